//! Files, undo, stages, play, views, settings.

use crate::bundled;
use crate::drawing::Stage;
use crate::window::actions::{button, button_as, choice};
use crate::window::editor::Editor;
use crate::window::navigation::Navigation;
use crate::window::panels::leaving::Destination;
use crate::window::panels::path_text;
use crate::window::request::Request;
use egui::Ui;
use render::palette::StitchColors;
use std::path::PathBuf;

/// Shows the panel.
pub fn show(editor: &mut Editor, ui: &mut Ui) {
    egui::Panel::top("top").show(ui, |ui| {
        ui.horizontal_wrapped(|ui| {
            ui.menu_button("New", |ui| {
                for bundled in &bundled::ALL {
                    if ui.button(bundled.name).on_hover_text(bundled.about).clicked() {
                        editor.leave(Destination::Other(Request::Begin(bundled)));
                    }
                }
            })
            .response
            .on_hover_text("Begin with a mesh that comes with the program");
            button(editor, ui, "Open…");
            let field =
                egui::TextEdit::singleline(&mut editor.panel.path).hint_text("path").desired_width(180.0);
            let response =
                ui.add(field).on_hover_text("Where the project is saved; Enter opens what is there");
            ui.ctx().accesskit_node_builder(response.id, |node| node.set_label("Path"));
            if response.lost_focus() && ui.input(|i| i.key_pressed(egui::Key::Enter)) {
                // From now on the field names this document again, or the one that comes.
                let path = std::mem::replace(&mut editor.panel.path, path_text(&editor.view));
                editor.leave(Destination::Other(Request::Open(PathBuf::from(path.trim()))));
            }
            button(editor, ui, "Save");
            ui.separator();
            button_as(editor, ui, "Undo", "⟲ Undo");
            button_as(editor, ui, "Redo", "⟳ Redo");
            ui.separator();
            for (stage, name) in Stage::ALL.into_iter().zip(["Mesh", "Labels", "Stitches", "Yarn"]) {
                choice(editor, ui, name, editor.stage == stage);
            }
            ui.separator();
            button_as(editor, ui, "Play", if editor.playing { "⏸ Pause" } else { "▶ Play" });
            ui.separator();
            for name in ["Front", "Back"] {
                button(editor, ui, name);
            }
            choice(editor, ui, "Chart", editor.chart.is_some());
            choice(editor, ui, "Experiments", editor.panel.lab.open);
            ui.menu_button("View", |ui| {
                for name in ["Frame all", "Frame selected", "Left", "Right", "Top", "Three-quarter"] {
                    button(editor, ui, name);
                }
            })
            .response
            .on_hover_text("Where to look from");
            ui.menu_button("⚙ Settings", |ui| {
                ui.label("Moving the view");
                for (navigation, name, what) in Navigation::ALL {
                    ui.radio_value(&mut editor.navigation, navigation, name).on_hover_text(what);
                }
                ui.label("Colours of stitches");
                for (colors, name, what) in StitchColors::ALL {
                    let choice = ui.radio_value(&mut editor.stitch_colors, colors, name);
                    if choice.on_hover_text(what).changed() {
                        editor.show_stage();
                    }
                }
            })
            .response
            .on_hover_text("How the mouse moves the view, and what colours stitches have");
            button_as(editor, ui, "Search commands", "🔍 Search");
        });
    });
}
