//! Facts, problems, history.

use super::{history, palette, problems};
use crate::window::catalogue::describe;
use crate::window::editor::Editor;
use egui::Ui;

/// Shows the panel.
pub fn show(editor: &mut Editor, ui: &mut Ui) {
    egui::Panel::right("facts").exact_size(236.0).resizable(false).show(ui, |ui| {
        // Beside what is scrolled, not over it.
        ui.spacing_mut().scroll.floating_allocated_width = 6.0;
        egui::ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
            facts(editor, ui);
            ui.separator();
            problems::show(editor, ui);
            ui.separator();
            history::show(editor, ui);
        });
    });
}

fn facts(editor: &Editor, ui: &mut Ui) {
    ui.heading("Fabric");
    let facts = &editor.survey.facts;
    let [x, y, z] = facts.size_mm;
    ui.label(format!("{} faces in {} rows", facts.faces, facts.rows));
    if facts.loops > 0 {
        ui.label(format!("{} loops, {:.1} m of yarn", facts.loops, facts.yarn_length_m));
        ui.label(format!("{} with ends, {} rings", facts.yarns.open, facts.yarns.closed));
        for (symbol, count) in &facts.stitches {
            ui.horizontal(|ui| {
                let (rect, _) = ui.allocate_exact_size(egui::vec2(14.0, 14.0), egui::Sense::hover());
                ui.painter().rect_filled(rect, 2.0, palette::color(editor, symbol));
                let name = symbol.parse().map_or_else(|_| symbol.clone(), |stitch| describe(&stitch));
                // In one line; the pointer shows the rest of long names.
                ui.add(egui::Label::new(format!("{count} × {name}")).truncate());
            });
        }
    }
    ui.label(format!("{x:.0} × {y:.0} × {z:.0} mm"));
}
