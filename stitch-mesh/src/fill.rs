//! Filling: one click labels one row (Yuksel et al. §5.1, Fig. 11).
//!
//! Filling from a border labels that border as course, the faces on it as a row, edges of the row with a vertex on the border as
//! wale and the rest as course; filling from a course edge does the same for the row beyond it. The side from which a row was
//! filled is its bottom.
//!
//! The paper's inputs are tubes. Here a border ends where it turns a corner (a vertex with one face, or with three or more
//! faces at an inner corner such as that of an armhole), so that flat pieces and garments with openings are filled alike.

use crate::ids::{EdgeId, FaceId, HalfEdgeId};
use crate::label::{EdgeLabel, LabelError, LabelledMesh, Wales};

impl LabelledMesh {
    /// Fills the first row from a border edge: its border, up to the next corners, becomes course. Returns the faces of the row.
    ///
    /// # Errors
    /// [`LabelError::NotBorder`], or [`LabelError::NothingToFill`] where the row is there already.
    pub fn fill_from_border(&mut self, edge: EdgeId) -> Result<Vec<FaceId>, LabelError> {
        let (start, twin) = self.mesh.edge_sides(edge);
        if twin.is_some() {
            return Err(LabelError::NotBorder(edge));
        }
        let base = self.run(
            start,
            |h| self.mesh.next_on_border(h).filter(|_| self.mesh.valence(self.mesh.tip(h)) == 2),
            |h| self.border_before(h).filter(|_| self.mesh.valence(self.mesh.origin(h)) == 2),
        );
        self.fill(edge, base)
    }

    /// Fills the row beyond a course edge: the run of course edges along the labelled row, as far as there are unlabelled
    /// faces beyond. Returns the faces of the new row.
    ///
    /// # Errors
    /// [`LabelError::NotCourse`], or [`LabelError::NothingToFill`] where no face beyond is unlabelled.
    pub fn fill_from_course(&mut self, edge: EdgeId) -> Result<Vec<FaceId>, LabelError> {
        if self.label(edge) != Some(EdgeLabel::Course) {
            return Err(LabelError::NotCourse(edge));
        }
        let (first, twin) = self.mesh.edge_sides(edge);
        let start = [Some(first), twin]
            .into_iter()
            .flatten()
            .find(|h| self.is_open(self.mesh.face(*h)))
            .ok_or(LabelError::NothingToFill(edge))?;
        let open =
            |h: &HalfEdgeId| self.is_open(self.mesh.face(*h)) && self.label_of(*h) == Some(EdgeLabel::Course);
        // On the far side the course runs the other way.
        let base = self.run(
            start,
            |h| {
                let far = self.mesh.twin(h)?;
                self.mesh.twin(self.course_before(far)?).filter(open)
            },
            |h| {
                let far = self.mesh.twin(h)?;
                self.mesh.twin(self.course_after(far)?).filter(open)
            },
        );
        self.fill(edge, base)
    }

    /// Whether filling would do something to a face: it has edges without a label, or all of them but no wale direction. A
    /// face that came out with other than two wale edges is not filled again; it is for the hand tools.
    pub(crate) fn is_open(&self, face: FaceId) -> bool {
        let unlabelled = self.mesh.face_half_edges(face).any(|h| self.label_of(h).is_none());
        unlabelled || (self.wales(face).is_none() && self.wale_half_edges(face).is_some())
    }

    /// The longest run through `start` that `next` and `before` allow, in order; once round when it is a ring.
    fn run(
        &self,
        start: HalfEdgeId,
        next: impl Fn(HalfEdgeId) -> Option<HalfEdgeId>,
        before: impl Fn(HalfEdgeId) -> Option<HalfEdgeId>,
    ) -> Vec<HalfEdgeId> {
        let mut run = vec![start];
        let mut at = start;
        while let Some(h) = next(at) {
            if h == start || run.len() > self.mesh.half_edge_count() {
                return run;
            }
            run.push(h);
            at = h;
        }
        let mut front = Vec::new();
        at = start;
        while let Some(h) = before(at).filter(|_| front.len() <= self.mesh.half_edge_count()) {
            front.push(h);
            at = h;
        }
        front.reverse();
        front.extend(run);
        front
    }

    fn border_before(&self, h: HalfEdgeId) -> Option<HalfEdgeId> {
        // Turn about the origin until the border on the other side of the fan.
        let mut at = self.mesh.prev(h);
        while let Some(twin) = self.mesh.twin(at) {
            at = self.mesh.prev(twin);
            if at == h {
                return None;
            }
        }
        Some(at)
    }

    /// The next course half-edge of the same row and the same side, seen from the labelled face of `h`.
    fn course_after(&self, h: HalfEdgeId) -> Option<HalfEdgeId> {
        let after = self.mesh.next(h);
        match self.label_of(after)? {
            EdgeLabel::Course => Some(after),
            EdgeLabel::Wale => self.mesh.twin(after).map(|t| self.mesh.next(t)),
        }
        .filter(|n| self.label_of(*n) == Some(EdgeLabel::Course))
    }

    fn course_before(&self, h: HalfEdgeId) -> Option<HalfEdgeId> {
        let before = self.mesh.prev(h);
        match self.label_of(before)? {
            EdgeLabel::Course => Some(before),
            EdgeLabel::Wale => self.mesh.twin(before).map(|t| self.mesh.prev(t)),
        }
        .filter(|n| self.label_of(*n) == Some(EdgeLabel::Course))
    }

    /// Labels the row of faces that stand on `base`.
    fn fill(&mut self, edge: EdgeId, base: Vec<HalfEdgeId>) -> Result<Vec<FaceId>, LabelError> {
        let faces: Vec<FaceId> =
            base.iter().map(|h| self.mesh.face(*h)).filter(|f| self.is_open(*f)).collect();
        if faces.is_empty() {
            return Err(LabelError::NothingToFill(edge));
        }
        let mut on_base = vec![false; self.mesh.vertex_count()];
        for h in &base {
            self.labels[self.mesh.edge(*h).index()] = Some(EdgeLabel::Course);
            on_base[self.mesh.origin(*h).index()] = true;
            on_base[self.mesh.tip(*h).index()] = true;
        }
        for face in &faces {
            for h in self.mesh.face_half_edges(*face) {
                let touches = on_base[self.mesh.origin(h).index()] || on_base[self.mesh.tip(h).index()];
                let label = if touches { EdgeLabel::Wale } else { EdgeLabel::Course };
                self.labels[self.mesh.edge(h).index()].get_or_insert(label);
            }
        }
        // The base is the bottom: going round the face, the wale edge after it rises.
        for h in base {
            let face = self.mesh.face(h);
            if self.wales(face).is_none()
                && let Some([a, b]) = self.wale_half_edges(face)
            {
                let base_before_b = self.between(a, b).contains(&h);
                self.wales[face.index()] = Some(match base_before_b {
                    true => Wales { left: a, right: b },
                    false => Wales { left: b, right: a },
                });
            }
        }
        Ok(faces)
    }
}

#[cfg(test)]
mod tests {
    use crate::grid::plain_grid;
    use crate::ids::{EdgeId, FaceId, VertexId};
    use crate::label::{EdgeLabel, LabelError, LabelProblem, LabelledMesh};

    fn edge(labelled: &LabelledMesh, a: u32, b: u32) -> EdgeId {
        labelled.mesh().edge_between(VertexId(a), VertexId(b)).unwrap()
    }

    /// Vertices of a 3 × 2 grid: 0–3 below, 4–7 in the middle, 8–11 above.
    #[test]
    fn a_border_is_filled_up_to_its_corners_and_the_next_row_from_it() {
        let mut labelled = LabelledMesh::new(plain_grid(3, 2));
        let row = labelled.fill_from_border(edge(&labelled, 1, 2)).unwrap();
        assert_eq!(row, [FaceId(0), FaceId(1), FaceId(2)]);
        assert_eq!(labelled.label(edge(&labelled, 0, 4)), Some(EdgeLabel::Wale), "the side is not a course");
        assert_eq!(labelled.label(edge(&labelled, 5, 6)), Some(EdgeLabel::Course));
        assert_eq!(labelled.label(edge(&labelled, 4, 8)), None);
        assert_eq!(labelled.problems().len(), 3, "the other row is still to do");
        let next = labelled.fill_from_course(edge(&labelled, 6, 7)).unwrap();
        assert_eq!(next, [FaceId(3), FaceId(4), FaceId(5)]);
        assert_eq!(labelled.problems(), []);
        assert_eq!(labelled.rows().len(), 2);
        assert_eq!(labelled.row_of(FaceId(4)).faces, next);
    }

    #[test]
    fn the_side_filled_from_is_the_bottom_until_the_row_is_flipped() {
        let mut labelled = LabelledMesh::new(plain_grid(3, 2));
        labelled.fill_from_border(edge(&labelled, 9, 10)).unwrap();
        let wales = labelled.wales(FaceId(4)).unwrap();
        assert_eq!(labelled.mesh().edge(labelled.bottoms(wales)[0]), edge(&labelled, 9, 10));
        labelled.flip_row(FaceId(3)).unwrap();
        let wales = labelled.wales(FaceId(4)).unwrap();
        assert_eq!(labelled.mesh().edge(labelled.tops(wales)[0]), edge(&labelled, 9, 10));
        assert_eq!(labelled.row_of(FaceId(4)).faces, [FaceId(3), FaceId(4), FaceId(5)]);
    }

    #[test]
    fn tools_say_why_they_do_nothing() {
        let mut labelled = LabelledMesh::new(plain_grid(3, 2));
        let inner = edge(&labelled, 5, 6);
        assert_eq!(labelled.fill_from_border(inner), Err(LabelError::NotBorder(inner)));
        assert_eq!(labelled.fill_from_course(inner), Err(LabelError::NotCourse(inner)));
        assert_eq!(labelled.flip_row(FaceId(0)), Err(LabelError::NoRow(FaceId(0))));
        let base = edge(&labelled, 0, 1);
        labelled.fill_from_border(base).unwrap();
        assert_eq!(labelled.fill_from_border(base), Err(LabelError::NothingToFill(base)));
    }

    #[test]
    fn hand_labels_complete_a_face_or_break_it() {
        let mut labelled = LabelledMesh::new(plain_grid(3, 2));
        labelled.fill_from_border(edge(&labelled, 1, 2)).unwrap();
        for (a, b, label) in [(8, 9, EdgeLabel::Course), (4, 8, EdgeLabel::Wale), (5, 9, EdgeLabel::Wale)] {
            let edge = edge(&labelled, a, b);
            labelled.set_label(edge, Some(label));
        }
        assert!(labelled.wales(FaceId(3)).is_some() && labelled.wales(FaceId(4)).is_none());
        let top = edge(&labelled, 8, 9);
        labelled.set_label(top, Some(EdgeLabel::Wale));
        assert!(labelled.problems().contains(&LabelProblem::WaleCount { face: FaceId(3), count: 3 }));
    }
}
