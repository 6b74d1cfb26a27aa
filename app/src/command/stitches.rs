//! Commands on stitches and on what is marked on their edges: ids stay, the yarn is laid again, and whatever did not change
//! keeps its place.

use super::{check_face, pins};
use crate::project::Project;
use crate::written::rows_between;
use anyhow::{Context, Result};
use patterns::chart::Chart;
use stitch_mesh::cable::Cable;
use stitch_mesh::dye::Dye;
use stitch_mesh::ids::{FaceId, VertexId};
use stitch_mesh::patch::Patch;
use stitch_mesh::seam::Seam;
use stitch_mesh::stitch::Stitch;
use stitch_mesh::stitch_mesh::StitchMesh;
use stitch_mesh::wrapping::Wrapping;

/// Changes stitches and lays the yarn again.
pub(super) fn restitch(
    project: &mut Project,
    change: impl FnOnce(&mut StitchMesh) -> Result<()>,
) -> Result<()> {
    let before = project.clone();
    let old = before.knitted()?;
    let mut stitches = (*old.stitches).clone();
    change(&mut stitches)?;
    if stitches.is_as(&old.stitches) {
        return Ok(());
    }
    let fabric = old.edited(stitches);
    pins::keep(&mut project.scene, old, &fabric, Some);
    project.fabric = Some(fabric);
    project.keep_yarn_of(&before, None);
    Ok(())
}

fn ends([a, b]: [u32; 2]) -> [VertexId; 2] {
    [VertexId(a), VertexId(b)]
}

fn vertices(list: &[u32]) -> Vec<VertexId> {
    list.iter().copied().map(VertexId).collect()
}

/// Face ids of a list of numbers.
fn faces(stitches: &StitchMesh, list: &[u32]) -> Result<Vec<FaceId>> {
    let count = stitches.mesh().face_count();
    list.iter().map(|f| check_face(*f, count).map(|()| FaceId(*f))).collect()
}

pub(super) fn set_stitch(project: &mut Project, list: &[u32], stitch: &Stitch) -> Result<()> {
    restitch(project, |stitches| {
        faces(stitches, list)?.into_iter().try_for_each(|f| Ok(stitches.set_stitch(f, stitch.clone())?))
    })
}

pub(super) fn set_chart(
    project: &mut Project,
    chart: &[String],
    rows: Option<[usize; 2]>,
    selected: Option<&[u32]>,
) -> Result<()> {
    let chart: Chart = chart.join("\n").parse()?;
    restitch(project, |stitches| {
        let set = match selected {
            None => {
                let rows = rows.map_or_else(|| Ok(stitches.rows()), |rows| rows_between(stitches, rows))?;
                chart.over(stitches, &rows)
            }
            Some(list) => {
                let mut chosen = faces(stitches, list)?;
                if let Some(rows) = rows {
                    let within: std::collections::HashSet<FaceId> =
                        rows_between(stitches, rows)?.into_iter().flat_map(|r| r.faces).collect();
                    chosen.retain(|f| within.contains(f));
                }
                chart.over_faces(stitches, &chosen)
            }
        };
        set.into_iter().try_for_each(|(face, stitch)| Ok(stitches.set_stitch(face, stitch)?))
    })
}

pub(super) fn fill_region(project: &mut Project, face: u32, stitch: &Stitch) -> Result<()> {
    restitch(project, |stitches| {
        check_face(face, stitches.mesh().face_count())?;
        let region = stitches.region(FaceId(face));
        region.into_iter().try_for_each(|f| Ok(stitches.set_stitch(f, stitch.clone())?))
    })
}

pub(super) fn paste(project: &mut Project, at: u32, patch: &Patch) -> Result<()> {
    restitch(project, |stitches| {
        check_face(at, stitches.mesh().face_count())?;
        Ok(patch.paste(stitches, FaceId(at))?)
    })
}

pub(super) fn set_cable(project: &mut Project, cable: &Cable) -> Result<()> {
    restitch(project, |stitches| Ok(stitches.set_cable(cable.clone())?))
}

pub(super) fn clear_cables(project: &mut Project, edges: &[[u32; 2]]) -> Result<()> {
    let edges: Vec<[VertexId; 2]> = edges.iter().copied().map(ends).collect();
    restitch(project, |stitches| {
        let cleared = stitches.clear_cables(&edges);
        (cleared > 0).then_some(()).context("there is no cable on these edges")
    })
}

pub(super) fn set_live(project: &mut Project, edges: &[[u32; 2]], live: bool) -> Result<()> {
    restitch(project, |stitches| edges.iter().try_for_each(|e| Ok(stitches.set_live(ends(*e), live)?)))
}

pub(super) fn set_spiral(project: &mut Project, spiral: bool) -> Result<()> {
    restitch(project, |stitches| {
        stitches.set_spiral(spiral);
        Ok(())
    })
}

pub(super) fn sew(project: &mut Project, a: &[u32], b: &[u32]) -> Result<()> {
    restitch(project, |stitches| {
        let seam = Seam::between(stitches.mesh(), &vertices(a), &vertices(b))?;
        Ok(stitches.sew(seam)?)
    })
}

pub(super) fn unsew(project: &mut Project, edges: &[[u32; 2]]) -> Result<()> {
    let edges: Vec<[VertexId; 2]> = edges.iter().copied().map(ends).collect();
    restitch(project, |stitches| {
        let undone = stitches.unsew(&edges);
        (undone > 0).then_some(()).context("there is no seam on these edges")
    })
}

pub(super) fn dye(project: &mut Project, list: &[u32], color: Dye) -> Result<()> {
    restitch(project, |stitches| {
        faces(stitches, list)?.into_iter().try_for_each(|f| Ok(stitches.set_dye(f, color)?))
    })
}

pub(super) fn dye_rows(project: &mut Project, rows: [usize; 2], color: Dye) -> Result<()> {
    restitch(project, |stitches| {
        let mut faces = rows_between(stitches, rows)?.into_iter().flat_map(|r| r.faces);
        faces.try_for_each(|f| Ok(stitches.set_dye(f, color)?))
    })
}

pub(super) fn wrap(
    project: &mut Project,
    list: &[u32],
    modulus: Option<f64>,
    angle_deg: Option<f64>,
) -> Result<()> {
    let wrapping = Wrapping { modulus: modulus.unwrap_or(1.0), angle: angle_deg.map(f64::to_radians) };
    restitch(project, |stitches| {
        faces(stitches, list)?.into_iter().try_for_each(|f| Ok(stitches.set_wrapping(f, wrapping)?))
    })
}
