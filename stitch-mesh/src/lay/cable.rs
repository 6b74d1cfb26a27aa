//! Cables laid: loops that change places between two rows (Yuksel et al. §4.5, Fig. 9).
//!
//! The paper puts a cable face between the rows. Here each leg of a loop runs straight from its top edge below to the bottom
//! edge that the cable gives it above, in a strip that reaches from the heads of the lower row to the feet of the upper one.
//! Where a leg of one strand crosses a leg of another there is a **crossing node**: two visits, front to back in the order of
//! the strands, nothing wrapped. A cross of n over m loops has 4 n m of them.
//!
//! Straight across, the legs lie longer than a knitter's, who has the same yarn in every loop: they are taken in to
//! [`TAKEN_IN`] of that, which is what draws a cable together.

use super::{Draft, course_port};
use crate::cable::Cable;
use crate::ids::NodeId;
use crate::stitch_mesh::StitchMesh;
use crate::yarn_net::NodeKind;
use glam::DVec3;

/// What remains of the length of a crossing leg.
const TAKEN_IN: f64 = 0.8;
/// How far the strip reaches into the stitches below and above, as a part of their height.
const REACH: [f64; 2] = [0.45, 0.08];
/// Where the legs of a loop leave its top edge, and arrive at a bottom edge, in widths of the edge.
const LEAVES: [f64; 2] = [0.32, 0.68];
const ARRIVES: [f64; 2] = [0.22, 0.78];
/// How far aside of a strand in front the next one leaves, in widths of the edge.
const ASIDE: f64 = 0.08;

/// Lays all cables across the edges that [`Draft::of_faces`] has joined straight.
pub fn cross(stitches: &StitchMesh, vertex_normals: &[DVec3], draft: &mut Draft<'_>) {
    for cable in stitches.cables() {
        lay(cable, stitches, vertex_normals, draft);
    }
}

fn lay(cable: &Cable, stitches: &StitchMesh, vertex_normals: &[DVec3], draft: &mut Draft<'_>) {
    let mesh = stitches.mesh();
    let strip = Strip::of(cable, stitches, vertex_normals);
    let crossing = cable.crossing();
    // A cable that was set can cross, so every pair of vertices is an edge with faces on both sides.
    let tops: Vec<_> = cable.path.windows(2).filter_map(|w| mesh.half_edge_between(w[1], w[0])).collect();
    let bottoms: Vec<_> = tops.iter().filter_map(|h| mesh.twin(*h)).collect();
    let legs = 2 * crossing.len();
    // Strands of different depth leave a little beside each other, so that no three legs meet in one point.
    let leaves = |leg: usize| (leg / 2) as f64 + LEAVES[leg % 2] + ASIDE * crossing[leg / 2].1 as f64;
    let arrives = |leg: usize| crossing[leg / 2].0 as f64 + ARRIVES[leg % 2];
    // Every crossing once, with the height at which it lies, 0 below to 1 above.
    let mut met: Vec<Vec<(f64, NodeId)>> = vec![Vec::new(); legs];
    for a in 0..legs {
        for b in a + 1..legs {
            if crossing[a / 2].0 > crossing[b / 2].0 {
                let apart = [leaves(b) - leaves(a), arrives(b) - arrives(a)];
                let height = apart[0] / (apart[0] - apart[1]);
                let across = leaves(a) + (arrives(a) - leaves(a)) * height;
                let node = strip.node(draft, across, height);
                met[a].push((height, node));
                met[b].push((height, node));
            }
        }
    }
    // In the order of their depth, so that every node has its yarns front to back.
    let mut order: Vec<usize> = (0..legs).collect();
    order.sort_by_key(|leg| crossing[leg / 2].1);
    for leg in order {
        met[leg].sort_by(|a, b| a.0.total_cmp(&b.0));
        let nodes: Vec<NodeId> = met[leg].iter().map(|m| m.1).collect();
        let (below, above) = (leg / 2, crossing[leg / 2].0);
        let [from, to] = [draft.new_port(), draft.new_port()];
        // Seen from below a top runs right to left, so its left leg is at its tip.
        draft.join(course_port(tops[below], 1 - (leg % 2) as u32), from);
        draft.join(to, course_port(bottoms[above], (leg % 2) as u32));
        let dye = stitches.dyes()[mesh.face(tops[below]).index()];
        let first = draft.add_piece([from, to], &nodes, dye, false);
        for (i, pair) in nodes.windows(2).enumerate() {
            let length = draft.node(pair[0]).0.position.distance(draft.node(pair[1]).0.position);
            draft.take_in.push((first + i as u32, (1.0 - TAKEN_IN) * length));
        }
    }
}

/// The strip in which the legs of a cable cross.
struct Strip {
    /// Points of the path, and there the ways down and up to the edges of the strip [m].
    points: Vec<[DVec3; 3]>,
    normals: Vec<DVec3>,
}

impl Strip {
    fn of(cable: &Cable, stitches: &StitchMesh, vertex_normals: &[DVec3]) -> Self {
        let mesh = stitches.mesh();
        let height = |h| stitches.up(mesh.face(h));
        let edge = |i: usize| mesh.half_edge_between(cable.path[i + 1], cable.path[i]);
        let last = cable.path.len() - 2;
        let points = (0..=last + 1).map(|i| {
            // At each vertex the mean of the stitches on both sides of it.
            let beside: Vec<_> =
                [i.checked_sub(1), Some(i.min(last))].into_iter().flatten().filter_map(edge).collect();
            let n = beside.len().max(1) as f64;
            let down = beside.iter().map(|h| height(*h)).sum::<DVec3>() / n * -REACH[0];
            let up = beside.iter().filter_map(|h| mesh.twin(*h)).map(height).sum::<DVec3>() / n * REACH[1];
            [mesh.position(cable.path[i]), down, up]
        });
        Self {
            points: points.collect(),
            normals: cable.path.iter().map(|v| vertex_normals[v.index()]).collect(),
        }
    }

    /// Adds a node at `across` loops from the left and at `height` of the strip.
    fn node(&self, draft: &mut Draft<'_>, across: f64, height: f64) -> NodeId {
        let i = (across.floor().max(0.0) as usize).min(self.points.len() - 2);
        let s = across - i as f64;
        let [point, down, up] = [0, 1, 2].map(|k| self.points[i][k].lerp(self.points[i + 1][k], s));
        let normal = self.normals[i].lerp(self.normals[i + 1], s).normalize_or(DVec3::Z);
        draft.add_node(point + down.lerp(up, height), normal, NodeKind::Crossing, up)
    }
}
