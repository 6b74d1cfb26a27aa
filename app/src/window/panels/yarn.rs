//! The simulation: its steps, its solver, its scene, the materials of its yarns.

use super::{material, scene};
use crate::window::actions::button;
use crate::window::editor::Editor;
use egui::{ComboBox, Ui};
use sim_core::SolverChoice;

/// Solvers, their names and what they are.
const SOLVERS: [(SolverChoice, &str, &str); 4] = [
    (SolverChoice::Auto, "fastest", "The one that is fastest for this fabric on this machine"),
    (SolverChoice::Direct, "direct", "A complete factorisation on the CPU: the fastest for little fabric"),
    (SolverChoice::Iterative, "iterative", "Conjugate gradients on the CPU: the fastest for much fabric"),
    (SolverChoice::Gpu, "GPU", "Conjugate gradients on the graphics card, if only a software one"),
];

/// Shows them.
pub fn show(editor: &mut Editor, ui: &mut Ui) {
    ui.heading("Simulation");
    ui.horizontal(|ui| {
        button(editor, ui, "Step");
        button(editor, ui, "Reset");
        button(editor, ui, "Lay anew");
    });
    solver(editor, ui);
    ui.separator();
    scene::show(editor, ui);
    ui.separator();
    material::show(editor, ui);
}

/// Which solver is wanted, which one it is, and why not the other.
fn solver(editor: &mut Editor, ui: &mut Ui) {
    let (mut chosen, before) = (editor.solver, editor.solver);
    let name = SOLVERS.iter().find(|(solver, ..)| *solver == chosen).map_or("", |(_, name, _)| name);
    ComboBox::from_label("solver").selected_text(name).show_ui(ui, |ui| {
        for (solver, name, what) in SOLVERS {
            ui.selectable_value(&mut chosen, solver, name).on_hover_text(what);
        }
    });
    if chosen != before {
        editor.solve_with(chosen);
    }
    let Some(snapshot) = editor.yarn().filter(|s| !s.solver.is_empty()) else { return };
    match &snapshot.adapter {
        Some(adapter) => ui.weak(format!("on {adapter}")),
        None => ui.weak(format!("{}, on the CPU", snapshot.solver)),
    };
    if let Some(notice) = &snapshot.notice {
        ui.colored_label(ui.visuals().warn_fg_color, notice);
    }
}
