//! Contact between neighbouring stitches along a yarn.
//!
//! # Theory
//! Cirio et al. 2014 §4.5 (woven cloth), used for knits as it is: two contact nodes on one yarn keep a distance d, because
//! the yarns that cross there have a thickness. With Δu = u₁ − u₀:
//! - energy V = k_c/2 (d − Δu)₊² [J];
//! - gradient −k_c (d − Δu)₊ on Δu [N], Hessian k_c inside, exact [N/m].
//!
//! # Differences from the paper
//! d is less than a yarn diameter (about 0.6 R): with 2R nearly all sliding is blocked and with it all plasticity. A
//! segment laid shorter than d takes its own length for d. The penalty can be overpowered; what then keeps Δu above zero is
//! that a step which halves a segment is taken again with half the time step.

use crate::local::{Element, Local};

/// Distance of two contacts along a yarn over (u₀, u₁).
#[derive(Clone, Copy, Debug)]
pub(crate) struct Parallel {
    /// k_c [N/m].
    pub stiffness: f64,
    /// d [m].
    pub distance: f64,
}

impl Element<2> for Parallel {
    #[inline(always)]
    fn energy(&self, q: &[f64; 2]) -> f64 {
        0.5 * self.stiffness * (self.distance - (q[1] - q[0])).max(0.0).powi(2)
    }

    #[inline(always)]
    fn expand(&self, q: &[f64; 2]) -> Local<2> {
        let overlap = self.distance - (q[1] - q[0]);
        if overlap <= 0.0 {
            return Local::zero();
        }
        let force = self.stiffness * overlap;
        let mut local = Local { energy: self.energy(q), gradient: [force, -force], ..Local::zero() };
        local.add_outer(self.stiffness, &[-1.0, 1.0]);
        local
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::finite_difference::{check_element, check_exact_hessian};

    #[test]
    fn derivatives_on_both_sides_of_contact() {
        for distance in [1e-5, 1e-3, 1e-1] {
            for ratio in [-0.5, 0.0, 0.5, 0.9, 1.1, 30.0] {
                let element = Parallel { stiffness: 5.3e3, distance };
                check_element(&element, &[0.2 * distance, (0.2 + ratio) * distance]);
                check_exact_hessian(&element, &[0.2 * distance, (0.2 + ratio) * distance]);
            }
        }
    }
}
