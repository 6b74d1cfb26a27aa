//! Commands: every change to a project is one of these values.
//!
//! The window makes them from clicks, a script is a file of them (one JSON object a line), the history shows them by name.
//! Edges are named by their two vertices, faces by number, as the window and `inspect` show them, from 0: those of the input
//! mesh for labels and counts, those of the stitch mesh for everything after tessellation.

mod cloth;
mod labels;
mod name;
mod pins;
mod rest_shape;
mod script;
mod stitches;
mod structure;
mod surgery;
mod tessellation;
mod yarns;

pub use cloth::Weave;
pub(crate) use rest_shape::mean_size;
pub use script::{read_script, write_script};

use crate::fabric::Fabric;
use crate::project::Project;
use crate::relax::{Watch, relax_mesh, unwatched};
use anyhow::{Context, Result, bail};
use patterns::tile::Layout;
use serde::{Deserialize, Serialize};
use sim_core::mesh_relax::RelaxParams;
use sim_core::{Material, Preset, Scene};
use stitch_mesh::cable::Cable;
use stitch_mesh::dye::Dye;
use stitch_mesh::edit::{End, Survivors, Way};
use stitch_mesh::ids::{EdgeId, VertexId};
use stitch_mesh::label::EdgeLabel;
use stitch_mesh::mesh::PolygonMesh;
use stitch_mesh::patch::Patch;
use stitch_mesh::stitch::Stitch;

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
    /// Labels edges by hand, or takes their labels away.
    LabelEdges {
        /// The edges.
        edges: Vec<[u32; 2]>,
        /// Their label.
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
    /// Cuts the labelled mesh into stitches. Stitches in the same place of the input keep their type, colour and marks.
    Tessellate {
        /// Width of a stitch [mm], from which all edges are counted anew; as they are counted now if absent.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        width_mm: Option<f64>,
    },
    /// Changes how many stitches or rows go on edges of the input. Takes effect when it is tessellated again.
    SetEdgeCounts {
        /// The edges; a wale edge takes all wale edges of its row with it.
        edges: Vec<[u32; 2]>,
        /// Stitches or rows on each.
        count: u32,
    },
    /// Marks wale edges of the input: increases and decreases beside them all lie along them.
    MarkWale {
        /// The edges.
        edges: Vec<[u32; 2]>,
        /// Whether they are marked.
        marked: bool,
    },
    /// Sets the stitch of some faces.
    SetStitch {
        /// The faces.
        faces: Vec<u32>,
        /// Their stitch.
        stitch: Stitch,
    },
    /// Repeats a chart over all rows, over some, or over a selection of faces, anchored at its lowest stitch on the left.
    SetChart {
        /// Lines of the chart, the lowest row first, as in `["k k p p"]`.
        chart: Vec<String>,
        /// First and last row, from 0; all rows if absent.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        rows: Option<[usize; 2]>,
        /// The selection; all faces of these rows if absent.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        faces: Option<Vec<u32>>,
    },
    /// Sets the stitch of a face and of all faces with the same stitch that can be reached from it over such faces.
    FillRegion {
        /// The face.
        face: u32,
        /// The stitch.
        stitch: Stitch,
    },
    /// Sets a cable.
    SetCable {
        /// Where its loops cross, and how.
        cable: Cable,
    },
    /// Clears the cables that any of these edges lies in.
    ClearCables {
        /// The edges.
        edges: Vec<[u32; 2]>,
    },
    /// Leaves loops at the border live, or has them bound off.
    SetLive {
        /// Their top edges.
        edges: Vec<[u32; 2]>,
        /// Whether they are live.
        live: bool,
    },
    /// Knits closed rows as a spiral, or as rings.
    SetSpiral {
        /// Whether they are a spiral.
        spiral: bool,
    },
    /// Sews two stretches of border together, first vertex to first vertex. Between two vertices that are no neighbours the
    /// seam follows the border, the shorter way; so corners of the input mesh will do.
    Sew {
        /// Vertices along one.
        a: Vec<u32>,
        /// Vertices along the other.
        b: Vec<u32>,
    },
    /// Undoes the seams that any of these edges lies in.
    Unsew {
        /// The edges.
        edges: Vec<[u32; 2]>,
    },
    /// Changes the colour of the yarn with which some stitches are worked.
    Dye {
        /// The faces.
        faces: Vec<u32>,
        /// The colour, `#rrggbb`.
        color: Dye,
    },
    /// Changes the colour of the yarn with which some rows are worked.
    DyeRows {
        /// First and last row, from 0.
        rows: [usize; 2],
        /// The colour, `#rrggbb`.
        color: Dye,
    },
    /// Changes how strongly and at what angle the yarns of some stitches are wrapped around each other.
    SetWrap {
        /// The faces.
        faces: Vec<u32>,
        /// Factor on the modulus of wrapping that their material has; 1 if absent.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        modulus: Option<f64>,
        /// Angle at which wrapped yarns are at rest [°]; that of their material if absent.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        angle_deg: Option<f64>,
    },
    /// Puts a copied patch on the fabric.
    Paste {
        /// The face for its lowest stitch on the left.
        at: u32,
        /// The patch.
        patch: Patch,
    },
    /// Knits a swatch of a written pattern in place of everything.
    Import {
        /// The pattern in KnitSpeak.
        text: String,
        /// Stitches to cast on; as the pattern says, or twice its repeat, if absent.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        cast_on: Option<usize>,
        /// Repeats side by side and above each other, instead.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        repeats: Option<[usize; 2]>,
    },
    /// Repeats a written pattern over the fabric.
    Tile {
        /// The pattern in KnitSpeak.
        text: String,
        /// First and last row, from 0; all rows if absent.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        rows: Option<[usize; 2]>,
        /// The faces; all of these rows if absent.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        faces: Option<Vec<u32>>,
        /// How repeats lie beside each other.
        #[serde(default)]
        layout: Layout,
    },
    /// Splits a course edge: one more loop for the stitch below and the stitch above.
    SplitCourse {
        /// The edge.
        edge: [u32; 2],
    },
    /// Collapses a course edge: one loop less for the stitch below and the stitch above.
    CollapseCourse {
        /// The edge.
        edge: [u32; 2],
    },
    /// Divides a stitch by a new wale edge.
    AddWale {
        /// The stitch.
        face: u32,
        /// The vertex below it and the one above it that the new edge joins.
        edge: [u32; 2],
    },
    /// Removes a wale edge, so that the stitches on both sides are worked together.
    RemoveWale {
        /// The edge.
        edge: [u32; 2],
    },
    /// Moves an end of a wale edge along its row by one course edge, which changes hands.
    ShiftWale {
        /// The edge.
        edge: [u32; 2],
        /// Which end.
        end: End,
        /// Where to.
        to: Way,
    },
    /// Weaves a piece of cloth and puts it beside what is there.
    Weave(Weave),
    /// Changes the material of the yarn, or of yarn of one colour.
    SetMaterial {
        /// The colour, `#rrggbb`; all yarn that has no material of its own if absent.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        color: Option<Dye>,
        /// All its parameters.
        material: Material,
    },
    /// Takes a material by name, as it is for stitches of this size.
    UsePreset {
        /// The colour, `#rrggbb`; all yarn that has no material of its own if absent.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        color: Option<Dye>,
        /// The name.
        preset: Preset,
    },
    /// Makes yarn of one colour like the rest again.
    ClearMaterial {
        /// The colour, `#rrggbb`.
        color: Dye,
    },
    /// Changes what surrounds the fabric.
    SetScene {
        /// All of it.
        scene: Scene,
    },
    /// Holds some stitches where they are, by a spring at each node.
    Hold {
        /// The faces.
        faces: Vec<u32>,
    },
    /// Lets go of everything that is held.
    LetGo,
    /// Cuts the yarn in the middle of the loops of some stitches.
    CutYarn {
        /// The faces.
        faces: Vec<u32>,
    },
    /// Cuts the yarn between two visits.
    CutYarnAt {
        /// The first of them, as the yarn is numbered now.
        visit: u32,
    },
    /// Lets the loops of some stitches slip off what holds them, so that they may run.
    DropLoops {
        /// The faces.
        faces: Vec<u32>,
    },
    /// Puts the yarn back to where it was laid, and mends what was cut.
    ResetYarn,
    /// Lays the yarn anew with loops of the shape that a pattern has when it is relaxed, so that the fabric keeps its size.
    Compensate {
        /// The pattern in KnitSpeak; as it is drawn if absent.
        text: Option<String>,
    },
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
    /// The project after this command.
    ///
    /// # Errors
    /// Why it cannot be done; nothing has changed then.
    pub fn apply(&self, project: &Project) -> Result<Project> {
        Ok(self.perform(project, &mut unwatched)?.0)
    }

    /// The project after this command, and which faces and vertices came through it when it has changed the faces of the stitch
    /// mesh. `watch` sees stitches that are being relaxed, and may break off.
    pub(crate) fn perform(
        &self,
        project: &Project,
        watch: Watch<'_>,
    ) -> Result<(Project, Option<Survivors>)> {
        let mut after = project.clone();
        let mut survivors = None;
        let project = &mut after;
        match self {
            Self::FillFromBorder { edge } => labels::fill_from_border(project, *edge)?,
            Self::FillFromCourse { edge } => labels::fill_from_course(project, *edge)?,
            Self::FillOnwards { edge } => labels::fill_onwards(project, *edge)?,
            Self::LabelEdges { edges, label } => labels::label(project, edges, *label)?,
            Self::FlipRow { face } => labels::flip_row(project, *face)?,
            Self::Autolabel => labels::label_all(project),
            Self::ClearLabels => labels::clear(project),
            Self::Tessellate { width_mm } => tessellation::tessellate(project, *width_mm)?,
            Self::SetEdgeCounts { edges, count } => tessellation::set_counts(project, edges, *count)?,
            Self::MarkWale { edges, marked } => tessellation::mark(project, edges, *marked)?,
            Self::SetStitch { faces, stitch } => stitches::set_stitch(project, faces, stitch)?,
            Self::SetChart { chart, rows, faces } => {
                stitches::set_chart(project, chart, *rows, faces.as_deref())?;
            }
            Self::FillRegion { face, stitch } => stitches::fill_region(project, *face, stitch)?,
            Self::SetCable { cable } => stitches::set_cable(project, cable)?,
            Self::ClearCables { edges } => stitches::clear_cables(project, edges)?,
            Self::SetLive { edges, live } => stitches::set_live(project, edges, *live)?,
            Self::SetSpiral { spiral } => stitches::set_spiral(project, *spiral)?,
            Self::Sew { a, b } => stitches::sew(project, a, b)?,
            Self::Unsew { edges } => stitches::unsew(project, edges)?,
            Self::Dye { faces, color } => stitches::dye(project, faces, *color)?,
            Self::DyeRows { rows, color } => stitches::dye_rows(project, *rows, *color)?,
            Self::SetWrap { faces, modulus, angle_deg } => {
                stitches::wrap(project, faces, *modulus, *angle_deg)?;
            }
            Self::Paste { at, patch } => stitches::paste(project, *at, patch)?,
            Self::Import { text, cast_on, repeats } => structure::import(project, text, *cast_on, *repeats)?,
            Self::Tile { text, rows, faces, layout } => {
                survivors = structure::tile(project, text, *rows, faces.as_deref(), *layout)?;
            }
            Self::SplitCourse { edge } => survivors = structure::split_course(project, *edge)?,
            Self::CollapseCourse { edge } => survivors = structure::collapse_course(project, *edge)?,
            Self::AddWale { face, edge } => survivors = structure::add_wale(project, *face, *edge)?,
            Self::RemoveWale { edge } => survivors = structure::remove_wale(project, *edge)?,
            Self::ShiftWale { edge, end, to } => {
                survivors = structure::shift_wale(project, *edge, *end, *to)?;
            }
            Self::Weave(piece) => piece.perform(project)?,
            Self::SetMaterial { color, material } => yarns::set(project, *color, material.clone())?,
            Self::UsePreset { color, preset } => yarns::use_preset(project, *color, *preset)?,
            Self::ClearMaterial { color } => yarns::clear(project, *color)?,
            Self::SetScene { scene } => {
                scene.validate(project.fabric.as_ref().map_or(0, |f| f.net().nodes.len()))?;
                project.scene = scene.clone();
            }
            Self::Hold { faces } => pins::hold(project, faces)?,
            Self::LetGo => project.scene.let_go(),
            Self::ResetYarn => {
                project.fabric = project.fabric.as_ref().map(Fabric::laid_anew);
            }
            Self::CutYarn { faces } => surgery::cut(project, faces)?,
            Self::CutYarnAt { visit } => surgery::cut_at(project, *visit)?,
            Self::DropLoops { faces } => surgery::drop(project, faces)?,
            Self::Compensate { text } => rest_shape::compensate(project, text.as_deref())?,
            Self::RelaxMesh { aspect, fill, surface } => {
                let params = RelaxParams { aspect: *aspect, fill: *fill, ..RelaxParams::default() };
                *project = relax_mesh(project, params, *surface, watch)?;
            }
        }
        Ok((after, survivors))
    }
}

fn find_edge(mesh: &PolygonMesh, [a, b]: [u32; 2]) -> Result<EdgeId> {
    mesh.edge_between(VertexId(a), VertexId(b)).with_context(|| format!("there is no edge {a}–{b}"))
}

fn check_face(face: u32, count: usize) -> Result<()> {
    if face as usize >= count {
        bail!("there is no face {face}: the faces are 0–{}", count - 1);
    }
    Ok(())
}
