//! Shear of woven cloth: the angle between warp and weft at a crossing.
//!
//! # Theory
//! Cirio et al. 2014 §4 (woven cloth): yarns that lie on each other resist being turned against each other, and once
//! neighbours touch they lock. With a = x₁ − x₀ along one yarn and b = x₂ − x₀' along the other (x₀ and x₀' are the same
//! node), φ = atan2(|a × b|, a·b), γ = φ − φ₀, and L the part of the yarn that this angle stands for:
//! - energy V = L f(γ) [J], f = k_x/2 γ² + k_j/2 (|γ| − γ_j)₊² [N], k_x = SR² with the shear modulus S;
//! - with n = a × b/|a × b|: ∂φ/∂a = −n × a/|a|², ∂φ/∂b = n × b/|b|²; gradient L f' ∇φ;
//! - stiffness by Gauss–Newton, L f'' ∇φ ∇φᵀ, exact at rest. What is left out, L f' ∇²φ, has both signs. φ does not change in
//!   a rotation, so this stiffness is blind to rotations.
//!
//! **Jamming.** Parallel yarns s apart are s sin φ apart in sheared cloth, and touch when that is their diameter: γ_j = acos(2R/s).
//! From there on the stiffness is three orders of magnitude larger, as in bending.
//!
//! # Differences from the paper
//! The paper has one jamming angle for a cloth; here it follows from the thickness and distance of the yarns.

use crate::local::{Element, LEAST_LENGTH, Local, point, put};
use glam::DVec3;

/// Stiffness of jamming over stiffness of shear, k_j/k_x.
pub(crate) const JAM_FACTOR: f64 = 1000.0;

/// Shear over (x₁, x₀, x₀', x₂).
#[derive(Clone, Copy, Debug)]
pub(crate) struct Shear {
    /// k_x [N].
    pub stiffness: f64,
    /// L [m].
    pub length: f64,
    /// φ₀ [rad].
    pub rest: f64,
    /// γ_j [rad].
    pub jam: f64,
}

/// The crossing as it is.
struct Measure {
    a: DVec3,
    b: DVec3,
    /// Unit normal of the crossing; any normal of the first yarn where both lie in one line.
    n: DVec3,
    /// φ [rad].
    phi: f64,
}

impl Measure {
    fn new(q: &[f64; 12]) -> Self {
        let (a, b) = (point(q, 0) - point(q, 3), point(q, 9) - point(q, 6));
        let cross = a.cross(b);
        let flat = cross.length() <= 1e-12 * (a.length() * b.length()).max(LEAST_LENGTH * LEAST_LENGTH);
        let along = || a.try_normalize().unwrap_or(DVec3::X);
        let n = if flat { along().any_orthonormal_vector() } else { cross.normalize() };
        Self { a, b, n, phi: cross.length().atan2(a.dot(b)) }
    }

    /// ∇φ [rad/m].
    fn gradient(&self) -> [f64; 12] {
        let least = LEAST_LENGTH * LEAST_LENGTH;
        let by_a = -self.n.cross(self.a) / self.a.length_squared().max(least);
        let by_b = self.n.cross(self.b) / self.b.length_squared().max(least);
        let mut out = [0.0; 12];
        for (k, v) in [by_a, -by_a, -by_b, by_b].into_iter().enumerate() {
            put(&mut out, 3 * k, v);
        }
        out
    }
}

impl Shear {
    /// φ [rad], and the unit normal of the crossing on the side from which it turns counter-clockwise from a to b.
    pub fn angle(q: &[f64; 12]) -> (f64, DVec3) {
        let m = Measure::new(q);
        (m.phi, m.n)
    }

    /// f, f', f'' at γ [N].
    fn profile(&self, gamma: f64) -> [f64; 3] {
        let jam = JAM_FACTOR * self.stiffness;
        let over = (gamma.abs() - self.jam).max(0.0);
        [
            0.5 * self.stiffness * gamma * gamma + 0.5 * jam * over * over,
            self.stiffness * gamma + jam * over.copysign(gamma),
            self.stiffness + if over > 0.0 { jam } else { 0.0 },
        ]
    }
}

impl Element<12> for Shear {
    fn energy(&self, q: &[f64; 12]) -> f64 {
        self.length * self.profile(Measure::new(q).phi - self.rest)[0]
    }

    fn expand(&self, q: &[f64; 12]) -> Local<12> {
        let m = Measure::new(q);
        let [f, slope, curvature] = self.profile(m.phi - self.rest);
        let turn = m.gradient();
        let mut local = Local {
            energy: self.length * f,
            gradient: turn.map(|g| self.length * slope * g),
            ..Local::zero()
        };
        local.add_outer(self.length * curvature, &turn);
        local
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::finite_difference::{check_element, check_exact_hessian, check_spin, samples};

    const SHEAR: Shear = Shear { stiffness: 0.03, length: 1e-3, rest: 1.5, jam: 0.7 };

    /// Crossings of every angle, yarns of 0.1 mm to 10 mm.
    fn cases() -> impl Iterator<Item = [f64; 12]> {
        samples::<12>(80).enumerate().map(|(i, s)| s.map(|x| x * 10f64.powi(i as i32 % 3 - 4)))
    }

    #[test]
    fn derivatives_before_and_after_jamming() {
        let mut jammed = 0;
        for q in cases() {
            let over = (Shear::angle(&q).0 - SHEAR.rest).abs() - SHEAR.jam;
            if over.abs() > 1e-3 {
                jammed += usize::from(over > 0.0);
                check_element(&SHEAR, &q);
            }
        }
        assert!((10..70).contains(&jammed), "{jammed} of 80 are jammed");
    }

    #[test]
    fn hessian_is_exact_at_rest() {
        for q in cases() {
            let rest = Shear::angle(&q).0;
            if (0.3..2.8).contains(&rest) {
                check_exact_hessian(&Shear { rest, ..SHEAR }, &q);
            }
        }
    }

    #[test]
    fn stiffness_is_blind_to_rotations() {
        for q in cases() {
            check_spin(&SHEAR, &q, DVec3::new(0.3, -2.0, 1.1), [0, 3, 6, 9]);
        }
    }

    #[test]
    fn degenerate_crossings_are_finite() {
        let mut folded = [0.0; 12];
        put(&mut folded, 0, DVec3::X);
        put(&mut folded, 9, -DVec3::X);
        for q in [[0.0; 12], [1.0; 12], folded] {
            let local = SHEAR.expand(&q);
            assert!(local.energy.is_finite() && local.gradient.iter().all(|g| g.is_finite()));
            assert!(local.hessian.as_flattened().iter().all(|h| h.is_finite()));
        }
    }
}
