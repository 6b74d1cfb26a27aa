//! The simulation: its steps, its scene, the materials of its yarns.

use super::{material, scene};
use crate::window::actions::button;
use crate::window::editor::Editor;
use egui::Ui;

/// Shows them.
pub fn show(editor: &mut Editor, ui: &mut Ui) {
    ui.heading("Simulation");
    ui.horizontal(|ui| {
        button(editor, ui, "Step");
        button(editor, ui, "Lay anew");
    });
    ui.separator();
    scene::show(editor, ui);
    ui.separator();
    material::show(editor, ui);
}
