//! The window.
use crate::project::Project;
/// Opens the window.
pub fn run(_project: Option<Project>, _path: Option<std::path::PathBuf>) -> anyhow::Result<()> {
    Ok(())
}
