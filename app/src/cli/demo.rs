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
use stitch_mesh::obj::{Unit, read_obj};
use stitch_mesh::tessellate::StitchSize;

/// The bundled pullover, in metres.
pub const PULLOVER: &[u8] = include_bytes!("../../../assets/meshes/pullover.obj");

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
    let mesh = read_obj(PULLOVER, Unit::M)?;
    let project = Project::new(mesh, StitchSize::of_width(DEFAULT_STITCH_WIDTH));
    draw(&project, Stage::Mesh, "mesh.png")?;
    let project = Command::Autolabel.apply(&project)?;
    draw(&project, Stage::Labels, "labels.png")?;
    let mut project = Command::Tessellate { width_mm: 1e3 * DEFAULT_STITCH_WIDTH }.apply(&project)?;
    for (chart, rows) in [("k k p p", [0, 6])] {
        project = Command::SetChart { chart: vec![chart.into()], rows: Some(rows) }.apply(&project)?;
    }
    draw(&project, Stage::Stitches, "stitches.png")?;
    let scene = scenes::scene("form", &project.fabric()?.state())?;
    project.scene = scene.clone();
    draw(&project, Stage::Yarn, "yarn-initial.png")?;
    let project = simulate::settle(project, scene, DRAPE_LIMIT, "draping")?;
    draw(&project, Stage::Yarn, "yarn.png")?;
    project.save(&out.join("pullover.purl"))?;
    files::write(&out.join("demo.json"), &serde_json::to_vec_pretty(&inspect(&project))?)?;
    report(&project, output)
}
