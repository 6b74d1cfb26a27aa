//! A chart: rows of stitches that repeat over a fabric (Yuksel et al. §5.3: "each line corresponds to a row of the stitch
//! mesh, and lists the stitch types on that row").
//!
//! The first line is the lowest row, stitches stand left to right as seen from the front, and the chart repeats in both
//! directions: `k k p p` is a 2 × 2 rib; `k` and `p` on two lines is garter. Only stitches that join one loop to one can be
//! charted so; faces that increase or decrease keep what they are.

use std::collections::{HashSet, VecDeque};
use std::str::FromStr;
use stitch_mesh::ids::FaceId;
use stitch_mesh::label::Row;
use stitch_mesh::stitch::{Stitch, StitchError};
use stitch_mesh::stitch_mesh::StitchMesh;

/// A repeating chart. Never empty.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Chart {
    pub(crate) rows: Vec<Vec<Stitch>>,
}

/// Why a text is not a chart.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ChartError {
    /// No rows.
    #[error("the chart is empty")]
    Empty,
    /// Not a stitch.
    #[error("line {line}: {error}")]
    Stitch {
        /// Line, from 1.
        line: usize,
        /// What is wrong.
        error: StitchError,
    },
    /// A stitch of another shape.
    #[error(
        "line {line}: '{symbol}' does not join one loop to one, so it cannot be repeated over any fabric"
    )]
    Shape {
        /// Line, from 1.
        line: usize,
        /// The stitch.
        symbol: String,
    },
}

/// Whether a stitch joins one loop to one.
fn fits_anywhere(stitch: &Stitch) -> bool {
    (stitch.bottoms(), stitch.tops()) == (1, 1) && stitch.holds()
}

impl FromStr for Chart {
    type Err = ChartError;

    /// Reads a chart; empty lines and what follows `#` are passed over.
    fn from_str(text: &str) -> Result<Self, ChartError> {
        let mut rows = Vec::new();
        for (number, line) in text.lines().enumerate() {
            let line = line.split('#').next().unwrap_or("");
            let mut row = Vec::new();
            for symbol in line.split_whitespace() {
                let line = number + 1;
                let stitch: Stitch = symbol.parse().map_err(|error| ChartError::Stitch { line, error })?;
                if !fits_anywhere(&stitch) {
                    return Err(ChartError::Shape { line, symbol: symbol.to_owned() });
                }
                row.push(stitch);
            }
            if !row.is_empty() {
                rows.push(row);
            }
        }
        if rows.is_empty() { Err(ChartError::Empty) } else { Ok(Self { rows }) }
    }
}

impl Chart {
    /// A chart from its rows, the lowest first.
    ///
    /// # Errors
    /// No rows, an empty row, or a stitch that does not join one loop to one.
    pub fn new(rows: Vec<Vec<Stitch>>) -> Result<Self, ChartError> {
        if rows.is_empty() || rows.iter().any(Vec::is_empty) {
            return Err(ChartError::Empty);
        }
        for (line, row) in (1..).zip(&rows) {
            if let Some(stitch) = row.iter().find(|s| !fits_anywhere(s)) {
                return Err(ChartError::Shape { line, symbol: stitch.to_string() });
            }
        }
        Ok(Self { rows })
    }

    /// Its lines, the lowest row first, as [`Self::from_str`] reads them.
    pub fn lines(&self) -> Vec<String> {
        let line = |row: &Vec<Stitch>| row.iter().map(Stitch::to_string).collect::<Vec<_>>().join(" ");
        self.rows.iter().map(line).collect()
    }

    /// The stitch at a row and column of the fabric.
    pub fn at(&self, row: usize, column: usize) -> &Stitch {
        let row = &self.rows[row % self.rows.len()];
        &row[column % row.len()]
    }

    /// What the chart makes of every face in `rows` (all rows of a stitch mesh, or some of them, lower ones first) that joins
    /// one loop to one. Lines are counted up the wale, so that in a garment of several pieces each of them, and each side of
    /// a neck, has the whole pattern.
    pub fn over(&self, stitches: &StitchMesh, rows: &[Row]) -> Vec<(FaceId, Stitch)> {
        let mut set = Vec::new();
        let mut line = vec![None; stitches.mesh().face_count()];
        for row in rows {
            let below = row.faces.iter().flat_map(|f| stitches.below(*f)).filter_map(|f| line[f.index()]);
            let above = below.max().map_or(0, |l: usize| l + 1);
            for (column, face) in row.faces.iter().enumerate() {
                line[face.index()] = Some(above);
                let now = stitches.stitch(*face);
                if (now.bottoms(), now.tops()) == (1, 1) {
                    set.push((*face, self.at(above, column).clone()));
                }
            }
        }
        set
    }

    /// What the chart makes of those faces of a selection that join one loop to one. Each connected part of it begins with
    /// its lowest stitch on the left; from there columns are counted along the rows and rows up the wale.
    pub fn over_faces(&self, stitches: &StitchMesh, selected: &[FaceId]) -> Vec<(FaceId, Stitch)> {
        let mut open: HashSet<FaceId> = selected.iter().copied().collect();
        let mut set = Vec::new();
        let starts = stitches.rows();
        for start in starts.iter().flat_map(|r| leftmost_first(r, &open)).collect::<Vec<_>>() {
            let mut seeds = VecDeque::from([(start, 0i64, 0i64)]);
            while let Some((seed, row, column)) = seeds.pop_front() {
                for (face, column) in run(stitches, seed, column, &mut open) {
                    let now = stitches.stitch(face);
                    if (now.bottoms(), now.tops()) == (1, 1) {
                        let line = &self.rows[row.rem_euclid(self.rows.len() as i64) as usize];
                        let stitch = &line[column.rem_euclid(line.len() as i64) as usize];
                        set.push((face, stitch.clone()));
                    }
                    seeds.extend(stitches.above(face).zip(column..).map(|(f, c)| (f, row + 1, c)));
                    seeds.extend(stitches.below(face).zip(column..).map(|(f, c)| (f, row - 1, c)));
                }
            }
        }
        set
    }
}

/// The selected faces of a row, beginning with one that has no selected face on its left if there is one.
fn leftmost_first(row: &Row, selected: &HashSet<FaceId>) -> Vec<FaceId> {
    let n = row.faces.len();
    let is_in = |i: usize| selected.contains(&row.faces[i % n]);
    let begins = |i: &usize| is_in(*i) && !((*i > 0 || row.closed) && is_in(i + n - 1));
    let first = (0..n).find(begins).unwrap_or(0);
    (first..first + n).filter(|i| is_in(*i)).map(|i| row.faces[i % n]).collect()
}

/// Takes a face and its neighbours in the row, as far as they are open on either side, with their columns.
fn run(stitches: &StitchMesh, seed: FaceId, column: i64, open: &mut HashSet<FaceId>) -> Vec<(FaceId, i64)> {
    let mut taken = Vec::new();
    if !open.remove(&seed) {
        return taken;
    }
    taken.push((seed, column));
    for step in [1, -1] {
        let (mut face, mut column) = (seed, column);
        loop {
            let side = if step > 0 { stitches.right(face) } else { stitches.left(face) };
            match stitches.mesh().face_across(side).filter(|f| open.remove(f)) {
                Some(next) => (face, column) = (next, column + step),
                None => break,
            }
            taken.push((face, column));
        }
    }
    taken
}

#[cfg(test)]
mod tests {
    use super::*;
    use stitch_mesh::edge_counts::StitchSize;
    use stitch_mesh::mesh::PolygonMesh;
    use stitch_mesh::pieces::rectangle;

    #[test]
    fn a_chart_repeats_in_both_directions() {
        let chart: Chart = "k k p p\n# the second row\np p k k\n".parse().unwrap();
        let mut fabric = rectangle(6, 4, StitchSize::of_width(3e-3)).unwrap();
        for (face, stitch) in chart.over(&fabric, &fabric.rows()) {
            fabric.set_stitch(face, stitch).unwrap();
        }
        let rows: Vec<String> = fabric
            .rows()
            .iter()
            .map(|r| r.faces.iter().map(|f| fabric.stitch(*f).to_string()).collect())
            .collect();
        assert_eq!(rows, ["kkppkk", "ppkkpp", "kkppkk", "ppkkpp"]);
    }

    #[test]
    fn every_piece_has_the_whole_chart() {
        let chart: Chart = "k\np".parse().unwrap();
        let piece = rectangle(2, 4, StitchSize::of_width(3e-3)).unwrap();
        let mesh = piece.mesh();
        let positions = mesh.positions().iter().chain(mesh.positions()).copied().collect();
        let one = mesh.face_lists();
        let other = one.iter().map(|face| face.iter().map(|v| v + mesh.vertex_count() as u32).collect());
        let faces: Vec<Vec<u32>> = one.iter().cloned().chain(other).collect();
        let two = PolygonMesh::new(positions, &faces).unwrap();
        let two = StitchMesh::new(two, vec![Stitch::knit(); faces.len()]).unwrap();
        let set = chart.over(&two, &two.rows());
        assert_eq!(set.len(), 16);
        for (face, stitch) in set {
            assert_eq!(stitch, if face.0 / 2 % 2 == 0 { Stitch::knit() } else { Stitch::purl() }, "{face}");
        }
        // Rows are counted alike in both.
        let faces =
            |rows| two.rows_between(rows).map(|rows| rows.into_iter().flat_map(|r| r.faces).collect());
        let both: Vec<FaceId> = [2, 3, 4, 5, 10, 11, 12, 13].map(FaceId).to_vec();
        let sorted = faces([1, 2]).map(|mut faces: Vec<FaceId>| {
            faces.sort_unstable();
            faces
        });
        assert_eq!(sorted, Some(both));
        assert_eq!(faces([3, 4]), None);
        assert_eq!(faces([2, 1]), None);
    }

    #[test]
    fn a_selection_has_its_own_beginning() {
        let chart: Chart = "p k\nk k".parse().unwrap();
        let mut fabric = rectangle(5, 4, StitchSize::of_width(3e-3)).unwrap();
        // Columns 1 to 4 of rows 1 to 3, without their lower right corner.
        let selected = [6, 7, 11, 12, 13, 14, 16, 17, 18, 19].map(FaceId);
        for (face, stitch) in chart.over_faces(&fabric, &selected) {
            fabric.set_stitch(face, stitch).unwrap();
        }
        let row =
            |r: u32| (5 * r..5 * r + 5).map(|f| fabric.stitch(FaceId(f)).to_string()).collect::<String>();
        assert_eq!([0, 1, 2, 3].map(row), ["kkkkk", "kpkkk", "kkkkk", "kpkpk"]);
    }

    #[test]
    fn errors_name_the_line() {
        let error = |text: &str| text.parse::<Chart>().unwrap_err().to_string();
        assert_eq!(error("# nothing\n"), "the chart is empty");
        assert!(error("k\nk q").starts_with("line 2: 'q' is not a stitch"));
        assert!(error("k d12k").starts_with("line 1: 'd12k' does not join"));
    }
}
