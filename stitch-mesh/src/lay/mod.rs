//! Laying yarn: stitch mesh → yarn net (stage 5 of the flow; Yuksel et al. §6.2 and §4.3).
//!
//! # Theory
//! Every edge of a stitch mesh is crossed by yarn at fixed places, its **ports**: a wale edge by the one yarn of the row, a
//! course edge by the two legs of one loop. A stitch says how the ports of its face are joined inside, and nothing else:
//!
//! ```text
//!            |T leg            T leg|             A  an old loop, coming in through a bottom edge
//!       A----LU======= A head =======RU----A      T  the yarn of this row, on its way from the left wale edge to the right,
//!         //                           \\            leaving through each top edge as a new loop and coming back
//!    ___LL  |A leg              A leg|  RL___     A visits LL, LU, RU, RL; T visits LL, LU, then the loop, then RU, RL
//! ```
//!
//! Yarns are found by following ports from face to face. So whatever the faces and rows are like, the yarn is continuous, and
//! wale directions that oppose each other need no special care: two tops that meet join leg to leg, and the small closed
//! yarns of Yuksel et al. Fig. 8 come out by themselves.
//!
//! # Practice
//! 1. `cell`: nodes, pieces of yarn and stitch contacts of each face;
//! 2. `border`: cast-on along bottom edges, bind-off along top edges, rows joined at their ends so that a flat piece is one
//!    yarn going back and forth;
//! 3. `trace`: pieces joined into yarns, arc lengths measured.
//!
//! The paper makes the first row of faces the cast-on. Here cast-on and bind-off lie outside of the mesh, so that every face
//! stays a stitch that can be chosen, and borders may lie anywhere.
//!
//! Rest lengths are the laid lengths: the fabric keeps the size at which the artist drew it.

mod border;
mod cell;
mod trace;

#[cfg(test)]
mod tests;

use crate::ids::{FaceId, HalfEdgeId, NodeId};
use crate::stitch_mesh::StitchMesh;
use crate::yarn_net::YarnNet;
use cell::{Cell, FaceFrame};
use glam::DVec3;
use smallvec::SmallVec;

/// Lays the yarn of a stitch mesh. The same mesh always gives the same net.
pub fn lay(stitches: &StitchMesh) -> YarnNet {
    let mut draft = Draft::new(stitches.mesh().half_edge_count());
    let normals = stitches.mesh().vertex_normals();
    for face in stitches.mesh().faces() {
        let frame = FaceFrame::of_face(stitches, &normals, face);
        Cell::of_face(stitches, face).lay(stitches.stitch(face), &frame, &mut draft);
    }
    for h in (0..stitches.mesh().half_edge_count()).map(HalfEdgeId::new) {
        if let Some(twin) = stitches.mesh().twin(h) {
            if stitches.is_wale(h) {
                draft.join(wale_port(h), wale_port(twin));
            } else {
                draft.join(course_port(h, 0), course_port(twin, 1));
            }
        }
    }
    border::finish(stitches, &normals, &mut draft);
    trace::trace(draft)
}

/// A place where yarn crosses an edge.
type Port = usize;

/// Where the yarn of a row crosses a wale edge, seen from the face of `h`.
fn wale_port(h: HalfEdgeId) -> Port {
    2 * h.index()
}

/// Where a leg crosses a course edge, seen from the face of `h`: 0 near its origin, 1 near its tip.
fn course_port(h: HalfEdgeId, place: usize) -> Port {
    2 * h.index() + place
}

/// A visit before the yarns are known: its place in [`Draft::visits`].
type DraftVisit = usize;

/// A stretch of yarn inside one cell, from port to port.
struct Piece {
    from: Port,
    visits: SmallVec<[DraftVisit; 4]>,
    to: Port,
}

struct DraftNode {
    position: DVec3,
    normal: DVec3,
    /// Along the row, out of the cell on the nearer side: where the yarn goes when it turns back or ends here [m].
    outward: DVec3,
    face: Option<FaceId>,
    /// Front to back.
    stack: SmallVec<[DraftVisit; 3]>,
}

struct DraftContact {
    handedness: f64,
    new: [DraftVisit; 2],
    old: SmallVec<[[DraftVisit; 2]; 1]>,
}

/// Pieces of yarn and how they are joined, before they are yarns.
#[derive(Default)]
struct Draft {
    nodes: Vec<DraftNode>,
    /// The node of every visit.
    visits: Vec<NodeId>,
    pieces: Vec<Piece>,
    contacts: Vec<DraftContact>,
    /// For every port the one it is joined to.
    joined: Vec<Option<Port>>,
}

impl Draft {
    fn new(half_edges: usize) -> Self {
        Self { joined: vec![None; 2 * half_edges], ..Self::default() }
    }

    fn node(&mut self, node: DraftNode) -> NodeId {
        self.nodes.push(node);
        NodeId::new(self.nodes.len() - 1)
    }

    fn visit(&mut self, node: NodeId) -> DraftVisit {
        self.visits.push(node);
        self.visits.len() - 1
    }

    /// For every port the piece that begins or ends there.
    fn piece_at_ports(&self) -> Vec<Option<usize>> {
        let mut at = vec![None; self.joined.len()];
        for (i, piece) in self.pieces.iter().enumerate() {
            at[piece.from] = Some(i);
            at[piece.to] = Some(i);
        }
        at
    }

    /// Follows the yarn that enters a piece at port `from`: the pieces, each with whether it is passed from its beginning,
    /// and the port at which the yarn ends loose. A ring ends where it began, without one.
    fn follow(&self, piece_at: &[Option<usize>], from: Port) -> (Vec<(usize, bool)>, Option<Port>) {
        let mut run: Vec<(usize, bool)> = Vec::new();
        let mut entry = from;
        while let Some(piece) = piece_at[entry] {
            let forward = entry == self.pieces[piece].from;
            run.push((piece, forward));
            let exit = if forward { self.pieces[piece].to } else { self.pieces[piece].from };
            match self.joined[exit].filter(|next| piece_at[*next].is_some()) {
                Some(next) if next == from => return (run, None),
                Some(next) => entry = next,
                None => return (run, Some(exit)),
            }
        }
        (run, None)
    }

    /// A port that lies on no half-edge: at cast-on, bind-off and ends.
    fn new_port(&mut self) -> Port {
        self.joined.push(None);
        self.joined.len() - 1
    }

    fn join(&mut self, a: Port, b: Port) {
        self.joined[a] = Some(b);
        self.joined[b] = Some(a);
    }
}
