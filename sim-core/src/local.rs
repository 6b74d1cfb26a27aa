//! What every force looks like to the assembly: a small element over its own few unknowns.
//!
//! An element sees a local vector q and gives its energy V(q) [J], the gradient ∇V and a positive semi-definite
//! approximation of the Hessian (Gauss–Newton, or with the indefinite part dropped). A linearly implicit step needs the
//! Hessian only to be stable, never to be exact; positive semi-definite blocks keep the system matrix positive definite.
//!
//! | local vector | elements |
//! |---|---|
//! | (x₀, u₀, x₁, u₁): two visits of four numbers each | stretch, gravity, mass |
//! | (x₀, u₀, x₁, u₁, x₂, u₂): three visits | bend |
//! | (x₄, x₀, x₁, x₃): four points | wrap |
//! | (u₀, u₁): the sliding coordinates of one segment | contact length, parallel contact |
//! | x: one point | body contact, pin |

use glam::DVec3;

/// Lengths are held above this in denominators, so that coincident points give finite numbers [m].
pub(crate) const LEAST_LENGTH: f64 = 1e-9;

/// Energy, gradient and stiffness of one element over its `N` local unknowns.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Local<const N: usize> {
    /// V [J].
    pub energy: f64,
    /// ∇V [N].
    pub gradient: [f64; N],
    /// Positive semi-definite approximation of ∇²V, symmetric [N/m].
    pub hessian: [[f64; N]; N],
}

impl<const N: usize> Local<N> {
    /// No energy, no force, no stiffness.
    #[inline(always)]
    pub fn zero() -> Self {
        Self { energy: 0.0, gradient: [0.0; N], hessian: [[0.0; N]; N] }
    }

    /// Adds the rank-one stiffness k g gᵀ.
    #[inline(always)]
    pub fn add_outer(&mut self, k: f64, g: &[f64; N]) {
        for i in 0..N {
            let kg = k * g[i];
            for j in 0..N {
                self.hessian[i][j] += kg * g[j];
            }
        }
    }
}

/// The verbs of a force.
pub(crate) trait Element<const N: usize> {
    /// V(q) [J].
    fn energy(&self, q: &[f64; N]) -> f64;

    /// V, ∇V and the stiffness at q.
    fn expand(&self, q: &[f64; N]) -> Local<N>;

    /// K_t v for the velocity v of a rigid rotation `omega` [rad/s], where K_t is the part of the stiffness that is not
    /// zero on rigid rotations (see `rigid.rs`) [N/s].
    #[inline(always)]
    fn spin(&self, _q: &[f64; N], _omega: DVec3) -> [f64; N] {
        [0.0; N]
    }
}

/// The vector at `q[at..at + 3]`.
#[inline(always)]
pub(crate) fn point<const N: usize>(q: &[f64; N], at: usize) -> DVec3 {
    DVec3::new(q[at], q[at + 1], q[at + 2])
}

/// Writes `v` to `q[at..at + 3]`.
#[inline(always)]
pub(crate) fn put<const N: usize>(q: &mut [f64; N], at: usize, v: DVec3) {
    q[at..at + 3].copy_from_slice(&v.to_array());
}
