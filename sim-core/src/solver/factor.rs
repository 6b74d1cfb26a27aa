//! Block Cholesky factorisation, complete or incomplete: what conjugate gradients are preconditioned with.
//!
//! # Theory
//! L Lᵀ, except that products without a place in the [`Pattern`] are dropped. For a group with the diagonal block D and the rows P
//! below it: factorise D = C Cᵀ, turn P into Q = P C⁻ᵀ, and subtract Q Qᵀ from later fronts (`panel.rs`). Stored are U = C⁻ᵀ and Q:
//! with them both directions of L Lᵀ z = r are two products of a matrix with a vector for each group, forwards y = Uᵀ r and
//! r_rows −= Q y, backwards z = U (y − Qᵀ z_rows).
//!
//! # Practice
//! Single precision, packed to half of it for use (`packed.rs`): that makes no difference to the number of iterations, and the time of
//! an application is that of reading the factor from memory. The matrix is scaled to a unit diagonal first, as its entries range
//! from masses to stiffnesses. Dropping can leave a block that is not positive definite; then a part of the diagonal is added.
//! Parts run beside each other, and what they do to the joint is added up in their order.

use super::elimination::{Elimination, Fronts, Packs};
use super::gradients::Preconditioner;
use super::matrix::BlockMatrix;
use super::packed::{LANES, Packed, Scratch, Tile};
use super::pattern::{Group, Part, Pattern};
use rayon::prelude::*;

/// Parts of the diagonal added to it, tried one after the other.
pub(crate) const SHIFTS: [f32; 4] = [0.0, 1e-3, 4e-3, 1.6e-2];

/// Unknowns under which a factor is made and used on one thread: waking a second takes longer than it helps.
pub(crate) const ALONE: usize = 40_000;

/// A matrix has no factorisation, whatever the shift.
#[derive(Debug)]
pub(crate) struct NoFactor;

/// A factorisation of a matrix.
pub(crate) struct Factor {
    pattern: Pattern,
    /// All fronts, packed.
    tiles: Vec<Tile>,
    /// Scales of their columns, [dof_count].
    columns: Vec<[f32; 2]>,
    /// What makes the diagonal of the matrix 1, [dof_count].
    scale: Vec<f64>,
    /// The vector that is being solved for, in the order of elimination.
    work: Vec<f32>,
}

impl Factor {
    /// Lays out the factor.
    pub fn new(pattern: Pattern) -> Self {
        let tiles = pattern.groups.last().map_or(0, |g| g.tiles.end);
        let count = pattern.place.len();
        Self {
            pattern,
            tiles: vec![[0; LANES]; tiles],
            columns: vec![[0.0; 2]; count],
            scale: vec![0.0; count],
            work: vec![0.0; count],
        }
    }

    /// Its size, packed [bytes].
    pub fn bytes(&self) -> u64 {
        size_of_val(&self.tiles[..]) as u64
    }

    /// Operations that making it takes.
    pub fn operations(&self) -> u64 {
        let of = |group: &Group| {
            let (n, m) = (group.unknowns.len() as u64, group.rows.len() as u64);
            // (C; Q) and U of a front, and half of Q Qᵀ; a multiplication and an addition each.
            2 * (n * n * n / 3 + n * n * m + n * n * n / 6 + n * m * m / 2)
        };
        self.pattern.groups.iter().map(of).sum()
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
        let Self { pattern, tiles, columns, scale, .. } = self;
        let (tiles, joint_tiles) = split(tiles, pattern, |p| p.tiles.len());
        let (columns, joint_columns) = split(columns, pattern, |p| p.unknowns.len());
        let (last, others) = joint_and_others(pattern);
        let elimination = Elimination { pattern, matrix, scale, shift };
        let mut halves: Vec<_> = others.iter().zip(tiles).zip(columns).collect();
        let eliminated = beside(pattern, &mut halves, |((part, tiles), columns)| {
            elimination.eliminate(part, Fronts::new(&part.groups), Packs { tiles, columns })
        });
        let mut joint = Fronts::new(&last.groups);
        for outer in eliminated {
            joint.add(outer?, |group| elimination.filled(group));
        }
        elimination.eliminate(last, joint, Packs { tiles: joint_tiles, columns: joint_columns }).map(|_| ())
    }
}

impl Preconditioner for Factor {
    fn apply(&mut self, r: &[f64], z: &mut [f64]) {
        let Self { pattern, tiles, columns, scale, work, .. } = self;
        for ((place, r), scale) in pattern.place.iter().zip(r).zip(scale.iter()) {
            work[*place as usize] = (r * scale) as f32;
        }
        let (last, others) = joint_and_others(pattern);
        let (parts, joint) = split(work, pattern, |p| p.unknowns.len());
        let solve = Solve { pattern, tiles, columns };
        let mut halves: Vec<_> = others.iter().zip(parts).collect();
        let changes = beside(pattern, &mut halves, |(part, own)| {
            let mut outer = vec![0.0; joint.len()];
            solve.forwards(part, own, &mut outer);
            outer
        });
        for outer in changes {
            joint.iter_mut().zip(outer).for_each(|(entry, change)| *entry += change);
        }
        solve.forwards(last, joint, &mut []);
        solve.backwards(last, joint, &[]);
        beside(pattern, &mut halves, |(part, own)| solve.backwards(part, own, joint));
        for ((place, z), scale) in pattern.place.iter().zip(z).zip(scale.iter()) {
            *z = f64::from(work[*place as usize]) * scale;
        }
    }
}

/// Does something with each of `halves`: beside each other, where they are large enough to be worth a second thread.
fn beside<T: Send, R: Send>(
    pattern: &Pattern,
    halves: &mut [T],
    work: impl Fn(&mut T) -> R + Sync + Send,
) -> Vec<R> {
    if pattern.place.len() < ALONE {
        halves.iter_mut().map(work).collect()
    } else {
        halves.par_iter_mut().map(work).collect()
    }
}

/// The slices of `all` that belong to the parts, and that of the joint.
fn split<'a, T>(
    mut all: &'a mut [T],
    pattern: &Pattern,
    size: impl Fn(&Part) -> usize,
) -> (Vec<&'a mut [T]>, &'a mut [T]) {
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

/// Solves with a factor.
#[derive(Clone, Copy)]
struct Solve<'a> {
    pattern: &'a Pattern,
    tiles: &'a [Tile],
    columns: &'a [[f32; 2]],
}

impl Solve<'_> {
    fn front(&self, group: &Group) -> Packed<'_> {
        let (tiles, scale) = (&self.tiles[group.tiles.clone()], &self.columns[group.unknowns.clone()]);
        Packed { tiles, scale, rows: group.rows.len() }
    }

    /// Solves with L for the unknowns of a part, and adds to `outer` what that does to the joint.
    fn forwards(self, part: &Part, own: &mut [f32], outer: &mut [f32]) {
        pulp::Arch::new().dispatch(Forwards { solve: self, part, own, outer });
    }

    /// Solves with Lᵀ for the unknowns of a part, those of the joint being known.
    fn backwards(self, part: &Part, own: &mut [f32], outer: &[f32]) {
        pulp::Arch::new().dispatch(Backwards { solve: self, part, own, outer });
    }
}

// Both directions are compiled for each width of vectors that processors have; which of them runs makes no difference to the bits.

struct Forwards<'a> {
    solve: Solve<'a>,
    part: &'a Part,
    own: &'a mut [f32],
    outer: &'a mut [f32],
}

impl pulp::WithSimd for Forwards<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, _: S) {
        let Self { solve, part, own, outer } = self;
        let (first, end) = (part.unknowns.start, part.unknowns.end);
        let joint = solve.pattern.place.len() - outer.len();
        let mut scratch = Scratch::default();
        for group in &solve.pattern.groups[part.groups.clone()] {
            let at = group.unknowns.start - first..group.unknowns.end - first;
            solve.front(group).forwards(&mut own[at], &mut scratch);
            for (row, change) in group.rows.iter().map(|r| *r as usize).zip(scratch.change.as_flattened()) {
                let entry = if row < end { &mut own[row - first] } else { &mut outer[row - joint] };
                *entry -= change;
            }
        }
    }
}

struct Backwards<'a> {
    solve: Solve<'a>,
    part: &'a Part,
    own: &'a mut [f32],
    outer: &'a [f32],
}

impl pulp::WithSimd for Backwards<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, _: S) {
        let Self { solve, part, own, outer } = self;
        let (first, end) = (part.unknowns.start, part.unknowns.end);
        let joint = solve.pattern.place.len() - outer.len();
        let (mut known, mut scratch) = (Vec::new(), Scratch::default());
        for group in solve.pattern.groups[part.groups.clone()].iter().rev() {
            let at = group.unknowns.start - first..group.unknowns.end - first;
            let rows = group.rows.iter().map(|r| *r as usize);
            known.clear();
            known.extend(rows.map(|r| if r < end { own[r - first] } else { outer[r - joint] }));
            solve.front(group).backwards(&mut own[at], &known, &mut scratch);
        }
    }
}
