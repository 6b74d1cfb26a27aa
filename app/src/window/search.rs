//! The command search: find whatever can be done by its name, and do it.

use super::actions::{self, Action};
use super::catalogue;
use super::editor::Editor;
use crate::drawing::Stage;
use egui::{Key, RichText};
use stitch_mesh::catalogue::symbols;

/// Entries shown at once; who looks for others writes more.
const MOST: usize = 12;

/// The search while it is open.
#[derive(Default)]
pub struct Search {
    text: String,
    chosen: usize,
}

/// Something that can be found.
#[derive(Clone, Copy)]
enum Entry {
    Action(&'static Action),
    /// A stitch by its symbol.
    Stitch(&'static str),
}

impl Entry {
    fn name(self) -> String {
        match self {
            Self::Action(action) => action.name.to_owned(),
            Self::Stitch(symbol) => format!("{} · {symbol}", catalogue::name(symbol)),
        }
    }

    fn blocked(self, editor: &Editor) -> Option<&'static str> {
        match self {
            Self::Action(action) => action.blocked(editor),
            Self::Stitch(_) if matches!(editor.stage, Stage::Stitches | Stage::Yarn) => None,
            Self::Stitch(_) => Some("not at this stage"),
        }
    }

    fn run(self, editor: &mut Editor) {
        match self {
            Self::Action(action) => action.run(editor),
            Self::Stitch(symbol) => catalogue::choose(symbol, editor),
        }
    }
}

/// Entries in which every word of the text occurs; those that begin with it first, those that can't be done now last.
fn find(editor: &Editor, text: &str) -> Vec<Entry> {
    let text = text.trim().to_lowercase();
    let entries = actions::all().map(Entry::Action).chain(symbols().map(Entry::Stitch));
    let matching = |e: &Entry| text.split_whitespace().all(|word| e.name().to_lowercase().contains(word));
    let mut found: Vec<Entry> = entries.filter(matching).collect();
    found.sort_by_key(|e| (e.blocked(editor).is_some(), !e.name().to_lowercase().starts_with(&text)));
    found.truncate(MOST);
    found
}

/// Shows the search where it is open.
pub fn show(editor: &mut Editor, ctx: &egui::Context) {
    let Some(mut search) = editor.search.take() else { return };
    let mut run = None;
    let window = egui::Modal::new(egui::Id::unique("search")).show(ctx, |ui| {
        ui.set_width(420.0);
        let hint = "What do you want to do?";
        let field = egui::TextEdit::singleline(&mut search.text).hint_text(hint).desired_width(f32::INFINITY);
        // Up and down go through the list, not through the text.
        let (up, down, enter) = ui.input_mut(|i| {
            let mut pressed = |key| i.consume_key(egui::Modifiers::NONE, key);
            (pressed(Key::ArrowUp), pressed(Key::ArrowDown), pressed(Key::Enter))
        });
        let response = ui.add(field);
        ui.ctx().accesskit_node_builder(response.id, |node| node.set_label("Search commands"));
        response.request_focus();
        let found = find(editor, &search.text);
        if response.changed() {
            search.chosen = 0;
        }
        search.chosen = (search.chosen + usize::from(down)).min(found.len().saturating_sub(1));
        search.chosen -= usize::from(up).min(search.chosen);
        if found.is_empty() {
            ui.label(RichText::new("nothing has that name").weak());
        }
        for (i, entry) in found.iter().enumerate() {
            let blocked = entry.blocked(editor);
            let key = match entry {
                Entry::Action(action) => action.key_text(ui.ctx()).unwrap_or_default(),
                Entry::Stitch(_) => String::new(),
            };
            let button = egui::Button::selectable(i == search.chosen, entry.name())
                .shortcut_text(key)
                .min_size(egui::vec2(ui.available_width(), 0.0));
            let response = ui.add_enabled(blocked.is_none(), button);
            let what = match entry {
                Entry::Action(action) => action.what,
                Entry::Stitch(_) => "Sets what is selected; with nothing selected, the stitch to paint with",
            };
            let clicked =
                response.on_hover_text(what).on_disabled_hover_text(blocked.unwrap_or(what)).clicked();
            if clicked || (enter && i == search.chosen && blocked.is_none()) {
                run = Some(*entry);
            }
        }
        response
    });
    match run {
        Some(entry) => entry.run(editor),
        None if window.should_close() => {}
        None => editor.search = Some(search),
    }
}
