//! Yarn that is cut and loops that are dropped.

use super::check_face;
use crate::project::Project;
use anyhow::{Context, Result};
use sim_core::Operation;
use std::ops::Range;
use stitch_mesh::ids::{FaceId, VisitId};

/// Cuts the yarn in the middle of the loops that some stitches have made.
pub(super) fn cut(project: &mut Project, faces: &[u32]) -> Result<()> {
    each_loop(project, faces, |head| Operation::Cut(VisitId((head.start + head.end - 1) / 2)))
}

/// Cuts the yarn between a visit and the next one.
pub(super) fn cut_at(project: &mut Project, visit: u32) -> Result<()> {
    let mut fabric = project.fabric()?.clone();
    project.scene.follow(&fabric.operate(Operation::Cut(VisitId(visit)))?);
    project.fabric = Some(fabric);
    Ok(())
}

/// Takes what holds the loops of some stitches out of them.
pub(super) fn drop(project: &mut Project, faces: &[u32]) -> Result<()> {
    each_loop(project, faces, |head| Operation::Release(head.map(VisitId).collect()))
}

/// Does something to the heads of the loops on the tops of faces, one after the other.
fn each_loop(
    project: &mut Project,
    faces: &[u32],
    operation: impl Fn(Range<u32>) -> Operation,
) -> Result<()> {
    let mut fabric = project.knitted()?.clone();
    for &face in faces {
        let mesh = fabric.stitches.mesh();
        check_face(face, mesh.face_count())?;
        let of_face =
            |l: &&stitch_mesh::yarn_net::Loop| mesh.face(l.top) == FaceId(face) && !l.head.is_empty();
        let made = fabric.net().loops.iter().find(of_face);
        let head =
            made.with_context(|| format!("stitch {face} has no loop that anything holds"))?.head.clone();
        project.scene.follow(&fabric.operate(operation(head))?);
    }
    project.fabric = Some(fabric);
    Ok(())
}
