//! Unravelling: a loop that nothing holds slips out, and the wale below it runs.
//!
//! Proved on the net, not on the stitches it was laid from: a loop is held if its head, the stretch of yarn beyond its top
//! edge, passes an end of a stitch contact or a node at which yarn is threaded through it. Crossing another yarn does not
//! hold it, so a slipped or cabled loop counts by what holds it further up.

use crate::ids::HalfEdgeId;
use crate::stitch_mesh::StitchMesh;
use crate::yarn_net::{NodeKind, YarnNet};

/// The top half-edges whose loops nothing holds, except live ones. Empty for every fabric that stays together; what can fall
/// apart is a loop slipped row after row up to where tops meet tops, which no knitter works.
pub fn loose_loops(stitches: &StitchMesh, net: &YarnNet) -> Vec<HalfEdgeId> {
    let holds = |visit: u32| {
        let node = net.visits[visit as usize].node;
        matches!(net.nodes[node.index()].kind, NodeKind::Stitch | NodeKind::Thread | NodeKind::Seam)
    };
    let loose = net.loops.iter().filter(|l| !l.head.clone().any(holds));
    loose.map(|l| l.top).filter(|top| !stitches.is_live(handed_on_to(stitches, *top))).collect()
}

/// The top edge at which the loop on a top edge ends up, handed on by the stitches that slip it: its own if none does.
pub fn handed_on_to(stitches: &StitchMesh, top: HalfEdgeId) -> HalfEdgeId {
    let mut at = top;
    // Handed on once a row at the most; cables may take it aside, but not back.
    for _ in 0..stitches.mesh().face_count() {
        let Some(bottom) = stitches.loop_above(at) else { break };
        let face = stitches.mesh().face(bottom);
        let slipped = stitches.stitch(face).ops.iter().position(|op| op.make.passes_on());
        match slipped.and_then(|i| stitches.tops(face).nth(i)) {
            Some(next) => at = next,
            None => break,
        }
    }
    at
}
