//! Products of the matrix with vectors.
//!
//! Half of the matrix is stored, so each entry counts twice, once for its row and once for its column. Chunks of columns run
//! beside each other into buffers of their own, added up in their order: the sums have the same bits whatever the
//! number of threads.

use super::matrix::BlockMatrix;
use rayon::prelude::*;

/// Columns whose part of a product is worked out at once.
const CHUNK: usize = 4096;

/// Products of a matrix with vectors.
pub(crate) struct Product {
    /// For each chunk its first row, and its part of the product from there on.
    chunks: Vec<(usize, Vec<f64>)>,
}

impl Product {
    /// Buffers for `matrix`.
    pub fn new(matrix: &BlockMatrix) -> Self {
        let chunk = |first: usize| {
            let end = matrix.dof_count().min(first + CHUNK);
            let entries = matrix.column[first] as usize..matrix.column[end] as usize;
            let last = matrix.row[entries].iter().max().map_or(end, |row| *row as usize + 1);
            (first, vec![0.0; last - first])
        };
        Self { chunks: (0..matrix.dof_count()).step_by(CHUNK).map(chunk).collect() }
    }

    /// Sets `y` to `matrix` times `x`.
    pub fn set(&mut self, matrix: &BlockMatrix, x: &[f64], y: &mut [f64]) {
        self.chunks.par_iter_mut().for_each(|(first, part)| {
            part.fill(0.0);
            for j in *first..x.len().min(*first + CHUNK) {
                let (diagonal, end) = (matrix.column[j] as usize, matrix.column[j + 1] as usize);
                let mut sum = matrix.value[diagonal] * x[j];
                let below = diagonal + 1..end;
                for (value, row) in matrix.value[below.clone()].iter().zip(&matrix.row[below]) {
                    let row = *row as usize;
                    sum += value * x[row];
                    part[row - *first] += value * x[j];
                }
                part[j - *first] += sum;
            }
        });
        y.fill(0.0);
        for (first, part) in &self.chunks {
            y[*first..].iter_mut().zip(part).for_each(|(y, part)| *y += part);
        }
        matrix.tail.iter().for_each(|link| link.add(x, y));
    }
}
