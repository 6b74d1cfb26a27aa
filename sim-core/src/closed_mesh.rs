//! A closed mesh as a body: its signed distance on a grid.
//!
//! # Theory
//! The distance to the surface (`closed_surface.rs`) is sampled at the corners of cubic cells and interpolated trilinearly: the error is about cell² × curvature/8 on smooth parts and
//! a part of a cell at edges, which come out rounded. The normal is the gradient of the interpolation.
//!
//! # Practice
//! The grid goes two cells beyond the mesh. From outside of it the distance is that to the grid plus that at the nearest point
//! of the grid: never less than the true one, and fabric that far away does not touch.

use crate::closed_surface::{ClosedMeshError, Surface, Triangles};
use glam::{DVec3, UVec3};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Cells along the longest side of a mesh.
const CELLS: f64 = 64.0;

/// Cells between the mesh and the border of the grid.
const MARGIN: f64 = 2.0;

/// A closed mesh with its signed distance.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(try_from = "Triangles", into = "Triangles")]
pub struct ClosedMesh {
    triangles: Arc<Triangles>,
    field: Arc<Field>,
}

/// Distances at the corners of cells.
#[derive(Debug)]
struct Field {
    low: DVec3,
    /// Side of a cell [m].
    cell: f64,
    /// Corners along each axis.
    corners: UVec3,
    /// x runs fastest [m].
    distance: Vec<f32>,
}

impl PartialEq for ClosedMesh {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.triangles, &other.triangles) || self.triangles == other.triangles
    }
}

impl TryFrom<Triangles> for ClosedMesh {
    type Error = ClosedMeshError;

    fn try_from(mesh: Triangles) -> Result<Self, ClosedMeshError> {
        Self::new(mesh)
    }
}

impl From<ClosedMesh> for Triangles {
    fn from(mesh: ClosedMesh) -> Self {
        (*mesh.triangles).clone()
    }
}

impl ClosedMesh {
    /// The body of closed triangles, all facing outwards or all inwards.
    ///
    /// # Errors
    /// Where the mesh is not closed.
    pub fn new(mut mesh: Triangles) -> Result<Self, ClosedMeshError> {
        mesh.face_outwards()?;
        let surface = Surface::new(mesh)?;
        let field = Field::new(&surface);
        Ok(Self { triangles: Arc::new(surface.mesh), field: Arc::new(field) })
    }

    /// Its triangles.
    pub fn triangles(&self) -> &Triangles {
        &self.triangles
    }

    /// The grid of distances: its lowest corner, the side of a cell [m], corners along each axis, and the distances there, x
    /// running fastest [m].
    pub(crate) fn grid(&self) -> (DVec3, f64, UVec3, &[f32]) {
        let Field { low, cell, corners, distance } = &*self.field;
        (*low, *cell, *corners, distance)
    }

    /// The box around the grid [m].
    pub(crate) fn bounds(&self) -> [DVec3; 2] {
        let Field { low, cell, corners, .. } = &*self.field;
        [*low, *low + *cell * (corners - 1).as_dvec3()]
    }

    /// Signed distance of `x` from the surface, negative inside [m], and the unit normal there.
    pub fn distance(&self, x: DVec3) -> (f64, DVec3) {
        self.field.sample(x)
    }
}

impl Field {
    fn new(surface: &Surface) -> Self {
        let mesh = &surface.mesh;
        let all = || mesh.triangles.iter().flatten().map(|v| mesh.positions[*v as usize]);
        let (low, high) =
            all().fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(l, h), p| (l.min(p), h.max(p)));
        let cell = (high - low).max_element() / CELLS;
        let low = low - MARGIN * cell;
        let corners = ((high - low) / cell + MARGIN).ceil().as_uvec3() + 1;
        let distance = |index: usize| {
            let (index, [nx, ny]) = (index as u32, [corners.x, corners.y]);
            let place = UVec3::new(index % nx, index / nx % ny, index / nx / ny);
            surface.nearest(low + cell * place.as_dvec3()).map_or(f32::INFINITY, |n| n.distance as f32)
        };
        let count = corners.element_product() as usize;
        Self { low, cell, corners, distance: (0..count).into_par_iter().map(distance).collect() }
    }

    fn sample(&self, x: DVec3) -> (f64, DVec3) {
        let most = (self.corners - 1).as_dvec3();
        let place = (x - self.low) / self.cell;
        let inside = place.clamp(DVec3::ZERO, most);
        let first = inside.floor().min(most - 1.0);
        let part = inside - first;
        let [nx, ny] = [self.corners.x as usize, self.corners.y as usize];
        let start = first.as_uvec3();
        let start = start.x as usize + nx * (start.y as usize + ny * start.z as usize);
        let at = |i: usize, j: usize, k: usize| f64::from(self.distance[start + i + nx * (j + ny * k)]);
        let mix = |a: f64, b: f64, t: f64| a + (b - a) * t;
        // Along x at the four edges, along y at the two faces, along z.
        let edge = |j, k| mix(at(0, j, k), at(1, j, k), part.x);
        let face = |k| mix(edge(0, k), edge(1, k), part.y);
        let slope_x = |j, k| at(1, j, k) - at(0, j, k);
        let gradient = DVec3::new(
            mix(mix(slope_x(0, 0), slope_x(1, 0), part.y), mix(slope_x(0, 1), slope_x(1, 1), part.y), part.z),
            mix(edge(1, 0) - edge(0, 0), edge(1, 1) - edge(0, 1), part.z),
            face(1) - face(0),
        );
        let beyond = self.cell * (place - inside);
        let distance = mix(face(0), face(1), part.z) + beyond.length();
        let normal = if beyond == DVec3::ZERO { gradient } else { beyond };
        (distance, normal.try_normalize().unwrap_or(DVec3::Y))
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use crate::noise::unit_hash;

    /// A box around the origin.
    pub fn cuboid(half: DVec3) -> Triangles {
        let corner = |i: u32| {
            half * (DVec3::new(f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2)) * 2.0 - 1.0)
        };
        let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        Triangles {
            positions: (0..8).map(corner).collect(),
            triangles: quads.iter().flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]).collect(),
        }
    }

    /// A ball about the origin, its points on the sphere.
    pub fn ball(radius: f64) -> Triangles {
        let (around, rings) = (64, 32);
        let mut positions = vec![DVec3::NEG_Y * radius, DVec3::Y * radius];
        for ring in 1..rings {
            let latitude = std::f64::consts::PI * (f64::from(ring) / f64::from(rings) - 0.5);
            positions.extend((0..around).map(|i| {
                let (sin, cos) = (std::f64::consts::TAU * f64::from(i) / f64::from(around)).sin_cos();
                radius * DVec3::new(cos * latitude.cos(), latitude.sin(), sin * latitude.cos())
            }));
        }
        let at = |ring: i32, i: i32| (2 + (ring - 1) * around + i % around) as u32;
        let mut triangles = Vec::new();
        for i in 0..around {
            triangles.extend([[0, at(1, i), at(1, i + 1)], [1, at(rings - 1, i + 1), at(rings - 1, i)]]);
            for ring in 1..rings - 1 {
                let [a, b, c, d] = [at(ring, i), at(ring, i + 1), at(ring + 1, i + 1), at(ring + 1, i)];
                triangles.extend([[a, c, b], [a, d, c]]);
            }
        }
        Triangles { positions, triangles }
    }

    fn points(size: f64) -> impl Iterator<Item = DVec3> {
        let at = |i: u64| DVec3::new(unit_hash(3 * i), unit_hash(3 * i + 1), unit_hash(3 * i + 2));
        (0..2000).map(move |i| size * (2.0 * at(i) - 1.0))
    }

    #[test]
    fn a_ball_has_the_distance_of_a_sphere() {
        let radius = 0.1;
        let body = ClosedMesh::new(ball(radius)).unwrap();
        let cell = 2.0 * radius / CELLS;
        for x in points(0.104).filter(|x| x.length() > 0.02) {
            let (distance, normal) = body.distance(x);
            // The triangles lie up to 1 − cos(π/64) inside of the sphere.
            assert!((distance - (x.length() - radius)).abs() < 0.1 * cell, "{distance} at {x}");
            assert!(normal.dot(x.normalize()) > 0.99, "{normal} at {x}");
        }
        let far = DVec3::new(0.3, 0.4, 0.0);
        let (distance, normal) = body.distance(far);
        assert!((0.399..0.45).contains(&distance) && normal.dot(far) > 0.3, "{distance}");
    }

    #[test]
    fn a_box_has_the_distance_of_a_box() {
        let half = DVec3::new(0.1, 0.05, 0.08);
        let mut inward = cuboid(half);
        inward.triangles.iter_mut().for_each(|t| t.swap(0, 1));
        for mesh in [cuboid(half), inward] {
            let body = ClosedMesh::new(mesh).unwrap();
            let cell = 0.2 / CELLS;
            for x in points(0.1) {
                let q = x.abs() - half;
                let exact = q.max(DVec3::ZERO).length() + q.max_element().min(0.0);
                let (distance, _) = body.distance(x);
                assert!(
                    (distance - exact).abs() < 0.5 * cell || exact > 2.0 * cell,
                    "{distance} for {exact} at {x}"
                );
            }
        }
    }

    #[test]
    fn meshes_that_are_not_closed_are_refused() {
        let mut open = cuboid(DVec3::ONE);
        open.triangles.pop();
        assert!(matches!(ClosedMesh::new(open), Err(ClosedMeshError::Open(..))));
        let mut flat = cuboid(DVec3::ONE);
        flat.positions.iter_mut().for_each(|p| p.z = 0.0);
        assert_eq!(ClosedMesh::new(flat).unwrap_err(), ClosedMeshError::Empty);
        let mut wild = cuboid(DVec3::ONE);
        wild.triangles[3][1] = 99;
        assert_eq!(ClosedMesh::new(wild).unwrap_err(), ClosedMeshError::Vertex(3));
    }

    #[test]
    fn a_mesh_is_written_and_read() {
        let body = ClosedMesh::new(cuboid(DVec3::ONE)).unwrap();
        let plain: Triangles = body.clone().into();
        assert_eq!(ClosedMesh::try_from(plain).unwrap(), body);
    }
}
