//! What the window sees of the document: made in the document's thread, with everything in it that takes a while to find.

use crate::document::Document;
use crate::inspect::{Inspection, inspect};
use crate::project::Project;
use std::path::PathBuf;
use std::sync::Arc;
use stitch_mesh::label::{LabelledMesh, Row};
use stitch_mesh::stitch_mesh::StitchMesh;

/// The document as the window last saw it.
#[derive(Clone, Debug)]
pub struct View {
    /// Counts the changes.
    pub revision: u64,
    /// Counts how often the document itself has put the yarn somewhere (laid it anew, or took that back); otherwise the
    /// simulation knows best where it is.
    pub placed: u64,
    /// Counts how often another document has taken its place.
    pub opened: u64,
    /// Whether there is something in it that has not been saved.
    pub is_changed: bool,
    /// The project.
    pub project: Project,
    /// Rows of the labelled mesh.
    pub labelled_rows: Arc<Rows<LabelledMesh>>,
    /// Rows of the fabric.
    pub fabric_rows: Option<Arc<Rows<StitchMesh>>>,
    /// The file it was made from, or is to be written to.
    pub path: Option<PathBuf>,
    /// The project file that it is in, if it is in one.
    pub home: Option<PathBuf>,
    /// Names of the steps done, oldest first.
    pub done: Vec<String>,
    /// Names of the steps that were taken back, the next to be done again first.
    pub undone: Vec<String>,
    /// What the last request came to: done, or why not.
    pub message: Result<String, String>,
}

/// What the session knows of a document besides itself; see [`View`].
#[derive(Clone, Debug, Default)]
pub(super) struct Standing {
    pub revision: u64,
    pub placed: u64,
    pub opened: u64,
    pub is_changed: bool,
    pub path: Option<PathBuf>,
    pub home: Option<PathBuf>,
}

/// Facts about a project: they take longer to find than most edits, so they come after the view.
#[derive(Debug, Default)]
pub struct Survey {
    /// The revision that was looked at.
    pub revision: u64,
    /// What was found.
    pub facts: Inspection,
}

impl Survey {
    /// Looks at a view's project.
    pub(super) fn of(view: &View) -> Self {
        Self { revision: view.revision, facts: inspect(&view.project) }
    }
}

/// Rows of a mesh, and where each face is in them.
#[derive(Debug)]
pub struct Rows<M> {
    of: Arc<M>,
    /// All rows.
    pub rows: Vec<Row>,
    /// The number of each row, from 0; those that are knitted beside each other have the same.
    numbers: Vec<usize>,
    /// Row and place in it, [face_count]; none for faces without labels.
    place: Vec<Option<[u32; 2]>>,
}

impl<M> Rows<M> {
    fn new(of: &Arc<M>, face_count: usize, rows: Vec<Row>, numbers: Vec<usize>) -> Self {
        let mut place = vec![None; face_count];
        for (r, row) in rows.iter().enumerate() {
            row.faces.iter().enumerate().for_each(|(i, f)| place[f.index()] = Some([r as u32, i as u32]));
        }
        Self { of: of.clone(), rows, numbers, place }
    }

    /// Number of the row of a face, its place in the row, and how many are in it; counted from 0.
    pub fn place(&self, face: u32) -> Option<[usize; 3]> {
        let [row, place] = (*self.place.get(face as usize)?)?.map(|n| n as usize);
        Some([self.numbers[row], place, self.rows[row].faces.len()])
    }
}

impl View {
    /// A view of `document`. What `before` has found about the same meshes is taken over.
    pub(super) fn of(
        document: &Document,
        Standing { revision, placed, opened, is_changed, path, home }: Standing,
        message: Result<String, String>,
        before: Option<&Self>,
    ) -> Self {
        let project = document.project().clone();
        let labelled = &project.labelled;
        let labelled_rows =
            before.map(|b| &b.labelled_rows).filter(|r| Arc::ptr_eq(&r.of, labelled)).cloned();
        let labelled_rows = labelled_rows.unwrap_or_else(|| {
            let rows = labelled.rows();
            let numbers = (0..rows.len()).collect();
            Arc::new(Rows::new(labelled, labelled.mesh().face_count(), rows, numbers))
        });
        let fabric_rows = project.fabric.as_ref().map(|fabric| {
            let stitches = &fabric.stitches;
            let known = before.and_then(|b| b.fabric_rows.as_ref());
            known.filter(|r| r.of.shares_mesh_of(stitches)).cloned().unwrap_or_else(|| {
                let (rows, heights) = stitches.rows_and_heights();
                Arc::new(Rows::new(stitches, stitches.mesh().face_count(), rows, heights))
            })
        });
        Self {
            revision,
            placed,
            opened,
            is_changed,
            labelled_rows,
            fabric_rows,
            project,
            path,
            home,
            done: document.steps().collect(),
            undone: document.undone().collect(),
            message,
        }
    }
}
