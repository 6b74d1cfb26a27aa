//! Bodies beside the fabric: what it drapes over.

use std::f32::consts::{PI, TAU};

use glam::Vec3;

use crate::Bounds;

/// Matte light grey, linear.
const COLOR: [f32; 3] = [0.45, 0.45, 0.46];
/// Pieces around a sphere or a disc: round to the eye at a few hundred pixels.
const AROUND: usize = 64;
/// Rings from a pole to the equator.
const RINGS: usize = 16;
/// Cosine of the angle under which a corner of a mesh is shaded round.
const ROUND: f32 = 0.85;
/// The ground, lit, is about as light as the background, which it fades into.
const GROUND_COLOR: [f32; 3] = [0.62, 0.605, 0.58];
/// Radii [m] of the disc that stands for the ground, and its opacity there.
const GROUND_RINGS: [(f32, f32); 4] = [(0.0, 1.0), (0.6, 1.0), (1.2, 0.4), (2.0, 0.0)];

/// A body.
#[derive(Clone, Debug, PartialEq)]
pub enum Solid {
    /// A ball.
    Sphere {
        /// Its middle [m].
        center: Vec3,
        /// Its radius [m].
        radius: f32,
    },
    /// A cylinder with half balls on its ends.
    Capsule {
        /// The middles of the half balls [m].
        ends: [Vec3; 2],
        /// Its radius [m].
        radius: f32,
    },
    /// Triangles that face outwards; where they meet at a blunt angle they are shaded round.
    Mesh {
        /// Corners [m].
        positions: Vec<Vec3>,
        /// Three corners each.
        triangles: Vec<[u32; 3]>,
    },
    /// The ground under the origin, level; it fades into the background some way out, and is not seen from below.
    Ground {
        /// Its height y [m].
        height: f32,
    },
}

/// Bodies, drawn matte grey.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Solids {
    /// The bodies.
    pub solids: Vec<Solid>,
}

/// A corner of a triangle.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Vertex {
    pub position: Vec3,
    pub normal: Vec3,
    pub color: [f32; 3],
    pub opacity: f32,
}

impl Solids {
    /// The box around all bodies but the ground.
    pub fn bounds(&self) -> Option<Bounds> {
        let bounds = self.solids.iter().filter_map(|solid| match solid {
            Solid::Sphere { center, radius } => {
                Some(Bounds { min: *center - *radius, max: *center + *radius })
            }
            Solid::Capsule { ends: [a, b], radius } => {
                Some(Bounds { min: a.min(*b) - *radius, max: a.max(*b) + *radius })
            }
            Solid::Mesh { positions, .. } => Bounds::of(positions.iter().copied()),
            Solid::Ground { .. } => None,
        });
        bounds.reduce(Bounds::union)
    }

    /// The triangles of all bodies, three vertices each.
    pub(crate) fn vertices(&self) -> Vec<Vertex> {
        let mut out = Vec::new();
        for solid in &self.solids {
            match solid {
                Solid::Sphere { center, radius } => capsule([*center; 2], *radius, &mut out),
                Solid::Capsule { ends, radius } => capsule(*ends, *radius, &mut out),
                Solid::Mesh { positions, triangles } => mesh(positions, triangles, &mut out),
                Solid::Ground { height } => ground(*height, &mut out),
            }
        }
        out
    }
}

fn vertex(position: Vec3, normal: Vec3) -> Vertex {
    Vertex { position, normal, color: COLOR, opacity: 1.0 }
}

/// Rings of constant latitude about the axis from one end to the other; the cylinder is the strip between the two
/// equators. A sphere is a capsule of no length.
fn capsule([a, b]: [Vec3; 2], radius: f32, out: &mut Vec<Vertex>) {
    let axis = (b - a).try_normalize().unwrap_or(Vec3::Y);
    let (u, v) = axis.any_orthonormal_pair();
    let ring = |i: usize| {
        let (end, step) = if i <= RINGS { (a, i) } else { (b, i - 1) };
        let latitude = PI * (step as f32 / (2 * RINGS) as f32 - 0.5);
        (end, latitude)
    };
    let at = |i: usize, j: usize| {
        let (end, latitude) = ring(i);
        let (sin, cos) = (TAU * j as f32 / AROUND as f32).sin_cos();
        let normal = (u * cos + v * sin) * latitude.cos() + axis * latitude.sin();
        vertex(end + normal * radius, normal)
    };
    for i in 0..2 * RINGS + 1 {
        for j in 0..AROUND {
            let [p, q, r, s] = [at(i, j), at(i, j + 1), at(i + 1, j + 1), at(i + 1, j)];
            out.extend([p, q, r, p, r, s]);
        }
    }
}

/// A corner has the mean normal of the triangles around it, unless its own is far from that, as at the edges of a box.
fn mesh(positions: &[Vec3], triangles: &[[u32; 3]], out: &mut Vec<Vertex>) {
    let corners = |t: &[u32; 3]| t.map(|v| positions[v as usize]);
    let area = |t: &[u32; 3]| {
        let [a, b, c] = corners(t);
        (b - a).cross(c - a)
    };
    let mut means = vec![Vec3::ZERO; positions.len()];
    for t in triangles {
        t.iter().for_each(|v| means[*v as usize] += area(t));
    }
    for t in triangles {
        let own = area(t).normalize_or(Vec3::Y);
        for v in t {
            let mean = means[*v as usize].normalize_or(own);
            let normal = if mean.dot(own) > ROUND { mean } else { own };
            out.push(vertex(positions[*v as usize], normal));
        }
    }
}

fn ground(height: f32, out: &mut Vec<Vertex>) {
    let at = |(radius, opacity): (f32, f32), j: usize| {
        let (sin, cos) = (TAU * j as f32 / AROUND as f32).sin_cos();
        let position = Vec3::new(radius * sin, height, radius * cos);
        Vertex { position, normal: Vec3::Y, color: GROUND_COLOR, opacity }
    };
    for rings in GROUND_RINGS.windows(2) {
        for j in 0..AROUND {
            let [p, q] = [at(rings[0], j), at(rings[0], j + 1)];
            let [r, s] = [at(rings[1], j + 1), at(rings[1], j)];
            out.extend([p, s, r, p, r, q]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn capsule_points_lie_on_it_and_face_outwards() {
        let (ends, radius) = ([Vec3::new(1.0, 2.0, 3.0), Vec3::new(1.5, 1.0, 4.0)], 0.3);
        let solids = Solids { solids: vec![Solid::Capsule { ends, radius }] };
        let axis = ends[1] - ends[0];
        for triangle in solids.vertices().chunks(3) {
            let face = (triangle[1].position - triangle[0].position)
                .cross(triangle[2].position - triangle[0].position);
            for corner in triangle {
                let t = ((corner.position - ends[0]).dot(axis) / axis.length_squared()).clamp(0.0, 1.0);
                let off = corner.position - ends[0] - axis * t;
                assert!((off.length() - radius).abs() < 1e-5);
                assert!(face.dot(corner.normal) > -1e-7);
            }
        }
    }

    #[test]
    fn edges_of_a_mesh_stay_sharp_and_bulges_round() {
        let apex = |height: f32| {
            let base = [Vec3::X, Vec3::NEG_Z, Vec3::NEG_X, Vec3::Z];
            let positions = [&base[..], &[Vec3::Y * height]].concat();
            let triangles = vec![[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]];
            let solids = Solids { solids: vec![Solid::Mesh { positions, triangles }] };
            solids.vertices()[2].normal
        };
        assert!(apex(0.1).dot(Vec3::Y) > 0.999 && apex(2.0).dot(Vec3::Y) < 0.5);
    }

    #[test]
    fn the_ground_faces_up() {
        let solids = Solids { solids: vec![Solid::Ground { height: -1.0 }] };
        for triangle in solids.vertices().chunks(3) {
            let [a, b, c] = [0, 1, 2].map(|i| triangle[i].position);
            assert!((b - a).cross(c - a).y >= 0.0 && a.y == -1.0);
        }
        assert_eq!(solids.bounds(), None);
    }
}
