//! Woven cloth as a project of its own.

use crate::fabric::Fabric;
use crate::project::Project;
use anyhow::Result;
use sim_core::Material;
use std::sync::Arc;
use stitch_mesh::edge_counts::StitchSize;
use stitch_mesh::mesh::PolygonMesh;
use stitch_mesh::stitch_mesh::StitchMesh;
use stitch_mesh::weave::Woven;

/// A project of one woven piece, with yarn as thick as its spacing asks for. Its input mesh is the outline of the piece.
///
/// # Errors
/// A piece that cannot be woven.
pub fn cloth(piece: Woven) -> Result<Project> {
    piece.check()?;
    // The width of a loop whose yarn would be as thick.
    let width = piece.radius() / Material::for_loop_width(1.0).drawn_radius;
    let outline = PolygonMesh::new(piece.corners().to_vec(), &[vec![0, 1, 2, 3]])?;
    let mut project = Project::new(outline, StitchSize::of_width(width));
    project.fabric = Some(Fabric::laid(StitchMesh::empty(), None, Arc::new(vec![piece])));
    Ok(project)
}
