//! Bind-off: one more row of knits in cells beyond the border, each through its fabric loop and the bind-off loop before it. It
//! has colour and wrapping of the stitch below it.

use super::draft::{Cell, Draft, LOOSE};
use super::template::{LocalPorts, knit_through};
use super::{Port, course_port};
use crate::dye::Dye;
use crate::ids::HalfEdgeId;
use crate::stitch::Stitch;
use crate::stitch_mesh::StitchMesh;
use crate::wrapping::Wrapping;
use glam::DVec3;
use smallvec::{SmallVec, smallvec};

/// Height of a bind-off cell, as a part of the face below it.
const HEIGHT: f64 = 0.7;

/// A cell of a bind-off that has not been laid yet: its direction is not known before the yarn reaches it.
pub(super) struct BindOffCell {
    pub edge: HalfEdgeId,
    pub left: Port,
    pub right: Port,
}

/// The way in which a bind-off is worked.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Way {
    Rightwards,
    Leftwards,
    Round,
}

/// Cells with joined ports above a run of top edges (which come right to left); the cells come left to right.
pub(super) fn cells(run: &[HalfEdgeId], draft: &mut Draft<'_>) -> Vec<BindOffCell> {
    let cells: Vec<BindOffCell> = run
        .iter()
        .rev()
        .map(|h| BindOffCell { edge: *h, left: draft.new_port(), right: draft.new_port() })
        .collect();
    for pair in cells.windows(2) {
        draft.join(pair[0].right, pair[1].left);
    }
    // Until the cells are laid, the legs of a loop are joined as they will be through its cell: so its yarn can be followed.
    for h in run {
        draft.join(course_port(*h, 0), course_port(*h, 1));
    }
    cells
}

/// Lays the bind-off stitches. Returns, for one with an end, the port at which the yarn leaves after it has been drawn
/// through the last loop.
pub(super) fn lay(
    stitches: &StitchMesh,
    vertex_normals: &[DVec3],
    cells: &[BindOffCell],
    way: Way,
    draft: &mut Draft<'_>,
) -> Option<Port> {
    let n = cells.len();
    let tops: Vec<[Port; 2]> = (0..n).map(|_| [draft.new_port(), draft.new_port()]).collect();
    let order: Vec<usize> = if way == Way::Leftwards { (0..n).rev().collect() } else { (0..n).collect() };
    // Going round, the first stitch takes the last one's loop.
    let mut previous = tops.last().copied().filter(|_| way == Way::Round);
    for i in &order {
        let BindOffCell { edge, left, right } = cells[*i];
        let place = Place::above(stitches, vertex_normals, edge);
        let legs = [draft.new_port(), draft.new_port()];
        draft.join(legs[0], course_port(edge, 1));
        draft.join(legs[1], course_port(edge, 0));
        let mut bottoms: SmallVec<[[Port; 2]; 2]> = smallvec![legs];
        if let Some(previous) = previous {
            let passed_over = [draft.new_port(), draft.new_port()];
            draft.join(passed_over[0], previous[0]);
            draft.join(passed_over[1], previous[1]);
            bottoms.push(passed_over);
        }
        // The bind-off loop before is passed over the fabric loop: it lies in front.
        let stitch = knit_through((0..bottoms.len() as u8).rev().collect());
        let ports = ports(left, right, &bottoms, &[tops[*i]]);
        place.add(&stitch, bottoms.len(), &ports, draft);
        previous = Some(tops[*i]);
    }
    let last = *order.last()?;
    let place = Place::above(stitches, vertex_normals, cells[last].edge);
    match way {
        Way::Round => None,
        Way::Rightwards => Some(fasten(tops[last], cells[last].right, way, place, draft)),
        Way::Leftwards => Some(fasten(tops[last], cells[last].left, way, place, draft)),
    }
}

/// Where a cell beyond the border lies.
struct Place {
    /// Lower left, lower right, upper right, upper left [m].
    corners: [DVec3; 4],
    normal: DVec3,
    dye: Dye,
    wrapping: Wrapping,
}

impl Place {
    fn above(stitches: &StitchMesh, vertex_normals: &[DVec3], edge: HalfEdgeId) -> Self {
        let mesh = stitches.mesh();
        let face = mesh.face(edge);
        let (left, right) = (mesh.tip(edge), mesh.origin(edge));
        let [from, to] = [left, right].map(|v| mesh.position(v));
        let up = stitches.up(face) * HEIGHT;
        let normal = (vertex_normals[left.index()] + vertex_normals[right.index()]).normalize_or(DVec3::Z);
        let (dye, wrapping) = (stitches.dyes()[face.index()], stitches.wrappings()[face.index()]);
        Self { corners: [from, to, to + up, from + up], normal, dye, wrapping }
    }

    /// Puts a stitch with this many bottoms here.
    fn add(&self, stitch: &Stitch, bottoms: usize, ports: &[Port], draft: &mut Draft<'_>) {
        let [a, b, c, d] = self.corners;
        // Corners in the order of a face, its lower side cut into the bottoms.
        let mut corners: SmallVec<[DVec3; 6]> =
            (0..=bottoms).map(|i| a.lerp(b, i as f64 / bottoms as f64)).collect();
        corners.push(c);
        if stitch.tops() > 0 {
            corners.push(d);
        } else {
            corners[bottoms + 1] = 0.5 * (c + d);
        }
        let normals = vec![self.normal; corners.len()];
        let cell = Cell { corners: &corners, normals: &normals, dye: self.dye, wrapping: self.wrapping };
        draft.add_beyond(stitch, &cell, ports);
    }
}

/// Draws the yarn that leaves at `from` through the last loop.
fn fasten(last: [Port; 2], from: Port, way: Way, place: Place, draft: &mut Draft<'_>) -> Port {
    let [left, right, _, upper] = place.corners;
    let sense = if way == Way::Leftwards { -1.0 } else { 1.0 };
    let beyond = (right - left) * 0.8 * sense + (upper - left) * 0.3;
    let place = Place { corners: place.corners.map(|c| c + beyond), ..place };
    let (entry, exit, legs) = (draft.new_port(), draft.new_port(), [draft.new_port(), draft.new_port()]);
    draft.join(entry, from);
    legs.iter().zip(last).for_each(|(a, b)| draft.join(*a, b));
    let (left, right) = if way == Way::Leftwards { (exit, entry) } else { (entry, exit) };
    let gather = Stitch { ops: smallvec![], stack: smallvec![0] };
    place.add(&gather, 1, &ports(left, right, &[legs], &[]), draft);
    exit
}

/// Ports in the order of a face's.
fn ports(left: Port, right: Port, bottoms: &[[Port; 2]], tops: &[[Port; 2]]) -> Vec<Port> {
    let local = LocalPorts { bottoms: bottoms.len(), tops: tops.len() };
    let mut ports = vec![LOOSE; local.count()];
    ports[usize::from(local.left())] = left;
    ports[usize::from(local.right())] = right;
    for (i, legs) in bottoms.iter().enumerate() {
        local.bottom(i).into_iter().zip(legs).for_each(|(p, leg)| ports[usize::from(p)] = *leg);
    }
    for (i, legs) in tops.iter().enumerate() {
        local.top(i).into_iter().zip(legs).for_each(|(p, leg)| ports[usize::from(p)] = *leg);
    }
    ports
}
