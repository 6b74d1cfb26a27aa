//! Where the entries of a factor are.
//!
//! # Theory
//! The unknowns of a group are eliminated at once. What that couples are the *rows* of the group: the unknowns, of groups
//! eliminated later, that are joined to any of its own. A complete factorisation hands the rows of each group on to the
//! next group among them, and so through the whole tree of elimination. The incomplete one hands them on once, from the rows of
//! the matrix itself (one level of fill, IC(1)); products that fall on no row are dropped. A row is a single node, not a whole
//! group: the legs of a loop reach a part of the next stitch only, which halves the factor.
//!
//! # Practice
//! Each group has a *front*: one dense matrix with a column for each of its n unknowns, and under the n rows of its own its m
//! rows of others. It lies column by column.

use super::dissection::{Sizes, dissected};
use super::groups::groups;
use super::matrix::BlockMatrix;
use super::packed::tile_count;
use super::parts::sort_into_parts;
use crate::model::Model;
use rayon::prelude::*;
use std::ops::Range;

/// Neighbouring rows of a group that follow each other in the front of a later group too.
pub(crate) struct Run {
    /// The first of them among the rows of the group.
    pub from: u32,
    /// The same in the later front.
    pub to: u32,
    pub len: u32,
}

/// Entries in a run, in the mean, from which a product is better worked out in place than copied there.
const LONG: usize = 32;

/// Groups of a complete factorisation.
const SIZES: Sizes = Sizes { leaf: 8, most: 256 };

/// How far rows are handed on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Fill {
    /// From the rows of the matrix itself: an incomplete factorisation.
    Once,
    /// Through the whole tree of elimination: a complete one.
    Always,
}

/// What the elimination of a group does to the front of a later one.
pub(crate) struct Change {
    /// Number of the later group.
    pub group: u32,
    /// Those of the rows that are unknowns of the later group.
    pub columns: Range<u32>,
    /// The rows from the first of the columns on, as far as they are in the later front: those of its columns.
    pub runs: Vec<Run>,
    /// Whether the columns follow each other there too and the runs are long: then it is worked out where it goes.
    pub in_place: bool,
}

/// Unknowns that are eliminated at once.
pub(crate) struct Group {
    /// Its unknowns, in the order of elimination.
    pub unknowns: Range<usize>,
    /// The later unknowns that it is joined to, ascending.
    pub rows: Vec<u32>,
    /// Its front in the factor, packed.
    pub tiles: Range<usize>,
    /// What of the matrix lies in its front.
    pub blocks: Range<usize>,
    /// What its elimination does to later fronts.
    pub changes: Vec<Change>,
}

impl Group {
    /// Rows of its front.
    pub fn height(&self) -> usize {
        self.unknowns.len() + self.rows.len()
    }
}

/// A block of the matrix in a front.
pub(crate) struct Block {
    /// The nodes of its rows and of its columns in the matrix.
    pub nodes: [u32; 2],
    /// Its place in the first column of its node.
    pub offset: u32,
    /// Where its first row and its first column are in the front, in the order of `nodes`.
    pub at: [u32; 2],
}

/// Groups that can be eliminated without the other parts.
pub(crate) struct Part {
    pub groups: Range<usize>,
    pub unknowns: Range<usize>,
    pub tiles: Range<usize>,
}

/// The structure of a factor.
pub(crate) struct Pattern {
    pub groups: Vec<Group>,
    /// The last is the joint: it comes after all others.
    pub parts: Vec<Part>,
    /// Place of each unknown in the order of elimination.
    pub place: Vec<u32>,
    /// All blocks of the matrix, by the group in whose front they are.
    pub blocks: Vec<Block>,
}

impl Pattern {
    /// Of the complete factorisation.
    pub fn complete(model: &Model, matrix: &BlockMatrix) -> Self {
        let (members, parts) = dissected(model, SIZES);
        Self::new(model, matrix, &members, Fill::Always, parts)
    }

    /// Of the incomplete one.
    pub fn incomplete(model: &Model, matrix: &BlockMatrix) -> Self {
        let mut members = groups(model);
        let parts = sort_into_parts(model, &mut members);
        Self::new(model, matrix, &members, Fill::Once, parts)
    }

    fn new(
        model: &Model,
        matrix: &BlockMatrix,
        members: &[Vec<u32>],
        fill: Fill,
        parts: Vec<Range<usize>>,
    ) -> Self {
        let order = Order::new(model, members);
        let rows = order.rows(model, fill);
        let mut groups: Vec<Group> = Vec::with_capacity(rows.len());
        for (g, below) in rows.iter().enumerate() {
            let rows: Vec<u32> = below.iter().flat_map(|n| order.unknowns(model, *n)).collect();
            let unknowns = order.first[g] as usize..order.first[g + 1] as usize;
            let tiles = groups.last().map_or(0, |g| g.tiles.end);
            let tiles = tiles..tiles + tile_count(unknowns.len(), rows.len());
            groups.push(Group { unknowns, rows, tiles, blocks: 0..0, changes: Vec::new() });
        }
        let changes: Vec<_> = groups.par_iter().map(|group| changes(&groups, &order, &group.rows)).collect();
        groups.iter_mut().zip(changes).for_each(|(group, changes)| group.changes = changes);
        let blocks = order.blocks(matrix, &mut groups);
        let part = |range: Range<usize>| {
            let end =
                |at: usize, of: &dyn Fn(&Group) -> usize| at.checked_sub(1).map_or(0, |g| of(&groups[g]));
            let within = |of: &dyn Fn(&Group) -> usize| end(range.start, of)..end(range.end, of);
            let unknowns = within(&|g| g.unknowns.end);
            Part { unknowns, tiles: within(&|g| g.tiles.end), groups: range }
        };
        let parts = parts.into_iter().map(part).collect();
        Self { parts, place: order.place, blocks, groups }
    }
}

/// The nodes of later groups that each of `groups`, sorted as they are eliminated, is joined to, in that order.
pub(crate) fn rows(model: &Model, groups: &[Vec<u32>], fill: Fill) -> Vec<Vec<u32>> {
    Order::new(model, groups).rows(model, fill)
}

/// The order of elimination.
struct Order {
    /// First unknown of each group, and their number, [group_count + 1].
    first: Vec<u32>,
    group_of_node: Vec<u32>,
    /// First unknown of each node.
    start: Vec<u32>,
    group_of_unknown: Vec<u32>,
    /// New place of each unknown.
    place: Vec<u32>,
}

impl Order {
    fn new(model: &Model, groups: &[Vec<u32>]) -> Self {
        let nodes = model.net.nodes.len();
        let mut order = Self {
            first: vec![0],
            group_of_node: vec![0; nodes],
            start: vec![0; nodes],
            group_of_unknown: Vec::with_capacity(model.dof_count()),
            place: vec![0; model.dof_count()],
        };
        for (g, members) in groups.iter().enumerate() {
            for node in members.iter().map(|n| *n as usize) {
                order.group_of_node[node] = g as u32;
                order.start[node] = order.group_of_unknown.len() as u32;
                for unknown in model.start[node]..model.start[node + 1] {
                    order.place[unknown as usize] = order.group_of_unknown.len() as u32;
                    order.group_of_unknown.push(g as u32);
                }
            }
            order.first.push(order.group_of_unknown.len() as u32);
        }
        order
    }

    fn unknowns(&self, model: &Model, node: u32) -> Range<u32> {
        let (node, start) = (node as usize, self.start[node as usize]);
        start..start + model.start[node + 1] - model.start[node]
    }

    /// The nodes of later groups that each group is joined to, in the order of elimination.
    fn rows(&self, model: &Model, fill: Fill) -> Vec<Vec<u32>> {
        let mut rows: Vec<Vec<u32>> = vec![Vec::new(); self.first.len() - 1];
        for (a, neighbours) in model.neighbours.iter().enumerate() {
            for &b in neighbours {
                let (group_a, group_b) = (self.group_of_node[a], self.group_of_node[b as usize]);
                if group_a < group_b {
                    rows[group_a as usize].push(b);
                } else if group_b < group_a {
                    rows[group_b as usize].push(a as u32);
                }
            }
        }
        self.tidy(&mut rows);
        match fill {
            Fill::Once => self.hand_on_once(&mut rows),
            Fill::Always => self.hand_on_always(&mut rows),
        }
        rows
    }

    /// Adds the fill of a complete factorisation: what a group is joined to goes on to the next of them, and from there on.
    fn hand_on_always(&self, rows: &mut [Vec<u32>]) {
        for group in 0..rows.len() {
            self.tidy(&mut rows[group..=group]);
            let Some(next) = rows[group].first().map(|n| self.group_of_node[*n as usize]) else { continue };
            let on = rows[group].iter().filter(|n| self.group_of_node[**n as usize] > next).copied();
            let on: Vec<u32> = on.collect();
            rows[next as usize].extend(on);
        }
    }

    /// Adds one level of fill: what a group is joined to goes on to all of them.
    fn hand_on_once(&self, rows: &mut [Vec<u32>]) {
        let joined = rows.to_vec();
        for handed_on in &joined {
            for &b in handed_on {
                let group = self.group_of_node[b as usize];
                let later = handed_on.iter().filter(|a| self.group_of_node[**a as usize] > group);
                rows[group as usize].extend(later);
            }
        }
        self.tidy(rows);
    }

    /// The blocks of the matrix by the group in whose front they are: the earlier of those of their two nodes.
    fn blocks(&self, matrix: &BlockMatrix, groups: &mut [Group]) -> Vec<Block> {
        let mut blocks: Vec<(u32, Block)> = Vec::with_capacity(matrix.block_node.len());
        for column in 0..self.start.len() as u32 {
            for (row, offset) in matrix.blocks(column as usize) {
                let nodes = [row, column];
                let [a, b] = nodes.map(|n| self.group_of_node[n as usize]);
                let number = a.min(b);
                let group = &groups[number as usize];
                let place = |node: u32| {
                    let start = self.start[node as usize];
                    match (start as usize).checked_sub(group.unknowns.start) {
                        Some(own) if own < group.unknowns.len() => own,
                        _ => {
                            let at = group.rows.partition_point(|row| *row < start);
                            debug_assert_eq!(group.rows.get(at), Some(&start));
                            group.unknowns.len() + at
                        }
                    }
                };
                blocks.push((number, Block { nodes, offset, at: nodes.map(|n| place(n) as u32) }));
            }
        }
        blocks.sort_by_key(|(group, _)| *group);
        let mut end = 0;
        for own in blocks.chunk_by(|(a, _), (b, _)| a == b) {
            groups[own[0].0 as usize].blocks = end..end + own.len();
            end += own.len();
        }
        blocks.into_iter().map(|(_, block)| block).collect()
    }

    fn tidy(&self, rows: &mut [Vec<u32>]) {
        for nodes in rows {
            nodes.sort_unstable_by_key(|n| self.start[*n as usize]);
            nodes.dedup();
        }
    }
}

/// What the elimination of a group with these rows does to later fronts.
fn changes(groups: &[Group], order: &Order, rows: &[u32]) -> Vec<Change> {
    let group_of = |row: &u32| order.group_of_unknown[*row as usize];
    let mut first = 0;
    let change = |columns: &[u32]| {
        let number = group_of(&columns[0]);
        let group = &groups[number as usize];
        let at = first;
        first += columns.len();
        let place = |row: u32| (row as usize).checked_sub(group.unknowns.start);
        let width = group.unknowns.len();
        let mut runs: Vec<Run> = Vec::new();
        let mut others = group.rows.iter().enumerate();
        let mut other = others.next();
        for (from, row) in rows.iter().enumerate().skip(at) {
            while other.is_some_and(|(_, other)| other < row) {
                other = others.next();
            }
            let to = match (place(*row), other) {
                (Some(own), _) if own < width => own,
                (_, Some((i, other))) if other == row => width + i,
                _ => continue,
            };
            let (from, to) = (from as u32, to as u32);
            match runs.last_mut() {
                Some(run) if run.from + run.len == from && run.to + run.len == to => run.len += 1,
                _ => runs.push(Run { from, to, len: 1 }),
            }
        }
        let count = columns.len();
        let follow = columns[count - 1] - columns[0] == count as u32 - 1;
        let in_place = follow && count >= LONG && rows.len() - at >= LONG * runs.len();
        Change { group: number, in_place, columns: at as u32..first as u32, runs }
    };
    rows.chunk_by(|a, b| group_of(a) == group_of(b)).map(change).collect()
}
