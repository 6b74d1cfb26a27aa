//! The verb `new`, and scripts.

use crate::bundled;
use crate::command::{Command, read_script};
use crate::document::Document;
use crate::files;
use crate::project::{DEFAULT_STITCH_WIDTH, Project};
use anyhow::{Context, Result, bail};
use std::path::Path;
use stitch_mesh::edge_counts::StitchSize;
use stitch_mesh::obj::Unit;

/// A project from a mesh, in a file or bundled: labelled, and tessellated where the labels allow it.
pub fn new(mesh: &Path, unit: Unit, stitch_mm: Option<f64>, script: Option<&Path>) -> Result<Project> {
    if let Some(mm) = stitch_mm.filter(|mm| !(0.1..=1000.0).contains(mm)) {
        bail!("a stitch of {mm} mm cannot be knitted: --stitch-size goes from 0.1 to 1000");
    }
    let bundled = mesh.to_str().and_then(bundled::find).filter(|_| !mesh.exists());
    let usual = bundled.map_or(DEFAULT_STITCH_WIDTH, |b| b.width);
    let width = stitch_mm.map_or(usual, |mm| mm * 1e-3);
    let project = match bundled {
        Some(bundled) if script.is_none() => return bundled.knitted(width),
        Some(bundled) => bundled.mesh(width)?,
        None => Project::from_obj(mesh, unit, StitchSize::of_width(width))?,
    };
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
        0 => Command::Tessellate { width_mm: Some(1e3 * width) }.apply(&project),
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
