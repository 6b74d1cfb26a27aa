//! Making a factor: the elimination of groups, one after the other.
//!
//! # Theory
//! A front is opened, with what the matrix has there, when something is first taken away from it, and given up when its own group has
//! been eliminated and packed. (Duff and Reid, *The Multifrontal Solution of Indefinite Sparse Symmetric Linear Equations*, keep what
//! children hand on; here it is taken from later fronts at once.) With nested dissection the open fronts are the separators around what is
//! being eliminated, of large fabrics a small part of the factor; where elimination goes through the fabric like a wave they are its crest.
//!
//! # Practice
//! All fronts together, in single precision, would take twice the memory of the packed factor.

use super::factor::NoFactor;
use super::matrix::BlockMatrix;
use super::packed::{Tile, pack};
use super::panel;
use super::pattern::{Change, Group, Part, Pattern, Run};
use faer::linalg::matmul::{matmul, triangular};
use faer::prelude::ReborrowMut;
use faer::{Accum, MatMut, MatRef, Par};
use std::ops::Range;
use triangular::BlockStructure::{Rectangular, TriangularLower};

/// The fronts of consecutive groups, of which some are open.
pub(crate) struct Fronts {
    /// The first group.
    first: usize,
    /// The fronts, empty before and after they are open.
    open: Vec<Vec<f32>>,
}

impl Fronts {
    /// None is open.
    pub fn new(groups: &Range<usize>) -> Self {
        Self { first: groups.start, open: vec![Vec::new(); groups.len()] }
    }

    /// The front of a group, opened with what it begins with if it is not.
    fn opened(&mut self, group: usize, begin: impl FnOnce() -> Vec<f32>) -> &mut Vec<f32> {
        let front = &mut self.open[group - self.first];
        if front.is_empty() {
            *front = begin();
        }
        front
    }

    /// Adds what was done to the same fronts elsewhere.
    pub fn add(&mut self, changes: Self, begin: impl Fn(usize) -> Vec<f32>) {
        for (group, change) in (self.first..).zip(changes.open).filter(|(_, change)| !change.is_empty()) {
            self.opened(group, || begin(group)).iter_mut().zip(change).for_each(|(x, change)| *x += change);
        }
    }
}

/// What of a factor belongs to a part, packed.
pub(crate) struct Packs<'a> {
    pub tiles: &'a mut [Tile],
    pub columns: &'a mut [[f32; 2]],
}

/// A factorisation that is being made.
pub(crate) struct Elimination<'a> {
    pub pattern: &'a Pattern,
    pub matrix: &'a BlockMatrix,
    /// What makes the diagonal of the matrix 1, [dof_count].
    pub scale: &'a [f64],
    /// What is then added to it.
    pub shift: f32,
}

impl Elimination<'_> {
    /// The front of a group with what the matrix has there.
    pub fn filled(&self, group: usize) -> Vec<f32> {
        let Self { pattern, matrix, scale, shift } = self;
        let group = &pattern.groups[group];
        let (width, height) = (group.unknowns.len(), group.height());
        let mut front = vec![0.0; width * height];
        for block in &pattern.blocks[group.blocks.clone()] {
            let [rows, columns] =
                block.nodes.map(|n| matrix.start[n as usize] as usize..matrix.start[n as usize + 1] as usize);
            let [row, column] = block.at.map(|at| at as usize);
            // Above the diagonal is nothing, and the rows of the matrix can be the columns of the front.
            let (by_row, by_column, at) = match row < column {
                true => (height, 1, row * height + column),
                false => (1, height, column * height + row),
            };
            for (j, own) in columns.clone().enumerate() {
                let first = if row == column { j } else { 0 };
                let place = matrix.place(columns.start as u32, block.offset, first as u32, j as u32);
                for (i, value) in (first..rows.len()).zip(&matrix.value[place..]) {
                    let scaled = value * scale[own] * scale[rows.start + i];
                    front[at + i * by_row + j * by_column] = scaled as f32;
                }
            }
        }
        front.iter_mut().step_by(height + 1).take(width).for_each(|diagonal| *diagonal += shift);
        front
    }

    /// Factorises the fronts of a part. Gives what that does to the joint, beyond its own.
    pub fn eliminate(&self, part: &Part, mut fronts: Fronts, packs: Packs) -> Result<Fronts, NoFactor> {
        let groups = &self.pattern.groups;
        let mut joint = Fronts::new(&self.pattern.parts.last().map_or(0..0, |p| p.groups.clone()));
        let (mut inverse, mut product) = (Vec::new(), Vec::new());
        for number in part.groups.clone() {
            let group = &groups[number];
            let (n, m) = (group.unknowns.len(), group.rows.len());
            let mut front = std::mem::take(fronts.opened(number, || self.filled(number)));
            inverse.resize(n * n, 0.0);
            panel::eliminate(&mut front, &mut inverse, n).map_err(|_| NoFactor)?;
            let scale = &mut packs.columns[group.unknowns.start - part.unknowns.start..][..n];
            let packed = group.tiles.start - part.tiles.start..group.tiles.end - part.tiles.start;
            pack(&inverse, &front, scale, &mut packs.tiles[packed]);
            let rows = MatRef::from_column_major_slice(&front, n + m, n).subrows(n, m);
            for changes in group.changes.chunk_by(|a, b| !a.in_place && !b.in_place) {
                let first = changes[0].columns.start as usize;
                let (height, width) = (m - first, changes[changes.len() - 1].columns.end as usize - first);
                let (below, beside) = (rows.subrows(first, height), rows.subrows(first, width).transpose());
                if !changes[0].in_place {
                    product.resize(height * width, 0.0);
                    multiply(&mut product, below, beside);
                }
                for change in changes {
                    let number = change.group as usize;
                    let later = &groups[number];
                    let front = match part.groups.contains(&number) {
                        true => fronts.opened(number, || self.filled(number)),
                        false => joint.opened(number, || vec![0.0; later.unknowns.len() * later.height()]),
                    };
                    if change.in_place {
                        change.work_out(below, beside, &group.rows, later, front);
                    } else {
                        change.add(&product, height, first, &group.rows, later, front);
                    }
                }
            }
        }
        Ok(joint)
    }
}

/// Sets the first columns of the product of `rows` with themselves, from their diagonal down, to what is taken away.
fn multiply(product: &mut [f32], rows: MatRef<f32>, beside: MatRef<f32>) {
    let (height, width) = (rows.nrows(), beside.ncols());
    let (diagonal, below) =
        MatMut::from_column_major_slice_mut(product, height, width).split_at_row_mut(width);
    triangular::matmul(
        diagonal,
        TriangularLower,
        Accum::Replace,
        rows.subrows(0, width),
        Rectangular,
        beside,
        Rectangular,
        -1.0,
        Par::Seq,
    );
    if height > width {
        matmul(below, Accum::Replace, rows.subrows(width, height - width), beside, -1.0, Par::Seq);
    }
}

impl Change {
    /// Works out the product of rows of a group with those `beside` and takes it away from the front of a `later` one.
    fn work_out(
        &self,
        below: MatRef<f32>,
        beside: MatRef<f32>,
        rows: &[u32],
        later: &Group,
        front: &mut [f32],
    ) {
        let column = rows[self.columns.start as usize] as usize - later.unknowns.start;
        let (width, height) = (self.columns.len(), later.height());
        let front = &mut front[column * height..(column + width) * height];
        let mut front = MatMut::from_column_major_slice_mut(front, height, width);
        for run in &self.runs {
            let [from, to, len] = [run.from - self.columns.start, run.to, run.len].map(|x| x as usize);
            let changed = front.rb_mut().subrows_mut(to, len);
            matmul(changed, Accum::Add, below.subrows(from, len), beside, -1.0, Par::Seq);
        }
    }

    /// Adds what is in `product`, of so many rows, of which the first row and column are number `first`, to the front of a `later` one.
    fn add(
        &self,
        product: &[f32],
        height: usize,
        first: usize,
        rows: &[u32],
        later: &Group,
        front: &mut [f32],
    ) {
        for j in self.columns.clone().map(|j| j as usize) {
            let start = later.height() * (rows[j] as usize - later.unknowns.start);
            let column = &mut front[start..start + later.height()];
            let product = &product[(j - first) * height..(j - first + 1) * height];
            for Run { from, to, len } in &self.runs {
                // Above the diagonal is nothing.
                let [from, to, len] = [*from, *to, *len].map(|x| x as usize);
                let skipped = j.saturating_sub(from).min(len);
                let changed = &mut column[to + skipped..to + len];
                let by = &product[from + skipped - first..from + len - first];
                changed.iter_mut().zip(by).for_each(|(entry, change)| *entry += change);
            }
        }
    }
}
