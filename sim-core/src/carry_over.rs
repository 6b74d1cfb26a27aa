//! Keeping the state of a fabric through an edit of its stitches.
//!
//! An edit lays a new net. Nodes are the same in both if they lie in the same place of the same face: the face has as many
//! nodes as before, and the node as many visits. They keep position and velocity, and their visits, taken in the order of
//! the yarn, keep how far they have slid. All other nodes start where they were laid, moved as their neighbours on
//! the yarn have moved.

use glam::DVec3;
use smallvec::SmallVec;
use std::sync::Arc;
use stitch_mesh::ids::{FaceId, NodeId, VisitId};
use stitch_mesh::yarn_net::{Visit, YarnNet, YarnState};

/// The state of `new_net` that continues `old_state` of `old_net`. `old_face` tells which face of the old mesh a face of the
/// new one was, if any; nodes outside of the mesh (cast-on, bind-off, tails) are carried over if there are as many as before.
pub fn carry_over(
    old_net: &YarnNet,
    old_state: &YarnState,
    new_net: &YarnNet,
    old_face: impl Fn(FaceId) -> Option<FaceId>,
) -> YarnState {
    // Stacked otherwise at some nodes, nothing more: everything is where it was.
    let runs_alike = |(a, b): (&Visit, &Visit)| (a.node, a.yarn, a.u) == (b.node, b.yarn, b.u);
    let alike = old_net.nodes.len() == new_net.nodes.len()
        && old_net.visits.len() == new_net.visits.len()
        && (Arc::ptr_eq(&old_net.visits, &new_net.visits)
            || old_net.visits.iter().zip(&*new_net.visits).all(runs_alike));
    if alike {
        return old_state.clone();
    }
    let mut state = new_net.laid_state();
    let mut moved: Vec<Option<DVec3>> = vec![None; new_net.nodes.len()];
    let mut slid = vec![0.0; new_net.visits.len()];
    for (new, old) in same_nodes(old_net, new_net, old_face) {
        let (n, o) = (new.index(), old.index());
        state.position[n] = old_state.position[o];
        state.velocity[n] = old_state.velocity[o];
        moved[n] = Some(old_state.position[o] - new_net.nodes[n].position);
        for (v, w) in along_yarn(new_net, new).into_iter().zip(along_yarn(old_net, old)) {
            slid[v.index()] = old_state.sliding[w.index()] - old_net.visits[w.index()].u;
            state.sliding_velocity[v.index()] = old_state.sliding_velocity[w.index()];
        }
    }
    for (x, displacement) in state.position.iter_mut().zip(spread(new_net, &mut moved)) {
        *x += displacement.unwrap_or_default();
    }
    // What has been taken in is among what has slid, as long as it is the same yarn that is taken in.
    if old_net.taken_in.len() == new_net.taken_in.len() {
        state.taken_in = old_state.taken_in;
        slide(new_net, &mut state, &slid);
    }
    state
}

/// Pairs of a new node and the old one that it continues.
fn same_nodes(
    old_net: &YarnNet,
    new_net: &YarnNet,
    old_face: impl Fn(FaceId) -> Option<FaceId>,
) -> Vec<(NodeId, NodeId)> {
    let [old, new] = [old_net, new_net].map(NodesOf::net);
    let visits = |net: &YarnNet, n: NodeId| net.nodes[n.index()].visits.len();
    let mut pairs = Vec::with_capacity(new_net.nodes.len());
    for (face, nodes) in new.all() {
        let was = match face {
            Some(face) => old_face(face).map(Some),
            None => Some(None),
        };
        let Some(before) = was.map(|f| old.face(f)).filter(|o| o.len() == nodes.len()) else { continue };
        let both = nodes.iter().copied().zip(before.iter().copied());
        pairs.extend(both.filter(|(n, o)| visits(new_net, *n) == visits(old_net, *o)));
    }
    pairs
}

/// The nodes of a net, face by face, then those that lie in none.
struct NodesOf {
    /// Where those of each face begin, where those of none begin, and the end.
    starts: Vec<u32>,
    nodes: Vec<NodeId>,
}

impl NodesOf {
    fn net(net: &YarnNet) -> Self {
        let faces = net.nodes.iter().filter_map(|n| n.face).max().map_or(0, |f| f.index() + 1);
        let place = |face: Option<FaceId>| face.map_or(faces, FaceId::index);
        let mut starts = vec![0u32; faces + 2];
        net.nodes.iter().for_each(|n| starts[place(n.face) + 1] += 1);
        (0..=faces).for_each(|f| starts[f + 1] += starts[f]);
        let mut next = starts.clone();
        let mut nodes = vec![NodeId(0); net.nodes.len()];
        for (n, node) in net.nodes.iter().enumerate() {
            let at = &mut next[place(node.face)];
            nodes[*at as usize] = NodeId::new(n);
            *at += 1;
        }
        Self { starts, nodes }
    }

    fn at(&self, place: usize) -> &[NodeId] {
        let range = self.starts.get(place).zip(self.starts.get(place + 1));
        range.map_or(&[], |(begin, end)| &self.nodes[*begin as usize..*end as usize])
    }

    fn face(&self, face: Option<FaceId>) -> &[NodeId] {
        let none = self.starts.len() - 2;
        match face {
            Some(face) if face.index() >= none => &[],
            face => self.at(face.map_or(none, FaceId::index)),
        }
    }

    fn all(&self) -> impl Iterator<Item = (Option<FaceId>, &[NodeId])> {
        let none = self.starts.len() - 2;
        (0..=none).map(move |f| ((f < none).then(|| FaceId::new(f)), self.at(f)))
    }
}

/// The visits of a node in the order of the yarn, which turning a knit into a purl leaves as it is.
fn along_yarn(net: &YarnNet, node: NodeId) -> SmallVec<[VisitId; 3]> {
    let mut visits = net.nodes[node.index()].visits.clone();
    visits.sort_unstable();
    visits
}

/// For each node that has not been carried over how its neighbours have moved, from neighbour to neighbour; nothing for
/// the others, nor where no neighbour has moved.
fn spread(net: &YarnNet, moved: &mut [Option<DVec3>]) -> Vec<Option<DVec3>> {
    let mut missing: Vec<usize> = (0..moved.len()).filter(|n| moved[*n].is_none()).collect();
    let mut out = vec![None; moved.len()];
    loop {
        let mean = |n: &usize| {
            let around = net.nodes[*n].visits.iter().flat_map(|v| [net.prev(*v), net.next(*v)]).flatten();
            let known = around.filter_map(|v| moved[net.visits[v.index()].node.index()]);
            let (sum, count) = known.fold((DVec3::ZERO, 0.0), |(s, c), d| (s + d, c + 1.0));
            (count > 0.0).then(|| (*n, sum / count))
        };
        let found: Vec<(usize, DVec3)> = missing.iter().filter_map(mean).collect();
        if found.is_empty() {
            return out;
        }
        for (n, d) in found {
            moved[n] = Some(d);
            out[n] = Some(d);
        }
        missing.retain(|n| moved[*n].is_none());
    }
}

/// Slides the visits by `slid`, on every yarn where that leaves yarn in each segment.
fn slide(net: &YarnNet, state: &mut YarnState, slid: &[f64]) {
    for (id, yarn) in net.yarns.iter().enumerate() {
        let mut segments = net.segments_of(stitch_mesh::ids::YarnId::new(id));
        let fits = segments.all(|s| {
            let [a, b] = s.ends.map(|v| v.index());
            let rest = net.visits[b].u + s.wrap - net.visits[a].u;
            rest + slid[b] - slid[a] > 0.1 * rest
        });
        for v in yarn.visits.clone().filter(|_| fits) {
            state.sliding[v as usize] += slid[v as usize];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Material, Scene, Simulator};
    use stitch_mesh::edge_counts::StitchSize;
    use stitch_mesh::lay::lay;
    use stitch_mesh::pieces::rectangle;
    use stitch_mesh::stitch::Stitch;

    #[test]
    fn an_edit_keeps_everything_else() {
        let mut stitches = rectangle(8, 8, StitchSize::of_width(3e-3)).unwrap();
        let old_net = Arc::new(lay(&stitches));
        let mut simulator =
            Simulator::new(&old_net, Material::for_loop_width(3e-3), Scene::empty(), old_net.laid_state())
                .unwrap();
        for _ in 0..20 {
            simulator.step().unwrap();
        }
        let old = simulator.state();
        let same = carry_over(&old_net, old, &old_net, Some);
        assert_eq!(same.position, old.position);
        assert!(same.sliding.iter().zip(&old.sliding).all(|(a, b)| (a - b).abs() < 1e-15));

        let edited = FaceId(27);
        stitches.set_stitch(edited, Stitch::purl()).unwrap();
        let new_net = Arc::new(lay(&stitches));
        let carried = carry_over(&old_net, old, &new_net, |f| (f != edited).then_some(f));
        assert!(carried.fits(&new_net) && carried.is_finite());
        for (i, node) in new_net.nodes.iter().enumerate() {
            let distance = carried.position[i].distance(old.position[i]);
            assert!(if node.face == Some(edited) { distance < 1e-3 } else { distance == 0.0 });
        }
        let mut simulator =
            Simulator::new(&new_net, Material::for_loop_width(3e-3), Scene::empty(), carried).unwrap();
        assert_eq!(simulator.step().unwrap().rejected, 0);
    }
}
