//! A step stage by stage, by each solver.

use super::hanging::{Hanging, columns};
use super::machine::Machine;
use crate::cli::Output;
use anyhow::Result;
use serde_json::json;
use sim_core::{SharedGpu, SolverChoice};

/// Stitches on each side.
const SIDE: usize = 41;
/// Steps that are measured.
const STEPS: u64 = 20;

/// Hangs stockinette by its last row and measures.
pub fn run(solvers: &[SolverChoice], print: Output) -> Result<()> {
    let (machine, gpu) = (Machine::measure(), SharedGpu::default());
    let hanging = Hanging::new(SIDE)?;
    let mut runs = Vec::new();
    for (solver, time_step) in solvers.iter().flat_map(|s| [(*s, 5e-3), (*s, 10e-3)]) {
        let measured = hanging.steps(&machine, &gpu, solver, time_step, [0, STEPS])?;
        print.tell(&format!("steps of {:.0} ms, {}", 1e3 * time_step, measured.text()));
        runs.push(columns(&measured, time_step));
    }
    print.end(&json!({ "runs": runs, "threads": rayon::current_num_threads() }));
    Ok(())
}
