//! The pattern that is tiled, in the widths that are needed.

use super::{Layout, TileError};
use crate::knit::items_of_row;
use crate::knitspeak::{Pattern, Width, Worked, WorkedRow};
use std::collections::HashMap;
use stitch_mesh::needle::Item;

/// A pattern in all the widths that are asked for.
pub(super) struct Swatches<'p> {
    pattern: &'p Pattern,
    layout: Layout,
    /// Stitches of the narrowest swatch, and of each further repeat.
    pub narrowest: usize,
    pub repeat: usize,
    /// Rows that can be knitted from the lowest on, so that as many loops are left as there were.
    pub heights: Vec<usize>,
    known: HashMap<usize, Vec<Vec<Item>>>,
}

impl<'p> Swatches<'p> {
    pub fn new(pattern: &'p Pattern, layout: Layout) -> Result<Self, TileError> {
        // Rows that begin and end within a repeat may take two of them at least; a pattern without an open group has one width.
        let passes = (1..=3).find_map(|n| Some((n, pattern.work(Width::Repeats(n)).ok()?)));
        let (n, one) = match passes {
            Some(found) => found,
            None => (0, pattern.work(Width::AsWritten)?),
        };
        let narrowest = one.cast_on;
        let wider = pattern.work(Width::Repeats(n + 1)).map_or(0, |w| w.cast_on);
        let repeat = if wider > narrowest { wider - narrowest } else { narrowest };
        let closes = |(_, row): &(usize, &WorkedRow)| row.loops == narrowest;
        let heights: Vec<usize> = (1..).zip(&one.rows).filter(closes).map(|(i, _)| i).collect();
        let ends = one.rows.last().map_or(narrowest, |row| row.loops);
        if ends != narrowest {
            return Err(TileError::Open { begins: narrowest, ends });
        }
        let apart = matches!(layout, Layout::Alternating | Layout::HalfDrop);
        if apart && narrowest != repeat {
            return Err(TileError::Edges(narrowest % repeat));
        }
        Ok(Self { pattern, layout, narrowest, repeat, heights, known: HashMap::new() })
    }

    pub fn rows(&self) -> usize {
        self.heights.last().copied().unwrap_or(0)
    }

    /// The widest swatch of at most so many stitches.
    pub fn widest(&self, room: usize) -> Option<usize> {
        room.checked_sub(self.narrowest).map(|more| self.narrowest + more / self.repeat * self.repeat)
    }

    /// Rows of a swatch that closes around so many stitches, if the pattern does: one without edge stitches, or one whose edge
    /// stitches are those that a repeat begins with, once more.
    pub fn round(&mut self, around: usize) -> Result<Option<Vec<Vec<Item>>>, TileError> {
        let edge = self.narrowest % self.repeat;
        if !around.is_multiple_of(self.repeat) || around + edge < self.narrowest {
            return Ok(None);
        }
        let mut rows = self.swatch(around + edge)?;
        let plain = |item: &Item| matches!(item, Item::Stitch(s) if (s.bottoms(), s.tops()) == (1, 1));
        for row in &mut rows {
            let again = row.split_off(row.len() - edge.min(row.len()));
            if again.len() < edge || again != row[..edge.min(row.len())] || !again.iter().all(plain) {
                return Ok(None);
            }
        }
        Ok(Some(rows))
    }

    /// Rows of a swatch, the lowest first.
    pub fn swatch(&mut self, wide: usize) -> Result<Vec<Vec<Item>>, TileError> {
        if let Some(rows) = self.known.get(&wide) {
            return Ok(rows.clone());
        }
        let items = |worked: &Worked| -> Result<Vec<Vec<Item>>, TileError> {
            let rows = worked.rows.iter().map(items_of_row).collect::<Result<Vec<_>, _>>();
            rows.map_err(|fault| self.pattern.error(fault).into())
        };
        let mirrored = |rows: &[Vec<Item>]| -> Vec<Vec<Item>> {
            rows.iter().map(|row| row.iter().rev().map(Item::mirrored).collect()).collect()
        };
        let rows = match self.layout {
            Layout::Straight => items(&self.pattern.work(Width::CastOn(wide))?)?,
            Layout::Mirrored => mirrored(&items(&self.pattern.work(Width::CastOn(wide))?)?),
            Layout::Alternating | Layout::HalfDrop => {
                let one = items(&self.pattern.work(Width::CastOn(self.repeat))?)?;
                let mut other = one.clone();
                match self.layout {
                    Layout::Alternating => other = mirrored(&one),
                    _ => other.rotate_left(one.len() / 2),
                }
                let row = |r: usize| {
                    let tiles = (0..wide / self.repeat).map(|k| if k % 2 == 0 { &one[r] } else { &other[r] });
                    tiles.flatten().cloned().collect()
                };
                (0..one.len()).map(row).collect()
            }
        };
        self.known.insert(wide, rows.clone());
        Ok(rows)
    }
}
