//! Gauge: course and wale spacing of relaxed plain knit against its loop length.
//!
//! Munden (*The geometry and dimensional properties of plain-knit fabrics*, J. Text. Inst. 50, 1959) found that both spacings of
//! relaxed plain knit are proportional to the length l of yarn in a loop: courses per length × l = 5.0, wales per length ×
//! l = 3.8 and their ratio 1.3 for dry-relaxed wool. Here the same yarn is laid in loops of several lengths.
//!
//! In the model the yarns of a contact share one line, along which yarn is as long as its way from node to node. Real yarn
//! goes around its neighbour: drawn with its thickness it is a quarter longer, so the same is told with the length as it is
//! drawn, too. That brings both constants to within some percent of Munden's; the ratio needs no such correction.
//!
//! Course spacing is proportional to loop length, wale spacing less than that: thickness and contact lengths of the yarn stay the
//! same while the loops grow, and tight loops are held wide by them.

use super::bench::Bench;
use super::report::{Line, Plot, Table};
use super::specimen::{LOOP, Specimen};
use anyhow::Result;
use glam::DVec3;
use render::NamedView;
use sim_core::{Material, Scene, Simulator, curves};
use stitch_mesh::edge_counts::StitchSize;
use stitch_mesh::ids::FaceId;
use stitch_mesh::pieces::rectangle;
use stitch_mesh::yarn_curves::YarnCurve;

/// Stitches and rows.
const SIZE: [usize; 2] = [16, 20];
/// Widths of the laid loops, over the usual [`LOOP`].
const WIDTHS: [f64; 5] = [0.85, 0.92, 1.0, 1.15, 1.3];
/// Simulated time [s].
const TIME: f64 = 1.0;
/// What Munden measured: courses and wales per length, times the loop length.
const MUNDEN: [f64; 2] = [5.0, 3.8];

/// Relaxes plain knit of several loop lengths.
pub fn run(bench: &mut Bench) -> Result<()> {
    bench.plan(TIME * WIDTHS.len() as f64);
    let mut rows = Vec::new();
    for factor in WIDTHS {
        let size = StitchSize::of_width(LOOP * factor);
        let stitches = rectangle(SIZE[0], SIZE[1], size)?;
        let specimen = Specimen::new(&stitches, size, Material::for_loop_width(LOOP).into());
        let mut simulator = specimen.simulate(Scene::empty())?;
        let laid = spacings(&specimen, &specimen.net.laid_state().position);
        bench.run(&mut simulator, TIME)?;
        let [course, wale] = spacings(&specimen, &simulator.state().position);
        let length = loop_length(&specimen);
        rows.push(vec![
            1e3 * length,
            1e3 * laid[0],
            1e3 * laid[1],
            1e3 * course,
            1e3 * wale,
            length / course,
            length / wale,
            wale / course,
            drawn_over_model(&specimen, &simulator),
        ]);
        if factor == 1.0 {
            bench.report.pictures.push(specimen.picture("relaxed", NamedView::Front, &simulator));
        }
        bench.report.plots = vec![plot(&rows)];
    }
    let mean = |i: usize| rows.iter().map(|r| r[i]).sum::<f64>() / rows.len() as f64;
    let (courses, wales, drawn) = (mean(5), mean(6), mean(8));
    let report = &mut bench.report;
    report.remarks.push(format!(
        "{courses:.2} courses and {wales:.2} wales to the length of yarn in a loop (Munden: {:.1} and {:.1}). Drawn with its thickness \
         the yarn is {:.0} % longer than from contact to contact, and they are {:.2} and {:.2}",
        MUNDEN[0],
        MUNDEN[1],
        100.0 * (drawn - 1.0),
        courses * drawn,
        wales * drawn
    ));
    report.figure("courses_times_length", courses);
    report.figure("wales_times_length", wales);
    report.figure("ratio", courses / wales);
    report.figure("drawn_over_model_length", drawn);
    report.figure("courses_times_drawn_length", courses * drawn);
    report.figure("wales_times_drawn_length", wales * drawn);
    report.figure("munden_courses_times_length", MUNDEN[0]);
    report.figure("munden_wales_times_length", MUNDEN[1]);
    report.figure("munden_ratio", 1.3);
    let columns = vec![
        "loop_length_mm",
        "laid_course_spacing_mm",
        "laid_wale_spacing_mm",
        "course_spacing_mm",
        "wale_spacing_mm",
        "courses_times_length",
        "wales_times_length",
        "ratio",
        "drawn_over_model_length",
    ];
    report.tables.push(Table { name: "gauge", columns, rows });
    Ok(())
}

/// Mean length of yarn in a loop [m]: all yarn in stitches over their number. The nodes of a stitch lie in its face.
fn loop_length(specimen: &Specimen) -> f64 {
    let net = &specimen.net;
    let in_stitch =
        |v: stitch_mesh::ids::VisitId| net.nodes[net.visits[v.index()].node.index()].face.is_some();
    let segments = net.segments().filter(|s| s.ends.iter().all(|v| in_stitch(*v)));
    let length: f64 =
        segments.map(|s| net.visits[s.ends[1].index()].u + s.wrap - net.visits[s.ends[0].index()].u).sum();
    let stitches: usize = specimen.rows.iter().map(Vec::len).sum();
    length / stitches as f64
}

/// Length of the yarn as it is drawn over its length in the model.
fn drawn_over_model(specimen: &Specimen, simulator: &Simulator) -> f64 {
    /// Pieces of a span.
    const FINE: usize = 8;
    let drawn = curves(&specimen.net, simulator.state(), &specimen.materials);
    let of = |curve: &YarnCurve| {
        curve.sample(FINE).windows(2).map(|pair| f64::from(pair[0].distance(pair[1]))).sum::<f64>()
    };
    let model: f64 =
        specimen.net.yarns.iter().map(|y| specimen.net.visits[y.visits.end as usize - 1].u).sum();
    drawn.curves.iter().map(of).sum::<f64>() / model
}

/// Course spacing (from row to row) and wale spacing (from column to column) in the middle of the piece [m].
fn spacings(specimen: &Specimen, position: &[DVec3]) -> [f64; 2] {
    let state = stitch_mesh::yarn_net::YarnState { position: position.to_vec(), ..Default::default() };
    let centers = specimen.centers(&state);
    let at = |row: usize, column: usize| centers[FaceId::index(specimen.rows[row][column])];
    let mean =
        |pairs: Vec<[DVec3; 2]>| pairs.iter().map(|[a, b]| a.distance(*b)).sum::<f64>() / pairs.len() as f64;
    let inner = |n: usize| n / 4..n - n / 4;
    let places = || inner(SIZE[1]).flat_map(|r| inner(SIZE[0]).map(move |c| (r, c)));
    // Over two rows: in flat knitting rows lean to and fro a little.
    [
        mean(places().map(|(r, c)| [at(r - 1, c), at(r + 1, c)]).collect()) / 2.0,
        mean(places().map(|(r, c)| [at(r, c - 1), at(r, c + 1)]).collect()) / 2.0,
    ]
}

fn plot(rows: &[Vec<f64>]) -> Plot {
    let points = |i: usize| rows.iter().map(|r| [r[0], r[i]]).collect::<Vec<_>>();
    let of_munden = |k: f64| rows.iter().map(|r| [r[0], r[0] / k]).collect::<Vec<_>>();
    Plot {
        name: "gauge",
        title: "Relaxed plain knit".to_owned(),
        x: "length of yarn in a loop [mm]",
        y: "spacing [mm]",
        lines: vec![
            Line::new("from wale to wale", points(4)),
            Line::new("from course to course", points(3)),
            Line::dashed("wales, Munden 1959", of_munden(MUNDEN[1])),
            Line::dashed("courses, Munden 1959", of_munden(MUNDEN[0])),
        ],
    }
}
