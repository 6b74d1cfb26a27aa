//! What is selected and what is hidden. No part of the document: it is neither saved nor undone.

use super::surface::Surface;
use std::collections::BTreeSet;
use stitch_mesh::ids::{EdgeId, FaceId, HalfEdgeId};
use stitch_mesh::label::EdgeLabel;
use stitch_mesh::mesh::PolygonMesh;

/// What a click takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mode {
    /// The nearest edge.
    Edge,
    /// The face.
    Face,
    /// The face's whole row.
    Row,
}

impl Mode {
    /// All modes with their names, in the order of their keys.
    pub const ALL: [(Self, &'static str); 3] =
        [(Self::Edge, "Edge"), (Self::Face, "Face"), (Self::Row, "Row")];
}

/// What becomes of the selection when something is picked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Change {
    /// It is what was picked.
    Replace,
    /// What was picked comes to it.
    Add,
    /// What was picked leaves it.
    Remove,
}

impl Change {
    /// Shift adds, Ctrl removes.
    pub fn of(modifiers: egui::Modifiers) -> Self {
        match (modifiers.shift, modifiers.command) {
            (_, true) => Self::Remove,
            (true, false) => Self::Add,
            (false, false) => Self::Replace,
        }
    }
}

/// Faces or edges that were picked.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Picked {
    /// Faces.
    Faces(Vec<FaceId>),
    /// Edges.
    Edges(Vec<EdgeId>),
}

impl Picked {
    /// What a click on a face near one of its edges picks; with `looped` the whole row or column: across a wale edge lies the
    /// row, across a course edge the column. In mode `Row` it is the column, as the row comes without.
    pub fn at(surface: Surface<'_>, half: HalfEdgeId, mode: Mode, looped: bool) -> Self {
        let mesh = surface.mesh();
        let (face, edge) = (mesh.face(half), mesh.edge(half));
        match (mode, looped) {
            (Mode::Edge, false) => Self::Edges(vec![edge]),
            (Mode::Edge, true) => Self::Edges(surface.edge_loop(edge)),
            (Mode::Face, false) => Self::Faces(vec![face]),
            (Mode::Face, true) if surface.label(edge) == Some(EdgeLabel::Wale) => {
                Self::Faces(surface.row(face))
            }
            (Mode::Face, true) | (Mode::Row, true) => Self::Faces(surface.column(face)),
            (Mode::Row, false) => Self::Faces(surface.row(face)),
        }
    }
}

/// Selected and hidden parts of one mesh.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Selection {
    /// What a click takes.
    pub mode: Mode,
    /// Selected faces.
    pub faces: BTreeSet<FaceId>,
    /// Selected edges.
    pub edges: BTreeSet<EdgeId>,
    /// Hidden faces; none of them is selected.
    pub hidden: BTreeSet<FaceId>,
}

impl Selection {
    /// Nothing selected, nothing hidden.
    pub fn new(mode: Mode) -> Self {
        Self { mode, faces: BTreeSet::new(), edges: BTreeSet::new(), hidden: BTreeSet::new() }
    }

    /// Whether nothing is selected.
    pub fn is_empty(&self) -> bool {
        self.faces.is_empty() && self.edges.is_empty()
    }

    /// Selects nothing.
    pub fn clear(&mut self) {
        self.faces.clear();
        self.edges.clear();
    }

    /// Takes in what was picked.
    pub fn change(&mut self, picked: Picked, change: Change) {
        if change == Change::Replace {
            self.clear();
        }
        match (picked, change) {
            (Picked::Faces(faces), Change::Remove) => faces.iter().for_each(|f| _ = self.faces.remove(f)),
            (Picked::Edges(edges), Change::Remove) => edges.iter().for_each(|e| _ = self.edges.remove(e)),
            (Picked::Faces(faces), _) => {
                self.faces.extend(faces.into_iter().filter(|f| !self.hidden.contains(f)));
            }
            (Picked::Edges(edges), _) => self.edges.extend(edges),
        }
    }

    /// Selects everything that shows.
    pub fn all(&mut self, mesh: &PolygonMesh, mode: Mode) {
        self.clear();
        match mode {
            Mode::Edge => self.edges = mesh.edges().filter(|e| self.shows(mesh, *e)).collect(),
            Mode::Face | Mode::Row => {
                self.faces = mesh.faces().filter(|f| !self.hidden.contains(f)).collect();
            }
        }
    }

    /// Whether a face at the edge shows.
    pub fn shows(&self, mesh: &PolygonMesh, edge: EdgeId) -> bool {
        let (first, second) = mesh.edge_sides(edge);
        [Some(first), second].into_iter().flatten().any(|h| !self.hidden.contains(&mesh.face(h)))
    }

    /// Selects all pieces that something is selected of, or that `under` belongs to.
    pub fn linked(&mut self, mesh: &PolygonMesh, under: Option<FaceId>) {
        let component = mesh.components();
        let at_edges = self.edges.iter().map(|e| mesh.face(mesh.edge_sides(*e).0));
        let begin = self.faces.iter().copied().chain(at_edges).chain(under);
        let pieces: BTreeSet<usize> = begin.map(|f| component[f.index()]).collect();
        let linked = mesh.faces().filter(|f| pieces.contains(&component[f.index()]));
        self.change(Picked::Faces(linked.collect()), Change::Add);
    }

    /// Grows the selected faces to their rows.
    pub fn to_rows(&mut self, surface: Surface<'_>) {
        let mut rows = BTreeSet::new();
        for face in &self.faces {
            if !rows.contains(face) {
                rows.extend(surface.row(*face));
            }
        }
        self.change(Picked::Faces(rows.into_iter().collect()), Change::Replace);
    }

    /// Hides the selected faces, or those at selected edges.
    pub fn hide(&mut self, mesh: &PolygonMesh) {
        let at = |e: &EdgeId| {
            let (first, second) = mesh.edge_sides(*e);
            [Some(first), second].into_iter().flatten().map(|h| mesh.face(h))
        };
        self.hidden.extend(self.edges.iter().flat_map(at));
        self.hidden.extend(&self.faces);
        self.clear();
    }

    /// The selected edges, and those around the selected faces: between a selected face and one that is not.
    pub fn outline(&self, mesh: &PolygonMesh) -> BTreeSet<EdgeId> {
        let mut outline = self.edges.clone();
        for half in self.faces.iter().flat_map(|f| mesh.face_half_edges(*f)) {
            if mesh.face_across(half).is_none_or(|f| !self.faces.contains(&f)) {
                outline.insert(mesh.edge(half));
            }
        }
        outline
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use stitch_mesh::edge_counts::StitchSize;
    use stitch_mesh::pieces::rectangle;

    #[test]
    fn picking_adds_removes_and_replaces() {
        let faces = |f: &[u32]| Picked::Faces(f.iter().copied().map(FaceId).collect());
        let mut selection = Selection::new(Mode::Face);
        selection.change(faces(&[1, 2]), Change::Replace);
        selection.change(faces(&[3]), Change::Add);
        selection.change(faces(&[1, 9]), Change::Remove);
        assert_eq!(selection.faces, BTreeSet::from([2, 3].map(FaceId)));
        selection.change(faces(&[7]), Change::Replace);
        assert_eq!(selection.faces, BTreeSet::from([FaceId(7)]));
        let of = |shift, command| Change::of(egui::Modifiers { shift, command, ..Default::default() });
        assert_eq!(
            [of(false, false), of(true, false), of(false, true)],
            [Change::Replace, Change::Add, Change::Remove]
        );
    }

    #[test]
    fn what_is_hidden_cannot_be_selected() {
        let piece = rectangle(3, 2, StitchSize::of_width(3e-3)).unwrap();
        let mesh = piece.mesh();
        let mut selection = Selection::new(Mode::Face);
        selection.change(Picked::Faces(vec![FaceId(0), FaceId(1)]), Change::Replace);
        selection.hide(mesh);
        assert!(selection.is_empty());
        selection.all(mesh, Mode::Face);
        assert_eq!(selection.faces, (2..6).map(FaceId).collect());
        selection.change(Picked::Faces(vec![FaceId(0)]), Change::Add);
        assert!(!selection.faces.contains(&FaceId(0)));
        selection.all(mesh, Mode::Edge);
        assert!(selection.edges.len() < mesh.edge_count(), "edges between hidden faces stay out");
    }

    #[test]
    fn the_outline_of_two_neighbours_leaves_out_what_lies_between() {
        let piece = rectangle(3, 2, StitchSize::of_width(3e-3)).unwrap();
        let mut selection = Selection::new(Mode::Face);
        selection.change(Picked::Faces(vec![FaceId(0), FaceId(1)]), Change::Replace);
        assert_eq!(selection.outline(piece.mesh()).len(), 6);
    }

    #[test]
    fn linked_takes_the_whole_piece() {
        let piece = rectangle(3, 2, StitchSize::of_width(3e-3)).unwrap();
        let mut selection = Selection::new(Mode::Face);
        selection.linked(piece.mesh(), None);
        assert!(selection.is_empty(), "nothing to begin from");
        selection.linked(piece.mesh(), Some(FaceId(4)));
        assert_eq!(selection.faces.len(), 6);
    }
}
