//! Where the entries of the incomplete factor are, and in which order workgroups may make them.
//!
//! # Theory
//! The factorisation is that of `solver/factor.rs`: groups of two courses of a wale, eliminated row by row, rows handed on
//! once (IC(1)). A group may be eliminated as soon as all groups are that it takes something from; all those with the same
//! *level*, the longest chain of such groups before it, go at once. A piece of w × h stitches has some w + 1.5 h levels.
//!
//! # Practice
//! Chunks are runs of groups whose matrix and factor fit into one binding each. A group takes from its own chunk and the one
//! before; rows further on are left out, which costs accuracy of the factor and nothing else.

use super::layout::{Group, MOST_GROUP, NONE, RIGID, Source};
use crate::model::Model;
use crate::solver::groups::groups;
use std::collections::BTreeMap;
use std::ops::Range;

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
    place: Vec<u32>,
    pub sources: Vec<Source>,
    pub shared_rows: Vec<u32>,
    /// Unknowns of all rows.
    pub row_dofs: Vec<u32>,
    pub handed_count: u32,
    /// Of each level the chunks that have groups in it, with the records.
    pub levels: Vec<Vec<(usize, Range<u32>)>>,
    /// Numbers in the factor of each chunk.
    pub factor_counts: Vec<u64>,
}

impl Pattern {
    /// The pattern for `model`, with no more than `most` numbers of matrix and of factor in a chunk. `widths` are the columns in
    /// the rows of each node of the model.
    pub fn new(model: &Model, widths: &[u32], most: u64) -> Self {
        let members = small_groups(model);
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
        let mut pattern = Self {
            old,
            new,
            dof,
            nodes,
            rows: Vec::new(),
            chunk_of: Vec::new(),
            group_of,
            groups: Vec::new(),
            place: Vec::new(),
            sources: Vec::new(),
            shared_rows: Vec::new(),
            row_dofs: Vec::new(),
            handed_count: 0,
            levels: Vec::new(),
            factor_counts: Vec::new(),
        };
        pattern.join_rows(model);
        pattern.cut_into_chunks(widths, most);
        pattern.schedule();
        pattern.lay_out();
        pattern
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

    /// The rows of each group, handed on once.
    fn join_rows(&mut self, model: &Model) {
        let mut rows: Vec<Vec<u32>> = vec![Vec::new(); self.nodes.len()];
        for (a, neighbours) in model.neighbours.iter().enumerate() {
            for b in neighbours {
                let (a, b) = (self.new[a], self.new[*b as usize]);
                let (lower, upper) = (a.min(b), a.max(b));
                if self.group_of[lower as usize] < self.group_of[upper as usize] {
                    rows[self.group_of[lower as usize] as usize].push(upper);
                }
            }
        }
        let tidy = |rows: &mut Vec<Vec<u32>>| {
            for row in rows {
                row.sort_unstable();
                row.dedup();
            }
        };
        tidy(&mut rows);
        for handed_on in rows.clone() {
            for b in &handed_on {
                let group = self.group_of[*b as usize];
                let later = handed_on.iter().filter(|a| self.group_of[**a as usize] > group);
                rows[group as usize].extend(later);
            }
        }
        tidy(&mut rows);
        self.rows = rows;
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
        for (g, row) in self.rows.iter_mut().enumerate() {
            row.retain(|n| self.chunk_of[self.group_of[*n as usize] as usize] <= self.chunk_of[g] + 1);
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
            let (place, parts) = (place as u32, &mut self.levels[level]);
            match parts.last_mut() {
                Some((last, range)) if *last == chunk => range.end = place + 1,
                _ => parts.push((chunk, place..place + 1)),
            }
        }
    }

    /// Gives every group its front, its rows and its sources.
    fn lay_out(&mut self) {
        let count = self.nodes.len();
        self.groups = vec![Group::default(); count];
        self.factor_counts = vec![0; self.chunk_of.last().map_or(1, |c| *c as usize + 1)];
        let mut sources: Vec<Vec<u32>> = vec![Vec::new(); count];
        for g in 0..count {
            let (size, row_count) = (self.group_size(g), self.row_count(g));
            let factor = &mut self.factor_counts[self.chunk_of[g] as usize];
            let front = *factor as u32;
            *factor += u64::from(size) * u64::from(size + row_count);
            let row = self.row_dofs.len() as u32;
            for n in &self.rows[g] {
                self.row_dofs.extend(self.dof[*n as usize]..self.dof[*n as usize + 1]);
                let later = &mut sources[self.group_of[*n as usize] as usize];
                if later.last() != Some(&(g as u32)) {
                    later.push(g as u32);
                }
            }
            self.groups[self.place[g] as usize] = Group {
                dof: self.dof[self.nodes[g].start as usize],
                size,
                row,
                row_count,
                front,
                handed: row,
                node: self.nodes[g].start,
                node_end: self.nodes[g].end,
                source: 0,
                source_end: 0,
            };
        }
        self.handed_count = self.row_dofs.len() as u32;
        for (g, from) in sources.iter().enumerate() {
            let first = self.sources.len() as u32;
            let fronts = self.fronts(g);
            for h in from {
                let start = self.shared_rows.len() as u32;
                let (mut row, mut columns) = (0, 0);
                for n in &self.rows[*h as usize] {
                    let size = self.size(*n);
                    if let Some(front) = fronts.get(n) {
                        self.shared_rows.extend((0..size).map(|i| (row + i) | ((front + i) << 16)));
                        columns += if self.nodes[g].contains(n) { size } else { 0 };
                    }
                    row += size;
                }
                let count = self.shared_rows.len() as u32 - start;
                let before = u32::from(self.chunk_of[*h as usize] != self.chunk_of[g]);
                self.sources.push(Source {
                    group: self.place[*h as usize],
                    before,
                    first: start,
                    count,
                    columns,
                });
            }
            let group = &mut self.groups[self.place[g] as usize];
            (group.source, group.source_end) = (first, self.sources.len() as u32);
        }
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
            let mut at = self.groups[self.place[g] as usize].handed;
            for n in &self.rows[g] {
                incoming[*n as usize].push(at);
                at += self.size(*n);
            }
        }
        incoming
    }

    /// Row of `other` in the front of the group of `node`, or NONE.
    pub fn front_of(&self, fronts: &BTreeMap<u32, u32>, other: u32) -> u32 {
        fronts.get(&other).copied().unwrap_or(NONE)
    }
}

/// The groups of the CPU's factorisation, those cut up that a workgroup has no memory for.
fn small_groups(model: &Model) -> Vec<Vec<u32>> {
    let size = |n: u32| (model.start[n as usize + 1] - model.start[n as usize]) as usize;
    let mut small: Vec<Vec<u32>> = Vec::new();
    for group in groups(model) {
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
