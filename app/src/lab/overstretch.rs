//! Overstretch and release (Cirio et al., Fig. 9): pulled beyond what friction holds, yarn slides through its contacts, and part
//! of the extension stays. Where friction lets nothing slide, nearly all of it goes.
//!
//! A released piece waves, so at rest its width is measured along its rows.

use super::bench::Bench;
use super::jaws::{Direction, Jaws};
use super::pull::{Reading, load, read, unload};
use super::report::{Line, Picture, Plot, Table};
use super::specimen::{LOOP, Specimen};
use anyhow::Result;
use render::NamedView;
use sim_core::{Material, Scene};
use stitch_mesh::ids::FaceId;
use stitch_mesh::yarn_net::YarnState;

/// Stitches and rows of garter stitch.
const SIZE: [usize; 2] = [12, 12];
/// Force at which it is let go, for each row [N].
const LIMIT: f64 = 2.0 / 12.0;
/// The longest stroke, over the width at rest.
const STROKE: f64 = 0.04;
/// Time to relax before and after [s].
const RELAXING: f64 = 1.0;
/// A coefficient of friction at which nothing slides.
const HIGH: f64 = 100.0;

/// What one yarn did.
struct Trial {
    /// Width before and after [m].
    rest: f64,
    residual: f64,
    readings: Vec<Reading>,
    /// At rest, at the largest force, let go.
    pictures: [Picture; 3],
}

/// Pulls and lets go, with both yarns.
pub fn run(bench: &mut Bench) -> Result<()> {
    bench.plan(28.0);
    let own = Material::for_loop_width(LOOP).friction;
    let mut lines = Vec::new();
    let mut rows = Vec::new();
    for (what, friction) in [("", own), ("_high_friction", HIGH)] {
        let trial = measure(bench, SIZE, friction)?;
        let report = &mut bench.report;
        report.figure(format!("rest{}_mm", if what.is_empty() { "_width" } else { what }), 1e3 * trial.rest);
        report.figure(
            format!("residual{}_mm", if what.is_empty() { "_width" } else { what }),
            1e3 * trial.residual,
        );
        if what.is_empty() {
            report.pictures.extend(trial.pictures);
        }
        rows.extend(trial.readings.iter().map(|r| vec![friction, 1e3 * r.distance, r.force]));
        let points = trial.readings.iter().map(|r| [1e3 * r.distance, r.force]).collect();
        lines.push(Line::new(format!("friction {friction}"), points));
        report.plots = vec![Plot {
            name: "force",
            title: "Garter stitch overstretched and let go".to_owned(),
            x: "width [mm]",
            y: "force [N]",
            lines: lines.clone(),
        }];
    }
    let columns = vec!["friction", "width_mm", "force_n"];
    bench.report.tables.push(Table { name: "overstretch", columns, rows });
    Ok(())
}

/// Garter stitch of one yarn.
fn measure(bench: &mut Bench, [wide, high]: [usize; 2], friction: f64) -> Result<Trial> {
    let mut specimen = Specimen::rectangle(wide, high, |_, t| t % 2 == 1)?;
    specimen.materials.base.friction = friction;
    let mut simulator = specimen.simulate(Scene::empty())?;
    bench.run(&mut simulator, RELAXING)?;
    let rest = width(&specimen, simulator.state());
    let at_rest = specimen.picture("rest", NamedView::Front, &simulator);
    let mut jaws = Jaws::grip(&specimen, simulator.state(), Direction::Course)?;
    let mut readings = vec![read(&jaws, &simulator)];
    let limit = LIMIT * jaws.held();
    let strokes =
        load(bench, &mut simulator, &mut jaws, (limit, STROKE * rest), &mut |_, r| readings.push(r))?;
    let pulled = specimen.picture("overstretched", NamedView::Front, &simulator);
    unload(bench, &mut simulator, &mut jaws, (limit, &strokes), &mut |_, r| readings.push(r))?;
    simulator.set_scene(Scene::empty())?;
    bench.run(&mut simulator, RELAXING)?;
    let residual = width(&specimen, simulator.state());
    let pictures = [at_rest, pulled, specimen.picture("released", NamedView::Front, &simulator)];
    Ok(Trial { rest, residual, readings, pictures })
}

/// Width along the rows, from the first stitch to the last, in the mean of the rows between the borders [m].
fn width(specimen: &Specimen, state: &YarnState) -> f64 {
    let centers = specimen.centers(state);
    let rows = &specimen.rows[2..specimen.rows.len() - 2];
    let of = |pair: &[FaceId]| centers[pair[0].index()].distance(centers[pair[1].index()]);
    rows.iter().flat_map(|row| row.windows(2).map(of)).sum::<f64>() / rows.len() as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::ops::ControlFlow;

    /// Fig. 9 of the paper, on a small piece.
    #[test]
    fn overstretched_garter_stays_wide_unless_friction_holds_everything() {
        let mut watch = |_: f64, _: &super::super::Report| ControlFlow::Continue(());
        let mut bench = Bench::new(&mut watch);
        let residual = |trial: Trial| trial.residual / trial.rest - 1.0;
        let own = residual(measure(&mut bench, [5, 6], 0.3).unwrap());
        let high = residual(measure(&mut bench, [5, 6], HIGH).unwrap());
        println!("{own:.3} stays, with high friction {high:.3}");
        assert!(own > 0.08);
        assert!(high.abs() < 0.25 * own);
    }
}
