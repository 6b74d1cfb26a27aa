//! Written patterns and projects: a swatch of a pattern, a pattern tiled over a fabric, instructions for a fabric.

use crate::fabric::Fabric;
use crate::project::Project;
use anyhow::{Context, Result, anyhow, bail};
use patterns::instructions::instructions;
use patterns::knit::knit;
use patterns::knitspeak::{Pattern, Width, Worked, WorkedRow, write};
use patterns::tile::{Layout, Tiled, tile};
use serde::Serialize;
use std::collections::HashSet;
use stitch_mesh::edge_counts::StitchSize;
use stitch_mesh::ids::FaceId;
use stitch_mesh::label::Row;
use stitch_mesh::stitch_mesh::StitchMesh;

/// Width of the stitches of a swatch [m]: hand-knitting yarn on 4 mm needles.
pub const SWATCH_STITCH_WIDTH: f64 = 4.5e-3;

/// Figures of a swatch, as scripts read them.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct SwatchFacts {
    /// Stitches cast on.
    pub cast_on: usize,
    /// Rows or rounds.
    pub rows: usize,
    /// Most stitches between two of them.
    pub most_stitches: usize,
    /// What is doubtful in the text, a line each.
    pub warnings: Vec<String>,
}

/// How wide a pattern is knitted and how often its rows: so many stitches, so many repeats, or as its text says.
pub fn extent(cast_on: Option<usize>, repeats: Option<[usize; 2]>) -> (Width, usize) {
    match (cast_on, repeats) {
        (Some(n), _) => (Width::CastOn(n), 1),
        (None, Some([wide, high])) => (Width::Repeats(wide), high),
        (None, None) => (Width::AsWritten, 1),
    }
}

/// A piece knitted from a written pattern, worked `high` times over its rows, as a project of its own.
///
/// # Errors
/// Where the text is wrong, or what a stitch mesh cannot hold of it.
pub fn swatch(text: &str, width: Width, high: usize) -> Result<(Project, SwatchFacts)> {
    let pattern = Pattern::read(text)?;
    let worked = repeated(pattern.work(width)?, high)?;
    let size = StitchSize::of_width(SWATCH_STITCH_WIDTH);
    let stitches = knit(&pattern, &worked, size)?;
    let mut project = Project::new(stitches.mesh().clone(), size);
    project.fabric = Some(Fabric::new(stitches));
    let mut warnings: Vec<String> = worked.warnings.iter().map(ToString::to_string).collect();
    if let Width::Repeats(wide @ 2..) = width
        && pattern.work(Width::Repeats(1)).is_ok_and(|once| once.cast_on == worked.cast_on)
    {
        warnings.push(format!(
            "nothing in the pattern repeats across, so {wide} repeats are as wide as one: write what repeats between * and \
             'repeat from *'"
        ));
    }
    let facts = SwatchFacts {
        cast_on: worked.cast_on,
        rows: worked.rows.len(),
        most_stitches: worked.most_stitches(),
        warnings,
    };
    Ok((project, facts))
}

/// The smallest piece of a pattern that shows what its stitches are like far from any border.
///
/// # Errors
/// Where the text is wrong, or what a stitch mesh cannot hold of it.
pub(crate) fn sample(text: &str, size: StitchSize) -> Result<StitchMesh> {
    /// Stitches and rows at least.
    const LEAST: [usize; 2] = [16, 20];
    let pattern = Pattern::read(text)?;
    let [once, twice] = [1, 2].map(|n| pattern.work(Width::Repeats(n)).map(|w| w.cast_on));
    let (once, twice) = (once?, twice?);
    let across = 1 + LEAST[0].saturating_sub(once).div_ceil(twice.saturating_sub(once).max(1));
    let worked = pattern.work(Width::Repeats(across))?;
    let high = LEAST[1].div_ceil(worked.rows.len().max(1));
    Ok(knit(&pattern, &repeated(worked, high)?, size)?)
}

/// The name of a pattern: its first line, if that is a comment.
pub fn title(text: &str) -> &str {
    let first = text.lines().next().and_then(|line| line.strip_prefix('#')).map(str::trim);
    first.filter(|name| !name.is_empty() && !name.starts_with("check:")).unwrap_or("a written pattern")
}

/// A pattern worked several times over its rows.
pub(crate) fn repeated(worked: Worked, times: usize) -> Result<Worked> {
    let count = worked.rows.len();
    match times {
        0 => bail!("a pattern has to be worked once at least"),
        1 => return Ok(worked),
        _ if count % 2 == 1 && !worked.in_the_round => bail!(
            "the pattern has {count} rows, so its second repeat would begin on the other side: only patterns with an even number \
             of rows can be repeated"
        ),
        _ => {}
    }
    let (begins, ends) = (worked.cast_on, worked.rows.last().map_or(0, |row| row.loops));
    if begins != ends {
        bail!(
            "the pattern begins with {begins} stitches and ends with {ends}, so it cannot be repeated upwards"
        );
    }
    let rows: Vec<WorkedRow> = worked.rows.iter().cycle().take(count * times).cloned().collect();
    Ok(Worked { rows, ..worked })
}

/// The rows of a fabric from one height to another, counted from 0.
///
/// # Errors
/// There are none so high.
pub(crate) fn rows_between(stitches: &StitchMesh, [first, last]: [usize; 2]) -> Result<Vec<Row>> {
    stitches.rows_between([first, last]).with_context(|| {
        let highest = stitches.rows_and_heights().1.last().copied().unwrap_or(0);
        format!("there are no rows {first}–{last}: the fabric has rows 0–{highest}")
    })
}

/// The part of a fabric that a region asks for: rows from the first to the last, and of them the given faces; all without it.
fn region(stitches: &StitchMesh, rows: Option<[usize; 2]>, faces: Option<&[u32]>) -> Result<HashSet<FaceId>> {
    let within: HashSet<FaceId> = match rows {
        Some(rows) => rows_between(stitches, rows)?.into_iter().flat_map(|row| row.faces).collect(),
        None => stitches.mesh().faces().collect(),
    };
    let Some(faces) = faces else { return Ok(within) };
    let count = stitches.mesh().face_count();
    if let Some(face) = faces.iter().find(|f| **f as usize >= count) {
        bail!("there is no stitch {face}: the stitches are 0–{}", count.saturating_sub(1));
    }
    let chosen = faces.iter().copied().map(FaceId).filter(|f| within.contains(f));
    Ok(chosen.collect())
}

/// A pattern tiled over a fabric, or over some of its rows and faces.
///
/// # Errors
/// The pattern cannot be read, or finds no room.
pub fn tiled(
    project: &Project,
    text: &str,
    rows: Option<[usize; 2]>,
    faces: Option<&[u32]>,
    layout: Layout,
) -> Result<Tiled> {
    let stitches = &project.knitted()?.stitches;
    let all = stitches.rows();
    let region = region(stitches, rows, faces)?;
    Ok(tile(stitches, &all, &region, &Pattern::read(text)?, layout)?)
}

/// Instructions for a fabric, or for some of its rows and faces.
///
/// # Errors
/// Which stitch cannot be knitted by hand, and why.
pub fn told(project: &Project, rows: Option<[usize; 2]>, faces: Option<&[u32]>) -> Result<String> {
    let stitches = &project.knitted()?.stitches;
    let all = stitches.rows();
    let region = region(stitches, rows, faces)?;
    let part = |row: &Row| -> Option<Result<Row>> {
        let n = row.faces.len();
        let is_in = |i: usize| region.contains(&row.faces[i % n]);
        let count = (0..n).filter(|i| is_in(*i)).count();
        if count == n || count == 0 {
            return (count > 0).then(|| Ok(row.clone()));
        }
        let begins = |i: &usize| is_in(*i) && !((*i > 0 || row.closed) && is_in(i + n - 1));
        let first = (0..n).find(begins)?;
        let faces: Vec<FaceId> =
            (first..first + n).take_while(|i| is_in(*i)).map(|i| row.faces[i % n]).collect();
        Some(if faces.len() == count {
            Ok(Row { faces, closed: false })
        } else {
            Err(anyhow!(
                "stitch {}: the chosen stitches of its row do not all lie side by side",
                row.faces[first].0
            ))
        })
    };
    let chosen: Vec<Row> = all.iter().filter_map(part).collect::<Result<_>>()?;
    // Stitches that end in a point are not worked: the yarn is drawn through their loops.
    let is_gathered = |row: &Row| row.faces.iter().all(|f| stitches.stitch(*f).tops() == 0);
    let (chosen, end) = match chosen.split_last() {
        Some((last, rest)) if is_gathered(last) && !rest.is_empty() => {
            (rest, "Cut the yarn and draw it through the last")
        }
        _ => (&chosen[..], "Bind off"),
    };
    let worked = instructions(stitches, chosen)?;
    let left = worked.rows.last().map_or(worked.cast_on, |row| row.loops);
    let joined = if worked.in_the_round { " and join in the round" } else { "" };
    Ok(format!(
        "# Cast on {} stitches{joined}.\n{}# {end} {left} stitches.\n",
        worked.cast_on,
        write(&worked)
    ))
}
