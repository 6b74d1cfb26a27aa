//! The main job without a window: the bundled pullover from OBJ through every stage to a draped rest.

use super::{Output, picture, report, simulate};
use crate::command::Command;
use crate::drawing::Stage;
use crate::files;
use crate::inspect::inspect;
use crate::project::{DEFAULT_STITCH_WIDTH, Project};
use crate::scenes;
use anyhow::Result;
use render::{Gpu, NamedView};
use std::path::Path;
use stitch_mesh::edge_counts::StitchSize;
use stitch_mesh::obj::{Unit, read_obj};

/// The bundled pullover, in metres.
pub const PULLOVER: &[u8] = include_bytes!("../../../assets/meshes/pullover.obj");

/// Size of the pictures.
const SIZE: [u32; 2] = [1280, 960];

/// Simulated time after which the drape ends even if something still creeps [s].
const DRAPE_LIMIT: f64 = 1.0;

/// The pullover as it was read.
fn mesh() -> Result<Project> {
    Ok(Project::new(read_obj(PULLOVER, Unit::M)?, StitchSize::of_width(DEFAULT_STITCH_WIDTH)))
}

/// Labels and stitches for it: stockinette with a ribbed hem.
fn stitched(project: &Project) -> Result<Project> {
    let tessellate = Command::Tessellate { width_mm: 1e3 * DEFAULT_STITCH_WIDTH };
    let rib = Command::SetChart { chart: vec!["k k p p".into()], rows: Some([0, 6]) };
    rib.apply(&tessellate.apply(project)?)
}

/// The pullover, labelled, knitted and on its dress form: what the window opens with.
///
/// # Errors
/// The bundled mesh is broken.
pub fn project() -> Result<Project> {
    let mut project = stitched(&Command::Autolabel.apply(&mesh()?)?)?;
    project.scene = scenes::scene("form", &project.fabric()?.state())?;
    Ok(project)
}

/// Runs the flow and leaves pictures and figures in `out`.
pub fn run(out: &Path, output: Output) -> Result<()> {
    std::fs::create_dir_all(out)?;
    let gpu = Gpu::headless()?;
    let draw = |project: &Project, stage, name: &str| {
        picture(&gpu, project, stage, NamedView::ThreeQuarter, SIZE, &out.join(name))
    };
    draw(&mesh()?, Stage::Mesh, "mesh.png")?;
    draw(&Command::Autolabel.apply(&mesh()?)?, Stage::Labels, "labels.png")?;
    let project = project()?;
    draw(&project, Stage::Stitches, "stitches.png")?;
    draw(&project, Stage::Yarn, "yarn-initial.png")?;
    let scene = project.scene.clone();
    let project = simulate::settle(project, scene, DRAPE_LIMIT, "draping")?;
    draw(&project, Stage::Yarn, "yarn.png")?;
    project.save(&out.join("pullover.purl"))?;
    files::write(&out.join("demo.json"), &serde_json::to_vec_pretty(&inspect(&project))?)?;
    report(&project, output)
}
