//! Bodies beside the fabric: what it drapes over.

use std::f32::consts::{PI, TAU};

use glam::{Vec2, Vec3};

use crate::Bounds;

/// Matte light grey, linear.
const COLOR: [f32; 3] = [0.45, 0.45, 0.46];
/// Pieces around a sphere or a disc: round to the eye at a few hundred pixels.
const AROUND: usize = 48;
/// Rings from a pole to the equator.
const RINGS: usize = 12;
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

/// Triangles of bodies.
#[derive(Clone, Debug, Default)]
pub(crate) struct Triangles {
    pub vertices: Vec<Vertex>,
    /// Three vertices each.
    pub indices: Vec<u32>,
}

/// What triangles meet at.
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

    /// The triangles of all bodies.
    pub(crate) fn triangles(&self) -> Triangles {
        let mut out = Triangles::default();
        for solid in &self.solids {
            match solid {
                Solid::Sphere { center, radius } => out.capsule([*center; 2], *radius),
                Solid::Capsule { ends, radius } => out.capsule(*ends, *radius),
                Solid::Mesh { positions, triangles } => out.mesh(positions, triangles),
                Solid::Ground { height } => out.ground(*height),
            }
        }
        out
    }
}

fn vertex(position: Vec3, normal: Vec3) -> Vertex {
    Vertex { position, normal, color: COLOR, opacity: 1.0 }
}

impl Triangles {
    /// Rings of constant latitude about the axis from one end to the other; the cylinder is the strip between the two
    /// equators. A sphere is a capsule of no length.
    fn capsule(&mut self, [a, b]: [Vec3; 2], radius: f32) {
        let axis = (b - a).try_normalize().unwrap_or(Vec3::Y);
        let (u, v) = axis.any_orthonormal_pair();
        let ring = |i: usize| {
            let (end, step) = if i <= RINGS { (a, i) } else { (b, i - 1) };
            let (sin, cos) = (PI * (step as f32 / (2 * RINGS) as f32 - 0.5)).sin_cos();
            move |around: Vec2| {
                let normal = (u * around.x + v * around.y) * cos + axis * sin;
                vertex(end + normal * radius, normal)
            }
        };
        self.rings((0..2 * RINGS + 2).map(ring));
    }

    /// The ground, from its rim inwards.
    fn ground(&mut self, height: f32) {
        let ring = |(radius, opacity): (f32, f32)| {
            move |around: Vec2| {
                let position = Vec3::new(radius * around.y, height, radius * around.x);
                Vertex { position, normal: Vec3::Y, color: GROUND_COLOR, opacity }
            }
        };
        self.rings(GROUND_RINGS.into_iter().rev().map(ring));
    }

    /// Strips between rings that follow each other; a ring has a vertex for each unit vector around.
    fn rings<Ring: Fn(Vec2) -> Vertex>(&mut self, rings: impl Iterator<Item = Ring>) {
        let around: Vec<Vec2> =
            (0..AROUND).map(|j| Vec2::from_angle(TAU * j as f32 / AROUND as f32)).collect();
        for (i, ring) in rings.enumerate() {
            let first = self.vertices.len() as u32;
            self.vertices.extend(around.iter().map(|a| ring(*a)));
            let before = first.wrapping_sub(AROUND as u32);
            let corner = |j: usize| (j % AROUND) as u32;
            for j in (0..AROUND).filter(|_| i > 0) {
                let [p, q] = [j, j + 1].map(|j| before + corner(j));
                let [s, r] = [j, j + 1].map(|j| first + corner(j));
                self.indices.extend([p, q, r, p, r, s]);
            }
        }
    }

    /// A corner has the mean normal of the triangles around it, unless its own is far from that, as at the edges of a box.
    fn mesh(&mut self, positions: &[Vec3], triangles: &[[u32; 3]]) {
        let area = |t: &[u32; 3]| {
            let [a, b, c] = t.map(|v| positions[v as usize]);
            (b - a).cross(c - a)
        };
        let mut means = vec![Vec3::ZERO; positions.len()];
        for t in triangles {
            t.iter().for_each(|v| means[*v as usize] += area(t));
        }
        means.iter_mut().for_each(|mean| *mean = mean.normalize_or_zero());
        let first = self.vertices.len() as u32;
        self.vertices.extend(positions.iter().zip(&means).map(|(p, mean)| vertex(*p, *mean)));
        for t in triangles {
            let own = area(t).normalize_or(Vec3::Y);
            for v in t {
                if means[*v as usize].dot(own) > ROUND {
                    self.indices.push(first + v);
                } else {
                    self.indices.push(self.vertices.len() as u32);
                    self.vertices.push(vertex(positions[*v as usize], own));
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The corners of the triangles of a body.
    fn corners(solid: Solid) -> Vec<[Vertex; 3]> {
        let Triangles { vertices, indices } = Solids { solids: vec![solid] }.triangles();
        indices.chunks(3).map(|t| [t[0], t[1], t[2]].map(|v| vertices[v as usize])).collect()
    }

    #[test]
    fn capsule_points_lie_on_it_and_face_outwards() {
        let (ends, radius) = ([Vec3::new(1.0, 2.0, 3.0), Vec3::new(1.5, 1.0, 4.0)], 0.3);
        let axis = ends[1] - ends[0];
        let mut area = 0.0;
        for triangle in corners(Solid::Capsule { ends, radius }) {
            let face = (triangle[1].position - triangle[0].position)
                .cross(triangle[2].position - triangle[0].position);
            area += face.length() / 2.0;
            for corner in triangle {
                let t = ((corner.position - ends[0]).dot(axis) / axis.length_squared()).clamp(0.0, 1.0);
                let off = corner.position - ends[0] - axis * t;
                assert!((off.length() - radius).abs() < 1e-5);
                assert!(face.dot(corner.normal) > -1e-7);
            }
        }
        let whole = TAU * radius * (axis.length() + 2.0 * radius);
        assert!((0.99..1.0).contains(&(area / whole)), "closed all around: {area} of {whole}");
    }

    #[test]
    fn edges_of_a_mesh_stay_sharp_and_bulges_round() {
        let apex = |height: f32| {
            let base = [Vec3::X, Vec3::NEG_Z, Vec3::NEG_X, Vec3::Z];
            let positions = [&base[..], &[Vec3::Y * height]].concat();
            let triangles = vec![[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]];
            corners(Solid::Mesh { positions, triangles })[0][2].normal
        };
        assert!(apex(0.1).dot(Vec3::Y) > 0.999 && apex(2.0).dot(Vec3::Y) < 0.5);
    }

    #[test]
    fn the_ground_faces_up() {
        let ground = Solid::Ground { height: -1.0 };
        for [a, b, c] in corners(ground.clone()).into_iter().map(|t| t.map(|corner| corner.position)) {
            assert!((b - a).cross(c - a).y >= 0.0 && a.y == -1.0);
        }
        assert_eq!(Solids { solids: vec![ground] }.bounds(), None);
    }
}
