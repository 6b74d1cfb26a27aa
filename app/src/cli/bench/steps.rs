//! A step stage by stage, by each solver.

use super::machine::Machine;
use super::{solver, stages_ms, stages_text};
use crate::cli::Output;
use anyhow::Result;
use serde_json::{Value, json};
use sim_core::{Material, Method, Pin, Scene, Simulator};
use std::sync::Arc;
use stitch_mesh::edge_counts::StitchSize;
use stitch_mesh::lay::lay;
use stitch_mesh::pieces::rectangle;

/// Stitches on each side.
const SIDE: usize = 41;
/// Width of a loop [m].
const LOOP: f64 = 3e-3;
/// Steps that are measured.
const STEPS: usize = 20;
/// Stiffness of what holds each node of the last row [N/m].
const STIFFNESS: f64 = 10.0;

/// Hangs stockinette by its last row and measures.
pub fn run(print: Output) -> Result<()> {
    let machine = Machine::measure();
    let net = Arc::new(lay(&rectangle(SIDE, SIDE, StitchSize::of_width(LOOP))?));
    let last = SIDE * (SIDE - 1);
    let held = net.nodes.iter().enumerate().filter(|(_, n)| n.face.is_some_and(|f| f.index() >= last));
    let pins: Vec<Pin> =
        held.map(|(i, n)| Pin { node: i as u32, target: n.position, stiffness: STIFFNESS }).collect();
    let mut runs = Vec::new();
    for (method, time_step) in
        [Method::Direct, Method::Iterative].into_iter().flat_map(|m| [(m, 5e-3), (m, 10e-3)])
    {
        let scene = Scene { pins: pins.clone(), time_step, ..Scene::default() };
        let mut simulator = Simulator::new(&net, Material::for_loop_width(LOOP), scene, net.laid_state())?;
        simulator.set_method(Some(method));
        for _ in 0..STEPS {
            simulator.step()?;
        }
        let (costs, facts, stages) = (simulator.costs(), simulator.facts(), stages_ms(&simulator));
        let ms: f64 = stages.values().filter_map(Value::as_f64).sum();
        let iterations = costs.iterations as f64 / costs.attempts as f64;
        print.tell(&format!(
            "{} loops, {} solver, steps of {:.0} ms: {ms:.1} ms a step ({}), {iterations:.1} iterations, {} of {} steps \
             taken again\n  {}",
            SIDE * SIDE,
            solver(&simulator),
            1e3 * time_step,
            stages_text(&stages),
            facts.rejected_steps,
            costs.attempts,
            machine.compare(&costs, simulator.work()),
        ));
        runs.push(json!({
            "loops": SIDE * SIDE,
            "solver": solver(&simulator),
            "time_step_ms": 1e3 * time_step,
            "ms_per_step": ms,
            "stages_ms": stages,
            "iterations": iterations,
            "residual": costs.residual,
            "rejected_steps": facts.rejected_steps,
            "max_stretch_error": facts.max_stretch,
            "finite": simulator.state().is_finite(),
        }));
    }
    print.end(&json!({ "runs": runs, "threads": rayon::current_num_threads() }));
    Ok(())
}
