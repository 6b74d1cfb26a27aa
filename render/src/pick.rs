//! What lies under the pointer.

use glam::Vec3;

use crate::{Faces, Ray};

/// Where a ray meets a polygon.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Index of the polygon.
    pub polygon: usize,
    /// Where [m].
    pub position: Vec3,
    /// How far from the ray's origin [m].
    pub distance: f32,
    /// The polygon's edge nearest to the position: edge i runs from corner i to corner i + 1.
    pub edge: usize,
}

/// The first polygon that a ray meets, from either side. Polygons are the same triangles that are drawn.
pub fn pick(faces: &Faces, ray: Ray) -> Option<Hit> {
    // Most polygons are far off the ray. A point is within reach of the ray's line if it is nearer to it than to the
    // farthest corner, which is far cheaper than triangles.
    let off_line = |p: Vec3| (p - ray.origin).cross(ray.direction).length_squared();
    let mut nearest: Option<(usize, f32)> = None;
    for (index, polygon) in faces.polygons.iter().enumerate() {
        let Some(&first) = polygon.vertices.first() else { continue };
        let first = faces.positions[first as usize];
        let reach = faces.corners(index).map(|p| p.distance_squared(first)).fold(0.0, f32::max);
        // The triangles lie within the polygon's longest distance of its first corner; the factor covers rounding.
        if off_line(first) > 1.01 * reach {
            continue;
        }
        let hits = faces.triangles(index).filter_map(|triangle| intersect(ray, triangle));
        for distance in hits {
            if nearest.is_none_or(|(_, best)| distance < best) {
                nearest = Some((index, distance));
            }
        }
    }
    nearest.map(|(polygon, distance)| {
        let position = ray.origin + ray.direction * distance;
        Hit { polygon, position, distance, edge: nearest_edge(faces, polygon, position) }
    })
}

/// How far beyond its sides a triangle is still met, as a part of them: rays along the side of two triangles, as through the
/// middle of a quadrilateral, shall not pass between them.
pub(crate) const SEAM: f32 = 1e-5;

/// Distance along a ray to a triangle (Möller and Trumbore), from either side.
fn intersect(ray: Ray, [a, b, c]: [Vec3; 3]) -> Option<f32> {
    let (ab, ac, ao) = (b - a, c - a, ray.origin - a);
    let p = ray.direction.cross(ac);
    let determinant = ab.dot(p);
    if determinant == 0.0 {
        return None;
    }
    let u = ao.dot(p) / determinant;
    let q = ao.cross(ab);
    let v = ray.direction.dot(q) / determinant;
    let distance = ac.dot(q) / determinant;
    (u.min(v).min(1.0 - u - v) >= -SEAM && distance > 0.0).then_some(distance)
}

fn nearest_edge(faces: &Faces, polygon: usize, position: Vec3) -> usize {
    let corners: Vec<_> = faces.corners(polygon).collect();
    let distance = |i: usize| {
        let (start, end) = (corners[i], corners[(i + 1) % corners.len()]);
        let along = end - start;
        let t = (position - start).dot(along) / along.length_squared().max(f32::MIN_POSITIVE);
        position.distance_squared(start + along * t.clamp(0.0, 1.0))
    };
    (0..corners.len()).min_by(|&i, &j| distance(i).total_cmp(&distance(j))).unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Polygon;

    /// A wavy sheet of n × n quads, corners one unit apart.
    fn sheet(n: u32) -> Faces {
        let height = |x: u32, y: u32| (x as f32 * 0.7).sin() * (y as f32 * 0.5).cos() * 2.0;
        let position = |i: u32| {
            let (x, y) = (i % (n + 1), i / (n + 1));
            Vec3::new(x as f32, y as f32, height(x, y))
        };
        let quad = |i: u32| {
            let start = i % n + i / n * (n + 1);
            Polygon {
                vertices: smallvec::smallvec![start, start + 1, start + n + 2, start + n + 1],
                color: [1.0; 3],
            }
        };
        Faces {
            positions: (0..(n + 1) * (n + 1)).map(position).collect(),
            polygons: (0..n * n).map(quad).collect(),
        }
    }

    /// Rays from all around, some of which miss.
    fn rays(n: u32) -> impl Iterator<Item = Ray> {
        (0..n).map(|i| {
            let t = i as f32;
            let origin = Vec3::new(
                5.0 + 30.0 * (t * 0.37).cos(),
                5.0 + 30.0 * (t * 0.73).sin(),
                20.0 * (t * 0.21).sin(),
            );
            let target = Vec3::new((t * 1.7).rem_euclid(12.0) - 1.0, (t * 2.3).rem_euclid(12.0) - 1.0, 0.0);
            Ray { origin, direction: (target - origin).normalize() }
        })
    }

    #[test]
    fn agrees_with_trying_every_triangle() {
        let faces = sheet(10);
        let mut hits = 0;
        for ray in rays(500) {
            let brute = (0..faces.polygons.len())
                .flat_map(|i| faces.triangles(i).map(move |triangle| (i, triangle)))
                .filter_map(|(i, triangle)| Some((intersect(ray, triangle)?, i)))
                .min_by(|a, b| a.0.total_cmp(&b.0));
            let found = pick(&faces, ray);
            assert_eq!(found.map(|hit| (hit.distance, hit.polygon)), brute);
            hits += usize::from(found.is_some());
        }
        assert!((100..480).contains(&hits), "{hits} of the rays hit: the test is one-sided");
    }

    #[test]
    fn finds_the_nearest_edge() {
        let faces = sheet(1);
        let ray = |x, y| Ray { origin: Vec3::new(x, y, 9.0), direction: Vec3::NEG_Z };
        let edge = |x, y| pick(&faces, ray(x, y)).unwrap().edge;
        assert_eq!([edge(0.5, 0.02), edge(0.98, 0.5), edge(0.5, 0.98), edge(0.02, 0.5)], [0, 1, 2, 3]);
    }

    #[test]
    fn ignores_what_lies_behind() {
        let faces = sheet(1);
        assert!(pick(&faces, Ray { origin: Vec3::new(0.5, 0.5, 9.0), direction: Vec3::Z }).is_none());
        assert!(pick(&Faces::default(), Ray { origin: Vec3::ZERO, direction: Vec3::Z }).is_none());
    }

    #[test]
    fn is_fast_enough_for_a_moving_pointer() {
        let faces = sheet(224);
        let ray = Ray { origin: Vec3::new(100.3, 90.2, 300.0), direction: Vec3::NEG_Z };
        let best = (0..10)
            .map(|_| {
                let start = std::time::Instant::now();
                assert!(pick(&faces, ray).is_some());
                start.elapsed()
            })
            .min();
        println!("a pick among {} faces: {best:?}", faces.polygons.len());
    }
}
