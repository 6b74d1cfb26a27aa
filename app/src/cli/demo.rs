//! The main job without a window: the bundled pullover from OBJ through every stage to a draped rest.

use super::{Output, picture, report, simulate};
use crate::bundled;
use crate::drawing::Stage;
use crate::files;
use crate::inspect::inspect;
use crate::project::Project;
use anyhow::Result;
use render::{Gpu, NamedView};
use std::path::Path;

/// Size of the pictures.
const SIZE: [u32; 2] = [1280, 960];

/// Simulated time after which the drape ends even if something still creeps [s].
const DRAPE_LIMIT: f64 = 1.0;

/// Runs the flow and leaves pictures and figures in `out`.
pub fn run(out: &Path, output: Output) -> Result<()> {
    std::fs::create_dir_all(out)?;
    let gpu = Gpu::headless()?;
    let draw = |project: &Project, stage, name: &str| {
        picture(&gpu, project, stage, NamedView::ThreeQuarter, SIZE, &out.join(name))
    };
    let project = bundled::pullover()?;
    let mesh = Project::new(project.labelled.mesh().clone(), project.size);
    draw(&mesh, Stage::Mesh, "mesh.png")?;
    draw(&project, Stage::Labels, "labels.png")?;
    draw(&project, Stage::Stitches, "stitches.png")?;
    draw(&project, Stage::Yarn, "yarn-initial.png")?;
    let scene = project.scene.clone();
    let project = simulate::settle(project, scene, DRAPE_LIMIT, "draping")?;
    draw(&project, Stage::Yarn, "yarn.png")?;
    project.save(&out.join("pullover.purl"))?;
    files::write(&out.join("demo.json"), &serde_json::to_vec_pretty(&inspect(&project))?)?;
    report(&project, output)
}
