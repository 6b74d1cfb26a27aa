//! Block incomplete Cholesky factorisation: a cheap approximation of the system to precondition conjugate gradients with.
//!
//! # Theory
//! As the complete factorisation L Lᵀ, except that products without a place in the [`Pattern`] are dropped. For a group with the
//! diagonal block D and the rows P below it: factorise D = C Cᵀ, turn P into Q = P C⁻ᵀ, and subtract Q Qᵀ from later fronts.
//! Stored is the front G = (C⁻¹; Q C⁻¹): with it both directions of L Lᵀ z = r are one product of a matrix with a vector for each
//! group, forwards (y; t) = G r, then r_rows −= t, and backwards z = Gᵀ (y; −z_rows).
//!
//! # Practice
//! Single precision: that makes no difference to the number of iterations and halves the time of an application, which
//! is that of reading the factor from memory. The matrix is scaled to a unit diagonal first, as its entries range from masses
//! to stiffnesses. Dropping can leave a block that is not positive definite; then a part of the diagonal is added.
//! Parts run beside each other, and what they do to the joint is added up in their order.

use super::gradients::Preconditioner;
use super::matrix::BlockMatrix;
use super::pattern::{Group, Part, Pattern};
use crate::model::Model;
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::{cholesky_in_place, cholesky_in_place_scratch};
use faer::linalg::matmul::{matmul, triangular};
use faer::linalg::triangular_inverse::invert_lower_triangular;
use faer::linalg::triangular_solve::{solve_lower_triangular_in_place, solve_upper_triangular_in_place};
use faer::{Accum, Mat, MatMut, MatRef, Par};
use rayon::prelude::*;
use triangular::BlockStructure::{Rectangular, TriangularLower};

/// Parts of the diagonal added to it, tried one after the other.
const SHIFTS: [f32; 4] = [0.0, 1e-3, 4e-3, 1.6e-2];

/// A matrix has no incomplete factorisation, whatever the shift.
#[derive(Debug)]
pub(crate) struct NoFactor;

/// An approximate factorisation of a matrix.
pub(crate) struct Incomplete {
    pattern: Pattern,
    /// Fronts, as described for the module.
    factor: Vec<f32>,
    /// What makes the diagonal of the matrix 1, [dof_count].
    scale: Vec<f64>,
    /// The vector that is being solved for, in the order of elimination.
    work: Vec<f32>,
}

impl Incomplete {
    /// Lays out the factor.
    pub fn new(model: &Model, matrix: &BlockMatrix) -> Self {
        let pattern = Pattern::new(model, matrix);
        let size = pattern.groups.last().map_or(0, |g| g.front.end);
        let count = matrix.dof_count();
        Self { pattern, factor: vec![0.0; size], scale: vec![0.0; count], work: vec![0.0; count] }
    }

    /// Factorises `matrix`.
    pub fn factorise(&mut self, matrix: &BlockMatrix) -> Result<(), NoFactor> {
        let diagonal = |j: usize| matrix.value[matrix.column[j] as usize];
        for (j, scale) in self.scale.iter_mut().enumerate() {
            *scale = 1.0 / diagonal(j).sqrt();
        }
        if !self.scale.iter().all(|s| s.is_finite()) {
            return Err(NoFactor);
        }
        let factorised = SHIFTS.iter().any(|shift| self.factorise_shifted(matrix, *shift).is_ok());
        if factorised { Ok(()) } else { Err(NoFactor) }
    }

    fn factorise_shifted(&mut self, matrix: &BlockMatrix, shift: f32) -> Result<(), NoFactor> {
        self.factor.fill(0.0);
        for (j, scale) in self.scale.iter().enumerate() {
            for k in matrix.column[j] as usize..matrix.column[j + 1] as usize {
                let scaled = matrix.value[k] * scale * self.scale[matrix.row[k] as usize];
                self.factor[self.pattern.target[k] as usize] = scaled as f32;
            }
        }
        let pattern = &self.pattern;
        let (parts, joint) = split(&mut self.factor, pattern, |p| p.fronts.len());
        let (last, others) = joint_and_others(pattern);
        let eliminated: Vec<Result<Vec<f32>, NoFactor>> = others
            .par_iter()
            .zip(parts)
            .map(|(part, fronts)| {
                let mut outer = vec![0.0; joint.len()];
                eliminate(pattern, part, fronts, &mut outer, shift).map(|()| outer)
            })
            .collect();
        for outer in eliminated {
            joint.iter_mut().zip(outer?).for_each(|(entry, change)| *entry += change);
        }
        eliminate(pattern, last, joint, &mut [], shift)
    }
}

impl Preconditioner for Incomplete {
    fn apply(&mut self, r: &[f64], z: &mut [f64]) {
        let Self { pattern, factor, scale, work } = self;
        for ((place, r), scale) in pattern.place.iter().zip(r).zip(scale.iter()) {
            work[*place as usize] = (r * scale) as f32;
        }
        let (last, others) = joint_and_others(pattern);
        let (mut parts, joint) = split(work, pattern, |p| p.unknowns.len());
        let changes: Vec<Vec<f32>> = others
            .par_iter()
            .zip(&mut parts)
            .map(|(part, own)| {
                let mut outer = vec![0.0; joint.len()];
                forwards(pattern, factor, part, own, &mut outer);
                outer
            })
            .collect();
        for outer in changes {
            joint.iter_mut().zip(outer).for_each(|(entry, change)| *entry += change);
        }
        forwards(pattern, factor, last, joint, &mut []);
        backwards(pattern, factor, last, joint, &[]);
        others.par_iter().zip(parts).for_each(|(part, own)| backwards(pattern, factor, part, own, joint));
        for ((place, z), scale) in pattern.place.iter().zip(z).zip(scale.iter()) {
            *z = f64::from(work[*place as usize]) * scale;
        }
    }
}

/// The slices of `all` that belong to the parts, and that of the joint.
fn split<'a>(
    mut all: &'a mut [f32],
    pattern: &Pattern,
    size: impl Fn(&Part) -> usize,
) -> (Vec<&'a mut [f32]>, &'a mut [f32]) {
    let mut parts = Vec::new();
    for part in joint_and_others(pattern).1 {
        let (own, rest) = all.split_at_mut(size(part));
        parts.push(own);
        all = rest;
    }
    (parts, all)
}

/// The joint, and the parts that it joins.
fn joint_and_others(pattern: &Pattern) -> (&Part, &[Part]) {
    let count = pattern.parts.len() - 1;
    (&pattern.parts[count], &pattern.parts[..count])
}

/// Turns the matrix in the `fronts` of a part into its factor, and adds to `outer` what that does to the joint.
fn eliminate(
    pattern: &Pattern,
    part: &Part,
    fronts: &mut [f32],
    outer: &mut [f32],
    shift: f32,
) -> Result<(), NoFactor> {
    let groups = &pattern.groups[part.groups.clone()];
    let widest = groups.iter().map(|g| g.unknowns.len()).max().unwrap_or_default();
    let highest = groups.iter().map(|g| g.rows.len()).max().unwrap_or_default();
    let mut scratch = MemBuffer::new(cholesky_in_place_scratch::<f32>(widest, Par::Seq, Default::default()));
    let mut product = vec![0.0; highest * highest];
    let joint_start = pattern.groups.last().map_or(0, |g| g.front.end) - outer.len();
    for group in groups {
        let (n, m) = (group.unknowns.len(), group.rows.len());
        let own = group.front.start - part.fronts.start..group.front.end - part.fronts.start;
        let front = MatMut::from_column_major_slice_mut(&mut fronts[own], n + m, n);
        let (mut diagonal, mut rows) = front.split_at_row_mut(n);
        for i in 0..n {
            diagonal[(i, i)] += shift;
        }
        let stack = MemStack::new(&mut scratch);
        cholesky_in_place(diagonal.as_mut(), Default::default(), Par::Seq, stack, Default::default())
            .map_err(|_| NoFactor)?;
        solve_lower_triangular_in_place(diagonal.as_ref(), rows.as_mut().transpose_mut(), Par::Seq);
        triangular::matmul(
            MatMut::from_column_major_slice_mut(&mut product[..m * m], m, m),
            TriangularLower,
            Accum::Replace,
            rows.as_ref(),
            Rectangular,
            rows.as_ref().transpose(),
            Rectangular,
            1.0,
            Par::Seq,
        );
        solve_upper_triangular_in_place(
            diagonal.as_ref().transpose(),
            rows.as_mut().transpose_mut(),
            Par::Seq,
        );
        let mut inverse = Mat::zeros(n, n);
        invert_lower_triangular(inverse.as_mut(), diagonal.as_ref(), Par::Seq);
        diagonal.copy_from(&inverse);
        for run in &group.runs {
            let (from, to, len) = (run.from as usize, run.to as usize, run.len as usize);
            let changed = match to.checked_sub(joint_start).filter(|_| !outer.is_empty()) {
                Some(to) => &mut outer[to..to + len],
                None => &mut fronts[to - part.fronts.start..to - part.fronts.start + len],
            };
            changed.iter_mut().zip(&product[from..from + len]).for_each(|(entry, change)| *entry -= change);
        }
    }
    Ok(())
}

/// The front of a group.
fn front<'a>(factor: &'a [f32], group: &Group) -> MatRef<'a, f32> {
    let n = group.unknowns.len();
    MatRef::from_column_major_slice(&factor[group.front.clone()], n + group.rows.len(), n)
}

/// Solves with L for the unknowns of a part, and adds to `outer` what that does to the joint.
fn forwards(pattern: &Pattern, factor: &[f32], part: &Part, own: &mut [f32], outer: &mut [f32]) {
    let mut result = Vec::new();
    let (first, end) = (part.unknowns.start, part.unknowns.end);
    for group in &pattern.groups[part.groups.clone()] {
        let n = group.unknowns.len();
        let at = group.unknowns.start - first..group.unknowns.end - first;
        result.resize(n + group.rows.len(), 0.0);
        multiply(&mut result, front(factor, group), &own[at.clone()]);
        own[at].copy_from_slice(&result[..n]);
        for (row, change) in group.rows.iter().map(|r| *r as usize).zip(&result[n..]) {
            if row < end {
                own[row - first] -= change;
            } else {
                outer[row + outer.len() - pattern.place.len()] -= change;
            }
        }
    }
}

/// Solves with Lᵀ for the unknowns of a part, those of the joint being known.
fn backwards(pattern: &Pattern, factor: &[f32], part: &Part, own: &mut [f32], joint: &[f32]) {
    let mut known = Vec::new();
    let (first, end) = (part.unknowns.start, part.unknowns.end);
    for group in pattern.groups[part.groups.clone()].iter().rev() {
        let at = group.unknowns.start - first..group.unknowns.end - first;
        known.clear();
        known.extend_from_slice(&own[at.clone()]);
        known.extend(group.rows.iter().map(|r| *r as usize).map(|row| {
            if row < end { -own[row - first] } else { -joint[row + joint.len() - pattern.place.len()] }
        }));
        multiply(&mut own[at], front(factor, group).transpose(), &known);
    }
}

/// Sets `result` to `matrix` times `vector`.
fn multiply(result: &mut [f32], matrix: MatRef<f32>, vector: &[f32]) {
    let (m, n) = (result.len(), vector.len());
    matmul(
        MatMut::from_column_major_slice_mut(result, m, 1),
        Accum::Replace,
        matrix,
        MatRef::from_column_major_slice(vector, n, 1),
        1.0,
        Par::Seq,
    );
}
