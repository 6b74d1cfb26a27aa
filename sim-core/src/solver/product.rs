//! Products of the matrix with vectors.
//!
//! Half of the matrix is stored, so each entry counts twice, once for its row and once for its column. Chunks of columns run
//! beside each other into buffers of their own, added up in their order: the sums have the same bits whatever the
//! number of threads. A buffer holds the rows that its chunk has, and no others: seams join the ends of a garment, and buffers
//! from a chunk's first row to its last would in all grow with the square of the garment.

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
        for Chunk { rows, part, .. } in &self.chunks {
            let mut part = &part[..];
            for run in rows {
                let (own, rest) = part.split_at(run.len());
                y[run.clone()].iter_mut().zip(own).for_each(|(y, part)| *y += part);
                part = rest;
            }
        }
        matrix.tail.iter().for_each(|link| link.add(x, y));
    }
}

/// Columns whose part of a product is worked out at once.
struct Chunk {
    nodes: Range<usize>,
    /// The rows that it has, in runs, the first beginning with its own columns.
    rows: Vec<Range<usize>>,
    /// Where the rows of each of its blocks are in `part`.
    place: Vec<u32>,
    /// Their part of the product.
    part: Vec<f64>,
}

impl Chunk {
    fn new(matrix: &BlockMatrix, nodes: Range<usize>) -> Self {
        let blocks = matrix.first_block[nodes.start] as usize..matrix.first_block[nodes.end] as usize;
        let below = &matrix.block_node[blocks];
        let mut all: Vec<u32> = nodes.clone().map(|n| n as u32).chain(below.iter().copied()).collect();
        all.sort_unstable();
        all.dedup();
        let mut first = Vec::with_capacity(all.len());
        let (mut rows, mut count): (Vec<Range<usize>>, usize) = (Vec::new(), 0);
        for node in all.iter().map(|n| *n as usize) {
            let own = matrix.start[node] as usize..matrix.start[node + 1] as usize;
            first.push(count as u32);
            count += own.len();
            match rows.last_mut() {
                Some(run) if run.end == own.start => run.end = own.end,
                _ => rows.push(own),
            }
        }
        let place = below.iter().map(|n| first[all.partition_point(|a| a < n)]).collect();
        Self { nodes, rows, place, part: vec![0.0; count] }
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
        let Self { chunk: Chunk { nodes, place, part, .. }, matrix, x } = self;
        part.fill(0.0);
        let first_block = matrix.first_block[nodes.start] as usize;
        for node in nodes.clone() {
            let own = matrix.start[node] as usize..matrix.start[node + 1] as usize;
            let blocks = matrix.first_block[node] as usize..matrix.first_block[node + 1] as usize;
            let places = &place[blocks.start - first_block..blocks.end - first_block];
            let below = || matrix.block_node[blocks.start + 1..blocks.end].iter().zip(&places[1..]);
            let own_place = places[0] as usize;
            for j in own.clone() {
                let (first, end) = (matrix.column[j] as usize, matrix.column[j + 1] as usize);
                let by = x[j];
                // The diagonal block from its diagonal on, then those below, of which each is a run of rows.
                let mut sum = matrix.value[first] * by;
                let mut at = first + 1;
                let mut run = |at: &mut usize, rows: Range<usize>, place: usize| {
                    let values = &matrix.value[*at..*at + rows.len()];
                    *at += rows.len();
                    let mut sum = 0.0;
                    let part = &mut part[place..place + rows.len()];
                    for ((value, x), part) in values.iter().zip(&x[rows]).zip(part) {
                        sum += value * x;
                        *part += value * by;
                    }
                    sum
                };
                sum += run(&mut at, j + 1..own.end, own_place + j + 1 - own.start);
                for (below, place) in below() {
                    let below = *below as usize;
                    let rows = matrix.start[below] as usize..matrix.start[below + 1] as usize;
                    sum += run(&mut at, rows, *place as usize);
                }
                debug_assert_eq!(at, end);
                part[own_place + j - own.start] += sum;
            }
        }
    }
}
