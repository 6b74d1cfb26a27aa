//! The linear system of a step: a sparse symmetric matrix of node blocks, and its factorisation.

pub(crate) mod cholesky;
pub(crate) mod matrix;
mod ordering;
