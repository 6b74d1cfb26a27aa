//! Knit and purl by turns over what is selected, or over everything.

use crate::command::Command;
use crate::window::editor::Editor;
use egui::Ui;
use patterns::alternation::{Lines, basketweave, garter, moss, rib};

/// A fabric of knit and purl by turns.
struct Alternation {
    name: &'static str,
    what: &'static str,
    /// What its numbers are.
    numbers: &'static [&'static str],
    first: [usize; 2],
    lines: fn([usize; 2]) -> Lines,
}

const ALTERNATIONS: [Alternation; 6] = [
    Alternation {
        name: "Stockinette",
        what: "Knit on the front",
        numbers: &[],
        first: [1, 0],
        lines: |[n, _]| garter(n, 0),
    },
    Alternation {
        name: "Reverse",
        what: "Purl on the front: stockinette from behind",
        numbers: &[],
        first: [0, 1],
        lines: |[_, n]| garter(0, n),
    },
    Alternation {
        name: "Rib",
        what: "Columns of knit and purl by turns: draws in and stretches",
        numbers: &["knit columns", "purl columns"],
        first: [2, 2],
        lines: |[n, m]| rib(n, m),
    },
    Alternation {
        name: "Garter",
        what: "Rows of knit and purl by turns, as seen from the front: lies flat",
        numbers: &["knit rows", "purl rows"],
        first: [1, 1],
        lines: |[n, m]| garter(n, m),
    },
    Alternation {
        name: "Moss",
        what: "Knit and purl by turns both ways; 1 row high it is seed, 2 rows double moss",
        numbers: &["rows"],
        first: [1, 0],
        lines: |[n, _]| moss(n),
    },
    Alternation {
        name: "Basket",
        what: "Basketweave: blocks of knit and purl like a chequerboard",
        numbers: &["stitches", "rows"],
        first: [4, 4],
        lines: |[n, m]| basketweave(n, m),
    },
];

/// Numbers of the alternations, as they stand in the fields.
pub struct Numbers([[usize; 2]; ALTERNATIONS.len()]);

impl Default for Numbers {
    fn default() -> Self {
        Self(ALTERNATIONS.map(|a| a.first))
    }
}

/// Shows them.
pub fn show(editor: &mut Editor, ui: &mut Ui) {
    let over = if editor.selection().faces.is_empty() { "all over" } else { "over the selection" };
    ui.horizontal(|ui| {
        ui.heading("By turns");
        ui.label(egui::RichText::new(over).weak());
    });
    let mut chosen = None;
    egui::Grid::new("alternations").num_columns(3).spacing([6.0, 4.0]).show(ui, |ui| {
        for (kind, numbers) in ALTERNATIONS.iter().zip(&mut editor.panel.alternation.0) {
            let button = egui::Button::new(kind.name).min_size(egui::vec2(86.0, 0.0));
            if ui.add(button).on_hover_text(kind.what).clicked() {
                chosen = Some((kind.lines)(*numbers));
            }
            for (number, of) in numbers.iter_mut().zip(kind.numbers) {
                let field = ui.add(egui::DragValue::new(number).range(1..=99).speed(0.05));
                ui.ctx()
                    .accesskit_node_builder(field.id, |node| node.set_label(format!("{}: {of}", kind.name)));
                field.on_hover_text(*of);
            }
            ui.end_row();
        }
    });
    if let Some(chart) = chosen {
        let selected = &editor.selection().faces;
        let faces = (!selected.is_empty()).then(|| selected.iter().map(|f| f.0).collect());
        editor.act(Command::SetChart { chart, rows: None, faces });
    }
}
