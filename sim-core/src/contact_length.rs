//! Preservation of the material length of a stitch contact.
//!
//! # Theory
//! Cirio et al. §4.5, eq. 6, for each yarn of a contact with Δu = u₁ − u₀ and rest length L:
//! - energy V = k_l L/2 (Δu/L − 1)² [J];
//! - gradient k_l (Δu/L − 1) on Δu [N], Hessian k_l/L, exact [N/m].
//!
//! No difference from the paper.

use crate::local::{Element, Local};

/// Length of one yarn in a stitch contact over (u₀, u₁).
#[derive(Clone, Copy, Debug)]
pub(crate) struct ContactLength {
    /// k_l [N].
    pub stiffness: f64,
    /// L [m].
    pub rest: f64,
}

impl Element<2> for ContactLength {
    #[inline(always)]
    fn energy(&self, q: &[f64; 2]) -> f64 {
        0.5 * self.stiffness * self.rest * ((q[1] - q[0]) / self.rest - 1.0).powi(2)
    }

    #[inline(always)]
    fn expand(&self, q: &[f64; 2]) -> Local<2> {
        let force = self.stiffness * ((q[1] - q[0]) / self.rest - 1.0);
        let mut local = Local { energy: self.energy(q), gradient: [-force, force], ..Local::zero() };
        local.add_outer(self.stiffness / self.rest, &[-1.0, 1.0]);
        local
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::finite_difference::{check_element, check_exact_hessian};

    #[test]
    fn derivatives() {
        for rest in [1e-5, 1e-3, 1e-1] {
            for ratio in [-0.5, 0.0, 0.3, 1.0, 1.7] {
                let element = ContactLength { stiffness: 17.7, rest };
                check_element(&element, &[0.2 * rest, (0.2 + ratio) * rest]);
                check_exact_hessian(&element, &[0.2 * rest, (0.2 + ratio) * rest]);
            }
        }
    }
}
