//! Knitting charts as files.

use crate::files;
use anyhow::{Context, Result, bail};
use patterns::diagram::{Course, Diagram, raster, svg};
use std::path::Path;
use stitch_mesh::stitch_mesh::StitchMesh;

/// Squares of a chart in a file at the most, across and up: more is a fabric, and nobody reads it as a chart.
const MOST: [usize; 2] = [400, 600];

/// Size of a square in a PNG file [px].
const SQUARE: f32 = 24.0;

/// Writes a chart of some rows as SVG or PNG, as the file's name ends. Returns it.
///
/// # Errors
/// No rows, more than make a chart, another kind of file, or it cannot be written.
pub fn write(stitches: &StitchMesh, courses: &[Course], path: &Path) -> Result<Diagram> {
    if courses.is_empty() {
        bail!("there are no rows to chart");
    }
    let diagram = Diagram::of(stitches, courses, MOST);
    if let Some(part) = diagram.left_out() {
        bail!("a chart would show only {part}: choose fewer rows, or a part of them in the window");
    }
    let sheet = diagram.sheet();
    match path.extension().and_then(|e| e.to_str()) {
        Some("svg") => files::write(path, svg::to_svg(&sheet).as_bytes())?,
        Some("png") => {
            let picture = raster::draw(&sheet, SQUARE).context("the chart is too large for a picture")?;
            let [wide, high] = picture.size;
            let image = image::RgbaImage::from_raw(wide, high, picture.rgba)
                .context("the chart does not fill its picture")?;
            files::write_png(path, &image)?;
        }
        _ => bail!("{}: a chart is written as .svg or .png", path.display()),
    }
    Ok(diagram)
}
