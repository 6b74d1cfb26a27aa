//! Seams: two borders sewn together, stitch to stitch (as pieces of a garment are).
//!
//! The two sides need not have the same number of stitches: the sewing yarn goes to and fro and catches each edge in its
//! turn, in proportion. The sides may be of any kind: row ends, cast-on or bind-off.
//!
//! A seam of a garment is known before its stitches are: by corners of the input mesh, which keep their numbers when it is
//! tessellated. [`Seam::between`] follows the border from one to the next.

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
    /// The seam along two sides of which only some vertices are named, at least the ends: from each to the next it follows
    /// the border of `mesh`, the shorter way round where there are two.
    ///
    /// # Errors
    /// [`SeamError::NoBorder`] where two of them do not lie on one border.
    pub fn between(mesh: &PolygonMesh, a: &[VertexId], b: &[VertexId]) -> Result<Self, SeamError> {
        let side = |named: &[VertexId]| {
            let mut vertices: Vec<VertexId> = named.first().copied().into_iter().collect();
            for pair in named.windows(2) {
                let error = SeamError::NoBorder(pair[0], pair[1]);
                vertices.extend(along_border(mesh, pair[0], pair[1]).ok_or(error)?);
            }
            Ok(vertices)
        };
        Ok(Self { a: side(a)?, b: side(b)? })
    }

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

/// The vertices after `from` on a border as far as `to`, the shorter way round.
fn along_border(mesh: &PolygonMesh, from: VertexId, to: VertexId) -> Option<Vec<VertexId>> {
    if from.index().max(to.index()) >= mesh.vertex_count() {
        return None;
    }
    let walk = |from: VertexId, to: VertexId| {
        let start = mesh.outgoing(from).find(|h| mesh.twin(*h).is_none());
        let mut vertices = Vec::new();
        let mut at = start;
        while let Some(h) = at {
            vertices.push(mesh.tip(h));
            if mesh.tip(h) == to {
                return Some(vertices);
            }
            at = mesh.next_on_border(h).filter(|next| Some(*next) != start);
        }
        None
    };
    let onwards = walk(from, to)?;
    let mut back = walk(to, from)?;
    if onwards.len() <= back.len() {
        return Some(onwards);
    }
    back.pop();
    back.reverse();
    back.push(to);
    Some(back)
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::edge_counts::StitchSize;
    use crate::pieces::rectangle;

    #[test]
    fn a_seam_between_corners_follows_the_border() {
        // Vertices of 4 × 3 stitches: 0–4 below, 15–19 above.
        let piece = rectangle(4, 3, StitchSize::of_width(3e-3)).unwrap();
        let seam = |a: &[u32], b: &[u32]| -> Result<_, SeamError> {
            let vertices = |list: &[u32]| list.iter().copied().map(VertexId).collect::<Vec<_>>();
            let seam = Seam::between(piece.mesh(), &vertices(a), &vertices(b))?;
            let numbers = |side: Vec<VertexId>| side.into_iter().map(|v| v.0).collect::<Vec<_>>();
            Ok((numbers(seam.a), numbers(seam.b)))
        };
        assert_eq!(seam(&[0, 15], &[4, 19]), Ok((vec![0, 5, 10, 15], vec![4, 9, 14, 19])));
        assert_eq!(seam(&[4, 0], &[19, 17, 15]), Ok((vec![4, 3, 2, 1, 0], vec![19, 18, 17, 16, 15])));
        assert_eq!(seam(&[0, 6], &[4, 19]), Err(SeamError::NoBorder(VertexId(0), VertexId(6))));
        assert_eq!(seam(&[0, 99], &[4, 19]), Err(SeamError::NoBorder(VertexId(0), VertexId(99))));
    }
}
