//! A chart: rows of stitches that repeat over a fabric (Yuksel et al. §5.3: "each line corresponds to a row of the stitch
//! mesh, and lists the stitch types on that row").
//!
//! The first line is the lowest row, stitches stand left to right as seen from the front, and the chart repeats in both
//! directions: `k k p p` is a 2 × 2 rib; `k` and `p` on two lines is garter. Only stitches that join one loop to one can be
//! charted so; faces that increase or decrease keep what they are.

use std::str::FromStr;
use stitch_mesh::ids::FaceId;
use stitch_mesh::label::Row;
use stitch_mesh::stitch::{Stitch, StitchError};
use stitch_mesh::stitch_mesh::StitchMesh;

/// A repeating chart. Never empty.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Chart {
    rows: Vec<Vec<Stitch>>,
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
                if (stitch.bottoms(), stitch.tops()) != (1, 1) || !stitch.holds() {
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
    /// The stitch at a row and column of the fabric.
    pub fn at(&self, row: usize, column: usize) -> &Stitch {
        let row = &self.rows[row % self.rows.len()];
        &row[column % row.len()]
    }

    /// What the chart makes of every face in `rows` (all rows of a stitch mesh, or some of them in order) that joins one loop to one.
    pub fn over(&self, stitches: &StitchMesh, rows: &[Row]) -> Vec<(FaceId, Stitch)> {
        let mut set = Vec::new();
        for (r, row) in rows.iter().enumerate() {
            for (column, face) in row.faces.iter().enumerate() {
                let now = stitches.stitch(*face);
                if (now.bottoms(), now.tops()) == (1, 1) {
                    set.push((*face, self.at(r, column).clone()));
                }
            }
        }
        set
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use stitch_mesh::edge_counts::StitchSize;
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
    fn errors_name_the_line() {
        let error = |text: &str| text.parse::<Chart>().unwrap_err().to_string();
        assert_eq!(error("# nothing\n"), "the chart is empty");
        assert!(error("k\nk q").starts_with("line 2: 'q' is not a stitch"));
        assert!(error("k d12k").starts_with("line 1: 'd12k' does not join"));
    }
}
