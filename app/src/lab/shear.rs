//! Shear to and fro: the last row moves along the first at a constant distance.
//!
//! Both rows are held as in clamps. The force against the shear angle has a loop, whose area is what friction takes.

use super::Setup;
use super::bench::Bench;
use super::report::{Line, Plot, Table};
use super::specimen::Specimen;
use anyhow::Result;
use glam::DVec3;
use render::NamedView;
use sim_core::{Pin, Scene, Simulator};

/// Stitches and rows of the usual fabric, garter stitch, which lies flat.
const SIZE: [usize; 2] = [16, 16];
/// The largest shear angle [degrees], and that of one stroke.
const LARGEST: f64 = 40.0;
const STROKE: f64 = 2.0;
/// Simulated time of a stroke, and of the relaxation before [s].
const INTERVAL: f64 = 0.1;
const RELAXING: f64 = 0.6;
/// Part of a stroke in which the clamp moves, and part at its end over which the force is measured.
const MOVING: f64 = 0.5;
const MEASURED: f64 = 0.3;
/// Stiffness with which each node is held [N/m].
const STIFFNESS: f64 = 50.0;

/// Shears one way, the other way, and back.
pub fn run(bench: &mut Bench, setup: &Setup) -> Result<()> {
    let specimen = match &setup.pattern {
        Some(text) => Specimen::of_pattern(text)?,
        None => Specimen::rectangle(SIZE[0], SIZE[1], |_, t| t % 2 == 1)?,
    };
    let strokes = (LARGEST / STROKE).round() as i32;
    let angles = (1..=strokes).chain((-strokes..strokes).rev()).chain(1 - strokes..=strokes);
    bench.plan(RELAXING + f64::from(5 * strokes) * INTERVAL);
    let mut simulator = specimen.simulate(Scene::empty())?;
    bench.run(&mut simulator, RELAXING)?;
    let clamps = Clamps::close(&specimen, &simulator)?;
    let mut rows = vec![vec![0.0, 0.0]];
    let mut from = 0.0;
    for angle in angles.map(|i| f64::from(i) * STROKE) {
        let force = clamps.shear(bench, &mut simulator, [from, angle])?;
        from = angle;
        rows.push(vec![angle, force]);
        bench.report.plots = vec![plot(&rows)];
        if angle == LARGEST && bench.report.pictures.is_empty() {
            bench.report.pictures.push(specimen.picture("sheared", NamedView::Front, &simulator));
        }
    }
    let report = &mut bench.report;
    // From the loop alone, without the first stroke out of rest.
    let cycle = &rows[strokes as usize..];
    let angle = |r: &Vec<f64>| clamps.height * r[0].to_radians().tan();
    let lost: f64 = cycle.windows(2).map(|w| 0.5 * (w[0][1] + w[1][1]) * (angle(&w[1]) - angle(&w[0]))).sum();
    let slope = |between: [f64; 2]| {
        let part: Vec<&Vec<f64>> =
            cycle.iter().filter(|r| (between[0]..=between[1]).contains(&r[0])).collect();
        let n = part.len() as f64;
        let mean = |i: usize| part.iter().map(|r| r[i]).sum::<f64>() / n;
        let (a, f) = (mean(0), mean(1));
        let top: f64 = part.iter().map(|r| (r[0] - a) * (r[1] - f)).sum();
        top / part.iter().map(|r| (r[0] - a).powi(2)).sum::<f64>()
    };
    report.figure("stiffness_small_n_per_degree", slope([-8.0, 8.0]));
    report.figure("stiffness_large_n_per_degree", slope([LARGEST - 10.0, LARGEST]));
    report.figure("cycle_loss_j", lost);
    report.figure("largest_force_n", rows.iter().map(|r| r[1]).fold(0.0, f64::max));
    report.tables.push(Table { name: "shear", columns: vec!["angle_degrees", "force_n"], rows });
    Ok(())
}

/// Both end rows, each node held at its place; those of the last row move.
struct Clamps {
    /// Node, place when closed, and whether it moves.
    held: Vec<(u32, DVec3, bool)>,
    /// Distance between the rows [m].
    height: f64,
}

impl Clamps {
    fn close(specimen: &Specimen, simulator: &Simulator) -> Result<Self> {
        let state = simulator.state();
        let row = 1.0 / specimen.rows.len() as f64;
        let ends: [&dyn Fn(f64, f64) -> bool; 2] = [&|_, t| t < row, &|_, t| t > 1.0 - row];
        let height = (specimen.mean(state, ends[1])? - specimen.mean(state, ends[0])?).y;
        let held = ends.iter().zip([false, true]).flat_map(|(end, moves)| {
            specimen.nodes(end).map(move |n| (n.0, state.position[n.index()], moves)).collect::<Vec<_>>()
        });
        Ok(Self { held: held.collect(), height })
    }

    /// Goes from one angle to another [degrees]; gives the force at the end [N].
    fn shear(&self, bench: &mut Bench, simulator: &mut Simulator, [from, to]: [f64; 2]) -> Result<f64> {
        let begin = simulator.time_s();
        let (mut sum, mut count) = (0.0, 0.0);
        loop {
            let part = (simulator.time_s() - begin) / INTERVAL;
            if part >= 1.0 - 1e-9 {
                return Ok(sum / f64::max(count, 1.0));
            }
            let angle: f64 = from + (to - from) * (part / MOVING).min(1.0);
            let offset = self.height * angle.to_radians().tan() * DVec3::X;
            let pin = |(node, place, moves): &(u32, DVec3, bool)| Pin {
                node: *node,
                target: if *moves { *place + offset } else { *place },
                stiffness: STIFFNESS,
            };
            let scene = Scene { pins: self.held.iter().map(pin).collect(), ..Scene::empty() };
            simulator.set_scene(scene)?;
            bench.step(simulator)?;
            if part >= 1.0 - MEASURED {
                (sum, count) = (sum + self.force(simulator), count + 1.0);
            }
        }
    }

    /// Force along the course, the mean of both clamps [N].
    fn force(&self, simulator: &Simulator) -> f64 {
        let of = |(pin, (_, _, moves)): (&Pin, &(u32, DVec3, bool))| {
            let pull = pin.stiffness * (pin.target - simulator.state().position[pin.node as usize]).x;
            if *moves { pull } else { -pull }
        };
        0.5 * simulator.scene().pins.iter().zip(&self.held).map(of).sum::<f64>()
    }
}

fn plot(rows: &[Vec<f64>]) -> Plot {
    let line = Line::new("shear", rows.iter().map(|r| [r[0], r[1]]).collect());
    Plot {
        name: "shear",
        title: "Shear to and fro".to_owned(),
        x: "shear angle [degrees]",
        y: "force [N]",
        lines: vec![line],
    }
}
