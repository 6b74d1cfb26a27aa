//! The verb `new`, and scripts.

use crate::command::{Command, read_script};
use crate::document::Document;
use crate::files;
use crate::project::Project;
use anyhow::{Context, Result, bail};
use std::path::Path;
use stitch_mesh::edge_counts::StitchSize;
use stitch_mesh::obj::Unit;

/// A project from a mesh: labelled, and tessellated where the labels allow it.
pub fn new(mesh: &Path, unit: Unit, stitch_mm: f64, script: Option<&Path>) -> Result<Project> {
    if !(0.1..=1000.0).contains(&stitch_mm) {
        bail!("a stitch of {stitch_mm} mm cannot be knitted: --stitch-size goes from 0.1 to 1000");
    }
    let project = Project::from_obj(mesh, unit, StitchSize::of_width(stitch_mm * 1e-3))?;
    let project = match script {
        Some(script) => {
            let text = String::from_utf8(files::read(script)?)
                .with_context(|| format!("{} is not text", script.display()))?;
            perform(project, &text).with_context(|| script.display().to_string())?
        }
        None => Command::Autolabel.apply(&project)?,
    };
    if project.fabric.is_some() {
        return Ok(project);
    }
    match project.labelled.problems().len() {
        0 => Command::Tessellate { width_mm: Some(stitch_mm) }.apply(&project),
        _ => Ok(project), // the report says what could not be decided
    }
}

/// Runs a script of commands.
pub fn perform(project: Project, script: &str) -> Result<Project> {
    let mut document = Document::new(project);
    for (number, command) in read_script(script)? {
        document.apply(command).with_context(|| format!("line {number}"))?;
    }
    Ok(document.project().clone())
}
