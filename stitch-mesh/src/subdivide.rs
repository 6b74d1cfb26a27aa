//! Catmull–Clark subdivision of a polygon mesh, with the flat mesh of the same topology beside it.
//!
//! # Theory
//! Catmull & Clark, *Recursively generated B-spline surfaces on arbitrary topological meshes* (1978). One level turns every
//! n-gon into n quads. With F the mean of a face's corners, M the middle of an edge, n the number of faces at a vertex S, and
//! Q, R the means of F and M around it:
//!
//! | new vertex | inside | on the border |
//! |---|---|---|
//! | of a face | F | |
//! | of an edge | (M + mean of both F) / 2 | M |
//! | of a vertex | (Q + 2R + (n − 3)S) / n | (A + 6S + B) / 8, with A, B its neighbours on the border |
//!
//! So borders are cubic B-splines of the border alone. A border vertex with a single face is a corner and stays.
//!
//! The **flat** mesh is refined at the same time with F, M and S themselves: it never leaves the polygons of the input (an
//! n-gon that is not plane is cut into n pieces about its middle). A point found on the flat mesh is carried to the same
//! place of the same quad of the smooth one (Yuksel et al. §6.1).
//!
//! # Practice
//! Half-edges are refined by index alone, as in Dupuy & Vanhoey, *A Halfedge Refinement Rule for Parallel Catmull-Clark
//! Subdivision* (2021): half-edge h becomes the four half-edges 4h … 4h + 3 of the quad at its origin, and twins, edges and
//! vertices follow from those of h. No hashing and no sorting at any level, and the same mesh always gives the same quads.

use crate::ids::HalfEdgeId;
use crate::mesh::PolygonMesh;
use glam::DVec3;

/// No half-edge.
const NONE: u32 = u32::MAX;

/// A mesh after some levels of subdivision: quads, their smooth positions and their flat ones.
#[derive(Clone, Debug, PartialEq)]
pub struct Subdivision {
    /// Corners of every quad, counter-clockwise seen from the front, [quad_count].
    pub quads: Vec<[u32; 4]>,
    /// For side i of quad q, from corner i to corner i + 1, at 4q + i: the same side seen from the other quad, [4 quad_count].
    twins: Vec<u32>,
    /// Positions on the smooth surface, [vertex_count] [m].
    pub smooth: Vec<DVec3>,
    /// Positions on the input, [vertex_count] [m].
    pub flat: Vec<DVec3>,
    /// Border vertices that stay where they are: those with a single face in the input.
    pub corners: Vec<u32>,
}

impl Subdivision {
    /// Subdivides a mesh; level 0 is taken for level 1, the first that has only quads.
    pub fn new(mesh: &PolygonMesh, levels: u32) -> Self {
        let mut level = Level::of(mesh);
        let (mut smooth, mut flat) = (mesh.positions().to_vec(), mesh.positions().to_vec());
        for _ in 0..levels.max(1) {
            (smooth, flat) = (level.smooth(&smooth), level.flat(&flat));
            level = level.refined();
        }
        let corners = (0..mesh.vertex_count() as u32).filter(|v| mesh.valence(crate::ids::VertexId(*v)) == 1);
        let quads = level.origin.as_chunks().0.to_vec();
        Self { quads, twins: level.twin, smooth, flat, corners: corners.collect() }
    }

    /// Number of quads that `levels` of subdivision make of a mesh.
    pub fn quad_count(mesh: &PolygonMesh, levels: u32) -> usize {
        4usize.saturating_pow(levels.max(1) - 1).saturating_mul(mesh.half_edge_count())
    }

    /// The quad across side `side` of a quad, and its side there; none on the border.
    pub fn across(&self, quad: usize, side: usize) -> Option<(usize, usize)> {
        match self.twins[4 * quad + side] {
            NONE => None,
            twin => Some((twin as usize / 4, twin as usize % 4)),
        }
    }

    /// Every border as a ring of vertices, running with the faces on the left.
    pub fn borders(&self) -> Vec<Vec<u32>> {
        let mut next = vec![NONE; self.smooth.len()];
        let sides = || (0..self.twins.len()).filter(|h| self.twins[*h] == NONE);
        let ends = |h: usize| (self.quads[h / 4][h % 4], self.quads[h / 4][(h + 1) % 4]);
        for (from, to) in sides().map(ends) {
            next[from as usize] = to;
        }
        let mut borders = Vec::new();
        for (start, _) in sides().map(ends) {
            let mut ring = Vec::new();
            let mut at = start;
            while next[at as usize] != NONE {
                ring.push(at);
                at = std::mem::replace(&mut next[at as usize], NONE);
            }
            if !ring.is_empty() {
                borders.push(ring);
            }
        }
        borders
    }
}

/// The topology of one level, by half-edge.
struct Level {
    vertex_count: usize,
    edge_count: usize,
    face_count: usize,
    origin: Vec<u32>,
    twin: Vec<u32>,
    edge: Vec<u32>,
    face: Vec<u32>,
    next: Vec<u32>,
    prev: Vec<u32>,
}

impl Level {
    fn of(mesh: &PolygonMesh) -> Self {
        let all = || (0..mesh.half_edge_count()).map(HalfEdgeId::new);
        Self {
            vertex_count: mesh.vertex_count(),
            edge_count: mesh.edge_count(),
            face_count: mesh.face_count(),
            origin: all().map(|h| mesh.origin(h).0).collect(),
            twin: all().map(|h| mesh.twin(h).map_or(NONE, |t| t.0)).collect(),
            edge: all().map(|h| mesh.edge(h).0).collect(),
            face: all().map(|h| mesh.face(h).0).collect(),
            next: all().map(|h| mesh.next(h).0).collect(),
            prev: all().map(|h| mesh.prev(h).0).collect(),
        }
    }

    fn half_edge_count(&self) -> usize {
        self.origin.len()
    }

    /// Whether a half-edge is the one with the lower number of its edge, so that each edge is met once.
    fn is_first(&self, h: usize) -> bool {
        (h as u32) < self.twin[h]
    }

    fn refined(&self) -> Self {
        let count = 4 * self.half_edge_count();
        let (v, e, f) = (self.vertex_count as u32, self.edge_count as u32, self.face_count as u32);
        let mut fine = Self {
            vertex_count: self.vertex_count + self.edge_count + self.face_count,
            edge_count: 2 * self.edge_count + self.half_edge_count(),
            face_count: self.half_edge_count(),
            origin: Vec::with_capacity(count),
            twin: Vec::with_capacity(count),
            edge: Vec::with_capacity(count),
            face: (0..count as u32).map(|h| h / 4).collect(),
            next: (0..count as u32).map(|h| h / 4 * 4 + (h + 1) % 4).collect(),
            prev: (0..count as u32).map(|h| h / 4 * 4 + (h + 3) % 4).collect(),
        };
        for h in 0..self.half_edge_count() {
            let prev = self.prev[h] as usize;
            // From the vertex to the middle of the edge, to the middle of the face, to the middle of the edge before, back.
            let (edge, edge_before) = (self.edge[h], self.edge[prev]);
            fine.origin.extend([self.origin[h], v + f + edge, v + self.face[h], v + f + edge_before]);
            let twin = self.twin[h];
            fine.twin.extend([
                if twin == NONE { NONE } else { 4 * self.next[twin as usize] + 3 },
                4 * self.next[h] + 2,
                4 * self.prev[h] + 1,
                if self.twin[prev] == NONE { NONE } else { 4 * self.twin[prev] },
            ]);
            fine.edge.extend([
                2 * edge + u32::from(!self.is_first(h)),
                2 * e + h as u32,
                2 * e + self.prev[h],
                2 * edge_before + u32::from(self.is_first(prev)),
            ]);
        }
        fine
    }

    /// Positions of the next level on the flat mesh: vertices, middles of faces, middles of edges.
    fn flat(&self, positions: &[DVec3]) -> Vec<DVec3> {
        let mut out = Vec::with_capacity(self.vertex_count + self.edge_count + self.face_count);
        out.extend_from_slice(positions);
        let mut sums = vec![(DVec3::ZERO, 0.0); self.face_count];
        for h in 0..self.half_edge_count() {
            let (sum, count) = &mut sums[self.face[h] as usize];
            (*sum, *count) = (*sum + positions[self.origin[h] as usize], *count + 1.0);
        }
        out.extend(sums.into_iter().map(|(sum, count)| sum / count));
        let mut middles = vec![DVec3::ZERO; self.edge_count];
        for h in (0..self.half_edge_count()).filter(|h| self.is_first(*h)) {
            middles[self.edge[h] as usize] = self.middle(positions, h);
        }
        out.extend(middles);
        out
    }

    /// Positions of the next level on the smooth surface, in the same order.
    fn smooth(&self, positions: &[DVec3]) -> Vec<DVec3> {
        let mut out = self.flat(positions);
        let (v, f) = (self.vertex_count, self.face_count);
        let mut around = vec![(DVec3::ZERO, DVec3::ZERO, 0.0); v]; // sums of F and of M, and n
        let mut border = vec![DVec3::ZERO; v]; // A + B
        let mut on_border = vec![false; v];
        for h in 0..self.half_edge_count() {
            let (a, b) = (self.origin[h] as usize, self.origin[self.next[h] as usize] as usize);
            let face = out[v + self.face[h] as usize];
            let (faces, edges, n) = &mut around[a];
            (*faces, *edges, *n) = (*faces + face, *edges + self.middle(positions, h), *n + 1.0);
            if self.twin[h] == NONE {
                (border[a], border[b]) = (border[a] + positions[b], border[b] + positions[a]);
                (on_border[a], on_border[b]) = (true, true);
            }
        }
        for a in 0..v {
            let (faces, edges, n) = around[a];
            out[a] = match (on_border[a], n == 1.0) {
                (true, true) => positions[a],
                (true, false) => (border[a] + 6.0 * positions[a]) / 8.0,
                (false, _) => (faces / n + 2.0 * edges / n + (n - 3.0) * positions[a]) / n,
            };
        }
        for h in (0..self.half_edge_count()).filter(|h| self.is_first(*h) && self.twin[*h] != NONE) {
            let faces = [h, self.twin[h] as usize].map(|h| out[v + self.face[h] as usize]);
            out[v + f + self.edge[h] as usize] =
                0.5 * self.middle(positions, h) + 0.25 * (faces[0] + faces[1]);
        }
        out
    }

    fn middle(&self, positions: &[DVec3], h: usize) -> DVec3 {
        let next = self.next[h] as usize;
        0.5 * (positions[self.origin[h] as usize] + positions[self.origin[next] as usize])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::plain_grid;

    fn cube() -> PolygonMesh {
        let sign = |i: u32, bit: u32| if i & bit == 0 { -1.0 } else { 1.0 };
        let positions = (0..8).map(|i| DVec3::new(sign(i, 1), sign(i, 2), sign(i, 4)));
        let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        PolygonMesh::new(positions.collect(), &faces.map(|f| f.to_vec())).unwrap()
    }

    fn near(a: DVec3, b: DVec3) -> bool {
        (a - b).length() < 1e-12
    }

    #[test]
    fn one_level_of_a_cube_is_as_worked_out_by_hand() {
        let fine = Subdivision::new(&cube(), 1);
        assert_eq!((fine.quads.len(), fine.smooth.len()), (24, 26));
        for (smooth, flat) in fine.smooth.iter().zip(&fine.flat) {
            let expected = match flat.abs().element_sum().round() as u32 {
                1 => *flat,             // the middle of a face stays
                2 => *flat * 0.75,      // (2 M + F + F) / 4
                _ => *flat * 5.0 / 9.0, // (Q + 2 R) / 3 with Q = S/3 and R = 2 S/3
            };
            assert!(near(*smooth, expected), "{flat} went to {smooth}");
        }
        assert!(fine.corners.is_empty() && fine.borders().is_empty());
    }

    #[test]
    fn a_cube_tends_to_its_limit_surface() {
        // Limit of a vertex (Halstead, Kass, DeRose 1993): (n² S + 4 Σ M' + Σ F') / (n (n + 5)) over the first level's edge
        // and face points: here (9·5/9 + 4·3/2 + 1) / 24 = 1/2 for every coordinate (M' sum 3/4 + 3/4, F' sum 1).
        let fine = Subdivision::new(&cube(), 6);
        for v in 0..8 {
            assert!((fine.smooth[v] - fine.flat[v] * 0.5).length() < 1e-3, "{}", fine.smooth[v]);
        }
    }

    #[test]
    fn twins_are_mutual_and_meet_end_to_end() {
        for levels in 1..4 {
            let fine = Subdivision::new(&cube(), levels);
            assert_eq!(fine.quads.len(), Subdivision::quad_count(&cube(), levels));
            for (q, quad) in fine.quads.iter().enumerate() {
                for side in 0..4 {
                    let (other, there) = fine.across(q, side).unwrap();
                    assert_eq!(fine.across(other, there), Some((q, side)));
                    let far = fine.quads[other];
                    assert_eq!((far[there], far[(there + 1) % 4]), (quad[(side + 1) % 4], quad[side]));
                }
            }
        }
    }

    #[test]
    fn a_flat_piece_stays_flat_and_keeps_its_corners() {
        let mesh = plain_grid(3, 2);
        let fine = Subdivision::new(&mesh, 3);
        assert!(fine.smooth.iter().all(|p| p.z.abs() < 1e-15));
        assert_eq!(fine.corners.len(), 4);
        for v in &fine.corners {
            assert_eq!(fine.smooth[*v as usize], mesh.positions()[*v as usize]);
        }
        // Its borders are straight, so the B-spline of the border keeps to them.
        let [ring] = &fine.borders()[..] else { panic!("one border") };
        assert_eq!(ring.len(), 2 * (3 + 2) * 8);
        let [low, high] = mesh.bounds();
        for p in ring.iter().map(|v| fine.smooth[*v as usize]) {
            let gap = [p.x - low.x, high.x - p.x, p.y - low.y, high.y - p.y];
            assert!(gap.iter().any(|d| d.abs() < 1e-15) && gap.iter().all(|d| *d > -1e-15), "{p}");
        }
    }

    #[test]
    fn borders_do_not_feel_the_inside() {
        let mesh = plain_grid(3, 3);
        let mut positions = mesh.positions().to_vec();
        positions[5].z = 0.01;
        let bulged = PolygonMesh::new(positions, &mesh.face_lists()).unwrap();
        let (a, b) = (Subdivision::new(&mesh, 2), Subdivision::new(&bulged, 2));
        let ring = a.borders().concat();
        assert!(ring.iter().all(|v| near(a.smooth[*v as usize], b.smooth[*v as usize])));
        assert!(!near(a.smooth[5], b.smooth[5]));
    }

    #[test]
    fn polygons_with_any_number_of_corners() {
        let positions = (0..5).map(|i| {
            let angle = f64::from(i) * std::f64::consts::TAU / 5.0;
            DVec3::new(angle.cos(), angle.sin(), 0.0)
        });
        let apex = [DVec3::new(2.0, 1.0, 0.5)];
        let mesh =
            PolygonMesh::new(positions.chain(apex).collect(), &[vec![0, 1, 2, 3, 4], vec![1, 0, 5]]).unwrap();
        let fine = Subdivision::new(&mesh, 2);
        assert_eq!(fine.quads.len(), 8 * 4);
        let quad_area = |positions: &[DVec3]| -> f64 {
            let corner = |q: &[u32; 4]| q.map(|v| positions[v as usize]);
            let area = |[a, b, c, d]: [DVec3; 4]| 0.5 * (c - a).cross(d - b).length();
            fine.quads.iter().map(corner).map(area).sum()
        };
        let area: f64 = mesh.faces().map(|f| mesh.face_area_vector(f).length()).sum();
        assert!((quad_area(&fine.flat) - area).abs() < 1e-12);
    }
}
