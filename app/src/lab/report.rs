//! What an experiment finds.

use render::{Drawing, NamedView};

/// All that an experiment has found.
#[derive(Clone, Debug, Default)]
pub struct Report {
    /// Numbers by name; the name ends with the unit.
    pub figures: Vec<(String, f64)>,
    /// What there is to say about them, a sentence each.
    pub remarks: Vec<String>,
    /// Measurements, each for a CSV file.
    pub tables: Vec<Table>,
    /// Curves.
    pub plots: Vec<Plot>,
    /// What the pieces look like.
    pub pictures: Vec<Picture>,
}

/// Measurements in columns.
#[derive(Clone, Debug)]
pub struct Table {
    /// Name of its file, without ending.
    pub name: &'static str,
    /// What each column holds; the name ends with the unit.
    pub columns: Vec<&'static str>,
    /// The numbers, row by row.
    pub rows: Vec<Vec<f64>>,
}

/// Curves over one axis.
#[derive(Clone, Debug)]
pub struct Plot {
    /// Name of its file, without ending.
    pub name: &'static str,
    /// What it shows.
    pub title: String,
    /// The axis to the right, with its unit.
    pub x: &'static str,
    /// The axis upwards, with its unit.
    pub y: &'static str,
    /// The curves.
    pub lines: Vec<Line>,
}

/// One curve.
#[derive(Clone, Debug)]
pub struct Line {
    /// What the legend says.
    pub name: String,
    /// Its points.
    pub points: Vec<[f64; 2]>,
    /// Whether it is drawn as dashes: what has been fitted or told by others.
    pub dashed: bool,
}

/// One piece of fabric, or several in a frame with their names.
#[derive(Clone, Debug)]
pub struct Picture {
    /// Name of its file, without ending.
    pub name: &'static str,
    /// Where from.
    pub view: NamedView,
    /// The pieces, each with its name.
    pub shown: Vec<(String, Drawing)>,
}

impl Report {
    /// Adds a figure.
    pub fn figure(&mut self, name: impl Into<String>, value: f64) {
        self.figures.push((name.into(), value));
    }
}

impl Line {
    /// A measured curve.
    pub fn new(name: impl Into<String>, points: Vec<[f64; 2]>) -> Self {
        Self { name: name.into(), points, dashed: false }
    }

    /// A curve that was not measured.
    pub fn dashed(name: impl Into<String>, points: Vec<[f64; 2]>) -> Self {
        Self { dashed: true, ..Self::new(name, points) }
    }
}

impl Table {
    /// The measurements as CSV: a line of names, then a line a row.
    pub fn csv(&self) -> String {
        let number = |x: &f64| format!("{x:.6e}");
        let lines = self.rows.iter().map(|row| row.iter().map(number).collect::<Vec<_>>().join(","));
        let lines = std::iter::once(self.columns.join(",")).chain(lines);
        lines.map(|line| line + "\n").collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn csv_has_a_line_of_names_and_a_line_a_row() {
        let table =
            Table { name: "a", columns: vec!["x_mm", "y_n"], rows: vec![vec![1.0, 0.5], vec![2.0, -3e-9]] };
        assert_eq!(table.csv(), "x_mm,y_n\n1.000000e0,5.000000e-1\n2.000000e0,-3.000000e-9\n");
    }
}
