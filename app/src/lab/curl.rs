//! Curl of stockinette (Cirio et al., Fig. 7): top and bottom roll to the front, the sides to the back.
//!
//! Which pair of edges wins is open in a square, where both begin to roll and one pulls the other along later. In a narrow
//! strip the long edges roll up wholly and the short ones still lean the other way. The figures are the strip's.

use super::bench::Bench;
use super::report::{Line, Plot, Table};
use super::specimen::Specimen;
use anyhow::Result;
use render::NamedView;
use sim_core::{Scene, Simulator};

/// Stitches and rows of the strip and of the square.
const PIECES: [(&str, [usize; 2]); 2] = [("strip", [10, 36]), ("square", [24, 24])];
/// Simulated time, and time between two measurements [s].
const TIME: f64 = 0.8;
const INTERVAL: f64 = 0.02;
/// The edges, in the order in which they are measured.
const EDGES: [&str; 4] = ["top", "bottom", "left", "right"];

/// Lets both pieces curl.
pub fn run(bench: &mut Bench) -> Result<()> {
    bench.plan(TIME * PIECES.len() as f64);
    for (name, [wide, high]) in PIECES {
        let specimen = Specimen::rectangle(wide, high, |_, _| false)?;
        let mut simulator = specimen.simulate(Scene::empty())?;
        let mut rows = vec![heights(&specimen, &simulator)?];
        while simulator.time_s() < TIME - 1e-9 {
            bench.run(&mut simulator, INTERVAL)?;
            rows.push(heights(&specimen, &simulator)?);
        }
        let report = &mut bench.report;
        let last = &rows[rows.len() - 1];
        for (edge, height) in EDGES.iter().zip(&last[1..]) {
            let prefix = if name == "strip" { String::new() } else { format!("{name}_") };
            report.figure(format!("{prefix}{edge}_mm"), *height);
        }
        let line =
            |(i, edge): (usize, &&str)| Line::new(*edge, rows.iter().map(|r| [r[0], r[1 + i]]).collect());
        report.plots.push(Plot {
            name,
            title: format!("Curl of stockinette, {wide} × {high} stitches"),
            x: "time [s]",
            y: "height of the edge over the middle, to the front [mm]",
            lines: EDGES.iter().enumerate().map(line).collect(),
        });
        report.tables.push(Table {
            name,
            columns: vec!["time_s", "top_mm", "bottom_mm", "left_mm", "right_mm"],
            rows,
        });
        report.pictures.push(specimen.picture(name, NamedView::ThreeQuarter, &simulator));
    }
    Ok(())
}

/// Time [s], and mean height of each edge over the middle, positive to the front [mm].
fn heights(specimen: &Specimen, simulator: &Simulator) -> Result<Vec<f64>> {
    let state = simulator.state();
    let inner = |x: f64| (0.35..0.65).contains(&x);
    let middle = specimen.mean(state, |s, t| inner(s) && inner(t))?;
    let [.., front] = specimen.frame(state)?;
    let (row, column) = (1.0 / specimen.rows.len() as f64, 1.0 / specimen.rows[0].len() as f64);
    let edges: [&dyn Fn(f64, f64) -> bool; 4] = [
        &|s, t| t > 1.0 - row && inner(s),
        &|s, t| t < row && inner(s),
        &|s, t| s < column && inner(t),
        &|s, t| s > 1.0 - column && inner(t),
    ];
    let mut measured = vec![simulator.time_s()];
    for edge in edges {
        measured.push(1e3 * (specimen.mean(state, edge)? - middle).dot(front));
    }
    Ok(measured)
}
