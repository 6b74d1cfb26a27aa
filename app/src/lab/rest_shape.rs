//! Rest-shape compensation (Cirio et al., Fig. 6): the same garment with loops as they are drawn, and with loops as they are in
//! a relaxed sample, each set free without gravity. The first shrinks, the second keeps its size.

use super::bench::Bench;
use super::report::{Line, Picture, Plot, Table};
use super::specimen::Specimen;
use crate::bundled;
use crate::command::Command;
use crate::fabric::Fabric;
use crate::project::Project;
use anyhow::Result;
use glam::DVec3;
use render::NamedView;
use sim_core::{RestShape, Scene, Simulator};
use std::sync::Arc;
use stitch_mesh::yarn_net::YarnState;

/// Width of a stitch of the garment [mm]: a child's pullover of the thickest yarn, so that it has few.
const STITCH_MM: f64 = 20.0;
/// Simulated time for loops of 3 mm, and its step [s]; larger loops do the same more slowly.
const TIME: f64 = 1.2;
const STEP: f64 = 5e-3;
/// The sample, in KnitSpeak.
const STOCKINETTE: &str = "Row 1 (RS): Knit.\nRow 2: Purl.\n";

/// Relaxes the garment with both kinds of loops.
pub fn run(bench: &mut Bench) -> Result<()> {
    let slower = STITCH_MM / 3.0;
    bench.plan(3.0 * slower * TIME);
    let tessellate = Command::Tessellate { width_mm: Some(STITCH_MM) };
    let mesh = Project { fabric: None, counts: None, ..bundled::pullover()? };
    let garment = tessellate.apply(&mesh)?;
    let stitches = (*garment.fabric()?.stitches).clone();
    let sample = crate::written::sample(STOCKINETTE, crate::command::mean_size(&stitches))?;
    let mut told = 0.0;
    let mut stopped = Ok(());
    let shape = RestShape::relax(&sample, &garment.materials, &mut |part| {
        if stopped.is_ok() {
            stopped = bench.pass(slower * TIME * (part - told));
            told = part;
        }
    })?;
    stopped?;
    let [course, wale] = shape.growth();
    let compensated = Fabric::with_rest_shape(stitches, Some(Arc::new(shape)));
    let specimen = Specimen::new(&garment.fabric()?.stitches, garment.size, garment.materials.clone());
    let laid = area(&specimen, &specimen.net.laid_state());
    let mut rows: Vec<Vec<f64>> = Vec::new();
    let mut shown = Vec::new();
    let pieces =
        [("with", "at rest as in a sample", &compensated), ("without", "as drawn", garment.fabric()?)];
    let mut figures = vec![("laid_area_mm2".to_owned(), laid)];
    let mut lines = Vec::new();
    for (name, what, fabric) in pieces {
        let scene = Scene { time_step: slower * STEP, ..Scene::empty() };
        let Project { materials, .. } = &garment;
        let mut simulator =
            Simulator::new(fabric.net(), materials.clone(), scene, (*fabric.state()).clone())?;
        let mut points = vec![[0.0, area(&specimen, simulator.state())]];
        while simulator.time_s() < slower * TIME {
            bench.run(&mut simulator, 10.0 * slower * STEP)?;
            points.push([simulator.time_s(), area(&specimen, simulator.state())]);
        }
        figures.push((format!("{name}_mm2"), points[points.len() - 1][1]));
        if rows.is_empty() {
            rows = points.iter().map(|p| vec![p[0]]).collect();
        }
        rows.iter_mut().zip(&points).for_each(|(row, point)| row.push(point[1]));
        lines.push(Line::new(format!("loops {what}"), points.iter().map(|p| [p[0], p[1] * 1e-2]).collect()));
        shown.push((
            format!("Loops {what}"),
            specimen.drawing(simulator.net(), &centred(simulator.state()), simulator.scene()),
        ));
    }
    let last = rows.last().map_or(0.0, |row| row[0]);
    lines.push(Line::dashed("as laid", vec![[0.0, laid * 1e-2], [last, laid * 1e-2]]));
    let report = &mut bench.report;
    report.figures = figures;
    report.figure("growth_course", course);
    report.figure("growth_wale", wale);
    report.plots.push(Plot {
        name: "area",
        title: "A pullover set free".to_owned(),
        x: "time [s]",
        y: "area [cm²]",
        lines,
    });
    report.tables.push(Table { name: "area", columns: vec!["time_s", "with_mm2", "without_mm2"], rows });
    report.pictures.push(Picture { name: "garments", view: NamedView::ThreeQuarter, shown });
    Ok(())
}

/// A state with its middle at the origin.
fn centred(state: &YarnState) -> YarnState {
    let middle = state.position.iter().sum::<DVec3>() / state.position.len().max(1) as f64;
    YarnState { position: state.position.iter().map(|x| *x - middle).collect(), ..state.clone() }
}

/// Area between the middles of stitches that meet at a corner [mm²]: in a curl it is that of the fabric, not of its shadow.
fn area(specimen: &Specimen, state: &YarnState) -> f64 {
    let centers = specimen.centers(state);
    let stitches = &specimen.stitches;
    let right = |f| stitches.mesh().face_across(stitches.right(f));
    let of = |f| {
        let beside = right(f)?;
        let (above, across) = (stitches.above(f).next()?, stitches.above(beside).next()?);
        let [a, b, c, d] = [f, beside, across, above].map(|f| centers[f.index()]);
        Some(0.5 * (c - a).cross(d - b).length())
    };
    1e6 * stitches.mesh().faces().filter_map(of).sum::<f64>()
}
