//! Opening whatever a project can begin with.

use crate::files;
use crate::project::{DEFAULT_STITCH_WIDTH, Project};
use crate::written::swatch;
use anyhow::{Context, Result, bail};
use patterns::knitspeak::Width;
use std::path::Path;
use stitch_mesh::edge_counts::StitchSize;
use stitch_mesh::obj::Unit;

/// Opens a project, or a mesh in metres or a swatch of a written pattern as a new project.
///
/// # Errors
/// What is wrong with the file, by line or face; a file of another kind.
pub fn open_any(path: &Path) -> Result<Project> {
    match path.extension().and_then(|e| e.to_str()) {
        Some("purl") => Project::open(path),
        Some("obj") => Project::from_obj(path, Unit::M, StitchSize::of_width(DEFAULT_STITCH_WIDTH)),
        Some("ks") => {
            let name = || path.display().to_string();
            let text = String::from_utf8(files::read(path)?).with_context(name)?;
            Ok(swatch(&text, Width::AsWritten, 1).with_context(name)?.0)
        }
        _ => bail!("cannot open {}: the name has to end in .purl, .obj or .ks", path.display()),
    }
}
