//! The yarn of one stitch.
//!
//! Each knit or purl of a stitch has four nodes LL, LU, RU, RL in its share of the face; every old loop passes all four, and
//! so does the new yarn, with its loop between LU and RU. A yarn-over has none. A stitch without tops gathers: its yarn
//! threads each old loop at two nodes. A twisted loop crosses its own legs in one more node.

use super::{Draft, DraftContact, DraftNode, DraftVisit, Piece, Port, course_port, wale_port};
use crate::ids::{FaceId, NodeId};
use crate::mean_value::{mean_value_weights, reference_polygon};
use crate::stitch::{Make, Stitch};
use crate::stitch_mesh::StitchMesh;
use glam::{DVec2, DVec3};
use smallvec::{SmallVec, smallvec};

/// Places of the four nodes in their share of the face: across (left to right), up (bottom to top).
const LL: DVec2 = DVec2::new(0.20, 0.10);
const LU: DVec2 = DVec2::new(0.30, 0.50);
const RU: DVec2 = DVec2::new(0.70, 0.50);
const RL: DVec2 = DVec2::new(0.80, 0.10);
/// Where the legs of a twisted loop cross.
const CROSSING: DVec2 = DVec2::new(0.50, 0.75);
/// Where gathered loops are threaded.
const GATHER: [DVec2; 2] = [DVec2::new(0.35, 0.35), DVec2::new(0.65, 0.35)];

/// Maps places in the reference square of a stitch into space.
pub struct FaceFrame {
    reference: Vec<DVec2>,
    corners: Vec<DVec3>,
    normals: Vec<DVec3>,
    face: Option<FaceId>,
}

impl FaceFrame {
    /// The frame of a face of the mesh.
    pub fn of_face(stitches: &StitchMesh, vertex_normals: &[DVec3], face: FaceId) -> Self {
        let mesh = stitches.mesh();
        let stitch = stitches.stitch(face);
        Self {
            // Both begin at the lower left corner, and a side without edges is one corner in both.
            reference: reference_polygon(stitch.bottoms(), stitch.tops()),
            corners: mesh.face_vertices(face).map(|v| mesh.position(v)).collect(),
            normals: mesh.face_vertices(face).map(|v| vertex_normals[v.index()]).collect(),
            face: Some(face),
        }
    }

    /// The frame of a cell beyond a border: a quadrilateral (lower left, lower right, upper right, upper left).
    pub fn beyond_border(corners: [DVec3; 4], normal: DVec3) -> Self {
        Self {
            reference: reference_polygon(1, 1),
            corners: corners.to_vec(),
            normals: vec![normal; 4],
            face: None,
        }
    }

    /// Position of a place in the reference square [m].
    pub fn position(&self, place: DVec2) -> DVec3 {
        let weights = mean_value_weights(&self.reference, place);
        self.corners.iter().zip(weights).map(|(c, w)| *c * w).sum()
    }

    fn node(&self, place: DVec2) -> DraftNode {
        let weights = mean_value_weights(&self.reference, place);
        let normal: DVec3 = self.normals.iter().zip(weights).map(|(n, w)| *n * w).sum();
        let across = self.position(DVec2::new(0.9, place.y)) - self.position(DVec2::new(0.1, place.y));
        DraftNode {
            position: self.position(place),
            normal: normal.normalize_or(DVec3::Z),
            outward: across * if place.x > 0.5 { 0.3 } else { -0.3 },
            face: self.face,
            stack: SmallVec::new(),
        }
    }
}

/// The ports of a stitch.
pub struct Cell {
    /// Where the row's yarn comes in on the left.
    pub left: Port,
    /// Where it goes out on the right.
    pub right: Port,
    /// Left and right leg of each old loop, left to right.
    pub bottoms: SmallVec<[[Port; 2]; 2]>,
    /// Left and right leg of each new loop, left to right.
    pub tops: SmallVec<[[Port; 2]; 2]>,
}

impl Cell {
    /// The ports of a face.
    pub fn of_face(stitches: &StitchMesh, face: FaceId) -> Self {
        Self {
            left: wale_port(stitches.left(face)),
            right: wale_port(stitches.right(face)),
            bottoms: stitches.bottoms(face).map(|h| [course_port(h, 0), course_port(h, 1)]).collect(),
            // Tops run right to left, so their origin is on the right.
            tops: stitches.tops(face).map(|h| [course_port(h, 1), course_port(h, 0)]).collect(),
        }
    }

    /// Adds the nodes, pieces and contacts of `stitch`.
    pub fn lay(&self, stitch: &Stitch, frame: &FaceFrame, draft: &mut Draft) {
        let mut old: Vec<SmallVec<[DraftVisit; 4]>> = vec![SmallVec::new(); self.bottoms.len()];
        let mut new = NewYarn { from: self.left, visits: SmallVec::new() };
        for (i, op) in stitch.ops.iter().enumerate() {
            let share = |place: DVec2| DVec2::new((i as f64 + place.x) / stitch.tops() as f64, place.y);
            let four = (op.make != Make::YarnOver).then(|| {
                let nodes = [LL, LU, RU, RL].map(|p| draft.node(frame.node(share(p))));
                contacts(draft, nodes, op.make == Make::Knit, &stitch.stack, &mut old)
            });
            new.visits.extend(four.iter().flat_map(|v| [v[0], v[1]]));
            let [left, right] = self.tops[i];
            if op.twist == 0 {
                new.end(draft, left, right);
            } else {
                let node = draft.node(frame.node(share(CROSSING)));
                let (out, back) = (draft.visit(node), draft.visit(node));
                draft.nodes[node.index()].stack =
                    if op.twist > 0 { smallvec![out, back] } else { smallvec![back, out] };
                new.visits.push(out);
                new.end(draft, right, left);
                new.visits.push(back);
            }
            new.visits.extend(four.iter().flat_map(|v| [v[2], v[3]]));
        }
        if stitch.ops.is_empty() {
            gather(frame, &mut old, &mut new, draft);
        }
        new.end(draft, self.right, self.right);
        // Old loops exist only where something holds them; under a yarn-over row there is nothing but the border.
        for (visits, [from, to]) in old.into_iter().zip(&self.bottoms).filter(|_| stitch.holds()) {
            draft.pieces.push(Piece { from: *from, visits, to: *to });
        }
    }
}

/// The two stitch contacts of one knit or purl. Returns the visits of the new yarn.
fn contacts(
    draft: &mut Draft,
    nodes: [NodeId; 4],
    knit: bool,
    stack: &[u8],
    old: &mut [SmallVec<[DraftVisit; 4]>],
) -> [DraftVisit; 4] {
    let new = nodes.map(|n| draft.visit(n));
    let mut old_visits: Vec<[DraftVisit; 4]> = Vec::new();
    for b in stack {
        let visits = nodes.map(|n| draft.visit(n));
        old[usize::from(*b)].extend(visits);
        old_visits.push(visits);
    }
    // Knit: the old loops lie in front of the new yarn at its feet and behind it above; purl the other way round.
    for (k, node) in nodes.into_iter().enumerate() {
        let old_in_front = knit == (k == 0 || k == 3);
        let stack = &mut draft.nodes[node.index()].stack;
        stack.extend(old_visits.iter().map(|v| v[k]));
        stack.insert(if old_in_front { stack.len() } else { 0 }, new[k]);
    }
    let left = if knit { 1.0 } else { -1.0 };
    for (handedness, p, q) in [(left, 0, 1), (-left, 2, 3)] {
        draft.contacts.push(DraftContact {
            handedness,
            new: [new[p], new[q]],
            old: old_visits.iter().map(|v| [v[p], v[q]]).collect(),
        });
    }
    new
}

/// A yarn through all old loops that makes none: in front of the left side of each, behind its right side.
fn gather(frame: &FaceFrame, old: &mut [SmallVec<[DraftVisit; 4]>], new: &mut NewYarn, draft: &mut Draft) {
    let count = old.len() as f64;
    for (b, held) in old.iter_mut().enumerate() {
        for (k, place) in GATHER.into_iter().enumerate() {
            let node = draft.node(frame.node(DVec2::new((b as f64 + place.x) / count, place.y)));
            let (thread, loop_) = (draft.visit(node), draft.visit(node));
            draft.nodes[node.index()].stack =
                if k == 0 { smallvec![thread, loop_] } else { smallvec![loop_, thread] };
            new.visits.push(thread);
            held.push(loop_);
        }
    }
}

/// The row's yarn while it is followed through a stitch.
struct NewYarn {
    from: Port,
    visits: SmallVec<[DraftVisit; 4]>,
}

impl NewYarn {
    /// Ends the piece at port `to`; the next one begins at `then`.
    fn end(&mut self, draft: &mut Draft, to: Port, then: Port) {
        let visits = std::mem::take(&mut self.visits);
        draft.pieces.push(Piece { from: std::mem::replace(&mut self.from, then), visits, to });
    }
}
