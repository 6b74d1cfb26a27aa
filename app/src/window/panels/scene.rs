//! What surrounds the fabric: scenes by name and from files, what holds it, and how hard.

use crate::scenes;
use crate::window::actions::button;
use crate::window::editor::Editor;
use crate::window::request::Request;
use egui::Ui;
use sim_core::HoldFact;

/// Forces shown at once.
const MOST: usize = 12;

/// Shows them.
pub fn show(editor: &mut Editor, ui: &mut Ui) {
    ui.heading("Scene");
    let has_fabric = editor.project().fabric.is_some();
    ui.horizontal_wrapped(|ui| {
        for (name, what) in scenes::NAMED {
            if ui.button(name).on_hover_text(what).clicked() && has_fabric {
                editor.request(Request::Scene(name.to_owned()));
            }
        }
    });
    ui.horizontal(|ui| {
        let field =
            egui::TextEdit::singleline(&mut editor.panel.scene).hint_text("scene file").desired_width(120.0);
        let typed = ui.add(field);
        let entered = typed.lost_focus() && ui.input(|i| i.key_pressed(egui::Key::Enter));
        typed.on_hover_text("A scene file; docs/scenes.md says how to write one");
        let named = has_fabric && !editor.panel.scene.trim().is_empty();
        if (ui.add_enabled(named, egui::Button::new("Load")).clicked() || entered) && named {
            editor.request(Request::Scene(editor.panel.scene.trim().to_owned()));
        }
    });
    ui.horizontal(|ui| {
        button(editor, ui, "Hold");
        button(editor, ui, "Let go");
    });
    let mut holds = editor.yarn().map(|s| s.holds.clone()).unwrap_or_default();
    holds.retain(HoldFact::is_felt);
    for HoldFact { what, force_n } in holds.iter().take(MOST) {
        let [x, y, z] = (1e3 * *force_n).to_array();
        // In one label, which goes on in the next line where a name is long.
        ui.label(format!("{what}: {:.2} mN", 1e3 * force_n.length()))
            .on_hover_text(format!("Force on the fabric: {x:.2}, {y:.2}, {z:.2} mN"));
    }
    if holds.len() > MOST {
        ui.label(format!("and {} more", holds.len() - MOST));
    }
}
