//! Rows, columns and loops of whatever mesh a stage shows: the labelled mesh or the stitch mesh.

use std::collections::BTreeSet;
use stitch_mesh::ids::{EdgeId, FaceId, HalfEdgeId};
use stitch_mesh::label::{EdgeLabel, LabelledMesh};
use stitch_mesh::mesh::PolygonMesh;
use stitch_mesh::stitch_mesh::StitchMesh;

/// The mesh under the pointer.
#[derive(Clone, Copy)]
pub enum Surface<'a> {
    /// The input mesh with its labels.
    Labelled(&'a LabelledMesh),
    /// The fabric.
    Stitched(&'a StitchMesh),
}

impl<'a> Surface<'a> {
    /// Its polygons.
    pub fn mesh(self) -> &'a PolygonMesh {
        match self {
            Self::Labelled(labelled) => labelled.mesh(),
            Self::Stitched(stitches) => stitches.mesh(),
        }
    }

    /// The faces of the row through a face; the face alone where there is no row yet.
    pub fn row(self, face: FaceId) -> Vec<FaceId> {
        match self {
            Self::Labelled(labelled) if labelled.wales(face).is_none() => vec![face],
            Self::Labelled(labelled) => labelled.row_of(face).faces,
            Self::Stitched(stitches) => stitches.row_of(face).faces,
        }
    }

    /// The faces above and below a face, and itself: at each row the first that follows.
    pub fn column(self, face: FaceId) -> Vec<FaceId> {
        let mut column = BTreeSet::from([face]);
        for up in [true, false] {
            let mut at = face;
            while let Some(next) = self.beyond(at, up).filter(|f| column.insert(*f)) {
                at = next;
            }
        }
        column.into_iter().collect()
    }

    fn beyond(self, face: FaceId, up: bool) -> Option<FaceId> {
        let sides = if up { self.tops(face) } else { self.bottoms(face) };
        sides.into_iter().find_map(|h| self.mesh().face_across(h))
    }

    fn bottoms(self, face: FaceId) -> Vec<HalfEdgeId> {
        match self {
            Self::Labelled(l) => l.wales(face).map(|w| l.bottoms(w)).unwrap_or_default(),
            Self::Stitched(s) => s.bottoms(face).collect(),
        }
    }

    fn tops(self, face: FaceId) -> Vec<HalfEdgeId> {
        match self {
            Self::Labelled(l) => l.wales(face).map(|w| l.tops(w)).unwrap_or_default(),
            Self::Stitched(s) => s.tops(face).collect(),
        }
    }

    /// What an edge is to the knitting; none without a label.
    pub fn label(self, edge: EdgeId) -> Option<EdgeLabel> {
        match self {
            Self::Labelled(labelled) => labelled.label(edge),
            Self::Stitched(stitches) if stitches.is_wale(stitches.mesh().edge_sides(edge).0) => {
                Some(EdgeLabel::Wale)
            }
            Self::Stitched(_) => Some(EdgeLabel::Course),
        }
    }

    /// The line of edges through an edge: a course edge's along its row, a wale edge's up and down its column; where there is
    /// no label, straight on through vertices with four edges.
    pub fn edge_loop(self, edge: EdgeId) -> Vec<EdgeId> {
        let mesh = self.mesh();
        let (half, _) = mesh.edge_sides(edge);
        let face = mesh.face(half);
        let line = |halves: Vec<HalfEdgeId>| -> Vec<EdgeId> {
            halves.into_iter().map(|h| mesh.edge(h)).collect::<BTreeSet<_>>().into_iter().collect()
        };
        let row = |sides: fn(Self, FaceId) -> Vec<HalfEdgeId>| {
            line(self.row(face).into_iter().flat_map(|f| sides(self, f)).collect())
        };
        match self.label(edge) {
            Some(EdgeLabel::Course) if self.bottoms(face).contains(&half) => row(Self::bottoms),
            Some(EdgeLabel::Course) if self.tops(face).contains(&half) => row(Self::tops),
            Some(EdgeLabel::Wale) => {
                let is_right = self.right(face) == Some(half);
                let side = |f| if is_right { self.right(f) } else { self.left(f) };
                let found = line(self.column(face).into_iter().filter_map(side).collect());
                if found.contains(&edge) { found } else { self.straight_on(edge) }
            }
            _ => self.straight_on(edge),
        }
    }

    fn right(self, face: FaceId) -> Option<HalfEdgeId> {
        match self {
            Self::Labelled(l) => l.wales(face).map(|w| w.right),
            Self::Stitched(s) => Some(s.right(face)),
        }
    }

    fn left(self, face: FaceId) -> Option<HalfEdgeId> {
        match self {
            Self::Labelled(l) => l.wales(face).map(|w| w.left),
            Self::Stitched(s) => Some(s.left(face)),
        }
    }

    /// Straight on from an edge inside of the mesh; from one on the border along it, up to its corners.
    fn straight_on(self, edge: EdgeId) -> Vec<EdgeId> {
        let mesh = self.mesh();
        let mut line = BTreeSet::from([edge]);
        let mut walk = |start: HalfEdgeId, next: &dyn Fn(HalfEdgeId) -> Option<HalfEdgeId>| {
            let mut at = start;
            while let Some(beyond) = next(at).filter(|h| line.insert(mesh.edge(*h))) {
                at = beyond;
            }
        };
        match mesh.edge_sides(edge) {
            (first, Some(second)) => [first, second].into_iter().for_each(|h| {
                walk(h, &|h| {
                    let crossing = mesh.valence(mesh.tip(h)) == 4;
                    mesh.twin(mesh.next(h)).filter(|_| crossing).map(|t| mesh.next(t))
                });
            }),
            (side, None) => {
                let borders = mesh.borders();
                let before = |h| {
                    let ring = borders.iter().find(|ring| ring.contains(&h))?;
                    ring.iter().copied().find(|b| mesh.next_on_border(*b) == Some(h))
                };
                let passes = |v| mesh.valence(v) > 1;
                walk(side, &|h| mesh.next_on_border(h).filter(|_| passes(mesh.tip(h))));
                walk(side, &|h| before(h).filter(|_| passes(mesh.origin(h))));
            }
        }
        line.into_iter().collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use stitch_mesh::autolabel::autolabel;
    use stitch_mesh::edge_counts::StitchSize;
    use stitch_mesh::pieces::rectangle;

    /// 6 columns and 4 rows; face 6 r + c is in row r and column c.
    fn piece() -> StitchMesh {
        rectangle(6, 4, StitchSize::of_width(3e-3)).unwrap()
    }

    fn edge(stitches: &StitchMesh, face: u32, side: usize) -> EdgeId {
        stitches.mesh().edge(HalfEdgeId(stitches.mesh().first_half_edge(FaceId(face)).0 + side as u32))
    }

    #[test]
    fn rows_and_columns_go_through_the_face() {
        let stitches = piece();
        let labelled = autolabel(&LabelledMesh::new(stitches.mesh().clone()));
        for surface in [Surface::Stitched(&stitches), Surface::Labelled(&labelled)] {
            assert_eq!(surface.row(FaceId(8)), [6, 7, 8, 9, 10, 11].map(FaceId));
            assert_eq!(surface.column(FaceId(8)), [2, 8, 14, 20].map(FaceId));
        }
        let bare = LabelledMesh::new(stitches.mesh().clone());
        assert_eq!(Surface::Labelled(&bare).row(FaceId(8)), [FaceId(8)]);
    }

    #[test]
    fn loops_of_edges_follow_rows_and_columns() {
        let stitches = piece();
        let surface = Surface::Stitched(&stitches);
        let bare = LabelledMesh::new(stitches.mesh().clone());
        let bare = Surface::Labelled(&bare);
        let sorted = |mut edges: Vec<EdgeId>| {
            edges.sort_unstable();
            edges
        };
        // Sides: 0 below, 1 right, 2 above, 3 left.
        for (side, faces) in
            [(0, [6, 7, 8, 9, 10, 11].as_slice()), (1, &[2, 8, 14, 20]), (3, &[2, 8, 14, 20])]
        {
            let expected = sorted(faces.iter().map(|f| edge(&stitches, *f, side)).collect());
            assert_eq!(surface.edge_loop(edge(&stitches, 8, side)), expected, "side {side}");
            assert_eq!(bare.edge_loop(edge(&stitches, 8, side)), expected, "without labels, side {side}");
        }
        let top = sorted((18..24).map(|f| edge(&stitches, f, 2)).collect());
        assert_eq!(surface.edge_loop(edge(&stitches, 20, 2)), top);
        assert_eq!(bare.edge_loop(edge(&stitches, 20, 2)), top, "the border, from corner to corner");
    }
}
