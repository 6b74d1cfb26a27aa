//! The labelled mesh: every edge of the input is course or wale, and so the faces are rows (stage 1 of the flow).
//!
//! Yuksel et al. §5.1: every face has exactly two wale edges; faces joined by wale edges are a row. The wale direction of a
//! row says which of its sides was knitted first. [`crate::fill`] labels row after row, [`crate::autolabel`] all of them; here
//! is what labels are, the hand tools, and what can be wrong with them.

use crate::ids::{EdgeId, FaceId, HalfEdgeId};
use crate::mesh::PolygonMesh;
use serde::{Deserialize, Serialize};

/// What an edge of the input mesh is to the knitting.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum EdgeLabel {
    /// Along a row: loops pass across it.
    Course,
    /// Along a column of loops: the row's yarn passes across it.
    Wale,
}

/// The two wale half-edges of a face, which say where its row goes and which way is up.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Wales {
    /// The one on the left, running down the wale.
    pub left: HalfEdgeId,
    /// The one on the right, running up.
    pub right: HalfEdgeId,
}

/// Faces joined by wale edges, left to right.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Row {
    /// Faces, left to right as seen from the front.
    pub faces: Vec<FaceId>,
    /// Whether the last face is joined to the first.
    pub closed: bool,
}

/// A face whose labels are missing or wrong.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum LabelProblem {
    /// A face with an edge that is neither course nor wale yet.
    Unlabelled {
        /// The face.
        face: FaceId,
    },
    /// A face needs exactly two wale edges, for its row's yarn to come in and go out.
    WaleCount {
        /// The face.
        face: FaceId,
        /// How many it has.
        count: usize,
    },
    /// Two neighbours in a row have opposite wale directions.
    OpposedInRow {
        /// One face.
        a: FaceId,
        /// Its neighbour.
        b: FaceId,
    },
}

impl LabelProblem {
    /// The face to look at.
    pub fn face(&self) -> FaceId {
        match *self {
            Self::Unlabelled { face } | Self::WaleCount { face, .. } | Self::OpposedInRow { a: face, .. } => {
                face
            }
        }
    }

    /// What is wrong there and what to do about it.
    pub fn what(&self) -> String {
        match self {
            Self::Unlabelled { .. } => {
                "not labelled yet: fill the row from a border or from a labelled row beside it".into()
            }
            Self::WaleCount { count, .. } => format!(
                "wale edges at this face: {count}, and it needs two, for the yarn of its row to come in and go out; label \
                 its edges by hand, or change the mesh there"
            ),
            Self::OpposedInRow { b, .. } => {
                format!("knitted in the opposite direction to face {b} in the same row: flip one of them")
            }
        }
    }
}

impl std::fmt::Display for LabelProblem {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "face {}: {}", self.face(), self.what())
    }
}

/// Labels that are not complete.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{first}{}", if *.count > 1 { format!("; and {} more faces", .count - 1) } else { String::new() })]
pub struct Incomplete {
    /// The first problem.
    pub first: LabelProblem,
    /// How many there are.
    pub count: usize,
}

/// Why a labelling tool did nothing.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum LabelError {
    /// Filling from a border needs a border edge.
    #[error("not on a border; fill from a border, or from a course edge of a labelled row")]
    NotBorder(EdgeId),
    /// Filling from a course edge needs a course edge.
    #[error("not a course edge")]
    NotCourse(EdgeId),
    /// There is no unlabelled face on that edge.
    #[error("there is no unlabelled face beside it")]
    NothingToFill(EdgeId),
    /// The face has no wale direction to flip yet.
    #[error("face {0} has no row yet")]
    NoRow(FaceId),
}

/// A polygon mesh with the labels given so far.
#[derive(Clone, Debug, PartialEq)]
pub struct LabelledMesh {
    pub(crate) mesh: PolygonMesh,
    /// [edge_count]
    pub(crate) labels: Vec<Option<EdgeLabel>>,
    /// [face_count]; of faces with exactly two wale edges and all edges labelled.
    pub(crate) wales: Vec<Option<Wales>>,
}

impl LabelledMesh {
    /// A mesh without labels.
    pub fn new(mesh: PolygonMesh) -> Self {
        Self { labels: vec![None; mesh.edge_count()], wales: vec![None; mesh.face_count()], mesh }
    }

    /// A mesh with labels from a file: those of the edges, and for each face its rising wale half-edge where it has one.
    /// None when the lists do not fit the mesh.
    pub fn from_parts(
        mesh: PolygonMesh,
        labels: Vec<Option<EdgeLabel>>,
        rising: &[Option<HalfEdgeId>],
    ) -> Option<Self> {
        if labels.len() != mesh.edge_count() || rising.len() != mesh.face_count() {
            return None;
        }
        let mut labelled = Self { wales: vec![None; mesh.face_count()], labels, mesh };
        for (face, rising) in rising.iter().enumerate().map(|(i, r)| (FaceId::new(i), r)) {
            let candidates = labelled.wale_half_edges(face);
            labelled.wales[face.index()] = match (candidates, rising) {
                (Some([a, b]), Some(r)) if a == *r => Some(Wales { left: b, right: a }),
                (Some([a, b]), Some(r)) if b == *r => Some(Wales { left: a, right: b }),
                (None, None) => None,
                _ => return None,
            };
        }
        Some(labelled)
    }

    /// The mesh.
    pub fn mesh(&self) -> &PolygonMesh {
        &self.mesh
    }

    /// Labels, [edge_count].
    pub fn labels(&self) -> &[Option<EdgeLabel>] {
        &self.labels
    }

    /// The label of one edge.
    pub fn label(&self, edge: EdgeId) -> Option<EdgeLabel> {
        self.labels[edge.index()]
    }

    /// Whether an edge is labelled wale.
    pub fn is_wale(&self, edge: EdgeId) -> bool {
        self.label(edge) == Some(EdgeLabel::Wale)
    }

    /// All wale edges of the rows at a wale edge, it included.
    pub fn wales_of_row(&self, edge: EdgeId) -> Vec<EdgeId> {
        let (first, twin) = self.mesh.edge_sides(edge);
        let mut edges = vec![edge];
        for face in [Some(first), twin].into_iter().flatten().map(|h| self.mesh.face(h)) {
            let row = self.row_of(face).faces.into_iter().filter_map(|f| self.wales(f));
            edges.extend(row.flat_map(|w| [self.mesh.edge(w.left), self.mesh.edge(w.right)]));
        }
        edges.sort_unstable();
        edges.dedup();
        edges
    }

    /// The wale half-edges of a face, once it has exactly two and no edge is unlabelled.
    pub fn wales(&self, face: FaceId) -> Option<Wales> {
        self.wales[face.index()]
    }

    /// Bottom half-edges of a labelled face, left to right.
    pub fn bottoms(&self, wales: Wales) -> Vec<HalfEdgeId> {
        self.between(wales.left, wales.right)
    }

    /// Top half-edges of a labelled face, **right to left** (as the face runs).
    pub fn tops(&self, wales: Wales) -> Vec<HalfEdgeId> {
        self.between(wales.right, wales.left)
    }

    pub(crate) fn between(&self, from: HalfEdgeId, to: HalfEdgeId) -> Vec<HalfEdgeId> {
        std::iter::successors(Some(self.mesh.next(from)), |h| Some(self.mesh.next(*h)))
            .take_while(|h| *h != to)
            .collect()
    }

    pub(crate) fn label_of(&self, h: HalfEdgeId) -> Option<EdgeLabel> {
        self.label(self.mesh.edge(h))
    }

    /// The wale half-edges of a face when it is fully labelled and has just two.
    pub(crate) fn wale_half_edges(&self, face: FaceId) -> Option<[HalfEdgeId; 2]> {
        let half_edges: Vec<HalfEdgeId> = self.mesh.face_half_edges(face).collect();
        if half_edges.iter().any(|h| self.label_of(*h).is_none()) {
            return None;
        }
        let wales: Vec<HalfEdgeId> =
            half_edges.into_iter().filter(|h| self.label_of(*h) == Some(EdgeLabel::Wale)).collect();
        wales.try_into().ok()
    }

    /// Labels a single edge by hand, or takes its label away. Faces at it get a wale direction when that completes them:
    /// that of a neighbour in the row if there is one.
    pub fn set_label(&mut self, edge: EdgeId, label: Option<EdgeLabel>) {
        self.labels[edge.index()] = label;
        let (first, twin) = self.mesh.edge_sides(edge);
        for face in [Some(first), twin].into_iter().flatten().map(|h| self.mesh.face(h)) {
            self.wales[face.index()] = None;
            if let Some([a, b]) = self.wale_half_edges(face) {
                let joins = |left: HalfEdgeId, right: HalfEdgeId| {
                    let neighbour = |h: HalfEdgeId| {
                        let twin = self.mesh.twin(h)?;
                        Some((twin, self.wales(self.mesh.face(twin))?))
                    };
                    neighbour(left).is_some_and(|(t, w)| w.right == t)
                        || neighbour(right).is_some_and(|(t, w)| w.left == t)
                };
                let (left, right) = if joins(b, a) { (b, a) } else { (a, b) };
                self.wales[face.index()] = Some(Wales { left, right });
            }
        }
    }

    /// Turns the wale direction of the whole row of a face.
    ///
    /// # Errors
    /// [`LabelError::NoRow`] where the face has no row yet.
    pub fn flip_row(&mut self, face: FaceId) -> Result<(), LabelError> {
        self.wales(face).ok_or(LabelError::NoRow(face))?;
        for face in self.row_of(face).faces {
            if let Some(w) = &mut self.wales[face.index()] {
                *w = Wales { left: w.right, right: w.left };
            }
        }
        Ok(())
    }

    /// The row through a face, walking across wale edges as far as the directions agree.
    pub fn row_of(&self, face: FaceId) -> Row {
        let across = |h: HalfEdgeId, arrives_left: bool| {
            let twin = self.mesh.twin(h)?;
            let face = self.mesh.face(twin);
            let wales = self.wales(face)?;
            (twin == if arrives_left { wales.left } else { wales.right }).then_some(face)
        };
        let mut faces = vec![face];
        let mut at = face;
        while let Some(next) = self.wales(at).and_then(|w| across(w.right, true)) {
            if next == face {
                return Row { faces, closed: true };
            }
            faces.push(next);
            at = next;
        }
        at = face;
        let mut front = Vec::new();
        while let Some(before) = self.wales(at).and_then(|w| across(w.left, false)) {
            front.push(before);
            at = before;
        }
        front.reverse();
        front.extend(faces);
        Row { faces: front, closed: false }
    }

    /// All rows of labelled faces, in order of their first face.
    pub fn rows(&self) -> Vec<Row> {
        let mut seen = vec![false; self.mesh.face_count()];
        let mut rows = Vec::new();
        for face in self.mesh.faces() {
            if !seen[face.index()] && self.wales(face).is_some() {
                let row = self.row_of(face);
                row.faces.iter().for_each(|f| seen[f.index()] = true);
                rows.push(row);
            }
        }
        rows
    }

    /// Whether every face has its row.
    ///
    /// # Errors
    /// [`Incomplete`] with the first problem.
    pub fn check_complete(&self) -> Result<(), Incomplete> {
        let problems = self.problems();
        match problems.first() {
            Some(first) => Err(Incomplete { first: first.clone(), count: problems.len() }),
            None => Ok(()),
        }
    }

    /// Everything that keeps this mesh from being knitted. Empty when it can be tessellated.
    pub fn problems(&self) -> Vec<LabelProblem> {
        let mut problems = Vec::new();
        for face in self.mesh.faces() {
            let labels: Vec<_> = self.mesh.face_half_edges(face).map(|h| self.label_of(h)).collect();
            if labels.contains(&None) {
                problems.push(LabelProblem::Unlabelled { face });
                continue;
            }
            let count = labels.iter().filter(|l| **l == Some(EdgeLabel::Wale)).count();
            let Some(wales) = self.wales(face).filter(|_| count == 2) else {
                problems.push(LabelProblem::WaleCount { face, count });
                continue;
            };
            if let Some(twin) = self.mesh.twin(wales.right)
                && let Some(other) = self.wales(self.mesh.face(twin))
                && other.left != twin
            {
                problems.push(LabelProblem::OpposedInRow { a: face, b: self.mesh.face(twin) });
            }
        }
        problems
    }
}
