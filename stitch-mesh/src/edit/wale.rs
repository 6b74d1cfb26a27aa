//! Adding, removing and shifting wale edges.

use super::draft::{Draft, inner_wale};
use super::reshape::{cut, join, pass_bottom, pass_top};
use super::{EditError, Edited, End, Way};
use crate::ids::{FaceId, VertexId};
use crate::reface::Outline;
use crate::stitch_mesh::StitchMesh;
use std::sync::Arc;

impl StitchMesh {
    /// Divides a stitch by a new wale edge from a corner below it to one above it. The left part keeps its number, the right
    /// part gets the one after the last; both keep colour and place. All ids survive.
    ///
    /// # Errors
    /// [`EditError`].
    pub fn add_wale(&self, face: FaceId, [bottom, top]: [VertexId; 2]) -> Result<Edited, EditError> {
        let mesh = self.mesh();
        if face.index() >= mesh.face_count() {
            return Err(EditError::NoFace(face));
        }
        let (below, above) = self.corners(face);
        let place = |side: &[u32], v: VertexId| side.iter().position(|w| *w == v.0);
        let (Some(i), Some(j)) = (place(&below, bottom), place(&above, top)) else {
            return Err(EditError::NotAcross { face, bottom, top });
        };
        if i + j == 0 || i + j == below.len() + above.len() - 2 {
            return Err(EditError::NoLoops { face, bottom, top });
        }
        let mut draft = Draft::of(self);
        let [left, right] = cut(self.stitch(face), i, j);
        *draft.outline(face) = outline(&below[..=i], &above[..=j]);
        let new = FaceId::new(mesh.face_count());
        draft.refacing.outlines.insert(new, outline(&below[i..], &above[j..]));
        *draft.stitch(face) = left;
        draft.stitches.push(right);
        draft.stitch(new);
        Arc::make_mut(&mut draft.dyes).push(self.dyes()[face.index()]);
        Arc::make_mut(&mut draft.wrappings).push(self.wrappings()[face.index()]);
        Arc::make_mut(&mut draft.places).push(self.places()[face.index()]);
        draft.finish()
    }

    /// Removes a wale edge: the stitches on both sides become one, which works their loops together, those of the left one in
    /// front. The earlier of their numbers stays; all vertices survive.
    ///
    /// # Errors
    /// [`EditError`].
    pub fn remove_wale(&self, edge: [VertexId; 2]) -> Result<Edited, EditError> {
        let (left, right) = self.neighbours(edge)?;
        if self.mesh().face_across(self.right(right)) == Some(left) {
            return Err(EditError::LastOfRow(left));
        }
        let (stays, goes) = (left.min(right), left.max(right));
        let ((mut below, mut above), (more_below, more_above)) = (self.corners(left), self.corners(right));
        below.extend(&more_below[1..]);
        above.extend(&more_above[1..]);
        let mut draft = Draft::of(self);
        *draft.outline(stays) = outline(&below, &above);
        *draft.stitch(stays) = join(self.stitch(left), self.stitch(right));
        Arc::make_mut(&mut draft.dyes)[stays.index()] = self.dyes()[left.index()];
        Arc::make_mut(&mut draft.wrappings)[stays.index()] = self.wrappings()[left.index()];
        Arc::make_mut(&mut draft.places)[stays.index()] = self.places()[left.index()];
        draft.drop_face(goes, stays);
        draft.finish()
    }

    /// Moves one end of a wale edge along the row by one course edge, which changes hands with its loop. All ids survive.
    ///
    /// # Errors
    /// [`EditError`]: the stitch that gives the edge has no other.
    pub fn shift_wale(&self, edge: [VertexId; 2], end: End, way: Way) -> Result<Edited, EditError> {
        let (left, right) = self.neighbours(edge)?;
        let gives = if way == Way::Right { right } else { left };
        let stitch = self.stitch(gives);
        let (has, side) = match end {
            End::Bottom => (stitch.bottoms(), "below"),
            End::Top => (stitch.tops(), "above"),
        };
        if has < 2 {
            return Err(EditError::NothingToGive { face: gives, side });
        }
        let (mut left_side, mut right_side) = (self.corners(left), self.corners(right));
        let (l, r) = match end {
            End::Bottom => (&mut left_side.0, &mut right_side.0),
            End::Top => (&mut left_side.1, &mut right_side.1),
        };
        match way {
            Way::Right => {
                r.remove(0);
                l.push(r[0]);
            }
            Way::Left => {
                l.pop();
                r.insert(0, l[l.len() - 1]);
            }
        }
        let mut draft = Draft::of(self);
        *draft.outline(left) = outline(&left_side.0, &left_side.1);
        *draft.outline(right) = outline(&right_side.0, &right_side.1);
        let (mut l, mut r) = (self.stitch(left).clone(), self.stitch(right).clone());
        let pass = if end == End::Top { pass_top } else { pass_bottom };
        pass(&mut l, &mut r, way == Way::Right);
        *draft.stitch(left) = l;
        *draft.stitch(right) = r;
        draft.finish()
    }

    /// The stitches to the left and to the right of a wale edge.
    fn neighbours(&self, edge: [VertexId; 2]) -> Result<(FaceId, FaceId), EditError> {
        let (h, twin) = inner_wale(self, edge)?;
        let (left, right) = (self.mesh().face(h), self.mesh().face(twin));
        if left == right { Err(EditError::LastOfRow(left)) } else { Ok((left, right)) }
    }

    /// Vertices below and above a face, left to right.
    fn corners(&self, face: FaceId) -> (Vec<u32>, Vec<u32>) {
        let vertices: Vec<u32> = self.mesh().face_vertices(face).map(|v| v.0).collect();
        let (below, above) = vertices.split_at(self.stitch(face).bottoms() + 1);
        (below.to_vec(), above.iter().rev().copied().collect())
    }
}

/// A face from its vertices below and above, left to right.
fn outline(below: &[u32], above: &[u32]) -> Outline {
    below.iter().chain(above.iter().rev()).copied().collect()
}
