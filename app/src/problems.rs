//! What keeps a project from being knitted, or will show: each with its place, in a knitter's words.

use crate::fabric::Fabric;
use crate::project::Project;
use serde::Serialize;
use sim_core::Surgery;
use stitch_mesh::cable::Cable;
use stitch_mesh::edge_counts::StitchSize;
use stitch_mesh::ids::{FaceId, VisitId};
use stitch_mesh::stitch_mesh::StitchMesh;
use stitch_mesh::unravel::loose_loops;

/// How much denser than asked for the loops of an increase or decrease may be.
///
/// Half a stitch of width is left of twice as many, and yarn as thick as the size asks for just fits: a shaping of one stitch in
/// two (`kp` on every stitch of a row) passes, and so does the stitch by which counts may differ from lengths on short edges.
const MOST_DENSITY: f64 = 2.5;

/// The mesh to which a place belongs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Of {
    /// The mesh that was read.
    Input,
    /// The stitch mesh.
    Stitches,
}

/// Something that keeps the project from being knitted.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Problem {
    /// Where, as in `face 12`.
    pub r#where: String,
    /// What, in a knitter's words.
    pub what: String,
    /// The mesh whose numbers these are.
    pub of: Of,
    /// The face, if it is at one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub face: Option<u32>,
    /// The ends of the edge, if it is at one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub edge: Option<[u32; 2]>,
}

impl Problem {
    fn at_face(of: Of, face: FaceId, what: impl Into<String>) -> Self {
        let r#where = format!("face {face}");
        Self { r#where, what: what.into(), of, face: Some(face.0), edge: None }
    }

    fn at_edge(of: Of, [a, b]: [u32; 2], what: impl Into<String>) -> Self {
        Self { r#where: format!("edge {a}–{b}"), what: what.into(), of, face: None, edge: Some([a, b]) }
    }
}

/// All problems of a project: those of its labels, of its counts, and of its stitches.
pub fn problems(project: &Project) -> Vec<Problem> {
    let labelled = &project.labelled;
    // A swatch was knitted from a pattern, not cut from a labelled mesh.
    let knitted = project.fabric.is_some() && project.counts.is_none();
    let labels = labelled.problems().into_iter().filter(|_| !knitted);
    let mut found: Vec<Problem> = labels.map(|p| Problem::at_face(Of::Input, p.face(), p.what())).collect();
    if let Some(counts) = &project.counts {
        found.extend(counts.unequal_wales(labelled).into_iter().map(|(face, left, right)| {
            let what = format!(
                "{left} rows at its left wale edge and {right} at its right one, and a row needs both its ends: give the \
                 wale edges of its row the same count, or tessellate by stitch width"
            );
            Problem::at_face(Of::Input, face, what)
        }));
    }
    if let Some(fabric) = &project.fabric {
        found.extend(squeezed(&fabric.stitches, project.size));
        found.extend(fabric.stitches.cables().iter().filter_map(|c| scattered(&fabric.stitches, c)));
        found.extend(closed(fabric));
        found.extend(loose(fabric));
    }
    found
}

/// Increases and decreases without room for their loops. Where a side is a point (the tip of a crown) loops are drawn together
/// on purpose.
fn squeezed(stitches: &StitchMesh, size: StitchSize) -> impl Iterator<Item = Problem> + '_ {
    let mesh = stitches.mesh();
    mesh.faces().filter_map(move |face| {
        let (below, above) = (stitches.bottoms(face), stitches.tops(face));
        if below.len() == above.len() || below.len().min(above.len()) == 0 {
            return None;
        }
        let more: Vec<_> = if below.len() > above.len() { below.collect() } else { above.collect() };
        let room = more.iter().map(|h| mesh.edge_length(mesh.edge(*h))).sum::<f64>() / more.len() as f64;
        (MOST_DENSITY * room < size.width).then(|| {
            let what = match stitches.stitch(face) {
                s if s.tops() > s.bottoms() => {
                    "an increase without room: its loops are less than 40 % as wide as the stitches asked for; spread the \
                     increases over more rows, or ask for more stitches below"
                }
                _ => {
                    "a decrease without room: the loops it works together are less than 40 % as wide as the stitches asked \
                     for; begin to decrease further below, or ask for fewer stitches there"
                }
            };
            Problem::at_face(Of::Stitches, face, what)
        })
    })
}

/// A cable whose loops do not come from neighbours of one row, or do not go on into neighbours of one row.
fn scattered(stitches: &StitchMesh, cable: &Cable) -> Option<Problem> {
    let mesh = stitches.mesh();
    let ends = |w: &[stitch_mesh::ids::VertexId]| [w[0].0, w[1].0];
    let at = |w: &[stitch_mesh::ids::VertexId]| {
        let below = mesh.half_edge_between(w[1], w[0])?;
        Some([mesh.face(below), mesh.face_across(below)?])
    };
    let mut before: Option<[FaceId; 2]> = None;
    for edge in cable.path.windows(2) {
        let Some(now) = at(edge) else {
            let what = "a cable that cannot cross: there is no stitch on one of its sides; clear it";
            return Some(Problem::at_edge(Of::Stitches, ends(edge), what));
        };
        let joined = |a: FaceId, b: FaceId| a == b || mesh.face_across(stitches.right(a)) == Some(b);
        if let Some(was) = before
            && !(joined(was[0], now[0]) && joined(was[1], now[1]))
        {
            let what = "a cable that cannot cross: its loops come from different rows here; clear it, and set one that \
                        stays between two rows";
            return Some(Problem::at_edge(Of::Stitches, ends(edge), what));
        }
        before = Some(now);
    }
    None
}

/// Loops that nothing holds.
fn loose(fabric: &Fabric) -> impl Iterator<Item = Problem> {
    let what = if fabric.surgery == Surgery::default() {
        "nothing holds its loop, it would run: it is slipped row after row to where rows meet top to top; knit it once on the way"
    } else {
        "nothing holds its loop, it would run: yarn has been cut or dropped there; laying the yarn anew mends it"
    };
    let loops = loose_loops(&fabric.stitches, fabric.net());
    loops.into_iter().map(move |top| Problem::at_face(Of::Stitches, fabric.stitches.mesh().face(top), what))
}

/// Rings of yarn where a spiral was asked for.
fn closed(fabric: &Fabric) -> Option<Problem> {
    let net = fabric.net();
    let ring = net.yarns.iter().find(|y| y.period.is_some() && fabric.stitches.marks().spiral)?;
    let mut faces = ring.visits.clone().map(|v| net.visits[VisitId(v).index()].node);
    let face = faces.find_map(|n| net.nodes[n.index()].face)?;
    let what = "the yarn of its row closes on itself, and the fabric is to be one spiral: rows whose wale directions oppose \
                each other, or that lie between two borders alone, cannot go on into the next; flip one, or knit in rings";
    Some(Problem::at_face(Of::Stitches, face, what))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::command::Command;
    use stitch_mesh::edge_counts::EdgeCounts;
    use stitch_mesh::ids::VertexId;
    use stitch_mesh::pieces::rectangle;

    /// Two by two faces of 20 mm.
    fn labelled() -> Project {
        let size = StitchSize::of_width(0.005);
        let big = rectangle(2, 2, StitchSize { width: 0.02, height: 0.02 }).unwrap();
        Command::Autolabel.apply(&Project::new(big.mesh().clone(), size)).unwrap()
    }

    #[test]
    fn a_sound_fabric_has_no_problems() {
        let project = Command::Tessellate { width_mm: Some(5.0) }.apply(&labelled()).unwrap();
        assert_eq!(problems(&project), []);
    }

    #[test]
    fn unequal_rows_are_named_by_face() {
        let mut project = labelled();
        let mut counts = EdgeCounts::from_size(&project.labelled, project.size).unwrap();
        let wales = project.labelled.wales(FaceId(1)).unwrap();
        counts.counts[project.labelled.mesh().edge(wales.right).index()] += 1;
        project.counts = Some(counts);
        let found = problems(&project);
        assert_eq!(found.len(), 1);
        assert_eq!((found[0].face, found[0].of, found[0].r#where.as_str()), (Some(1), Of::Input, "face 1"));
        let json = serde_json::to_value(&found[0]).unwrap();
        assert_eq!((json["of"].as_str(), json["face"].as_u64()), (Some("input"), Some(1)));
    }

    #[test]
    fn an_increase_without_room_is_named_by_face() {
        let project = labelled();
        let top = project.labelled.wales(FaceId(3)).map(|w| project.labelled.tops(w)[0]).unwrap();
        let mesh = project.labelled.mesh();
        let edge = [mesh.origin(top).0, mesh.tip(top).0];
        let project = Command::SetEdgeCounts { edges: vec![edge], count: 12 }.apply(&project).unwrap();
        let project = Command::Tessellate { width_mm: None }.apply(&project).unwrap();
        let found = problems(&project);
        assert!(!found.is_empty());
        let stitches = &project.fabric().unwrap().stitches;
        for problem in found {
            let face = FaceId(problem.face.unwrap());
            assert!(stitches.stitch(face).tops() > stitches.stitch(face).bottoms());
            assert!(problem.what.starts_with("an increase without room"), "{}", problem.what);
        }
    }

    #[test]
    fn a_cable_over_different_rows_is_named_by_edge() {
        let stitches = rectangle(3, 3, StitchSize::of_width(3e-3)).unwrap();
        let good = Cable::cross([4, 5, 6].map(VertexId).to_vec(), 1, 1, true);
        assert_eq!(scattered(&stitches, &good), None);
        // From above the first row to above the second one: no cable lets itself be set so.
        let bad = Cable::cross([4, 5, 9, 10].map(VertexId).to_vec(), 1, 2, true);
        assert_eq!(scattered(&stitches, &bad).unwrap().edge, Some([5, 9]));
    }
}
