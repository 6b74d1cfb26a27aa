//! Frames of stitches, from the middles of their neighbours: in a relaxed fabric as in a laid one.

use glam::DVec3;
use stitch_mesh::ids::FaceId;
use stitch_mesh::stitch_mesh::StitchMesh;
use stitch_mesh::yarn_net::{YarnNet, YarnState};

/// Frame of a face: origin, a, b, n.
pub(super) type Frame = [DVec3; 4];

/// Middle of the nodes of each stitch, [face_count] [m]; of its face, where it has none.
pub(super) fn centers(stitches: &StitchMesh, net: &YarnNet, state: &YarnState) -> Vec<DVec3> {
    let mut sums = vec![(DVec3::ZERO, 0.0); stitches.mesh().face_count()];
    for (node, x) in net.nodes.iter().zip(&state.position) {
        if let Some(face) = node.face {
            let (sum, count) = &mut sums[face.index()];
            (*sum, *count) = (*sum + *x, *count + 1.0);
        }
    }
    let center = |(i, (sum, count)): (usize, (DVec3, f64))| match count {
        0.0 => stitches.mesh().face_center(FaceId::new(i)),
        _ => sum / count,
    };
    sums.into_iter().enumerate().map(center).collect()
}

/// The frame of each face.
pub(super) fn frames(stitches: &StitchMesh, centers: &[DVec3]) -> Vec<Frame> {
    let mesh = stitches.mesh();
    let middle = |faces: Vec<FaceId>| {
        let n = faces.len() as f64;
        (n > 0.0).then(|| faces.iter().map(|f| centers[f.index()]).sum::<DVec3>() / n)
    };
    let way = |from: Option<DVec3>, here: DVec3, to: Option<DVec3>, or: DVec3| match (from, to) {
        (Some(from), Some(to)) => 0.5 * (to - from),
        (None, Some(to)) => to - here,
        (Some(from), None) => here - from,
        (None, None) => or,
    };
    let frame = |face: FaceId| {
        let here = centers[face.index()];
        let beside = |h| mesh.face_across(h).map(|f| centers[f.index()]);
        let edge = |h| 0.5 * (mesh.position(mesh.origin(h)) + mesh.position(mesh.tip(h)));
        let (left, right) = (stitches.left(face), stitches.right(face));
        let a = way(beside(left), here, beside(right), edge(right) - edge(left));
        let below = middle(stitches.below(face).collect());
        let b = way(below, here, middle(stitches.above(face).collect()), stitches.up(face));
        let across = a.cross(b);
        [here, a, b, across / across.length().sqrt().max(1e-12)]
    };
    mesh.faces().map(frame).collect()
}

/// α, β, γ of a point.
pub(super) fn coordinates([origin, a, b, n]: &Frame, x: DVec3) -> DVec3 {
    glam::DMat3::from_cols(*a, *b, *n).inverse() * (x - *origin)
}

/// The point at α, β, γ.
pub(super) fn at([origin, a, b, n]: &Frame, place: DVec3) -> DVec3 {
    *origin + place.x * *a + place.y * *b + place.z * *n
}
