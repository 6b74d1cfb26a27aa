//! Everything that a key or a button does, in one table: name, key, where it makes sense, what it does and when it can't.
//!
//! Shortcuts, the command search, buttons, tooltips and the hints in the status bar all read it, so that they cannot disagree.
//! An action is a few lines in one of the lists below; it works on what is selected, or where nothing is, on what is under the
//! pointer.

mod edit;
mod fabric;
mod select;
mod structure;
mod view;

use super::editor::Editor;
use crate::drawing::Stage;
use egui::{Event, Key, KeyboardShortcut, Modifiers, Ui};
use stitch_mesh::ids::EdgeId;

/// What an action works on: tells which keys are worth naming when the pointer is over something.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum On {
    /// The whole document, or the window.
    Window,
    /// Faces.
    Faces,
    /// Edges.
    Edges,
}

/// An entry of the table.
pub struct Action {
    /// Its name, as buttons and the search show it.
    pub name: &'static str,
    /// One sentence about what it does.
    pub what: &'static str,
    /// Its key.
    pub key: Option<KeyboardShortcut>,
    /// The stages in which it makes sense.
    pub stages: &'static [Stage],
    /// What it works on.
    pub on: On,
    /// Why it cannot be done just now.
    pub why_not: fn(&Editor) -> Option<&'static str>,
    /// Does it.
    pub run: fn(&mut Editor),
}

/// The stage with yarn.
const YARN: &[Stage] = &[Stage::Yarn];

/// Stages with stitches.
const FABRIC: &[Stage] = &[Stage::Stitches, Stage::Yarn];

impl Action {
    /// An action at all stages, without a key, that can always be done.
    const fn new(name: &'static str, what: &'static str, run: fn(&mut Editor)) -> Self {
        Self { name, what, key: None, stages: &Stage::ALL, on: On::Window, why_not: |_| None, run }
    }

    const fn key(self, modifiers: Modifiers, key: Key) -> Self {
        Self { key: Some(KeyboardShortcut::new(modifiers, key)), ..self }
    }

    const fn at(self, stages: &'static [Stage]) -> Self {
        Self { stages, ..self }
    }

    const fn on(self, on: On) -> Self {
        Self { on, ..self }
    }

    const fn unless(self, why_not: fn(&Editor) -> Option<&'static str>) -> Self {
        Self { why_not, ..self }
    }

    /// Its key in words, as in `Ctrl+Z`.
    pub fn key_text(&self, ctx: &egui::Context) -> Option<String> {
        self.key.map(|key| ctx.format_shortcut(&key))
    }

    /// What it does, and its key.
    pub fn tooltip(&self, ctx: &egui::Context) -> String {
        match self.key_text(ctx) {
            Some(key) => format!("{} ({key})", self.what),
            None => self.what.to_owned(),
        }
    }

    /// Why it cannot be done just now; none where it can.
    pub fn blocked(&self, editor: &Editor) -> Option<&'static str> {
        if !self.stages.contains(&editor.stage) {
            return Some("not at this stage");
        }
        (self.why_not)(editor)
    }

    /// Does it, or says why not.
    pub fn run(&self, editor: &mut Editor) {
        editor.error = self.blocked(editor).map(|why| format!("{}: {why}", self.name));
        if editor.error.is_none() {
            (self.run)(editor);
        }
    }
}

/// All actions.
pub fn all() -> impl Iterator<Item = &'static Action> {
    [view::ACTIONS, select::ACTIONS, edit::ACTIONS, fabric::ACTIONS, structure::ACTIONS].into_iter().flatten()
}

/// Edges by their vertices, as commands name them.
fn ends(editor: &Editor, edges: Vec<EdgeId>) -> Vec<[u32; 2]> {
    let mesh = editor.surface().mesh();
    edges.into_iter().map(|e| mesh.edge_ends(e).map(|v| v.0)).collect()
}

/// The action of a name.
pub fn named(name: &str) -> Option<&'static Action> {
    let found = all().find(|a| a.name == name);
    debug_assert!(found.is_some(), "there is no action '{name}'");
    found
}

/// A button for an action.
pub fn button(editor: &mut Editor, ui: &mut Ui, name: &str) {
    button_as(editor, ui, name, name);
}

/// A button for an action with another text on it.
pub fn button_as(editor: &mut Editor, ui: &mut Ui, name: &str, text: &str) {
    show(editor, ui, name, egui::Button::new(text));
}

/// A button for an action that is one of several choices, marked where it is what holds now.
pub fn choice(editor: &mut Editor, ui: &mut Ui, name: &str, marked: bool) {
    show(editor, ui, name, egui::Button::selectable(marked, name));
}

fn show(editor: &mut Editor, ui: &mut Ui, name: &str, button: egui::Button<'_>) {
    let Some(action) = named(name) else { return };
    let blocked = action.blocked(editor);
    let button = ui.add_enabled(blocked.is_none(), button);
    let tooltip = action.tooltip(ui.ctx());
    let why = blocked.map_or_else(String::new, |why| format!("{tooltip}\n\n{why}"));
    if button.on_hover_text(tooltip).on_disabled_hover_text(why).clicked() {
        action.run(editor);
    }
}

/// Runs the actions whose keys were pressed.
pub fn shortcuts(editor: &mut Editor, ctx: &egui::Context) {
    let is_asking = editor.leaving.is_some() || editor.replacing.is_some();
    if is_asking || editor.search.is_some() || egui::Popup::is_any_open(ctx) {
        return; // all keys are theirs
    }
    // Escape takes the focus from a text field before anybody else sees the key: it is still the field's.
    let focused = ctx.egui_wants_keyboard_input();
    let typing = std::mem::replace(&mut editor.typing, focused) || focused;
    let pressed = ctx.input_mut(|input| {
        let mut pressed = Vec::new();
        input.events.retain(|event| {
            let found = shortcut(event).filter(|key| !typing || !is_typed(*key)).and_then(|key| {
                let matching = || all().filter(move |a| a.key == Some(key));
                matching().find(|a| a.stages.contains(&editor.stage)).or_else(|| matching().next())
            });
            pressed.extend(found);
            found.is_none()
        });
        pressed
    });
    for action in pressed {
        action.run(editor);
    }
}

/// The key that an event is. The system turns some keys into events of their own.
fn shortcut(event: &Event) -> Option<KeyboardShortcut> {
    let (modifiers, key) = match event {
        Event::Key { key, pressed: true, modifiers, .. } => (*modifiers, *key),
        Event::Copy => (Modifiers::COMMAND, Key::C),
        Event::Cut => (Modifiers::COMMAND, Key::X),
        Event::Paste(_) => (Modifiers::COMMAND, Key::V),
        _ => return None,
    };
    // Written as in the table: Command is Ctrl, or what stands for it on the machine.
    let modifiers = Modifiers { alt: modifiers.alt, shift: modifiers.shift, ..Modifiers::NONE }
        | if modifiers.command || modifiers.ctrl { Modifiers::COMMAND } else { Modifiers::NONE };
    Some(KeyboardShortcut::new(modifiers, key))
}

/// Whether a text field wants the key for itself: whatever writes, and what edits text everywhere.
fn is_typed(KeyboardShortcut { modifiers, logical_key }: KeyboardShortcut) -> bool {
    let edits = [Key::A, Key::C, Key::V, Key::X, Key::Y, Key::Z].contains(&logical_key);
    let function = logical_key.name().starts_with('F') && logical_key.name().len() > 1;
    !function && (!modifiers.command || edits)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_key_means_two_things() {
        let keyed: Vec<_> = all().filter(|a| a.key.is_some()).collect();
        for (i, a) in keyed.iter().enumerate() {
            for b in &keyed[..i] {
                let meet = a.stages.iter().any(|s| b.stages.contains(s));
                assert!(a.key != b.key || !meet, "{} and {} have the same key", a.name, b.name);
            }
        }
        assert!(keyed.len() > 30);
    }

    #[test]
    fn names_are_told_apart_and_sentences_are_short() {
        let names: std::collections::BTreeSet<_> = all().map(|a| a.name).collect();
        assert_eq!(names.len(), all().count());
        assert!(all().all(|a| !a.what.is_empty() && a.what.len() < 110));
    }

    #[test]
    fn keys_that_write_stay_with_the_text_field() {
        let typed = |modifiers, key| is_typed(KeyboardShortcut::new(modifiers, key));
        assert!(typed(Modifiers::NONE, Key::K) && typed(Modifiers::COMMAND, Key::Z));
        assert!(typed(Modifiers::SHIFT, Key::F) && typed(Modifiers::NONE, Key::Home));
        assert!(!typed(Modifiers::COMMAND, Key::S) && !typed(Modifiers::NONE, Key::F3));
    }
}
