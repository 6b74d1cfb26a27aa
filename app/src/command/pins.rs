//! Pins through an edit, which gives the nodes of the yarn new numbers.

use sim_core::Pin;
use std::collections::HashMap;
use stitch_mesh::ids::FaceId;
use stitch_mesh::yarn_net::YarnNet;

/// The pins on `new` that hold what those on `old` held: nodes of stitches, or outside of the mesh, that have as many nodes
/// as before. `was` tells which face of the old mesh a face of the new one was.
pub(super) fn moved(
    pins: &[Pin],
    old: &YarnNet,
    new: &YarnNet,
    was: impl Fn(FaceId) -> Option<FaceId>,
) -> Vec<Pin> {
    if pins.is_empty() {
        return Vec::new();
    }
    let by_face = |net: &YarnNet| {
        let mut nodes: HashMap<Option<FaceId>, Vec<u32>> = HashMap::new();
        for (node, i) in net.nodes.iter().zip(0..) {
            nodes.entry(node.face).or_default().push(i);
        }
        nodes
    };
    let (old, mut now) = (by_face(old), HashMap::new());
    for (face, nodes) in by_face(new) {
        let before = match face {
            Some(face) => was(face).map(Some),
            None => Some(None),
        };
        let same = before.and_then(|f| old.get(&f)).filter(|o| o.len() == nodes.len());
        now.extend(same.into_iter().flatten().copied().zip(nodes));
    }
    pins.iter().filter_map(|pin| Some(Pin { node: *now.get(&pin.node)?, ..*pin })).collect()
}
