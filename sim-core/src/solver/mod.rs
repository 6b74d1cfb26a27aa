//! The linear system of a step: a sparse symmetric matrix of node blocks, and two ways to solve it.

#[cfg(test)]
mod agreement;
pub(crate) mod cholesky;
mod gradients;
mod groups;
mod incomplete;
pub(crate) mod matrix;
mod ordering;
mod parts;
mod pattern;
mod product;

use crate::model::Model;
use cholesky::{Cholesky, SolveError};
use incomplete::Incomplete;
use matrix::BlockMatrix;

/// Unknowns above which conjugate gradients are faster than a complete factorisation.
const CROSSOVER: usize = 3000;

/// Solves the systems of one net.
pub(crate) struct Solver {
    /// None for a small system.
    preconditioner: Option<Incomplete>,
    /// Made when it is first needed.
    direct: Option<Cholesky>,
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
        Ok(Self { preconditioner: None, direct: Some(Cholesky::new(model, matrix)?) })
    }

    /// Solves by conjugate gradients, and where they fail by a complete factorisation.
    pub fn iterative(model: &Model, matrix: &BlockMatrix) -> Self {
        Self { preconditioner: Some(Incomplete::new(model, matrix)), direct: None }
    }

    /// Replaces the guess in `x` by the solution of `matrix` x = `rhs`.
    pub fn solve(
        &mut self,
        model: &Model,
        matrix: &BlockMatrix,
        rhs: &[f64],
        x: &mut [f64],
    ) -> Result<(), SolveError> {
        if let Some(preconditioner) = &mut self.preconditioner
            && preconditioner.factorise(matrix).is_ok()
        {
            let nodes = &model.start[..model.net.nodes.len()];
            match gradients::solve(matrix, preconditioner, nodes, rhs, x) {
                Ok(iterations) => {
                    tracing::trace!(iterations, "solved");
                    return Ok(());
                }
                Err(failed) => tracing::debug!(?failed, "solving directly"),
            }
        }
        let direct = match &mut self.direct {
            Some(direct) => direct,
            none => none.insert(Cholesky::new(model, matrix)?),
        };
        x.copy_from_slice(rhs);
        direct.solve(matrix, x)
    }
}
