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

use super::gradients::Preconditioner;
use super::matrix::BlockMatrix;
use super::packed::{LANES, Packed, Scratch, Tile, pack};
use super::panel;
use super::pattern::{Change, Group, Part, Pattern, Run};
use faer::linalg::matmul::{matmul, triangular};
use faer::prelude::ReborrowMut;
use faer::{Accum, MatMut, MatRef, Par};
use rayon::prelude::*;
use triangular::BlockStructure::{Rectangular, TriangularLower};

/// Parts of the diagonal added to it, tried one after the other.
const SHIFTS: [f32; 4] = [0.0, 1e-3, 4e-3, 1.6e-2];

/// Unknowns under which a factor is made and used on one thread: waking a second takes longer than it helps.
pub(crate) const ALONE: usize = 40_000;

/// A matrix has no factorisation, whatever the shift.
#[derive(Debug)]
pub(crate) struct NoFactor;

/// A factorisation of a matrix.
pub(crate) struct Factor {
    pattern: Pattern,
    /// Fronts, as described for the module, while they are made.
    fronts: Vec<f32>,
    /// All of them packed.
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
        let last = pattern.groups.last();
        let (size, tiles) = last.map_or((0, 0), |g| (g.front.end, g.tiles.end));
        let count = pattern.place.len();
        Self {
            pattern,
            fronts: vec![0.0; size],
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
        let Self { pattern, fronts, tiles, columns, scale, .. } = self;
        fronts.fill(0.0);
        for (j, own) in scale.iter().enumerate() {
            for k in matrix.column[j] as usize..matrix.column[j + 1] as usize {
                let scaled = matrix.value[k] * own * scale[matrix.row[k] as usize];
                fronts[pattern.target[k] as usize] = scaled as f32;
            }
        }
        let (fronts, joint_fronts) = split(fronts, pattern, |p| p.fronts.len());
        let (tiles, joint_tiles) = split(tiles, pattern, |p| p.tiles.len());
        let (columns, joint_columns) = split(columns, pattern, |p| p.unknowns.len());
        let (last, others) = joint_and_others(pattern);
        let room = || vec![0.0; joint_fronts.len()];
        let mut halves: Vec<_> = others.iter().zip(fronts).zip(tiles.into_iter().zip(columns)).collect();
        let eliminated = beside(pattern, &mut halves, |((part, fronts), (tiles, columns))| {
            let mut outer = room();
            eliminate(pattern, part, Slices { fronts, tiles, columns }, &mut outer, shift).map(|()| outer)
        });
        for outer in eliminated {
            joint_fronts.iter_mut().zip(outer?).for_each(|(entry, change)| *entry += change);
        }
        let joint = Slices { fronts: joint_fronts, tiles: joint_tiles, columns: joint_columns };
        eliminate(pattern, last, joint, &mut [], shift)
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

/// What of a factor belongs to a part.
struct Slices<'a> {
    fronts: &'a mut [f32],
    tiles: &'a mut [Tile],
    columns: &'a mut [[f32; 2]],
}

/// Turns the matrix in the fronts of a part into its factor, and adds to `outer` what that does to the joint.
fn eliminate(
    pattern: &Pattern,
    part: &Part,
    Slices { fronts, tiles, columns }: Slices,
    outer: &mut [f32],
    shift: f32,
) -> Result<(), NoFactor> {
    let groups = &pattern.groups[part.groups.clone()];
    let highest = groups.iter().map(|g| g.rows.len()).max().unwrap_or_default();
    let (mut inverse, mut product) = (Vec::new(), vec![0.0; highest * highest]);
    let joint_start = pattern.groups.last().map_or(0, |g| g.front.end) - outer.len();
    for group in groups {
        let (n, m) = (group.unknowns.len(), group.rows.len());
        let later_start = group.front.end;
        let (own, later) = fronts.split_at_mut(group.front.end - part.fronts.start);
        let front = &mut own[group.front.start - part.fronts.start..];
        for i in 0..n {
            front[i * (n + m) + i] += shift;
        }
        inverse.resize(n * n, 0.0);
        panel::eliminate(front, &mut inverse, n).map_err(|_| NoFactor)?;
        let scale = &mut columns[group.unknowns.start - part.unknowns.start..][..n];
        let packed = group.tiles.start - part.tiles.start..group.tiles.end - part.tiles.start;
        pack(&inverse, front, scale, &mut tiles[packed]);
        let rows = MatRef::from_column_major_slice(front, n + m, n).subrows(n, m);
        for changes in group.changes.chunk_by(|a, b| !a.in_place && !b.in_place) {
            let first = changes[0].columns.start as usize;
            let (height, width) = (m - first, changes[changes.len() - 1].columns.end as usize - first);
            let (below, beside) = (rows.subrows(first, height), rows.subrows(first, width).transpose());
            if !changes[0].in_place {
                multiply(&mut product[..height * width], below, beside);
            }
            for change in changes {
                let fronts = match change.front.checked_sub(joint_start).filter(|_| !outer.is_empty()) {
                    Some(start) => &mut outer[start..],
                    None => &mut later[change.front - later_start..],
                };
                if change.in_place {
                    change.work_out(below, beside, &group.rows, fronts);
                } else {
                    change.add(&product[..height * width], height, first, &group.rows, fronts);
                }
            }
        }
    }
    Ok(())
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
    /// Works out the product of rows of a group with those `beside` and takes it away from a later front, at the start of `fronts`.
    fn work_out(&self, below: MatRef<f32>, beside: MatRef<f32>, rows: &[u32], fronts: &mut [f32]) {
        let column = (rows[self.columns.start as usize] - self.first_unknown) as usize;
        let width = self.columns.len();
        let front = &mut fronts[column * self.height..(column + width) * self.height];
        let mut front = MatMut::from_column_major_slice_mut(front, self.height, width);
        for run in &self.runs {
            let [from, to, len] = [run.from - self.columns.start, run.to, run.len].map(|x| x as usize);
            let changed = front.rb_mut().subrows_mut(to, len);
            matmul(changed, Accum::Add, below.subrows(from, len), beside, -1.0, Par::Seq);
        }
    }

    /// Adds what is in `product`, whose first row and column are number `first`, to a later front, at the start of `fronts`.
    fn add(&self, product: &[f32], height: usize, first: usize, rows: &[u32], fronts: &mut [f32]) {
        for j in self.columns.clone().map(|j| j as usize) {
            let start = self.height * (rows[j] - self.first_unknown) as usize;
            let column = &mut fronts[start..start + self.height];
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
