//! Stretch of one yarn segment.
//!
//! # Theory
//! Cirio et al. 2014 §4.2 (woven cloth), used unchanged for knits. With Δu = u₁ − u₀, r = x₁ − x₀, l = |r|, d = r/l,
//! w = r/Δu and k_s = YπR² [N]:
//! - energy V = k_s/2 Δu (|w| − 1)² = k_s/2 (l²/Δu − 2l + Δu) [J];
//! - ∂V/∂r = k_s (r/Δu − d), ∂V/∂Δu = k_s/2 (1 − |w|²) [N];
//! - stiffness in (d, Δu), of rank one: k_s/Δu (d, −m)(d, −m)ᵀ. With m = |w| it is the Hessian. So it is in taut yarn;
//! - across d, exact: k_s (1/Δu − 1/l) (I − d dᵀ), which is negative in a compressed segment and then left out.
//!
//! **Slack.** In a compressed segment m = (1 + |w|)/2, which makes it Gauss and Newton's stiffness of the residual (l − Δu)/√Δu. The forces
//! are k_s (|w| − 1)(d, −m), so it shares between d and Δu as they do. And ∂V/∂Δu is zero at Δu = l, but k_s m²/Δu so small in very slack yarn
//! that a step goes 1/m times as far: twice where l is nothing. Where that is more than [`BEYOND`], the secant k_s/2 (1 − |w|²)/(Δu − l)
//! over `BEYOND` takes its place, with which the step goes that far.
//!
//! **Crimp.** Yarn that climbs by c across the fabric on its way from x₀ to x₁, over or under another, is l = √(|r|² + c²)
//! long (see `woven.rs`); c = 0 for all others. Then ∇l = r/l takes the place of d, and across it the stiffness is
//! k_s (1/Δu − 1/l) (I − ∇l ∇lᵀ).
//!
//! # Differences from the paper
//! The paper differentiates in full. In slack yarn a step that takes δ of the yarn from a segment then leaves it stretched by
//! (1 − |w|) δ/Δu, 2.5 % at |w| = 0.8 and δ = Δu/8, and with Gauss and Newton's stiffness by half of that. With the paper's, edges that
//! shrink in the first steps of a garment lost all of their yarn in one step, however short. Forces are the paper's in slack yarn too.
//! In taut yarn the Hessian is better: Gauss and Newton's made steps that pull yarn out of tight loops hang on rounding.
//!
//! Leaving out compression across d is what keeps the matrix definite: a slack yarn would buckle sideways, which the bending stiffness
//! resists anyway.

use crate::local::{Element, LEAST_LENGTH, Local, point, put};
use glam::DVec3;

/// How far a step in Δu may go in slack yarn, over the way to where it is slack no more.
pub(crate) const BEYOND: f64 = 1.1;

/// Stretch of a segment over (x₀, u₀, x₁, u₁).
#[derive(Clone, Copy, Debug)]
pub(crate) struct Stretch {
    /// k_s = YπR² [N].
    pub stiffness: f64,
    /// c [m].
    pub climb: f64,
}

impl Stretch {
    /// (r, l, Δu).
    #[inline(always)]
    fn measure(&self, q: &[f64; 8]) -> (DVec3, f64, f64) {
        let r = point(q, 4) - point(q, 0);
        (r, r.length().hypot(self.climb).max(LEAST_LENGTH), (q[7] - q[3]).max(LEAST_LENGTH))
    }

    /// m of a segment with |w| = `w`.
    #[inline(always)]
    fn share(w: f64) -> f64 {
        w.max(0.5 * (1.0 + w))
    }

    /// What the stiffness of slack yarn in Δu is greater by than Gauss and Newton's [N/m].
    #[inline(always)]
    fn slack(&self, l: f64, du: f64) -> f64 {
        let m = Self::share(l / du);
        self.stiffness / du * (m / BEYOND - m * m).max(0.0)
    }

    /// k_s (1/Δu − 1/l)₊: stiffness of a taut segment across its own direction [N/m].
    #[inline(always)]
    fn across(&self, l: f64, du: f64) -> f64 {
        (self.stiffness * (1.0 / du - 1.0 / l)).max(0.0)
    }
}

impl Element<8> for Stretch {
    #[inline(always)]
    fn energy(&self, q: &[f64; 8]) -> f64 {
        let (_, l, du) = self.measure(q);
        0.5 * self.stiffness * (l - du).powi(2) / du
    }

    #[inline(always)]
    fn expand(&self, q: &[f64; 8]) -> Local<8> {
        let (r, l, du) = self.measure(q);
        let d = r / l;
        let w = l / du;
        let m = Self::share(w);
        let mut local = Local::zero();
        local.energy = self.energy(q);

        let by_r = self.stiffness * (w - 1.0) * d;
        let by_du = 0.5 * self.stiffness * (1.0 - w * w);
        put(&mut local.gradient, 0, -by_r);
        put(&mut local.gradient, 4, by_r);
        local.gradient[3] = -by_du;
        local.gradient[7] = by_du;

        let mut along = [0.0; 8];
        put(&mut along, 0, -d);
        put(&mut along, 4, d);
        along[3] = m;
        along[7] = -m;
        local.add_outer(self.stiffness / du, &along);
        let slack = self.slack(l, du);
        local.hessian[3][3] += slack;
        local.hessian[7][7] += slack;
        local.hessian[3][7] -= slack;
        local.hessian[7][3] -= slack;

        let across = self.across(l, du);
        let d = d.to_array();
        for i in 0..3 {
            for j in 0..3 {
                let p = across * (f64::from(u8::from(i == j)) - d[i] * d[j]);
                local.hessian[i][j] += p;
                local.hessian[4 + i][4 + j] += p;
                local.hessian[i][4 + j] -= p;
                local.hessian[4 + i][j] -= p;
            }
        }
        local
    }

    // A rotation moves the second end against the first by ω × r, which is all across r and ∇l.
    #[inline(always)]
    fn spin(&self, q: &[f64; 8], omega: DVec3) -> [f64; 8] {
        let (r, l, du) = self.measure(q);
        let force = self.across(l, du) * omega.cross(r);
        let mut out = [0.0; 8];
        put(&mut out, 0, -force);
        put(&mut out, 4, force);
        out
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::finite_difference::{check_element, check_exact_hessian, check_spin, samples};

    const STRETCH: Stretch = Stretch { stiffness: 17.7, climb: 0.0 };

    /// Segments of 0.01 mm to 0.1 m, compressed or stretched.
    fn cases(ratio: std::ops::Range<f64>) -> impl Iterator<Item = [f64; 8]> {
        samples::<8>(60).enumerate().map(move |(i, s)| {
            let scale = 10f64.powi(i as i32 % 5 - 5);
            let mut q = s.map(|x| x * scale);
            let l = point(&q, 4).distance(point(&q, 0));
            q[7] = q[3] + l / (ratio.start + (ratio.end - ratio.start) * (0.5 + 0.5 * s[7]));
            q
        })
    }

    #[test]
    fn derivatives() {
        for q in cases(0.5..1.8) {
            check_element(&STRETCH, &q);
        }
    }

    #[test]
    fn hessian_is_exact_when_taut() {
        for q in cases(1.01..1.8) {
            check_exact_hessian(&STRETCH, &q);
        }
    }

    #[test]
    fn slack_yarn_has_gauss_and_newtons_stiffness() {
        for q in cases(0.85..0.999) {
            let (_, l, du) = STRETCH.measure(&q);
            let residual = |l: f64, du: f64| (l - du) / du.sqrt();
            let by = |dl: f64, ddu: f64| {
                (residual(l + dl, du + ddu) - residual(l - dl, du - ddu)) / (2.0 * (dl + ddu))
            };
            let (by_l, by_du) = (by(1e-6 * l, 0.0), by(0.0, 1e-6 * du));
            let hessian = STRETCH.expand(&q).hessian;
            let d = DVec3::from_slice(&(STRETCH.measure(&q).0 / l).to_array());
            let along: f64 = (0..3).map(|i| hessian[7][4 + i] * d[i]).sum();
            let close = |a: f64, b: f64| (a - b).abs() < 1e-6 * b.abs();
            assert!(close(along, STRETCH.stiffness * by_l * by_du), "{q:?}");
            assert!(close(hessian[7][7], STRETCH.stiffness * by_du * by_du), "{q:?}");
        }
    }

    /// Where a step takes an eighth of its yarn from a slack segment, as its neighbours do.
    #[test]
    fn a_step_leaves_slack_yarn_hardly_stretched() {
        for q in cases(0.85..0.99) {
            let (r, l, du) = STRETCH.measure(&q);
            let (local, d) = (STRETCH.expand(&q), (r / l).to_array());
            let along = |row: &[f64]| row[4..7].iter().zip(&d).map(|(x, d)| x * d).sum::<f64>();
            let stiffness: f64 = (0..3).map(|i| d[i] * along(&local.hessian[4 + i])).sum();
            let taken = du / 8.0;
            let longer = (along(&local.hessian[7]) * taken - along(&local.gradient)) / stiffness;
            let strain = (l + longer) / (du - taken) - 1.0;
            assert!(strain.abs() < 0.6 * (1.0 - l / du) * taken / du, "{strain} at {}", l / du);
        }
    }

    #[test]
    fn derivatives_of_crimped_yarn() {
        for (q, steep) in cases(0.5..1.8).zip([0.2, 1.0, 3.0].into_iter().cycle()) {
            let climb = steep * point(&q, 4).distance(point(&q, 0));
            let crimped = Stretch { climb, ..STRETCH };
            check_element(&crimped, &q);
            let mut taut = q;
            taut[7] = q[3] + crimped.measure(&q).1 / 1.3;
            check_exact_hessian(&crimped, &taut);
            check_spin(&crimped, &taut, DVec3::new(0.3, -2.0, 1.1), [0, 4]);
        }
    }

    #[test]
    fn slack_yarn_is_drawn_to_its_length_and_little_further() {
        for q in cases(0.05..0.99) {
            let (_, l, du) = STRETCH.measure(&q);
            let local = STRETCH.expand(&q);
            let step = -local.gradient[7] / local.hessian[7][7];
            let way = step / (l - du);
            assert!((1.0 - 1e-9..BEYOND + 1e-9).contains(&way), "{way} of the way from {du} to {l}");
        }
    }

    #[test]
    fn spin_is_the_stiffness_on_a_rotation() {
        let omega = DVec3::new(0.3, -2.0, 1.1);
        for q in cases(1.01..1.8) {
            check_spin(&STRETCH, &q, omega, [0, 4]);
        }
    }

    #[test]
    fn coincident_points_are_finite() {
        for q in [[0.0; 8], [1.0; 8], [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.5]] {
            let local = STRETCH.expand(&q);
            assert!(local.energy.is_finite() && local.gradient.iter().all(|g| g.is_finite()));
            assert!(local.hessian.as_flattened().iter().all(|h| h.is_finite()));
        }
    }
}
