//! Wrapping of two yarns around each other at a stitch contact.
//!
//! # Theory
//! Cirio et al. §4.2, eq. 2 and appendix. The axis e runs from x₀ to x₁, the two ends of the contact; yarn a leaves it at
//! x₀ towards x₄, yarn b at x₁ towards x₃. With v_a = (x₄ − x₁) × (x₀ − x₁), v_b = (x₀ − x₁) × (x₃ − x₁) and their
//! directions n_a, n_b:
//! - ψ = atan2(e·(n_a × n_b), n_a·n_b), zero in a flat fabric, at rest ψ₀ = σ|ψ₀|;
//! - with h the distance of an outer point from the axis and t its place along it (0 at x₀, 1 at x₁):
//!   ∇ψ = −n_a/h_a on x₄, −n_b/h_b on x₃, (1 − t₄) n_a/h_a + (1 − t₃) n_b/h_b on x₀, t₄ n_a/h_a + t₃ n_b/h_b on x₁;
//! - energy V = k_w L/2 ϱ² [J], ϱ = (ψ − ψ₀) s(h_a) s(h_b), s(h) = h/√(h² + ε²);
//! - stiffness k_w L ∇ϱ ∇ϱᵀ (Gauss–Newton, exact at rest).
//!
//! # Differences from the paper
//! - ψ is signed. The paper's arccos cannot tell a knit from a purl, which differ in nothing but this sign.
//! - s(h) fades the hinge out where an outer segment lies along the axis. There ψ has no meaning and ∇ψ grows as 1/h.
//! - ψ − ψ₀ is taken in −π…π, so that the jump lies opposite to the rest angle.

use crate::local::{Element, LEAST_LENGTH, Local, point, put};
use glam::DVec3;
use std::f64::consts::{PI, TAU};

/// Wrapping over (x₄, x₀, x₁, x₃).
#[derive(Clone, Copy, Debug)]
pub(crate) struct Wrap {
    /// k_w L, stiffness by rest length of the contact [N m].
    pub stiffness: f64,
    /// ψ₀, signed [rad].
    pub rest: f64,
    /// ε, distance from the axis under which the hinge fades [m].
    pub fade: f64,
}

/// One wing of the hinge: an outer point against the axis.
struct Wing {
    /// Place along the axis, 0 at x₀ and 1 at x₁.
    t: f64,
    /// Distance from the axis [m].
    h: f64,
    /// Unit vector from the axis to the point; zero on the axis.
    out: DVec3,
}

impl Wing {
    fn new(outer: DVec3, x0: DVec3, e: DVec3, length: f64) -> Self {
        let r = outer - x0;
        let across = r - r.dot(e) * e;
        let h = across.length();
        Self { t: r.dot(e) / length, h, out: across / h.max(LEAST_LENGTH) }
    }
}

impl Wrap {
    /// ϱ and its gradient over (x₄, x₀, x₁, x₃).
    fn residual(&self, q: &[f64; 12]) -> (f64, [f64; 12]) {
        let [x4, x0, x1, x3] = [0, 3, 6, 9].map(|at| point(q, at));
        let length = x0.distance(x1).max(LEAST_LENGTH);
        let e = (x1 - x0) / length;
        let (a, b) = (Wing::new(x4, x0, e, length), Wing::new(x3, x0, e, length));
        // v_a and v_b, divided by the length of the axis and of the wing.
        let (n_a, n_b) = (e.cross(a.out), -e.cross(b.out));
        let psi = e.dot(n_a.cross(n_b)).atan2(n_a.dot(n_b));
        let angle = (psi - self.rest + PI).rem_euclid(TAU) - PI;

        let root = |w: &Wing| (w.h * w.h + self.fade * self.fade).sqrt();
        let (root_a, root_b) = (root(&a), root(&b));
        let (s_a, s_b) = (a.h / root_a, b.h / root_b);
        // ∂ϱ by the outer points: along n the angle turns (s/h = 1/root), along `out` the fading changes.
        let fading = |root: f64| self.fade * self.fade / root.powi(3);
        let by_4 = s_b * (-n_a / root_a + angle * fading(root_a) * a.out);
        let by_3 = s_a * (-n_b / root_b + angle * fading(root_b) * b.out);

        let mut gradient = [0.0; 12];
        put(&mut gradient, 0, by_4);
        put(&mut gradient, 3, -(1.0 - a.t) * by_4 - (1.0 - b.t) * by_3);
        put(&mut gradient, 6, -a.t * by_4 - b.t * by_3);
        put(&mut gradient, 9, by_3);
        (angle * s_a * s_b, gradient)
    }
}

impl Element<12> for Wrap {
    fn energy(&self, q: &[f64; 12]) -> f64 {
        0.5 * self.stiffness * self.residual(q).0.powi(2)
    }

    fn expand(&self, q: &[f64; 12]) -> Local<12> {
        let (residual, gradient) = self.residual(q);
        let mut local = Local::zero();
        local.energy = 0.5 * self.stiffness * residual * residual;
        local.gradient = gradient.map(|g| self.stiffness * residual * g);
        local.add_outer(self.stiffness, &gradient);
        local
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::finite_difference::{check_element, check_exact_hessian, samples};

    const WRAP: Wrap = Wrap { stiffness: 5e-7, rest: 1.57, fade: 2e-4 };

    /// Contacts of 0.1 mm to 10 mm, all angles away from the jump.
    fn cases() -> impl Iterator<Item = [f64; 12]> {
        samples::<12>(90)
            .enumerate()
            .map(|(i, s)| {
                let scale = 10f64.powi(i as i32 % 3 - 4);
                s.map(|x| x * scale)
            })
            .filter(|q| (Wrap { fade: 0.0, ..WRAP }.residual(q).0.abs() - PI).abs() > 0.05)
    }

    #[test]
    fn derivatives() {
        for q in cases() {
            check_element(&WRAP, &q);
        }
    }

    #[test]
    fn hessian_is_exact_at_rest() {
        let mut q = [0.0; 12];
        put(&mut q, 0, DVec3::new(1e-3, -1e-3, 0.0));
        put(&mut q, 6, DVec3::Y * 1e-3);
        put(&mut q, 9, DVec3::new(-1e-3, 2e-3, 1e-3));
        // Turned until this pose is the rest pose: ψ is the residual left at ψ₀ = 0, unfaded.
        let pose = Wrap { rest: 0.0, fade: 0.0, ..WRAP };
        check_exact_hessian(&Wrap { rest: pose.residual(&q).0, ..WRAP }, &q);
    }

    #[test]
    fn a_flat_hinge_has_angle_zero_and_handedness_has_a_sign() {
        let angle = |lift: f64| {
            let mut q = [0.0; 12];
            put(&mut q, 0, DVec3::new(1.0, -1.0, 0.0));
            put(&mut q, 6, DVec3::Y);
            put(&mut q, 9, DVec3::new(-1.0, 2.0, lift));
            Wrap { rest: 0.0, fade: 0.0, ..WRAP }.residual(&q).0
        };
        assert!(angle(0.0).abs() < 1e-12);
        assert!((angle(1.0) + angle(-1.0)).abs() < 1e-12 && (angle(1.0).abs() - PI / 4.0).abs() < 1e-12);
    }

    #[test]
    fn degenerate_contacts_are_finite() {
        let mut on_axis = [0.0; 12];
        put(&mut on_axis, 0, -DVec3::Y);
        put(&mut on_axis, 6, DVec3::Y);
        put(&mut on_axis, 9, DVec3::Y * 2.0);
        for q in [[0.0; 12], on_axis] {
            let local = WRAP.expand(&q);
            assert!(local.energy.is_finite() && local.gradient.iter().all(|g| g.is_finite()));
            assert!(local.hessian.as_flattened().iter().all(|h| h.is_finite()));
        }
    }
}
