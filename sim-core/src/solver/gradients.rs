//! Conjugate gradients.
//!
//! # Theory
//! Hestenes and Stiefel, preconditioned with M ≈ A. √(r · M⁻¹ r) estimates the error in the norm of the energy; it is
//! compared with √(b · x), the norm of the solution itself.
//!
//! A solution stopped early lacks some of the motion of the fabric as a whole, which costs no energy and is noticed
//! first: without this, free fabric drifts. So in the end the error is made exactly zero along the three
//! translations t, by x += T (Tᵀ A T)⁻¹ Tᵀ r.

use super::matrix::BlockMatrix;
use super::product::Product;
use super::vectors::{combine, dot};
use glam::DVec3;

/// A matrix M near A that is easily inverted.
pub(crate) trait Preconditioner {
    /// Sets `z` to M⁻¹ `r`.
    fn apply(&mut self, r: &[f64], z: &mut [f64]);
}

/// The iterations did not reach the tolerance, or the matrix is not positive definite.
#[derive(Debug)]
pub(crate) struct NotConverged {
    pub iterations: usize,
}

/// How a solution was found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Solved {
    pub iterations: usize,
    /// Estimate of the error in the norm of the energy, relative to the solution.
    pub error: f64,
}

/// Solves `matrix` x = `b` from the guess in `x` to a relative `tolerance`, in `most` iterations or not at all. `nodes` are
/// the first unknowns of all nodes.
pub(crate) fn solve(
    matrix: &BlockMatrix,
    preconditioner: &mut impl Preconditioner,
    nodes: &[u32],
    b: &[f64],
    x: &mut [f64],
    (most, tolerance): (usize, f64),
) -> Result<Solved, NotConverged> {
    let mut product = Product::new(matrix);
    let mut z = vec![0.0; b.len()];
    let mut q = vec![0.0; b.len()];
    product.set(matrix, x, &mut q);
    let mut r: Vec<f64> = b.iter().zip(&q).map(|(b, q)| b - q).collect();
    preconditioner.apply(&r, &mut z);
    let mut error = dot(&r, &z);
    let mut p = z.clone();
    let mut iterations = 0;
    while error.is_nan() || error > tolerance.powi(2) * dot(b, x).abs() {
        product.set(matrix, &p, &mut q);
        let curvature = dot(&p, &q);
        if iterations == most || !(curvature > 0.0 && error.is_finite()) {
            return Err(NotConverged { iterations });
        }
        let step = error / curvature;
        combine(1.0, x, step, &p);
        combine(1.0, &mut r, -step, &q);
        preconditioner.apply(&r, &mut z);
        let next = dot(&r, &z);
        combine(next / error, &mut p, 1.0, &z);
        error = next;
        iterations += 1;
    }
    translate(matrix, nodes, &r, x);
    Ok(Solved { iterations, error: (error / dot(b, x).abs().max(f64::MIN_POSITIVE)).sqrt() })
}

/// Makes the error of `x` zero along translations, `r` being the residual.
fn translate(matrix: &BlockMatrix, nodes: &[u32], r: &[f64], x: &mut [f64]) {
    let residual: DVec3 = nodes.iter().map(|n| DVec3::from_slice(&r[*n as usize..])).sum();
    let shift = matrix.translated().inverse() * residual;
    if shift.is_finite() {
        for n in nodes {
            for axis in 0..3 {
                x[*n as usize + axis] += shift[axis];
            }
        }
    }
}
