//! Colours of yarn.

use crate::window::actions::button_as;
use crate::window::editor::Editor;
use egui::{Color32, Ui};
use render::palette::StitchColors;
use stitch_mesh::dye::Dye;

/// Colours to begin with: undyed wool, and seven of Okabe and Ito's, told apart by every kind of colour vision.
const DYES: [(&str, [u8; 3]); 8] = [
    ("Undyed", Dye::UNDYED.0),
    ("Charcoal", [0x30, 0x30, 0x34]),
    ("Orange", [0xe6, 0x9f, 0x00]),
    ("Sky blue", [0x56, 0xb4, 0xe9]),
    ("Green", [0x00, 0x9e, 0x73]),
    ("Blue", [0x00, 0x72, 0xb2]),
    ("Vermilion", [0xd5, 0x5e, 0x00]),
    ("Mauve", [0xcc, 0x79, 0xa7]),
];

/// Shows them.
pub fn show(editor: &mut Editor, ui: &mut Ui) {
    ui.heading("Yarn colour");
    ui.horizontal_wrapped(|ui| {
        ui.spacing_mut().item_spacing = egui::vec2(3.0, 3.0);
        for (name, [r, g, b]) in DYES {
            let chosen = editor.panel.dye == Dye([r, g, b]);
            let stroke = if chosen {
                egui::Stroke::new(2.5, ui.visuals().strong_text_color())
            } else {
                egui::Stroke::NONE
            };
            let swatch = egui::Button::new("").fill(Color32::from_rgb(r, g, b)).stroke(stroke);
            let response = ui.add(swatch.min_size(egui::vec2(22.0, 22.0)));
            response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, true, name));
            if response.on_hover_text(name).clicked() {
                editor.panel.dye = Dye([r, g, b]);
            }
        }
    });
    ui.horizontal(|ui| {
        let field = ui.color_edit_button_srgb(&mut editor.panel.dye.0);
        ui.ctx().accesskit_node_builder(field.id, |node| node.set_label("Another colour"));
        field.on_hover_text("Another colour");
        button_as(editor, ui, "Dye", "Dye the selection");
    });
    let mut shows_yarn = editor.stitch_colors == StitchColors::Yarn;
    let choice = ui.checkbox(&mut shows_yarn, "Colour stitches like their yarn");
    if choice.on_hover_text("Otherwise stitches have the colour of their kind").changed() {
        editor.stitch_colors = if shows_yarn { StitchColors::Yarn } else { StitchColors::default() };
        editor.show_stage();
    }
}
