//! The rectangle that is relaxed, and what is measured on it.

use super::frames::{centers, coordinates, frames};
use super::{NodeShape, StitchShape, around, local_numbers, way};
use glam::DVec3;
use std::collections::HashMap;
use std::sync::Arc;
use stitch_mesh::ids::{FaceId, NodeId, VisitId};
use stitch_mesh::lay::lay;
use stitch_mesh::stitch_mesh::StitchMesh;
use stitch_mesh::yarn_net::{YarnNet, YarnState};

/// Least distance of what is measured from the border [stitches].
const BORDER: usize = 3;

/// A rectangle and its yarn.
pub(super) struct Sample {
    stitches: StitchMesh,
    pub net: Arc<YarnNet>,
    /// Stitches far enough from the border.
    inner: Vec<FaceId>,
}

impl Sample {
    pub fn new(stitches: StitchMesh) -> Self {
        let inside = |n: usize| n.min(BORDER)..n.saturating_sub(BORDER).max(n.min(BORDER));
        let rows = stitches.rows();
        let inner = rows[inside(rows.len())].iter().flat_map(|row| &row.faces[inside(row.faces.len())]);
        let inner = inner.copied().collect();
        Self { net: Arc::new(lay(&stitches)), stitches, inner }
    }

    /// Mean width and height of the inner stitches [m]. Of vectors, so that what goes to and fro in depth, as a rib does, does
    /// not count as width.
    pub fn size(&self, state: &YarnState) -> [f64; 2] {
        let frames = frames(&self.stitches, &centers(&self.stitches, &self.net, state));
        let mean = |i: usize| {
            let sum = self.inner.iter().map(|f| frames[f.index()][i]).sum::<DVec3>();
            (sum / self.inner.len().max(1) as f64).length()
        };
        [mean(1), mean(2)]
    }

    /// The shapes of the inner stitches; those among the same others in the mean.
    pub fn shapes(&self, state: &YarnState) -> Vec<StitchShape> {
        let net = &self.net;
        let frames = frames(&self.stitches, &centers(&self.stitches, net, state));
        let local = local_numbers(net);
        let mut nodes_of: HashMap<FaceId, Vec<NodeId>> = HashMap::new();
        for (i, node) in net.nodes.iter().enumerate() {
            node.face.into_iter().for_each(|f| nodes_of.entry(f).or_default().push(NodeId::new(i)));
        }
        let yarn = |u: &dyn Fn(VisitId) -> f64, a: VisitId, b: VisitId| {
            let period = net.yarns[net.visits[a.index()].yarn.index()].period.unwrap_or(0.0);
            let length = u(b) - u(a);
            // Where a closed yarn meets its beginning.
            if length.abs() > 0.5 * period && period > 0.0 { period - length.abs() } else { length.abs() }
        };
        let slide = |from: VisitId, to: Option<VisitId>| {
            let to = to.unwrap_or(from);
            let laid = yarn(&|v| net.visits[v.index()].u, from, to);
            let now = yarn(&|v| state.sliding[v.index()], from, to);
            (way(net, &local, from, to), if laid > 0.0 { now / laid } else { 1.0 })
        };
        let mut found: Vec<(StitchShape, f64)> = Vec::new();
        for face in &self.inner {
            let shape = |node: &NodeId| NodeShape {
                place: coordinates(&frames[face.index()], state.position[node.index()]),
                slides: net.nodes[node.index()]
                    .visits
                    .iter()
                    .map(|v| [slide(*v, net.prev(*v)), slide(*v, net.next(*v))])
                    .collect(),
            };
            let one = StitchShape {
                stitch: self.stitches.stitch(*face).clone(),
                around: around(&self.stitches, *face),
                nodes: nodes_of.get(face).into_iter().flatten().map(shape).collect(),
            };
            match found.iter_mut().find(|(s, _)| s.stitch == one.stitch && s.around == one.around) {
                Some((sum, count)) => {
                    add(sum, one);
                    *count += 1.0;
                }
                None => found.push((one, 1.0)),
            }
        }
        found.into_iter().map(|(sum, count)| divided(sum, count)).collect()
    }
}

/// Adds a shape of the same stitch. Yarn runs to and fro in flat knitting, so the slides go with the node they lead to.
fn add(sum: &mut StitchShape, one: StitchShape) {
    for (s, o) in sum.nodes.iter_mut().zip(one.nodes) {
        s.place += o.place;
        for (s, o) in s.slides.iter_mut().zip(o.slides) {
            let turned = s[0].0 != o[0].0;
            s[0].1 += o[usize::from(turned)].1;
            s[1].1 += o[usize::from(!turned)].1;
        }
    }
}

fn divided(mut sum: StitchShape, count: f64) -> StitchShape {
    for node in &mut sum.nodes {
        node.place /= count;
        node.slides.iter_mut().flatten().for_each(|s| s.1 /= count);
    }
    sum
}
