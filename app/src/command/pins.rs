//! Holding stitches; pins and clamps through an edit, which gives the nodes of the yarn new numbers.

use super::check_face;
use crate::fabric::Fabric;
use crate::project::Project;
use crate::scenes;
use anyhow::Result;
use sim_core::Scene;
use std::collections::HashMap;
use stitch_mesh::ids::{FaceId, NodeId};
use stitch_mesh::yarn_net::YarnNet;

/// Adds a clamp that holds some stitches where they are.
pub(super) fn hold(project: &mut Project, faces: &[u32]) -> Result<()> {
    let fabric = project.fabric()?;
    let count = fabric.stitches.mesh().face_count();
    faces.iter().try_for_each(|f| check_face(*f, count))?;
    let name = format!("hold {}", project.scene.clamps.len());
    let clamp = scenes::held(fabric, &project.materials.base, faces, name);
    project.scene.clamps.push(clamp);
    Ok(())
}

/// Lets the pins and clamps of a scene hold on `new` what they held on `old`: nodes of stitches, or outside of the mesh, that
/// have as many nodes as before. `was` tells which face of the old mesh a face of the new one was.
pub(super) fn keep(scene: &mut Scene, old: &Fabric, new: &Fabric, was: impl Fn(FaceId) -> Option<FaceId>) {
    if scene.pins.is_empty() && scene.clamps.is_empty() {
        return;
    }
    let [old, new] = [old, new].map(Fabric::net);
    let by_face = |net: &YarnNet| {
        let mut nodes: HashMap<Option<FaceId>, Vec<u32>> = HashMap::new();
        for (node, i) in net.nodes.iter().zip(0..) {
            nodes.entry(node.face).or_default().push(i);
        }
        nodes
    };
    let mut now = vec![None; old.nodes.len()];
    let old = by_face(old);
    for (face, nodes) in by_face(new) {
        let before = match face {
            Some(face) => was(face).map(Some),
            None => Some(None),
        };
        let same = before.and_then(|f| old.get(&f)).filter(|o| o.len() == nodes.len());
        for (before, after) in same.into_iter().flatten().zip(nodes) {
            now[*before as usize] = Some(NodeId(after));
        }
    }
    scene.follow(&now);
}
