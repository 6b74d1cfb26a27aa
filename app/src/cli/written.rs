//! The verbs of written patterns: `swatch`, `tile`, `instructions`.

use super::Output;
use super::values::parse_rows;
use crate::command::Command;
use crate::document::Document;
use crate::files;
use crate::inspect::inspect;
use crate::project::Project;
use crate::written::{SwatchFacts, extent, swatch, tiled, told};
use anyhow::{Context, Result, bail};
use patterns::knitspeak::KnitSpeakError;
use patterns::tile::Layout;
use serde_json::json;
use std::io::IsTerminal as _;
use std::path::{Path, PathBuf};

/// How much of a pattern is knitted.
#[derive(clap::Args)]
pub struct Extent {
    /// Stitches to cast on; as the pattern says, or twice its repeat, if absent
    #[arg(long, value_name = "N", conflicts_with = "repeats")]
    cast_on: Option<usize>,
    /// Repeats side by side and above each other, as in 3x2
    #[arg(long, value_name = "WxH", value_parser = parse_repeats)]
    repeats: Option<[usize; 2]>,
}

fn parse_repeats(text: &str) -> Result<[usize; 2], String> {
    let (w, h) = text.split_once('x').ok_or("expected WIDTHxHEIGHT, as in 3x2")?;
    match (w.parse(), h.parse()) {
        (Ok(w @ 1..=1000), Ok(h @ 1..=1000)) => Ok([w, h]),
        _ => Err(format!("'{text}' are not repeats from 1x1 to 1000x1000")),
    }
}

/// Where a pattern is tiled.
#[derive(clap::Args)]
pub struct Where {
    /// First and last row, from 0, as in 4..19; all rows if absent
    #[arg(long, value_name = "A..B", value_parser = parse_rows)]
    rows: Option<[usize; 2]>,
    /// Stitches, as in 3,7,20-39; all of the rows if absent
    #[arg(long, value_name = "F", value_parser = parse_faces)]
    faces: Option<Faces>,
    /// straight, mirrored, alternating or half-drop
    #[arg(long, default_value = "straight", value_parser = parse_layout)]
    layout: Layout,
}

/// Stitches by number.
#[derive(Clone)]
pub struct Faces(Vec<u32>);

/// Stitches of a list like `3,7,20-39`.
pub fn parse_faces(text: &str) -> Result<Faces, String> {
    let mut faces = Vec::new();
    for part in text.split(',') {
        let (a, b) = part.split_once('-').unwrap_or((part, part));
        match (a.trim().parse::<u32>(), b.trim().parse::<u32>()) {
            (Ok(a), Ok(b)) if a <= b && b - a < 10_000_000 => faces.extend(a..=b),
            _ => return Err(format!("'{part}' is neither a stitch nor a range of them")),
        }
    }
    Ok(Faces(faces))
}

fn parse_layout(text: &str) -> Result<Layout, String> {
    let all = [
        ("straight", Layout::Straight),
        ("mirrored", Layout::Mirrored),
        ("alternating", Layout::Alternating),
        ("half-drop", Layout::HalfDrop),
    ];
    let found = all.into_iter().find(|(name, _)| *name == text);
    found
        .map(|(_, layout)| layout)
        .ok_or_else(|| "expected straight, mirrored, alternating or half-drop".into())
}

fn read(path: &Path) -> Result<String> {
    String::from_utf8(files::read(path)?).with_context(|| format!("{} is not text", path.display()))
}

/// Names the file, and at a terminal shows the place in it.
fn in_file(error: anyhow::Error, path: &Path, text: &str) -> anyhow::Error {
    if let Some(error) = error.downcast_ref::<KnitSpeakError>()
        && std::io::stderr().is_terminal()
    {
        let report = error.report(&path.display().to_string(), text);
        let _ = std::io::Write::write_all(&mut std::io::stderr(), report.as_bytes());
    }
    error.context(path.display().to_string())
}

fn knitted(path: &Path, size: &Extent) -> Result<(Project, SwatchFacts)> {
    let text = read(path)?;
    let (width, high) = extent(size.cast_on, size.repeats);
    swatch(&text, width, high).map_err(|error| in_file(error, path, &text))
}

fn said(facts: &SwatchFacts) -> String {
    let SwatchFacts { cast_on, rows, most_stitches, warnings } = facts;
    let mut line = format!("cast on {cast_on}, {rows} rows, most stitches {most_stitches}");
    warnings.iter().for_each(|warning| line += &format!("\n{warning}"));
    line
}

/// Knits a swatch, or one of every pattern in a folder.
pub fn swatches(pattern: &Path, size: &Extent, output: &Path, print: Output) -> Result<()> {
    if !pattern.is_dir() {
        files::check_ending(output, "purl", "projects")?;
        let (project, facts) = knitted(pattern, size)?;
        project.save(output)?;
        print.print(&serde_json::to_value(&facts)?, &said(&facts));
        return Ok(());
    }
    let entries = std::fs::read_dir(pattern).with_context(|| pattern.display().to_string())?;
    let mut paths: Vec<PathBuf> = entries.filter_map(|e| Some(e.ok()?.path())).collect();
    paths.retain(|path| path.extension().is_some_and(|e| e == "ks"));
    paths.sort();
    if paths.is_empty() {
        bail!("{}: there are no patterns (.ks) in this folder", pattern.display());
    }
    std::fs::create_dir_all(output).with_context(|| output.display().to_string())?;
    let (mut report, mut lines, mut failed) = (Vec::new(), Vec::new(), 0);
    for path in &paths {
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let done = knitted(path, size).and_then(|(project, facts)| {
            project.save(&output.join(&name).with_extension("purl"))?;
            Ok(facts)
        });
        match done {
            Ok(facts) => {
                lines.push(format!("{name}: {}", said(&facts)));
                report.push(json!({"file": name, "facts": facts}));
            }
            Err(error) => {
                failed += 1;
                lines.push(format!("{error:#}"));
                report.push(json!({"file": name, "error": format!("{error:#}")}));
            }
        }
    }
    print.print(&json!({"patterns": report, "failed": failed}), &lines.join("\n"));
    if failed > 0 {
        bail!("{}: {failed} of {} patterns could not be knitted", pattern.display(), paths.len());
    }
    Ok(())
}

/// Tiles a pattern over a project.
pub fn tile(project: &Path, pattern: &Path, place: Where, output: &Path, print: Output) -> Result<()> {
    files::check_ending(output, "purl", "projects")?;
    let text = read(pattern)?;
    let mut document = Document::new(Project::open(project)?);
    let Where { rows, faces, layout } = place;
    let faces = faces.map(|f| f.0);
    let report = tiled(document.project(), &text, rows, faces.as_deref(), layout)
        .map_err(|error| in_file(error, pattern, &text))?;
    document.apply(Command::Tile { text, rows, faces, layout })?;
    document.project().save(output)?;
    let facts = inspect(document.project());
    let mut json = serde_json::to_value(&facts)?;
    json["repeats"] = report.repeats.into();
    json["covered"] = report.covered.into();
    json["left_out"] = report.left_out.clone().into();
    let lines = [format!("{} repeats over {} stitches", report.repeats, report.covered)];
    let lines = lines.into_iter().chain(report.left_out).collect::<Vec<_>>().join("\n");
    print.print(&json, &format!("{lines}\n{facts}"));
    Ok(())
}

/// Writes instructions for a project, to a file or to standard output.
pub fn instructions(
    project: &Path,
    rows: Option<[usize; 2]>,
    faces: Option<Faces>,
    output: Option<&Path>,
    print: Output,
) -> Result<()> {
    let faces = faces.map(|f| f.0);
    let text = told(&Project::open(project)?, rows, faces.as_deref())
        .with_context(|| project.display().to_string())?;
    if let Some(output) = output {
        files::write(output, text.as_bytes())?;
    }
    let shown = output.map_or_else(|| text.trim_end().to_owned(), |path| path.display().to_string());
    print.print(&json!({"text": text, "file": output}), &shown);
    Ok(())
}
