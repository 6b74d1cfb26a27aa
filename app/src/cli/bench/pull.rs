//! Stockinette that is pulled.

use super::machine::{Machine, forget_peak};
use super::measured::Measured;
use crate::cli::Output;
use anyhow::Result;
use glam::DVec3;
use serde_json::json;
use sim_core::{Clamp, Key, Material, Motion, Scene, SharedGpu, Simulation, SolverChoice};
use std::sync::Arc;
use stitch_mesh::edge_counts::StitchSize;
use stitch_mesh::lay::lay;
use stitch_mesh::pieces::rectangle;

/// Stitches on each side.
const SIDE: usize = 20;
/// Width of a loop [m].
const LOOP: f64 = 3e-3;
/// How much wider the fabric is pulled, and how long that takes [s].
const PULL: f64 = 0.2;
const TIME: f64 = 0.2;
/// Time step [s].
const STEP: f64 = 0.025;
/// Stiffness of what holds each node at the sides [N/m].
const STIFFNESS: f64 = 10.0;

/// Pulls and measures.
pub fn run(solver: SolverChoice, print: Output) -> Result<()> {
    let stitches = rectangle(SIDE, SIDE, StitchSize::of_width(LOOP))?;
    let net = Arc::new(lay(&stitches));
    let jaw = |column: usize, name: &str, side: f64| {
        let at_side = |face: usize| face % SIDE == column;
        let held = net.nodes.iter().enumerate().filter(|(_, n)| n.face.is_some_and(|f| at_side(f.index())));
        let shift = DVec3::X * (0.5 * side * PULL * SIDE as f64 * LOOP);
        let keys = vec![
            Key { time_s: 0.0, shift: DVec3::ZERO, turn: DVec3::ZERO },
            Key { time_s: TIME, shift, turn: DVec3::ZERO },
        ];
        Clamp {
            name: name.to_owned(),
            nodes: held.map(|(i, n)| (i as u32, n.position)).collect(),
            stiffness: STIFFNESS,
            motion: Motion { keys, ..Motion::default() },
        }
    };
    let clamps = vec![jaw(0, "left", -1.0), jaw(SIDE - 1, "right", 1.0)];
    let scene = Scene { clamps, time_step: STEP, ..Scene::empty() };
    let machine = Machine::measure();
    forget_peak();
    let material = Material::for_loop_width(LOOP);
    let mut simulation =
        Simulation::new(&SharedGpu::default(), solver, &net, material, scene, net.laid_state())?;
    let pulled = |s: &Simulation| s.progress().time_s < TIME - 1e-9;
    let measured = Measured::steps(&machine, SIDE * SIDE, &mut simulation, pulled)?;
    let mut json = measured.json();
    json.insert("time_step_s".to_owned(), json!(STEP));
    print.print(&json.into(), &measured.text());
    Ok(())
}
