//! Stockinette that is pulled.

use super::{solver, stages_ms, stages_text};
use crate::cli::Output;
use anyhow::Result;
use cpu_time::ProcessTime;
use glam::DVec3;
use serde_json::json;
use sim_core::{Clamp, Key, Material, Motion, Scene, Simulator};
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
const STEP: f64 = 0.02;
/// Stiffness of what holds each node at the sides [N/m].
const STIFFNESS: f64 = 10.0;

/// Pulls and measures.
pub fn run(print: Output) -> Result<()> {
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
    let mut simulator = Simulator::new(&net, Material::for_loop_width(LOOP), scene, net.laid_state())?;
    let start = ProcessTime::now();
    while simulator.time_s() < TIME - 1e-9 {
        simulator.step()?;
    }
    let cpu_s = start.elapsed().as_secs_f64();
    let facts = simulator.facts();
    let loops = SIDE * SIDE;
    let cost = cpu_s / (loops as f64 * simulator.time_s());
    let (state, stages) = (simulator.state(), stages_ms(&simulator));
    let json = json!({
        "loops": loops,
        "solver": solver(&simulator),
        "steps": facts.steps,
        "time_step_s": STEP,
        "cpu_s_per_stitch_and_sim_s": cost,
        "max_stretch_error": facts.max_stretch,
        "min_yarn_distance_over_diameter": facts.min_yarn_distance_over_diameter,
        "finite": state.is_finite(),
        "rejected_steps": facts.rejected_steps,
        "stages_ms": stages,
    });
    let text = format!(
        "{loops} loops, {} solver: {cost:.5} s of processor per stitch and simulated second\n\
         a step: {} ms\n\
         largest stretch {:.4}, least yarn distance {:.3} diameters, {} of {} steps taken again",
        solver(&simulator),
        stages_text(&stages),
        facts.max_stretch,
        facts.min_yarn_distance_over_diameter,
        facts.rejected_steps,
        facts.steps
    );
    print.print(&json, &text);
    Ok(())
}
