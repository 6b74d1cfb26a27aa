//! Vectors of unknowns: products and sums, in pieces that run beside each other.
//!
//! Pieces are of one length and their sums are added up in their order, so that results have the same bits whatever the number of
//! threads. At 325 000 loops a vector is 25 MB, and what conjugate gradients do to them was an eighth of an iteration on one core.

use rayon::prelude::*;

/// Unknowns in a piece.
const PIECE: usize = 1 << 15;

/// a · b.
pub(crate) fn dot(a: &[f64], b: &[f64]) -> f64 {
    let of = |(a, b): (&[f64], &[f64])| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    if a.len() <= PIECE {
        return of((a, b));
    }
    let sums: Vec<f64> = a.par_chunks(PIECE).zip(b.par_chunks(PIECE)).map(of).collect();
    sums.iter().sum()
}

/// Sets `a` to keep · a + by · b.
pub(crate) fn combine(keep: f64, a: &mut [f64], by: f64, b: &[f64]) {
    let of = |(a, b): (&mut [f64], &[f64])| {
        for (a, b) in a.iter_mut().zip(b) {
            *a = keep * *a + by * b;
        }
    };
    if a.len() <= PIECE {
        return of((a, b));
    }
    a.par_chunks_mut(PIECE).zip(b.par_chunks(PIECE)).for_each(of);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::noise::unit_hash;

    fn numbers(count: usize, seed: u64) -> Vec<f64> {
        (0..count as u64).map(|i| unit_hash(seed + i) - 0.5).collect()
    }

    #[test]
    fn pieces_add_up() {
        for count in [0, 7, PIECE, PIECE + 1, 3 * PIECE + 5] {
            let (a, b) = (numbers(count, 0), numbers(count, 1 << 40));
            let expected: f64 = a.iter().zip(&b).map(|(a, b)| a * b).sum();
            assert!((dot(&a, &b) - expected).abs() <= 1e-12 * count as f64);
            let mut c = a.clone();
            combine(0.5, &mut c, -2.0, &b);
            assert!(c.iter().zip(a.iter().zip(&b)).all(|(c, (a, b))| *c == 0.5 * a - 2.0 * b));
        }
    }
}
