//! The same garments in more and more loops.

use super::machine::{Machine, forget_peak};
use super::measured::Measured;
use crate::bundled::find;
use crate::cli::Output;
use anyhow::{Context, Result};
use serde_json::json;
use sim_core::{Scene, SharedGpu, Simulation, SolverChoice};

/// Garments and their loops, fewest first.
const RUNS: [(&str, usize); 6] = [
    ("sweater", 1_000),
    ("sweater", 3_000),
    ("sweater", 10_000),
    ("sweater", 56_000),
    ("t-shirt", 100_000),
    ("t-shirt", 325_000),
];
/// Time step [s]: a frame.
const FRAME: f64 = 1.0 / 30.0;
/// How long they fall [s]: they land in the first half of it.
const FALL: f64 = 0.5;

/// Lets the garments of at most so many loops fall on their mannequin, and measures.
pub fn run(most_loops: usize, solver: SolverChoice, print: Output) -> Result<()> {
    let machine = Machine::measure();
    let gpu = SharedGpu::default();
    let mut runs = Vec::new();
    for (name, wanted) in RUNS.into_iter().filter(|(_, loops)| *loops <= most_loops) {
        forget_peak();
        let project = find(name).with_context(|| format!("there is no {name}"))?.of_loops(wanted)?;
        let fabric = project.fabric()?;
        let loops = fabric.stitches.loop_count();
        let scene = Scene { time_step: FRAME, ..project.scene.clone() };
        let state = (*fabric.state()).clone();
        let materials = project.materials.clone();
        let mut simulation = Simulation::new(&gpu, solver, fabric.net(), materials, scene, state)?;
        let falls = |s: &Simulation| s.progress().time_s < FALL;
        let measured = Measured::steps(&machine, loops, &mut simulation, falls)?;
        let s_per_frame = measured.clock_s_of(FRAME);
        print.tell(&format!(
            "{name}, {}\n  {s_per_frame:.2} s a frame of 1/30 s in the mean",
            measured.text()
        ));
        let mut run = measured.json();
        run.insert("garment".to_owned(), json!(name));
        run.insert("s_per_frame".to_owned(), json!(s_per_frame));
        runs.push(run);
    }
    print.end(&json!({ "runs": runs, "threads": rayon::current_num_threads() }));
    Ok(())
}
