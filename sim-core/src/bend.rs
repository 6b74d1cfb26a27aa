//! Bending between two consecutive yarn segments.
//!
//! # Theory
//! Cirio et al. §4.1, eq. 1. With a = x₁ − x₀, b = x₂ − x₁ (directions d₁, d₂), θ = atan2(|d₁ × d₂|, d₁·d₂) and
//! Δu = u₂ − u₀:
//! - energy V = f(θ)/Δu [J], f = k_b θ² + k_j (θ − θ_j)₊² [N m²], k_b = BπR²;
//! - with the binormal n = d₁ × d₂/|d₁ × d₂|: ∂θ/∂a = −n × d₁/|a|, ∂θ/∂b = n × d₂/|b|;
//! - stiffness in the plane of the bend, rank one: f''/Δu g gᵀ, g = (∇θ, −f'/(f''Δu) on Δu), and
//!   (2f − f'²/f'')/Δu³ on Δu, which the convexity of f keeps from being negative;
//! - stiffness out of the plane: θ has the second derivative cot(θ/2)/2 on the relative tilt
//!   t = (n/|a|, −(n/|a| + n/|b|), n/|b|) of the two segments and a negative one on their common tilt, which is left out:
//!   f'/Δu cot(θ/2)/2 t tᵀ.
//!
//! # Differences from the paper
//! Jamming, the sudden rise of stiffness by three orders of magnitude, starts for each bend at max(π/2, its angle at
//! rest + a little). With one threshold for all, the tight turns of cast-on, bind-off and row ends begin life jammed and
//! inject their energy into the fabric.

use crate::local::{Element, LEAST_LENGTH, Local, point, put};
use glam::DVec3;

/// Stiffness of jamming over stiffness of bending, k_j/k_b.
pub(crate) const JAM_FACTOR: f64 = 1000.0;

/// Bending over three visits (x₀, u₀, x₁, u₁, x₂, u₂); u₁ has no part in it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bend {
    /// k_b = BπR² [N m²].
    pub stiffness: f64,
    /// θ_j, where jamming starts [rad].
    pub jam_angle: f64,
}

/// The bend as it is.
struct Measure {
    /// Directions of both segments.
    d: [DVec3; 2],
    /// Their lengths [m].
    length: [f64; 2],
    /// Unit binormal; any normal of the yarn where it is straight.
    n: DVec3,
    /// θ [rad], its sine and its cosine.
    theta: f64,
    sine: f64,
    cosine: f64,
    /// Δu over both segments [m].
    du: f64,
}

impl Measure {
    #[inline(always)]
    fn new(q: &[f64; 12]) -> Self {
        let (a, b) = (point(q, 4) - point(q, 0), point(q, 8) - point(q, 4));
        let length = [a.length().max(LEAST_LENGTH), b.length().max(LEAST_LENGTH)];
        let d = [a / length[0], b / length[1]];
        let cross = d[0].cross(d[1]);
        let sine = cross.length();
        let n = if sine > 1e-12 {
            cross / sine
        } else {
            d[0].try_normalize().unwrap_or(DVec3::X).any_orthonormal_vector()
        };
        let cosine = d[0].dot(d[1]);
        let du = (q[11] - q[3]).max(LEAST_LENGTH);
        Self { d, length, n, theta: sine.atan2(cosine), sine, cosine, du }
    }

    /// ∇θ over the three points [rad/m].
    #[inline(always)]
    fn theta_gradient(&self) -> [DVec3; 3] {
        let by_a = -self.n.cross(self.d[0]) / self.length[0];
        let by_b = self.n.cross(self.d[1]) / self.length[1];
        [-by_a, by_a - by_b, by_b]
    }

    /// t, the gradient of the relative tilt out of the plane of the bend [1/m].
    #[inline(always)]
    fn tilt_gradient(&self) -> [DVec3; 3] {
        let (ta, tb) = (self.n / self.length[0], self.n / self.length[1]);
        [ta, -(ta + tb), tb]
    }
}

impl Bend {
    /// θ [rad].
    pub fn angle(q: &[f64; 12]) -> f64 {
        Measure::new(q).theta
    }

    /// f, f', f'' at θ [N m²].
    #[inline(always)]
    fn profile(&self, theta: f64) -> [f64; 3] {
        let jam = JAM_FACTOR * self.stiffness;
        let over = (theta - self.jam_angle).max(0.0);
        let jam_curvature = if over > 0.0 { 2.0 * jam } else { 0.0 };
        [
            self.stiffness * theta * theta + jam * over * over,
            2.0 * self.stiffness * theta + 2.0 * jam * over,
            2.0 * self.stiffness + jam_curvature,
        ]
    }

    /// f'/Δu cot(θ/2)/2: stiffness against relative tilt [N m].
    #[inline(always)]
    fn tilt_stiffness(&self, m: &Measure) -> f64 {
        let [_, slope, _] = self.profile(m.theta);
        // cot(θ/2) = (1 + cos θ)/sin θ; θ → 0: f' cot(θ/2)/2 → 2 k_b.
        let straight = m.sine < 1e-9 && m.cosine > 0.0;
        let along =
            if straight { 2.0 * self.stiffness } else { 0.5 * slope * (1.0 + m.cosine) / m.sine.max(1e-12) };
        (along / m.du).max(0.0)
    }
}

/// The three vectors at the places of the three positions.
#[inline(always)]
fn spread(v: [DVec3; 3]) -> [f64; 12] {
    let mut out = [0.0; 12];
    for (k, v) in v.into_iter().enumerate() {
        put(&mut out, 4 * k, v);
    }
    out
}

impl Element<12> for Bend {
    #[inline(always)]
    fn energy(&self, q: &[f64; 12]) -> f64 {
        let m = Measure::new(q);
        self.profile(m.theta)[0] / m.du
    }

    #[inline(always)]
    fn expand(&self, q: &[f64; 12]) -> Local<12> {
        let m = Measure::new(q);
        let [f, slope, curvature] = self.profile(m.theta);
        let mut local = Local::zero();
        local.energy = f / m.du;

        let mut in_plane = spread(m.theta_gradient());
        local.gradient = in_plane.map(|g| g * slope / m.du);
        local.gradient[3] = f / (m.du * m.du);
        local.gradient[11] = -local.gradient[3];

        let by_du = -slope / (curvature * m.du);
        in_plane[3] = -by_du;
        in_plane[11] = by_du;
        local.add_outer(curvature / m.du, &in_plane);

        let rest = ((2.0 * f - slope * slope / curvature) / m.du.powi(3)).max(0.0);
        for (i, j, sign) in [(3, 3, 1.0), (11, 11, 1.0), (3, 11, -1.0), (11, 3, -1.0)] {
            local.hessian[i][j] += sign * rest;
        }
        local.add_outer(self.tilt_stiffness(&m), &spread(m.tilt_gradient()));
        local
    }

    // A rotation ω tilts the two segments against each other by n·(ω × (d₂ − d₁)).
    #[inline(always)]
    fn spin(&self, q: &[f64; 12], omega: DVec3) -> [f64; 12] {
        let m = Measure::new(q);
        let tilt = m.n.dot(omega.cross(m.d[1] - m.d[0]));
        let k = self.tilt_stiffness(&m) * tilt;
        spread(m.tilt_gradient()).map(|t| k * t)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::finite_difference::{check_element, check_exact_hessian, check_spin, samples};

    const BEND: Bend = Bend { stiffness: 1.8e-9, jam_angle: 1.6 };

    /// Bends of every angle, segments of 0.1 mm to 10 mm.
    fn cases() -> impl Iterator<Item = [f64; 12]> {
        samples::<12>(60).enumerate().map(|(i, s)| {
            let scale = 10f64.powi(i as i32 % 3 - 4);
            let mut q = s.map(|x| x * scale);
            q[11] = q[3] + scale * (1.5 + s[11]);
            q
        })
    }

    #[test]
    fn derivatives() {
        for q in cases().filter(|q| (Measure::new(q).theta - BEND.jam_angle).abs() > 1e-3) {
            check_element(&BEND, &q);
        }
    }

    #[test]
    fn hessian_is_exact_in_a_straight_yarn() {
        let (a, b) = (DVec3::new(1e-3, 2e-3, -1e-3), DVec3::new(0.5e-3, 1e-3, -0.5e-3));
        let mut q = spread([DVec3::ZERO, a, a + b]);
        q[11] = 3e-3;
        check_exact_hessian(&BEND, &q);
    }

    #[test]
    fn spin_is_the_stiffness_on_a_rotation() {
        for q in cases() {
            check_spin(&BEND, &q, DVec3::new(0.3, -2.0, 1.1), [0, 4, 8]);
        }
    }

    #[test]
    fn degenerate_bends_are_finite() {
        let mut folded = spread([DVec3::ZERO, DVec3::X, DVec3::ZERO]);
        folded[11] = 1.0;
        for q in [[0.0; 12], folded, spread([DVec3::ZERO, DVec3::X, DVec3::X])] {
            let local = BEND.expand(&q);
            assert!(local.energy.is_finite() && local.gradient.iter().all(|g| g.is_finite()));
            assert!(local.hessian.as_flattened().iter().all(|h| h.is_finite()));
        }
    }
}
