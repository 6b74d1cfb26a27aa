//! Seams laid: a sewing yarn that goes to and fro between two borders.
//!
//! At each edge of either side it passes one node together with the yarn of that border: the end of the row, the strand of
//! the cast-on, the chain of the bind-off, the leg of a live loop. The sides take turns in proportion to their numbers of edges. Until
//! it is pulled the yarn reaches across the gap; it is taken in until it only just crosses over ([`STITCH`]), which draws the
//! borders together. Along the seam it stays as long as the borders are: pulled tighter than that it would gather them.

use super::border::BoundOff;
use super::{Draft, Port, course_port, wale_port};
use crate::ids::{NodeId, VertexId};
use crate::seam::Seam;
use crate::stitch_mesh::StitchMesh;
use crate::yarn_net::NodeKind;
use glam::DVec3;

/// How far a pulled sewing stitch reaches across the seam, in widths of an edge.
const STITCH: f64 = 0.3;
/// How far inside of its edge the sewing yarn catches the fabric, as a part of the height of the stitch there.
const INSET: f64 = 0.12;

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
    let along = |side: &[VertexId]| -> Vec<(f64, [VertexId; 2])> {
        let n = (side.len() - 1) as f64;
        side.windows(2).enumerate().map(|(i, w)| ((i as f64 + 0.5) / n, [w[0], w[1]])).collect()
    };
    let mut edges = along(&seam.a);
    edges.extend(along(&seam.b));
    edges.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut nodes: Vec<NodeId> = Vec::new();
    let mut width = 0.0;
    let mut dye = None;
    let mut places: Vec<f64> = Vec::new();
    for (place, [a, b]) in &edges {
        // A seam that was sewn lies on borders.
        let Some(h) = mesh.half_edge_between(*a, *b).or_else(|| mesh.half_edge_between(*b, *a)) else {
            continue;
        };
        let face = mesh.face(h);
        let middle = 0.5 * (mesh.position(*a) + mesh.position(*b));
        let inwards = mesh.face_center(face) - middle;
        let normal = (vertex_normals[a.index()] + vertex_normals[b.index()]).normalize_or(DVec3::Z);
        let node = draft.add_node(middle + 2.0 * INSET * inwards, normal, NodeKind::Thread, -inwards);
        let port: Port = if stitches.is_wale(h) {
            wale_port(h)
        } else {
            bound_off.get(&h).copied().unwrap_or(course_port(h, 0))
        };
        catch(draft, node, port, stitches.dyes()[face.index()]);
        dye.get_or_insert(stitches.dyes()[face.index()]);
        width += mesh.position(*a).distance(mesh.position(*b));
        nodes.push(node);
        places.push(*place);
    }
    let ends = [draft.new_port(), draft.new_port()];
    let first = draft.add_piece(ends, &nodes, dye.unwrap_or_default(), true);
    let across = STITCH * width / nodes.len().max(1) as f64;
    for (i, pair) in nodes.windows(2).enumerate() {
        let length = draft.node(pair[0]).0.position.distance(draft.node(pair[1]).0.position);
        // `width` is that of both sides together.
        let along = (places[i + 1] - places[i]) * width / 2.0;
        draft.take_in.push((first + i as u32, (length - along.hypot(across)).max(0.0)));
    }
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
