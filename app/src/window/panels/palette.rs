//! All kinds of stitches, to set or to paint with.

use super::color32;
use crate::window::catalogue::{Group, KINDS, Kind};
use crate::window::editor::Editor;
use egui::{Color32, Ui};
use render::palette;

/// The colour of a stitch in the picture.
pub fn color(symbol: &str) -> Color32 {
    color32(palette::stitch(symbol, 0))
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
    let shown = |k: &&Kind| k.symbol.contains(&wanted) || k.name().to_lowercase().contains(&wanted);
    for (group, heading) in Group::ALL {
        let kinds: Vec<&Kind> = KINDS.iter().filter(|k| k.group == group).filter(shown).collect();
        if kinds.is_empty() {
            continue;
        }
        ui.label(egui::RichText::new(heading).weak());
        ui.horizontal_wrapped(|ui| {
            ui.spacing_mut().item_spacing = egui::vec2(3.0, 3.0);
            for kind in kinds {
                stitch(editor, ui, kind);
            }
        });
    }
}

fn stitch(editor: &mut Editor, ui: &mut Ui, kind: &'static Kind) {
    let chosen = editor.brush.to_string() == kind.symbol;
    // The fills are light: dark letters on all of them.
    let text = egui::RichText::new(kind.symbol).color(Color32::BLACK).monospace();
    let stroke =
        if chosen { egui::Stroke::new(2.5, ui.visuals().strong_text_color()) } else { egui::Stroke::NONE };
    let button =
        egui::Button::new(text).fill(color(kind.symbol)).stroke(stroke).min_size(egui::vec2(36.0, 20.0));
    let response = ui.add(button);
    response.widget_info(|| {
        egui::WidgetInfo::labeled(egui::Role::Button, true, format!("{} · {}", kind.symbol, kind.name()))
    });
    let what = "sets what is selected; with nothing selected, the stitch to paint with";
    if response.on_hover_text(format!("{} ({})\n{what}", kind.name(), kind.symbol)).clicked() {
        kind.choose(editor);
    }
}
