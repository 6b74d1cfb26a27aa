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
