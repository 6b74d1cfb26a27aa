//! Commands on the labels of the input mesh. The fabric stays until it is tessellated anew, as it was made from labels that
//! were complete.

use super::{check_face, find_edge};
use crate::project::Project;
use anyhow::{Context, Result};
use std::sync::Arc;
use stitch_mesh::autolabel::{autolabel, grow};
use stitch_mesh::ids::FaceId;
use stitch_mesh::label::{EdgeLabel, LabelledMesh};

fn at([a, b]: [u32; 2]) -> String {
    format!("edge {a}–{b}")
}

fn labels(project: &mut Project) -> &mut LabelledMesh {
    Arc::make_mut(&mut project.labelled)
}

pub(super) fn fill_from_border(project: &mut Project, edge: [u32; 2]) -> Result<()> {
    let labelled = labels(project);
    labelled.fill_from_border(find_edge(labelled.mesh(), edge)?).with_context(|| at(edge))?;
    Ok(())
}

pub(super) fn fill_from_course(project: &mut Project, edge: [u32; 2]) -> Result<()> {
    let labelled = labels(project);
    labelled.fill_from_course(find_edge(labelled.mesh(), edge)?).with_context(|| at(edge))?;
    Ok(())
}

pub(super) fn fill_onwards(project: &mut Project, edge: [u32; 2]) -> Result<()> {
    let labelled = labels(project);
    let id = find_edge(labelled.mesh(), edge)?;
    let row = match labelled.label(id) {
        Some(EdgeLabel::Course) => labelled.fill_from_course(id),
        _ => labelled.fill_from_border(id),
    };
    row.with_context(|| at(edge))?;
    grow(labelled);
    Ok(())
}

pub(super) fn label(project: &mut Project, edges: &[[u32; 2]], label: Option<EdgeLabel>) -> Result<()> {
    let labelled = labels(project);
    for edge in edges {
        let edge = find_edge(labelled.mesh(), *edge)?;
        labelled.set_label(edge, label);
    }
    Ok(())
}

pub(super) fn flip_row(project: &mut Project, face: u32) -> Result<()> {
    let labelled = labels(project);
    check_face(face, labelled.mesh().face_count())?;
    Ok(labelled.flip_row(FaceId(face))?)
}

pub(super) fn label_all(project: &mut Project) {
    project.labelled = Arc::new(autolabel(&project.labelled));
}

pub(super) fn clear(project: &mut Project) {
    project.labelled = Arc::new(LabelledMesh::new(project.labelled.mesh().clone()));
}
