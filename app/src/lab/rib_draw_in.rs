//! Drawing in of a 2 × 2 rib (Cirio et al., Fig. 5): knit columns come forward, purl columns go back, and the piece becomes narrow.

use super::bench::Bench;
use super::report::{Line, Plot, Table};
use super::specimen::Specimen;
use anyhow::Result;
use render::NamedView;
use sim_core::{Scene, Simulator};

/// Stitches and rows.
const SIZE: [usize; 2] = [20, 20];
/// Simulated time, and time between two measurements [s].
const TIME: f64 = 1.2;
const INTERVAL: f64 = 0.02;

/// Lets the rib relax.
pub fn run(bench: &mut Bench) -> Result<()> {
    bench.plan(TIME);
    let specimen = Specimen::rectangle(SIZE[0], SIZE[1], |s, _| s / 2 % 2 == 1)?;
    let mut simulator = specimen.simulate(Scene::empty())?;
    bench.report.pictures.push(specimen.picture("laid", NamedView::Front, &simulator));
    let mut rows = vec![vec![0.0, width(&specimen, &simulator)?]];
    while simulator.time_s() < TIME - 1e-9 {
        bench.run(&mut simulator, INTERVAL)?;
        rows.push(vec![simulator.time_s(), width(&specimen, &simulator)?]);
        bench.report.plots = vec![plot(&rows)];
    }
    let report = &mut bench.report;
    report.figure("laid_width_mm", rows[0][1]);
    report.figure("relaxed_width_mm", rows[rows.len() - 1][1]);
    report.pictures.push(specimen.picture("relaxed", NamedView::Front, &simulator));
    report.pictures.push(specimen.picture("ridges", NamedView::Top, &simulator));
    report.tables.push(Table { name: "width", columns: vec!["time_s", "width_mm"], rows });
    Ok(())
}

/// Width of the rows in the middle, which cast-on and bind-off do not hold wide [mm].
fn width(specimen: &Specimen, simulator: &Simulator) -> Result<f64> {
    let column = 1.0 / SIZE[0] as f64;
    let inner = |t: f64| (0.35..0.65).contains(&t);
    let side = |chosen: &dyn Fn(f64) -> bool| specimen.mean(simulator.state(), |s, t| chosen(s) && inner(t));
    Ok(1e3 * side(&|s| s < column)?.distance(side(&|s| s > 1.0 - column)?))
}

fn plot(rows: &[Vec<f64>]) -> Plot {
    let line = Line::new("width", rows.iter().map(|r| [r[0], r[1]]).collect());
    Plot {
        name: "width",
        title: "2 × 2 rib drawing in".to_owned(),
        x: "time [s]",
        y: "width [mm]",
        lines: vec![line],
    }
}
