//! Shear of a corner: sub-quads want to be rectangles.
//!
//! # Theory
//! Yuksel et al. eq. 3: on corner j with neighbours i and k, with a = xᵢ − xⱼ, b = xₖ − xⱼ and c = a·b,
//! fⱼ = −κ c (xⱼ − (xᵢ + xₖ)/2). That is what this energy gives:
//! - energy V = κ/4 c²;
//! - gradient κ/2 c ∇c with ∇c = (b, −a − b, a) on (i, j, k);
//! - Hessian κ/2 (∇c ∇cᵀ + c ∇²c). ∇²c is indefinite; the stiffness is the first part alone (Gauss–Newton), exact at right
//!   angles.
//!
//! # Differences from the paper
//! The paper gives i and k half of −fⱼ each. The energy gives them −κ/2 c b and −κ/2 c a: the same sum, and they turn about j
//! instead of following it. The paper's version is the gradient of no energy; with one, steps can be judged by it and the
//! matrix is symmetric. As c has the unit of an area, so does the balance with the other forces depend on the unit of length:
//! here it is √(r_course r_wale), so that meshes of any size relax alike. (The paper names none.)

use glam::DVec3;

/// V/κ at xᵢ, xⱼ, xₖ.
pub(super) fn energy([i, j, k]: [DVec3; 3]) -> f64 {
    0.25 * (i - j).dot(k - j).powi(2)
}

/// c and ∇c at xᵢ, xⱼ, xₖ: the gradient over κ is c/2 ∇c, the stiffness over κ is ∇c ∇cᵀ/2.
pub(super) fn expand([i, j, k]: [DVec3; 3]) -> (f64, [DVec3; 3]) {
    let (a, b) = (i - j, k - j);
    (a.dot(b), [b, -a - b, a])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::local::{Element, Local, point, put};
    use crate::testing::finite_difference::{check_element, check_exact_hessian, samples};

    struct Shear;

    impl Element<9> for Shear {
        fn energy(&self, q: &[f64; 9]) -> f64 {
            energy([0, 3, 6].map(|at| point(q, at)))
        }

        fn expand(&self, q: &[f64; 9]) -> Local<9> {
            let (c, g) = expand([0, 3, 6].map(|at| point(q, at)));
            let mut flat = [0.0; 9];
            (0..3).for_each(|v| put(&mut flat, 3 * v, g[v]));
            let gradient = flat.map(|g| 0.5 * c * g);
            let mut local = Local { energy: self.energy(q), gradient, ..Local::zero() };
            local.add_outer(0.5, &flat);
            local
        }
    }

    #[test]
    fn derivatives_at_any_angle() {
        samples::<9>(20).for_each(|q| check_element(&Shear, &q));
        check_exact_hessian(&Shear, &[0.3, 0.8, 0.0, 0.3, 0.0, 0.0, 1.4, 0.0, 0.0]);
    }

    #[test]
    fn the_force_on_the_corner_is_the_papers() {
        for q in samples::<9>(10) {
            let [i, j, k] = [0, 3, 6].map(|at| point(&q, at));
            let (c, g) = expand([i, j, k]);
            let paper = -(i - j).dot(k - j) * (j - (i + k) / 2.0);
            assert!((-0.5 * c * g[1] - paper).length() < 1e-12);
        }
    }
}
