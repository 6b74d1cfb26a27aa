//! Control points with a reference normal each, parallel-transported along the curve.
//!
//! # Theory
//!
//! The unit tangent at a control point is that of the spline. Its normal goes to the next point by the smallest rotation
//! that takes the one tangent a to the other b, which for v ⟂ a is v − (b·v)/(1 + a·b) (a + b). So the frame never
//! flips and never turns about the yarn more than the curve makes it. Around a closed curve it comes back turned by an
//! angle (the curve's holonomy); every span then rolls back an equal part, and the ends meet.
//!
//! The vertex shader continues this inside a span, from the same formula.

use glam::Vec3;
use stitch_mesh::yarn_curves::YarnCurve;

use super::{PITCH, PLIES};

/// Set in [`ControlPoint::curve`] at the two ends of an open curve.
pub(crate) const END: u32 = 1 << 31;

/// A control point as `yarn.wgsl` reads it.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub(crate) struct ControlPoint {
    pub position: Vec3,
    /// Length of yarn up to here, in yarn diameters.
    pub arc: f32,
    /// Unit reference normal, at a right angle to the tangent.
    pub normal: Vec3,
    /// Index of the stretch of one thickness that begins or goes on here, and [`END`].
    pub stretch: u32,
}

/// Takes a normal of the unit tangent `a` to the unit tangent `b` by the smallest rotation.
pub(crate) fn transport(normal: Vec3, a: Vec3, b: Vec3) -> Vec3 {
    // Straight back has no smallest rotation; any stays finite.
    let moved = normal - (a + b) * (b.dot(normal) / (1.0 + a.dot(b)).max(1e-4));
    // Rounding must not add up along a kilometre of yarn.
    moved.reject_from_normalized(b).try_normalize().unwrap_or_else(|| b.any_orthonormal_vector())
}

/// Direction of the spline at the second of three neighbouring points; zero if all coincide.
fn tangent([p0, p1, p2]: [Vec3; 3]) -> Vec3 {
    let knot = |a: Vec3, b: Vec3| a.distance(b).sqrt().max(1e-3);
    let (d01, d12) = (knot(p0, p1), knot(p1, p2));
    let derivative = (p1 - p0) / d01 - (p2 - p0) / (d01 + d12) + (p2 - p1) / d12;
    derivative.normalize_or_zero()
}

/// Appends the points of a curve, with one more before its start and two after its end (three if it is closed: its first
/// point again), so that every span, and the end of the last, finds its four. The stretches of one thickness are counted from
/// `first_stretch`. Returns the roll a span [rad].
pub(crate) fn lay_out(curve: &YarnCurve, first_stretch: u32, out: &mut Vec<ControlPoint>) -> f32 {
    let spans = curve.span_count();
    if spans == 0 || curve.points.len() < 2 {
        return 0.0;
    }
    let first = out.len();
    let at = |i: usize| curve.points[i % curve.points.len()];
    let mut stretch = first_stretch;
    let radius = |i: usize| curve.radii[i % curve.radii.len()];
    let [before, ..] = curve.span(0);
    let [.., after] = curve.span(spans - 1);
    out.push(ControlPoint { position: before, arc: 0.0, normal: Vec3::ZERO, stretch });

    let mut arc = 0.0;
    let mut direction = (at(1) - at(0)).try_normalize().unwrap_or(Vec3::X);
    let mut normal = direction.any_orthonormal_vector();
    let mut start_direction = direction;
    for i in 0..=spans {
        let previous = out[out.len() - 1].position;
        let next = if i == spans { after } else { at(i + 1) };
        let here = tangent([previous, at(i), next]).try_normalize().unwrap_or(direction);
        normal = transport(normal, direction, here);
        direction = here;
        if i == 0 {
            start_direction = direction;
        } else {
            arc += at(i).distance(at(i - 1)) / (2.0 * radius(i - 1));
            stretch += u32::from(radius(i) != radius(i - 1));
        }
        if i == curve.points.len() {
            stretch = first_stretch; // around once
        }
        let end = if !curve.closed && (i == 0 || i == spans) { END } else { 0 };
        out.push(ControlPoint { position: at(i), arc, normal, stretch: stretch | end });
    }
    let beyond = ControlPoint { position: after, arc, normal: Vec3::ZERO, stretch };
    out.extend([beyond; 2]);
    if curve.closed { close(&mut out[first + 1..=first + 1 + spans], start_direction) } else { 0.0 }
}

/// Makes the last of the points agree with the first in normal and twist. Returns the roll a span [rad].
fn close(points: &mut [ControlPoint], direction: Vec3) -> f32 {
    let (start, end) = (points[0], points[points.len() - 1]);
    let side = direction.cross(start.normal);
    let turned = end.normal.dot(side).atan2(end.normal.dot(start.normal));
    let spans = points.len() - 1;
    let roll = -turned / spans as f32;
    // A whole number of plies fits around.
    let ply = PITCH / PLIES;
    let stretch = (end.arc / ply).round().max(1.0) * ply / end.arc.max(f32::MIN_POSITIVE);
    let tangents: Vec<_> = (0..=spans)
        .map(|i| match i {
            _ if i == 0 || i == spans => direction,
            _ => tangent([points[i - 1].position, points[i].position, points[i + 1].position]),
        })
        .collect();
    for (i, (point, tangent)) in points.iter_mut().zip(tangents).enumerate() {
        let (sin, cos) = (roll * i as f32).sin_cos();
        point.normal = point.normal * cos + tangent.cross(point.normal) * sin;
        point.arc *= stretch;
    }
    roll
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f32::consts::TAU;

    fn curve(points: Vec<Vec3>, closed: bool) -> YarnCurve {
        YarnCurve::new(points, closed, 1e-3, stitch_mesh::dye::Dye::UNDYED)
    }

    /// A closed curve that writhes, so that its frame comes back turned.
    fn trefoil(n: usize) -> Vec<Vec3> {
        let point = |i: usize| {
            let t = TAU * i as f32 / n as f32;
            let around = 2.0 + (3.0 * t).cos();
            Vec3::new(around * (2.0 * t).cos(), around * (2.0 * t).sin(), (3.0 * t).sin()) * 0.01
        };
        (0..n).map(point).collect()
    }

    fn helix(n: usize) -> Vec<Vec3> {
        (0..n)
            .map(|i| Vec3::new((0.3 * i as f32).cos(), 0.02 * i as f32, (0.3 * i as f32).sin()) * 0.01)
            .collect()
    }

    #[test]
    fn normals_are_orthonormal_and_turn_slowly() {
        for (points, closed) in [(helix(200), false), (trefoil(60), true)] {
            let mut out = Vec::new();
            lay_out(&curve(points, closed), 0, &mut out);
            for w in out.windows(3) {
                if w[1].normal == Vec3::ZERO {
                    continue; // the points beyond the ends carry none
                }
                assert!((w[1].normal.length() - 1.0).abs() < 1e-5);
                let direction = tangent([w[0].position, w[1].position, w[2].position]);
                assert!(w[1].normal.dot(direction).abs() < 1e-3, "{}", w[1].normal.dot(direction));
                assert!(w[2].normal == Vec3::ZERO || w[1].normal.dot(w[2].normal) > 0.8);
            }
        }
    }

    #[test]
    fn a_closed_curve_ends_as_it_begins() {
        let mut out = Vec::new();
        let roll = lay_out(&curve(trefoil(60), true), 3, &mut out);
        let (first, last) = (out[1], out[61]);
        assert_eq!(first.position, last.position);
        assert!(first.normal.distance(last.normal) < 1e-4, "{} {}", first.normal, last.normal);
        let plies = last.arc / (PITCH / PLIES);
        assert!((plies - plies.round()).abs() < 1e-3);
        assert!(roll.abs() > 1e-4, "the curve was meant to turn its frame");
        assert!(out.iter().all(|p| p.stretch == 3));
    }

    #[test]
    fn a_plane_curve_keeps_the_normal_of_its_plane() {
        let circle =
            (0..12).map(|i| Vec3::new((i as f32 * 0.5).cos(), (i as f32 * 0.5).sin(), 0.0)).collect();
        let mut out = Vec::new();
        lay_out(&curve(circle, false), 0, &mut out);
        let heights: Vec<_> = out[1..13].iter().map(|p| p.normal.z).collect();
        assert!(heights.iter().all(|z| (z - heights[0]).abs() < 1e-4), "{heights:?}");
    }

    #[test]
    fn coincident_and_reversing_points_stay_finite() {
        for points in [vec![Vec3::ONE; 5], vec![Vec3::ZERO, Vec3::X, Vec3::ZERO, Vec3::X]] {
            for closed in [false, true] {
                let mut out = Vec::new();
                let roll = lay_out(&curve(points.clone(), closed), 0, &mut out);
                assert!(roll.is_finite());
                assert!(out.iter().all(|p| p.normal.is_finite() && p.arc.is_finite()));
            }
        }
    }

    #[test]
    fn a_single_point_draws_nothing() {
        let mut out = Vec::new();
        lay_out(&curve(vec![Vec3::ONE], true), 0, &mut out);
        lay_out(&curve(vec![], false), 0, &mut out);
        assert!(out.is_empty());
    }
}
