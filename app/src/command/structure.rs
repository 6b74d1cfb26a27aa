//! Commands that change the faces of the stitch mesh. What came through keeps its yarn where it is.

use super::pins;
use crate::project::Project;
use crate::written::{extent, swatch, tiled};
use anyhow::Result;
use patterns::tile::Layout;
use stitch_mesh::edit::{Edited, End, Survivors, Way};
use stitch_mesh::ids::{FaceId, VertexId};
use stitch_mesh::stitch_mesh::StitchMesh;

/// Edits the faces and lays the yarn again.
fn reshape(
    project: &mut Project,
    edit: impl FnOnce(&StitchMesh) -> Result<Edited>,
) -> Result<Option<Survivors>> {
    let before = project.clone();
    let from = before.knitted()?;
    let (stitches, survivors) = edit(&from.stitches)?;
    let fabric = from.edited(stitches);
    let was = survivors.faces_before();
    let old_face = |f: FaceId| was.get(f.index()).copied().flatten();
    pins::keep(&mut project.scene, from, &fabric, old_face);
    project.fabric = Some(fabric);
    project.keep_yarn_of(&before, Some(&was));
    Ok(Some(survivors))
}

pub(super) fn split_course(project: &mut Project, edge: [u32; 2]) -> Result<Option<Survivors>> {
    reshape(project, |s| Ok(s.split_course(edge.map(VertexId))?))
}

pub(super) fn collapse_course(project: &mut Project, edge: [u32; 2]) -> Result<Option<Survivors>> {
    reshape(project, |s| Ok(s.collapse_course(edge.map(VertexId))?))
}

pub(super) fn add_wale(project: &mut Project, face: u32, edge: [u32; 2]) -> Result<Option<Survivors>> {
    reshape(project, |s| Ok(s.add_wale(FaceId(face), edge.map(VertexId))?))
}

pub(super) fn remove_wale(project: &mut Project, edge: [u32; 2]) -> Result<Option<Survivors>> {
    reshape(project, |s| Ok(s.remove_wale(edge.map(VertexId))?))
}

pub(super) fn shift_wale(
    project: &mut Project,
    edge: [u32; 2],
    end: End,
    to: Way,
) -> Result<Option<Survivors>> {
    reshape(project, |s| Ok(s.shift_wale(edge.map(VertexId), end, to)?))
}

pub(super) fn tile(
    project: &mut Project,
    text: &str,
    rows: Option<[usize; 2]>,
    faces: Option<&[u32]>,
    layout: Layout,
) -> Result<Option<Survivors>> {
    let tiled = tiled(project, text, rows, faces, layout)?;
    reshape(project, |_| Ok((tiled.stitches, tiled.survivors)))
}

pub(super) fn import(
    project: &mut Project,
    text: &str,
    cast_on: Option<usize>,
    repeats: Option<[usize; 2]>,
) -> Result<()> {
    let (width, high) = extent(cast_on, repeats);
    *project = swatch(text, width, high)?.0;
    Ok(())
}
