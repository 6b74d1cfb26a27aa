//! A step stage by stage, by each solver.

use super::machine::{Machine, forget_peak};
use super::measured::Measured;
use crate::cli::Output;
use anyhow::Result;
use serde_json::json;
use sim_core::{Material, Pin, Scene, SharedGpu, Simulation, SolverChoice};
use std::sync::Arc;
use stitch_mesh::edge_counts::StitchSize;
use stitch_mesh::lay::lay;
use stitch_mesh::pieces::rectangle;

/// Stitches on each side.
const SIDE: usize = 41;
/// Width of a loop [m].
const LOOP: f64 = 3e-3;
/// Steps that are measured.
const STEPS: u64 = 20;
/// Stiffness of what holds each node of the last row [N/m].
const STIFFNESS: f64 = 10.0;

/// Hangs stockinette by its last row and measures.
pub fn run(solvers: &[SolverChoice], print: Output) -> Result<()> {
    let machine = Machine::measure();
    let net = Arc::new(lay(&rectangle(SIDE, SIDE, StitchSize::of_width(LOOP))?));
    let last = SIDE * (SIDE - 1);
    let held = net.nodes.iter().enumerate().filter(|(_, n)| n.face.is_some_and(|f| f.index() >= last));
    let pins: Vec<Pin> =
        held.map(|(i, n)| Pin { node: i as u32, target: n.position, stiffness: STIFFNESS }).collect();
    let gpu = SharedGpu::default();
    let mut runs = Vec::new();
    for (solver, time_step) in solvers.iter().flat_map(|s| [(*s, 5e-3), (*s, 10e-3)]) {
        forget_peak();
        let scene = Scene { pins: pins.clone(), time_step, ..Scene::default() };
        let material = Material::for_loop_width(LOOP);
        let mut simulation = Simulation::new(&gpu, solver, &net, material, scene, net.laid_state())?;
        let few = |s: &Simulation| s.progress().steps < STEPS;
        let measured = Measured::steps(&machine, SIDE * SIDE, &mut simulation, few)?;
        print.tell(&format!("steps of {:.0} ms, {}", 1e3 * time_step, measured.text()));
        let mut run = measured.json();
        run.insert("time_step_ms".to_owned(), json!(1e3 * time_step));
        runs.push(run);
    }
    print.end(&json!({ "runs": runs, "threads": rayon::current_num_threads() }));
    Ok(())
}
