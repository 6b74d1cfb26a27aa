//! Elimination of the unknowns of one front.
//!
//! # Theory
//! A front is a tall panel of n columns, (D; P). Column by column, from the left, it becomes (C; Q) with D = C Cᵀ and Q = P C⁻ᵀ:
//! from column j everything is taken away that the columns before it contribute, then it is divided by the root of its
//! pivot. U = C⁻ᵀ follows from the same recurrence: column j of U is (eⱼ − Σₖ C[j][k] U[k]) / C[j][j] over k < j.
//!
//! # Practice
//! Every operation is a long column minus four others, which stay in the first cache. A front of 40 unknowns and 85 rows takes 5 µs,
//! and 2 for U; the factorisation, triangular solve and inverse of a general library take 26, as their blocks are made for larger
//! matrices. (Q Qᵀ is another matter: there the library is the faster.) Of the large fronts of a complete factorisation
//! [`BLOCK`] columns are done like this, then the library takes them away from all columns behind.

use faer::linalg::matmul::matmul;
use faer::{Accum, MatMut, MatRef, Par};

/// Columns taken away at once.
const BESIDE: usize = 4;

/// Columns that are done before they are taken away from the others.
const BLOCK: usize = 48;

/// A pivot is not positive.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct NotPositive;

/// Turns the front (D; P), of `n` columns one after the other, into (C; Q), and sets `inverse`, the columns of an n × n matrix, to C⁻ᵀ.
/// What is above the diagonal of C is of no use.
pub(crate) fn eliminate(front: &mut [f32], inverse: &mut [f32], n: usize) -> Result<(), NotPositive> {
    let height = front.len() / n.max(1);
    for first in (0..n).step_by(BLOCK) {
        let width = BLOCK.min(n - first);
        let (done, behind) = front[first * height..].split_at_mut(width * height);
        pulp::Arch::new().dispatch(Columns { columns: done, height, first })?;
        if !behind.is_empty() {
            let (start, count) = (first + width, n - first - width);
            let done = MatRef::from_column_major_slice(done, height, width).submatrix(
                start,
                0,
                height - start,
                width,
            );
            let behind = MatMut::from_column_major_slice_mut(behind, height, count).submatrix_mut(
                start,
                0,
                height - start,
                count,
            );
            matmul(behind, Accum::Add, done, done.subrows(0, count).transpose(), -1.0, Par::Seq);
        }
    }
    pulp::Arch::new().dispatch(Inversion { front, inverse, n });
    Ok(())
}

/// Eliminates columns of a front from which those before are taken away, the first being number `first` in the front.
struct Columns<'a> {
    columns: &'a mut [f32],
    height: usize,
    first: usize,
}

impl pulp::WithSimd for Columns<'_> {
    type Output = Result<(), NotPositive>;

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, _: S) -> Self::Output {
        let Self { columns, height, first } = self;
        for j in 0..columns.len() / height {
            let (before, column) = columns[..(j + 1) * height].split_at_mut(j * height);
            let row = first + j;
            let column = &mut column[row..];
            let factor = |k: usize| before[k * height + row];
            take_away(column, j, |k| &before[k * height + row..(k + 1) * height], factor);
            let pivot = column[0];
            if pivot.is_nan() || pivot <= 0.0 {
                return Err(NotPositive);
            }
            let by = 1.0 / pivot.sqrt();
            for x in column {
                *x *= by;
            }
        }
        Ok(())
    }
}

/// Sets `inverse` to C⁻ᵀ.
struct Inversion<'a> {
    front: &'a [f32],
    inverse: &'a mut [f32],
    n: usize,
}

impl pulp::WithSimd for Inversion<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, _: S) {
        let Self { front, inverse, n } = self;
        let height = front.len() / n.max(1);
        for j in 0..n {
            let factor = |k: usize| front[k * height + j];
            let (before, column) = inverse[..(j + 1) * n].split_at_mut(j * n);
            column.fill(0.0);
            take_away(&mut column[..j], j, |k| &before[k * n..k * n + j], factor);
            column[j] = 1.0;
            let by = 1.0 / factor(j);
            for x in &mut column[..=j] {
                *x *= by;
            }
        }
    }
}

/// Takes `factor(k)` times the column `of(k)` away from `column`, for all k < `count`.
#[inline(always)]
fn take_away<'a>(
    column: &mut [f32],
    count: usize,
    of: impl Fn(usize) -> &'a [f32],
    factor: impl Fn(usize) -> f32,
) {
    let length = column.len();
    let fours = count - count % BESIDE;
    for k in (0..fours).step_by(BESIDE) {
        let [a, b, c, d] = [of(k), of(k + 1), of(k + 2), of(k + 3)];
        let (a, b, c, d) = (&a[..length], &b[..length], &c[..length], &d[..length]);
        let [by_a, by_b, by_c, by_d] = [factor(k), factor(k + 1), factor(k + 2), factor(k + 3)];
        for i in 0..length {
            column[i] -= (a[i] * by_a + b[i] * by_b) + (c[i] * by_c + d[i] * by_d);
        }
    }
    for k in fours..count {
        let (a, by) = (&of(k)[..length], factor(k));
        for i in 0..length {
            column[i] -= a[i] * by;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn panels_are_factorised() {
        let number = |i: usize| crate::noise::unit_hash(i as u64) as f32 - 0.5;
        for (n, m) in [(1, 0), (2, 3), (7, 9), (40, 85), (150, 60)] {
            let height = n + m;
            let entry = |i: usize, j: usize| {
                let (i, j) = (i.max(j), i.min(j));
                if i == j { n as f32 } else { number(200 * i + j) }
            };
            let mut front: Vec<f32> = (0..n).flat_map(|j| (0..height).map(move |i| entry(i, j))).collect();
            let mut inverse = vec![f32::NAN; n * n];
            eliminate(&mut front, &mut inverse, n).unwrap();
            // (C; Q) Cᵀ = (D; P) and C U ᵀ = I.
            let c = |i: usize, j: usize| if i < j { 0.0 } else { front[j * height + i] };
            for i in 0..height {
                for j in 0..n.min(i + 1) {
                    let product: f32 = (0..n).map(|k| c(i, k) * c(j, k)).sum();
                    assert!((product - entry(i, j)).abs() < 1e-4 * n as f32, "{n} {i} {j}");
                }
            }
            for i in 0..n {
                for j in 0..n {
                    let product: f32 = (0..n).map(|k| c(i, k) * inverse[k * n + j]).sum();
                    assert!((product - f32::from(u8::from(i == j))).abs() < 1e-5 * n as f32);
                }
            }
            for wrong in [-1.0, f32::NAN] {
                front[0] = wrong;
                assert_eq!(eliminate(&mut front, &mut inverse, n), Err(NotPositive));
            }
        }
    }
}
