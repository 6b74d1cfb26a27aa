//! Knitting charts as knitters draw them: squares with symbols, row by row, as seen from the right side.
//!
//! A cell is as wide as the loops it makes, so a decrease takes one square and an increase as many as it makes; a stitch with
//! yarn-overs beside it is shown as its parts. Rows with fewer squares than the widest are filled up with "no stitch"
//! squares, so that what is knitted into a loop stands above it; see `grid`.
//!
//! Squares of dyed yarn have its colour.
//!
//! What a symbol looks like is in [`glyph`]; a drawing is a list of marks ([`mark`]), which become SVG, pixels, or the
//! shapes of a window.

pub mod glyph;
mod grid;
mod lettering;
pub mod mark;
pub mod raster;
mod repeat;
pub mod sheet;
pub mod svg;

use grid::Piece;
pub use repeat::Repeat;
use std::collections::{BTreeSet, HashMap};
use std::ops::Range;
use stitch_mesh::cable::Cable;
use stitch_mesh::dye::Dye;
use stitch_mesh::ids::{EdgeId, FaceId};
use stitch_mesh::label::Row;
use stitch_mesh::stitch::{Make, Op, Stitch};
use stitch_mesh::stitch_mesh::StitchMesh;

/// A row of a fabric, or a part of one, that is to be charted.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Course {
    /// Its number in the fabric; knitters count from 1.
    pub number: usize,
    /// Whether it goes round, so that every row is a right-side row.
    pub closed: bool,
    /// Its faces, left to right.
    pub faces: Vec<FaceId>,
}

/// One cell of a chart.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Cell {
    /// What is knitted, on its own; none where there is no stitch.
    pub stitch: Option<Stitch>,
    /// Its columns, from 0 on the left.
    pub columns: Range<usize>,
    /// The face it is knitted in.
    pub face: Option<FaceId>,
    /// The colour of its yarn.
    pub dye: Dye,
}

/// One row of a chart.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct DiagramRow {
    /// Its number in the fabric, from 1.
    pub number: usize,
    /// Whether the number stands on the right, where right-side rows begin.
    pub right_side: bool,
    /// Its cells, left to right; they fill all columns.
    pub cells: Vec<Cell>,
}

/// A cable, drawn over the row that its loops are knitted into.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Crossing {
    /// The row, from 0 at the bottom.
    pub row: usize,
    /// Its columns.
    pub columns: Range<usize>,
    /// Loops of each strand, left to right below.
    pub strands: Vec<u8>,
    /// Strands left to right above.
    pub order: Vec<u8>,
    /// Strands front to back.
    pub front: Vec<u8>,
    /// Which strands are purled.
    pub purled: Vec<bool>,
}

/// A knitting chart. See the module.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Diagram {
    /// Number of columns.
    pub columns: usize,
    /// Its rows, the lowest first.
    pub rows: Vec<DiagramRow>,
    /// Its cables.
    pub crossings: Vec<Crossing>,
    /// What repeats, if something does.
    pub repeat: Option<Repeat>,
    /// Squares of the widest row and number of rows, with what was left out.
    pub whole: [usize; 2],
}

impl Course {
    /// All rows of a fabric, as [`StitchMesh::rows`] gives them: the lowest first. A row has the number after that of the
    /// highest row below it, so pieces that are knitted beside each other count their rows alike.
    pub fn all(stitches: &StitchMesh, rows: &[Row]) -> Vec<Self> {
        let mut number_of = vec![0; stitches.mesh().face_count()];
        let course = |row: &Row| {
            let below = row.faces.iter().flat_map(|f| stitches.below(*f)).map(|f| number_of[f.index()]);
            let number = 1 + below.max().unwrap_or(0);
            row.faces.iter().for_each(|f| number_of[f.index()] = number);
            Self { number, closed: row.closed, faces: row.faces.clone() }
        };
        rows.iter().map(course).collect()
    }

    /// The lowest row and the rows above it, one above the other; what is knitted beside them (sleeves, or the second of two
    /// pieces) has charts of its own.
    pub fn piece(stitches: &StitchMesh, rows: &[Row]) -> Vec<Self> {
        let mut piece: Vec<Self> = Vec::new();
        let mut last: BTreeSet<FaceId> = BTreeSet::new();
        for course in Self::all(stitches, rows) {
            let mut below = course.faces.iter().flat_map(|f| stitches.below(*f));
            if piece.is_empty() || below.any(|f| last.contains(&f)) {
                last = course.faces.iter().copied().collect();
                piece.push(course);
            }
        }
        piece
    }

    /// The rows that some faces lie in, cut to the columns that they reach.
    pub fn around(stitches: &StitchMesh, rows: &[Row], faces: &BTreeSet<FaceId>) -> Vec<Self> {
        let mut courses = Self::all(stitches, rows);
        courses.retain(|c| c.faces.iter().any(|f| faces.contains(f)));
        let places = |c: &Self| {
            let is_in = |f: &FaceId| faces.contains(f);
            Some([c.faces.iter().position(is_in)?, c.faces.iter().rposition(is_in)?])
        };
        let ends: Vec<[usize; 2]> = courses.iter().filter_map(places).collect();
        let from = ends.iter().map(|e| e[0]).min().unwrap_or(0);
        let to = ends.iter().map(|e| e[1]).max().unwrap_or(0);
        for course in &mut courses {
            course.faces.truncate(to + 1);
            course.faces.drain(..from.min(course.faces.len()));
        }
        courses.retain(|c| !c.faces.is_empty());
        courses
    }
}

/// A part of a face that has a cell of its own.
struct Part {
    stitch: Stitch,
    face: FaceId,
    dye: Dye,
    below: Vec<EdgeId>,
    above: Vec<EdgeId>,
}

impl Part {
    fn width(&self) -> usize {
        self.above.len().max(1)
    }

    /// How far right of its first column the loops that it is knitted into belong.
    fn middle(&self) -> i64 {
        (self.width() as i64 - 1) / 2
    }

    /// The loop in front.
    fn front(&self) -> usize {
        self.stitch.stack.first().map_or(0, |b| usize::from(*b))
    }
}

/// What a stitch is drawn as: a stitch with yarn-overs beside it is that stitch and the yarn-overs, anything else is itself.
/// Each part comes with the tops that it makes.
fn split(stitch: &Stitch) -> Vec<(Stitch, Range<usize>)> {
    let is_over = |op: &&Op| op.make == Make::YarnOver;
    let overs = stitch.ops.iter().filter(is_over).count();
    // Knitted several times into one loop is one symbol, whatever goes over the needle in between.
    let held = stitch.ops.len() - overs;
    if overs == 0 || stitch.ops.len() == 1 || (held != 1 && stitch.bottoms() > 0) {
        return vec![(stitch.clone(), 0..stitch.tops())];
    }
    let part = |(i, op): (usize, &Op)| {
        let stack = if is_over(&op) { Default::default() } else { stitch.stack.clone() };
        (Stitch { ops: std::iter::once(*op).collect(), stack }, i..i + 1)
    };
    stitch.ops.iter().enumerate().map(part).collect()
}

fn parts(stitches: &StitchMesh, face: FaceId) -> impl Iterator<Item = Part> {
    let mesh = stitches.mesh();
    let below: Vec<EdgeId> = stitches.bottoms(face).map(|h| mesh.edge(h)).collect();
    let above: Vec<EdgeId> = stitches.tops(face).map(|h| mesh.edge(h)).collect();
    let dye = stitches.dyes()[face.index()];
    split(stitches.stitch(face)).into_iter().map(move |(stitch, tops)| Part {
        face,
        dye,
        below: below[..stitch.bottoms()].to_vec(),
        above: above[tops].to_vec(),
        stitch,
    })
}

impl Diagram {
    /// Charts some rows of a fabric; of what is larger than `most` columns and rows, the stitches on the left and the lowest
    /// rows.
    pub fn of(stitches: &StitchMesh, courses: &[Course], most: [usize; 2]) -> Self {
        let wide = |row: &[Part]| row.iter().map(Part::width).sum::<usize>();
        let mut whole = [0, courses.len()];
        let mut rows: Vec<Vec<Part>> = Vec::new();
        for course in courses.iter().take(most[1]) {
            let mut row: Vec<Part> = course.faces.iter().flat_map(|f| parts(stitches, *f)).collect();
            whole[0] = whole[0].max(wide(&row));
            while wide(&row) > most[0] {
                row.pop();
            }
            rows.push(row);
        }
        let columns = rows.iter().map(|row| wide(row)).max().unwrap_or(0);
        let places = places(&rows, columns);
        let of_row = |((course, parts), first): ((&Course, &Vec<Part>), &Vec<usize>)| DiagramRow {
            number: course.number,
            right_side: course.closed || course.number % 2 == 1,
            cells: cells(parts, first, columns),
        };
        let mut diagram = Self {
            columns,
            rows: courses.iter().zip(&rows).zip(&places).map(of_row).collect(),
            crossings: crossings(stitches, &rows, &places),
            repeat: None,
            whole,
        };
        diagram.repeat = Repeat::of(&diagram);
        diagram
    }

    /// What has been left out, in words.
    pub fn left_out(&self) -> Option<String> {
        let shown = [self.columns, self.rows.len()];
        let of = |i: usize, what| {
            (shown[i] < self.whole[i]).then(|| format!("the first {} of {} {what}", shown[i], self.whole[i]))
        };
        let told: Vec<String> = [of(0, "stitches"), of(1, "rows")].into_iter().flatten().collect();
        (!told.is_empty()).then(|| told.join(", "))
    }
}

/// The first column of every part. The widest row has no choice; from there the rows find their places up and down, each
/// from its neighbour.
fn places(rows: &[Vec<Part>], columns: usize) -> Vec<Vec<usize>> {
    let wide = |row: &Vec<Part>| row.iter().map(Part::width).sum::<usize>();
    let Some(widest) = rows.iter().position(|row| wide(row) == columns) else { return Vec::new() };
    let mut places = vec![Vec::new(); rows.len()];
    let free = |part: &Part| Piece { width: part.width(), wants: Vec::new() };
    places[widest] = grid::place(&rows[widest].iter().map(free).collect::<Vec<_>>(), columns);
    for r in widest + 1..rows.len() {
        let mut loops = HashMap::new();
        for (part, first) in rows[r - 1].iter().zip(&places[r - 1]) {
            loops.extend(part.above.iter().copied().zip(*first as i64..));
        }
        let piece = |part: &Part| {
            let over = part.below.get(part.front()).and_then(|edge| loops.get(edge));
            let wants = over.map(|column| column - part.middle()).into_iter().collect();
            Piece { width: part.width(), wants }
        };
        places[r] = grid::place(&rows[r].iter().map(piece).collect::<Vec<_>>(), columns);
    }
    for r in (0..widest).rev() {
        let mut loops = HashMap::new();
        for (part, first) in rows[r + 1].iter().zip(&places[r + 1]) {
            let begin = *first as i64 + part.middle() - part.front() as i64;
            loops.extend(part.below.iter().copied().zip(begin..));
        }
        let piece = |part: &Part| {
            let under = (0..).zip(&part.above).filter_map(|(i, edge)| loops.get(edge).map(|c| c - i));
            Piece { width: part.width(), wants: under.collect() }
        };
        places[r] = grid::place(&rows[r].iter().map(piece).collect::<Vec<_>>(), columns);
    }
    places
}

/// The cells of a row, with "no stitch" where nothing stands.
fn cells(parts: &[Part], first: &[usize], columns: usize) -> Vec<Cell> {
    let nothing = |c: usize| Cell { stitch: None, columns: c..c + 1, face: None, dye: Dye::UNDYED };
    let mut cells = Vec::new();
    let mut end = 0;
    for (part, first) in parts.iter().zip(first) {
        cells.extend((end..*first).map(nothing));
        end = first + part.width();
        let Part { stitch, face, dye, .. } = part;
        cells.push(Cell { stitch: Some(stitch.clone()), columns: *first..end, face: Some(*face), dye: *dye });
    }
    cells.extend((end..columns).map(nothing));
    cells
}

/// The cables that lie in the chart as a whole.
fn crossings(stitches: &StitchMesh, rows: &[Vec<Part>], places: &[Vec<usize>]) -> Vec<Crossing> {
    if stitches.cables().is_empty() {
        return Vec::new();
    }
    let mut over = HashMap::new();
    for (r, (row, places)) in rows.iter().zip(places).enumerate() {
        for (part, first) in row.iter().zip(places) {
            over.extend(part.below.iter().map(|edge| (*edge, (r, *first, part))));
        }
    }
    let crossing = |cable: &Cable| {
        let edge = |ends: &[_]| stitches.mesh().edge_between(ends[0], ends[1]);
        let find = |ends: &[_]| over.get(&edge(ends)?).copied();
        let found: Vec<(usize, usize, &Part)> = cable.path.windows(2).map(find).collect::<Option<_>>()?;
        let from = found.iter().map(|f| f.1).min()?;
        let to = found.iter().map(|f| f.1 + f.2.width()).max()?;
        let purled = |strand: usize| {
            let loops_before: usize = cable.strands[..strand].iter().map(|n| usize::from(*n)).sum();
            let (place, _) = cable.crossing()[loops_before];
            found[place].2.stitch.ops.first().is_some_and(|op| op.make == Make::Purl)
        };
        Some(Crossing {
            row: found[0].0,
            columns: from..to,
            strands: cable.strands.clone(),
            order: cable.order.clone(),
            front: cable.front.clone(),
            purled: (0..cable.strands.len()).map(purled).collect(),
        })
    };
    stitches.cables().iter().filter_map(crossing).collect()
}

#[cfg(test)]
mod tests;
