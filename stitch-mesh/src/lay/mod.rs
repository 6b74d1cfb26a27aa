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
//! 1. `template`: the yarn of a stitch; `faces`: put on every face; `draft`: ports joined across edges;
//! 2. `cable`: loops that change places on their way up;
//! 3. `spiral`: closed rows joined into one another, where asked for;
//! 4. `border`: cast-on along bottom edges, bind-off along top edges (`bind_off`), rows joined at their ends so that a flat
//!    piece is one yarn going back and forth;
//! 5. `seam`: sewing yarns;
//! 6. `trace`: pieces joined into yarns, arc lengths measured.
//!
//! The paper makes the first row of faces the cast-on. Here cast-on and bind-off lie outside of the mesh, so that every face
//! stays a stitch that can be chosen, and borders may lie anywhere.
//!
//! Rest lengths are the laid lengths: the fabric keeps the size at which the artist drew it. Where yarn has to be shorter
//! than it lies at first (cables, seams), the net says by how much it is taken in.
//!
//! # Speed
//! What a stitch lays follows from its template and from how much lies in the faces before, so no face's yarn is written down
//! before it is in the net (`faces`): half of the time had gone into memory that was touched for the first time. Of two threads
//! one finds the rows while the other finds normals and templates; one follows the yarn while the other places nodes; one measures
//! the yarn while the other numbers the contacts. On 65 000 stitches that is 30 ms of one processor and 19 ms of two, where finding
//! the rows first had made it 28 ms of two. What is left is 42 MB, written once and read once; laid into memory that nobody has had
//! before, it takes a third as long again. So an edit that changes the faces is laid as a whole: a net with a part cut out and put in would
//! have to be written as well, with every number after the edit moved. After an edit that leaves all yarns where they run, [`relay`]
//! takes the net from before.

mod bind_off;
mod border;
mod cable;
mod draft;
mod faces;
mod relay;
mod seam;
mod spiral;
mod template;
mod trace;

#[cfg(test)]
mod marks_tests;
#[cfg(test)]
mod tests;

use crate::ids::HalfEdgeId;
use crate::stitch_mesh::StitchMesh;
use crate::yarn_net::YarnNet;
use draft::Draft;
use faces::FaceYarn;
pub use relay::relay;

/// Lays the yarn of a stitch mesh. The same mesh always gives the same net.
pub fn lay(stitches: &StitchMesh) -> YarnNet {
    let ((normals, faces), rows) =
        rayon::join(|| (stitches.mesh().vertex_normals(), FaceYarn::of(stitches)), || stitches.rows());
    let mut draft = Draft::of_faces(faces, &normals);
    cable::cross(stitches, &normals, &mut draft);
    let spirals = if stitches.marks().spiral { spiral::wind(stitches, &rows, &mut draft) } else { vec![] };
    let bound_off = border::finish(stitches, &rows, &normals, &spirals, &mut draft);
    seam::sew(stitches, &normals, &bound_off, &mut draft);
    trace::trace(draft)
}

/// A place where yarn crosses an edge: two for each half-edge of the mesh, and more beyond its borders.
type Port = u32;

/// Where the yarn of a row crosses a wale edge, seen from the face of `h`.
fn wale_port(h: HalfEdgeId) -> Port {
    2 * h.0
}

/// Where a leg crosses a course edge, seen from the face of `h`: 0 near its origin, 1 near its tip.
fn course_port(h: HalfEdgeId, place: u32) -> Port {
    2 * h.0 + place
}
