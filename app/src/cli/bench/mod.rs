//! Speed of the simulator, beside what it achieved with it.
//!
//! Times of the processor are over all threads, so they compare across machines with other things to do; the quality columns
//! tell whether they were bought with a wrong result.

mod growth;
mod hanging;
mod machine;
mod measured;
mod pull;
mod scale;
mod steps;

use super::Output;
use super::values::Solver;
use anyhow::Result;
use sim_core::SolverChoice;

/// What is measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum Suite {
    /// Stockinette of 20 × 20 stitches pulled by 20 % in 0.2 s
    Pull,
    /// A step of 1 681 loops, stage by stage, by each solver
    Steps,
    /// Steps of stockinette that hangs, in more and more loops
    Growth,
    /// Steps of the sweater and the t-shirt falling on their mannequin, in more and more loops
    Scale,
}

/// Measures and prints.
pub fn run(suite: Suite, most_loops: usize, solver: Option<Solver>, print: Output) -> Result<()> {
    let solver = solver.map(SolverChoice::from);
    match suite {
        Suite::Pull => pull::run(solver.unwrap_or_default(), print),
        Suite::Steps => {
            let both = [SolverChoice::Direct, SolverChoice::Iterative];
            steps::run(solver.as_ref().map_or(&both[..], std::slice::from_ref), print)
        }
        Suite::Growth => growth::run(most_loops, solver.unwrap_or(SolverChoice::Iterative), print),
        Suite::Scale => scale::run(most_loops, solver.unwrap_or_default(), print),
    }
}
