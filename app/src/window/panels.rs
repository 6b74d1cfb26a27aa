//! The panels around the viewport.

use super::editor::Editor;
use super::session::{Request, View};
use super::tools::Tool;
use crate::command::Command;
use crate::drawing::Stage;
use crate::scenes;
use egui::{RichText, Ui};
use render::{NamedView, palette};
use sim_core::{Material, SimCommand};
use std::path::PathBuf;

/// Charts on the palette.
const CHARTS: [(&str, &[&str]); 6] = [
    ("Stockinette", &["k"]),
    ("Reverse stockinette", &["p"]),
    ("Garter", &["k", "p"]),
    ("Rib 1 × 1", &["k p"]),
    ("Rib 2 × 2", &["k k p p"]),
    ("Seed", &["k p", "p k"]),
];

/// Stitches on the palette, with the names that knitters use.
const STITCHES: [(&str, &str); 4] =
    [("k", "knit"), ("p", "purl"), ("k1", "knit, twisted"), ("p1", "purl, twisted")];

/// Kinds of problems shown; the rest waits until these are mended.
const MOST_PROBLEMS: usize = 12;

/// What the panels remember between frames.
pub struct State {
    /// The path field.
    pub path: String,
    /// The stitch size field [mm].
    pub width_mm: f64,
    /// Width over height of the viewport.
    pub aspect: f32,
    /// The yarn while a slider moves.
    pub material: Option<Material>,
}

impl State {
    /// Fields as they stand for a freshly opened document.
    pub fn of(view: &View) -> Self {
        Self {
            path: view.path.as_ref().map(|p| p.display().to_string()).unwrap_or_default(),
            width_mm: 1e3 * view.project.size.width,
            aspect: 4.0 / 3.0,
            material: None,
        }
    }
}

/// Files, undo, stages, play.
pub fn top(editor: &mut Editor, ui: &mut Ui) {
    egui::Panel::top("top").show(ui, |ui| {
        ui.horizontal_wrapped(|ui| {
            if ui
                .button("Open…")
                .on_hover_text("Open a project or a mesh; without a file dialog, write its path in the field")
                .clicked()
            {
                open(editor);
            }
            let field =
                egui::TextEdit::singleline(&mut editor.panel.path).hint_text("path").desired_width(180.0);
            let response = ui.add(field);
            if response.lost_focus() && ui.input(|i| i.key_pressed(egui::Key::Enter)) {
                editor.request(Request::Open(PathBuf::from(editor.panel.path.trim())));
            }
            if ui.button("Save").on_hover_text("Ctrl+S").clicked() {
                editor.save();
            }
            ui.separator();
            let undo = editor.view.done.last().cloned();
            let hover = undo.as_deref().unwrap_or("nothing").to_owned();
            if ui
                .add_enabled(undo.is_some(), egui::Button::new("⟲ Undo"))
                .on_hover_text(format!("{hover} (Ctrl+Z)"))
                .clicked()
            {
                editor.request(Request::Undo);
            }
            let redo = editor.view.redo.clone();
            let hover = redo.as_deref().unwrap_or("nothing").to_owned();
            if ui
                .add_enabled(redo.is_some(), egui::Button::new("⟳ Redo"))
                .on_hover_text(format!("{hover} (Ctrl+Shift+Z)"))
                .clicked()
            {
                editor.request(Request::Redo);
            }
            ui.separator();
            let has_fabric = editor.project().fabric.is_some();
            for (i, (stage, name)) in
                Stage::ALL.into_iter().zip(["Mesh", "Labels", "Stitches", "Yarn"]).enumerate()
            {
                let enabled = has_fabric || matches!(stage, Stage::Mesh | Stage::Labels);
                let tab = ui.add_enabled(enabled, egui::Button::selectable(editor.stage == stage, name));
                let why = if enabled {
                    format!("Key {}", i + 1)
                } else {
                    "Tessellate the labelled mesh first".into()
                };
                if tab.on_hover_text(&why).on_disabled_hover_text(&why).clicked() {
                    editor.go_to(stage);
                }
            }
            ui.separator();
            let play = if editor.playing { "⏸ Pause" } else { "▶ Play" };
            if ui.add_enabled(has_fabric, egui::Button::new(play)).on_hover_text("Space").clicked() {
                editor.set_playing(!editor.playing);
                editor.go_to(Stage::Yarn);
            }
            ui.separator();
            if ui.button("Frame").on_hover_text("Fit the view (F)").clicked() {
                editor.frame(None);
            }
            for (name, view) in [("Front", NamedView::Front), ("Back", NamedView::Back)] {
                if ui.button(name).clicked() {
                    editor.frame(Some(view));
                }
            }
        });
    });
}

fn open(editor: &mut Editor) {
    // The portal's dialog has an event loop of its own; it runs beside the window and answers as a request.
    let field = PathBuf::from(editor.panel.path.trim());
    let current = editor.view.path.as_ref() == Some(&field);
    if !current && field.is_file() {
        editor.request(Request::Open(field));
    } else {
        editor.session.ask_for_file();
    }
}

/// Messages and the state of the simulation.
pub fn status(editor: &mut Editor, ui: &mut Ui) {
    egui::Panel::bottom("status").show(ui, |ui| {
        ui.horizontal(|ui| {
            if editor.session.is_busy() {
                ui.spinner();
                ui.label("working…");
            }
            let sim_error = editor.snapshot.as_ref().and_then(|s| s.error.clone());
            if let Some(error) = editor.error.as_ref().or(sim_error.as_ref()) {
                ui.colored_label(ui.visuals().error_fg_color, error);
            } else if let Ok(message) = &editor.view.message {
                ui.label(message);
            }
            ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
                if let Some(s) = &editor.snapshot {
                    ui.label(format!("{:.2} s simulated, {:.0} ms a step", s.time_s, s.ms_per_step));
                }
            });
        });
    });
}

/// Tools of the stage.
pub fn left(editor: &mut Editor, ui: &mut Ui) {
    egui::Panel::left("tools").exact_size(190.0).resizable(false).show(ui, |ui| {
        egui::ScrollArea::vertical().show(ui, |ui| {
            ui.heading("Tools");
            let tools = Tool::of(editor.stage);
            if tools.is_empty() {
                ui.label("The mesh as it was read. Go on to Labels.");
            }
            for (tool, name, what) in tools {
                if ui.selectable_label(editor.tool == *tool, *name).on_hover_text(*what).clicked() {
                    editor.tool = *tool;
                }
            }
            ui.separator();
            match editor.stage {
                Stage::Mesh => {}
                Stage::Labels => labels(editor, ui),
                Stage::Stitches => palette_of(editor, ui),
                Stage::Yarn => {
                    palette_of(editor, ui);
                    ui.separator();
                    yarn(editor, ui);
                }
            }
        });
    });
}

fn labels(editor: &mut Editor, ui: &mut Ui) {
    if ui.button("Label automatically").clicked() {
        editor.act(Command::Autolabel);
    }
    if ui.button("Clear labels").clicked() {
        editor.act(Command::ClearLabels);
    }
    ui.separator();
    ui.label("Stitch width");
    ui.add(egui::DragValue::new(&mut editor.panel.width_mm).range(0.5..=100.0).speed(0.1).suffix(" mm"));
    let complete = editor.project().labelled.problems().is_empty();
    let button = ui.add_enabled(complete, egui::Button::new("Tessellate"));
    if button.on_disabled_hover_text("Every face needs a row first").clicked() {
        editor.act(Command::Tessellate { width_mm: Some(editor.panel.width_mm) });
        editor.go_to(Stage::Stitches);
    }
}

fn swatch(ui: &mut Ui, symbol: &str) {
    let [r, g, b] = palette::stitch(symbol, 0);
    let color = egui::Rgba::from_rgb(r, g, b);
    let (rect, _) = ui.allocate_exact_size(egui::vec2(14.0, 14.0), egui::Sense::hover());
    ui.painter().rect_filled(rect, 2.0, color);
}

fn palette_of(editor: &mut Editor, ui: &mut Ui) {
    ui.heading("Stitch");
    for (symbol, name) in STITCHES {
        ui.horizontal(|ui| {
            swatch(ui, symbol);
            let chosen = editor.brush.to_string() == symbol;
            if ui.selectable_label(chosen, format!("{symbol}  {name}")).clicked()
                && let Ok(stitch) = symbol.parse()
            {
                editor.brush = stitch;
            }
        });
    }
    ui.separator();
    ui.heading("All over");
    for (name, chart) in CHARTS {
        if ui.button(name).clicked() {
            let chart = chart.iter().map(|line| (*line).to_owned()).collect();
            editor.act(Command::SetChart { chart, rows: None, faces: None });
        }
    }
}

fn yarn(editor: &mut Editor, ui: &mut Ui) {
    ui.heading("Simulation");
    ui.horizontal(|ui| {
        if ui.button("Step").clicked() {
            editor.sim.send(SimCommand::StepOnce);
        }
        if ui.button("Lay anew").on_hover_text("Put the yarn back to where it was laid").clicked() {
            editor.act(Command::ResetYarn);
        }
    });
    ui.label("Scene");
    let state = editor.project().fabric.as_ref().map(|f| f.state());
    for (name, what) in scenes::NAMED {
        if ui.button(name).on_hover_text(what).clicked()
            && let Some(Ok(scene)) = state.as_deref().map(|s| scenes::scene(name, s))
        {
            editor.act(Command::SetScene { scene });
        }
    }
    ui.separator();
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

/// History, facts and problems.
pub fn right(editor: &mut Editor, ui: &mut Ui) {
    egui::Panel::right("facts").exact_size(230.0).resizable(false).show(ui, |ui| {
        egui::ScrollArea::vertical().show(ui, |ui| {
            ui.heading("Fabric");
            let facts = &editor.view.facts;
            let [x, y, z] = facts.size_mm;
            ui.label(format!("{} faces in {} rows", facts.faces, facts.rows));
            if facts.loops > 0 {
                ui.label(format!("{} loops, {:.1} m of yarn", facts.loops, facts.yarn_length_m));
                ui.label(format!("{} with ends, {} rings", facts.yarns.open, facts.yarns.closed));
                for (symbol, count) in &facts.stitches {
                    ui.horizontal(|ui| {
                        swatch(ui, symbol);
                        ui.label(format!("{count} × {symbol}"));
                    });
                }
            }
            ui.label(format!("{x:.0} × {y:.0} × {z:.0} mm"));
            ui.separator();
            ui.heading("Problems");
            if facts.problems.is_empty() {
                ui.label("none");
            }
            for problem in facts.grouped_problems().iter().take(MOST_PROBLEMS) {
                ui.colored_label(ui.visuals().warn_fg_color, problem);
            }
            ui.separator();
            ui.heading("History");
            if editor.view.done.is_empty() {
                ui.label(RichText::new("nothing done yet").weak());
            }
            let can_script = !editor.view.done.is_empty();
            for name in editor.view.done.iter().rev().take(40) {
                ui.label(name);
            }
            if let Some(redo) = &editor.view.redo {
                ui.label(RichText::new(format!("{redo} (undone)")).weak());
            }
            if can_script
                && ui.button("Save as script").on_hover_text("Beside the project, as .jsonl").clicked()
            {
                let path = PathBuf::from(editor.panel.path.trim()).with_extension("jsonl");
                editor.request(Request::SaveScript(path));
            }
        });
    });
}
