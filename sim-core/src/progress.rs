//! How far a simulation has come.

use crate::surgery::Surgery;

/// How far a simulation has come, and what has happened to its net on the way.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Progress {
    /// Simulated time [s].
    pub time_s: f64,
    /// Time since the scene began, by which bodies and clamps move [s].
    pub scene_time_s: f64,
    /// Steps taken.
    pub steps: u64,
    /// Steps thrown away and taken again with half the time step.
    pub rejected: u64,
    /// What has been done to the net, and has happened to it.
    pub surgery: Surgery,
}

impl Progress {
    /// One step more, of `h` [s].
    pub(crate) fn add(&mut self, h: f64) {
        self.time_s += h;
        self.scene_time_s += h;
        self.steps += 1;
    }
}
