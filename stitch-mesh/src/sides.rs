//! The half-edges of faces: a mesh without its vertices.

use crate::corners::Corners;
use crate::ids::{EdgeId, FaceId, HalfEdgeId, VertexId};

/// One side of an edge.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct HalfEdge {
    pub origin: VertexId,
    pub face: FaceId,
    pub twin: Option<HalfEdgeId>,
    pub edge: EdgeId,
}

impl HalfEdge {
    /// A half-edge whose edge has no number yet.
    pub fn new(origin: VertexId, face: FaceId, twin: Option<HalfEdgeId>) -> Self {
        Self { origin, face, twin, edge: EdgeId(u32::MAX) }
    }
}

/// Half-edges face by face, and their edges.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Sides {
    pub half_edges: Vec<HalfEdge>,
    /// First half-edge of every edge.
    pub edges: Vec<HalfEdgeId>,
    /// First half-edge of every face, and one more entry for the end of the last face.
    pub face_starts: Vec<u32>,
    /// Border half-edge that starts at a vertex, for border vertices.
    pub border_from: Vec<Option<HalfEdgeId>>,
}

impl Sides {
    /// What comes of faces in which something is wrong is no mesh.
    pub fn of(vertex_count: usize, faces: &[impl AsRef<[u32]>], corners: &Corners) -> Self {
        let mut half_edges = Vec::with_capacity(faces.iter().map(|f| f.as_ref().len()).sum());
        let mut face_starts = Vec::with_capacity(faces.len() + 1);
        face_starts.push(0);
        for (face, vertices) in faces.iter().map(AsRef::as_ref).enumerate() {
            for (i, &a) in vertices.iter().enumerate() {
                let b = vertices[(i + 1) % vertices.len()];
                let twin = corners.half_edge(b, a).map(HalfEdgeId);
                half_edges.push(HalfEdge::new(VertexId(a), FaceId::new(face), twin));
            }
            face_starts.push(half_edges.len() as u32);
        }
        Self::numbered(vertex_count, half_edges, face_starts)
    }

    /// Numbers the edges: each when the first of its half-edges is met.
    pub fn numbered(vertex_count: usize, mut half_edges: Vec<HalfEdge>, face_starts: Vec<u32>) -> Self {
        let mut edges = Vec::with_capacity(half_edges.len() / 2);
        let mut border_from = vec![None; vertex_count];
        for this in (0..half_edges.len()).map(HalfEdgeId::new) {
            let HalfEdge { origin, twin, .. } = half_edges[this.index()];
            if twin.is_none() {
                border_from[origin.index()] = Some(this);
            }
            half_edges[this.index()].edge = match twin.filter(|t| *t < this) {
                Some(twin) => half_edges[twin.index()].edge,
                None => {
                    edges.push(this);
                    EdgeId::new(edges.len() - 1)
                }
            };
        }
        Self { half_edges, edges, face_starts, border_from }
    }
}
