//! Weave drafts: binary matrices, as weavers write them on point paper.
//!
//! One line for each pick, the first pick at the bottom; one cell for each end, from the left. `#` or `1` has the warp in
//! front, `.` or `0` the weft. Blanks and empty lines mean nothing, and whatever follows `//` is a comment.

use serde::{Deserialize, Serialize};
use std::fmt;
use std::str::FromStr;

/// Largest repeat of a draft.
const MOST: usize = 1000;

/// Which yarn lies in front at a crossing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cell {
    /// The warp.
    Warp,
    /// The weft.
    Weft,
}

/// The repeat of a weave.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub struct WeaveDraft {
    /// The first pick first, each from the left.
    picks: Vec<Vec<Cell>>,
}

/// A text that is no draft. Lines and columns count from 1.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum DraftError {
    /// Nothing to weave.
    #[error("the draft has no picks: write each as a line of # (warp in front) and . (weft in front)")]
    Empty,
    /// A character that is no cell.
    #[error(
        "line {line}, column {column}: '{found}' is neither # or 1 (warp in front) nor . or 0 (weft in front)"
    )]
    Character {
        /// Its line.
        line: usize,
        /// Its column.
        column: usize,
        /// The character.
        found: char,
    },
    /// A line of another length.
    #[error(
        "line {line}, column {column}: this pick crosses {cells} ends, and the one in line {first} crosses {ends}"
    )]
    Length {
        /// The line.
        line: usize,
        /// Where it ends, or where it should.
        column: usize,
        /// Its cells.
        cells: usize,
        /// The first line with cells.
        first: usize,
        /// The cells of that.
        ends: usize,
    },
    /// A repeat that is too large.
    #[error("line {line}, column {column}: a draft has at most {MOST} ends and {MOST} picks")]
    Size {
        /// The line where it becomes too large.
        line: usize,
        /// The column there.
        column: usize,
    },
    /// A pick that stays on one side.
    #[error("line {line}, column {column}: this pick lies {side} all ends, so nothing would hold it")]
    LoosePick {
        /// Its line.
        line: usize,
        /// Its first column.
        column: usize,
        /// `in front of` or `behind`.
        side: &'static str,
    },
    /// An end that stays on one side.
    #[error("line {line}, column {column}: this end lies {side} all picks, so nothing would hold it")]
    LooseEnd {
        /// The first line with cells.
        line: usize,
        /// Its column there.
        column: usize,
        /// `in front of` or `behind`.
        side: &'static str,
    },
}

impl WeaveDraft {
    /// Drafts that have a name.
    pub const NAMED: [(&'static str, &'static str); 3] = [
        ("plain", "#.\n.#"),
        ("twill", "#..#\n..##\n.##.\n##.."), // 2/2, its lines rise to the right
        ("satin", "##.##\n####.\n#.###\n###.#\n.####"), // five ends, the warp in front
    ];

    /// Which yarn lies in front where an end crosses a pick; the draft repeats.
    pub fn at(&self, end: usize, pick: usize) -> Cell {
        let row = &self.picks[pick % self.picks.len()];
        row[end % row.len()]
    }

    /// Ends and picks of the repeat.
    pub fn repeat(&self) -> [usize; 2] {
        [self.picks[0].len(), self.picks.len()]
    }
}

/// A pick as it was read: its line, its cells, and the column of each.
struct Read {
    line: usize,
    cells: Vec<Cell>,
    columns: Vec<usize>,
}

/// Where a yarn lies that never changes sides, `own` being the cell in which it is in front.
fn stays(mut cells: impl Iterator<Item = Cell>, own: Cell) -> Option<&'static str> {
    let first = cells.next()?;
    cells.all(|c| c == first).then_some(if first == own { "in front of" } else { "behind" })
}

impl FromStr for WeaveDraft {
    type Err = DraftError;

    /// Reads a draft, or the name of one.
    fn from_str(text: &str) -> Result<Self, DraftError> {
        let named = Self::NAMED.iter().find(|(name, _)| *name == text.trim());
        let text = named.map_or(text, |(_, draft)| draft);
        let mut read: Vec<Read> = Vec::new();
        for (line, content) in text.lines().enumerate().map(|(i, l)| (i + 1, l)) {
            let content = content.split_once("//").map_or(content, |(before, _)| before);
            let mut pick = Read { line, cells: Vec::new(), columns: Vec::new() };
            for (column, found) in content.chars().enumerate().map(|(i, c)| (i + 1, c)) {
                match found {
                    '#' | '1' => pick.cells.push(Cell::Warp),
                    '.' | '0' => pick.cells.push(Cell::Weft),
                    blank if blank.is_whitespace() => continue,
                    found => return Err(DraftError::Character { line, column, found }),
                }
                pick.columns.push(column);
                if pick.cells.len() > MOST || read.len() >= MOST {
                    return Err(DraftError::Size { line, column });
                }
            }
            if pick.cells.is_empty() {
                continue;
            }
            if let Some(first) = read.first()
                && first.cells.len() != pick.cells.len()
            {
                let (cells, ends) = (pick.cells.len(), first.cells.len());
                let column = if cells > ends { pick.columns[ends] } else { pick.columns[cells - 1] + 1 };
                return Err(DraftError::Length { line, column, cells, first: first.line, ends });
            }
            read.push(pick);
        }
        let first = read.first().ok_or(DraftError::Empty)?;
        for pick in &read {
            if let Some(side) = stays(pick.cells.iter().copied(), Cell::Weft) {
                return Err(DraftError::LoosePick { line: pick.line, column: pick.columns[0], side });
            }
        }
        for (end, column) in first.columns.iter().enumerate() {
            if let Some(side) = stays(read.iter().map(|p| p.cells[end]), Cell::Warp) {
                return Err(DraftError::LooseEnd { line: first.line, column: *column, side });
            }
        }
        Ok(Self { picks: read.into_iter().rev().map(|p| p.cells).collect() })
    }
}

impl fmt::Display for WeaveDraft {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, pick) in self.picks.iter().rev().enumerate() {
            if i > 0 {
                writeln!(f)?;
            }
            let cells = pick.iter().map(|c| if *c == Cell::Warp { '#' } else { '.' });
            write!(f, "{}", cells.collect::<String>())?;
        }
        Ok(())
    }
}

impl TryFrom<String> for WeaveDraft {
    type Error = DraftError;

    fn try_from(text: String) -> Result<Self, DraftError> {
        text.parse()
    }
}

impl From<WeaveDraft> for String {
    fn from(draft: WeaveDraft) -> Self {
        draft.to_string()
    }
}
