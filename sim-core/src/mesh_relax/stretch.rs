//! Stretch of an edge or a diagonal.
//!
//! # Theory
//! Yuksel et al. eq. 2: f = κ (ℓ/d − 1) d̂ on x₁, with d = |x₁ − x₀| and d̂ its direction, and the opposite on x₀. With
//! lengths in units of a stitch, energy and force have the unit of κ:
//! - energy V = κ (d − ℓ − ℓ ln(d/ℓ)), convex in d, zero at d = ℓ, without bound as d → 0: no edge collapses;
//! - gradient V' d̂ with V' = κ (1 − ℓ/d);
//! - Hessian V'' d̂d̂ᵀ + V'/d (I − d̂d̂ᵀ) with V'' = κℓ/d².
//!
//! # Differences from the paper
//! - The stiffness is made positive semi-definite by dropping the transverse part V'/d where it is negative (a pressed edge
//!   would rather turn), so it is the Hessian itself wherever d ≥ ℓ in the transverse directions.
//! - Along a stretched edge it is the secant κ/d = V'/(d − ℓ) ≥ V'': V' tends to a constant for long edges, and Newton's
//!   method on it overshoots from beyond d = 2ℓ on. The secant lands on d = ℓ from anywhere.
//! - Under d = ℓ/20 the energy goes on as its Taylor polynomial of second degree, so that coincident points have finite
//!   energy. They feel no force from each other: it would have no direction.

use glam::DVec3;

/// Length under which the energy is continued quadratically, over the rest length.
const SHORTEST: f64 = 0.05;

/// V/κ and V'/κ, for a length and a rest length.
fn energy_and_slope(d: f64, rest: f64) -> (f64, f64) {
    let at = d.max(SHORTEST * rest);
    let (energy, slope) = (at - rest - rest * (at / rest).ln(), 1.0 - rest / at);
    let under = d - at;
    let curvature = rest / (at * at);
    (energy + under * (slope + 0.5 * curvature * under), slope + curvature * under)
}

/// V/κ.
pub(super) fn energy(r: DVec3, rest: f64) -> f64 {
    energy_and_slope(r.length(), rest).0
}

/// Gradient on x₁ over κ and the stiffness over κ as `along` d̂d̂ᵀ + `across` (I − d̂d̂ᵀ).
pub(super) struct Expanded {
    pub direction: DVec3,
    pub slope: f64,
    pub along: f64,
    pub across: f64,
}

/// The gradient and stiffness for r = x₁ − x₀.
pub(super) fn expand(r: DVec3, rest: f64) -> Expanded {
    let d = r.length();
    let at = d.max(SHORTEST * rest);
    let (_, slope) = energy_and_slope(d, rest);
    let direction = if d > 0.0 { r / d } else { DVec3::ZERO };
    Expanded { direction, slope, along: (1.0 / at).max(rest / (at * at)), across: slope.max(0.0) / at }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::local::{Element, Local, point, put};
    use crate::testing::finite_difference::{check_element, check_exact_hessian};

    struct Stretch(f64);

    impl Element<3> for Stretch {
        fn energy(&self, q: &[f64; 3]) -> f64 {
            energy(point(q, 0), self.0)
        }

        fn expand(&self, q: &[f64; 3]) -> Local<3> {
            let e = expand(point(q, 0), self.0);
            let mut local = Local { energy: self.energy(q), ..Local::zero() };
            put(&mut local.gradient, 0, e.slope * e.direction);
            local.add_outer(e.along - e.across, &e.direction.to_array());
            (0..3).for_each(|i| local.hessian[i][i] += e.across);
            local
        }
    }

    #[test]
    fn derivatives_from_a_hundredth_to_a_hundred_rest_lengths() {
        for rest in [0.1, 0.87, 1.15] {
            for ratio in [0.01, 0.04, 0.06, 0.3, 0.9, 1.1, 3.0, 100.0] {
                check_element(&Stretch(rest), &(DVec3::new(0.6, -0.48, 0.64) * rest * ratio).to_array());
            }
        }
    }

    #[test]
    fn the_stiffness_is_the_hessian_at_rest() {
        check_exact_hessian(&Stretch(0.8), &(DVec3::new(0.6, -0.48, 0.64) * 0.8).to_array());
    }

    #[test]
    fn coincident_points_have_finite_energy_and_no_force() {
        let e = expand(DVec3::ZERO, 1.0);
        assert!(energy(DVec3::ZERO, 1.0) > 2.0 && energy(DVec3::ZERO, 1.0).is_finite());
        assert_eq!(e.slope * e.direction, DVec3::ZERO);
        assert!(e.along.is_finite() && e.across == 0.0);
    }
}
