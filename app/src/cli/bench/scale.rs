//! The same garments in more and more loops.

use super::machine::{Machine, peak_mib};
use super::{solver, stages_ms, stages_text};
use crate::bundled::find;
use crate::cli::Output;
use anyhow::{Context, Result};
use cpu_time::ProcessTime;
use serde_json::{Value, json};
use sim_core::{Scene, Simulator};

/// Garments and their loops, fewest first.
const RUNS: [(&str, usize); 6] = [
    ("sweater", 1_000),
    ("sweater", 3_000),
    ("sweater", 10_000),
    ("sweater", 56_000),
    ("t-shirt", 100_000),
    ("t-shirt", 325_000),
];
/// Time step [s]: two in a frame.
const STEP: f64 = FRAME / 2.0;
/// A frame [s].
const FRAME: f64 = 1.0 / 30.0;
/// Time before what is measured, in which yarn that was just laid finds its first shape [s].
const BEFORE: f64 = 0.1;
/// Steps that are measured.
const STEPS: usize = 4;

/// Lets the garments of at most so many loops fall on their mannequin, and measures.
pub fn run(most_loops: usize, print: Output) -> Result<()> {
    let machine = Machine::measure();
    let mut runs = Vec::new();
    for (name, wanted) in RUNS.into_iter().filter(|(_, loops)| *loops <= most_loops) {
        let project = find(name).with_context(|| format!("there is no {name}"))?.of_loops(wanted)?;
        let fabric = project.fabric()?;
        let loops = fabric.stitches.loop_count();
        let scene = Scene { time_step: STEP, ..project.scene.clone() };
        let state = (*fabric.state()).clone();
        let mut simulator = Simulator::new(fabric.net(), project.materials.clone(), scene, state)?;
        while simulator.time_s() < BEFORE {
            simulator.step()?;
        }
        let rejected_before = simulator.facts().rejected_steps;
        simulator.reset_costs();
        let (start, began) = (ProcessTime::now(), simulator.time_s());
        for _ in 0..STEPS {
            simulator.step()?;
        }
        let (cpu_s, simulated) = (start.elapsed().as_secs_f64(), simulator.time_s() - began);
        let (costs, facts, stages) = (simulator.costs(), simulator.facts(), stages_ms(&simulator));
        let ms: f64 = stages.values().filter_map(Value::as_f64).sum();
        let s_per_frame = 1e-3 * ms * costs.attempts as f64 * FRAME / simulated;
        let iterations = costs.iterations as f64 / costs.attempts as f64;
        let peak = peak_mib();
        print.tell(&format!(
            "{name}, {loops} loops, {} solver: {ms:.0} ms a step ({}), {:.3} ms a loop in 1 000 steps, {iterations:.1} \
             iterations, {s_per_frame:.2} s a frame of 1/30 s, stretch {:.4}, least yarn distance {:.2} diameters, {}\n  {}",
            solver(&simulator),
            stages_text(&stages),
            1e3 * ms / loops as f64,
            facts.max_stretch,
            facts.min_yarn_distance_over_diameter,
            peak.map_or_else(String::new, |mib| format!("{mib:.0} MiB so far")),
            machine.compare(&costs, simulator.work()),
        ));
        runs.push(json!({
            "garment": name,
            "loops": loops,
            "solver": solver(&simulator),
            "ms_per_step": ms,
            "stages_ms": stages,
            "s_per_frame": s_per_frame,
            "cpu_s_per_stitch_and_sim_s": cpu_s / (loops as f64 * simulated),
            "iterations": iterations,
            "residual": costs.residual,
            "peak_mib": peak,
            "max_stretch_error": facts.max_stretch,
            "min_yarn_distance_over_diameter": facts.min_yarn_distance_over_diameter,
            "rejected_steps": facts.rejected_steps - rejected_before,
            "finite": simulator.state().is_finite(),
        }));
    }
    print.end(&json!({ "runs": runs, "threads": rayon::current_num_threads() }));
    Ok(())
}
