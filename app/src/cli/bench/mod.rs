//! Speed of the simulator, beside what it achieved with it.
//!
//! Times of the processor are over all threads, so they compare across machines with other things to do; the quality columns
//! tell whether they were bought with a wrong result.

mod machine;
mod pull;
mod scale;
mod steps;

use super::Output;
use anyhow::Result;
use serde_json::{Map, Value, json};
use sim_core::{Method, STAGES, Simulator};

/// What is measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum Suite {
    /// Stockinette of 20 × 20 stitches pulled by 20 % in 0.2 s
    Pull,
    /// A step of 1 681 loops, stage by stage, by each solver
    Steps,
    /// Steps of the sweater and the t-shirt falling on their mannequin, in more and more loops
    Scale,
}

/// Measures and prints.
pub fn run(suite: Suite, most_loops: usize, print: Output) -> Result<()> {
    match suite {
        Suite::Pull => pull::run(print),
        Suite::Steps => steps::run(print),
        Suite::Scale => scale::run(most_loops, print),
    }
}

/// What a simulator is solved by.
fn solver(simulator: &Simulator) -> &'static str {
    match simulator.method() {
        Method::Direct => "direct",
        Method::Iterative => "iterative",
    }
}

/// Milliseconds of each stage of a step, by name.
fn stages_ms(simulator: &Simulator) -> Map<String, Value> {
    let costs = simulator.costs();
    let per_step = |stage: usize| 1e3 * costs.stages[stage].as_secs_f64() / costs.attempts.max(1) as f64;
    STAGES.iter().enumerate().map(|(i, name)| ((*name).to_owned(), json!(per_step(i)))).collect()
}

/// The stages in a line.
fn stages_text(stages: &Map<String, Value>) -> String {
    let stage = |(name, ms): (&String, &Value)| format!("{name} {:.1}", ms.as_f64().unwrap_or_default());
    stages.iter().map(stage).collect::<Vec<_>>().join(", ")
}
