//! One fabric in more and more loops: what a loop costs.
//!
//! `scale.rs` has garments of one size in more and more loops instead, which is harder: the finer the yarn, the further a step of the
//! same length goes in loops.

use super::hanging::{Hanging, columns};
use super::machine::Machine;
use crate::cli::Output;
use anyhow::Result;
use serde_json::json;
use sim_core::{SharedGpu, SolverChoice};

/// Stitches on each side, fewest first: 1 024 … 324 900 loops.
const SIDES: [usize; 6] = [32, 57, 103, 180, 320, 570];
/// Time step [s].
const STEP: f64 = 5e-3;
/// Steps before those that are measured, in which yarn that was just laid finds its first shape.
const BEFORE: u64 = 8;
/// Steps that are measured.
const STEPS: u64 = 12;

/// Hangs stockinette of at most so many loops by its last row and measures.
pub fn run(most_loops: usize, solver: SolverChoice, print: Output) -> Result<()> {
    let (machine, gpu) = (Machine::measure(), SharedGpu::default());
    let mut runs = Vec::new();
    let mut first = None;
    for side in SIDES.into_iter().filter(|side| side * side <= most_loops) {
        let measured = Hanging::new(side)?.steps(&machine, &gpu, solver, STEP, [BEFORE, STEPS])?;
        let growth = measured.ms_per_loop() / *first.get_or_insert(measured.ms_per_loop());
        print.tell(&format!("{}\n  a loop costs {growth:.2} times as much as at first", measured.text()));
        let mut run = columns(&measured, STEP);
        run.insert("growth".to_owned(), json!(growth));
        runs.push(run);
    }
    print.end(&json!({ "runs": runs, "threads": rayon::current_num_threads() }));
    Ok(())
}
