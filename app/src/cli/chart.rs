//! Knitting charts of projects.

use super::Output;
use crate::charts;
use crate::project::Project;
use anyhow::{Context, Result, bail};
use patterns::diagram::Course;
use serde_json::json;
use std::path::Path;

/// Charts the piece that begins with the lowest row of a project, or some of its rows.
pub fn run(project: &Path, output: &Path, rows: Option<[usize; 2]>, print: Output) -> Result<()> {
    let name = project.display().to_string();
    let project = Project::open(project)?;
    let stitches = &project.knitted().context(name.clone())?.stitches;
    let mut courses = Course::piece(stitches, &stitches.rows());
    if let Some([first, last]) = rows {
        if last >= courses.len() {
            bail!(
                "{name}: there are no rows {first}–{last}: the piece has rows 0–{}",
                courses.len().saturating_sub(1)
            );
        }
        courses.truncate(last + 1);
        courses.drain(..first);
    }
    let chart = charts::write(stitches, &courses, output).context(name)?;
    let facts = json!({"file": output, "columns": chart.columns, "rows": chart.rows.len()});
    print.print(&facts, &format!("{} columns, {} rows", chart.columns, chart.rows.len()));
    Ok(())
}
