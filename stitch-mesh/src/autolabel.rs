//! Labelling by itself, where the mesh allows it.
//!
//! Each side of each border is tried as the first row of its component, filling row after row from there; the try that
//! leaves the fewest problems wins, then the one with the fewest course edges at which wale directions oppose each other, then
//! the lowest: knitting begins at the hem. What is left over afterwards is filled from whatever borders remain.

use crate::ids::{EdgeId, FaceId, HalfEdgeId};
use crate::label::{EdgeLabel, LabelledMesh};
use crate::mesh::PolygonMesh;
use std::collections::VecDeque;

/// Labels everything that is not labelled yet. What could not be decided is in [`LabelledMesh::problems`] of the result.
pub fn autolabel(labelled: &LabelledMesh) -> LabelledMesh {
    let mut best = labelled.clone();
    grow(&mut best);
    let component = labelled.mesh().components();
    let count = component.iter().max().map_or(0, |m| m + 1);
    for c in 0..count {
        let faces: Vec<FaceId> = labelled.mesh().faces().filter(|f| component[f.index()] == c).collect();
        if !faces.iter().any(|f| best.is_open(*f)) {
            continue;
        }
        let candidates = sides(labelled.mesh()).into_iter().filter(|e| {
            let face = labelled.mesh().face(labelled.mesh().edge_sides(*e).0);
            component[face.index()] == c && best.is_open(face)
        });
        let tried = candidates.map(|edge| {
            let mut attempt = best.clone();
            // A candidate is an unlabelled border edge, so there is always something to fill.
            let _ = attempt.fill_from_border(edge);
            grow(&mut attempt);
            finish(&mut attempt, &faces);
            (quality(&attempt, &faces, edge), attempt)
        });
        if let Some((_, winner)) = tried.min_by(|(a, _), (b, _)| a.total_cmp(b)) {
            best = winner;
        }
    }
    best
}

/// One edge of each side of each border, sides being cut at corners.
fn sides(mesh: &PolygonMesh) -> Vec<EdgeId> {
    let mut edges = Vec::new();
    for ring in mesh.borders() {
        let begins = |h: &&HalfEdgeId| mesh.valence(mesh.origin(**h)) != 2;
        let corners: Vec<EdgeId> = ring.iter().filter(begins).map(|h| mesh.edge(*h)).collect();
        if corners.is_empty() {
            edges.extend(ring.first().map(|h| mesh.edge(*h)))
        } else {
            edges.extend(corners)
        }
    }
    edges
}

/// Fills outwards from every labelled row until nothing more can be reached.
fn grow(labelled: &mut LabelledMesh) {
    let mut open: VecDeque<EdgeId> = labelled.mesh().edges().collect();
    while let Some(edge) = open.pop_front() {
        if let Ok(row) = labelled.fill_from_course(edge) {
            let mesh = labelled.mesh();
            open.extend(row.into_iter().flat_map(|f| mesh.face_half_edges(f)).map(|h| mesh.edge(h)));
        }
    }
}

/// Fills what growing has not reached from the borders that are left.
fn finish(labelled: &mut LabelledMesh, faces: &[FaceId]) {
    for edge in sides(labelled.mesh()) {
        let face = labelled.mesh().face(labelled.mesh().edge_sides(edge).0);
        if faces.contains(&face) && labelled.label(edge).is_none() && labelled.fill_from_border(edge).is_ok()
        {
            grow(labelled);
        }
    }
}

/// Smaller is better: problems, then opposed course edges, then height of the first border [m].
fn quality(labelled: &LabelledMesh, faces: &[FaceId], first: EdgeId) -> f64 {
    let mesh = labelled.mesh();
    let bad = faces.iter().filter(|f| labelled.wales(**f).is_none()).count();
    let is_top = |h: HalfEdgeId| labelled.wales(mesh.face(h)).map(|w| labelled.tops(w).contains(&h));
    let opposed = mesh.edges().filter(|e| {
        let (a, b) = mesh.edge_sides(*e);
        labelled.label(*e) == Some(EdgeLabel::Course)
            && b.is_some_and(|b| is_top(a).is_some() && is_top(a) == is_top(b))
    });
    let [low, high] = mesh.bounds();
    let [a, b] = mesh.edge_ends(first);
    let middle = (mesh.position(a).y + mesh.position(b).y) / 2.0;
    let height = (middle - low.y) / (high.y - low.y).max(1e-12);
    1e6 * bad as f64 + opposed.count() as f64 + 0.5 * height
}
