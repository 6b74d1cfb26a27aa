//! The document: a project and the history of what was done to it.

use crate::command::Command;
use crate::fabric::Moved;
use crate::project::Project;
use crate::relax::unwatched;
use anyhow::Result;
use std::collections::HashSet;
use std::hash::Hash;
use std::sync::Arc;
use stitch_mesh::edit::Survivors;
use stitch_mesh::ids::FaceId;

/// A project that is being edited. Needs no window.
#[derive(Clone, Debug)]
pub struct Document {
    project: Project,
    done: Vec<Step>,
    undone: Vec<Step>,
    /// Whether the last step done is the one that was begun last: what is to amend a step that came to nothing begins one.
    is_open: bool,
}

/// Commands that are done and undone together, never none, and the project on their other side: before them when done, after
/// them when undone.
#[derive(Clone, Debug)]
struct Step {
    commands: Vec<Command>,
    project: Project,
    /// Which faces came through the command, if it has changed the faces of the stitch mesh.
    survivors: Option<Arc<Survivors>>,
}

impl Step {
    /// Of a large fabric its yarn is far more than its stitches, so the history keeps it only where it has moved.
    fn new(commands: Vec<Command>, mut project: Project, survivors: Option<Arc<Survivors>>) -> Self {
        if let Some(fabric) = &mut project.fabric {
            fabric.put_away();
        }
        Self { commands, project, survivors }
    }

    fn name(&self) -> String {
        // What makes room for something else is not worth a word.
        let telling: Vec<&Command> =
            self.commands.iter().filter(|c| !matches!(c, Command::ClearCables { .. })).collect();
        let more = telling.len().saturating_sub(1);
        let first = telling.first().copied().or(self.commands.first()).map(Command::name).unwrap_or_default();
        if more == 0 { first } else { format!("{first} and {more} more") }
    }
}

impl Document {
    /// A document without history.
    pub fn new(project: Project) -> Self {
        Self { project, done: Vec::new(), undone: Vec::new(), is_open: false }
    }

    /// The project now.
    pub fn project(&self) -> &Project {
        &self.project
    }

    /// Does a command. What had been undone is forgotten. A command that leaves everything as it was is no step of the history.
    ///
    /// # Errors
    /// Why it cannot be done; nothing has changed then.
    pub fn apply(&mut self, command: Command) -> Result<()> {
        self.close_step();
        let done = command.perform(&self.project, &mut unwatched)?;
        self.keep(command, done, false);
        Ok(())
    }

    /// Does a command as part of the last step, as a brush does that has reached one more face: there is still one step to
    /// undo. Where the command that was to begin it has changed nothing, this one begins it.
    ///
    /// # Errors
    /// Why it cannot be done; nothing has changed then.
    pub fn amend(&mut self, command: Command) -> Result<()> {
        let done = command.perform(&self.project, &mut unwatched)?;
        self.keep(command, done, true);
        Ok(())
    }

    /// What amends the last step from now on begins one instead.
    pub(crate) fn close_step(&mut self) {
        self.is_open = false;
    }

    /// Takes over what a command has made of the project, worked out elsewhere; as a step of its own or as part of the last. Says
    /// whether anything is another than before.
    pub(crate) fn keep(
        &mut self,
        command: Command,
        (after, survivors): (Project, Option<Survivors>),
        amends: bool,
    ) -> bool {
        let amends = amends && self.is_open;
        if after.is_as(&self.project) {
            self.is_open = amends;
            return false;
        }
        let before = std::mem::replace(&mut self.project, after);
        self.undone.clear();
        self.is_open = true;
        let survivors = survivors.map(Arc::new);
        let Some(step) = self.done.last_mut().filter(|_| amends) else {
            self.done.push(Step::new(vec![command], before, survivors));
            return true;
        };
        step.survivors = match (step.survivors.take(), survivors) {
            (Some(first), Some(second)) => Some(Arc::new(through_both(&first, &second))),
            (first, second) => first.or(second),
        };
        match step.commands.last_mut().and_then(|last| Some((merge(last, &command)?, last))) {
            Some((both, last)) => *last = both,
            None => step.commands.push(command),
        }
        true
    }

    /// Takes back the last command. False if there is none.
    pub fn undo(&mut self) -> bool {
        self.is_open = false;
        let Some(step) = self.done.pop() else { return false };
        let was = step.survivors.as_ref().map(|s| s.faces.clone());
        let step = self.swap(step, was.as_deref());
        self.undone.push(step);
        true
    }

    /// Does again what was taken back last. False if there is none.
    pub fn redo(&mut self) -> bool {
        self.is_open = false;
        let Some(step) = self.undone.pop() else { return false };
        let was = step.survivors.as_ref().map(|s| s.faces_before());
        let step = self.swap(step, was.as_deref());
        self.done.push(step);
        true
    }

    /// Goes to the other side of a step. `was` tells which face of the project now each face there is.
    fn swap(&mut self, step: Step, was: Option<&[Option<FaceId>]>) -> Step {
        let Step { commands, project: mut restored, survivors } = step;
        // Edits are undone, time is not: the yarn stays where it has got to, unless its place was the edit.
        if !commands.contains(&Command::ResetYarn) {
            restored.keep_yarn_of(&self.project, was);
        }
        let project = std::mem::replace(&mut self.project, restored);
        Step::new(commands, project, survivors)
    }

    /// Commands done so far, oldest first.
    pub fn done(&self) -> impl Iterator<Item = &Command> {
        self.done.iter().flat_map(|s| &s.commands)
    }

    /// Names of the steps done, oldest first.
    pub fn steps(&self) -> impl ExactSizeIterator<Item = String> {
        self.done.iter().map(Step::name)
    }

    /// Names of the steps that were taken back, the one that [`Self::redo`] would do first.
    pub fn undone(&self) -> impl ExactSizeIterator<Item = String> {
        self.undone.iter().rev().map(Step::name)
    }

    /// Takes over where the simulation has brought the yarn. No step of the history: time is not undone, edits are. What
    /// began with another net (one from before an edit) is dropped.
    pub fn take_over(&mut self, moved: Moved) {
        if let Some(fabric) = &self.project.fabric
            && fabric.net_if_laid().is_some_and(|net| Arc::ptr_eq(&moved.from, net))
            && moved.state.fits(&moved.net)
            && moved.state.is_finite()
        {
            self.project.take_over(moved, None);
        }
    }
}

/// What comes through two edits, one after the other.
fn through_both(first: &Survivors, second: &Survivors) -> Survivors {
    let vertices = first.vertices.iter().map(|v| v.and_then(|v| *second.vertices.get(v.index())?));
    let faces = first.faces.iter().map(|f| f.and_then(|f| *second.faces.get(f.index())?));
    Survivors { vertices: vertices.collect(), faces: faces.collect() }
}

/// One command that does what two of the same brush or slider did.
fn merge(first: &Command, second: &Command) -> Option<Command> {
    use Command::{Dye, LabelEdges, SetMaterial, SetScene, SetStitch};
    match (first, second) {
        (SetStitch { faces, stitch: a }, SetStitch { faces: more, stitch }) if a == stitch => {
            Some(SetStitch { faces: union(faces, more), stitch: stitch.clone() })
        }
        (Dye { faces, color: a }, Dye { faces: more, color }) if a == color => {
            Some(Dye { faces: union(faces, more), color: *color })
        }
        (LabelEdges { edges, label: a }, LabelEdges { edges: more, label }) if a == label => {
            Some(LabelEdges { edges: union(edges, more), label: *label })
        }
        (SetMaterial { color: a, .. }, SetMaterial { color, .. }) if a == color => Some(second.clone()),
        (SetScene { .. }, SetScene { .. }) => Some(second.clone()),
        _ => None,
    }
}

/// What is in either list, in order of first mention.
fn union<T: Copy + Eq + Hash>(first: &[T], second: &[T]) -> Vec<T> {
    let mut seen = HashSet::new();
    first.iter().chain(second).copied().filter(|x| seen.insert(*x)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::command::{read_script, write_script};
    use crate::fabric::Fabric;
    use stitch_mesh::edge_counts::StitchSize;
    use stitch_mesh::pieces::rectangle;
    use stitch_mesh::stitch::Stitch;

    fn document() -> Document {
        let size = StitchSize::of_width(0.004);
        let stitches = rectangle(6, 4, size).unwrap();
        let mut project = Project::new(stitches.mesh().clone(), size);
        project.fabric = Some(Fabric::new(stitches));
        Document::new(project)
    }

    fn purls(document: &Document) -> usize {
        let stitches = document.project().fabric().unwrap().stitches.stitches().to_vec();
        stitches.iter().filter(|s| **s == Stitch::purl()).count()
    }

    #[test]
    fn undo_and_redo_walk_the_history() {
        let mut document = document();
        let purl = |faces: &[u32]| Command::SetStitch { faces: faces.to_vec(), stitch: Stitch::purl() };
        document.apply(purl(&[0, 1])).unwrap();
        document.apply(purl(&[2])).unwrap();
        assert_eq!(purls(&document), 3);
        assert!(document.undo() && document.undo() && !document.undo());
        assert_eq!(purls(&document), 0);
        assert!(document.redo());
        assert_eq!(purls(&document), 2);
        document.apply(purl(&[0])).unwrap();
        assert!(document.undo() && document.redo(), "what changes nothing is no step");
        document.apply(purl(&[5])).unwrap();
        assert!(!document.redo(), "what was undone is forgotten after a new command");
    }

    #[test]
    fn a_brush_stroke_is_one_step() {
        let mut document = document();
        let purl = |face| Command::SetStitch { faces: vec![face], stitch: Stitch::purl() };
        document.apply(purl(3)).unwrap();
        document.amend(purl(4)).unwrap();
        document.amend(purl(4)).unwrap();
        assert_eq!(
            document.done().collect::<Vec<_>>(),
            [&Command::SetStitch { faces: vec![3, 4], stitch: Stitch::purl() }]
        );
        assert!(document.undo());
        assert_eq!(purls(&document), 0);
    }

    #[test]
    fn a_stroke_that_begins_where_nothing_changes_is_a_step_of_its_own() {
        let mut document = document();
        let purl = |face| Command::SetStitch { faces: vec![face], stitch: Stitch::purl() };
        document.apply(purl(3)).unwrap();
        document.apply(purl(3)).unwrap();
        document.amend(purl(4)).unwrap();
        document.amend(purl(5)).unwrap();
        assert_eq!(document.steps().collect::<Vec<_>>(), ["Set 1 stitch to p", "Set 2 stitches to p"]);
        assert!(document.undo());
        document.amend(purl(6)).unwrap();
        assert_eq!(document.steps().len(), 2, "what was undone to is no step to go on with");
        assert!(document.apply(purl(99)).is_err());
        document.amend(purl(7)).unwrap();
        assert_eq!(document.steps().len(), 3, "nor is what came before a command that failed");
    }

    #[test]
    fn commands_of_one_step_stay_in_the_script_and_are_undone_together() {
        let mut document = document();
        let set =
            |face, symbol: &str| Command::SetStitch { faces: vec![face], stitch: symbol.parse().unwrap() };
        document.apply(set(3, "k1")).unwrap();
        document.amend(set(4, "p")).unwrap();
        assert_eq!(document.steps().collect::<Vec<_>>(), ["Set 1 stitch to k1 and 1 more"]);
        assert_eq!(document.done().count(), 2);
        assert!(document.undo() && !document.undo());
        assert_eq!((purls(&document), document.undone().len()), (0, 1));
        assert!(document.redo());
        assert_eq!(purls(&document), 1);
    }

    #[test]
    fn a_failed_command_changes_nothing() {
        let mut document = document();
        let error =
            document.apply(Command::SetStitch { faces: vec![0, 99], stitch: Stitch::purl() }).unwrap_err();
        assert_eq!(error.to_string(), "there is no face 99: the faces are 0–23");
        assert_eq!((purls(&document), document.done().count()), (0, 0));
        assert!(
            document.apply(Command::SetStitch { faces: vec![0], stitch: "kp".parse().unwrap() }).is_err()
        );
    }

    #[test]
    fn a_script_does_what_the_history_did() {
        let mut document = document();
        document.apply(Command::Autolabel).unwrap();
        document.apply(Command::Tessellate { width_mm: Some(2.0) }).unwrap();
        document
            .apply(Command::SetChart { chart: vec!["k p".into()], rows: Some([1, 2]), faces: None })
            .unwrap();
        let script = write_script(document.done()).unwrap();
        let mut again = Document::new(self::document().project().clone());
        for (_, command) in read_script(&script).unwrap() {
            again.apply(command).unwrap();
        }
        let stitches = |d: &Document| d.project().fabric().unwrap().stitches.clone();
        assert_eq!(stitches(&again), stitches(&document));
        assert!(purls(&again) > 0);
        assert!(
            read_script("{\"do\":\"autolabel\"}\n{\"do\":\"dance\"}")
                .unwrap_err()
                .to_string()
                .contains("line 2")
        );
    }
}
