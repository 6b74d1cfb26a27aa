//! Where the entries of the factor are, and in which order workgroups may make them.
//!
//! # Theory
//! A group of unknowns may be eliminated as soon as all groups are that change its front; all those with the same *level*, the longest
//! chain of such groups before it, go at once. A level is some dispatches, and one more each way in every iteration. Nested
//! dissection (`solver/dissection.rs`) starts everywhere at once, and its levels are those of its separators, one within the other. Row by row,
//! as an incomplete factorisation needs it, elimination goes through a piece of w × h stitches in some w + 1.5 h levels:
//!
//! | sweater of loops | levels, row by row | dissected | numbers in the factor | dissected | operations | dissected |
//! |---|---|---|---|---|---|---|
//! | 1 012 | 76 | 21 | 3.5e6 | 5.0e6 | 0.6e9 | 1.3e9 |
//! | 3 076 | 297 | 34 | 9.7e6 | 17e6 | 1.6e9 | 6.3e9 |
//! | 10 396 | 447 | 57 | 31e6 | 70e6 | 4.6e9 | 39e9 |
//! | 57 118 | 983 | 137 | 158e6 | 490e6 | 22e9 | 534e9 |
//!
//! With the complete factor conjugate gradients have rounding and contacts of layers left to do: 3 076 loops, falling and landing in steps of 1/30 s, take 6 …
//! 12 iterations instead of 41 … 92. So it is complete wherever there is room for it.
//!
//! # Practice
//! Chunks are runs of groups whose matrix and factor fit into one binding each. (Where that is 128 MiB, as
//! every device has, 57 118 loops have 15, and a level several dispatches: 4 200 in a factorisation, and 890 each way.)

use super::changes::Changes;
use super::constants::{MOST_GROUP, RIGID};
use super::device::GpuDevice;
use super::layout::Group;
use crate::model::Model;
use crate::solver::dissection::{self, Sizes, dissected};
use crate::solver::groups::groups;
use crate::solver::pattern::{Fill, rows};
use std::collections::BTreeMap;
use std::ops::Range;

/// Size of a complete factor over that of the CPU's, which keeps half of it in half the precision.
const BY_PACKED: f64 = 2.0;

/// Groups of a complete factorisation: larger leaves than on the CPU, whose numbers are few, as it is groups and levels that take time.
const SIZES: Sizes = Sizes { leaf: 16, most: MOST_GROUP as u32 };

/// Groups in their order of elimination.
pub(crate) struct Pattern {
    /// The node of the model that each node is, in the order of elimination, and the other way round.
    pub old: Vec<u32>,
    pub new: Vec<u32>,
    /// First unknown of each node, and their number [node_count + 1].
    pub dof: Vec<u32>,
    /// Nodes of each group.
    pub nodes: Vec<Range<u32>>,
    /// The later nodes that each group is joined to, ascending.
    pub rows: Vec<Vec<u32>>,
    pub chunk_of: Vec<u32>,
    pub group_of: Vec<u32>,
    /// Records in the order in which they are worked on.
    pub groups: Vec<Group>,
    /// Their places, by group.
    pub place: Vec<u32>,
    /// Unknowns of all rows.
    pub row_dofs: Vec<u32>,
    /// Of each level its records, chunk by chunk.
    pub levels: Vec<Vec<(usize, Range<u32>)>>,
    pub changes: Changes,
    /// Whether nothing of the factor is dropped.
    pub is_complete: bool,
    /// Numbers in the factor of each chunk.
    pub factor_counts: Vec<u64>,
}

/// What there is room for on the device.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Room {
    /// Numbers in a binding.
    pub binding: u64,
    /// The largest factor that is made complete [bytes].
    pub complete: f64,
}

impl Room {
    /// What a device has, and for the factor of some 75 000 loops.
    pub fn on(gpu: &GpuDevice) -> Self {
        Self { binding: gpu.largest_binding(), complete: 2.5e9 }
    }
}

impl Pattern {
    /// The pattern for `model`, with a complete factor where there is `room`. `widths` are the columns in the rows of each node of the
    /// model.
    pub fn new(model: &Model, widths: &[u32], room: Room) -> Self {
        if BY_PACKED * dissection::bytes(model.net.nodes.len()) <= room.complete {
            let complete = Self::filled(model, widths, room.binding, Fill::Always);
            if complete.fits(room.binding) {
                return complete;
            }
        }
        Self::filled(model, widths, room.binding, Fill::Once)
    }

    /// No more than `most` numbers of matrix and of factor are in a chunk.
    fn filled(model: &Model, widths: &[u32], most: u64, fill: Fill) -> Self {
        let members = small(
            model,
            match fill {
                Fill::Always => dissected(model, SIZES).0,
                Fill::Once => groups(model),
            },
        );
        let old: Vec<u32> = members.iter().flatten().copied().collect();
        let mut new = vec![0; old.len()];
        for (to, from) in old.iter().enumerate() {
            new[*from as usize] = to as u32;
        }
        let size = |n: u32| model.start[n as usize + 1] - model.start[n as usize];
        let mut dof = vec![0];
        for n in &old {
            dof.push(dof.last().copied().unwrap_or_default() + size(*n));
        }
        let mut nodes = Vec::with_capacity(members.len());
        let mut group_of = vec![0; old.len()];
        let mut first = 0;
        for (g, group) in members.iter().enumerate() {
            let range = first..first + group.len() as u32;
            first = range.end;
            range.clone().for_each(|n| group_of[n as usize] = g as u32);
            nodes.push(range);
        }
        let mut rows = rows(model, &members, fill);
        rows.iter_mut().flatten().for_each(|n| *n = new[*n as usize]);
        let mut pattern = Self {
            old,
            new,
            dof,
            nodes,
            rows,
            chunk_of: Vec::new(),
            group_of,
            groups: Vec::new(),
            place: Vec::new(),
            row_dofs: Vec::new(),
            levels: Vec::new(),
            changes: Changes::default(),
            is_complete: fill == Fill::Always,
            factor_counts: Vec::new(),
        };
        pattern.cut_into_chunks(widths, most);
        pattern.schedule();
        pattern.lay_out();
        pattern.changes = Changes::new(&pattern);
        pattern
    }

    /// Whether what is not in chunks fits into bindings of so many numbers, and rows of fronts into half a word.
    fn fits(&self, most: u64) -> bool {
        let Changes { tiles, sources, shared_rows, .. } = &self.changes;
        let words = [size_of_val(&tiles[..]), size_of_val(&sources[..]), size_of_val(&self.row_dofs[..])];
        let rows = shared_rows.iter().map(|rows| size_of_val(&rows[..]));
        words.into_iter().chain(rows).all(|bytes| bytes as u64 / 4 <= most)
            && self.groups.iter().all(|group| group.size + group.row_count <= 0xffff)
    }

    /// Number of unknowns of a node.
    pub fn size(&self, node: u32) -> u32 {
        self.dof[node as usize + 1] - self.dof[node as usize]
    }

    fn group_size(&self, g: usize) -> u32 {
        self.dof[self.nodes[g].end as usize] - self.dof[self.nodes[g].start as usize]
    }

    fn row_count(&self, g: usize) -> u32 {
        self.rows[g].iter().map(|n| self.size(*n)).sum()
    }

    fn cut_into_chunks(&mut self, widths: &[u32], most: u64) {
        let (mut chunk, mut values, mut factor) = (0, 0, 0);
        for g in 0..self.nodes.len() {
            let n = u64::from(self.group_size(g));
            let own_factor = n * (n + u64::from(self.row_count(g)));
            let own_values: u64 = self.nodes[g]
                .clone()
                .map(|m| u64::from(widths[self.old[m as usize] as usize] + RIGID) * u64::from(self.size(m)))
                .sum();
            if values + own_values > most || factor + own_factor > most {
                (chunk, values, factor) = (chunk + 1, 0, 0);
            }
            values += own_values;
            factor += own_factor;
            self.chunk_of.push(chunk);
        }
    }

    /// Sorts the groups by level and chunk.
    fn schedule(&mut self) {
        let mut level = vec![0_u32; self.nodes.len()];
        for g in 0..self.nodes.len() {
            for n in &self.rows[g] {
                let later = self.group_of[*n as usize] as usize;
                level[later] = level[later].max(level[g] + 1);
            }
        }
        let mut order: Vec<u32> = (0..self.nodes.len() as u32).collect();
        order.sort_by_key(|g| (level[*g as usize], self.chunk_of[*g as usize], *g));
        self.place = vec![0; order.len()];
        for (place, g) in order.iter().enumerate() {
            self.place[*g as usize] = place as u32;
            let (level, chunk) = (level[*g as usize] as usize, self.chunk_of[*g as usize] as usize);
            if self.levels.len() <= level {
                self.levels.push(Vec::new());
            }
            add_to(&mut self.levels[level], chunk, place as u32);
        }
    }

    /// Gives every group its front and its rows.
    fn lay_out(&mut self) {
        let count = self.nodes.len();
        self.groups = vec![Group::default(); count];
        self.factor_counts = vec![0; self.chunk_of.last().map_or(1, |c| *c as usize + 1)];
        for g in 0..count {
            let (size, row_count) = (self.group_size(g), self.row_count(g));
            let factor = &mut self.factor_counts[self.chunk_of[g] as usize];
            let front = *factor as u32;
            *factor += u64::from(size) * u64::from(size + row_count);
            let row = self.row_dofs.len() as u32;
            for n in &self.rows[g] {
                self.row_dofs.extend(self.dof[*n as usize]..self.dof[*n as usize + 1]);
            }
            self.groups[self.place[g] as usize] = Group {
                dof: self.dof[self.nodes[g].start as usize],
                size,
                row,
                row_count,
                front,
                node: self.nodes[g].start,
                node_end: self.nodes[g].end,
            };
        }
    }

    /// Groups and tiles of all levels, in runs, as they are worked on.
    pub fn runs(&self) -> impl Iterator<Item = &Range<u32>> {
        self.levels.iter().zip(&self.changes.levels).flat_map(|(groups, level)| {
            let groups = groups.iter().chain(&level.below).map(|(_, range)| range);
            groups.chain(level.later.iter().map(|(_, range)| range))
        })
    }

    /// Row in the front of a group of each node that has one.
    pub fn fronts(&self, g: usize) -> BTreeMap<u32, u32> {
        let mut row = 0;
        let place = |n: u32| {
            let first = row;
            row += self.size(n);
            (n, first)
        };
        self.nodes[g].clone().chain(self.rows[g].iter().copied()).map(place).collect()
    }

    /// For each node where in the handed-on numbers its own begin, group by group before it.
    pub fn incoming(&self) -> Vec<Vec<u32>> {
        let mut incoming = vec![Vec::new(); self.old.len()];
        for g in 0..self.nodes.len() {
            let mut at = self.groups[self.place[g] as usize].row;
            for n in &self.rows[g] {
                incoming[*n as usize].push(at);
                at += self.size(*n);
            }
        }
        incoming
    }
}

/// Workgroups that a dispatch may have.
const MOST_WORKGROUPS: u32 = 65_535;

/// Adds one to the last of consecutive runs, if that is of the same kind and not too long, or begins another.
pub(crate) fn add_to<K: PartialEq>(runs: &mut Vec<(K, Range<u32>)>, kind: K, place: u32) {
    match runs.last_mut() {
        Some((last, range)) if *last == kind && range.len() < MOST_WORKGROUPS as usize => {
            range.end = place + 1
        }
        _ => runs.push((kind, place..place + 1)),
    }
}

/// Groups, those cut up that a workgroup has no memory for.
fn small(model: &Model, groups: Vec<Vec<u32>>) -> Vec<Vec<u32>> {
    let size = |n: u32| (model.start[n as usize + 1] - model.start[n as usize]) as usize;
    let mut small: Vec<Vec<u32>> = Vec::new();
    for group in groups {
        let (mut part, mut unknowns) = (Vec::new(), 0);
        for n in group {
            if unknowns + size(n) > MOST_GROUP {
                small.push(std::mem::take(&mut part));
                unknowns = 0;
            }
            unknowns += size(n);
            part.push(n);
        }
        small.push(part);
    }
    small
}
