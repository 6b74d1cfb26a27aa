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
//! rows of others. Fronts lie one after the other, column by column.

use super::dissection::dissected;
use super::groups::groups;
use super::matrix::BlockMatrix;
use super::packed::tile_count;
use super::parts::sort_into_parts;
use crate::model::Model;
use std::ops::Range;

/// Neighbouring entries of the product of a group's rows with themselves, and where they are subtracted.
pub(crate) struct Run {
    /// Place in the product, an m × m matrix stored by columns.
    pub from: u32,
    /// Place in the factor.
    pub to: u32,
    pub len: u32,
}

/// Unknowns that are eliminated at once.
pub(crate) struct Group {
    /// Its unknowns, in the order of elimination.
    pub unknowns: Range<usize>,
    /// The later unknowns that it is joined to, ascending.
    pub rows: Vec<u32>,
    /// Its front in the factor.
    pub front: Range<usize>,
    /// The same, packed.
    pub tiles: Range<usize>,
    /// What its elimination does to later fronts.
    pub runs: Vec<Run>,
}

/// Groups that can be eliminated without the other parts.
pub(crate) struct Part {
    pub groups: Range<usize>,
    pub unknowns: Range<usize>,
    pub fronts: Range<usize>,
    pub tiles: Range<usize>,
}

/// The structure of an incomplete factor.
pub(crate) struct Pattern {
    pub groups: Vec<Group>,
    /// The last is the joint: it comes after all others.
    pub parts: Vec<Part>,
    /// Place of each unknown in the order of elimination.
    pub place: Vec<u32>,
    /// Place in the factor of each entry of the matrix.
    pub target: Vec<u32>,
}

impl Pattern {
    /// Of the complete factorisation.
    pub fn complete(model: &Model, matrix: &BlockMatrix) -> Self {
        let (members, parts) = dissected(model);
        let order = Order::new(model, &members);
        let mut rows = order.rows(model);
        order.hand_on_always(&mut rows);
        Self::new(model, matrix, order, &rows, parts)
    }

    /// Of the incomplete one.
    pub fn incomplete(model: &Model, matrix: &BlockMatrix) -> Self {
        let mut members = groups(model);
        let parts = sort_into_parts(model, &mut members);
        let order = Order::new(model, &members);
        let mut rows = order.rows(model);
        order.hand_on_once(&mut rows);
        Self::new(model, matrix, order, &rows, parts)
    }

    fn new(
        model: &Model,
        matrix: &BlockMatrix,
        order: Order,
        rows: &[Vec<u32>],
        parts: Vec<Range<usize>>,
    ) -> Self {
        let mut groups: Vec<Group> = Vec::with_capacity(rows.len());
        for (g, below) in rows.iter().enumerate() {
            let rows: Vec<u32> = below.iter().flat_map(|n| order.unknowns(model, *n)).collect();
            let unknowns = order.first[g] as usize..order.first[g + 1] as usize;
            let (front, tiles) = groups.last().map_or((0, 0), |g| (g.front.end, g.tiles.end));
            let front = front..front + (unknowns.len() + rows.len()) * unknowns.len();
            let tiles = tiles..tiles + tile_count(unknowns.len(), rows.len());
            groups.push(Group { unknowns, rows, front, tiles, runs: Vec::new() });
        }
        let runs: Vec<Vec<Run>> = groups.iter().map(|group| runs(&groups, &order, &group.rows)).collect();
        groups.iter_mut().zip(runs).for_each(|(group, runs)| group.runs = runs);
        let mut target = Vec::with_capacity(matrix.row.len());
        for j in 0..matrix.dof_count() {
            for row in &matrix.row[matrix.column[j] as usize..matrix.column[j + 1] as usize] {
                let (a, b) = (order.place[j], order.place[*row as usize]);
                target.push(entry(&groups, &order, a.max(b), a.min(b)).unwrap_or_default() as u32);
            }
        }
        let part = |range: Range<usize>| {
            let end =
                |at: usize, of: &dyn Fn(&Group) -> usize| at.checked_sub(1).map_or(0, |g| of(&groups[g]));
            let within = |of: &dyn Fn(&Group) -> usize| end(range.start, of)..end(range.end, of);
            let unknowns = within(&|g| g.unknowns.end);
            let (fronts, tiles) = (within(&|g| g.front.end), within(&|g| g.tiles.end));
            Part { unknowns, fronts, tiles, groups: range }
        };
        let parts = parts.into_iter().map(part).collect();
        Self { parts, place: order.place, target, groups }
    }
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
    fn rows(&self, model: &Model) -> Vec<Vec<u32>> {
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

    fn tidy(&self, rows: &mut [Vec<u32>]) {
        for nodes in rows {
            nodes.sort_unstable_by_key(|n| self.start[*n as usize]);
            nodes.dedup();
        }
    }
}

/// Place in the factor of the entry (row, column), row ≥ column, if it has one.
fn entry(groups: &[Group], order: &Order, row: u32, column: u32) -> Option<usize> {
    let group = &groups[order.group_of_unknown[column as usize] as usize];
    let (width, (row, column)) = (group.unknowns.len(), (row as usize, column as usize));
    let below = if row < group.unknowns.end {
        row - group.unknowns.start
    } else {
        width + group.rows.binary_search(&(row as u32)).ok()?
    };
    Some(group.front.start + (column - group.unknowns.start) * (width + group.rows.len()) + below)
}

/// The entries of the product of `rows` with themselves that have a place in the factor.
fn runs(groups: &[Group], order: &Order, rows: &[u32]) -> Vec<Run> {
    let mut runs: Vec<Run> = Vec::new();
    for (j, column) in rows.iter().enumerate() {
        for (i, row) in rows.iter().enumerate().skip(j) {
            let Some(to) = entry(groups, order, *row, *column).map(|to| to as u32) else { continue };
            let from = (i + j * rows.len()) as u32;
            match runs.last_mut() {
                Some(run) if i > j && run.from + run.len == from && run.to + run.len == to => run.len += 1,
                _ => runs.push(Run { from, to, len: 1 }),
            }
        }
    }
    runs
}
