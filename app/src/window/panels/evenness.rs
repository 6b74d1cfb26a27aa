//! How even the stitches are: relaxing them, and those furthest from even.

use crate::drawing::Stage;
use crate::window::actions::{button, choice};
use crate::window::editor::Editor;
use crate::window::selection::{Change, Picked};
use egui::Ui;
use stitch_mesh::ids::FaceId;

/// Shows it.
pub fn show(editor: &mut Editor, ui: &mut Ui) {
    ui.heading("Evenness");
    ui.horizontal(|ui| {
        for (i, (name, what)) in [
            ("Aspect", "Height of a stitch over its width at rest"),
            ("Fill", "How much of the surface stitches fill at rest"),
        ]
        .into_iter()
        .enumerate()
        {
            let label = ui.label(name);
            let most = if i == 0 { 3.0 } else { 1.0 };
            let field = egui::DragValue::new(&mut editor.panel.relax[i]).range(0.2..=most).speed(0.01);
            ui.add(field).labelled_by(label.id).on_hover_text(what);
        }
    });
    ui.checkbox(&mut editor.panel.relax_on_surface, "On the surface").on_hover_text(
        "Stitches stay on the smooth surface of the input mesh; otherwise they find a shape of their own",
    );
    ui.horizontal(|ui| {
        button(editor, ui, "Relax mesh");
        let marked = editor.strained && editor.stage == Stage::Stitches;
        choice(editor, ui, "Show strain", marked);
    });
    worst(editor, ui);
}

/// The stitches furthest from even; a click shows one.
fn worst(editor: &mut Editor, ui: &mut Ui) {
    let survey = editor.survey.clone();
    let Some(strain) = &survey.facts.mesh_strain else { return };
    let percent = |s: f64| 100.0 * s;
    ui.label(format!("{:.1} % from even in the mean (rms)", percent(strain.rms)));
    ui.label("Furthest from it");
    let current = survey.revision == editor.view.revision;
    for face in &strain.worst {
        let way = if face.strain > 0.0 { "stretched" } else { "pressed" };
        let text = format!("stitch {}: {:.0} % {way}", face.face, percent(face.strain.abs()));
        let button = egui::Button::new(text).frame(false);
        if ui.add_enabled(current, button).on_hover_text("Select it and look at it").clicked() {
            editor.go_to(Stage::Stitches);
            editor.select(Picked::Faces(vec![FaceId(face.face)]), Change::Replace);
            editor.frame_selected();
        }
    }
}
