//! How the yarns of single stitches are wrapped around each other, where it is not as their material has it.

use crate::command::Command;
use crate::window::actions::button;
use crate::window::editor::Editor;
use egui::Ui;

/// What stands in the fields.
pub struct Fields {
    /// Factor on the modulus of the material.
    modulus: f64,
    /// Angle at rest [°].
    angle_deg: f64,
    /// Whether the angle is that of the material.
    of_material: bool,
}

impl Default for Fields {
    fn default() -> Self {
        Self { modulus: 1.0, angle_deg: 90.0, of_material: true }
    }
}

impl Fields {
    /// The command that wraps some stitches so.
    pub fn command(&self, faces: Vec<u32>) -> Command {
        let angle_deg = (!self.of_material).then_some(self.angle_deg);
        Command::SetWrap { faces, modulus: Some(self.modulus), angle_deg }
    }
}

/// Shows them.
pub fn show(editor: &mut Editor, ui: &mut Ui) {
    ui.heading("Wrapping");
    let fields = &mut editor.panel.wrap;
    ui.horizontal(|ui| {
        let label = ui.label("Modulus");
        let modulus = egui::DragValue::new(&mut fields.modulus).range(0.0..=1e3).speed(0.01).prefix("× ");
        ui.add(modulus).labelled_by(label.id).on_hover_text(
            "Factor on how strongly the yarns of a material are wrapped: 0 does not curl, 1 is as the material has it",
        );
        let label = ui.label("Angle");
        let angle = egui::DragValue::new(&mut fields.angle_deg).range(0.0..=180.0).suffix("°");
        ui.add_enabled(!fields.of_material, angle)
            .labelled_by(label.id)
            .on_hover_text("Angle at which the wrapped yarns are at rest");
    });
    ui.checkbox(&mut fields.of_material, "Angle of the material");
    button(editor, ui, "Wrap");
}
