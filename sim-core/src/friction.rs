//! Friction of yarns sliding at their nodes.
//!
//! # Theory
//! **Normal force.** Cirio et al. §4.3 ask for the contact forces Λᵢ between neighbours i, i + 1 of a stack that leave the
//! least net force on its yarns in the least-squares sense. With Fᵢ the stretch and bend force of yarn i at the node,
//! fᵢ = Fᵢ + Λᵢ₋₁ − Λᵢ, and AᵀA is tridiagonal (2, −1): −Λᵢ₋₁ + 2Λᵢ − Λᵢ₊₁ = Fᵢ − Fᵢ₊₁. Two yarns press each other with
//! Λ = (F₀ − F₁)/2.
//!
//! **Friction.** §4.4: an anchor ū for every visit, and a spring k_f (u − ū) limited by μλ.
//!
//! # Differences from the paper
//! - Λ is the whole force, not its part along a fitted normal. Yarns wrapped around each other press in every direction
//!   across their axis, and with the normal part alone rows slide into a herringbone lean. λ is |Λ| plus a cohesion λ₀,
//!   summed over both faces of a yarn inside of a stack.
//! - Slipping friction is not an explicit force of size μλ (with it u runs away within ten steps) but the secant spring
//!   k = min(k_f, μλ/|u − ū + h u̇|), in the force and in the matrix.
//! - Yarns that lie parallel in a stack have an anchor each, as all others.
//! - μ and λ₀ are those of the two yarns that touch (`materials.rs`), so a yarn inside of a stack is held by each of its faces
//!   as that one can.

use crate::materials::Touch;
use glam::DVec3;

/// Σμλ, the most that friction can hold of each yarn of a stack, from the forces of the yarns at their node, front to back;
/// `touch` tells about the contact of a yarn with the next one [N].
pub(crate) fn friction_limits(pull: &[DVec3], touch: impl Fn(usize) -> Touch) -> Vec<f64> {
    let contacts = pull.len().saturating_sub(1);
    // Thomas' algorithm for the tridiagonal system: (pivot, right-hand side) going down, solution going up.
    let mut rows: Vec<(f64, DVec3)> = Vec::with_capacity(contacts);
    for i in 0..contacts {
        let rhs = pull[i] - pull[i + 1];
        let (pivot, above) = rows.last().copied().unwrap_or((f64::INFINITY, DVec3::ZERO));
        rows.push((2.0 - 1.0 / pivot, rhs + above / pivot));
    }
    let mut limits = vec![0.0; pull.len()];
    let mut below = DVec3::ZERO;
    for i in (0..contacts).rev() {
        below = (rows[i].1 + below) / rows[i].0;
        let Touch { friction, cohesion } = touch(i);
        let limit = friction * (below.length() + cohesion);
        limits[i] += limit;
        limits[i + 1] += limit;
    }
    limits
}

/// The spring that stands for friction during one step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct FrictionSpring {
    /// ū, moved so that the spring does not pull harder than friction [m].
    pub anchor: f64,
    /// k [N/m].
    pub stiffness: f64,
}

impl FrictionSpring {
    /// The spring for a visit at `u` that slides with `rate` where friction holds up to `limit`, and sticks with `stick`
    /// [N/m], in a step `h`.
    pub fn new(anchor: f64, u: f64, rate: f64, limit: f64, h: f64, stick: f64) -> Self {
        let reach = limit / stick.max(1e-12);
        let anchor = anchor.clamp(u - reach, u + reach);
        let stretch = (u - anchor + h * rate).abs();
        Self { anchor, stiffness: stick.min(limit / stretch.max(1e-12)) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_yarns_press_each_other_with_half_the_difference() {
        let touch = |_| Touch { friction: 1.0, cohesion: 0.5 };
        let limits = friction_limits(&[DVec3::new(0.0, 0.0, -2.0), DVec3::new(0.0, 0.0, 4.0)], touch);
        assert_eq!(limits.as_slice(), [3.5, 3.5]);
        assert_eq!(friction_limits(&[DVec3::ONE], touch).as_slice(), [0.0]);
    }

    #[test]
    fn each_face_of_a_yarn_holds_as_it_can() {
        let touch = |i: usize| Touch { friction: [0.1, 0.5][i], cohesion: 2.0 };
        let limits = friction_limits(&[DVec3::ZERO; 3], touch);
        assert_eq!(limits.as_slice(), [0.2, 1.2, 1.0]);
    }

    #[test]
    fn normal_forces_leave_the_least_net_force() {
        let pull = [DVec3::Z * -3.0, DVec3::Z * 1.0, DVec3::X, DVec3::Z * 2.0];
        // The same by the normal equations in full.
        let a = nalgebra::DMatrix::from_fn(4, 3, |i, j| {
            if i == j {
                -1.0
            } else if i == j + 1 {
                1.0
            } else {
                0.0
            }
        });
        let b = nalgebra::DMatrix::from_fn(4, 3, |i, k| pull[i][k]);
        let lambda = (a.transpose() * &a).try_inverse().unwrap() * (-a.transpose() * b);
        let size: Vec<f64> = (0..3).map(|i| lambda.row(i).norm()).collect();
        let expected = [size[0], size[0] + size[1], size[1] + size[2], size[2]];
        let touch = |_| Touch { friction: 1.0, cohesion: 0.0 };
        for (force, expected) in friction_limits(&pull, touch).iter().zip(expected) {
            assert!((force - expected).abs() < 1e-12);
        }
    }

    #[test]
    fn friction_sticks_and_slips() {
        let stick = FrictionSpring::new(0.0, 1e-3, 0.0, 0.5, 1e-3, 100.0);
        assert_eq!(stick, FrictionSpring { anchor: 0.0, stiffness: 100.0 });
        let slip = FrictionSpring::new(0.0, 0.1, 1.0, 0.5, 1e-2, 100.0);
        assert!((slip.anchor - 0.095).abs() < 1e-15);
        assert!((slip.stiffness * (0.1 - slip.anchor + 1e-2) - 0.5).abs() < 1e-12, "pulls with μλ");
        let free = FrictionSpring::new(0.0, 0.1, 1.0, 0.0, 1e-2, 100.0);
        assert_eq!((free.anchor, free.stiffness), (0.1, 0.0));
    }
}
