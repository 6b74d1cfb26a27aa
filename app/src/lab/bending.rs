//! Bending: how a square drapes over a small disc, and how far a strip stands out before it hangs.
//!
//! - **Drape** (Cusick 1968): a piece is held between two discs and hangs freely around them. The drape coefficient is the area
//!   of its shadow beyond the disc over the area of the flat piece beyond it: 1 for a board, near 0 for a chain of beads.
//! - **Bending length** (Peirce 1930): a strip stands out by l and bends under its weight until the line from clamp to tip is
//!   θ under the horizontal; c = l (cos(θ/2) / (8 tan θ))^⅓, and the flexural rigidity is the weight per area times c³.

use super::bench::Bench;
use super::report::{Line, Plot, Table};
use super::specimen::Specimen;
use anyhow::Result;
use glam::DVec3;
use render::NamedView;
use sim_core::{Pin, Scene, Simulator};
use std::collections::HashSet;

/// Stitches and rows of the square of garter stitch, about as wide as high.
const SQUARE: [usize; 2] = [24, 32];
/// Radius of the discs over half the width of the square.
const DISC: f64 = 0.4;
/// Stitches across a strip, and rows that stand out.
const STRIP: usize = 8;
const OUT: [usize; 4] = [3, 5, 8, 12];
/// Rows of a strip in the clamp.
const CLAMPED: usize = 3;
/// Simulated time of the square and of a strip [s].
const TIME: [f64; 2] = [0.8, 0.6];
/// Stiffness with which nodes are clamped [N/m].
const STIFFNESS: f64 = 20.0;

/// Drapes the square, then hangs the strips.
pub fn run(bench: &mut Bench) -> Result<()> {
    bench.plan(TIME[0] + TIME[1] * OUT.len() as f64);
    drape(bench)?;
    strips(bench)
}

/// A piece of garter stitch turned level, face up, its rows running away from the clamp along +x or across it.
fn level(specimen: &Specimen, clamped: &dyn Fn(DVec3) -> bool) -> Result<Simulator> {
    let mut state = specimen.net.laid_state();
    for x in &mut state.position {
        *x = DVec3::new(x.x, x.z, -x.y);
    }
    let held = state.position.iter().enumerate().filter(|(_, x)| clamped(**x));
    let pins = held.map(|(i, x)| Pin { node: i as u32, target: *x, stiffness: STIFFNESS }).collect();
    let scene = Scene { pins, ..Scene::default() };
    Ok(Simulator::new(&specimen.net, specimen.materials.clone(), scene, state)?)
}

fn garter(wide: usize, high: usize) -> Result<Specimen> {
    Specimen::rectangle(wide, high, |_, t| t % 2 == 1)
}

fn drape(bench: &mut Bench) -> Result<()> {
    let specimen = garter(SQUARE[0], SQUARE[1])?;
    let radius = DISC * 0.5 * SQUARE[0] as f64 * specimen.size.width;
    let mut simulator = level(&specimen, &|x| x.with_y(0.0).length() < radius)?;
    let flat = shadow(&specimen, &simulator, radius);
    let mut rows = vec![vec![0.0, 1.0]];
    while simulator.time_s() < TIME[0] - 1e-9 {
        bench.run(&mut simulator, 0.02)?;
        rows.push(vec![simulator.time_s(), shadow(&specimen, &simulator, radius) / flat]);
        bench.report.plots = vec![Plot {
            name: "drape",
            title: "Square falling over a disc".to_owned(),
            x: "time [s]",
            y: "shadow beyond the disc over that when flat",
            lines: vec![Line::new("drape coefficient", rows.iter().map(|r| [r[0], r[1]]).collect())],
        }];
    }
    let report = &mut bench.report;
    report.figure("drape_coefficient", rows[rows.len() - 1][1]);
    report.tables.push(Table { name: "drape", columns: vec!["time_s", "drape_coefficient"], rows });
    report.pictures.push(specimen.picture("drape", NamedView::ThreeQuarter, &simulator));
    Ok(())
}

/// Area of the shadow under a level piece beyond a disc about the origin [m²].
fn shadow(specimen: &Specimen, simulator: &Simulator, radius: f64) -> f64 {
    /// Side of a cell that is in the shadow or not [m], and points across a stitch that are looked at.
    const CELL: f64 = 0.5e-3;
    const POINTS: usize = 8;
    let centers = specimen.centers(simulator.state());
    let mut dark = HashSet::new();
    for rows in specimen.rows.windows(2) {
        for (below, above) in rows[0].windows(2).zip(rows[1].windows(2)) {
            let [a, b, c, d] = [below[0], below[1], above[0], above[1]].map(|f| centers[f.index()]);
            for (i, j) in (0..=POINTS).flat_map(|i| (0..=POINTS).map(move |j| (i, j))) {
                let [s, t] = [i, j].map(|n| n as f64 / POINTS as f64);
                let x = a.lerp(b, s).lerp(c.lerp(d, s), t);
                if x.with_y(0.0).length() > radius {
                    dark.insert([x.x, x.z].map(|y| (y / CELL).floor() as i32));
                }
            }
        }
    }
    dark.len() as f64 * CELL * CELL
}

fn strips(bench: &mut Bench) -> Result<()> {
    let mut rows: Vec<Vec<f64>> = Vec::new();
    for out in OUT {
        let specimen = garter(STRIP, CLAMPED + out)?;
        let edge = |state: &stitch_mesh::yarn_net::YarnState, row: usize| {
            let t = (row as f64 + 0.5) / (CLAMPED + out) as f64;
            specimen.mean(state, |_, at| (at - t).abs() < 1e-6)
        };
        let clamp = -edge(&specimen.net.laid_state(), CLAMPED)?.y + 0.5 * specimen.size.height;
        // Level, rows follow each other along −z.
        let mut simulator = level(&specimen, &|x| x.z > clamp)?;
        bench.run(&mut simulator, TIME[1])?;
        let tip = edge(simulator.state(), CLAMPED + out - 1)?;
        let length = (out as f64 - 0.5) * specimen.size.height;
        let angle = (-tip.y).atan2(clamp - tip.z);
        let bending = length * ((0.5 * angle).cos() / (8.0 * angle.tan())).max(0.0).cbrt();
        let masses: f64 = simulator.model().node_masses(&specimen.materials).iter().sum();
        let area = specimen.size.width * specimen.size.height * (STRIP * (CLAMPED + out)) as f64;
        let rigidity = 9.81 * masses / area * bending.powi(3);
        rows.push(vec![1e3 * length, angle.to_degrees(), 1e3 * bending, 1e6 * rigidity]);
        bench.report.pictures.retain(|p| p.name != "strip");
        bench.report.pictures.push(specimen.picture("strip", NamedView::Right, &simulator));
    }
    let report = &mut bench.report;
    // Peirce's formula holds best for the middle angles.
    let best = rows.iter().min_by(|a, b| (a[1] - 41.5).abs().total_cmp(&(b[1] - 41.5).abs()));
    if let Some(best) = best {
        report.figure("bending_length_mm", best[2]);
        report.figure("flexural_rigidity_un_m", best[3]);
        report.figure("strip_angle_degrees", best[1]);
    }
    report.plots.push(Plot {
        name: "strip",
        title: "Strips standing out of a clamp".to_owned(),
        x: "length that stands out [mm]",
        y: "angle under the horizontal [degrees]",
        lines: vec![Line::new("garter stitch", rows.iter().map(|r| [r[0], r[1]]).collect())],
    });
    let columns = vec!["length_mm", "angle_degrees", "bending_length_mm", "flexural_rigidity_un_m"];
    report.tables.push(Table { name: "strips", columns, rows });
    Ok(())
}
