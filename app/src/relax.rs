//! Relaxing the stitch mesh of a project: its stitches move on the smooth surface of the input until they are as even as they
//! can be, and the yarn is laid again.

use crate::project::Project;
use anyhow::{Result, bail};
use serde::Serialize;
use sim_core::Material;
use sim_core::mesh_relax::{MeshRelaxation, RelaxEnd, RelaxParams, RestLengths, StepFacts, worst};
use std::ops::ControlFlow;
use stitch_mesh::stitch_mesh::StitchMesh;

/// Sees stitches after every step of their relaxation, and may break off.
pub type Watch<'a> = &'a mut dyn FnMut(&MeshRelaxation, &StepFacts) -> ControlFlow<()>;

/// Watches nothing.
pub(crate) fn unwatched(_: &MeshRelaxation, _: &StepFacts) -> ControlFlow<()> {
    ControlFlow::Continue(())
}

/// The project with its stitch mesh relaxed, on the smooth surface of the input mesh or freely in space. `watch` is called
/// after every step and may break off.
///
/// # Errors
/// No stitches yet; parameters out of range; broken off.
pub fn relax_mesh(
    project: &Project,
    params: RelaxParams,
    surface: bool,
    watch: Watch<'_>,
) -> Result<Project> {
    let knitted = project.knitted()?;
    let before = &knitted.stitches;
    let input = surface.then(|| project.labelled.mesh());
    let mut relaxation = MeshRelaxation::new(before, input, params)?;
    if relaxation.run(watch) == RelaxEnd::Interrupted {
        bail!("stopped; nothing was changed");
    }
    let stitches = relaxation.stitches()?;
    let mut after = project.clone();
    // Yarn that nobody has chosen is as thick as its stitches, and these have another size now.
    if project.materials.base == Material::for_loop_width(mean_width(before)) {
        after.materials = project.materials.refitted(mean_width(&stitches));
    }
    after.scene.let_go(); // pins and clamps hold nodes where these are no more
    after.fabric = Some(knitted.edited(stitches));
    Ok(after)
}

/// Mean width of a stitch along its course edges [m].
pub(crate) fn mean_width(stitches: &StitchMesh) -> f64 {
    let mesh = stitches.mesh();
    let course = mesh.edges().filter(|e| !stitches.is_wale(mesh.edge_sides(*e).0));
    let (sum, count) = course.fold((0.0, 0), |(sum, n), e| (sum + mesh.edge_length(e), n + 1));
    sum / f64::from(count.max(1))
}

/// How even the stitches of a mesh are: strain of the faces against the size that all would have on the same area.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct MeshStrain {
    /// Most pressed.
    pub min: f64,
    /// Most stretched.
    pub max: f64,
    /// Root mean square.
    pub rms: f64,
    /// The faces furthest from rest.
    pub worst: Vec<FaceStrain>,
    /// All of them, [face_count].
    #[serde(skip)]
    pub faces: Vec<f32>,
}

/// One of them.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct FaceStrain {
    /// The face.
    pub face: u32,
    /// Its strain: above zero where it is stretched, below where it is pressed.
    pub strain: f64,
}

/// The strain of a stitch mesh whose stitches should be `aspect` times as high as wide.
pub fn mesh_strain(stitches: &StitchMesh, aspect: f64) -> Option<MeshStrain> {
    /// Faces named.
    const NAMED: usize = 5;
    let mesh = stitches.mesh();
    let area = mesh.faces().map(|f| mesh.face_area_vector(f).length()).sum();
    let rest = RestLengths::new(stitches, area, aspect, 1.0).ok()?;
    let strain = rest.strain(stitches, mesh.positions());
    let (min, max) =
        strain.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), s| (l.min(*s), h.max(*s)));
    let rms = (strain.iter().map(|s| s * s).sum::<f64>() / strain.len() as f64).sqrt();
    let worst = worst(&strain, NAMED).into_iter().map(|(face, strain)| FaceStrain { face: face.0, strain });
    let faces = strain.iter().map(|s| *s as f32).collect();
    Some(MeshStrain { min, max, rms, worst: worst.collect(), faces })
}
