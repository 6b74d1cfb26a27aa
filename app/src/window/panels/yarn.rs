//! Simulation and scene; the materials of the yarns.

use super::material;
use crate::command::Command;
use crate::scenes;
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
    ui.label("Scene");
    let view = editor.view.clone();
    ui.horizontal_wrapped(|ui| {
        for (name, what) in scenes::NAMED {
            if ui.button(name).on_hover_text(what).clicked()
                && let Some(fabric) = &view.project.fabric
            {
                match scenes::scene(name, fabric, &view.project.materials.base) {
                    Ok(scene) => editor.act(Command::SetScene { scene }),
                    Err(error) => editor.error = Some(format!("{error:#}")),
                }
            }
        }
    });
    ui.separator();
    material::show(editor, ui);
}
