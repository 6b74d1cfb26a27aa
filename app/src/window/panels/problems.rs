//! What keeps the mesh from being knitted; a click shows where.

use crate::drawing::Stage;
use crate::problems::{Of, Problem};
use crate::window::editor::Editor;
use crate::window::selection::{Change, Picked};
use egui::{RichText, Ui};
use stitch_mesh::ids::{FaceId, VertexId};

/// Problems shown; the rest waits until these are mended.
const MOST: usize = 40;

/// Shows them.
pub fn show(editor: &mut Editor, ui: &mut Ui) {
    ui.heading("Problems");
    let survey = editor.survey.clone();
    let problems = &survey.facts.problems;
    // Those of an earlier state may lie on faces that are no more.
    let current = survey.revision == editor.view.revision;
    if problems.is_empty() {
        ui.label("none");
        return;
    }
    egui::ScrollArea::vertical().id_salt("problems").max_height(200.0).show(ui, |ui| {
        for problem in problems.iter().take(MOST) {
            let text = RichText::new(format!("{}: {}", problem.r#where, problem.what));
            let button = egui::Button::new(text.color(ui.visuals().warn_fg_color)).wrap().frame(false);
            if ui.add_enabled(current, button).on_hover_text("Select it and look at it").clicked() {
                show_where(editor, problem);
            }
        }
    });
    if problems.len() > MOST {
        ui.label(RichText::new(format!("and {} more", problems.len() - MOST)).weak());
    }
}

fn show_where(editor: &mut Editor, problem: &Problem) {
    editor.go_to(match problem.of {
        Of::Input => Stage::Labels,
        Of::Stitches => Stage::Stitches,
    });
    let mesh = editor.surface().mesh();
    let edge = problem.edge.and_then(|[a, b]| mesh.edge_between(VertexId(a), VertexId(b)));
    match (problem.face, edge) {
        (Some(face), _) => editor.select(Picked::Faces(vec![FaceId(face)]), Change::Replace),
        (None, Some(edge)) => editor.select(Picked::Edges(vec![edge]), Change::Replace),
        (None, None) => return,
    }
    editor.frame_selected();
}
