//! Inertia of one yarn segment.
//!
//! # Theory
//! Sueda et al. 2011, as in Cirio et al. 2014 §3.3. The material of a segment moves with
//! N₀ (ẋ₀ − w u̇₀) + N₁ (ẋ₁ − w u̇₁), w = (x₁ − x₀)/Δu, N₁ = 1 − N₀ running from 0 to 1. Integrating its kinetic energy gives
//! the mass matrix ρ Δu/6 [2 1; 1 2] ⊗ [[I, −w], [−wᵀ, w·w]] over (x₀, u₀, x₁, u₁), ρ in kg/m.
//!
//! # Differences from the paper
//! - A sliver of mass on each sliding coordinate: yarn that slides just as its node moves is at rest, so the matrix alone
//!   is singular along w.
//! - Forces that come from the change of the mass matrix (−Ṁv and ∂T/∂q) are dropped; they are quadratic in the velocity.

use crate::local::{LEAST_LENGTH, point};

/// Part of the mass at a node that its sliding coordinates get besides. At 0 the matrix is singular; at 0.1 the pieces of
/// yarn between two nodes visibly lag behind.
pub(crate) const SLIDING_MASS: f64 = 1e-3;

/// The mass matrix of a segment over (x₀, u₀, x₁, u₁) for `density` ρ [kg/m]; symmetric, positive definite [kg].
#[inline(always)]
pub(crate) fn mass(density: f64, q: &[f64; 8]) -> [[f64; 8]; 8] {
    let du = (q[7] - q[3]).max(LEAST_LENGTH);
    let w = ((point(q, 4) - point(q, 0)) / du).to_array();
    let unit = density * du / 6.0;
    let block = |i: usize, j: usize| match (i, j) {
        (3, 3) => w[0] * w[0] + w[1] * w[1] + w[2] * w[2],
        (3, k) | (k, 3) => -w[k],
        _ => f64::from(u8::from(i == j)),
    };
    let mut out = [[0.0; 8]; 8];
    for i in 0..8 {
        for j in 0..8 {
            let shape = if i / 4 == j / 4 { 2.0 } else { 1.0 };
            out[i][j] = unit * shape * block(i % 4, j % 4);
        }
    }
    out[3][3] += unit * SLIDING_MASS;
    out[7][7] += unit * SLIDING_MASS;
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::finite_difference::{is_positive_semidefinite, samples};

    #[test]
    fn kinetic_energy_is_that_of_the_material() {
        let density = 8.8e-4;
        for (s, v) in samples::<8>(20).zip(samples::<8>(40).skip(20)) {
            let mut q = s.map(|x| 1e-3 * x);
            q[7] = q[3] + 1e-3 * (1.5 + s[7]);
            let m = mass(density, &q);
            assert!(is_positive_semidefinite(&m));
            let mut energy = 0.0;
            for i in 0..8 {
                for j in 0..8 {
                    energy += 0.5 * v[i] * m[i][j] * v[j];
                }
            }
            // Simpson's rule is exact for the quadratic |velocity|².
            let du = q[7] - q[3];
            let w = (point(&q, 4) - point(&q, 0)) / du;
            let ends = [point(&v, 0) - w * v[3], point(&v, 4) - w * v[7]];
            let middle = 0.5 * (ends[0] + ends[1]);
            let square = ends[0].length_squared() + 4.0 * middle.length_squared() + ends[1].length_squared();
            let material = 0.5 * density * du * square / 6.0;
            let sliver = 0.5 * density * du / 6.0 * SLIDING_MASS * (v[3] * v[3] + v[7] * v[7]);
            assert!((energy - material - sliver).abs() < 1e-12 * energy.abs(), "{energy} {material}");
        }
    }

    #[test]
    fn a_segment_without_length_is_finite() {
        assert!(mass(1e-3, &[0.0; 8]).as_flattened().iter().all(|m| m.is_finite()));
    }
}
