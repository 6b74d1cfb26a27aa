//! How many stitches go where, and what that comes to, before it is done.

use crate::command::Command;
use crate::preview::{Consequences, preview};
use crate::project::Project;
use crate::window::actions::button;
use crate::window::editor::Editor;
use egui::{RichText, Ui};
use stitch_mesh::edge_counts::{EdgeCounts, StitchSize};
use stitch_mesh::ids::EdgeId;

/// Shows it.
pub fn show(editor: &mut Editor, ui: &mut Ui) {
    ui.heading("Counts");
    ui.horizontal(|ui| {
        let label = ui.label("Stitch width");
        let width = egui::DragValue::new(&mut editor.panel.width_mm);
        let field = ui.add(width.range(0.5..=100.0).speed(0.1).suffix(" mm")).labelled_by(label.id);
        if field.on_hover_text("All edges are counted anew from it").changed() {
            editor.panel.width_changed = true;
        }
    });
    if editor.project().labelled.check_complete().is_ok() {
        selected_edges(editor, ui);
        consequences(editor, ui);
    } else {
        ui.label(RichText::new("Every face needs a row first").weak());
    }
    button(editor, ui, "Tessellate");
}

/// The count of the selected edges, and their marks.
fn selected_edges(editor: &mut Editor, ui: &mut Ui) {
    let project = editor.project();
    let edges: Vec<EdgeId> = editor.selection().edges.iter().copied().collect();
    let Some(first) = edges.first() else {
        ui.label(RichText::new("Select edges to change how many stitches go on them").weak());
        return;
    };
    let known =
        project.counts.clone().or_else(|| EdgeCounts::from_size(&project.labelled, project.size).ok());
    let Some(counts) = known else { return };
    let Some(now) = counts.counts.get(first.index()).copied() else { return };
    let same = edges.iter().all(|e| counts.counts.get(e.index()) == Some(&now));
    let is_wale = edges.iter().all(|e| project.labelled.is_wale(*e));
    let marked = edges.iter().all(|e| counts.marked.contains(e));
    let mesh = project.labelled.mesh();
    let ends: Vec<[u32; 2]> = edges.iter().map(|e| mesh.edge_ends(*e).map(|v| v.0)).collect();
    let mut wanted = now;
    ui.horizontal_wrapped(|ui| {
        let label = ui.label(if is_wale { "Rows" } else { "On each edge" });
        if ui.add_enabled(now > 1, egui::Button::new("−")).on_hover_text("One fewer").clicked() {
            wanted = now - 1;
        }
        let mut typed = now;
        let field = egui::DragValue::new(&mut typed).range(1..=10_000).update_while_editing(false);
        let field =
            ui.add(field).labelled_by(label.id).on_hover_text("How many on each of the selected edges");
        if field.changed() {
            wanted = typed;
        }
        if ui.button("+").on_hover_text("One more").clicked() {
            wanted = now + 1;
        }
        if !same {
            ui.label(RichText::new("not the same everywhere now").weak());
        }
    });
    if wanted != now {
        editor.panel.width_changed = false;
        editor.act(Command::SetEdgeCounts { edges: ends, count: wanted });
        return;
    }
    let mut mark = marked;
    let check = ui.add_enabled(is_wale, egui::Checkbox::new(&mut mark, "Shape along these edges"));
    let check = check.on_hover_text("Increases and decreases beside marked wale edges all lie along them");
    if check.on_disabled_hover_text("Wale edges only").changed() {
        editor.act(Command::MarkWale { edges: ends, marked: mark });
    }
}

/// The last answer, and the revision and width it is for: counting again at every frame would be a waste.
#[derive(Default)]
pub struct Forecast(Option<(u64, Option<f64>, Result<Consequences, String>)>);

fn consequences(editor: &mut Editor, ui: &mut Ui) {
    let width = editor.panel.width_changed.then_some(editor.panel.width_mm);
    let view = editor.view.clone();
    let slot = &mut editor.panel.forecast.0;
    if !slot.as_ref().is_some_and(|(revision, w, _)| (*revision, *w) == (view.revision, width)) {
        *slot = None;
    }
    let (.., answer) = slot.get_or_insert_with(|| {
        (view.revision, width, ask(&view.project, width).map_err(|e| format!("{e:#}")))
    });
    match answer {
        Ok(consequences) => ui.label(said(*consequences)),
        Err(error) => ui.colored_label(ui.visuals().error_fg_color, error.as_str()),
    };
}

/// What tessellating comes to: with a new stitch width [mm], or as edges are counted now.
fn ask(project: &Project, width_mm: Option<f64>) -> anyhow::Result<Consequences> {
    let size = width_mm.map_or(project.size, |mm| StitchSize::of_width(mm * 1e-3));
    match &project.counts {
        Some(counts) if width_mm.is_none() => preview(project, counts),
        _ => preview(project, &EdgeCounts::from_size(&project.labelled, size)?),
    }
}

/// As in "1 204 ▶ 1 260 stitches, 44 ▶ 46 rows, 12 increases, 8 decreases".
fn said(Consequences { before, after }: Consequences) -> String {
    let change = |before: u64, after: u64, what: &str| match before {
        0 => format!("{} {what}", grouped(after)),
        same if same == after => format!("{} {what}", grouped(after)),
        before => format!("{} ▶ {} {what}", grouped(before), grouped(after)),
    };
    [
        change(before.stitches, after.stitches, "stitches"),
        change(before.rows, after.rows, "rows"),
        format!("{} increases", grouped(after.increases)),
        format!("{} decreases", grouped(after.decreases)),
    ]
    .join(", ")
}

/// A number in groups of three digits.
fn grouped(number: u64) -> String {
    let digits = number.to_string();
    let mut text = String::new();
    for (i, digit) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i).is_multiple_of(3) {
            text.push('\u{2009}');
        }
        text.push(digit);
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use stitch_mesh::edge_totals::Totals;

    #[test]
    fn consequences_read_well() {
        let before = Totals { stitches: 1204, rows: 46, ..Totals::default() };
        let after = Totals { stitches: 1260, increases: 12, decreases: 8, rows: 46 };
        let said = said(Consequences { before, after }).replace('\u{2009}', " ");
        assert_eq!(said, "1 204 ▶ 1 260 stitches, 46 rows, 12 increases, 8 decreases");
        assert_eq!(grouped(1_234_567).replace('\u{2009}', " "), "1 234 567");
    }
}
