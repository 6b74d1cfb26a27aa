//! How close the yarns come to each other.

use crate::curves::with_arc_length;
use glam::{IVec3, Vec3};
use std::collections::HashMap;
use stitch_mesh::yarn_curves::{YarnCurve, YarnCurves};

/// Yarn closer than this along itself is no other yarn, in radii: a tight half turn is 2π of them.
const OWN_LENGTH: f32 = 6.0;

/// A point of a sampled curve.
#[derive(Clone, Copy)]
struct Sample {
    curve: usize,
    at: Vec3,
    /// Arc length from the beginning of its curve [m].
    along: f32,
}

/// Least distance between the centre lines of two yarns, or of one and itself further along; infinite where none come
/// within two diameters [m].
pub fn least_distance(curves: &YarnCurves) -> f64 {
    let radius = curves.curves.iter().map(YarnCurve::greatest_radius).fold(0.0, f32::max);
    let cell = 4.0 * radius;
    if cell <= 0.0 {
        return f64::INFINITY;
    }
    let mut lengths = Vec::new();
    let mut grid: HashMap<IVec3, Vec<Sample>> = HashMap::new();
    for (curve, c) in curves.curves.iter().enumerate() {
        let samples = with_arc_length(c);
        let closing = match (samples.first(), samples.last()) {
            (Some(a), Some(b)) if c.closed => b.1 + a.0.distance(b.0),
            _ => f32::INFINITY,
        };
        lengths.push(closing);
        for (at, along) in samples {
            grid.entry((at / cell).floor().as_ivec3()).or_default().push(Sample { curve, at, along });
        }
    }
    let is_other = |a: &Sample, b: &Sample| {
        let apart = (a.along - b.along).abs();
        a.curve != b.curve || apart.min(lengths[a.curve] - apart) > OWN_LENGTH * radius
    };
    let mut least = f32::INFINITY;
    for (key, here) in &grid {
        for (dx, dy, dz) in (0..27).map(|k| (k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1)) {
            let Some(there) = grid.get(&(*key + IVec3::new(dx, dy, dz))) else { continue };
            for a in here {
                for b in there.iter().filter(|b| is_other(a, b)) {
                    least = least.min(a.at.distance(b.at));
                }
            }
        }
    }
    f64::from(least)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn line(from: Vec3, to: Vec3) -> YarnCurve {
        let points = (0..30).map(|i| from.lerp(to, i as f32 / 29.0)).collect();
        YarnCurve::new(points, false, 0.1, stitch_mesh::dye::Dye::UNDYED)
    }

    #[test]
    fn crossing_lines_have_their_distance() {
        let curves =
            vec![line(-Vec3::X, Vec3::X), line(Vec3::new(0.0, -1.0, 0.15), Vec3::new(0.0, 1.0, 0.15))];
        assert!((least_distance(&YarnCurves { curves }) - 0.15).abs() < 5e-3);
    }

    #[test]
    fn a_yarn_is_no_neighbour_of_itself_until_it_comes_back() {
        let straight = YarnCurves { curves: vec![line(-Vec3::X, Vec3::X)] };
        assert!(least_distance(&straight) > 0.6);
        let mut back = line(Vec3::ZERO, Vec3::X * 3.0);
        back.points.extend(line(Vec3::new(3.0, 0.2, 0.0), Vec3::new(0.0, 0.2, 0.0)).points);
        assert!((least_distance(&YarnCurves { curves: vec![back] }) - 0.2).abs() < 5e-3);
    }
}
