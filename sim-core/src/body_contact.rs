//! Contact of the fabric with a body.
//!
//! # Theory
//! A node keeps the gap g(x) = signed distance − clearance, the clearance being the half thickness of the fabric there:
//! - energy V = k/2 g² while g < 0 [J];
//! - gradient k g n, n = ∇g, stiffness k n nᵀ (the curvature of the surface is left out);
//! - Coulomb friction as a drag −c (v − v_s)_t along the surface, v_s the velocity of the surface itself, with
//!   c = min(m/h, μ N/|(v − v_s)_t|), N = −k g: full sticking up to the friction cone, the force of the cone beyond.
//!
//! # Practice
//! The body is taken where it is when the step ends, as all forces of an implicit step are.
//!
//! A contact is taken up in the step whose free flight would pass the surface, not in the step after, so fabric that falls
//! lands on the body rather than in it. Its spring then draws the node to the surface: the one step of a fast
//! approach in which it may pull is the step that stops it. A body that comes closer counts like a node that does.

use crate::body::Placed;
use crate::local::{Element, Local, point, put};
use glam::DVec3;

/// The most drag along a surface, in masses of the node per step: a hundred stop a node as good as wholly; more would only spoil
/// the matrix.
pub(crate) const MOST_DRAG: f64 = 100.0;

/// Contact of a node with a body over (x), taken up whatever the sign of the gap; see the module.
#[derive(Clone, Copy)]
pub(crate) struct BodyContact<'a> {
    /// The body.
    pub body: &'a Placed<'a>,
    /// Distance that the node keeps from the surface [m].
    pub clearance: f64,
    /// k [N/m].
    pub stiffness: f64,
}

impl BodyContact<'_> {
    /// g and n.
    pub fn gap(&self, x: DVec3) -> (f64, DVec3) {
        let (distance, normal) = self.body.distance(x);
        (distance - self.clearance, normal)
    }

    /// c, drag along the surface for a node of `mass` that moves with `v` past it in a step `h` [kg/s].
    pub fn drag(&self, (gap, normal): (f64, DVec3), v: DVec3, mass: f64, h: f64) -> f64 {
        let press = self.body.friction() * self.stiffness * (-gap).max(0.0);
        let slip = (v - v.dot(normal) * normal).length();
        (press / slip.max(1e-12)).min(MOST_DRAG * mass / h)
    }
}

impl Element<3> for BodyContact<'_> {
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

/// A contact while a step goes on.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Touching {
    /// Index of the body in the scene.
    pub body: usize,
    /// The node.
    pub node: usize,
    /// g and n at the place where the node began.
    pub gap: f64,
    /// See there.
    pub normal: DVec3,
    /// k [N/m].
    pub stiffness: f64,
    /// c [kg/s].
    pub drag: f64,
    /// v_s [m/s].
    pub surface: DVec3,
}

impl Touching {
    /// The force on a node that ended the step of `h` with `v` [N].
    pub fn force(&self, v: DVec3, h: f64) -> DVec3 {
        let slip = v - self.surface;
        let along = slip - slip.dot(self.normal) * self.normal;
        -self.stiffness * (self.gap + h * v.dot(self.normal)) * self.normal - self.drag * along
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::body::tests::bodies;
    use crate::testing::finite_difference::{check_element, samples};

    #[test]
    fn derivatives() {
        // The mesh is left out: its normals jump at the borders of cells.
        for body in &bodies()[..4] {
            let body = &Placed::new(body, 0.0, 1e-3);
            for q in samples::<3>(30) {
                check_element(&BodyContact { body, clearance: 0.01, stiffness: 10.0 }, &q);
            }
        }
    }

    #[test]
    fn drag_stays_in_the_friction_cone() {
        let [ground, ..] = bodies();
        let body = &Placed::new(&ground, 0.0, 1e-3);
        let contact = BodyContact { body, clearance: 0.0, stiffness: 10.0 };
        let (x, v) = (DVec3::new(0.0, 0.099, 0.0), DVec3::new(3.0, -1.0, 4.0));
        assert!((contact.drag(contact.gap(x), v, 1e-3, 1e-3) * 5.0 - 0.3 * 10.0 * 1e-3).abs() < 1e-12);
        assert_eq!(contact.drag(contact.gap(x), DVec3::ZERO, 1e-8, 1e-3), 100.0 * 1e-8 / 1e-3);
    }
}
