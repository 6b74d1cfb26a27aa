//! What repeats in a chart.
//!
//! Stitches at both ends of the rows may be left out, up to four on a side and no more than a quarter of the columns, for
//! borders and for what makes a pattern even; of the ways to do so that leave something that repeats across, the one that leaves out least is taken. The repeat is the
//! smallest number of columns, and of rows, after which everything is the same again. It has to be there twice, and plain
//! fabric of one stitch counts for nothing.

use super::Diagram;
use std::collections::HashMap;
use std::ops::Range;
use stitch_mesh::dye::Dye;
use stitch_mesh::stitch::Stitch;

/// Columns left out on a side, at the most.
const MARGIN: usize = 4;

/// One repeat of a chart: the lowest, on the right, where knitters begin.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Repeat {
    /// Its columns.
    pub columns: Range<usize>,
    /// Its rows, from 0 at the bottom.
    pub rows: Range<usize>,
}

/// What stands in a square: a stitch and which of its squares it is, the colour of its yarn, and the same of a cable.
type Square<'a> = (Option<&'a Stitch>, usize, Dye, Option<([&'a [u8]; 3], usize)>);

/// Squares as numbers, [row][column].
fn squares(diagram: &Diagram) -> Vec<Vec<usize>> {
    let mut numbers: HashMap<Square<'_>, usize> = HashMap::new();
    let mut rows = Vec::new();
    for (r, row) in diagram.rows.iter().enumerate() {
        let mut squares = Vec::with_capacity(diagram.columns);
        for cell in &row.cells {
            for column in cell.columns.clone() {
                let crossing = diagram.crossings.iter().find(|c| c.row == r && c.columns.contains(&column));
                let crossing =
                    crossing.map(|c| ([&c.strands[..], &c.order, &c.front], column - c.columns.start));
                let square = (cell.stitch.as_ref(), column - cell.columns.start, cell.dye, crossing);
                let next = numbers.len();
                squares.push(*numbers.entry(square).or_insert(next));
            }
        }
        rows.push(squares);
    }
    rows
}

/// The smallest step after which everything is the same, if it fits in twice.
fn period(length: usize, same: impl Fn(usize, usize) -> bool) -> Option<usize> {
    (1..=length / 2).find(|step| (*step..length).all(|i| same(i - step, i)))
}

impl Repeat {
    /// The repeat of a chart.
    pub(super) fn of(diagram: &Diagram) -> Option<Self> {
        let squares = squares(diagram);
        let mut margins: Vec<[usize; 2]> =
            (0..=MARGIN).flat_map(|left| (0..=MARGIN).map(move |right| [left, right])).collect();
        margins.retain(|[left, right]| 4 * (left + right) <= diagram.columns);
        margins.sort_by_key(|[left, right]| left + right);
        let across = margins.into_iter().find_map(|[left, right]| {
            let end = diagram.columns.checked_sub(right).filter(|end| *end > left)?;
            let same = |a: usize, b: usize| squares.iter().all(|row| row[left + a] == row[left + b]);
            period(end - left, same).map(|step| (left..end, step))
        });
        let (inside, wide) = across.unwrap_or((0..diagram.columns, diagram.columns));
        let same = |a: usize, b: usize| squares[a][inside.clone()] == squares[b][inside.clone()];
        let up = period(squares.len(), same);
        let high = up.unwrap_or(squares.len());
        let twice = wide < inside.len() || up.is_some();
        (twice && wide * high > 1).then(|| Self { columns: inside.end - wide..inside.end, rows: 0..high })
    }
}
