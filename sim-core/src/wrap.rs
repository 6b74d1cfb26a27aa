//! Wrapping of two yarns around each other at a stitch contact.
//!
//! # Theory
//! Cirio et al. §4.2, eq. 2 and appendix. The axis e runs from x₀ to x₁, the two ends of the contact; yarn a leaves it at
//! x₀ towards x₄, yarn b at x₁ towards x₃. With v_a = (x₄ − x₁) × (x₀ − x₁), v_b = (x₀ − x₁) × (x₃ − x₁) and their
//! directions n_a, n_b:
//! - ψ = atan2(e·(n_a × n_b), n_a·n_b), zero in a flat fabric, at rest ψ₀ = σ|ψ₀|; φ = ψ − ψ₀;
//! - with h the distance of an outer point from the axis and t its place along it (0 at x₀, 1 at x₁):
//!   ∇φ = −n_a/h_a on x₄, −n_b/h_b on x₃, (1 − t₄) n_a/h_a + (1 − t₃) n_b/h_b on x₀, t₄ n_a/h_a + t₃ n_b/h_b on x₁;
//! - energy V = k_w L (1 − s_a s_b cos φ) [J], s = s(h) = h/√(h² + ε²);
//! - gradient k_w L (s_a s_b sin φ ∇φ − cos φ (s_a' s_b ∇h_a + s_a s_b' ∇h_b));
//! - stiffness k_w L (s_a² s_b² ∇φ ∇φᵀ − cos₊φ (s_a'' s_b ∇h_a ∇h_aᵀ + s_a s_b'' ∇h_b ∇h_bᵀ)), s'' ≤ 0. It is the Hessian
//!   itself at rest away from the axis.
//!
//! k_w and |ψ₀| are those of the material, or what a stitch makes of them: m k_w, and an angle of its own
//! ([`stitch_mesh::wrapping`]).
//!
//! # Differences from the paper
//! - ψ is signed. The paper's arccos cannot tell a knit from a purl, which differ in nothing but this sign.
//! - The paper's energy is k_w L φ²/2, which 1 − cos φ continues without a jump opposite to the rest angle. In a flat fabric
//!   (φ = π/2) it turns with 1 where the paper's turns with π/2, so k_w is about 1.5 times the paper's.
//! - s(h) makes the energy smooth where an outer segment comes to lie along the axis, as it does at borders: there ψ has no
//!   meaning, and ∇ψ grows as 1/h. An outer point that is more than a quarter turn off may pass through the axis. Fading out the
//!   paper's energy by s(h) draws such points onto the axis instead, where they never come to rest.

use crate::local::{Element, LEAST_LENGTH, Local, point, put};
use glam::DVec3;

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
    /// Unit vector from the axis to the point; zero on the axis.
    out: DVec3,
    /// s(h).
    s: f64,
    /// s/h [1/m].
    s_by_h: f64,
    /// s' [1/m].
    slope: f64,
    /// s'' [1/m²].
    curvature: f64,
}

impl Wing {
    #[inline(always)]
    fn new(outer: DVec3, x0: DVec3, e: DVec3, length: f64, fade: f64) -> Self {
        let r = outer - x0;
        let across = r - r.dot(e) * e;
        let h = across.length();
        let root = (h * h + fade * fade).sqrt().max(LEAST_LENGTH);
        Self {
            t: r.dot(e) / length,
            out: across / h.max(LEAST_LENGTH),
            s: h / root,
            s_by_h: 1.0 / root,
            slope: fade * fade / root.powi(3),
            curvature: -3.0 * h * fade * fade / root.powi(5),
        }
    }
}

/// The hinge as it is.
struct Hinge {
    a: Wing,
    b: Wing,
    n_a: DVec3,
    n_b: DVec3,
    /// cos φ and sin φ; both zero with a wing on the axis.
    cos: f64,
    sin: f64,
}

impl Hinge {
    /// Vectors over (x₄, x₀, x₁, x₃) that are `by_a` on x₄ and `by_b` on x₃, and on the axis what keeps it in balance.
    #[inline(always)]
    fn spread(&self, by_a: DVec3, by_b: DVec3) -> [f64; 12] {
        let mut out = [0.0; 12];
        put(&mut out, 0, by_a);
        put(&mut out, 3, -(1.0 - self.a.t) * by_a - (1.0 - self.b.t) * by_b);
        put(&mut out, 6, -self.a.t * by_a - self.b.t * by_b);
        put(&mut out, 9, by_b);
        out
    }
}

impl Wrap {
    #[inline(always)]
    fn hinge(&self, q: &[f64; 12]) -> Hinge {
        let [x4, x0, x1, x3] = [0, 3, 6, 9].map(|at| point(q, at));
        let length = x0.distance(x1).max(LEAST_LENGTH);
        let e = (x1 - x0) / length;
        let (a, b) = (Wing::new(x4, x0, e, length, self.fade), Wing::new(x3, x0, e, length, self.fade));
        // v_a and v_b, divided by the length of the axis and of the wing.
        let (n_a, n_b) = (e.cross(a.out), -e.cross(b.out));
        let (cos_psi, sin_psi) = (n_a.dot(n_b), e.dot(n_a.cross(n_b)));
        let (sin_rest, cos_rest) = self.rest.sin_cos();
        let cos = cos_psi * cos_rest + sin_psi * sin_rest;
        let sin = sin_psi * cos_rest - cos_psi * sin_rest;
        Hinge { a, b, n_a, n_b, cos, sin }
    }
}

impl Element<12> for Wrap {
    #[inline(always)]
    fn energy(&self, q: &[f64; 12]) -> f64 {
        let Hinge { a, b, cos, .. } = self.hinge(q);
        self.stiffness * (1.0 - a.s * b.s * cos)
    }

    #[inline(always)]
    fn expand(&self, q: &[f64; 12]) -> Local<12> {
        let hinge = self.hinge(q);
        let Hinge { a, b, n_a, n_b, cos, sin } = &hinge;
        let k = self.stiffness;
        let mut local = Local { energy: k * (1.0 - a.s * b.s * cos), ..Local::zero() };
        let by_a = -sin * a.s_by_h * b.s * *n_a - cos * a.slope * b.s * a.out;
        let by_b = -sin * a.s * b.s_by_h * *n_b - cos * a.s * b.slope * b.out;
        local.gradient = hinge.spread(k * by_a, k * by_b);

        local.add_outer(k, &hinge.spread(-a.s_by_h * b.s * *n_a, -a.s * b.s_by_h * *n_b));
        let inward = k * cos.max(0.0);
        local.add_outer(-inward * a.curvature * b.s, &hinge.spread(a.out, DVec3::ZERO));
        local.add_outer(-inward * a.s * b.curvature, &hinge.spread(DVec3::ZERO, b.out));
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
        samples::<12>(90).enumerate().map(|(i, s)| {
            let scale = 10f64.powi(i as i32 % 3 - 4);
            s.map(|x| x * scale)
        })
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
        // Turned until this pose is the rest pose.
        let flat = Wrap { rest: 0.0, fade: 0.0, ..WRAP }.hinge(&q);
        check_exact_hessian(&Wrap { rest: flat.sin.atan2(flat.cos), fade: 0.0, ..WRAP }, &q);
    }

    #[test]
    fn a_flat_hinge_has_angle_zero_and_handedness_has_a_sign() {
        let angle = |lift: f64| {
            let mut q = [0.0; 12];
            put(&mut q, 0, DVec3::new(1.0, -1.0, 0.0));
            put(&mut q, 6, DVec3::Y);
            put(&mut q, 9, DVec3::new(-1.0, 2.0, lift));
            let hinge = Wrap { rest: 0.0, ..WRAP }.hinge(&q);
            hinge.sin.atan2(hinge.cos)
        };
        assert!(angle(0.0).abs() < 1e-12);
        assert!((angle(1.0) + angle(-1.0)).abs() < 1e-12);
        assert!((angle(1.0).abs() - std::f64::consts::FRAC_PI_4).abs() < 1e-12);
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
