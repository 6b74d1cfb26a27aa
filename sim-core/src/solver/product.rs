//! Products of the matrix with vectors.
//!
//! Half of the matrix is stored, so each entry counts twice, once for its row and once for its column. Chunks of columns run
//! beside each other into buffers of their own, added up in their order: the sums have the same bits whatever the
//! number of threads.

use super::matrix::BlockMatrix;
use rayon::prelude::*;
use std::ops::Range;

/// Nodes in a chunk.
const CHUNK: usize = 8192;

/// Products of a matrix with vectors.
pub(crate) struct Product {
    chunks: Vec<Chunk>,
}

impl Product {
    /// Buffers for `matrix`.
    pub fn new(matrix: &BlockMatrix) -> Self {
        let count = matrix.start.len() - 1;
        let chunk = |first: usize| Chunk::new(matrix, first..count.min(first + CHUNK));
        Self { chunks: (0..count).step_by(CHUNK).map(chunk).collect() }
    }

    /// Sets `y` to `matrix` times `x`.
    pub fn set(&mut self, matrix: &BlockMatrix, x: &[f64], y: &mut [f64]) {
        match &mut self.chunks[..] {
            [one] => one.multiply(matrix, x),
            many => many.par_iter_mut().for_each(|chunk| chunk.multiply(matrix, x)),
        }
        y.fill(0.0);
        for Chunk { unknowns, part, .. } in &self.chunks {
            for (y, part) in y[unknowns.start..].iter_mut().zip(part) {
                *y += part;
            }
        }
        matrix.tail.iter().for_each(|link| link.add(x, y));
    }
}

/// Columns whose part of a product is worked out at once.
struct Chunk {
    nodes: Range<usize>,
    unknowns: Range<usize>,
    /// Their part of the product, from their first row on.
    part: Vec<f64>,
}

impl Chunk {
    fn new(matrix: &BlockMatrix, nodes: Range<usize>) -> Self {
        let unknowns = matrix.start[nodes.start] as usize..matrix.start[nodes.end] as usize;
        let entries = matrix.column[unknowns.start] as usize..matrix.column[unknowns.end] as usize;
        let last = matrix.row[entries].iter().max().map_or(unknowns.end, |row| *row as usize + 1);
        Self { nodes, part: vec![0.0; last - unknowns.start], unknowns }
    }

    fn multiply(&mut self, matrix: &BlockMatrix, x: &[f64]) {
        pulp::Arch::new().dispatch(Multiplication { chunk: self, matrix, x });
    }
}

struct Multiplication<'a> {
    chunk: &'a mut Chunk,
    matrix: &'a BlockMatrix,
    x: &'a [f64],
}

impl pulp::WithSimd for Multiplication<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, _: S) {
        let Self { chunk: Chunk { nodes, unknowns, part }, matrix, x } = self;
        part.fill(0.0);
        for node in nodes.clone() {
            let own = matrix.start[node] as usize..matrix.start[node + 1] as usize;
            let blocks = matrix.first_block[node] as usize..matrix.first_block[node + 1] as usize;
            for j in own.clone() {
                let (first, end) = (matrix.column[j] as usize, matrix.column[j + 1] as usize);
                let by = x[j];
                // The diagonal block from its diagonal on, then those below, of which each is a run of rows.
                let mut sum = matrix.value[first] * by;
                let mut at = first + 1;
                let mut run = |at: &mut usize, rows: Range<usize>| {
                    let values = &matrix.value[*at..*at + rows.len()];
                    *at += rows.len();
                    let mut sum = 0.0;
                    let rows_of_part = &mut part[rows.start - unknowns.start..rows.end - unknowns.start];
                    for ((value, x), part) in values.iter().zip(&x[rows]).zip(rows_of_part) {
                        sum += value * x;
                        *part += value * by;
                    }
                    sum
                };
                sum += run(&mut at, j + 1..own.end);
                for below in &matrix.block_node[blocks.start + 1..blocks.end] {
                    let below = *below as usize;
                    sum += run(&mut at, matrix.start[below] as usize..matrix.start[below + 1] as usize);
                }
                debug_assert_eq!(at, end);
                part[j - unknowns.start] += sum;
            }
        }
    }
}
