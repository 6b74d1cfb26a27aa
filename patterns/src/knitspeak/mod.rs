//! KnitSpeak: knitting patterns in the words of knitters, as Stitch-Maps publishes them.
//!
//! ```text
//! pattern   = statement+            each ends with a full stop; capitals do not matter; # begins a comment
//! statement = (Row | Rows | Round | Rounds | Rnd) ids [(RS) | (WS)] ":" items [ "(" count ")" ]
//!           | Repeat (rows | rounds) ids [N times]
//!           | Cast on count
//! ids       = n | n-m, lists with "," and "and"
//! items     = item, item, …
//! item      = "*" items ", repeat from *" [to end | to last N sts]
//!           | "[" items "]" (once | twice | N times) | "(" items ")" in next st
//!           | stitch | k5 | Knit | Purl [to end | to last N sts] | BO n sts | CO n sts | 3/2 RC
//! ```
//!
//! # Theory
//! The text is cut into tokens (`lex`), sentences (`parse`), items (`items`) and amounts (`amounts`), and names are
//! looked up (`vocabulary`, `cable`). `order` puts the rows into the order in which they are worked, `measure` counts
//! the loops that each works and makes, `solve` finds the cast-ons that fit, and `work` works the rows. A wrong-side row is
//! read as it is worked and turned over stitch by stitch (`term`), so that what comes out is always the fabric as seen from
//! the front. [`write()`] is the way back.
//!
//! # Practice
//! Sides alternate; the first row that names its side settles them, and without one odd rows are on the right side. `BO n sts`
//! works n + 1 loops: a stitch has to be worked to pass the last one over, and it counts as worked then, not as the first of
//! what follows. Only where a row ends with it and no more than n stitches are left ("to last 3 sts, BO 3 sts") is the last one
//! fastened off. `repeat from * 3 times` works the group once and then three times more. "K1, p1 to end" repeats all that the
//! row has said so far, unless something is open or bound off in it.

mod amounts;
mod cable;
mod error;
mod grammar;
mod items;
mod lex;
mod measure;
mod order;
mod parse;
mod solve;
mod syntax;
mod term;
mod vocabulary;
mod work;
mod write;

#[cfg(test)]
mod tests;

pub use error::{KnitSpeakError, Warning};
pub use syntax::Side;
pub use term::{Crossing, Work};
pub use work::{Step, Worked, WorkedRow};
pub use write::write;

pub(crate) use write::has_name;

use error::Lines;

pub(crate) use error::Fault;
use syntax::Statement;
use winnow::ascii::{dec_uint, space0};
use winnow::combinator::preceded;
use winnow::prelude::*;
use work::Check;

/// A pattern that has been read.
#[derive(Clone, Debug)]
pub struct Pattern {
    statements: Vec<Statement>,
    check: Option<Check>,
    /// Where comments begin that look like one and are none.
    unread_checks: Vec<usize>,
    lines: Lines,
}

/// How wide a pattern is worked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Width {
    /// With so many stitches.
    CastOn(usize),
    /// With so many passes of the first row's open group that has one. A pattern without any has only one width.
    Repeats(usize),
    /// With the number of stitches that the text gives; without one, the smallest with which every open group is worked
    /// twice, and 8 if any number does.
    AsWritten,
}

impl Pattern {
    /// Reads a pattern.
    ///
    /// # Errors
    /// Where the text is not KnitSpeak, or has rows that are missing or given twice.
    pub fn read(text: &str) -> Result<Self, KnitSpeakError> {
        let lines = Lines::new(text);
        let statements = parse::statements(&text.to_ascii_lowercase()).map_err(|fault| lines.error(fault))?;
        order::order(&statements).map_err(|fault| lines.error(fault))?;
        let (check, unread_checks) = check_lines(text);
        Ok(Self { statements, check, unread_checks, lines })
    }

    /// A fault found later, with its line and column.
    pub(crate) fn error(&self, fault: Fault) -> KnitSpeakError {
        self.lines.error(fault)
    }

    /// Works the rows.
    ///
    /// # Errors
    /// The first row that does not fit the stitches that there are; or no cast-on that fits.
    pub fn work(&self, width: Width) -> Result<Worked, KnitSpeakError> {
        work::work(self, width).map_err(|fault| self.lines.error(fault))
    }
}

/// The first comment with the writer's figures for a swatch, if there is one, and where those begin that cannot be read.
fn check_lines(text: &str) -> (Option<Check>, Vec<usize>) {
    let (mut check, mut unread) = (None, Vec::new());
    let mut at = 0;
    for line in text.split_inclusive('\n') {
        let comment = line.trim_start().strip_prefix('#').map(str::trim_start);
        match figures.parse_next(&mut line.trim_start()) {
            Ok((cast_on, rows, most)) => drop(check.get_or_insert(Check { cast_on, rows, most, at })),
            Err(_) if comment.is_some_and(|c| c.starts_with("check:")) => unread.push(at),
            Err(_) => {}
        }
        at += line.len();
    }
    (check, unread)
}

fn figures(line: &mut &str) -> winnow::Result<(usize, usize, usize)> {
    let cast_on = preceded(("#", space0, "check: cast on "), dec_uint);
    let rows = preceded(", rows ", dec_uint);
    let most = preceded(", most stitches ", dec_uint);
    (cast_on, rows, most).parse_next(line)
}
