//! Seams laid: a sewing yarn that goes to and fro between two borders.
//!
//! At each edge of either side it passes one node together with the yarn of that border: the end of the row, the strand of
//! the cast-on, the chain of the bind-off, the leg of a live loop. The sides take turns in proportion to their numbers of edges. Until
//! it is pulled the yarn reaches across the gap; it is taken in, or let out where the gap is narrow, until the edges lie against each
//! other ([`BETWEEN`]). Along the seam it stays as long as the borders are: pulled tighter than that it would gather them. Pulled
//! tighter across it would press the borders through each other, and yarn that has nowhere to go makes every step fail. It does not
//! slide where it has caught a border ([`NodeKind::Seam`]): why, is said where it is taken in (`sim-core`: `take_in`).

use super::border::BoundOff;
use super::{Draft, Port, course_port, wale_port};
use crate::ids::{NodeId, VertexId};
use crate::seam::Seam;
use crate::stitch_mesh::StitchMesh;
use crate::yarn_net::NodeKind;
use glam::DVec3;

/// How far apart the edges of a pulled seam stay, over the root of the area of a stitch: a strand of yarn.
const BETWEEN: f64 = 0.33;
/// How far inside of its edge the sewing yarn catches the fabric, as a part of the stitch there.
const INSET: f64 = 0.25;

/// Lays all seams.
pub(super) fn sew(
    stitches: &StitchMesh,
    vertex_normals: &[DVec3],
    bound_off: &BoundOff,
    draft: &mut Draft<'_>,
) {
    for seam in stitches.seams() {
        lay(seam, stitches, vertex_normals, bound_off, draft);
    }
}

fn lay(
    seam: &Seam,
    stitches: &StitchMesh,
    vertex_normals: &[DVec3],
    bound_off: &BoundOff,
    draft: &mut Draft<'_>,
) {
    let mesh = stitches.mesh();
    // Edges of both sides by how far along their side they lie; at a tie the first side comes first.
    let along = |side: usize, vertices: &[VertexId]| -> Vec<(Place, [VertexId; 2])> {
        let n = (vertices.len() - 1) as f64;
        let place = |i: usize| Place { along: (i as f64 + 0.5) / n, side, reach: 0.0 };
        vertices.windows(2).enumerate().map(|(i, w)| (place(i), [w[0], w[1]])).collect()
    };
    let mut edges = along(0, &seam.a);
    edges.extend(along(1, &seam.b));
    edges.sort_by(|(p, _), (q, _)| p.along.total_cmp(&q.along));
    let mut nodes: Vec<NodeId> = Vec::new();
    let mut width = 0.0;
    let mut dye = None;
    let mut places: Vec<Place> = Vec::new();
    for (place, [a, b]) in edges {
        // A seam that was sewn lies on borders.
        let Some(h) = mesh.half_edge_between(a, b).or_else(|| mesh.half_edge_between(b, a)) else {
            continue;
        };
        let face = mesh.face(h);
        let middle = 0.5 * (mesh.position(a) + mesh.position(b));
        let edge = mesh.position(a).distance(mesh.position(b));
        // From the edge to the opposite one.
        let inwards = 2.0 * (mesh.face_center(face) - middle);
        let normal = (vertex_normals[a.index()] + vertex_normals[b.index()]).normalize_or(DVec3::Z);
        let node = draft.add_node(middle + INSET * inwards, normal, NodeKind::Seam, -0.5 * inwards);
        let port: Port = if stitches.is_wale(h) {
            wale_port(h)
        } else {
            bound_off.get(&h).copied().unwrap_or(course_port(h, 0))
        };
        catch(draft, node, port, stitches.dyes()[face.index()]);
        dye.get_or_insert(stitches.dyes()[face.index()]);
        width += edge;
        nodes.push(node);
        let depth = inwards.length();
        places.push(Place { reach: INSET * depth + 0.5 * BETWEEN * (edge * depth).sqrt(), ..place });
    }
    let ends = [draft.new_port(), draft.new_port()];
    let first = draft.add_piece(ends, &nodes, dye.unwrap_or_default(), true);
    for (i, pair) in places.windows(2).enumerate() {
        let (from, to) = (&pair[0], &pair[1]);
        // From edge to edge of one side it stays as it lies.
        if from.side == to.side {
            continue;
        }
        let laid = draft.node(nodes[i]).0.position.distance(draft.node(nodes[i + 1]).0.position);
        // `width` is that of both sides together.
        let along = (to.along - from.along) * width / 2.0;
        draft.take_in.push((first + i as u32, laid - along.hypot(from.reach + to.reach)));
    }
}

/// Where the sewing yarn catches an edge.
struct Place {
    /// How far along its side, 0 … 1.
    along: f64,
    /// Which side: 0 or 1.
    side: usize,
    /// From there to the middle of the pulled seam [m].
    reach: f64,
}

/// Leads the yarn at a border port through `node`.
fn catch(draft: &mut Draft<'_>, node: NodeId, port: Port, dye: crate::dye::Dye) {
    match draft.other_side(port) {
        Some(other) => draft.join_through(node, [port, other], dye),
        None => {
            let ends = [draft.new_port(), draft.new_port()];
            draft.join(port, ends[0]);
            draft.add_piece(ends, &[node], dye, false)
        }
    };
}
