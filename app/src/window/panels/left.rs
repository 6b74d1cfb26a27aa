//! Tools and what they work with, stage by stage.

use super::{colour, evenness, library, palette, patterns, strands, tessellation, wrapping, yarn};
use crate::drawing::Stage;
use crate::window::actions::{button, button_as, choice};
use crate::window::editor::Editor;
use crate::window::pointer::Tool;
use crate::window::selection::Mode;
use egui::Ui;

/// Which tools are shown for a fabric.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Tab {
    /// Kinds of stitches.
    Palette,
    /// Written patterns.
    Library,
    /// What is done to a fabric beside.
    Finish,
    /// The simulation.
    Simulate,
}

/// Shows the panel.
pub fn show(editor: &mut Editor, ui: &mut Ui) {
    egui::Panel::left("tools").exact_size(222.0).resizable(false).show(ui, |ui| {
        // Beside what is scrolled, not over it.
        ui.spacing_mut().scroll.floating_allocated_width = 6.0;
        egui::ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
            ui.horizontal_wrapped(|ui| {
                let tools: &[(&str, Tool)] = match editor.stage {
                    Stage::Mesh => &[("Select", Tool::Select), ("Brush select", Tool::Brush)],
                    Stage::Labels => &[("Select", Tool::Select)],
                    Stage::Stitches => {
                        &[("Select", Tool::Select), ("Brush select", Tool::Brush), ("Paint", Tool::Paint)]
                    }
                    Stage::Yarn => &[
                        ("Select", Tool::Select),
                        ("Brush select", Tool::Brush),
                        ("Paint", Tool::Paint),
                        ("Grab", Tool::Grab),
                        ("Scissors", Tool::Scissors),
                    ],
                };
                for (name, tool) in tools {
                    choice(editor, ui, name, editor.tool == *tool);
                }
            });
            if editor.tool == Tool::Brush {
                let label = ui.label("Radius");
                let radius = egui::Slider::new(&mut editor.panel.brush_radius, 5.0..=200.0);
                ui.add(radius.suffix(" px")).labelled_by(label.id);
            }
            ui.horizontal(|ui| {
                for (mode, name) in Mode::ALL {
                    choice(editor, ui, name, editor.selection().mode == mode);
                }
            });
            selected(editor, ui);
            ui.separator();
            match editor.stage {
                Stage::Mesh => {
                    ui.label("The mesh as it was read. Go on to Labels.");
                }
                Stage::Labels => labels(editor, ui),
                Stage::Stitches | Stage::Yarn => fabric(editor, ui),
            }
        });
    });
}

/// Everything that changes the fabric, by tabs so that each fits without scrolling.
fn fabric(editor: &mut Editor, ui: &mut Ui) {
    let in_yarn = editor.stage == Stage::Yarn;
    let tab = match editor.panel.tab {
        Tab::Simulate if !in_yarn => Tab::Palette,
        tab => tab,
    };
    ui.horizontal_wrapped(|ui| {
        for (shown, name, what) in [
            (Tab::Palette, "Palette", "Kinds of stitches, and patterns of knit and purl"),
            (Tab::Library, "Library", "Written patterns, to be tiled over the fabric"),
            (Tab::Finish, "Finish", "Copies, colours, cables, seams, structure, wrapping and evenness"),
            (Tab::Simulate, "Simulate", "The simulation, its scene and its yarn"),
        ] {
            let fits = shown != Tab::Simulate || in_yarn;
            if fits && ui.selectable_label(tab == shown, name).on_hover_text(what).clicked() {
                editor.panel.tab = shown;
            }
        }
    });
    ui.separator();
    match tab {
        Tab::Palette => {
            palette::show(editor, ui);
            button(editor, ui, "Fill region");
            ui.separator();
            patterns::show(editor, ui);
        }
        Tab::Library => library::show(editor, ui),
        Tab::Finish => {
            copies(editor, ui);
            ui.separator();
            colour::show(editor, ui);
            ui.separator();
            edges(editor, ui);
            ui.separator();
            wrapping::show(editor, ui);
            ui.separator();
            evenness::show(editor, ui);
        }
        Tab::Simulate => yarn::show(editor, ui),
    }
}

fn copies(editor: &mut Editor, ui: &mut Ui) {
    ui.heading("Copies");
    ui.horizontal_wrapped(|ui| {
        for name in ["Copy", "Mirror copy", "Paste"] {
            button(editor, ui, name);
        }
    });
}

/// What is selected, in words.
fn selected(editor: &Editor, ui: &mut Ui) {
    let selection = editor.selection();
    let count = |n: usize, one: &str| match n {
        0 => None,
        1 => Some(format!("1 {one}")),
        n => Some(format!("{n} {one}s")),
    };
    let parts = [
        count(selection.faces.len(), "face"),
        count(selection.edges.len(), "edge"),
        (!selection.hidden.is_empty()).then(|| format!("({} hidden)", selection.hidden.len())),
    ];
    let parts: Vec<String> = parts.into_iter().flatten().collect();
    let text = if selection.is_empty() { "Nothing selected".to_owned() } else { "Selected:".to_owned() };
    ui.label(egui::RichText::new(format!("{text} {}", parts.join(", "))).weak());
}

fn labels(editor: &mut Editor, ui: &mut Ui) {
    button(editor, ui, "Label automatically");
    ui.label("Selected edges");
    ui.horizontal(|ui| {
        button_as(editor, ui, "Label course", "Course");
        button_as(editor, ui, "Label wale", "Wale");
        button_as(editor, ui, "Clear label", "None");
    });
    ui.horizontal(|ui| {
        button(editor, ui, "Fill row");
        button(editor, ui, "Fill onwards");
    });
    button(editor, ui, "Flip row");
    button(editor, ui, "Clear labels");
    ui.separator();
    tessellation::show(editor, ui);
}

/// What is marked on edges, and how stitches meet at them.
fn edges(editor: &mut Editor, ui: &mut Ui) {
    ui.heading("Edges");
    ui.horizontal_wrapped(|ui| {
        for name in ["Cable", "Live loops", "Sew", "Unsew", "Spiral"] {
            button(editor, ui, name);
        }
    });
    strands::show(editor, ui);
    ui.heading("Structure");
    ui.horizontal_wrapped(|ui| {
        for name in ["Split loop", "Collapse loop", "Divide stitch", "Remove wale"] {
            button(editor, ui, name);
        }
        for name in ["Shift top left", "Shift top right", "Shift bottom left", "Shift bottom right"] {
            button(editor, ui, name);
        }
    });
}
