//! A sparse symmetric matrix with a fixed pattern of node blocks, and a tail without one.
//!
//! Only the lower triangle is stored, by columns, as the factorisation wants it. Node blocks are full, so the place of an
//! entry follows from the place of its block: in the first column of node J the rows of the blocks I ≥ J follow each other,
//! and each further column of J begins one row later. An entry (i of I, j of J) therefore lies at
//! `column(J, j) + block(I, J) + i − j`.

use super::tail::Link;
use crate::model::Model;
use glam::DMat3;

/// The lower triangle of a symmetric matrix.
#[derive(Clone, Debug)]
pub(crate) struct BlockMatrix {
    /// First unknown of each node, [node_count + 1].
    pub start: Vec<u32>,
    /// First entry of each column, [dof_count + 1].
    pub column: Vec<u32>,
    /// Each entry.
    pub value: Vec<f64>,
    /// Blocks outside of the pattern.
    pub tail: Vec<Link>,
    /// Blocks under the diagonal of each node, first of them, [node_count + 1].
    pub first_block: Vec<u32>,
    /// Node of each block's rows, ascending within a column.
    pub block_node: Vec<u32>,
    /// Place of each block in the first column of its node.
    block_offset: Vec<u32>,
}

impl BlockMatrix {
    /// A zero matrix with the pattern of `model`.
    pub fn new(model: &Model) -> Self {
        let start = model.start.clone();
        let mut matrix = Self {
            column: vec![0],
            value: Vec::new(),
            tail: Vec::new(),
            first_block: vec![0],
            block_node: Vec::new(),
            block_offset: Vec::new(),
            start,
        };
        let mut count = 0;
        for (node, rows) in model.neighbours.iter().enumerate() {
            let mut offset = 0;
            for &below in rows {
                matrix.block_node.push(below);
                matrix.block_offset.push(offset);
                offset += matrix.size(below as usize);
            }
            matrix.first_block.push(matrix.block_node.len() as u32);
            // The rows of all blocks, in each further column one less.
            for above in 0..matrix.size(node) {
                count += offset - above;
                matrix.column.push(count);
            }
        }
        matrix.value = vec![0.0; count as usize];
        matrix
    }

    /// Number of unknowns of a node.
    fn size(&self, node: usize) -> u32 {
        self.start[node + 1] - self.start[node]
    }

    /// Number of unknowns.
    pub fn dof_count(&self) -> usize {
        self.column.len() - 1
    }

    /// The blocks under the diagonal of a node and that on it: the node of their rows and their place in the first column.
    pub fn blocks(&self, column: usize) -> impl Iterator<Item = (u32, u32)> {
        let blocks = self.first_block[column] as usize..self.first_block[column + 1] as usize;
        self.block_node[blocks.clone()].iter().copied().zip(self.block_offset[blocks].iter().copied())
    }

    /// Place of the block (`row`, `column`), `row` ≥ `column`, in the first column of its node. Part of the pattern, or it
    /// is a mistake in the model.
    pub fn block(&self, row: usize, column: usize) -> u32 {
        let blocks = self.first_block[column] as usize..self.first_block[column + 1] as usize;
        let at = self.block_node[blocks.clone()].partition_point(|node| (*node as usize) < row);
        debug_assert_eq!(self.block_node[blocks.start + at] as usize, row);
        self.block_offset[blocks.start + at]
    }

    /// Place of the entry (i, j) of the block at `block` in the column of the node whose unknowns start at `start`. The places
    /// of further rows follow; a diagonal block has those with i ≥ j.
    #[inline]
    pub fn place(&self, start: u32, block: u32, i: u32, j: u32) -> usize {
        (self.column[(start + j) as usize] + block + i) as usize - j as usize
    }

    /// Tᵀ A T for the three translations T of all nodes: the sum of what joins positions to positions.
    pub fn translated(&self) -> DMat3 {
        let mut sum = DMat3::ZERO;
        for node in 0..self.start.len() - 1 {
            for j in 0..3 {
                for (k, (_, offset)) in self.blocks(node).enumerate() {
                    // What lies below the diagonal counts for what lies above it too.
                    for i in if k == 0 { j } else { 0 }..3 {
                        let entry = self.value[self.place(self.start[node], offset, i as u32, j as u32)];
                        sum.col_mut(j)[i] += entry;
                        if k > 0 || i > j {
                            sum.col_mut(i)[j] += entry;
                        }
                    }
                }
            }
        }
        // Of a contact the diagonal blocks are in the sum, and should not be: it resists no common motion.
        self.tail.iter().for_each(|link| sum -= 2.0 * link.block);
        sum
    }

    /// Row, column and value of each entry of the pattern.
    #[cfg(test)]
    pub fn entries(&self) -> impl Iterator<Item = (usize, usize, f64)> {
        let columns = (0..self.start.len() - 1).flat_map(move |node| {
            (0..self.size(node)).flat_map(move |j| self.blocks(node).map(move |block| (node, j, block)))
        });
        columns.flat_map(move |(node, j, (row, offset))| {
            let first = if row as usize == node { j } else { 0 };
            (first..self.size(row as usize)).map(move |i| {
                let at = [self.start[row as usize] + i, self.start[node] + j].map(|unknown| unknown as usize);
                (at[0], at[1], self.value[self.place(self.start[node], offset, i, j)])
            })
        })
    }

    /// Adds to a diagonal entry.
    pub fn add_diagonal(&mut self, dof: usize, value: f64) {
        self.value[self.column[dof] as usize] += value;
    }
}
