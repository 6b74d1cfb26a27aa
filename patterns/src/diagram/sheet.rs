//! A chart as a drawing: squares, symbols, row numbers, the box around a repeat; and the sheet that is written to files, with
//! a legend below.

use super::mark::{Ink, Mark, Paint, Point, rectangle};
use super::{Cell, Crossing, Diagram, DiagramRow, glyph, lettering};
use std::collections::BTreeSet;
use stitch_mesh::dye::Dye;
use stitch_mesh::stitch::{Make, Stitch};

/// Room for row numbers on both sides, and above and below the squares [squares].
const ROOM: [f32; 2] = [1.8, 0.4];
/// Height of letters and digits [squares].
const LETTER: f32 = 0.42;

/// A drawing.
#[derive(Clone, Debug, PartialEq)]
pub struct Sheet {
    /// Width and height [squares].
    pub size: [f32; 2],
    /// What is drawn, the first under the others.
    pub marks: Vec<Mark>,
}

/// A line of the legend.
struct Entry {
    wide: usize,
    marks: Vec<Mark>,
    ink: Ink,
    name: String,
}

/// An empty square; the paper is white already.
fn square(at: Point, wide: usize, ink: Ink) -> impl Iterator<Item = Mark> {
    let outline = rectangle(at, [wide as f32, 1.0]);
    let line = Mark { points: outline.to_vec(), paint: Paint::Line(Ink::Grid, 0.035) };
    let area = (ink != Ink::White).then(|| Mark::area(outline[..4].iter().copied(), ink));
    area.into_iter().chain([line])
}

impl Cell {
    /// What its squares are filled with.
    fn ink(&self) -> Ink {
        match (&self.stitch, self.dye) {
            (None, _) => Ink::Grey,
            (Some(_), Dye::UNDYED) => Ink::White,
            (Some(_), Dye(rgb)) => Ink::Yarn(rgb),
        }
    }
}

impl Diagram {
    /// Width and height of the chart with its row numbers [squares].
    pub fn size(&self) -> [f32; 2] {
        [self.columns as f32 + 2.0 * ROOM[0], self.rows.len() as f32 + 2.0 * ROOM[1]]
    }

    /// The upper left corner of a square.
    pub fn corner(&self, row: usize, column: usize) -> Point {
        [ROOM[0] + column as f32, ROOM[1] + (self.rows.len() - 1 - row) as f32]
    }

    /// All cells, with the row that each is in.
    pub fn cells(&self) -> impl Iterator<Item = (usize, &Cell)> {
        self.rows.iter().enumerate().flat_map(|(r, row)| row.cells.iter().map(move |cell| (r, cell)))
    }

    /// The cell at a place of the drawing.
    pub fn cell_at(&self, [x, y]: Point) -> Option<&Cell> {
        let (x, y) = ((x - ROOM[0]).floor(), (y - ROOM[1]).floor());
        if x < 0.0 || y < 0.0 {
            return None;
        }
        let row = self.rows.len().checked_sub(1 + y as usize)?;
        self.rows[row].cells.iter().find(|c| c.columns.contains(&(x as usize)))
    }

    /// The chart as a drawing, without a legend.
    pub fn marks(&self) -> Vec<Mark> {
        let mut marks = Vec::new();
        for (r, row) in self.rows.iter().enumerate() {
            for cell in &row.cells {
                let at = self.corner(r, cell.columns.start);
                let ink = cell.ink();
                marks.extend(square(at, cell.columns.len(), ink));
                let symbol = cell.stitch.as_ref().map(glyph::of).unwrap_or_default();
                marks.extend(symbol.into_iter().map(|m| m.moved(at).on(ink)));
            }
            marks.extend(self.number(r, row));
        }
        for crossing in &self.crossings {
            let at = self.corner(crossing.row, crossing.columns.start);
            let under =
                self.rows[crossing.row].cells.iter().find(|c| c.columns.start == crossing.columns.start);
            let ink = under.map_or(Ink::White, Cell::ink);
            marks.extend(glyph::of_crossing(crossing).into_iter().map(|m| m.moved(at).on(ink)));
            let frame = rectangle(at, [crossing.columns.len() as f32, 1.0]);
            marks.push(Mark { points: frame.to_vec(), paint: Paint::Line(Ink::Grid, 0.035) });
        }
        if let Some(repeat) = &self.repeat {
            let at = self.corner(repeat.rows.end - 1, repeat.columns.start);
            let size = [repeat.columns.len() as f32, repeat.rows.len() as f32];
            let points = rectangle(at, size).to_vec();
            marks.push(Mark { points, paint: Paint::Line(Ink::Red, 0.13) });
        }
        marks
    }

    /// The number of a row, on the side where it begins.
    fn number(&self, r: usize, row: &DiagramRow) -> Vec<Mark> {
        /// Between number and squares.
        const GAP: f32 = 0.3;
        let number = row.number.to_string();
        let [_, top] = self.corner(r, 0);
        let x = if row.right_side {
            ROOM[0] + self.columns as f32 + GAP
        } else {
            ROOM[0] - GAP - lettering::width(&number, LETTER)
        };
        lettering::write(&number, [x, top + (1.0 + LETTER) / 2.0], LETTER)
    }

    /// What the symbols mean, in the order in which they come.
    fn legend(&self) -> Vec<Entry> {
        let mut entries: Vec<Entry> = Vec::new();
        let mut add = |entry: Entry| {
            if entries.iter().all(|e| e.name != entry.name) {
                entries.push(entry);
            }
        };
        let mut seen: BTreeSet<String> = BTreeSet::new();
        for (_, cell) in self.cells() {
            let Some(stitch) = &cell.stitch else { continue };
            if seen.insert(stitch.to_string()) {
                let (wide, marks) = (cell.columns.len(), glyph::of(stitch));
                add(Entry { wide, marks, ink: Ink::White, name: name(stitch) });
            }
        }
        for crossing in &self.crossings {
            let (wide, marks) = (crossing.columns.len(), glyph::of_crossing(crossing));
            add(Entry { wide, marks, ink: Ink::White, name: crossing.name() });
        }
        let stitches = self.cells().filter(|(_, cell)| cell.stitch.is_some());
        let dyes: BTreeSet<Dye> = stitches.map(|(_, cell)| cell.dye).collect();
        if dyes.iter().any(|dye| *dye != Dye::UNDYED) {
            for dye in dyes {
                let ink = if dye == Dye::UNDYED { Ink::White } else { Ink::Yarn(dye.0) };
                let name = if dye == Dye::UNDYED { "undyed yarn".into() } else { format!("yarn {dye}") };
                add(Entry { wide: 1, marks: Vec::new(), ink, name });
            }
        }
        if self.cells().any(|(_, c)| c.stitch.is_none()) {
            add(Entry { wide: 1, marks: Vec::new(), ink: Ink::Grey, name: "no stitch".into() });
        }
        entries
    }

    /// The chart with its legend.
    pub fn sheet(&self) -> Sheet {
        /// From one line of the legend to the next, and between symbol and name.
        const STEP: f32 = 1.35;
        const GAP: f32 = 0.5;
        let [mut wide, mut high] = self.size();
        let mut marks = self.marks();
        let legend = self.legend();
        let symbols = legend.iter().map(|e| e.wide).max().unwrap_or(0) as f32;
        high += 0.4;
        for entry in legend {
            let at = [ROOM[0], high];
            marks.extend(square(at, entry.wide, entry.ink));
            marks.extend(entry.marks.into_iter().map(|m| m.moved(at)));
            let x = ROOM[0] + symbols + GAP;
            marks.extend(lettering::write(&entry.name, [x, high + (1.0 + LETTER) / 2.0], LETTER));
            wide = wide.max(x + lettering::width(&entry.name, LETTER) + GAP);
            high += STEP;
        }
        Sheet { size: [wide, high + 0.1], marks }
    }
}

/// What a stitch is called beside its symbol: abbreviation and words.
pub fn name(stitch: &Stitch) -> String {
    let (short, words) = (stitch.abbreviation(), stitch.description());
    let made_one = |op: &stitch_mesh::stitch::Op| op.make == Make::YarnOver && op.twist != 0;
    match &stitch.ops[..] {
        [op] if stitch.bottoms() == 0 && made_one(op) => {
            format!("m1{}: make one, a twisted yarn-over", if op.twist > 0 { "r" } else { "l" })
        }
        _ if short == words => words,
        _ => format!("{short}: {words}"),
    }
}

impl Crossing {
    /// What it is called: as knitters say where two strands cross, "3 over 2, to the left".
    pub fn name(&self) -> String {
        let purled = if self.purled.contains(&true) { ", purled behind" } else { "" };
        match (&self.strands[..], &self.order[..], &self.front[..]) {
            ([left, right], [1, 0], [1, _]) => format!("cable: {right} over {left}, to the left{purled}"),
            ([left, right], [1, 0], _) => format!("cable: {left} over {right}, to the right{purled}"),
            (strands, ..) => {
                let sizes: Vec<String> = strands.iter().map(u8::to_string).collect();
                format!("cable of {} strands: {}{purled}", strands.len(), sizes.join(" + "))
            }
        }
    }
}
