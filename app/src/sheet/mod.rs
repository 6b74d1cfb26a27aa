//! The contact sheet of stitches: a settled swatch of each, from the front and from the back, with its name and symbol.

mod swatch;

use crate::page;
use anyhow::{Context, Result};
use egui::text::LayoutJob;
use egui::{Align, Align2, Color32, FontId, Painter, Pos2, Rect, TextureHandle, Vec2, pos2, vec2};
use image::RgbaImage;
use render::Gpu;

/// Side of a picture [pixels].
const PICTURE: f32 = 124.0;
/// How much larger a picture is drawn, for smooth edges.
const FINER: u32 = 2;
/// Swatches side by side.
const ACROSS: usize = 6;
/// Between the front and the back of a swatch [pixels].
const BETWEEN: f32 = 2.0;
/// Height of what stands below a picture, of a heading, and the gap between swatches [pixels].
const TEXT: f32 = 54.0;
const HEADING: f32 = 38.0;
const GAP: f32 = 14.0;
/// Width and height of a swatch with its text [pixels].
const CELL: Vec2 = vec2(2.0 * PICTURE + BETWEEN, PICTURE + TEXT);

/// A swatch as it is shown.
struct Entry {
    sides: [TextureHandle; 2],
    title: String,
    description: String,
}

/// Draws the sheet. `watch` is told how many swatches of how many are done.
///
/// # Errors
/// A swatch that cannot be simulated, or a device that cannot draw.
pub fn draw(gpu: &Gpu, watch: &mut dyn FnMut(usize, usize)) -> Result<RgbaImage> {
    let groups = swatch::groups()?;
    let count = groups.iter().map(|(_, swatches)| swatches.len()).sum();
    let mut done = 0;
    let context = egui::Context::default();
    let mut chapters = Vec::new();
    for (heading, swatches) in groups {
        let mut entries = Vec::new();
        for swatch in swatches {
            let sides = swatch::both_sides(gpu, &swatch, PICTURE as u32 * FINER)
                .with_context(|| swatch.title.clone())?
                .map(|picture| page::texture(&context, &picture));
            entries.push(Entry { sides, title: swatch.title, description: swatch.description });
            done += 1;
            watch(done, count);
        }
        chapters.push((heading, entries));
    }
    let lines: usize = chapters.iter().map(|(_, entries)| entries.len().div_ceil(ACROSS)).sum();
    let width = ACROSS as f32 * (CELL.x + GAP) + GAP;
    let height = lines as f32 * CELL.y + chapters.len() as f32 * HEADING + GAP;
    page::draw(gpu, &context, [width as u32, height as u32], 1.0, |ui| {
        let painter = ui.painter();
        let mut top = GAP / 2.0;
        for (heading, entries) in &chapters {
            let place = pos2(GAP, top + HEADING / 2.0);
            painter.text(
                place,
                Align2::LEFT_CENTER,
                *heading,
                FontId::proportional(20.0),
                Color32::from_gray(40),
            );
            top += HEADING;
            for line in entries.chunks(ACROSS) {
                for (column, entry) in line.iter().enumerate() {
                    show(painter, pos2(GAP + column as f32 * (CELL.x + GAP), top), entry);
                }
                top += CELL.y;
            }
        }
    })
}

/// Both sides, and centred below them the title and the description.
fn show(painter: &Painter, corner: Pos2, entry: &Entry) {
    let whole = Rect::from_min_max(Pos2::ZERO, pos2(1.0, 1.0));
    for (i, side) in entry.sides.iter().enumerate() {
        let place = corner + vec2(i as f32 * (PICTURE + BETWEEN), 0.0);
        painter.image(side.id(), Rect::from_min_size(place, Vec2::splat(PICTURE)), whole, Color32::WHITE);
    }
    let middle = corner + vec2(CELL.x / 2.0, PICTURE + 3.0);
    painter.text(middle, Align2::CENTER_TOP, &entry.title, FontId::proportional(14.0), Color32::BLACK);
    let font = FontId::proportional(11.0);
    let mut words = LayoutJob::simple(entry.description.clone(), font, Color32::from_gray(60), CELL.x);
    words.halign = Align::Center;
    painter.galley(middle + vec2(0.0, 17.0), painter.layout_job(words), Color32::BLACK);
}
