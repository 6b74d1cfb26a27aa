//! A plot with egui: in the window, and as a picture.

use super::report::Plot;
use crate::page;
use anyhow::Result;
use egui::{Color32, Ui};
use egui_plot::{Corner, Legend, LineStyle};
use image::RgbaImage;
use render::Gpu;

/// Size of a picture [pixels], and pixels to a point: letters are as large as on a screen of that kind.
const SIZE: [u32; 2] = [1200, 800];
const SCALE: f32 = 1.5;

/// Colours that people who see few colours can tell apart (Okabe and Ito), darker first.
const COLORS: [Color32; 6] = [
    Color32::from_rgb(0x00, 0x72, 0xb2),
    Color32::from_rgb(0xd5, 0x5e, 0x00),
    Color32::from_rgb(0x00, 0x9e, 0x73),
    Color32::from_rgb(0xcc, 0x79, 0xa7),
    Color32::from_rgb(0xe6, 0x9f, 0x00),
    Color32::from_rgb(0x56, 0xb4, 0xe9),
];

/// Shows a plot as large as there is room.
pub fn show(ui: &mut Ui, plot: &Plot) {
    let area = egui_plot::Plot::new(plot.name);
    let area = match &plot.lines[..] {
        [_, _, ..] => area.legend(Legend::default().position(Corner::LeftTop)),
        _ => area,
    };
    area.x_axis_label(plot.x).y_axis_label(plot.y).allow_scroll(false).show(ui, |area| {
        for (i, line) in plot.lines.iter().enumerate() {
            let curve = egui_plot::Line::new(line.name.clone(), line.points.clone())
                .color(COLORS[i % COLORS.len()])
                .width(2.0);
            area.line(if line.dashed { curve.style(LineStyle::dashed_loose()) } else { curve });
        }
    });
}

/// Draws a plot with its title.
///
/// # Errors
/// A device that cannot draw.
pub fn draw(gpu: &Gpu, plot: &Plot) -> Result<RgbaImage> {
    let context = egui::Context::default();
    context.set_visuals(egui::Visuals::light());
    page::draw(gpu, &context, SIZE, SCALE, |ui| {
        egui::Frame::NONE.inner_margin(12).show(ui, |ui| {
            ui.vertical_centered(|ui| ui.heading(&plot.title));
            show(ui, plot);
        });
    })
}
