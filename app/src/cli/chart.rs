//! Knitting charts of projects.

use super::Output;
use crate::charts;
use crate::project::Project;
use anyhow::{Context, Result, bail};
use patterns::diagram::Course;
use serde_json::json;
use std::path::Path;

/// The first and the last row, counted from 1.
pub fn parse_rows(text: &str) -> Result<[usize; 2], String> {
    let number = |s: &str| s.trim().parse::<usize>().ok().filter(|n| *n > 0);
    match text.split_once("..").map(|(a, b)| (number(a), number(b))) {
        Some((Some(a), Some(b))) if a <= b => Ok([a, b]),
        _ => Err(format!("'{text}' is not a range of rows, as in 1..24")),
    }
}

/// Charts the piece that begins with the lowest row of a project, or some of its rows.
pub fn run(project: &Path, output: &Path, rows: Option<[usize; 2]>, print: Output) -> Result<()> {
    let name = project.display().to_string();
    let project = Project::open(project)?;
    let stitches = &project.fabric().context(name.clone())?.stitches;
    let mut courses = Course::piece(stitches, &stitches.rows());
    if let Some([first, last]) = rows {
        if last > courses.len() {
            bail!("{name} has {} rows, not {last}", courses.len());
        }
        courses.truncate(last);
        courses.drain(..first - 1);
    }
    let chart = charts::write(stitches, &courses, output).context(name)?;
    let facts = json!({"file": output, "columns": chart.columns, "rows": chart.rows.len()});
    print.print(&facts, &format!("{} columns, {} rows", chart.columns, chart.rows.len()));
    Ok(())
}
