//! All kinds of stitches, to set or to paint with.

use super::color32;
use crate::window::catalogue;
use crate::window::editor::Editor;
use egui::{Color32, Ui};
use render::palette::{self, StitchColors};
use stitch_mesh::catalogue::GROUPS;

/// The colour of a kind of stitches in the picture, or where that shows yarn, as it is otherwise.
pub fn color(editor: &Editor, symbol: &str) -> Color32 {
    let colors = match editor.stitch_colors {
        StitchColors::Yarn => StitchColors::default(),
        colors => colors,
    };
    color32(colors.of(symbol, palette::YARN, 0))
}

/// Shows the palette.
pub fn show(editor: &mut Editor, ui: &mut Ui) {
    ui.horizontal(|ui| {
        ui.heading("Stitch");
        let field = egui::TextEdit::singleline(&mut editor.panel.palette_filter)
            .hint_text("find")
            .desired_width(110.0);
        let response = ui.add(field).on_hover_text("Show stitches by name or symbol");
        ui.ctx().accesskit_node_builder(response.id, |node| node.set_label("Find a stitch"));
    });
    let wanted = editor.panel.palette_filter.trim().to_lowercase();
    let shown =
        |symbol: &&str| symbol.contains(&wanted) || catalogue::name(symbol).to_lowercase().contains(&wanted);
    for (heading, symbols) in GROUPS {
        let symbols: Vec<&str> = symbols.iter().copied().filter(shown).collect();
        if symbols.is_empty() {
            continue;
        }
        ui.label(egui::RichText::new(heading).weak());
        ui.horizontal_wrapped(|ui| {
            ui.spacing_mut().item_spacing = egui::vec2(3.0, 3.0);
            for symbol in symbols {
                stitch(editor, ui, symbol);
            }
        });
    }
}

fn stitch(editor: &mut Editor, ui: &mut Ui, symbol: &str) {
    let chosen = editor.brush.to_string() == symbol;
    // The fills are light: dark letters on all of them.
    let text = egui::RichText::new(symbol).color(Color32::BLACK).monospace();
    let stroke =
        if chosen { egui::Stroke::new(2.5, ui.visuals().strong_text_color()) } else { egui::Stroke::NONE };
    let button =
        egui::Button::new(text).fill(color(editor, symbol)).stroke(stroke).min_size(egui::vec2(36.0, 20.0));
    let response = ui.add(button);
    response.widget_info(|| {
        egui::WidgetInfo::labeled(egui::Role::Button, true, format!("{symbol} · {}", catalogue::name(symbol)))
    });
    let what = "sets what is selected; with nothing selected, the stitch to paint with";
    if response.on_hover_text(format!("{} ({symbol})\n{what}", catalogue::name(symbol))).clicked() {
        catalogue::choose(symbol, editor);
    }
}
