//! The polygon mesh: a half-edge structure for n-gons with borders and any number of components (stage 0 of the flow).
//!
//! Half-edges of one face lie one after another in memory, in the order in which the face was given (counter-clockwise seen
//! from the front). A border edge has one half-edge, an inner edge two. Built once and never changed: an edit of the faces
//! builds a new mesh, so the invariants checked by [`crate::validate`] hold for as long as the mesh lives.

use crate::corners::Corners;
use crate::ids::{EdgeId, FaceId, HalfEdgeId, VertexId};
use crate::sides::Sides;
pub use crate::validate::MeshError;
use crate::validate::{MeshProblem, area_vector, check, position_problems};
use glam::DVec3;
use rayon::prelude::*;
use std::ops::Range;

/// A half-edge mesh of polygons. See the module.
#[derive(Clone, Debug, PartialEq)]
pub struct PolygonMesh {
    pub(crate) positions: Vec<DVec3>,
    pub(crate) sides: Sides,
    /// The faces around every vertex.
    pub(crate) corners: Corners,
}

impl PolygonMesh {
    /// Builds the mesh from vertex positions [m] and faces (vertex indices, counter-clockwise seen from the front).
    ///
    /// # Errors
    /// Everything that [`crate::validate::validate`] finds.
    pub fn new(positions: Vec<DVec3>, faces: &[impl AsRef<[u32]> + Sync]) -> Result<Self, MeshError> {
        let build = |corners: &Corners| Sides::of(positions.len(), faces, corners);
        let (corners, sides) = check(&positions, faces, build).map_err(MeshError)?;
        Ok(Self { positions, sides, corners })
    }

    /// The mesh without faces, where nothing is knitted.
    pub(crate) fn empty() -> Self {
        let faces = [[0; 0]; 0];
        let corners = Corners::new(0, &faces);
        Self { positions: Vec::new(), sides: Sides::of(0, &faces, &corners), corners }
    }

    /// The same mesh with its vertices at other positions [m]. All ids survive.
    ///
    /// # Errors
    /// A number of positions that is not that of the vertices; coordinates that are not finite; faces without area.
    pub fn moved_to(&self, positions: Vec<DVec3>) -> Result<Self, MeshError> {
        if positions.len() != self.vertex_count() {
            return Err(MeshError(vec![MeshProblem::PositionCount {
                given: positions.len(),
                vertices: self.vertex_count(),
            }]));
        }
        let problems = position_problems(&positions, &self.face_lists());
        if !problems.is_empty() {
            return Err(MeshError(problems));
        }
        Ok(Self { positions, ..self.clone() })
    }

    /// Vertex positions, [vertex_count] [m].
    pub fn positions(&self) -> &[DVec3] {
        &self.positions
    }

    /// The position of one vertex [m].
    pub fn position(&self, vertex: VertexId) -> DVec3 {
        self.positions[vertex.index()]
    }

    /// Number of vertices.
    pub fn vertex_count(&self) -> usize {
        self.positions.len()
    }

    /// Number of half-edges.
    pub fn half_edge_count(&self) -> usize {
        self.sides.half_edges.len()
    }

    /// Number of edges.
    pub fn edge_count(&self) -> usize {
        self.sides.edges.len()
    }

    /// Number of faces.
    pub fn face_count(&self) -> usize {
        self.sides.face_starts.len() - 1
    }

    /// All faces.
    pub fn faces(&self) -> impl ExactSizeIterator<Item = FaceId> + Clone + use<> {
        (0..self.face_count()).map(FaceId::new)
    }

    /// All edges.
    pub fn edges(&self) -> impl ExactSizeIterator<Item = EdgeId> + use<> {
        (0..self.edge_count()).map(EdgeId::new)
    }

    pub(crate) fn face_range(&self, face: FaceId) -> Range<u32> {
        self.sides.face_starts[face.index()]..self.sides.face_starts[face.index() + 1]
    }

    /// The half-edge with which a face begins.
    pub fn first_half_edge(&self, face: FaceId) -> HalfEdgeId {
        HalfEdgeId(self.sides.face_starts[face.index()])
    }

    /// Half-edges of a face, in its order.
    pub fn face_half_edges(
        &self,
        face: FaceId,
    ) -> impl ExactSizeIterator<Item = HalfEdgeId> + DoubleEndedIterator + use<> {
        self.face_range(face).map(HalfEdgeId)
    }

    /// Vertices of a face, in its order.
    pub fn face_vertices(&self, face: FaceId) -> impl ExactSizeIterator<Item = VertexId> + '_ {
        self.face_half_edges(face).map(|h| self.origin(h))
    }

    /// The faces as lists of vertex indices, as they were given to [`PolygonMesh::new`].
    pub fn face_lists(&self) -> Vec<Vec<u32>> {
        self.faces().map(|f| self.face_vertices(f).map(|v| v.0).collect()).collect()
    }

    /// The vertex at which a half-edge starts.
    pub fn origin(&self, h: HalfEdgeId) -> VertexId {
        self.sides.half_edges[h.index()].origin
    }

    /// The vertex at which a half-edge ends.
    pub fn tip(&self, h: HalfEdgeId) -> VertexId {
        self.origin(self.next(h))
    }

    /// The face on the left of a half-edge.
    pub fn face(&self, h: HalfEdgeId) -> FaceId {
        self.sides.half_edges[h.index()].face
    }

    /// The next half-edge of the same face.
    pub fn next(&self, h: HalfEdgeId) -> HalfEdgeId {
        let range = self.face_range(self.face(h));
        if h.0 + 1 < range.end { HalfEdgeId(h.0 + 1) } else { HalfEdgeId(range.start) }
    }

    /// The half-edge before this one in the same face.
    pub fn prev(&self, h: HalfEdgeId) -> HalfEdgeId {
        let range = self.face_range(self.face(h));
        if h.0 > range.start { HalfEdgeId(h.0 - 1) } else { HalfEdgeId(range.end - 1) }
    }

    /// The half-edge on the other side of the same edge; none on the border.
    pub fn twin(&self, h: HalfEdgeId) -> Option<HalfEdgeId> {
        self.sides.half_edges[h.index()].twin
    }

    /// The face across a half-edge; none on the border.
    pub fn face_across(&self, h: HalfEdgeId) -> Option<FaceId> {
        self.twin(h).map(|t| self.face(t))
    }

    /// The edge of a half-edge.
    pub fn edge(&self, h: HalfEdgeId) -> EdgeId {
        self.sides.half_edges[h.index()].edge
    }

    /// The first half-edge of an edge, and its twin where there is one.
    pub fn edge_sides(&self, edge: EdgeId) -> (HalfEdgeId, Option<HalfEdgeId>) {
        let first = self.sides.edges[edge.index()];
        (first, self.twin(first))
    }

    /// Both ends of an edge.
    pub fn edge_ends(&self, edge: EdgeId) -> [VertexId; 2] {
        let first = self.sides.edges[edge.index()];
        [self.origin(first), self.tip(first)]
    }

    /// The edge between two vertices.
    pub fn edge_between(&self, a: VertexId, b: VertexId) -> Option<EdgeId> {
        let h = self.half_edge_between(a, b).or_else(|| self.half_edge_between(b, a))?;
        Some(self.edge(h))
    }

    /// The half-edge that runs from one vertex to another.
    pub fn half_edge_between(&self, from: VertexId, to: VertexId) -> Option<HalfEdgeId> {
        let exists = from.index() < self.positions.len();
        exists.then(|| self.corners.half_edge(from.0, to.0))?.map(HalfEdgeId)
    }

    /// The half-edges that start at a vertex, one for each face around it.
    pub fn outgoing(&self, vertex: VertexId) -> impl ExactSizeIterator<Item = HalfEdgeId> + '_ {
        self.corners.at(vertex.0).iter().map(|c| HalfEdgeId(c.half_edge))
    }

    /// Whether an edge lies on the border.
    pub fn is_border(&self, edge: EdgeId) -> bool {
        self.edge_sides(edge).1.is_none()
    }

    /// Length of an edge [m].
    pub fn edge_length(&self, edge: EdgeId) -> f64 {
        let [a, b] = self.edge_ends(edge);
        self.position(a).distance(self.position(b))
    }

    /// Number of faces around a vertex.
    pub fn valence(&self, vertex: VertexId) -> usize {
        self.corners.at(vertex.0).len()
    }

    /// The border half-edge that follows a border half-edge; with the faces on the left, a border runs clockwise around its
    /// hole and counter-clockwise around a flat piece.
    pub fn next_on_border(&self, h: HalfEdgeId) -> Option<HalfEdgeId> {
        self.sides.border_from[self.tip(h).index()]
    }

    /// Every border as a ring of half-edges.
    pub fn borders(&self) -> Vec<Vec<HalfEdgeId>> {
        let mut seen = vec![false; self.sides.half_edges.len()];
        let mut borders = Vec::new();
        for start in (0..self.sides.half_edges.len()).map(HalfEdgeId::new) {
            if self.twin(start).is_some() || seen[start.index()] {
                continue;
            }
            let mut ring = Vec::new();
            let mut at = Some(start);
            while let Some(h) = at.filter(|h| !seen[h.index()]) {
                seen[h.index()] = true;
                ring.push(h);
                at = self.next_on_border(h);
            }
            borders.push(ring);
        }
        borders
    }

    /// The component of every face, numbered from 0 in order of first face, [face_count].
    pub fn components(&self) -> Vec<usize> {
        let mut component = vec![usize::MAX; self.face_count()];
        let mut count = 0;
        for start in self.faces() {
            if component[start.index()] != usize::MAX {
                continue;
            }
            let mut open = vec![start];
            component[start.index()] = count;
            while let Some(face) = open.pop() {
                for other in self.face_half_edges(face).filter_map(|h| self.face_across(h)) {
                    if component[other.index()] == usize::MAX {
                        component[other.index()] = count;
                        open.push(other);
                    }
                }
            }
            count += 1;
        }
        component
    }

    /// Mean of a face's vertices [m].
    pub fn face_center(&self, face: FaceId) -> DVec3 {
        let n = self.face_half_edges(face).len() as f64;
        self.face_vertices(face).map(|v| self.position(v)).sum::<DVec3>() / n
    }

    /// Area vector of a face (Newell): its length is the area [m²], its direction the front.
    pub fn face_area_vector(&self, face: FaceId) -> DVec3 {
        area_vector(self.face_vertices(face).map(|v| self.position(v)))
    }

    /// Unit normals at the vertices, area-weighted, [vertex_count].
    pub fn vertex_normals(&self) -> Vec<DVec3> {
        let areas: Vec<DVec3> =
            (0..self.face_count()).into_par_iter().map(|f| self.face_area_vector(FaceId::new(f))).collect();
        let around =
            |v: u32| self.corners.at(v).iter().map(|c| self.sides.half_edges[c.half_edge as usize].face);
        let normal = |v: u32| around(v).map(|f| areas[f.index()]).sum::<DVec3>().normalize_or(DVec3::Z);
        (0..self.positions.len() as u32).into_par_iter().map(normal).collect()
    }

    /// Smallest and largest coordinates [m].
    pub fn bounds(&self) -> [DVec3; 2] {
        self.positions
            .iter()
            .fold([DVec3::INFINITY, DVec3::NEG_INFINITY], |[lo, hi], p| [lo.min(*p), hi.max(*p)])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3Swizzles as _;

    /// Two quads side by side.
    fn pair() -> PolygonMesh {
        let positions = [(0, 0), (1, 0), (2, 0), (2, 1), (1, 1), (0, 1)]
            .map(|(x, y)| DVec3::new(x as f64, y as f64, 0.0));
        PolygonMesh::new(positions.to_vec(), &[vec![0, 1, 4, 5], vec![1, 2, 3, 4]]).unwrap()
    }

    #[test]
    fn twins_meet_and_borders_run_round() {
        let mesh = pair();
        assert_eq!((mesh.edge_count(), mesh.face_count()), (7, 2));
        for h in (0..mesh.half_edge_count()).map(HalfEdgeId::new) {
            assert_eq!(mesh.prev(mesh.next(h)), h);
            if let Some(t) = mesh.twin(h) {
                assert_eq!(mesh.twin(t), Some(h));
                assert_eq!(mesh.origin(t), mesh.tip(h));
                assert_eq!(mesh.edge(t), mesh.edge(h));
            }
        }
        let borders = mesh.borders();
        assert_eq!(borders.len(), 1);
        assert_eq!(borders[0].len(), 6);
    }

    #[test]
    fn normals_and_areas() {
        let mesh = pair();
        assert!((mesh.face_area_vector(FaceId(0)) - DVec3::Z).length() < 1e-12);
        assert!(mesh.vertex_normals().iter().all(|n| (*n - DVec3::Z).length() < 1e-12));
    }

    #[test]
    fn moving_keeps_everything_but_the_positions() {
        let mesh = pair();
        let there: Vec<DVec3> = mesh.positions().iter().map(|p| 2.0 * p.yzx() + DVec3::Z).collect();
        let moved = mesh.moved_to(there.clone()).unwrap();
        assert_eq!(moved, PolygonMesh::new(there.clone(), &mesh.face_lists()).unwrap());
        assert!(mesh.moved_to(there[1..].to_vec()).unwrap_err().to_string().contains("5 positions"));
        assert!(mesh.moved_to(vec![DVec3::ZERO; 6]).unwrap_err().to_string().contains("no area"));
        assert!(mesh.moved_to(vec![DVec3::NAN; 6]).is_err());
    }

    #[test]
    fn components_are_told_apart() {
        let mut positions = pair().positions().to_vec();
        positions.extend([DVec3::Z, DVec3::Z + DVec3::X, DVec3::Z + DVec3::Y]);
        let mut faces = pair().face_lists();
        faces.push(vec![6, 7, 8]);
        let mesh = PolygonMesh::new(positions, &faces).unwrap();
        assert_eq!(mesh.components(), [0, 0, 1]);
    }
}
