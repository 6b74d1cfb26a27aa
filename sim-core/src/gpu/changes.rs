//! What the elimination of groups does to the fronts of later ones, as workgroups do it.
//!
//! # Theory
//! A group with the rows Q below its diagonal block takes Q Qᵀ away from later fronts. Groups of a level do so as soon as they are
//! eliminated: then there is most to be done at once, where a front that fetches everything when its turn comes leaves the last ones, those of the
//! largest separators, to a few workgroups. WGSL has no portable float atomics, so a workgroup has a *tile*, some rows of one front, and takes what
//! all sources of the level have for it one after the other.

use super::constants::TILE;
use super::layout::{Group, Source, Tile};
use super::pattern::{Pattern, add_to};
use std::ops::Range;

/// Dispatches of the levels, and what they work on.
#[derive(Default)]
pub(crate) struct Changes {
    pub tiles: Vec<Tile>,
    pub sources: Vec<Source>,
    /// Of each row that two fronts share, by the chunk of the later one: its place in the rows of the source (low half), and in the later front.
    pub shared_rows: Vec<Vec<u32>>,
    pub levels: Vec<Level>,
}

/// What a level does after its diagonal blocks have been factorised.
#[derive(Default)]
pub(crate) struct Level {
    /// Tiles of the rows below them, chunk by chunk.
    pub below: Vec<(usize, Range<u32>)>,
    /// Tiles of later fronts; of each run the chunks of sources and fronts.
    pub later: Vec<([usize; 2], Range<u32>)>,
    /// Operations of all of it, the diagonal blocks included.
    pub operations: u64,
}

/// What the elimination of a group takes, a multiplication and an addition being two: C⁻¹, Q, and half of Q Qᵀ.
fn operations(group: &Group) -> u64 {
    let (n, m) = (u64::from(group.size), u64::from(group.row_count));
    2 * (n * n * n / 3 + n * n * m + n * m * m / 2)
}

/// A tile of a front that a source changes: the chunks of both, the group and the number of the tile in its front.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Place {
    chunks: [usize; 2],
    group: u32,
    tile: u32,
}

/// What one source does to one tile.
type Change = (Place, Source);

impl Changes {
    /// What the groups of a pattern do, which has everything else.
    pub fn new(pattern: &Pattern) -> Self {
        let shared_rows = vec![Vec::new(); pattern.factor_counts.len()];
        let mut changes = Self { shared_rows, ..Self::default() };
        // Groups by their places.
        let mut group_at = vec![0; pattern.place.len()];
        pattern.place.iter().enumerate().for_each(|(g, place)| group_at[*place as usize] = g);
        for runs in &pattern.levels {
            let mut level = Level::default();
            let mut changed = Vec::new();
            for (chunk, range) in runs {
                for place in range.clone() {
                    level.operations += operations(&pattern.groups[place as usize]);
                    changes.divide(pattern, *chunk, place, &mut level);
                    changes.share(pattern, group_at[place as usize], &mut changed);
                }
            }
            changed.sort_by_key(|(place, _)| *place);
            for of_tile in changed.chunk_by(|(a, _), (b, _)| a == b) {
                let Place { chunks, group, .. } = of_tile[0].0;
                add_to(&mut level.later, chunks, changes.tiles.len() as u32);
                let source = changes.sources.len() as u32;
                changes.sources.extend(of_tile.iter().map(|(_, source)| *source));
                let source_end = changes.sources.len() as u32;
                changes.tiles.push(Tile { group, source, source_end, ..Tile::default() });
            }
            changes.levels.push(level);
        }
        changes
    }

    /// Adds the tiles below the diagonal block of a group.
    fn divide(&mut self, pattern: &Pattern, chunk: usize, place: u32, level: &mut Level) {
        let group = &pattern.groups[place as usize];
        let height = group.size + group.row_count;
        for row in (group.size..height).step_by(TILE as usize) {
            add_to(&mut level.below, chunk, self.tiles.len() as u32);
            let row_count = TILE.min(height - row);
            self.tiles.push(Tile { group: place, row, row_count, ..Tile::default() });
        }
    }

    /// Adds what the elimination of group `g` does to each later front, tile by tile.
    fn share(&mut self, pattern: &Pattern, g: usize, changed: &mut Vec<Change>) {
        let from = pattern.place[g];
        let dofs_of = |place: u32| {
            let group = &pattern.groups[place as usize];
            &pattern.row_dofs[group.row as usize..][..group.row_count as usize]
        };
        let rows = dofs_of(from);
        let mut at = 0;
        for own in
            pattern.rows[g].chunk_by(|a, b| pattern.group_of[*a as usize] == pattern.group_of[*b as usize])
        {
            let later = pattern.group_of[own[0] as usize] as usize;
            let to = pattern.place[later];
            let columns: u32 = own.iter().map(|n| pattern.size(*n)).sum();
            let front = &pattern.groups[to as usize];
            let chunks = [g, later].map(|g| pattern.chunk_of[g] as usize);
            let shared_rows = &mut self.shared_rows[chunks[1]];
            let first = shared_rows.len() as u32;
            let mut others = dofs_of(to).iter().zip(front.size..).peekable();
            for (row, dof) in (at..).zip(&rows[at as usize..]) {
                while others.next_if(|(other, _)| *other < dof).is_some() {}
                let place = match others.peek() {
                    _ if *dof < front.dof + front.size => dof - front.dof,
                    Some((other, place)) if *other == dof => *place,
                    _ => continue,
                };
                shared_rows.push(row | place << 16);
            }
            let elsewhere = u32::from(chunks[0] != chunks[1]);
            let mut row = first;
            for tile in shared_rows[first as usize..].chunk_by(|a, b| (a >> 16) / TILE == (b >> 16) / TILE) {
                let row_count = tile.len() as u32;
                let source =
                    Source { group: from, elsewhere, column: first, column_count: columns, row, row_count };
                changed.push((Place { chunks, group: to, tile: (tile[0] >> 16) / TILE }, source));
                row += row_count;
            }
            at += columns;
        }
    }
}
