//! Bodies that the fabric collides with.
//!
//! # Theory
//! A node keeps the gap g(x) = signed distance − clearance, the clearance being the half thickness of the fabric there:
//! - energy V = k/2 g² while g < 0 [J];
//! - gradient k g n, n = ∇g, stiffness k n nᵀ (the curvature of the surface is left out);
//! - Coulomb friction as a drag −c v_t along the surface with c = min(m/h, μ N/|v_t|), N = −k g: full sticking up to the
//!   friction cone, the force of the cone beyond.
//!
//! # Practice
//! A contact is taken up in the step whose free flight would pass the surface, not in the step after, so fabric that falls
//! lands on the body rather than in it. Its spring then draws the node to the surface: the one step of a fast
//! approach in which it may pull is the step that stops it.

use crate::local::{Element, Local, point, put};
use glam::DVec3;
use serde::{Deserialize, Serialize};

/// A resting body.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Body {
    /// Everything under a height.
    Ground {
        /// Height of the floor [m].
        height: f64,
        /// Coefficient of friction.
        friction: f64,
    },
    /// A ball.
    Sphere {
        /// Centre [m].
        center: DVec3,
        /// Radius [m].
        radius: f64,
        /// Coefficient of friction.
        friction: f64,
    },
    /// A rod with round ends.
    Capsule {
        /// One end of the axis [m].
        from: DVec3,
        /// The other [m].
        to: DVec3,
        /// Radius [m].
        radius: f64,
        /// Coefficient of friction.
        friction: f64,
    },
}

impl Body {
    /// Signed distance of `x` from the surface, negative inside [m], and the unit normal there.
    pub fn distance(&self, x: DVec3) -> (f64, DVec3) {
        let around = |axis: DVec3, radius: f64| {
            let r = x - axis;
            (r.length() - radius, r.try_normalize().unwrap_or(DVec3::Y))
        };
        match *self {
            Self::Ground { height, .. } => (x.y - height, DVec3::Y),
            Self::Sphere { center, radius, .. } => around(center, radius),
            Self::Capsule { from, to, radius, .. } => {
                let axis = to - from;
                let t = ((x - from).dot(axis) / axis.length_squared().max(1e-30)).clamp(0.0, 1.0);
                around(from + t * axis, radius)
            }
        }
    }

    /// Coefficient of friction.
    pub fn friction(&self) -> f64 {
        match *self {
            Self::Ground { friction, .. }
            | Self::Sphere { friction, .. }
            | Self::Capsule { friction, .. } => friction,
        }
    }

    /// Whether every number is finite, and sizes and friction are not negative.
    pub fn is_valid(&self) -> bool {
        let (places, size) = match *self {
            Self::Ground { height, .. } => ([DVec3::splat(height); 2], 0.0),
            Self::Sphere { center, radius, .. } => ([center; 2], radius),
            Self::Capsule { from, to, radius, .. } => ([from, to], radius),
        };
        let natural = |x: f64| x.is_finite() && x >= 0.0;
        places.iter().all(|p| p.is_finite()) && natural(size) && natural(self.friction())
    }
}

/// Contact of a node with a body over (x), taken up whatever the sign of the gap; see the module.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BodyContact {
    /// The body.
    pub body: Body,
    /// Distance that the node keeps from the surface [m].
    pub clearance: f64,
    /// k [N/m].
    pub stiffness: f64,
}

impl BodyContact {
    /// g and n.
    pub fn gap(&self, x: DVec3) -> (f64, DVec3) {
        let (distance, normal) = self.body.distance(x);
        (distance - self.clearance, normal)
    }

    /// c, drag along the surface for a node of `mass` that moves with `v` in a step `h` [kg/s].
    pub fn drag(&self, x: DVec3, v: DVec3, mass: f64, h: f64) -> f64 {
        let (gap, normal) = self.gap(x);
        let press = self.body.friction() * self.stiffness * (-gap).max(0.0);
        let slip = (v - v.dot(normal) * normal).length();
        // A hundred masses per step stop a node as good as wholly; more would only spoil the matrix.
        (press / slip.max(1e-12)).min(100.0 * mass / h)
    }
}

impl Element<3> for BodyContact {
    fn energy(&self, q: &[f64; 3]) -> f64 {
        0.5 * self.stiffness * self.gap(point(q, 0)).0.powi(2)
    }

    fn expand(&self, q: &[f64; 3]) -> Local<3> {
        let (gap, normal) = self.gap(point(q, 0));
        let mut local = Local { energy: self.energy(q), ..Local::zero() };
        put(&mut local.gradient, 0, self.stiffness * gap * normal);
        local.add_outer(self.stiffness, &normal.to_array());
        local
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::finite_difference::{check_element, samples};

    fn bodies() -> [Body; 3] {
        [
            Body::Ground { height: 0.1, friction: 0.3 },
            Body::Sphere { center: DVec3::new(0.1, 0.2, 0.3), radius: 0.4, friction: 0.3 },
            Body::Capsule { from: DVec3::ZERO, to: DVec3::new(0.3, 0.5, 0.1), radius: 0.05, friction: 0.3 },
        ]
    }

    #[test]
    fn derivatives() {
        for body in bodies() {
            for q in samples::<3>(30) {
                check_element(&BodyContact { body, clearance: 0.01, stiffness: 10.0 }, &q);
            }
        }
    }

    #[test]
    fn distance_is_signed() {
        let [ground, sphere, capsule] = bodies();
        assert!((ground.distance(DVec3::new(3.0, 0.5, 0.0)).0 - 0.4).abs() < 1e-15);
        assert!((sphere.distance(DVec3::new(0.1, 0.2, 0.3)).0 + 0.4).abs() < 1e-15);
        assert!((capsule.distance(DVec3::new(0.0, -1.0, 0.0)).0 - 0.95).abs() < 1e-15);
    }

    #[test]
    fn centre_of_a_body_is_finite() {
        for (body, x) in bodies().into_iter().zip([DVec3::ZERO, DVec3::new(0.1, 0.2, 0.3), DVec3::ZERO]) {
            assert!(body.distance(x).1.is_normalized());
        }
        let point = Body::Capsule { from: DVec3::X, to: DVec3::X, radius: 0.0, friction: 0.0 };
        assert!(point.distance(DVec3::X).1.is_normalized());
    }

    #[test]
    fn drag_stays_in_the_friction_cone() {
        let contact = BodyContact { body: bodies()[0], clearance: 0.0, stiffness: 10.0 };
        let (x, v) = (DVec3::new(0.0, 0.099, 0.0), DVec3::new(3.0, -1.0, 4.0));
        assert!((contact.drag(x, v, 1e-3, 1e-3) * 5.0 - 0.3 * 10.0 * 1e-3).abs() < 1e-12);
        assert_eq!(contact.drag(x, DVec3::ZERO, 1e-8, 1e-3), 100.0 * 1e-8 / 1e-3);
    }
}
