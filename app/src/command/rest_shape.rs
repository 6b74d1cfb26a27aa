//! Rest-shape compensation of a project.

use crate::fabric::Fabric;
use crate::project::Project;
use crate::relax::mean_width;
use crate::written::sample;
use anyhow::Result;
use sim_core::RestShape;
use std::sync::Arc;
use stitch_mesh::edge_counts::StitchSize;
use stitch_mesh::stitch_mesh::StitchMesh;

/// Lays the yarn with loops as they are in a relaxed sample of a pattern, or as drawn.
pub(super) fn compensate(project: &mut Project, text: Option<&str>) -> Result<()> {
    let knitted = project.knitted()?;
    let (stitches, woven) = ((*knitted.stitches).clone(), knitted.woven.clone());
    let shape = match text {
        None => None,
        Some(text) => {
            let sample = sample(text, mean_size(&stitches))?;
            Some(Arc::new(RestShape::relax(&sample, &project.materials, &mut |_| {})?))
        }
    };
    project.fabric = Some(Fabric::laid(stitches, shape, woven));
    Ok(())
}

/// Mean size of a stitch.
pub(crate) fn mean_size(stitches: &StitchMesh) -> StitchSize {
    let mesh = stitches.mesh();
    let area: f64 = mesh.faces().map(|f| mesh.face_area_vector(f).length()).sum();
    let width = mean_width(stitches);
    StitchSize { width, height: area / mesh.face_count() as f64 / width }
}
