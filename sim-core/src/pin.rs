//! Pins: springs that hold nodes.
//!
//! # Theory
//! V = k/2 |x − target|² [J], gradient k (x − target) [N], Hessian k I, exact [N/m].

use crate::local::{Element, Local, point, put};
use crate::scene::Pin;
use glam::DVec3;

impl Pin {
    /// Its force on a node at `x` [N].
    pub fn force(&self, x: DVec3) -> DVec3 {
        self.stiffness * (self.target - x)
    }
}

impl Element<3> for Pin {
    fn energy(&self, q: &[f64; 3]) -> f64 {
        0.5 * self.stiffness * point(q, 0).distance_squared(self.target)
    }

    fn expand(&self, q: &[f64; 3]) -> Local<3> {
        let mut local = Local { energy: self.energy(q), ..Local::zero() };
        put(&mut local.gradient, 0, -self.force(point(q, 0)));
        for i in 0..3 {
            local.hessian[i][i] = self.stiffness;
        }
        local
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::finite_difference::{check_element, check_exact_hessian, samples};

    #[test]
    fn derivatives() {
        let pin = Pin { node: 0, target: DVec3::new(0.1, 0.2, -0.1), stiffness: 10.0 };
        for q in samples::<3>(10) {
            check_element(&pin, &q);
            check_exact_hessian(&pin, &q);
        }
    }
}
