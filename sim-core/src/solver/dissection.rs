//! Groups of nodes for a complete factorisation: geometric nested dissection.
//!
//! # Theory
//! George, *Nested Dissection of a Regular Finite Element Mesh*. The nodes on one side of a plane that touch the other side
//! separate the fabric; eliminated last, they keep the two sides from filling each other in. Each side is dissected the
//! same way. Fabric is a surface, so n nodes fill in n log n entries and take n^1.5 operations.
//!
//! # Practice
//! A plane is chosen out of several along each axis for the smallest separator. Where the fabric was laid tells nearness
//! well enough, and is known before the first step. Separators, and pieces too small to be cut, are
//! groups. What the
//! first plane leaves on both sides is factorised beside each other, as in `parts.rs`.

use crate::model::Model;
use glam::DVec3;
use std::ops::Range;

/// Pieces of at most this many nodes are not cut again.
const LEAF: usize = 8;

/// Unknowns in a group, about; those of a large separator go into several.
const MOST_UNKNOWNS: u32 = 96;

/// Places of the planes that are tried, as parts of the nodes on one side.
const CUTS: [f64; 9] = [0.42, 0.44, 0.46, 0.48, 0.5, 0.52, 0.54, 0.56, 0.58];

/// The nodes of `model` in groups, in the order of their elimination, and the ranges of both halves and of what joins them.
pub(crate) fn dissected(model: &Model) -> (Vec<Vec<u32>>, Vec<Range<usize>>) {
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
        groups: Vec::new(),
    };
    let (left, right, joint) = match dissection.best_cut((0..count as u32).collect()) {
        Ok(Cut { left, right, separator, .. }) => (left, right, separator),
        Err(nodes) => (nodes, Vec::new(), Vec::new()),
    };
    let mut ends = Vec::new();
    for half in [left, right] {
        dissection.dissect(half);
        ends.push(dissection.groups.len());
    }
    dissection.add(&joint);
    let count = dissection.groups.len();
    (dissection.groups, vec![0..ends[0], ends[0]..ends[1], ends[1]..count])
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
    groups: Vec<Vec<u32>>,
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
        if nodes.is_empty() {
            return;
        }
        match self.best_cut(nodes) {
            Ok(Cut { left, right, separator, .. }) => {
                self.dissect(left);
                self.dissect(right);
                self.add(&separator);
            }
            Err(nodes) => self.groups.push(nodes),
        }
    }

    /// Adds `nodes`, in groups of not too many unknowns.
    fn add(&mut self, nodes: &[u32]) {
        let mut room = 0;
        for node in nodes {
            let size = self.size[*node as usize];
            match self.groups.last_mut().filter(|_| room >= size) {
                Some(group) => group.push(*node),
                None => {
                    self.groups.push(vec![*node]);
                    room = MOST_UNKNOWNS;
                }
            }
            room -= size;
        }
    }

    /// The cut with the smallest separator, or the nodes again if they are too few.
    fn best_cut(&mut self, nodes: Vec<u32>) -> Result<Cut, Vec<u32>> {
        if nodes.len() <= LEAF {
            return Err(nodes);
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
        best.ok_or(nodes)
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
    fn every_node_is_in_one_group_and_halves_touch_the_joint_alone() {
        let model = crate::testing::swatch_model(6, 5);
        let (groups, parts) = dissected(&model);
        let mut nodes = groups.concat();
        nodes.sort_unstable();
        assert!(nodes.into_iter().eq(0..model.net.nodes.len() as u32));
        let mut part_of = vec![0; model.net.nodes.len()];
        for (part, range) in parts.iter().enumerate() {
            groups[range.clone()].iter().flatten().for_each(|n| part_of[*n as usize] = part);
        }
        for (a, row) in model.neighbours.iter().enumerate() {
            assert!(row.iter().all(|b| part_of[a] + part_of[*b as usize] != 1));
        }
    }
}
