//! Knit and purl by turns over what is selected, or over everything.

use crate::command::Command;
use crate::window::editor::Editor;
use egui::Ui;
use patterns::alternation::{basketweave, garter, moss, rib};
use patterns::chart::{Chart, ChartError};

/// A fabric of knit and purl by turns.
struct Alternation {
    name: &'static str,
    what: &'static str,
    /// What its numbers are.
    numbers: &'static [&'static str],
    first: [usize; 2],
    chart: fn([usize; 2]) -> Result<Chart, ChartError>,
}

const ALTERNATIONS: [Alternation; 6] = [
    Alternation {
        name: "Stockinette",
        what: "Knit on the front",
        numbers: &[],
        first: [1, 0],
        chart: |[n, m]| rib(n, m),
    },
    Alternation {
        name: "Reverse",
        what: "Purl on the front: stockinette from behind",
        numbers: &[],
        first: [0, 1],
        chart: |[n, m]| rib(n, m),
    },
    Alternation {
        name: "Rib",
        what: "Columns of knit and purl by turns: draws in and stretches",
        numbers: &["knit columns", "purl columns"],
        first: [2, 2],
        chart: |[n, m]| rib(n, m),
    },
    Alternation {
        name: "Garter",
        what: "Rows of knit and purl by turns, as seen from the front: lies flat",
        numbers: &[],
        first: [1, 1],
        chart: |_| Ok(garter()),
    },
    Alternation {
        name: "Moss",
        what: "Knit and purl by turns both ways (seed)",
        numbers: &[],
        first: [1, 1],
        chart: |_| Ok(moss()),
    },
    Alternation {
        name: "Basket",
        what: "Basketweave: blocks of knit and purl like a chequerboard; 1 × 2 is double moss",
        numbers: &["stitches", "rows"],
        first: [4, 4],
        chart: |[n, m]| basketweave(n, m),
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
                chosen = (kind.chart)(*numbers).ok();
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
        editor.act(Command::SetChart { chart: chart.lines(), rows: None, faces });
    }
}
