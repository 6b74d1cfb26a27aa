//! The rigid rotation of a fabric, and why the step wants to know it.
//!
//! # Theory
//! A linearly implicit step replaces the forces at its end by F − h K v. The tension of a segment and the out-of-plane
//! stiffness of a bend are not zero on rigid rotations (a rotating tension changes direction, and K v knows only the straight
//! part of that motion), so a spinning fabric is braked by its own stress: in 0.2 s it loses three quarters of its angular
//! momentum at h = 1 ms, all of it at 5 ms. Here these terms act on v − v_rigid, v_rigid being the rigid motion that fits the
//! velocities of all nodes best. The translation drops out; what is left is ω.

use glam::{DMat3, DVec3};
use stitch_mesh::yarn_net::YarnState;

/// ω of the rigid motion closest to the node velocities, weighted by `masses` [kg]; zero where the nodes lie on a
/// line [rad/s].
pub(crate) fn rotation(state: &YarnState, masses: &[f64]) -> DVec3 {
    let nodes = || state.position.iter().zip(&state.velocity).zip(masses);
    let (mut mass, mut center, mut momentum) = (0.0, DVec3::ZERO, DVec3::ZERO);
    for ((x, v), m) in nodes() {
        mass += m;
        center += *m * *x;
        momentum += *m * *v;
    }
    let (center, mean) = (center / mass, momentum / mass);
    let (mut inertia, mut spin) = (DMat3::ZERO, DVec3::ZERO);
    for ((x, v), m) in nodes() {
        let r = *x - center;
        inertia += *m * (DMat3::from_diagonal(DVec3::splat(r.length_squared())) - outer(r));
        spin += *m * r.cross(*v - mean);
    }
    let trace = inertia.x_axis.x + inertia.y_axis.y + inertia.z_axis.z;
    if inertia.determinant() > 1e-9 * trace.powi(3) { inertia.inverse() * spin } else { DVec3::ZERO }
}

fn outer(r: DVec3) -> DMat3 {
    DMat3::from_cols(r * r.x, r * r.y, r * r.z)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rotation_of_a_rotating_body_is_found() {
        let omega = DVec3::new(1.0, -2.0, 0.5);
        let position = vec![DVec3::ZERO, DVec3::X, DVec3::Y * 2.0, DVec3::new(1.0, 1.0, 1.0)];
        let velocity = position.iter().map(|x| omega.cross(*x) + DVec3::ONE).collect();
        let state = YarnState { position, velocity, ..Default::default() };
        assert!((rotation(&state, &[1.0, 2.0, 0.5, 1.0]) - omega).length() < 1e-12);
    }

    #[test]
    fn a_line_has_none() {
        let position = vec![DVec3::ZERO, DVec3::X, DVec3::X * 2.0];
        let state = YarnState { velocity: vec![DVec3::Y; 3], position, ..Default::default() };
        assert_eq!(rotation(&state, &[1.0; 3]), DVec3::ZERO);
    }
}
