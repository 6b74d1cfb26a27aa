//! Commands: every change to a project is one of these values.
//!
//! The window makes them from clicks, a script is a file of them (one JSON object a line), the history shows them by name.
//! Edges are named by their two vertices, faces by number, as the window and `inspect` show them, from 0.

use crate::project::{Fabric, Project};
use crate::relax::{mean_width, relax_mesh};
use anyhow::{Context, Result, bail};
use patterns::chart::Chart;
use serde::{Deserialize, Serialize};
use sim_core::mesh_relax::RelaxParams;
use sim_core::{Material, Scene};
use std::ops::ControlFlow;
use std::sync::Arc;
use stitch_mesh::autolabel::{autolabel, grow};
use stitch_mesh::edge_counts::{EdgeCounts, StitchSize};
use stitch_mesh::ids::{EdgeId, FaceId, VertexId};
use stitch_mesh::label::{EdgeLabel, LabelledMesh};
use stitch_mesh::stitch::Stitch;
use stitch_mesh::stitch_mesh::StitchMesh;
use stitch_mesh::tessellate::tessellate;

/// One change to a project.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "do", rename_all = "snake_case", deny_unknown_fields)]
pub enum Command {
    /// Labels the row on a border.
    FillFromBorder {
        /// An edge of the border.
        edge: [u32; 2],
    },
    /// Labels the row beyond a course edge.
    FillFromCourse {
        /// The course edge.
        edge: [u32; 2],
    },
    /// Labels the row on a border or beyond a course edge, and all rows that can be reached from there.
    FillOnwards {
        /// The edge.
        edge: [u32; 2],
    },
    /// Labels one edge by hand, or takes its label away.
    LabelEdge {
        /// The edge.
        edge: [u32; 2],
        /// Its label.
        label: Option<EdgeLabel>,
    },
    /// Turns the wale direction of a row.
    FlipRow {
        /// A face of the row.
        face: u32,
    },
    /// Labels whatever can be labelled without asking.
    Autolabel,
    /// Takes all labels away.
    ClearLabels,
    /// Cuts the labelled mesh into stitches.
    Tessellate {
        /// Width of a stitch [mm].
        width_mm: f64,
    },
    /// Sets the stitch of some faces.
    SetStitch {
        /// The faces.
        faces: Vec<u32>,
        /// Their stitch.
        stitch: Stitch,
    },
    /// Repeats a chart over all rows, or over some.
    SetChart {
        /// Lines of the chart, the lowest row first, as in `["k k p p"]`.
        chart: Vec<String>,
        /// First and last row, from 0; all rows if absent.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        rows: Option<[usize; 2]>,
    },
    /// Changes the yarn.
    SetMaterial {
        /// All its parameters.
        material: Material,
    },
    /// Changes what surrounds the fabric.
    SetScene {
        /// All of it.
        scene: Scene,
    },
    /// Puts the yarn back to where it was laid.
    ResetYarn,
    /// Makes the stitches as even as they can be, and lays the yarn again.
    RelaxMesh {
        /// Height of a stitch over its width at rest.
        #[serde(default = "default_aspect")]
        aspect: f64,
        /// How much of the surface the stitches fill at rest, above 0 and at most 1.
        #[serde(default = "default_fill")]
        fill: f64,
        /// Whether they stay on the smooth surface of the input mesh, or find a shape of their own.
        #[serde(default = "default_surface")]
        surface: bool,
    },
}

fn default_aspect() -> f64 {
    RelaxParams::default().aspect
}

fn default_fill() -> f64 {
    RelaxParams::default().fill
}

fn default_surface() -> bool {
    true
}

impl Command {
    /// Its name in the history.
    pub fn name(&self) -> String {
        match self {
            Self::FillFromBorder { .. } => "Fill row from border".into(),
            Self::FillFromCourse { .. } => "Fill next row".into(),
            Self::FillOnwards { .. } => "Fill rows onwards".into(),
            Self::LabelEdge { label: Some(EdgeLabel::Course), .. } => "Label edge course".into(),
            Self::LabelEdge { label: Some(EdgeLabel::Wale), .. } => "Label edge wale".into(),
            Self::LabelEdge { label: None, .. } => "Clear edge label".into(),
            Self::FlipRow { .. } => "Flip row".into(),
            Self::Autolabel => "Label automatically".into(),
            Self::ClearLabels => "Clear labels".into(),
            Self::Tessellate { width_mm } => format!("Tessellate at {width_mm} mm"),
            Self::SetStitch { faces, stitch } if faces.len() == 1 => format!("Set 1 stitch to {stitch}"),
            Self::SetStitch { faces, stitch } => format!("Set {} stitches to {stitch}", faces.len()),
            Self::SetChart { chart, .. } => format!("Repeat {}", chart.join(" / ")),
            Self::SetMaterial { .. } => "Change yarn".into(),
            Self::SetScene { .. } => "Change scene".into(),
            Self::ResetYarn => "Lay yarn anew".into(),
            Self::RelaxMesh { surface: true, .. } => "Relax stitches".into(),
            Self::RelaxMesh { surface: false, .. } => "Relax stitches freely".into(),
        }
    }

    /// The project after this command.
    ///
    /// # Errors
    /// Why it cannot be done; nothing has changed then.
    pub fn apply(&self, project: &Project) -> Result<Project> {
        let mut after = project.clone();
        match self {
            Self::FillFromBorder { edge } => relabel(&mut after, |l| {
                l.fill_from_border(find_edge(l, *edge)?).with_context(|| at(*edge))?;
                Ok(())
            })?,
            Self::FillFromCourse { edge } => relabel(&mut after, |l| {
                l.fill_from_course(find_edge(l, *edge)?).with_context(|| at(*edge))?;
                Ok(())
            })?,
            Self::FillOnwards { edge } => relabel(&mut after, |l| {
                let id = find_edge(l, *edge)?;
                let row = match l.label(id) {
                    Some(EdgeLabel::Course) => l.fill_from_course(id),
                    _ => l.fill_from_border(id),
                };
                row.with_context(|| at(*edge))?;
                grow(l);
                Ok(())
            })?,
            Self::LabelEdge { edge, label } => relabel(&mut after, |l| {
                l.set_label(find_edge(l, *edge)?, *label);
                Ok(())
            })?,
            Self::FlipRow { face } => relabel(&mut after, |l| {
                check_face(*face, l.mesh().face_count())?;
                Ok(l.flip_row(FaceId(*face))?)
            })?,
            Self::Autolabel => relabel(&mut after, |l| {
                *l = autolabel(l);
                Ok(())
            })?,
            Self::ClearLabels => relabel(&mut after, |l| {
                *l = LabelledMesh::new(l.mesh().clone());
                Ok(())
            })?,
            Self::Tessellate { width_mm } => {
                let size = StitchSize::of_width(width_mm * 1e-3);
                let counts = EdgeCounts::from_size(&after.labelled, size)?;
                let stitches = tessellate(&after.labelled, &counts)?;
                if after.fabric.is_none() || after.size != size {
                    // Yarn as thick as the stitches came out: on short edges they are narrower than was asked for.
                    after.material = Material::for_loop_width(mean_width(&stitches));
                }
                after.size = size;
                after.scene.pins.clear();
                after.fabric = Some(Fabric::new(stitches));
            }
            Self::SetStitch { faces, stitch } => restitch(&mut after, |stitches| {
                faces.iter().try_for_each(|f| {
                    check_face(*f, stitches.mesh().face_count())?;
                    Ok(stitches.set_stitch(FaceId(*f), stitch.clone())?)
                })
            })?,
            Self::SetChart { chart, rows } => {
                let chart: Chart = chart.join("\n").parse()?;
                restitch(&mut after, |stitches| {
                    let all = stitches.rows();
                    let [first, last] = rows.unwrap_or([0, all.len() - 1]);
                    let chosen = all.get(first..=last).filter(|r| !r.is_empty()).with_context(|| {
                        format!("there are no rows {first}–{last}: the fabric has rows 0–{}", all.len() - 1)
                    })?;
                    for (face, stitch) in chart.over(stitches, chosen) {
                        stitches.set_stitch(face, stitch)?;
                    }
                    Ok(())
                })?;
            }
            Self::SetMaterial { material } => {
                material.validate()?;
                after.material = material.clone();
            }
            Self::SetScene { scene } => {
                scene.validate(after.fabric.as_ref().map_or(0, |f| f.net.nodes.len()))?;
                after.scene = scene.clone();
            }
            Self::ResetYarn => {
                if let Some(fabric) = &mut after.fabric {
                    fabric.state = None;
                    fabric.facts = None;
                }
            }
            Self::RelaxMesh { aspect, fill, surface } => {
                let params = RelaxParams { aspect: *aspect, fill: *fill, ..RelaxParams::default() };
                after = relax_mesh(project, params, *surface, &mut |_, _| ControlFlow::Continue(()))?;
            }
        }
        Ok(after)
    }
}

/// Changes labels. The fabric stays until it is tessellated anew, as it was made from labels that were complete.
fn relabel(project: &mut Project, change: impl FnOnce(&mut LabelledMesh) -> Result<()>) -> Result<()> {
    change(Arc::make_mut(&mut project.labelled))
}

/// Changes stitches and lays the yarn again; whatever did not change keeps its place.
fn restitch(project: &mut Project, change: impl FnOnce(&mut StitchMesh) -> Result<()>) -> Result<()> {
    let before = project.clone();
    let mut stitches = (*before.fabric()?.stitches).clone();
    change(&mut stitches)?;
    project.fabric = Some(Fabric::new(stitches));
    project.keep_yarn_of(&before);
    Ok(())
}

fn at([a, b]: [u32; 2]) -> String {
    format!("edge {a}–{b}")
}

fn find_edge(labelled: &LabelledMesh, [a, b]: [u32; 2]) -> Result<EdgeId> {
    let mesh = labelled.mesh();
    mesh.edge_between(VertexId(a), VertexId(b)).with_context(|| format!("there is no edge {a}–{b}"))
}

fn check_face(face: u32, count: usize) -> Result<()> {
    if face as usize >= count {
        bail!("there is no face {face}: the faces are 0–{}", count - 1);
    }
    Ok(())
}

/// Reads a script: one command a line, as JSON; empty lines and lines that begin with `#` are passed over. Each command comes
/// with the number of its line, from 1.
///
/// # Errors
/// The line that is not a command.
pub fn read_script(text: &str) -> Result<Vec<(usize, Command)>> {
    let lines = text.lines().enumerate().filter(|(_, l)| !l.trim().is_empty() && !l.trim().starts_with('#'));
    lines
        .map(|(number, line)| {
            let command =
                serde_json::from_str(line).with_context(|| format!("line {}: not a command", number + 1))?;
            Ok((number + 1, command))
        })
        .collect()
}

/// Writes a script that [`read_script`] reads.
///
/// # Errors
/// A command with a number that JSON cannot hold.
pub fn write_script<'a>(commands: impl IntoIterator<Item = &'a Command>) -> Result<String> {
    let mut text = String::new();
    for command in commands {
        text.push_str(&serde_json::to_string(command)?);
        text.push('\n');
    }
    Ok(text)
}
