//! Weight of one yarn segment.
//!
//! # Theory
//! Cirio et al. 2014 §4.1. With Δu = u₁ − u₀ and ρ the mass of yarn per length:
//! - energy V = −ρ Δu g·(x₀ + x₁)/2 [J];
//! - gradient −ρ Δu g/2 on x₀ and x₁ each [N], −ρ g·(x₀ + x₁)/2 on Δu: yarn slides downhill [N];
//! - stiffness: none. The Hessian (−ρ g/2 between x and Δu) is indefinite and tiny, so it is left out.

use crate::local::{Element, Local, point, put};
use glam::DVec3;

/// Weight of a segment over (x₀, u₀, x₁, u₁).
#[derive(Clone, Copy, Debug)]
pub(crate) struct Gravity {
    /// ρ g [N/m].
    pub weight: DVec3,
}

impl Element<8> for Gravity {
    #[inline(always)]
    fn energy(&self, q: &[f64; 8]) -> f64 {
        -(q[7] - q[3]) * self.weight.dot(point(q, 0) + point(q, 4)) / 2.0
    }

    #[inline(always)]
    fn expand(&self, q: &[f64; 8]) -> Local<8> {
        let mut local = Local { energy: self.energy(q), ..Local::zero() };
        let force = -0.5 * (q[7] - q[3]) * self.weight;
        let by_du = -0.5 * self.weight.dot(point(q, 0) + point(q, 4));
        put(&mut local.gradient, 0, force);
        put(&mut local.gradient, 4, force);
        local.gradient[3] = -by_du;
        local.gradient[7] = by_du;
        local
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::finite_difference::{check_element, samples};

    #[test]
    fn derivatives() {
        let gravity = Gravity { weight: DVec3::new(0.001, -0.0086, 0.002) };
        for (i, s) in samples::<8>(20).enumerate() {
            check_element(&gravity, &s.map(|x| x * 10f64.powi(i as i32 % 5 - 4)));
        }
    }
}
