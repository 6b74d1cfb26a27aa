//! The order in which unknowns are eliminated: geometric nested dissection.
//!
//! # Theory
//! George, *Nested Dissection of a Regular Finite Element Mesh*. The nodes on one side of a plane that touch the other side
//! separate the fabric; eliminated last, they keep the two sides from filling each other in. Each side is dissected the
//! same way. Fabric is a surface, so n nodes fill in n log n entries and take n^1.5 operations.
//!
//! # Practice
//! A plane is chosen out of several along each axis for the smallest separator. Where the fabric was laid tells nearness
//! well enough, and is known before the first step. The unknowns of a node stay together.

use crate::model::Model;
use glam::DVec3;

/// Pieces of at most this many nodes are not cut again.
const LEAF: usize = 12;

/// Places of the planes that are tried, as parts of the nodes on one side.
const CUTS: [f64; 9] = [0.42, 0.44, 0.46, 0.48, 0.5, 0.52, 0.54, 0.56, 0.58];

/// The unknowns of `model` in the order of their elimination.
pub(crate) fn elimination_order(model: &Model) -> Vec<u32> {
    let count = model.net.nodes.len();
    let mut neighbours = model.neighbours.clone();
    for a in 0..count {
        for &b in model.neighbours[a].iter().filter(|b| **b as usize != a) {
            neighbours[b as usize].push(a as u32);
        }
    }
    let mut dissection = Dissection {
        position: model.net.nodes.iter().map(|n| n.position).collect(),
        size: model.start.windows(2).map(|s| s[1] - s[0]).collect(),
        neighbours,
        side: vec![0; count],
        stamp: 0,
        order: Vec::with_capacity(count),
    };
    dissection.dissect((0..count as u32).collect());
    dissection.order.iter().flat_map(|n| model.start[*n as usize]..model.start[*n as usize + 1]).collect()
}

struct Dissection {
    position: Vec<DVec3>,
    /// Unknowns of each node.
    size: Vec<u32>,
    neighbours: Vec<Vec<u32>>,
    /// The stamp of the set that each node was last put in.
    side: Vec<u32>,
    stamp: u32,
    /// Nodes in the order of their elimination.
    order: Vec<u32>,
}

/// A way to cut a set of nodes.
struct Cut {
    left: Vec<u32>,
    right: Vec<u32>,
    separator: Vec<u32>,
    /// Unknowns in the separator.
    weight: u32,
}

impl Dissection {
    fn dissect(&mut self, nodes: Vec<u32>) {
        if nodes.len() <= LEAF {
            self.order.extend(nodes);
            return;
        }
        let mut best: Option<Cut> = None;
        for axis in 0..3 {
            let mut sorted = nodes.clone();
            let place = |n: &u32| self.position[*n as usize][axis];
            sorted.sort_by(|a, b| place(a).total_cmp(&place(b)).then(a.cmp(b)));
            for part in CUTS {
                let (left, right) = sorted.split_at((part * sorted.len() as f64) as usize);
                let [one, other] = [self.cut(left, right), self.cut(right, left)];
                let cut = if one.weight <= other.weight { one } else { other };
                if best.as_ref().is_none_or(|b| cut.weight < b.weight) {
                    best = Some(cut);
                }
            }
        }
        let Some(cut) = best else { return };
        self.dissect(cut.left);
        self.dissect(cut.right);
        self.order.extend(cut.separator);
    }

    fn cut(&mut self, left: &[u32], right: &[u32]) -> Cut {
        self.stamp += 1;
        for n in right {
            self.side[*n as usize] = self.stamp;
        }
        let touches =
            |n: &&u32| self.neighbours[**n as usize].iter().any(|m| self.side[*m as usize] == self.stamp);
        let (separator, rest): (Vec<u32>, Vec<u32>) = left.iter().partition(touches);
        let weight = separator.iter().map(|n| self.size[*n as usize]).sum();
        Cut { left: rest, right: right.to_vec(), separator, weight }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_unknown_is_eliminated_once() {
        let model = crate::testing::swatch_model(6, 5);
        let mut order = elimination_order(&model);
        order.sort_unstable();
        assert!(order.iter().copied().eq(0..model.dof_count() as u32));
    }
}
