//! The surface of a closed mesh: which point of it is nearest, and on which side of it something is.
//!
//! # Theory
//! The distance of a point is that to the nearest point of the triangles, negative inside. Its sign is that of (x − p)·n with p
//! the nearest point and n the pseudo-normal there: the triangle's own, the sum of both at an edge, the sum weighted by
//! angles at a vertex (Bærentzen and Aanæs, *Signed Distance Computation Using the Angle Weighted Pseudonormal*, 2005). For a
//! closed mesh without self-intersections that sign is exact.

use crate::bvh::{Bvh, nearest_on_triangle};
use glam::DVec3;
use serde::{Deserialize, Serialize};
use std::collections::HashMap;

/// A mesh that cannot be a body.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ClosedMeshError {
    /// No triangle, or none with an area.
    #[error("the mesh has no volume")]
    Empty,
    /// A triangle that names a vertex that is not there, or a vertex that is not finite.
    #[error("triangle {0} has a vertex that is missing or not finite")]
    Vertex(usize),
    /// An edge without exactly one triangle on each side.
    #[error("the mesh is not closed at the edge {0}–{1}")]
    Open(u32, u32),
}

/// Triangles that face outwards.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Triangles {
    /// Corners [m].
    pub positions: Vec<DVec3>,
    /// Three corners each.
    pub triangles: Vec<[u32; 3]>,
}

impl Triangles {
    fn corners(&self, triangle: usize) -> [DVec3; 3] {
        self.triangles[triangle].map(|v| self.positions[v as usize])
    }

    /// Turns all triangles over if they face inwards.
    ///
    /// # Errors
    /// A vertex that is not there; no volume.
    pub(crate) fn face_outwards(&mut self) -> Result<(), ClosedMeshError> {
        let finite = |v: &u32| self.positions.get(*v as usize).is_some_and(|p| p.is_finite());
        if let Some(bad) = self.triangles.iter().position(|t| !t.iter().all(finite)) {
            return Err(ClosedMeshError::Vertex(bad));
        }
        let at = |v: u32| self.positions[v as usize];
        let six_volumes = |[a, b, c]: [u32; 3]| at(a).dot(at(b).cross(at(c)));
        let volume: f64 = self.triangles.iter().map(|t| six_volumes(*t)).sum();
        if volume == 0.0 {
            return Err(ClosedMeshError::Empty);
        }
        if volume < 0.0 {
            self.triangles.iter_mut().for_each(|t| t.swap(1, 2));
        }
        Ok(())
    }
}

/// Closed triangles that face outwards, to be asked for the nearest point.
pub(crate) struct Surface {
    pub mesh: Triangles,
    normals: PseudoNormals,
    tree: Bvh,
}

/// The point of a surface that is nearest to another.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Nearest {
    /// Signed distance, negative inside [m].
    pub distance: f64,
    /// From the surface outwards, of length one.
    pub normal: DVec3,
    /// The triangle.
    pub triangle: usize,
    /// Barycentric coordinates in it.
    pub weights: [f64; 3],
}

impl Surface {
    /// The surface of triangles that face outwards.
    ///
    /// # Errors
    /// Where they are not closed.
    pub fn new(mesh: Triangles) -> Result<Self, ClosedMeshError> {
        let normals = PseudoNormals::new(&mesh)?;
        let tree = Bvh::new(mesh.triangles.len(), |t| mesh.corners(t));
        Ok(Self { mesh, normals, tree })
    }

    /// The point that is nearest to `x`.
    pub fn nearest(&self, x: DVec3) -> Option<Nearest> {
        let measure = |t: usize| {
            let (corners, weights) = (self.mesh.corners(t), nearest_on_triangle(self.mesh.corners(t), x));
            let nearest = weights[0] * corners[0] + weights[1] * corners[1] + weights[2] * corners[2];
            (x.distance_squared(nearest), (nearest, weights))
        };
        let (square, triangle, (nearest, weights)) = self.tree.nearest(x, measure)?;
        let outward = self.normals.at(&self.mesh, triangle, weights);
        let side = 1f64.copysign((x - nearest).dot(outward));
        let normal = (side * (x - nearest)).try_normalize().or(outward.try_normalize());
        Some(Nearest {
            distance: side * square.sqrt(),
            normal: normal.unwrap_or(DVec3::Y),
            triangle,
            weights,
        })
    }
}

/// Normals of triangles, edges and vertices that tell inside from outside.
struct PseudoNormals {
    of_triangle: Vec<DVec3>,
    /// By their ends, the lower first.
    of_edge: HashMap<[u32; 2], DVec3>,
    of_vertex: Vec<DVec3>,
}

impl PseudoNormals {
    fn new(mesh: &Triangles) -> Result<Self, ClosedMeshError> {
        let corners = |t: &[u32; 3]| t.map(|v| mesh.positions[v as usize]);
        let normal = |t| {
            let [a, b, c] = corners(t);
            (b - a).cross(c - a).normalize_or_zero()
        };
        let of_triangle: Vec<DVec3> = mesh.triangles.iter().map(normal).collect();
        let mut sides: HashMap<[u32; 2], (DVec3, i32, u32)> = HashMap::new();
        let mut of_vertex = vec![DVec3::ZERO; mesh.positions.len()];
        for (t, n) in mesh.triangles.iter().zip(&of_triangle) {
            for i in 0..3 {
                let [a, b, c] = [t[i], t[(i + 1) % 3], t[(i + 2) % 3]];
                let side = sides.entry([a.min(b), a.max(b)]).or_default();
                side.0 += *n;
                side.1 += if a < b { 1 } else { -1 };
                side.2 += 1;
                let [p, q, r] = [a, b, c].map(|v| mesh.positions[v as usize]);
                of_vertex[a as usize] += (q - p).angle_between(r - p) * *n;
            }
        }
        // Each edge is passed once each way.
        if let Some(([a, b], _)) = sides.iter().find(|(_, (_, ways, count))| *ways != 0 || *count != 2) {
            return Err(ClosedMeshError::Open(*a, *b));
        }
        let of_edge = sides.into_iter().map(|(ends, (n, ..))| (ends, n)).collect();
        Ok(Self { of_triangle, of_edge, of_vertex })
    }

    /// The normal at a point of triangle `t` with these barycentric coordinates.
    fn at(&self, mesh: &Triangles, t: usize, weights: [f64; 3]) -> DVec3 {
        let corners = mesh.triangles[t];
        let mut touched = (0..3).filter(|i| weights[*i] > 1e-9).map(|i| corners[i]);
        match [touched.next(), touched.next(), touched.next()] {
            [Some(v), None, _] => self.of_vertex[v as usize],
            [Some(a), Some(b), None] => self.of_edge[&[a.min(b), a.max(b)]],
            _ => self.of_triangle[t],
        }
    }
}
