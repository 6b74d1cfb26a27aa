//! Simulation, scene and material.

use crate::command::Command;
use crate::scenes;
use crate::window::actions::button;
use crate::window::editor::Editor;
use egui::Ui;
use sim_core::{Material, SimCommand};

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
                match scenes::scene(name, fabric, &view.project.material) {
                    Ok(scene) => editor.act(Command::SetScene { scene }),
                    Err(error) => editor.error = Some(format!("{error:#}")),
                }
            }
        }
    });
    ui.separator();
    material(editor, ui);
}

fn material(editor: &mut Editor, ui: &mut Ui) {
    ui.heading("Material");
    let defaults = Material::for_loop_width(editor.project().size.width);
    let mut material = editor.panel.material.take().unwrap_or_else(|| editor.project().material.clone());
    let (mut moving, mut done) = (false, false);
    let fields = [
        ("Bending", &mut material.bending_modulus, defaults.bending_modulus),
        ("Wrapping", &mut material.wrap_stiffness, defaults.wrap_stiffness),
        ("Friction", &mut material.friction, defaults.friction),
    ];
    for (name, value, default) in fields {
        // Shown as multiples of the wool that goes with the stitch size; absolute values stand in the project.
        let mut factor = *value / default;
        let label = ui.label(format!("{name}  × {factor:.2}"));
        let slider = egui::Slider::new(&mut factor, 0.05..=20.0).logarithmic(true).show_value(false);
        let response = ui.add(slider).labelled_by(label.id);
        if response.changed() {
            *value = factor * default;
        }
        moving |= response.dragged();
        done |= response.drag_stopped() || (response.changed() && !response.dragged());
    }
    if moving {
        // The fabric answers while the slider moves; the history gets one step when it is let go.
        editor.sim.send(SimCommand::SetMaterial(material.clone()));
        editor.panel.material = Some(material);
    } else if done {
        editor.act(Command::SetMaterial { material });
    }
}
