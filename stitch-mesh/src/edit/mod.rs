//! Edits of the faces of a stitch mesh (Yuksel et al. §5.3, Fig. 13).

use crate::ids::{FaceId, VertexId};

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
