//! Charts as SVG: each mark is a path.

use super::mark::{Ink, Paint};
use super::sheet::Sheet;
use std::fmt::Write as _;

/// Size of a square [px].
const SQUARE: f32 = 24.0;

fn color(ink: Ink) -> String {
    let [r, g, b] = ink.rgb();
    format!("#{r:02x}{g:02x}{b:02x}")
}

/// Writes a drawing as an SVG file.
pub fn to_svg(sheet: &Sheet) -> String {
    let [wide, high] = sheet.size.map(|s| (s * SQUARE).ceil());
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{wide}\" height=\"{high}\" viewBox=\"0 0 {wide} {high}\">\n\
         <title>Knitting chart</title>\n<rect width=\"{wide}\" height=\"{high}\" fill=\"#ffffff\"/>\n\
         <g stroke-linecap=\"round\" stroke-linejoin=\"round\">\n"
    );
    for mark in &sheet.marks {
        svg.push_str("<path d=\"");
        for (i, [x, y]) in mark.points.iter().enumerate() {
            // Writing to a string cannot fail.
            let _ = write!(svg, "{}{:.2} {:.2}", if i == 0 { 'M' } else { 'L' }, x * SQUARE, y * SQUARE);
        }
        let _ = match mark.paint {
            Paint::Fill(ink) => writeln!(svg, "Z\" fill=\"{}\"/>", color(ink)),
            Paint::Line(ink, width) => {
                let closed = if mark.points.first() == mark.points.last() { "Z" } else { "" };
                let width = width * SQUARE;
                writeln!(
                    svg,
                    "{closed}\" fill=\"none\" stroke=\"{}\" stroke-width=\"{width:.2}\"/>",
                    color(ink)
                )
            }
        };
    }
    svg.push_str("</g>\n</svg>\n");
    svg
}
