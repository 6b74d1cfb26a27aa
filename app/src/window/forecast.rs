//! What tessellating would come to, worked out beside the window before anybody asks for it to be done.

use crate::project::Project;
use std::sync::{Arc, Mutex, PoisonError};
use stitch_mesh::edge_counts::{EdgeCounts, StitchSize};
use stitch_mesh::stitch_mesh::StitchMesh;
use stitch_mesh::tessellate::tessellate;

/// How many stitches there are, and of which kinds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Tally {
    /// Stitches.
    pub stitches: usize,
    /// Those that make more loops than they take.
    pub increases: usize,
    /// Those that make fewer.
    pub decreases: usize,
    /// Rows.
    pub rows: usize,
}

impl Tally {
    /// Counts a fabric.
    pub fn of(stitches: &StitchMesh) -> Self {
        let count = |wanted: fn(usize, usize) -> bool| {
            stitches.stitches().iter().filter(|s| wanted(s.bottoms(), s.tops())).count()
        };
        Self {
            stitches: stitches.stitches().len(),
            increases: count(|bottoms, tops| tops > bottoms),
            decreases: count(|bottoms, tops| tops < bottoms),
            rows: stitches.rows().len(),
        }
    }
}

/// What the forecast is for: labels and counts by revision, and the stitch width in micrometres if it is to be changed.
pub type Question = (u64, Option<u64>);

type Answer = Result<Tally, String>;

/// The newest forecast.
#[derive(Default)]
pub struct Forecast {
    asked: Option<Question>,
    answer: Arc<Mutex<Option<(Question, Answer)>>>,
}

impl Forecast {
    /// The answer to a question, once it is there; begins to work it out where it is a new one. `wake` is called then.
    pub fn ask(
        &mut self,
        question: Question,
        project: &Project,
        wake: impl Fn() + Send + 'static,
    ) -> Option<Answer> {
        if self.asked != Some(question) {
            self.asked = Some(question);
            let (labelled, counts) = (project.labelled.clone(), project.counts.clone());
            let width = question.1.map_or(project.size.width, |um| um as f64 * 1e-6);
            let slot = Arc::clone(&self.answer);
            let work = move || {
                let anew = || EdgeCounts::from_size(&labelled, StitchSize::of_width(width));
                let marked = || counts.as_ref().map(|c| c.marked.clone()).unwrap_or_default();
                let counts = match (&counts, question.1) {
                    (Some(counts), None) => Ok(counts.clone()),
                    _ => anew().map(|new| EdgeCounts { marked: marked(), ..new }),
                };
                let tally = counts.map_err(|e| e.to_string()).and_then(|counts| {
                    tessellate(&labelled, &counts).map(|s| Tally::of(&s)).map_err(|e| e.to_string())
                });
                *slot.lock().unwrap_or_else(PoisonError::into_inner) = Some((question, tally));
                wake();
            };
            if let Err(error) = std::thread::Builder::new().name("forecast".to_owned()).spawn(work) {
                tracing::warn!("no forecast: {error}");
            }
        }
        let answer = self.answer.lock().unwrap_or_else(PoisonError::into_inner).clone();
        answer.filter(|(of, _)| *of == question).map(|(_, answer)| answer)
    }
}
