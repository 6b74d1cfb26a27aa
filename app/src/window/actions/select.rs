//! Selecting and hiding.

use super::{Action, FABRIC, On};
use crate::window::editor::Editor;
use crate::window::selection::{Mode, Selection};
use egui::{Key, Modifiers};

pub(super) const ACTIONS: &[Action] = &[
    Action::new("Edge", "Clicks select edges", |e| set_mode(e, Mode::Edge)).key(Modifiers::NONE, Key::Num1),
    Action::new("Face", "Clicks select faces: stitches", |e| set_mode(e, Mode::Face))
        .key(Modifiers::NONE, Key::Num2),
    Action::new("Row", "Clicks select whole rows", |e| set_mode(e, Mode::Row))
        .key(Modifiers::NONE, Key::Num3),
    Action::new("Select all", "Select everything that shows", |e| {
        with(e, |s, e| s.all(e.surface().mesh(), s.mode))
    })
    .key(Modifiers::NONE, Key::A),
    Action::new("Select none", "Select nothing", |e| with(e, |s, _| s.clear())).key(Modifiers::ALT, Key::A),
    Action::new("Select linked", "Select the whole piece that is selected or under the pointer", |e| {
        let under = e.face_under();
        with(e, |s, e| s.linked(e.surface().mesh(), under));
    })
    .key(Modifiers::NONE, Key::L)
    .on(On::Faces),
    Action::new(
        "Select alike",
        "Select all stitches of the kinds that are selected or under the pointer",
        select_alike,
    )
    .key(Modifiers::SHIFT, Key::L)
    .at(FABRIC)
    .on(On::Faces)
    .unless(Editor::no_faces),
    Action::new("Hide", "Hide what is selected, and its yarn", |e| {
        with(e, |s, e| s.hide(e.surface().mesh()))
    })
    .key(Modifiers::NONE, Key::H)
    .unless(|e| e.selection().is_empty().then_some("nothing is selected")),
    Action::new("Show all", "Show again what was hidden", |e| with(e, |s, _| s.hidden.clear()))
        .key(Modifiers::ALT, Key::H)
        .unless(|e| e.selection().hidden.is_empty().then_some("nothing is hidden")),
];

/// Changes the selection of the mesh that is shown.
fn with(editor: &mut Editor, change: impl FnOnce(&mut Selection, &Editor)) {
    let mut selection = editor.selection().clone();
    change(&mut selection, editor);
    editor.set_selection(selection);
}

fn set_mode(editor: &mut Editor, mode: Mode) {
    with(editor, |selection, editor| {
        selection.mode = mode;
        match mode {
            Mode::Edge => selection.faces.clear(),
            Mode::Face => selection.edges.clear(),
            Mode::Row => selection.to_rows(editor.surface()),
        }
    });
}

fn select_alike(editor: &mut Editor) {
    let Some(fabric) = &editor.view.project.fabric else { return };
    let stitches = fabric.stitches.clone();
    let kinds: Vec<_> = editor.faces_meant().into_iter().map(|f| stitches.stitch(f).clone()).collect();
    with(editor, |selection, _| {
        let alike = stitches.mesh().faces().filter(|f| kinds.contains(stitches.stitch(*f)));
        selection.faces = alike.filter(|f| !selection.hidden.contains(f)).collect();
    });
}
