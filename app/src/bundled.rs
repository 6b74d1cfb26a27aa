//! The pullover that comes with the program.

use crate::command::Command;
use crate::project::{DEFAULT_STITCH_WIDTH, Project};
use crate::scenes;
use anyhow::Result;
use stitch_mesh::edge_counts::StitchSize;
use stitch_mesh::obj::{Unit, read_obj};

/// The bundled pullover, in metres.
const PULLOVER: &[u8] = include_bytes!("../../assets/meshes/pullover.obj");

/// The pullover as it was read.
///
/// # Errors
/// The bundled mesh is broken.
pub fn mesh() -> Result<Project> {
    Ok(Project::new(read_obj(PULLOVER, Unit::M)?, StitchSize::of_width(DEFAULT_STITCH_WIDTH)))
}

/// Labels and stitches for it: stockinette with a ribbed hem.
fn stitched(project: &Project) -> Result<Project> {
    let tessellate = Command::Tessellate { width_mm: Some(1e3 * DEFAULT_STITCH_WIDTH) };
    let rib = Command::SetChart { chart: vec!["k k p p".into()], rows: Some([0, 6]), faces: None };
    rib.apply(&tessellate.apply(project)?)
}

/// The pullover, labelled, knitted and on its dress form: what the window opens with.
///
/// # Errors
/// The bundled mesh is broken.
pub fn pullover() -> Result<Project> {
    let mut project = stitched(&Command::Autolabel.apply(&mesh()?)?)?;
    project.scene = scenes::scene("form", project.fabric()?, &project.materials.base)?;
    Ok(project)
}
