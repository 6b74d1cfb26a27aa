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
    let all = stitches.rows();
    let mut courses = Course::piece(stitches, &all);
    // What is worked on after a division, or sewn on.
    let others = all.len() - courses.len().min(all.len());
    let other_parts = match others {
        0 => String::new(),
        n => format!("; {n} more rows are in other parts, which the window charts when they are selected"),
    };
    if let Some([first, last]) = rows {
        let highest = courses.last().map_or(0, |course| course.number);
        if last >= highest {
            bail!(
                "{name}: there are no rows {first}–{last}: the piece has rows 0–{}{other_parts}",
                highest.saturating_sub(1)
            );
        }
        // Courses are numbered from 1.
        courses.retain(|course| (first + 1..=last + 1).contains(&course.number));
        if courses.is_empty() {
            bail!("{name}: rows {first}–{last} are not in this piece{other_parts}");
        }
    }
    let chart = charts::write(stitches, &courses, output).context(name)?;
    let facts = json!({"file": output, "columns": chart.columns, "rows": chart.rows.len(), "rows_in_other_parts": others});
    print.print(&facts, &format!("{} columns, {} rows{other_parts}", chart.columns, chart.rows.len()));
    Ok(())
}
