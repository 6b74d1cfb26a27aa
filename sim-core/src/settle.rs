//! Simulating until a fabric is as good as still.

use crate::progress::Progress;
use crate::simulator::{SimError, StepReport};
use std::ops::ControlFlow;

/// Steps between two looks at the speed.
const INTERVAL: u64 = 10;

/// How far settling has come.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SettleProgress {
    /// Simulated time since the start [s].
    pub time_s: f64,
    /// Root-mean-square speed of the yarn [m/s].
    pub speed: f64,
}

/// When a fabric counts as settled.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SettleGoal {
    /// Root-mean-square speed of the yarn to come under [m/s].
    pub speed: f64,
    /// Simulated time after which to stop anyway [s].
    pub time_limit_s: f64,
}

/// How settling ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Settled {
    /// The fabric is as good as still.
    Still,
    /// The time limit came first.
    TimeLimit,
    /// The caller stopped it.
    Interrupted,
}

/// A simulation that can settle.
pub(crate) trait Settles {
    fn step(&mut self) -> Result<StepReport, SimError>;
    fn progress(&self) -> &Progress;
    /// Root-mean-square speed of the yarn [m/s].
    fn speed(&mut self) -> Result<f64, SimError>;
}

/// Steps until the fabric is as good as still, the time limit, or until `progress` breaks off.
pub(crate) fn settle(
    simulation: &mut impl Settles,
    goal: SettleGoal,
    progress: &mut dyn FnMut(SettleProgress) -> ControlFlow<()>,
) -> Result<Settled, SimError> {
    let start = simulation.progress().time_s;
    loop {
        simulation.step()?;
        let time_s = simulation.progress().time_s - start;
        if simulation.progress().steps.is_multiple_of(INTERVAL) {
            let speed = simulation.speed()?;
            if progress(SettleProgress { time_s, speed }).is_break() {
                return Ok(Settled::Interrupted);
            }
            if speed < goal.speed {
                return Ok(Settled::Still);
            }
        }
        if time_s >= goal.time_limit_s {
            return Ok(Settled::TimeLimit);
        }
    }
}
