//! Pictures of a project, stage by stage: what the renderer is given.

use crate::project::Project;
use crate::solids::solids;
use anyhow::Result;
use glam::DVec3;
use rayon::prelude::*;
use render::palette::{self, StitchColors};
use render::{Drawing, Faces, Lines, Polygon, Segment};
use sim_core::curves;
use smallvec::SmallVec;
use std::collections::HashMap;
use stitch_mesh::cable::Cable;
use stitch_mesh::dye::Dye;
use stitch_mesh::ids::{EdgeId, FaceId, VertexId};
use stitch_mesh::label::{EdgeLabel, LabelledMesh, Row};
use stitch_mesh::mesh::PolygonMesh;
use stitch_mesh::stitch::Stitch;
use stitch_mesh::stitch_mesh::StitchMesh;

/// What to show of a project.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, clap::ValueEnum)]
pub enum Stage {
    /// The input mesh.
    Mesh,
    /// Its rows and labels.
    Labels,
    /// The stitch mesh.
    Stitches,
    /// The yarn.
    Yarn,
}

impl Stage {
    /// All stages, in the order of the flow.
    pub const ALL: [Self; 4] = [Self::Mesh, Self::Labels, Self::Stitches, Self::Yarn];
}

/// Faces or edges that are drawn by one thread.
const PIECE: usize = 4096;

/// Which faces show.
pub type Shown<'a> = &'a (dyn Fn(FaceId) -> bool + Sync);

/// The picture of one stage.
///
/// # Errors
/// The stage has not been reached yet.
pub fn drawing(project: &Project, stage: Stage) -> Result<Drawing> {
    drawing_where(project, stage, &|_| true, StitchColors::default())
}

/// The picture of one stage, without the faces that are not `shown` (of a mesh; yarn passes from face to face). They have a
/// polygon without corners, so that polygons keep the numbers of their faces.
///
/// # Errors
/// As [`drawing`].
pub fn drawing_where(
    project: &Project,
    stage: Stage,
    shown: Shown<'_>,
    colors: StitchColors,
) -> Result<Drawing> {
    let labelled = &project.labelled;
    Ok(match stage {
        Stage::Mesh => mesh_drawing(labelled.mesh(), shown),
        Stage::Labels => label_drawing(labelled, shown),
        Stage::Stitches => {
            let stitches = &project.fabric()?.stitches;
            stitch_drawing(stitches, &stitches.rows(), shown, colors)
        }
        Stage::Yarn => {
            let fabric = project.fabric()?;
            let yarn = curves(fabric.net(), &fabric.state(), &project.materials);
            // The bodies are where the simulation has left them.
            let time_s = fabric.facts.as_ref().map_or(0.0, |f| f.time_s);
            Drawing { yarn, solids: solids(&project.scene, time_s), ..Drawing::default() }
        }
    })
}

/// The polygons of a mesh, coloured face by face.
fn faces(mesh: &PolygonMesh, shown: Shown<'_>, color: impl Fn(usize) -> [f32; 3] + Sync) -> Faces {
    let mut faces = Faces::default();
    draw_faces(&mut faces, mesh, shown, color);
    faces
}

fn draw_faces(
    faces: &mut Faces,
    mesh: &PolygonMesh,
    shown: Shown<'_>,
    color: impl Fn(usize) -> [f32; 3] + Sync,
) {
    let polygon = |f: usize| {
        let face = FaceId::new(f);
        let vertices =
            if shown(face) { mesh.face_vertices(face).map(|v| v.0).collect() } else { SmallVec::new() };
        Polygon { vertices, color: color(f) }
    };
    let positions = mesh.positions().par_iter().with_min_len(PIECE);
    positions.map(|p| p.as_vec3()).collect_into_vec(&mut faces.positions);
    let polygons = (0..mesh.face_count()).into_par_iter().with_min_len(PIECE);
    polygons.map(polygon).collect_into_vec(&mut faces.polygons);
}

/// The edge as a line on the screen.
pub fn edge_line(mesh: &PolygonMesh, edge: EdgeId, color: [f32; 3], width: f32) -> Segment {
    Segment { ends: mesh.edge_ends(edge).map(|v| mesh.position(v).as_vec3()), color, width }
}

/// Edges of which a face shows.
fn shown_edges(mesh: &PolygonMesh, shown: Shown<'_>) -> impl Iterator<Item = EdgeId> {
    mesh.edges().filter(move |e| {
        let (first, second) = mesh.edge_sides(*e);
        [Some(first), second].into_iter().flatten().any(|h| shown(mesh.face(h)))
    })
}

fn mesh_drawing(mesh: &PolygonMesh, shown: Shown<'_>) -> Drawing {
    let lines = shown_edges(mesh, shown).map(|e| edge_line(mesh, e, palette::UNLABELLED_EDGE, 1.5));
    Drawing {
        faces: faces(mesh, shown, |_| palette::UNLABELLED_FACE),
        lines: Lines { segments: lines.collect() },
        ..Drawing::default()
    }
}

/// Rows in colours, course edges and wale edges in two more, an arrow up each wale.
fn label_drawing(labelled: &LabelledMesh, shown: Shown<'_>) -> Drawing {
    let mesh = labelled.mesh();
    let mut row_of = vec![None; mesh.face_count()];
    for (r, row) in labelled.rows().iter().enumerate() {
        row.faces.iter().for_each(|f| row_of[f.index()] = Some(r));
    }
    let mut segments: Vec<Segment> = shown_edges(mesh, shown)
        .map(|e| match labelled.label(e) {
            Some(EdgeLabel::Course) => edge_line(mesh, e, palette::COURSE_EDGE, 3.0),
            Some(EdgeLabel::Wale) => edge_line(mesh, e, palette::WALE_EDGE, 2.0),
            None => edge_line(mesh, e, palette::UNLABELLED_EDGE, 1.5),
        })
        .collect();
    for face in mesh.faces().filter(|f| shown(*f)) {
        let Some(wales) = labelled.wales(face) else { continue };
        let middle = |h| (mesh.position(mesh.origin(h)) + mesh.position(mesh.tip(h))) / 2.0;
        let mean = |points: Vec<DVec3>, or: DVec3| match points.len() {
            0 => or,
            n => points.iter().sum::<DVec3>() / n as f64,
        };
        let bottom = mean(
            labelled.bottoms(wales).into_iter().map(middle).collect(),
            mesh.position(mesh.origin(wales.right)),
        );
        let top = mean(
            labelled.tops(wales).into_iter().map(middle).collect(),
            mesh.position(mesh.tip(wales.right)),
        );
        let side = (middle(wales.right) - middle(wales.left)) * 0.12;
        let (from, to) = (bottom.lerp(top, 0.3), bottom.lerp(top, 0.7));
        let barb = bottom.lerp(top, 0.5);
        for [a, b] in [[from, to], [to, barb + side], [to, barb - side]] {
            segments.push(Segment { ends: [a.as_vec3(), b.as_vec3()], color: [0.05; 3], width: 1.5 });
        }
    }
    let color = |f: usize| row_of[f].map_or(palette::UNLABELLED_FACE, palette::row);
    Drawing { faces: faces(mesh, shown, color), lines: Lines { segments }, ..Drawing::default() }
}

/// Colours of the faces of a stitch mesh with these rows, [face_count]: by kind or yarn, odd rows darker.
pub fn stitch_colors(stitches: &StitchMesh, rows: &[Row], colors: StitchColors) -> Vec<[f32; 3]> {
    let mut is_odd = vec![false; stitches.mesh().face_count()];
    for row in rows.iter().skip(1).step_by(2) {
        row.faces.iter().for_each(|f| is_odd[f.index()] = true);
    }
    // A fabric has few kinds of stitches and yarns, and mostly several of one beside each other, so their colours are looked up once each.
    type Kind<'a> = (&'a Stitch, Dye);
    let mut known: HashMap<Kind<'_>, [[f32; 3]; 2]> = HashMap::new();
    let mut last: Option<(Kind<'_>, [[f32; 3]; 2])> = None;
    let both = |(stitch, dye): &Kind<'_>| [0, 1].map(|row| colors.of(&stitch.to_string(), dye.linear(), row));
    let kinds = stitches.stitches().iter().zip(stitches.dyes().iter().copied());
    let colors = kinds.zip(is_odd).map(|(kind, odd)| {
        let colors = match last {
            Some((same, colors)) if same == kind => colors,
            _ => *known.entry(kind).or_insert_with_key(both),
        };
        last = Some((kind, colors));
        colors[usize::from(odd)]
    });
    colors.collect()
}

/// The picture of a stitch mesh with these rows.
pub fn stitch_drawing(
    stitches: &StitchMesh,
    rows: &[Row],
    shown: Shown<'_>,
    colors: StitchColors,
) -> Drawing {
    let mut drawing = Drawing::default();
    draw_stitches(&mut drawing, stitches, rows, shown, colors);
    drawing
}

/// Puts the picture of a stitch mesh with these rows in place of the faces and lines of a drawing, whose memory is used again.
pub fn draw_stitches(
    drawing: &mut Drawing,
    stitches: &StitchMesh,
    rows: &[Row],
    shown: Shown<'_>,
    colors: StitchColors,
) {
    let mesh = stitches.mesh();
    let line = |e: usize| {
        let edge = EdgeId::new(e);
        let (side, twin) = mesh.edge_sides(edge);
        let wale = stitches.is_wale(side);
        let shown = shown(mesh.face(side)) || twin.is_some_and(|t| shown(mesh.face(t)));
        let width = if shown { if wale { 1.5 } else { 1.0 } } else { 0.0 };
        edge_line(mesh, edge, [0.16, 0.14, 0.12], width)
    };
    let Drawing { faces, lines: Lines { segments }, .. } = drawing;
    rayon::join(
        || {
            let colors = stitch_colors(stitches, rows, colors);
            draw_faces(faces, mesh, shown, |f| colors[f]);
        },
        || {
            let edges = (0..mesh.edge_count()).into_par_iter().with_min_len(PIECE);
            edges.map(line).collect_into_vec(segments);
            segments.extend(stitches.cables().iter().flat_map(|cable| crossing(stitches, cable, shown)));
        },
    );
}

/// A cable as knitters draw it: a line for each strand, from the stitches below to those above that it goes to; those further back are
/// broken where the others cross them.
fn crossing(stitches: &StitchMesh, cable: &Cable, shown: Shown<'_>) -> Vec<Segment> {
    let mesh = stitches.mesh();
    // The middles of the stitches below and above each edge.
    let middles = |ends: &[VertexId]| {
        let below = mesh.face(mesh.half_edge_between(ends[1], ends[0])?);
        let above = mesh.face(mesh.half_edge_between(ends[0], ends[1])?);
        (shown(below) || shown(above)).then(|| [below, above].map(|face| mesh.face_center(face)))
    };
    let Some(middles) = cable.path.windows(2).map(middles).collect::<Option<Vec<_>>>() else {
        return Vec::new();
    };
    let loops = |strand: &u8| usize::from(cable.strands[usize::from(*strand)]);
    // Where a strand begins among the loops when they stand in an order.
    let first =
        |order: &[u8], strand: u8| -> usize { order.iter().take_while(|s| **s != strand).map(loops).sum() };
    let laid: Vec<u8> = (0..cable.strands.len() as u8).collect();
    let mean = |from: usize, count: usize, side: usize| {
        middles[from..from + count].iter().map(|m| m[side]).sum::<DVec3>() / count as f64
    };
    let line = |(depth, strand): (usize, &u8)| {
        let count = loops(strand);
        let ends = [mean(first(&laid, *strand), count, 0), mean(first(&cable.order, *strand), count, 1)];
        let parts: &[[f64; 2]] = if depth == 0 { &[[0.0, 1.0]] } else { &[[0.0, 0.3], [0.7, 1.0]] };
        parts.iter().map(move |part| Segment {
            ends: part.map(|t| ends[0].lerp(ends[1], t).as_vec3()),
            color: palette::CABLE,
            width: 4.0,
        })
    };
    cable.front.iter().enumerate().flat_map(line).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cables_are_drawn_on_the_stitches() {
        let size = stitch_mesh::edge_counts::StitchSize::of_width(3e-3);
        let net = |left: bool| {
            stitch_mesh::swatches::of_cable(&[(0, Cable::cross(vec![], 2, 2, left))], 5, size).unwrap()
        };
        let lines = |stitches: &StitchMesh| {
            let drawing = stitch_drawing(stitches, &stitches.rows(), &|_| true, StitchColors::default());
            let strands = drawing.lines.segments.into_iter().filter(|s| s.color == palette::CABLE);
            strands.map(|s| (s.ends[1] - s.ends[0]).to_array()).collect::<Vec<_>>()
        };
        // The strand in front goes to its side in one line, the other is broken.
        for (left, side) in [(true, -1.0), (false, 1.0)] {
            let strands = lines(&net(left));
            assert_eq!(strands.len(), 3);
            assert!(strands[0][0] * side > 0.0 && strands[1][0] * side < 0.0 && strands[2][0] * side < 0.0);
            assert!(strands.iter().all(|s| s[1] > 0.0), "upwards");
        }
    }
}
