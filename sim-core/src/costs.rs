//! What steps cost, stage by stage.

use std::time::{Duration, Instant};

/// What the steps of a simulator have cost so far, those that were thrown away included.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Costs {
    /// Time on the clock in each stage.
    pub stages: [Duration; STAGES.len()],
    /// Steps tried: those that went well, those solved before with fewer segments held, those taken again in smaller ones.
    pub attempts: u64,
    /// Iterations of conjugate gradients in all.
    pub iterations: u64,
    /// Memory read by these and at their beginnings on the CPU: factors forwards and backwards, and matrices once [bytes].
    pub bytes: u64,
    /// Operations of the factorisations on the CPU, a multiplication and an addition being two.
    pub operations: u64,
    /// Error of the last solution in the norm of the energy, relative to the solution itself, as the iterations estimate it.
    pub residual: f64,
}

/// The names of the stages of [`Costs::stages`], one after the other.
pub const STAGES: [&str; 6] = ["assembly", "friction", "contacts", "factorisation", "iterations", "rest"];

/// A stage of a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Stage {
    /// Elements, and their sum.
    Assembly,
    /// Compression, normals and friction springs.
    Friction,
    /// Layers, bodies, pins.
    Contacts,
    /// Factorisation of the matrix, and before the first complete one its layout.
    Factorisation,
    /// Conjugate gradients.
    Iterations,
    /// Everything else.
    Rest,
}

/// Measures stages that follow each other.
pub(crate) struct Watch(Instant);

impl Watch {
    /// Starts to measure.
    pub fn start() -> Self {
        Self(Instant::now())
    }

    /// Adds the time since the last lap to a stage.
    pub fn lap(&mut self, costs: &mut Costs, stage: Stage) {
        let now = Instant::now();
        costs.stages[stage as usize] += now - self.0;
        self.0 = now;
    }
}
