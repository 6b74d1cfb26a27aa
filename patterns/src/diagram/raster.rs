//! Charts as pixels.

use super::mark::{Ink, Paint};
use super::sheet::Sheet;
use tiny_skia::{Color, FillRule, LineCap, LineJoin, PathBuilder, Pixmap, Stroke, Transform};

/// Most pixels on a side.
const MOST: f32 = 16_384.0;

/// A picture: rows of RGBA pixels from the top.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Picture {
    /// Width and height [px].
    pub size: [u32; 2],
    /// sRGB and opacity of every pixel.
    pub rgba: Vec<u8>,
}

fn paint(ink: Ink) -> tiny_skia::Paint<'static> {
    let [r, g, b] = ink.rgb();
    let mut paint = tiny_skia::Paint { anti_alias: true, ..Default::default() };
    paint.set_color_rgba8(r, g, b, 0xff);
    paint
}

/// Draws with squares of some size [px]. None where the picture would be larger than 16 384 pixels on a side, or empty.
pub fn draw(sheet: &Sheet, square: f32) -> Option<Picture> {
    let [wide, high] = sheet.size.map(|s| (s * square).ceil());
    if !(1.0..=MOST).contains(&wide) || !(1.0..=MOST).contains(&high) {
        return None;
    }
    let mut pixels = Pixmap::new(wide as u32, high as u32)?;
    pixels.fill(Color::WHITE);
    let transform = Transform::from_scale(square, square);
    for mark in &sheet.marks {
        let mut path = PathBuilder::new();
        for (i, [x, y]) in mark.points.iter().enumerate() {
            if i == 0 { path.move_to(*x, *y) } else { path.line_to(*x, *y) }
        }
        if mark.points.first() == mark.points.last() {
            path.close();
        }
        let Some(path) = path.finish() else { continue };
        match mark.paint {
            Paint::Fill(ink) => pixels.fill_path(&path, &paint(ink), FillRule::Winding, transform, None),
            Paint::Line(ink, width) => {
                let stroke = Stroke {
                    width,
                    line_cap: LineCap::Round,
                    line_join: LineJoin::Round,
                    ..Default::default()
                };
                pixels.stroke_path(&path, &paint(ink), &stroke, transform, None);
            }
        }
    }
    Some(Picture { size: [pixels.width(), pixels.height()], rgba: pixels.take() })
}
