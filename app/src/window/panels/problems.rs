//! What keeps the mesh from being knitted; a click shows where.

use crate::drawing::Stage;
use crate::problems::{Of, Problem};
use crate::window::editor::Editor;
use crate::window::selection::{Change, Picked};
use egui::{RichText, Ui};
use stitch_mesh::ids::{FaceId, VertexId};

/// Different problems shown, and places of each; the rest waits until these are mended.
const MOST: usize = 20;
const NAMED: usize = 12;

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
        let groups = survey.facts.problem_groups();
        let more = groups.len().saturating_sub(MOST);
        for (what, places) in groups.into_iter().take(MOST) {
            ui.horizontal_wrapped(|ui| {
                for problem in &places[..places.len().min(NAMED)] {
                    let text = RichText::new(&problem.r#where).color(ui.visuals().warn_fg_color);
                    let link = egui::Button::new(text).small();
                    if ui.add_enabled(current, link).on_hover_text("Select it and look at it").clicked() {
                        show_where(editor, problem);
                    }
                }
                if places.len() > NAMED {
                    ui.label(RichText::new(format!("and {} more", places.len() - NAMED)).weak());
                }
            });
            ui.add(egui::Label::new(what).wrap());
            ui.add_space(4.0);
        }
        if more > 0 {
            ui.label(RichText::new(format!("and {more} other problems")).weak());
        }
    });
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
