//! The pattern library: found by name, shown with a picture, tiled with a click or by dropping it on the fabric.

use crate::command::Command;
use crate::library::{ACROSS, ENTRIES, Entry, PICTURES};
use crate::window::editor::Editor;
use egui::{Id, RichText, TextureHandle, Ui, vec2};
use patterns::tile::Layout;

/// Side of a picture [points].
const SIDE: f32 = 52.0;

/// What the panel remembers.
#[derive(Default)]
pub struct State {
    query: String,
    layout: Layout,
    pictures: Option<TextureHandle>,
}

/// A pattern on its way to the fabric.
#[derive(Clone, Copy)]
pub struct Dragged(&'static Entry);

/// How repeats are laid: name and explanation.
const LAYOUTS: [(Layout, &str, &str); 4] = [
    (Layout::Straight, "Straight", "All repeats alike"),
    (Layout::Mirrored, "Mirrored", "As seen in a mirror"),
    (Layout::Alternating, "Alternating", "Every second repeat as seen in a mirror"),
    (Layout::HalfDrop, "Half drop", "Every second repeat half its height further up"),
];

/// Shows it.
pub fn show(editor: &mut Editor, ui: &mut Ui) {
    let over = if editor.selection().faces.is_empty() { "over everything" } else { "over the selection" };
    ui.horizontal(|ui| {
        ui.heading("Patterns");
        ui.label(RichText::new(over).weak());
    });
    ui.horizontal(|ui| {
        let state = &mut editor.panel.written;
        let field = egui::TextEdit::singleline(&mut state.query).hint_text("find").desired_width(84.0);
        let field =
            ui.add(field).on_hover_text("Words of the name, the kind (lace, rib, cable) or the source");
        ui.ctx().accesskit_node_builder(field.id, |node| node.set_label("Find a pattern"));
        let name =
            |l: Layout| LAYOUTS.iter().find(|(layout, ..)| *layout == l).map_or("", |(_, name, _)| name);
        let mut chosen = state.layout;
        let combo = egui::ComboBox::from_id_salt("layout").width(88.0).selected_text(name(chosen));
        let response = combo.show_ui(ui, |ui| {
            for (layout, name, what) in LAYOUTS {
                ui.selectable_value(&mut chosen, layout, name).on_hover_text(what);
            }
        });
        ui.ctx().accesskit_node_builder(response.response.id, |node| node.set_label("Layout of repeats"));
        response.response.on_hover_text("How repeats lie beside each other");
        state.layout = chosen;
    });
    let query = editor.panel.written.query.clone();
    let pictures = pictures(editor, ui);
    for (i, entry) in ENTRIES.iter().enumerate().filter(|(_, entry)| entry.matches(&query)) {
        row(editor, ui, (i, entry), &pictures);
    }
}

/// The pictures on the GPU; loaded when they are first shown.
fn pictures(editor: &mut Editor, ui: &Ui) -> Option<TextureHandle> {
    let slot = &mut editor.panel.written.pictures;
    if slot.is_none() {
        let decoded = image::load_from_memory(PICTURES).ok()?.to_rgba8();
        let size = [decoded.width() as usize, decoded.height() as usize];
        let image = egui::ColorImage::from_rgba_unmultiplied(size, decoded.as_raw());
        *slot = Some(ui.ctx().load_texture("patterns", image, egui::TextureOptions::LINEAR));
    }
    slot.clone()
}

fn row(
    editor: &mut Editor,
    ui: &mut Ui,
    (i, entry): (usize, &'static Entry),
    pictures: &Option<TextureHandle>,
) {
    ui.horizontal(|ui| {
        let drag = ui.dnd_drag_source(Id::unique(("pattern", i)), Dragged(entry), |ui| match pictures {
            Some(texture) => {
                let down = ENTRIES.len().div_ceil(ACROSS as usize) as f32;
                let part = vec2(1.0 / ACROSS as f32, 1.0 / down);
                let place =
                    egui::pos2((i % ACROSS as usize) as f32 * part.x, (i / ACROSS as usize) as f32 * part.y);
                let image = egui::Image::new((texture.id(), vec2(SIDE, SIDE)));
                ui.add(image.uv(egui::Rect::from_min_size(place, part)))
            }
            None => ui.label(entry.title),
        });
        drag.response.on_hover_text("Drag it onto the fabric");
        ui.vertical(|ui| {
            ui.set_max_width(128.0);
            let about = format!("{}\n{}\n{}", entry.repeat, entry.source, entry.certainty);
            ui.add(egui::Label::new(entry.title).wrap()).on_hover_text(about);
            ui.label(RichText::new(entry.kind).weak().small());
            ui.horizontal(|ui| {
                if ui
                    .small_button("Tile")
                    .on_hover_text("Repeat it over the fabric or the selection")
                    .clicked()
                {
                    tile(editor, entry);
                }
                let swatch = ui.small_button("Swatch").on_hover_text("Knit a swatch in place of everything");
                if swatch.clicked() {
                    editor.act(Command::Import { text: entry.text.to_owned(), cast_on: None, repeats: None });
                }
            });
        });
    });
}

fn tile(editor: &mut Editor, entry: &Entry) {
    let selected = &editor.selection().faces;
    let faces = (!selected.is_empty()).then(|| selected.iter().map(|f| f.0).collect());
    let layout = editor.panel.written.layout;
    editor.act(Command::Tile { text: entry.text.to_owned(), rows: None, faces, layout });
}

/// Tiles a pattern that was dropped on the picture.
pub fn take_dropped(editor: &mut Editor, response: &egui::Response) {
    if editor.project().fabric.is_some()
        && let Some(dragged) = response.dnd_release_payload::<Dragged>()
    {
        tile(editor, dragged.0);
    }
}
