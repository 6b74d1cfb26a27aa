//! The columns of every suite: what steps cost, and what they achieved.

use super::machine::{Machine, peak_mib};
use anyhow::Result;
use cpu_time::ProcessTime;
use serde_json::{Map, Value, json};
use sim_core::{Costs, Facts, STAGES, Simulation};

/// Steps of a simulation, measured.
pub struct Measured {
    loops: usize,
    solver: &'static str,
    adapter: Option<String>,
    costs: Costs,
    /// Time of the processor, over all threads [s].
    cpu_s: f64,
    simulated_s: f64,
    steps: u64,
    rejected: u64,
    facts: Facts,
    /// Largest strain of a segment after any of the steps.
    stretch: f64,
    finite: bool,
    device_bytes: u64,
    peak_mib: Option<f64>,
    compared: Option<String>,
}

impl Measured {
    /// Steps of a fabric of so many loops as long as they are `wanted`.
    pub fn steps(
        machine: &Machine,
        loops: usize,
        simulation: &mut Simulation,
        mut wanted: impl FnMut(&Simulation) -> bool,
    ) -> Result<Self> {
        simulation.measure_costs();
        let began = simulation.progress().clone();
        let (mut cpu_s, mut stretch) = (0.0, 0.0f64);
        while wanted(simulation) {
            let start = ProcessTime::now();
            simulation.step()?;
            cpu_s += start.elapsed().as_secs_f64();
            stretch = stretch.max(simulation.max_stretch()?);
        }
        let costs = simulation.costs();
        Ok(Self {
            loops,
            cpu_s,
            costs,
            solver: simulation.solver(),
            adapter: simulation.adapter().map(str::to_owned),
            simulated_s: simulation.progress().time_s - began.time_s,
            steps: simulation.progress().steps - began.steps,
            rejected: simulation.progress().rejected - began.rejected,
            facts: simulation.facts()?,
            stretch,
            finite: simulation.state()?.is_finite(),
            device_bytes: simulation.device_bytes(),
            peak_mib: peak_mib(),
            compared: machine.compare(&costs),
        })
    }

    fn per_step(&self, sum: f64) -> f64 {
        sum / self.steps.max(1) as f64
    }

    /// Clock time of a step, with what was solved for it in vain [ms].
    fn ms_per_step(&self) -> f64 {
        self.per_step(1e3 * self.costs.stages.iter().map(|t| t.as_secs_f64()).sum::<f64>())
    }

    /// Clock time of a step, of each loop [ms].
    pub fn ms_per_loop(&self) -> f64 {
        self.ms_per_step() / self.loops as f64
    }

    /// Clock time of each stage of a step, by name [ms].
    fn stages(&self) -> impl Iterator<Item = (&'static str, f64)> {
        STAGES.into_iter().zip(self.costs.stages.map(|t| self.per_step(1e3 * t.as_secs_f64())))
    }

    fn iterations(&self) -> f64 {
        self.per_step(self.costs.iterations as f64)
    }

    fn cpu_s_per_stitch_and_sim_s(&self) -> f64 {
        self.cpu_s / (self.loops as f64 * self.simulated_s)
    }

    /// Clock time of so much simulated time [s].
    pub fn clock_s_of(&self, time_s: f64) -> f64 {
        1e-3 * self.ms_per_step() * self.steps as f64 * time_s / self.simulated_s
    }

    /// All columns by name.
    pub fn json(&self) -> Map<String, Value> {
        let stages: Map<String, Value> =
            self.stages().map(|(name, ms)| (name.to_owned(), json!(ms))).collect();
        let columns = [
            ("loops", json!(self.loops)),
            ("solver", json!(self.solver)),
            ("adapter", json!(self.adapter)),
            ("steps", json!(self.steps)),
            ("ms_per_step", json!(self.ms_per_step())),
            ("stages_ms", json!(stages)),
            ("iterations", json!(self.iterations())),
            ("residual", json!(self.costs.residual)),
            ("cpu_s_per_stitch_and_sim_s", json!(self.cpu_s_per_stitch_and_sim_s())),
            ("peak_mib", json!(self.peak_mib)),
            ("device_mib", json!(self.device_bytes as f64 / MIB)),
            ("max_stretch_error", json!(self.stretch)),
            ("min_yarn_distance_over_diameter", json!(self.facts.min_yarn_distance_over_diameter)),
            ("solutions", json!(self.costs.attempts)),
            ("rejected_steps", json!(self.rejected)),
            ("finite", json!(self.finite)),
        ];
        columns.into_iter().map(|(name, value)| (name.to_owned(), value)).collect()
    }

    /// All columns to be read.
    pub fn text(&self) -> String {
        let stages: Vec<String> = self.stages().map(|(name, ms)| format!("{name} {ms:.1}")).collect();
        let on = self.adapter.as_ref().map_or_else(String::new, |adapter| format!(" on {adapter}"));
        let peak = self.peak_mib.map_or_else(String::new, |mib| format!(", {mib:.0} MiB at most"));
        let device = match self.device_bytes {
            0 => String::new(),
            bytes => format!(", {:.0} MiB on the GPU", bytes as f64 / MIB),
        };
        let compared = self.compared.as_ref().map_or_else(String::new, |text| format!("\n  {text}"));
        format!(
            "{} loops, {} solver{on}: {:.1} ms a step ({}), {:.3} ms a loop in 1 000 steps\n  {:.1} iterations, residual {:.1e}, \
             {:.5} s of processor per stitch and simulated second{peak}{device}\n  largest stretch in any step {:.4}, least yarn distance \
             {:.3} diameters, {} steps, {} more solved twice for segments held, {} taken again in smaller ones, {}finite{compared}",
            self.loops,
            self.solver,
            self.ms_per_step(),
            stages.join(", "),
            1e3 * self.ms_per_loop(),
            self.iterations(),
            self.costs.residual,
            self.cpu_s_per_stitch_and_sim_s(),
            self.stretch,
            self.facts.min_yarn_distance_over_diameter,
            self.steps,
            self.costs.attempts.saturating_sub(self.steps + self.rejected),
            self.rejected,
            if self.finite { "" } else { "NOT " },
        )
    }
}

/// [bytes]
const MIB: f64 = 1048576.0;
