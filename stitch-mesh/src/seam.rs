//! Seams: two borders sewn together, stitch to stitch (as pieces of a garment are).
//!
//! The two sides need not have the same number of stitches: the sewing yarn goes to and fro and catches each edge in its
//! turn, in proportion. The sides may be of any kind: row ends, cast-on or bind-off.

use crate::ids::VertexId;
use crate::mesh::PolygonMesh;
use crate::stitch_mesh::StitchMesh;
use serde::{Deserialize, Serialize};

/// A seam: vertices along two stretches of border, in the order in which they are sewn. The first of one meets the first of
/// the other.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Seam {
    /// Along one side.
    pub a: Vec<VertexId>,
    /// Along the other.
    pub b: Vec<VertexId>,
}

/// Why a seam cannot be sewn.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SeamError {
    /// A side without edges.
    #[error("a seam needs at least one edge on both sides")]
    Empty,
    /// Two vertices of a side are not the ends of a border edge.
    #[error("{0}–{1} is not an edge of the border; only borders can be sewn")]
    NoBorder(VertexId, VertexId),
    /// An edge is in a seam already, or on both sides of this one.
    #[error("edge {0}–{1} would be sewn twice")]
    Taken(VertexId, VertexId),
}

impl Seam {
    fn edges(&self) -> impl Iterator<Item = [VertexId; 2]> + '_ {
        self.a.windows(2).chain(self.b.windows(2)).map(|w| sorted([w[0], w[1]]))
    }

    /// Whether the edge between two vertices lies in this seam.
    pub fn covers(&self, a: VertexId, b: VertexId) -> bool {
        self.edges().any(|e| e == sorted([a, b]))
    }

    /// Whether both sides are border of `mesh`, and no edge is sewn twice.
    ///
    /// # Errors
    /// Why it cannot be sewn.
    pub fn check(&self, mesh: &PolygonMesh) -> Result<(), SeamError> {
        if self.a.len() < 2 || self.b.len() < 2 {
            return Err(SeamError::Empty);
        }
        let mut seen = std::collections::HashSet::new();
        for [a, b] in self.edges() {
            if mesh.edge_between(a, b).is_none_or(|e| !mesh.is_border(e)) {
                return Err(SeamError::NoBorder(a, b));
            }
            if !seen.insert([a, b]) {
                return Err(SeamError::Taken(a, b));
            }
        }
        Ok(())
    }
}

/// The ends of an edge, the smaller first.
pub(crate) fn sorted([a, b]: [VertexId; 2]) -> [VertexId; 2] {
    [a.min(b), a.max(b)]
}

impl StitchMesh {
    /// The seams.
    pub fn seams(&self) -> &[Seam] {
        &self.marks().seams
    }

    /// Sews two borders together. All ids survive.
    ///
    /// # Errors
    /// Why it cannot be sewn; nothing is changed then.
    pub fn sew(&mut self, seam: Seam) -> Result<(), SeamError> {
        seam.check(self.mesh())?;
        if let Some([a, b]) = seam.edges().find(|[a, b]| self.seams().iter().any(|s| s.covers(*a, *b))) {
            return Err(SeamError::Taken(a, b));
        }
        self.marks_mut().seams.push(seam);
        Ok(())
    }

    /// Undoes the seams that one of these edges (each given by its ends) lies in. Returns how many there were.
    pub fn unsew(&mut self, edges: &[[VertexId; 2]]) -> usize {
        let seams = &mut self.marks_mut().seams;
        let before = seams.len();
        seams.retain(|s| !edges.iter().any(|[a, b]| s.covers(*a, *b)));
        before - seams.len()
    }
}
