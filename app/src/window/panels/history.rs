//! The history by name; a click goes there.

use crate::window::actions::button;
use crate::window::editor::Editor;
use crate::window::request::Request;
use egui::{RichText, Ui};

/// Shows it, the latest step on top, above the beginning.
pub fn show(editor: &mut Editor, ui: &mut Ui) {
    ui.heading("History");
    let (done, undone) = (&editor.view.done, &editor.view.undone);
    let mut wanted = None;
    let mut line = |ui: &mut Ui, steps: usize, name: &str| {
        let now = steps == done.len();
        let text = if steps > done.len() { RichText::new(name).weak() } else { RichText::new(name) };
        let button =
            egui::Button::selectable(now, text).truncate().min_size(egui::vec2(ui.available_width(), 0.0));
        let what = if now { "The document is here" } else { "Go to after this step" };
        if ui.add(button).on_hover_text(what).clicked() && !now {
            wanted = Some(steps);
        }
    };
    let steps: Vec<(usize, &String)> = done.iter().chain(undone).enumerate().collect();
    egui::ScrollArea::vertical().id_salt("history").max_height(260.0).show(ui, |ui| {
        for (i, name) in steps.into_iter().rev() {
            line(ui, i + 1, name);
        }
        line(ui, 0, "Beginning");
    });
    if let Some(steps) = wanted {
        editor.request(Request::GoTo(steps));
    }
    ui.horizontal_wrapped(|ui| {
        button(editor, ui, "Save script");
        button(editor, ui, "Save instructions");
    });
}
