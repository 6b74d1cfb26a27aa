//! The linear system of a step: a sparse symmetric matrix of node blocks, and two ways to solve it.
//!
//! # Theory
//! A complete factorisation of n unknowns takes some n^1.5 operations. Conjugate gradients with an incomplete one take
//! time in proportion to n, since what makes the system hard is local: axial stretch. They solve all but small systems; the
//! complete factorisation solves those, and any that the iterations fail on.
//!
//! # Practice
//! Measured at h = 5 ms on two busy cores, a step in all:
//!
//! | fabric | complete | incomplete | iterations |
//! |---|---|---|---|
//! | 8 × 8 | 7.2 ms | 5.6 ms | 14 |
//! | 16 × 16 | 22 ms | 20 ms | 14 |
//! | 24 × 24 | 70 … 84 ms | 50 … 57 ms | 13 |
//! | 56 × 56 | 740 … 780 ms | 240 … 460 ms | 20 |
//! | tube, 60 × 60 | 1 100 ms | 440 ms | 15 … 19 |
//!
//! - Blocks of two courses of a wale, taken from the net, and single precision do for plain, rib, garter, seed and twisted
//!   fabric, tubes and increases: 9 … 20 iterations, as many at any size.
//! - Without fill, IC(0), there are blocks that are not positive definite even in stockinette, and 52 … 300 iterations (of
//!   24 with one level of fill, to 1e-6). Stacks of three and gathered rows stay hard with one level: 46 … 48.
//! - Half of the time of an iteration and more is that of reading the factor (36 MB for 3 600 loops), so a second
//!   thread helps only as far as memory does.

#[cfg(test)]
mod agreement;
pub(crate) mod cholesky;
pub(crate) mod gradients;
pub(crate) mod groups;
mod incomplete;
pub(crate) mod matrix;
mod ordering;
mod parts;
mod pattern;
pub(crate) mod product;
pub(crate) mod tail;

use crate::model::Model;
use cholesky::{Cholesky, SolveError};
use gradients::Preconditioner;
use incomplete::Incomplete;
use matrix::BlockMatrix;

/// Unknowns above which conjugate gradients are faster than a complete factorisation.
const CROSSOVER: usize = 3000;

/// Systems solved directly after one that conjugate gradients failed on: what made that one hard is still there in the next
/// few, and trying in vain costs as much as solving.
const DIRECT_AFTER_FAILURE: u32 = 8;

/// Iterations after which to give up; by then a direct solution would have been faster.
const MOST_ITERATIONS: usize = 80;

/// Iterations after which to give up with a complete factorisation, which leaves only the tail to them.
const MOST_ITERATIONS_OF_TAIL: usize = 400;

/// Solves the systems of one net.
pub(crate) struct Solver {
    /// None for a small system.
    preconditioner: Option<Incomplete>,
    /// Made when it is first needed.
    direct: Option<Cholesky>,
    /// Systems to go before conjugate gradients are tried again.
    direct_for: u32,
}

impl Solver {
    /// The faster solver for systems with the pattern of `matrix`.
    pub fn new(model: &Model, matrix: &BlockMatrix) -> Result<Self, SolveError> {
        if matrix.dof_count() > CROSSOVER {
            Ok(Self::iterative(model, matrix))
        } else {
            Self::direct(model, matrix)
        }
    }

    /// Solves by a complete factorisation.
    pub fn direct(model: &Model, matrix: &BlockMatrix) -> Result<Self, SolveError> {
        Ok(Self { preconditioner: None, direct: Some(Cholesky::new(model, matrix)?), direct_for: 0 })
    }

    /// Solves by conjugate gradients, and where they fail by a complete factorisation.
    pub fn iterative(model: &Model, matrix: &BlockMatrix) -> Self {
        Self { preconditioner: Some(Incomplete::new(model, matrix)), direct: None, direct_for: 0 }
    }

    /// Replaces the guess in `x` by the solution of `matrix` x = `rhs`.
    pub fn solve(
        &mut self,
        model: &Model,
        matrix: &BlockMatrix,
        rhs: &[f64],
        x: &mut [f64],
    ) -> Result<(), SolveError> {
        let nodes = &model.start[..model.net.nodes.len()];
        if self.direct_for > 0 {
            self.direct_for -= 1;
        } else if let Some(preconditioner) = &mut self.preconditioner {
            if preconditioner.factorise(matrix).is_ok()
                && gradients::solve(matrix, preconditioner, nodes, rhs, x, MOST_ITERATIONS).is_ok()
            {
                return Ok(());
            }
            tracing::debug!("conjugate gradients failed, solving directly");
            self.direct_for = DIRECT_AFTER_FAILURE;
        }
        let direct = match &mut self.direct {
            Some(direct) => direct,
            none => none.insert(Cholesky::new(model, matrix)?),
        };
        direct.factorise(matrix)?;
        if matrix.tail.is_empty() {
            direct.apply(rhs, x);
            return Ok(());
        }
        gradients::solve(matrix, direct, nodes, rhs, x, MOST_ITERATIONS_OF_TAIL)
            .map(|_| ())
            .map_err(|_| SolveError::NotConverged)
    }
}
