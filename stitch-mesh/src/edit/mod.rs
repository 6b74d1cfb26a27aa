//! Edits of the faces of a stitch mesh (Yuksel et al. §5.3, Fig. 13): split and collapse course edges, add, remove and shift
//! wale edges.
//!
//! Each makes a new mesh, or refuses with the reason. A new vertex or face gets the number after the last, so that all others
//! keep theirs. Where one goes, those before it keep their numbers and those after it move down by one; what was merged
//! into a neighbour goes on as that ([`Survivors`]).
//!
//! Faces that gain or lose a loop keep what can be kept of their stitch. A new top is worked the other way than the one on
//! its left (after a knit a purl, and the other way round), as only that makes two loops out of one; a new bottom lies beside the
//! one it was split from in the stack. Colours and places in the input stay, and so do all marks: an edge of a cable or a seam
//! is not cut, the artist has to clear that first.

mod course;
mod draft;
mod reknit;
mod reshape;
#[cfg(test)]
mod tests;
mod wale;

pub use reknit::Block;

use crate::ids::{FaceId, VertexId};
use crate::marks::MarkError;
use crate::mesh::MeshError;
use crate::stitch_mesh::{StitchMesh, StitchMeshError};

/// Loops that can be worked together: symbols name them by one digit each.
pub const MOST_BOTTOMS: usize = 9;

/// What came through an edit.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Survivors {
    /// For every vertex before what it is now, [vertex_count before].
    pub vertices: Vec<Option<VertexId>>,
    /// For every face before what it is now, [face_count before].
    pub faces: Vec<Option<FaceId>>,
}

impl Survivors {
    /// For every face now what it was before: the first, where two have become one. Ends with the last face that was there
    /// before.
    pub fn faces_before(&self) -> Vec<Option<FaceId>> {
        let last = self.faces.iter().flatten().max().map_or(0, |f| f.index() + 1);
        let mut before = vec![None; last];
        for (old, new) in self.faces.iter().enumerate().rev() {
            if let Some(new) = new {
                before[new.index()] = Some(FaceId::new(old));
            }
        }
        before
    }
}

/// An end of a wale edge.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum End {
    /// The lower one.
    Bottom,
    /// The upper one.
    Top,
}

/// A direction along a row, seen from the front with the wale upwards.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Way {
    /// Against the row.
    Left,
    /// Along the row.
    Right,
}

/// The new mesh, and what came through.
pub type Edited = (StitchMesh, Survivors);

/// Why an edit is refused.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum EditError {
    /// No such edge.
    #[error("there is no edge {0}–{1} in the stitches")]
    NoEdge(VertexId, VertexId),
    /// No such face.
    #[error("there is no face {0}")]
    NoFace(FaceId),
    /// A wale edge where a course edge is needed.
    #[error(
        "edge {0}–{1} lies between two stitches of a row, and no loop passes it to be split or collapsed; it can be \
         removed or shifted"
    )]
    NotCourse(VertexId, VertexId),
    /// A course edge where a wale edge is needed.
    #[error(
        "edge {0}–{1} lies between two rows, and a loop passes it; only edges between two stitches of a row can be \
         removed or shifted; this one can be split or collapsed"
    )]
    NotWale(VertexId, VertexId),
    /// The edge lies in a cable.
    #[error("the loop on edge {0}–{1} crosses in a cable: clear the cable first")]
    InCable(VertexId, VertexId),
    /// The edge lies in a seam.
    #[error("edge {0}–{1} is sewn: undo the seam first")]
    InSeam(VertexId, VertexId),
    /// A stitch would be left without a loop above.
    #[error(
        "edge {a}–{b} has the only loop that stitch {face} makes; to end its column, remove a wale edge beside it, so that \
         it is worked together with its neighbour"
    )]
    LastTop {
        /// One end of the edge.
        a: VertexId,
        /// The other.
        b: VertexId,
        /// The stitch.
        face: FaceId,
    },
    /// A stitch would be left without a loop below.
    #[error(
        "edge {a}–{b} has the only loop that stitch {face} is worked into; to end its column, remove a wale edge beside it, \
         so that it is worked together with its neighbour"
    )]
    LastBottom {
        /// One end of the edge.
        a: VertexId,
        /// The other.
        b: VertexId,
        /// The stitch.
        face: FaceId,
    },
    /// Two places of the border, or two sides of the mesh, would meet in a point.
    #[error(
        "edge {0}–{1} cannot be collapsed: both its ends lie on the border, and the fabric would hang together in a single \
         point there"
    )]
    Pinch(VertexId, VertexId),
    /// A wale edge on the border.
    #[error("edge {0}–{1} is the end of its row: there is a stitch on one side only")]
    RowEnd(VertexId, VertexId),
    /// The same stitch, or the same two, on both sides all round.
    #[error("the row of stitch {0} would close on itself with a single stitch")]
    LastOfRow(FaceId),
    /// A new wale edge has to join bottom to top.
    #[error(
        "{bottom}–{top} does not divide stitch {face}: a new wale edge runs from a corner below the stitch to one above it"
    )]
    NotAcross {
        /// The stitch.
        face: FaceId,
        /// The vertex given as lower end.
        bottom: VertexId,
        /// The vertex given as upper end.
        top: VertexId,
    },
    /// One side of a new wale edge would have no loops.
    #[error(
        "{bottom}–{top} leaves no loop on one of its sides: split an edge above or below stitch {face} first"
    )]
    NoLoops {
        /// The stitch.
        face: FaceId,
        /// Lower end.
        bottom: VertexId,
        /// Upper end.
        top: VertexId,
    },
    /// A wale edge cannot be shifted over the only edge of a stitch.
    #[error("stitch {face} has only one loop {side} it, and would be left without: split that edge first")]
    NothingToGive {
        /// The stitch.
        face: FaceId,
        /// `above` or `below`.
        side: &'static str,
    },
    /// More loops than can be worked together.
    #[error("stitch {0} would work more than {MOST_BOTTOMS} loops together")]
    TooManyBottoms(FaceId),
    /// Rows of different lengths, or none.
    #[error("the stitches to be knitted anew do not make a block")]
    NotABlock,
    /// A stitch that makes more loops or fewer.
    #[error("stitch {0} does not join one loop to one: only plain stitches can be knitted anew in blocks")]
    NotPlain(FaceId),
    /// Loops bound off or cast on inside a block.
    #[error("row {0} of the pattern binds off or casts on, which only the edge of a fabric can")]
    Edge(usize),
    /// A row that does not fit the one below, or the highest one what lies above.
    #[error("row {row} of the pattern works {worked} loops and makes {made}, where there are {loops}")]
    Row {
        /// The row of the pattern, from 0.
        row: usize,
        /// Loops that it works.
        worked: usize,
        /// Loops that it makes.
        made: usize,
        /// Loops that there are.
        loops: usize,
    },
    /// The faces would not make a mesh.
    #[error("the fabric would not hold together: {0}")]
    Mesh(#[from] MeshError),
    /// The stitches would not fit.
    #[error(transparent)]
    Stitch(#[from] StitchMeshError),
    /// Marks would not fit.
    #[error(transparent)]
    Mark(#[from] MarkError),
}
