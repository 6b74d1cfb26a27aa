//! Where experiments are done: simulated time that is counted, and that somebody watches.

use super::report::Report;
use anyhow::{Result, bail};
use sim_core::{Simulator, StepReport};
use std::ops::ControlFlow;

/// Sees how much of an experiment is done, from 0 to 1, and what has been found so far, and may break off.
pub type Watch<'a> = &'a mut dyn FnMut(f64, &Report) -> ControlFlow<()>;

/// A place to work, with the report that grows there.
pub(super) struct Bench<'a> {
    watch: Watch<'a>,
    /// What has been found so far.
    pub report: Report,
    /// Simulated time in all, about, and how much of it has gone by [s].
    planned: f64,
    done: f64,
}

impl<'a> Bench<'a> {
    pub fn new(watch: Watch<'a>) -> Self {
        Self { watch, report: Report::default(), planned: 1.0, done: 0.0 }
    }

    /// Says how much simulated time an experiment takes, about [s].
    pub fn plan(&mut self, seconds: f64) {
        self.planned = seconds;
    }

    /// One step.
    pub fn step(&mut self, simulator: &mut Simulator) -> Result<StepReport> {
        let step = simulator.step()?;
        self.pass(step.time_step)?;
        Ok(step)
    }

    /// Counts simulated time that went by elsewhere [s].
    pub fn pass(&mut self, seconds: f64) -> Result<()> {
        self.done += seconds;
        if (self.watch)((self.done / self.planned).min(1.0), &self.report).is_break() {
            bail!("stopped");
        }
        Ok(())
    }

    /// Lets time go by [s].
    pub fn run(&mut self, simulator: &mut Simulator, seconds: f64) -> Result<()> {
        let end = simulator.time_s() + seconds;
        while simulator.time_s() < end - 1e-9 {
            self.step(simulator)?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Experiment, Setup};
    use std::ops::ControlFlow;

    #[test]
    fn a_watch_that_breaks_off_is_not_asked_again() {
        let mut asked = 0;
        let result = Experiment::RibDrawIn.run(&Setup::default(), &mut |done, _| {
            asked += 1;
            assert!((0.0..=1.0).contains(&done));
            if asked < 3 { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
        });
        assert!(result.is_err_and(|e| e.to_string().contains("stopped")));
        assert_eq!(asked, 3);
    }
}
