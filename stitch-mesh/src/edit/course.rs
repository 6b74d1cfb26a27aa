//! Splitting and collapsing course edges.

use super::draft::{Draft, find, free_course, turn};
use super::reshape::{add_bottom, add_top, remove_bottom, remove_top};
use super::{EditError, Edited};
use crate::ids::VertexId;
use crate::seam::sorted;
use crate::stitch_mesh::StitchMesh;

impl StitchMesh {
    /// Splits a course edge by a new vertex in its middle: the stitch below makes one more loop, the one above is worked into
    /// one more. A loop that was live stays live in both halves. The vertex gets the number after the last; all ids survive.
    ///
    /// # Errors
    /// [`EditError`].
    pub fn split_course(&self, edge: [VertexId; 2]) -> Result<Edited, EditError> {
        let sides = free_course(self, edge)?;
        let mesh = self.mesh();
        let mut draft = Draft::of(self);
        let [a, b] = edge;
        let middle = VertexId::new(mesh.vertex_count());
        draft.positions.push(mesh.position(a).midpoint(mesh.position(b)));
        for h in sides {
            let face = mesh.face(h);
            let corner = h.index() - mesh.first_half_edge(face).index();
            draft.outline(face).insert(corner + 1, middle.0);
            let i = turn(self, h);
            let stitch = draft.stitch(face);
            if self.is_bottom(h) { add_bottom(stitch, i) } else { add_top(stitch, i) }
        }
        if draft.marks.live.remove(&sorted(edge)) {
            draft.marks.live.extend(edge.map(|end| sorted([end, middle])));
        }
        draft.finish()
    }

    /// Collapses a course edge into one vertex: the stitch below makes one loop less, the one above is worked into one less.
    /// The later of its two vertices goes; the merged one lies in their middle, or on the border if one of them did. All
    /// faces survive.
    ///
    /// # Errors
    /// [`EditError`]: a stitch would have no loop left above or below, or the fabric would be pinched.
    pub fn collapse_course(&self, edge: [VertexId; 2]) -> Result<Edited, EditError> {
        let sides = free_course(self, edge)?;
        let mesh = self.mesh();
        let [a, b] = edge;
        for h in &sides {
            let face = mesh.face(*h);
            let stitch = self.stitch(face);
            match self.is_bottom(*h) {
                true if stitch.bottoms() == 1 => return Err(EditError::LastBottom { a, b, face }),
                false if stitch.tops() == 1 => return Err(EditError::LastTop { a, b, face }),
                _ => {}
            }
        }
        let on_border = |v: VertexId| mesh.outgoing(v).any(|h| is_at_border(self, h));
        let position = match (on_border(a), on_border(b)) {
            (true, true) if !mesh.is_border(find(self, edge)?) => return Err(EditError::Pinch(a, b)),
            (true, false) => mesh.position(a),
            (false, true) => mesh.position(b),
            _ => mesh.position(a).midpoint(mesh.position(b)),
        };
        let mut draft = Draft::of(self);
        for h in sides {
            let i = turn(self, h);
            let stitch = draft.stitch(mesh.face(h));
            if self.is_bottom(h) { remove_bottom(stitch, i) } else { remove_top(stitch, i) }
        }
        draft.merge_vertices(a, b, position);
        draft.finish()
    }
}

/// Whether the vertex at which a half-edge starts lies on the border beside its face.
fn is_at_border(stitches: &StitchMesh, h: crate::ids::HalfEdgeId) -> bool {
    let mesh = stitches.mesh();
    mesh.twin(h).is_none() || mesh.twin(mesh.prev(h)).is_none()
}
