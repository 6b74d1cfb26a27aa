//! Strips of nodes, and which elements lie in which.
//!
//! The columns of a run of nodes follow each other in the matrix. So elements that lie whole inside of one run can be added up without
//! a look at the others; those across two come after. Strips depend on the net alone.

use crate::model::{FROZEN, Model, Stencil};
use crate::solver::matrix::BlockMatrix;
use std::ops::Range;
use stitch_mesh::ids::NodeId;

/// Nodes in a strip at least, and strips at most.
const STRIP: usize = 4096;
const MOST_STRIPS: usize = 16;

/// Where the unknowns of a stencil are, counted from the beginning of its strip.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Places<const K: usize> {
    /// The stencil's place among all of its kind.
    pub term: u32,
    /// Of each visit in [`System::pull`].
    pub slot: [u32; K],
    /// First unknown of each visit's node.
    pub start: [u32; K],
    /// Place of the sliding coordinate within its node, or [`FROZEN`].
    pub sliding: [u32; K],
    /// First entry of the block (row a, column b) where node a ≥ node b.
    pub block: [[u32; K]; K],
    /// From an entry to that beside it in the next column, in the first column of each node. It is one less in each further one.
    stride: [u32; K],
}

impl<const K: usize> Places<K> {
    fn new(
        model: &Model,
        matrix: &BlockMatrix,
        (term, stencil): (usize, &Stencil<K>),
        strip: &Strip,
    ) -> Self {
        let node = stencil.nodes.map(|n| n.index());
        let own = node.map(|n| model.start[n]);
        let slot = std::array::from_fn(|k| {
            let stack = &model.net.nodes[node[k]].visits;
            let place = stack.iter().position(|v| *v == stencil.visits[k]).unwrap_or_default();
            model.slot[node[k]] + place as u32 - strip.slots.start
        });
        let sliding = std::array::from_fn(|k| match model.sliding[stencil.visits[k].index()] {
            FROZEN => FROZEN,
            dof => dof - own[k],
        });
        let block = std::array::from_fn(|a| {
            std::array::from_fn(|b| match matrix.block(node[a], node[b]) {
                _ if node[a] < node[b] => 0,
                block => matrix.place(own[b], block, 0, 0) as u32 - strip.entries.start,
            })
        });
        let stride = own.map(|s| matrix.column[s as usize + 1] - matrix.column[s as usize] - 1);
        Self { term: term as u32, slot, start: own.map(|s| s - strip.unknowns.start), sliding, block, stride }
    }

    /// From an entry of the first column of visit k's node to that beside it in a further one.
    #[inline(always)]
    pub fn column(&self, k: usize, unknown: usize) -> usize {
        unknown * self.stride[k] as usize - unknown * unknown.saturating_sub(1) / 2
    }
}

/// A run of nodes, and what of the system is theirs.
#[derive(Clone, Debug)]
pub(crate) struct Strip {
    nodes: Range<u32>,
    pub slots: Range<u32>,
    pub unknowns: Range<u32>,
    pub entries: Range<u32>,
}

impl Strip {
    fn new(model: &Model, matrix: &BlockMatrix, nodes: Range<u32>) -> Self {
        let between = |of: &dyn Fn(usize) -> u32| of(nodes.start as usize)..of(nodes.end as usize);
        let unknowns = between(&|n| model.start[n]);
        let entries = matrix.column[unknowns.start as usize]..matrix.column[unknowns.end as usize];
        Self { slots: between(&|n| model.slot[n]), unknowns, entries, nodes }
    }
}

/// Elements that touch one strip alone.
pub(crate) struct Share {
    pub segments: Vec<Places<2>>,
    pub bends: Vec<Places<3>>,
    pub wraps: Vec<Places<4>>,
    pub shears: Vec<Places<4>>,
}

impl Share {
    /// The elements of `model` that `has` takes by their nodes, their places counted from the beginning of `strip`.
    fn new(model: &Model, matrix: &BlockMatrix, strip: &Strip, has: &dyn Fn(&[NodeId]) -> bool) -> Self {
        fn places<'a, const K: usize>(
            stencils: impl Iterator<Item = &'a Stencil<K>>,
            (model, matrix, strip): (&Model, &BlockMatrix, &Strip),
            has: &dyn Fn(&[NodeId]) -> bool,
        ) -> Vec<Places<K>> {
            let own = stencils.enumerate().filter(|(_, s)| has(&s.nodes));
            own.map(|s| Places::new(model, matrix, s, strip)).collect()
        }
        let of = (model, matrix, strip);
        Self {
            segments: places(model.segments.iter().map(|t| &t.stencil), of, has),
            bends: places(model.bends.iter().map(|t| &t.stencil), of, has),
            wraps: places(model.wraps.iter().map(|t| &t.stencil), of, has),
            shears: places(model.shears.iter().map(|t| &t.stencil), of, has),
        }
    }
}

/// The strips of a net, each with the elements in it, and the elements across strips.
pub(crate) fn share_out(model: &Model, matrix: &BlockMatrix) -> (Vec<(Strip, Share)>, Share) {
    let count = model.net.nodes.len() as u32;
    let width = count.div_ceil((count as usize / STRIP).clamp(1, MOST_STRIPS) as u32).max(1);
    let strips = (0..count).step_by(width as usize).map(|first| {
        let strip = Strip::new(model, matrix, first..count.min(first + width));
        let inside = |nodes: &[NodeId]| nodes.iter().all(|n| strip.nodes.contains(&n.0));
        let share = Share::new(model, matrix, &strip, &inside);
        (strip, share)
    });
    let all = Strip::new(model, matrix, 0..count);
    let across = |nodes: &[NodeId]| nodes.iter().any(|n| n.0 / width != nodes[0].0 / width);
    (strips.collect(), Share::new(model, matrix, &all, &across))
}
