//! Conjugate gradients, preconditioned with the inverse blocks of the diagonal.

use super::system::{CHUNK, Small, System};
use rayon::prelude::*;

/// Buffers of the solver.
pub(super) struct Conjugate<const D: usize> {
    /// The solution of the last call, [vertex_count].
    pub solution: Vec<Small<D>>,
    residual: Vec<Small<D>>,
    direction: Vec<Small<D>>,
    product: Vec<Small<D>>,
}

impl<const D: usize> Conjugate<D> {
    pub fn new(count: usize) -> Self {
        let zero = || vec![[0.0; D]; count];
        Self { solution: zero(), residual: zero(), direction: zero(), product: zero() }
    }

    /// Solves matrix · solution = force until the residual, measured with the preconditioner, is `tolerance` of what it was,
    /// or after `most` iterations; any iterate is a direction of descent. Gives the number of iterations.
    pub fn solve(&mut self, system: &System<D>, tolerance: f64, most: usize) -> usize {
        self.solution.fill([0.0; D]);
        self.residual.copy_from_slice(&system.force);
        let mut rz = self.turn(system, 0.0);
        let goal = tolerance * tolerance * rz;
        for iteration in 0..most {
            if rz <= goal || !rz.is_normal() {
                return iteration;
            }
            let curvature = system.product(&self.direction, &mut self.product);
            if curvature.is_nan() || curvature <= 0.0 {
                return iteration;
            }
            let alpha = rz / curvature;
            let parts = (
                self.solution.par_chunks_mut(CHUNK),
                self.residual.par_chunks_mut(CHUNK),
                self.direction.par_chunks(CHUNK),
                self.product.par_chunks(CHUNK),
            );
            let dots = parts.into_par_iter().enumerate().map(|(chunk, (x, r, p, ap))| {
                let mut dot = 0.0;
                for i in 0..x.len() {
                    for d in 0..D {
                        x[i][d] += alpha * p[i][d];
                        r[i][d] -= alpha * ap[i][d];
                    }
                    let z = system.precondition(chunk * CHUNK + i, &r[i]);
                    (0..D).for_each(|d| dot += r[i][d] * z[d]);
                }
                dot
            });
            let next: f64 = dots.collect::<Vec<f64>>().iter().sum();
            self.advance(system, next / rz);
            rz = next;
        }
        most
    }

    /// Sets the direction to z + beta · direction, and gives r·z.
    fn turn(&mut self, system: &System<D>, beta: f64) -> f64 {
        self.advance(system, beta);
        self.residual.iter().zip(&self.direction).map(|(r, z)| (0..D).map(|d| r[d] * z[d]).sum::<f64>()).sum()
    }

    fn advance(&mut self, system: &System<D>, beta: f64) {
        let parts = (self.direction.par_chunks_mut(CHUNK), self.residual.par_chunks(CHUNK));
        parts.into_par_iter().enumerate().for_each(|(chunk, (p, r))| {
            for i in 0..p.len() {
                let z = system.precondition(chunk * CHUNK + i, &r[i]);
                for d in 0..D {
                    p[i][d] = z[d] + beta * p[i][d];
                }
            }
        });
    }
}
