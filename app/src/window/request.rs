//! What the window asks of the document.

use crate::bundled::Bundled;
use crate::command::Command;
use patterns::diagram::Course;
use std::path::{Path, PathBuf};

/// What a session can be asked to do.
#[derive(Clone, Debug)]
pub enum Request {
    /// Do a command.
    Do(Command),
    /// Do a command as part of the last step (a brush stroke).
    Amend(Command),
    /// Take back the last step.
    Undo,
    /// Do again what was taken back.
    Redo,
    /// Go back or forward in the history until so many steps are done.
    GoTo(usize),
    /// Open a project or mesh in place of this one.
    Open(PathBuf),
    /// Begin anew with what comes with the program.
    Begin(&'static Bundled),
    /// Only tell something.
    Say(&'static str),
    /// Take the scene of a name or a file.
    Scene(String),
    /// Save the project.
    Save(PathBuf),
    /// Save knitting instructions, for all or for some stitches.
    SaveInstructions(PathBuf, Option<Vec<u32>>),
    /// Save the history as a script.
    SaveScript(PathBuf),
    /// Save a chart of some rows.
    SaveChart(PathBuf, Vec<Course>),
}

impl Request {
    /// The file that it writes.
    pub fn writes(&self) -> Option<&Path> {
        match self {
            Self::Save(path)
            | Self::SaveInstructions(path, _)
            | Self::SaveScript(path)
            | Self::SaveChart(path, _) => Some(path),
            _ => None,
        }
    }

    /// Whether what it does to the document is lost unless that is saved.
    pub(super) fn changes(&self) -> bool {
        matches!(
            self,
            Self::Do(_) | Self::Amend(_) | Self::Undo | Self::Redo | Self::GoTo(_) | Self::Scene(_)
        )
    }

    /// What is going on while it is carried out.
    pub(super) fn doing(&self) -> String {
        match self {
            Self::Do(command) | Self::Amend(command) => command.name(),
            Self::Undo => "Undo".into(),
            Self::Redo => "Redo".into(),
            Self::GoTo(_) => "Go through the history".into(),
            Self::Open(path) => format!("Open {}", path.display()),
            Self::Begin(bundled) => format!("Knit {}", bundled.name),
            Self::Scene(name) => format!("Scene {name}"),
            Self::Say(_) => "Open".into(),
            Self::Save(path)
            | Self::SaveScript(path)
            | Self::SaveInstructions(path, _)
            | Self::SaveChart(path, _) => {
                format!("Save {}", path.display())
            }
        }
    }
}
