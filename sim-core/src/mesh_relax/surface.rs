//! The surface on which stitches move: a triangulation of the smooth surface of the input, and its borders.
//!
//! The triangles *are* the surface from here on: a vertex of the stitch mesh is a triangle and barycentric coordinates in it,
//! so it lies on the surface up to rounding, and its normal is interpolated from those at the corners, so that the directions
//! in which it may move do not jump at the edges of triangles. A vertex on a border is a place on the border's polyline.

use glam::DVec3;
use stitch_mesh::mesh::PolygonMesh;
use stitch_mesh::subdivide::Subdivision;

/// No neighbour.
pub(super) const NONE: u32 = u32::MAX;

/// Fewest levels of subdivision: curves of borders and of coarse meshes come out round.
const FEWEST_LEVELS: u32 = 3;

/// More quads than this are not made, however many stitches there are.
const MOST_QUADS: usize = 4_000_000;

/// Triangles with their neighbours, and borders. Lengths in stitches.
pub(super) struct Surface {
    pub points: Vec<DVec3>,
    /// The same points on the flat input.
    pub flat: Vec<DVec3>,
    /// Unit normals at the points.
    pub normals: Vec<DVec3>,
    pub triangles: Vec<[u32; 3]>,
    /// Triangle across side i, from corner i to corner i + 1.
    pub across: Vec<[u32; 3]>,
    /// Borders one after another, each as its points in order and the first again.
    pub border: Vec<u32>,
    /// Where each border begins in `border`, and one more entry for the end of the last.
    pub border_starts: Vec<u32>,
    /// Directions at the points of `border`, zero where the border has a corner.
    pub tangents: Vec<DVec3>,
}

/// Place of a vertex.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Place {
    /// On a triangle, with barycentric coordinates.
    Inside { triangle: u32, at: [f64; 3] },
    /// Between two points of a border, and how far from the first, 0 … 1.
    Border { border: u32, segment: u32, at: f64 },
    /// At a corner of a border, for good: that point.
    Corner { point: u32 },
}

impl Surface {
    /// The smooth surface of a mesh, with at least about as many triangles as half of `stitches` and lengths divided by
    /// `unit` once [`Self::scale`] is called.
    pub fn new(mesh: &PolygonMesh, stitches: usize) -> Self {
        let enough = |levels: u32| {
            Subdivision::quad_count(mesh, levels) >= stitches
                || Subdivision::quad_count(mesh, levels + 1) > MOST_QUADS
        };
        let levels = (FEWEST_LEVELS..12).find(|l| enough(*l)).unwrap_or(FEWEST_LEVELS);
        Self::of(&Subdivision::new(mesh, levels))
    }

    fn of(fine: &Subdivision) -> Self {
        let mut triangles = Vec::with_capacity(2 * fine.quads.len());
        let mut across = Vec::with_capacity(2 * fine.quads.len());
        let neighbour = |quad: usize, side: usize| match fine.across(quad, side) {
            // Sides 0 and 1 of a quad belong to its first triangle.
            Some((other, there)) => (2 * other + there / 2) as u32,
            None => NONE,
        };
        for (q, [a, b, c, d]) in fine.quads.iter().copied().enumerate() {
            triangles.extend([[a, b, c], [a, c, d]]);
            across.push([neighbour(q, 0), neighbour(q, 1), 2 * q as u32 + 1]);
            across.push([2 * q as u32, neighbour(q, 2), neighbour(q, 3)]);
        }
        let points = fine.smooth.clone();
        let mut normals = vec![DVec3::ZERO; points.len()];
        for triangle in &triangles {
            let [a, b, c] = triangle.map(|v| points[v as usize]);
            triangle.iter().for_each(|v| normals[*v as usize] += (b - a).cross(c - a));
        }
        normals.iter_mut().for_each(|n| *n = n.normalize_or(DVec3::Z));

        let mut is_corner = vec![false; points.len()];
        fine.corners.iter().for_each(|v| is_corner[*v as usize] = true);
        let (mut border, mut border_starts, mut tangents) = (Vec::new(), vec![0], Vec::new());
        for ring in fine.borders() {
            let at = |i: usize| points[ring[i % ring.len()] as usize];
            let tangent = |i: usize| {
                let (before, after) = (at(i) - at(i + ring.len() - 1), at(i + 1) - at(i));
                let smooth = before.normalize_or_zero() + after.normalize_or_zero();
                if is_corner[ring[i % ring.len()] as usize] {
                    DVec3::ZERO
                } else {
                    smooth.normalize_or_zero()
                }
            };
            tangents.extend((0..=ring.len()).map(tangent));
            border.extend(ring.iter().chain(ring.first()));
            border_starts.push(border.len() as u32);
        }
        Self { points, flat: fine.flat.clone(), normals, triangles, across, border, border_starts, tangents }
    }

    /// Divides all lengths by `unit`.
    pub fn scale(&mut self, unit: f64) {
        self.points.iter_mut().chain(&mut self.flat).for_each(|p| *p /= unit);
    }

    /// Area of all triangles.
    pub fn area(&self) -> f64 {
        let area = |t: &[u32; 3]| {
            let [a, b, c] = t.map(|v| self.points[v as usize]);
            0.5 * (b - a).cross(c - a).length()
        };
        self.triangles.iter().map(area).sum()
    }

    /// Corners of a triangle.
    pub fn corners(&self, triangle: usize) -> [DVec3; 3] {
        self.triangles[triangle].map(|v| self.points[v as usize])
    }

    /// Ends of a segment of the borders, an index into `border`.
    pub fn segment(&self, segment: usize) -> [DVec3; 2] {
        [0, 1].map(|i| self.points[self.border[segment + i] as usize])
    }

    /// Where a place is.
    pub fn position(&self, place: &Place) -> DVec3 {
        match place {
            Place::Inside { triangle, at } => {
                let [a, b, c] = self.corners(*triangle as usize);
                at[0] * a + at[1] * b + at[2] * c
            }
            Place::Border { segment, at, .. } => {
                let [a, b] = self.segment(*segment as usize);
                a.lerp(b, *at)
            }
            Place::Corner { point } => self.points[*point as usize],
        }
    }

    /// The unit normal at a place.
    pub fn normal(&self, place: &Place) -> DVec3 {
        let normal = |point: u32| self.normals[point as usize];
        match place {
            Place::Inside { triangle, at } => {
                let [a, b, c] = self.triangles[*triangle as usize].map(normal);
                (at[0] * a + at[1] * b + at[2] * c).normalize_or(a)
            }
            Place::Border { segment, at, .. } => {
                let [a, b] = [0, 1].map(|i| normal(self.border[*segment as usize + i]));
                a.lerp(b, *at).normalize_or(a)
            }
            Place::Corner { point } => normal(*point),
        }
    }

    /// Directions in which a vertex at a place may move: two in the tangent plane, one along a border, none at a corner.
    pub fn frame(&self, place: &Place) -> [DVec3; 2] {
        match place {
            Place::Inside { .. } => {
                let (u, v) = self.normal(place).any_orthonormal_pair();
                [u, v]
            }
            Place::Border { segment, at, .. } => {
                let s = *segment as usize;
                let [a, b] = self.segment(s);
                let straight = (b - a).normalize_or_zero();
                let end =
                    |i: usize| if self.tangents[i] == DVec3::ZERO { straight } else { self.tangents[i] };
                [end(s).lerp(end(s + 1), *at).normalize_or(straight), DVec3::ZERO]
            }
            Place::Corner { .. } => [DVec3::ZERO; 2],
        }
    }
}
