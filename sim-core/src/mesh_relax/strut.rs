//! The wale strut: wale edges of consecutive rows want to go on straight, so that stitches stand in columns.
//!
//! # Theory
//! Yuksel et al. eq. 4: wale edges i–j and j–k that follow each other push i and k apart with κ (1 − d/r), where
//! d = |xᵢ − xₖ| and r = max(r_wale, |xᵢ − xⱼ| + |xₖ − xⱼ|) is their distance if the wale were straight. With s = r − d ≥ 0:
//! - energy V = κ s² / 2r, zero when straight; with g = s/r, it grows as the fourth power of the angle;
//! - gradient κ (g ∇s − g²/2 ∇r);
//! - stiffness κ/r ∇s ∇sᵀ + κ (g − g²/2) ∇²r: Gauss–Newton in s, and of what remains the part that is positive
//!   semi-definite, the pull of the two wale edges across themselves, ∇²|xᵢ − xⱼ| = (I − eeᵀ)/|xᵢ − xⱼ|.
//!
//! # Differences from the paper
//! The paper's force is −κ g ∇s with r held fast: it pushes i and k apart and leaves it to the wale edges, stretched by it,
//! to pull j in. Here r moves along, and the same κ g acts on j at once: the wale is straightened as much, but is not
//! stretched for it (on a curved surface, where no wale is straight, the paper's version lengthens all of them). And it is the
//! gradient of an energy.

use glam::DVec3;

/// Lengths are held above this in denominators, in stitches.
const LEAST: f64 = 1e-6;

struct Lengths {
    /// r and whether it is the sum of the edges, which moves with them.
    straight: f64,
    moves: bool,
    /// d.
    chord: f64,
}

fn lengths([i, j, k]: [DVec3; 3], rest: f64) -> Lengths {
    let sum = i.distance(j) + k.distance(j);
    Lengths { straight: sum.max(rest), moves: sum > rest, chord: i.distance(k) }
}

/// V/κ at xᵢ, xⱼ, xₖ, with r_wale.
pub(super) fn energy(x: [DVec3; 3], rest: f64) -> f64 {
    let Lengths { straight, chord, .. } = lengths(x, rest);
    0.5 * (straight - chord).powi(2) / straight
}

/// The strut at one place, over κ.
pub(super) struct Expanded {
    /// ∇V, on i, j, k.
    pub gradient: [DVec3; 3],
    /// The stiffness ∇s ∇sᵀ `along`: 1/r.
    pub along: f64,
    /// ∇s, on i, j, k.
    pub s: [DVec3; 3],
    /// The stiffness (I − eeᵀ) `across` of the edges i–j and k–j.
    pub across: [f64; 2],
    /// Their directions e, away from j.
    pub e: [DVec3; 2],
}

/// Gradient and stiffness at xᵢ, xⱼ, xₖ, with r_wale.
pub(super) fn expand(x @ [i, j, k]: [DVec3; 3], rest: f64) -> Expanded {
    let Lengths { straight, moves, chord } = lengths(x, rest);
    let moving = if moves { 1.0 } else { 0.0 };
    let edges = [i - j, k - j];
    let e = edges.map(|edge| edge.normalize_or_zero() * moving);
    let apart = if chord > LEAST { (i - k) / chord } else { DVec3::ZERO };
    let r = [e[0], -e[0] - e[1], e[1]];
    let s = [r[0] - apart, r[1], r[2] + apart];
    let g = (straight - chord) / straight;
    let gradient = std::array::from_fn(|v| g * s[v] - 0.5 * g * g * r[v]);
    let pull = moving * (g - 0.5 * g * g).max(0.0);
    Expanded {
        gradient,
        along: 1.0 / straight,
        s,
        across: edges.map(|edge| pull / edge.length().max(LEAST)),
        e,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::local::{Element, Local, point, put};
    use crate::testing::finite_difference::{check_element, samples};

    struct Strut(f64);

    impl Element<9> for Strut {
        fn energy(&self, q: &[f64; 9]) -> f64 {
            energy([0, 3, 6].map(|at| point(q, at)), self.0)
        }

        fn expand(&self, q: &[f64; 9]) -> Local<9> {
            let e = expand([0, 3, 6].map(|at| point(q, at)), self.0);
            let mut local = Local { energy: self.energy(q), ..Local::zero() };
            let mut s = [0.0; 9];
            for v in 0..3 {
                put(&mut local.gradient, 3 * v, e.gradient[v]);
                put(&mut s, 3 * v, e.s[v]);
            }
            local.add_outer(e.along, &s);
            for (end, across, direction) in [(0, e.across[0], e.e[0]), (6, e.across[1], e.e[1])] {
                for (axis, unit) in DVec3::AXES.into_iter().enumerate() {
                    // Row `axis` of I − eeᵀ.
                    let row = (unit - direction * direction[axis]) * across;
                    for (a, sign_a) in [(end, 1.0), (3, -1.0)] {
                        for (b, sign_b) in [(end, 1.0), (3, -1.0)] {
                            (0..3).for_each(|k| local.hessian[a + axis][b + k] += sign_a * sign_b * row[k]);
                        }
                    }
                }
            }
            local
        }
    }

    #[test]
    fn derivatives_bent_and_folded() {
        samples::<9>(20).for_each(|q| check_element(&Strut(0.1), &q));
        // Pressed to under half: r is the rest length and does not move.
        samples::<9>(20).for_each(|q| check_element(&Strut(20.0), &q));
    }

    #[test]
    fn a_straight_wale_feels_nothing_and_a_bent_one_is_pulled_straight() {
        let (i, k) = (DVec3::ZERO, DVec3::new(0.0, 1.6, 0.0));
        assert!(energy([i, DVec3::new(0.0, 0.9, 0.0), k], 0.75) < 1e-15);
        let bent = expand([i, DVec3::new(0.3, 0.8, 0.0), k], 0.75);
        assert!(bent.gradient[1].x > 0.0, "downhill is back into line");
        assert!(bent.gradient.iter().sum::<DVec3>().length() < 1e-12);
    }

    #[test]
    fn coincident_points_are_finite() {
        let e = expand([DVec3::ZERO; 3], 0.75);
        assert!(
            e.gradient.iter().chain(&e.s).all(|g| g.is_finite()) && e.across.iter().all(|a| a.is_finite())
        );
    }
}
