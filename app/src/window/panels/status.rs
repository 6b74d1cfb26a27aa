//! The line at the bottom: what is going on, what is under the pointer and the keys that act on it, and what went wrong.

use crate::drawing::Stage;
use crate::window::actions::{self, On};
use crate::window::catalogue::describe;
use crate::window::editor::Editor;
use crate::window::selection::Mode;
use crate::window::surface::Surface;
use egui::{RichText, Ui};
use std::time::Duration;
use stitch_mesh::label::EdgeLabel;

/// Work that takes no longer is over before anybody reads about it.
const SHORT: Duration = Duration::from_millis(50);

/// Keys named at once.
const MOST_KEYS: usize = 7;

/// Shows the panel: two lines, so that nothing moves when a message comes.
pub fn show(editor: &mut Editor, ui: &mut Ui) {
    egui::Panel::bottom("status").show(ui, |ui| {
        ui.horizontal(|ui| {
            let under = under_pointer(editor);
            let keys = keys(editor, ui.ctx());
            ui.label(under.unwrap_or_else(|| "Point at something".to_owned()));
            ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
                ui.add(egui::Label::new(RichText::new(keys).weak()).truncate());
            });
        });
        ui.horizontal(|ui| {
            ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
                if let Some(s) = editor.yarn() {
                    ui.label(format!("{:.2} s simulated, {:.0} ms a step", s.time_s, s.ms_per_step));
                }
                ui.with_layout(egui::Layout::left_to_right(egui::Align::Center), |ui| going_on(editor, ui));
            });
        });
    });
}

/// What is going on, or what the last request came to. Where there is no room for all of it, the pointer shows the rest.
fn going_on(editor: &Editor, ui: &mut Ui) {
    if let Some(work) = editor.session.work().filter(|w| w.since.elapsed() > SHORT) {
        ui.spinner();
        ui.label(format!("{} …  {:.0} s", work.name, work.since.elapsed().as_secs_f64()));
        if ui.button("Cancel").on_hover_text("Leave the document as it was before").clicked() {
            editor.session.cancel();
        }
    }
    let sim_error = editor.yarn().and_then(|s| s.error.as_ref());
    let text = match (editor.error.as_ref().or(sim_error), &editor.view.message) {
        (Some(error), _) => RichText::new(error).color(ui.visuals().error_fg_color),
        (None, Ok(message)) => RichText::new(message),
        (None, Err(_)) => return,
    };
    ui.add(egui::Label::new(text).truncate());
}

/// What is under the pointer: "stitch 214, k2tog (d12k), row 12, 7th of 48".
fn under_pointer(editor: &Editor) -> Option<String> {
    let (half, _) = editor.under?;
    let surface = editor.surface();
    let mesh = surface.mesh();
    if editor.selection().mode == Mode::Edge {
        let edge = mesh.edge(half);
        let [a, b] = mesh.edge_ends(edge);
        let label = match surface.label(edge) {
            Some(EdgeLabel::Course) => "course",
            Some(EdgeLabel::Wale) => "wale",
            None => "no label",
        };
        let border = if mesh.is_border(edge) { ", border" } else { "" };
        let cable = match &surface {
            Surface::Stitched(stitches) => stitches.cables().iter().find(|c| c.covers(a, b)),
            Surface::Labelled(_) => None,
        };
        let cable = cable.map_or_else(String::new, |c| format!(", cable {}", c.name()));
        let length = 1e3 * mesh.edge_length(edge);
        let unit = if label == "wale" { "rows" } else { "stitches" };
        let count = editor.count(edge).map_or_else(String::new, |n| format!(", {n} {unit}"));
        return Some(format!("edge {a}–{b}, {label}{count}, {length:.1} mm{border}{cable}"));
    }
    let face = mesh.face(half);
    let (what, place) = match surface {
        Surface::Labelled(_) => (format!("face {face}"), editor.view.labelled_rows.place(face.0)),
        Surface::Stitched(stitches) => (
            format!("stitch {face}, {}", describe(stitches.stitch(face))),
            editor.view.fabric_rows.as_ref().and_then(|rows| rows.place(face.0)),
        ),
    };
    Some(match place {
        // Knitters count from 1.
        Some([row, place, count]) => format!("{what}, row {}, {} of {count}", row + 1, ordinal(place + 1)),
        None => format!("{what}, no row yet"),
    })
}

fn ordinal(n: usize) -> String {
    let ending = match (n % 10, n % 100) {
        (_, 11..=13) => "th",
        (1, _) => "st",
        (2, _) => "nd",
        (3, _) => "rd",
        _ => "th",
    };
    format!("{n}{ending}")
}

/// The keys that act on what is under the pointer, or on the selection.
fn keys(editor: &Editor, ctx: &egui::Context) -> String {
    if editor.stage == Stage::Mesh {
        return "Click selects · drag: box · Shift adds · Ctrl removes · F3 search".to_owned();
    }
    let on = if editor.selection().mode == Mode::Edge { On::Edges } else { On::Faces };
    let acting = actions::all().filter(|a| a.on == on && a.blocked(editor).is_none());
    let named = acting.filter_map(|a| Some(format!("{} {}", a.key_text(ctx)?, a.name.to_lowercase())));
    let mut named: Vec<String> = named.take(MOST_KEYS).collect();
    named.push("F3 search".to_owned());
    named.join(" · ")
}

#[cfg(test)]
mod tests {
    use super::ordinal;

    #[test]
    fn places_are_read_aloud() {
        let read = [1, 2, 3, 4, 11, 12, 13, 21, 22, 48, 111, 101].map(ordinal);
        assert_eq!(
            read,
            ["1st", "2nd", "3rd", "4th", "11th", "12th", "13th", "21st", "22nd", "48th", "111th", "101st"]
        );
    }
}
