//! Groups of nodes for a complete factorisation: nested dissection.
//!
//! # Theory
//! George, *Nested Dissection of a Regular Finite Element Mesh*. A separator, eliminated last, keeps the two sides from filling each
//! other in. Each side is dissected the same way. Fabric is a surface, so n nodes fill in n log n entries and take n^1.5
//! operations, in proportion to the cube of the width of separators.
//!
//! Schild and Sommer, *On Balanced Separators in Road Networks*: of nodes in their order along a line the first and the last part are
//! two sets, between which the smallest separator is a matter of paths (`separator.rs`).
//!
//! # Practice
//! Lines are the three axes. Where the fabric was laid tells nearness well enough, and is known before the first step.
//! Taken is the separator with the fewest operations by a rule of thumb; it is a third as wide as the nodes on one side of a plane
//! that touch the other side, and a sweater of 10 400 loops takes 37 · 10⁹ operations to factorise instead of 97 · 10⁹.
//!
//! Separators, and pieces too small to be cut, are groups. What the first separator leaves on both sides is factorised beside
//! each other, as in `parts.rs`.

use super::separator::{Band, Side};
use crate::model::Model;
use glam::DVec3;
use std::ops::Range;

/// The part of all nodes that are in the first set, and in the second.
const PART: f64 = 0.3;

/// How large groups are.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sizes {
    /// Pieces of at most this many nodes are not cut again.
    pub leaf: usize,
    /// Unknowns in a group, about; those of a large separator go into several.
    pub most: u32,
}

/// The nodes of `model` in groups, in the order of their elimination, and the ranges of both halves and of what joins them.
pub(crate) fn dissected(model: &Model, sizes: Sizes) -> (Vec<Vec<u32>>, Vec<Range<usize>>) {
    let count = model.net.nodes.len();
    let mut neighbours = model.neighbours.clone();
    for a in 0..count {
        for &b in model.neighbours[a].iter().filter(|b| **b as usize != a) {
            neighbours[b as usize].push(a as u32);
        }
    }
    let fabric = Fabric {
        position: model.net.nodes.iter().map(|n| n.position).collect(),
        size: model.start.windows(2).map(|s| s[1] - s[0]).collect(),
        neighbours,
    };
    let (halves, joint) = match Dissection::new(&fabric, sizes).best_cut((0..count as u32).collect()) {
        Ok(Cut { sides, separator }) => (sides, separator),
        Err(nodes) => ([nodes, Vec::new()], Vec::new()),
    };
    let dissect = |half| {
        let mut dissection = Dissection::new(&fabric, sizes);
        dissection.dissect(half);
        dissection.groups
    };
    let [left, right] = halves;
    let (mut groups, right) = rayon::join(|| dissect(left), || dissect(right));
    let mut ends = vec![groups.len()];
    groups.extend(right);
    ends.push(groups.len());
    let mut last = Dissection::new(&fabric, sizes);
    last.add(joint);
    groups.extend(last.groups);
    let count = groups.len();
    (groups, vec![0..ends[0], ends[0]..ends[1], ends[1]..count])
}

/// Operations of the complete factorisation of a fabric of so many nodes, about: 4 300 … 4 700 n^1.5 for sweaters of 1 000 … 57 000 loops.
pub(crate) fn operations(nodes: usize) -> f64 {
    4_500.0 * (nodes as f64).powf(1.5)
}

/// Size of the complete factor of a fabric of so many nodes, packed, about: 2 900, 3 800 and 4 400 a node were found at 43 000,
/// 225 000 and 402 000 nodes [bytes].
pub(crate) fn bytes(nodes: usize) -> f64 {
    400.0 * (nodes as f64).powf(1.186)
}

/// The graph of a fabric's nodes.
struct Fabric {
    /// Where each was laid.
    position: Vec<DVec3>,
    /// Unknowns of each node.
    size: Vec<u32>,
    neighbours: Vec<Vec<u32>>,
}

struct Dissection<'a> {
    fabric: &'a Fabric,
    /// The stamp of the set that each node was last put in, and its place there.
    place: Vec<(u32, u32)>,
    stamp: u32,
    sizes: Sizes,
    /// Nodes in the order of their elimination.
    groups: Vec<Vec<u32>>,
}

/// A way to cut a set of nodes.
struct Cut {
    sides: [Vec<u32>; 2],
    separator: Vec<u32>,
}

impl<'a> Dissection<'a> {
    fn new(fabric: &'a Fabric, sizes: Sizes) -> Self {
        Self { fabric, place: vec![(0, 0); fabric.size.len()], stamp: 0, sizes, groups: Vec::new() }
    }

    fn dissect(&mut self, nodes: Vec<u32>) {
        if nodes.is_empty() {
            return;
        }
        match self.best_cut(nodes) {
            Ok(Cut { sides, separator }) => {
                sides.into_iter().for_each(|side| self.dissect(side));
                self.add(separator);
            }
            Err(nodes) => self.groups.push(nodes),
        }
    }

    /// Adds a separator, in groups of not too many unknowns, along its length: what it separates touches a stretch of it.
    fn add(&mut self, mut separator: Vec<u32>) {
        let along = |n: &u32| self.fabric.position[*n as usize];
        let low = separator.iter().map(along).fold(DVec3::INFINITY, DVec3::min);
        let high = separator.iter().map(along).fold(DVec3::NEG_INFINITY, DVec3::max);
        let axis = (high - low).max_position();
        separator.sort_by(|a, b| along(a)[axis].total_cmp(&along(b)[axis]));
        let mut room = 0;
        for node in separator {
            let size = self.fabric.size[node as usize];
            match self.groups.last_mut().filter(|_| room >= size) {
                Some(group) => group.push(node),
                None => {
                    self.groups.push(vec![node]);
                    room = self.sizes.most;
                }
            }
            room -= size;
        }
    }

    /// The cut that makes for the fewest operations, or the nodes again if they are too few.
    fn best_cut(&mut self, nodes: Vec<u32>) -> Result<Cut, Vec<u32>> {
        if nodes.len() <= self.sizes.leaf {
            return Err(nodes);
        }
        let mut best: Option<(f64, Cut)> = None;
        for axis in 0..3 {
            let mut sorted = nodes.clone();
            let along = |n: &u32| self.fabric.position[*n as usize][axis];
            sorted.sort_unstable_by(|a, b| along(a).total_cmp(&along(b)).then(a.cmp(b)));
            for cut in self.cuts(&sorted) {
                let operations = self.operations(&cut);
                if best.as_ref().is_none_or(|(least, _)| operations < *least) {
                    best = Some((operations, cut));
                }
            }
        }
        best.map(|(_, cut)| cut).ok_or(nodes)
    }

    /// Operations that a cut makes for, about: of a separator, with what it is joined to, and of the sides, beside each other.
    fn operations(&self, cut: &Cut) -> f64 {
        let unknowns: u32 = cut.separator.iter().map(|n| self.fabric.size[*n as usize]).sum();
        let larger = cut.sides.iter().map(Vec::len).max().unwrap_or_default();
        4.0 * f64::from(unknowns).powi(3) + 2.0 * operations(larger)
    }

    /// The smallest separators between the first and the last of `sorted`.
    fn cuts(&mut self, sorted: &[u32]) -> [Cut; 2] {
        let count = sorted.len();
        let first = ((PART * count as f64) as usize).max(1);
        let band = first..count - first;
        self.stamp += 1;
        for (i, n) in sorted.iter().enumerate() {
            self.place[*n as usize] = (self.stamp, i as u32);
        }
        let near = |n: u32| {
            let places = self.fabric.neighbours[n as usize].iter().map(|m| self.place[*m as usize]);
            places.filter(|(stamp, _)| *stamp == self.stamp).map(|(_, at)| at as usize)
        };
        // Where seams join the ends, what touches the last is in the separator itself.
        let seam = |i: usize| i < first && near(sorted[i]).any(|at| at >= band.end);
        let mut starts = vec![0];
        let (mut neighbours, mut touches) = (Vec::new(), [Vec::new(), Vec::new()]);
        for i in band.clone() {
            neighbours.extend(near(sorted[i]).filter(|at| band.contains(at)).map(|at| (at - first) as u32));
            starts.push(neighbours.len() as u32);
            touches[0].push(near(sorted[i]).any(|at| at < first));
            touches[1].push(near(sorted[i]).any(|at| at >= band.end));
        }
        let separated = Band { first: starts, neighbours, touches }.separated();
        separated.map(|sides| {
            let mut cut = Cut { sides: [Vec::new(), Vec::new()], separator: Vec::new() };
            for (i, n) in sorted.iter().enumerate() {
                let side = match i {
                    i if seam(i) => Side::Separator,
                    i if i < first => Side::First,
                    i if i >= band.end => Side::Second,
                    i => sides[i - first],
                };
                match side {
                    Side::First => cut.sides[0].push(*n),
                    Side::Second => cut.sides[1].push(*n),
                    Side::Separator => cut.separator.push(*n),
                }
            }
            cut
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_node_is_in_one_group_and_halves_touch_the_joint_alone() {
        let model = crate::testing::swatch_model(6, 5);
        let (groups, parts) = dissected(&model, Sizes { leaf: 8, most: 256 });
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
