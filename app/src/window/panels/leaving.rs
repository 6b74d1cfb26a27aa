//! Before work that has not been saved is left: whether to save it.

use crate::window::editor::Editor;
use crate::window::request::Request;
use egui::{Context, Id, Modal};
use std::path::PathBuf;

/// Where one wants to go.
#[derive(Clone, Debug)]
pub(in crate::window) enum Destination {
    /// To another document.
    Other(Request),
    /// To a document that is to be chosen yet.
    Chosen,
    /// Out of the window.
    Closed,
}

/// That somebody has been asked, or has answered.
#[derive(Clone, Debug)]
pub(in crate::window) struct Leaving {
    /// Where to.
    pub to: Destination,
    /// Whether the document is being saved first.
    pub is_saving: bool,
}

impl Editor {
    /// Leaves the document for something else, or asks first what is to happen to it.
    pub(in crate::window) fn leave(&mut self, to: Destination) {
        if self.view.is_changed {
            self.leaving = Some(Leaving { to, is_saving: false });
        } else {
            self.go(to);
        }
    }

    /// Leaves the document as it is.
    pub(in crate::window) fn go(&mut self, to: Destination) {
        self.leaving = None;
        match to {
            Destination::Other(request) => self.request(request),
            Destination::Chosen => self.session.ask_for_file(),
            Destination::Closed => self.is_closed = true,
        }
    }

    /// Somebody wants to close the window.
    pub fn close(&mut self) {
        self.leave(Destination::Closed);
    }

    /// Whether it may be closed now.
    pub fn is_closed(&self) -> bool {
        self.is_closed
    }
}

/// Asks, if there is something to ask.
pub fn show(editor: &mut Editor, context: &Context) {
    let Some(Leaving { to, is_saving }) = editor.leaving.clone() else { return };
    if is_saving {
        if editor.session.is_busy() {
            return;
        }
        // Where it could not be saved, the status bar says why, and nobody leaves.
        if editor.session.latest().is_changed {
            editor.leaving = None;
        } else {
            editor.go(to);
        }
        return;
    }
    let name = editor.view.path.as_ref().and_then(|p| p.file_name()).unwrap_or("this".as_ref());
    let asked = format!("Save what was done to {} first?", name.display());
    let target = PathBuf::from(editor.panel.path.trim()).with_extension("purl");
    let (told, save) = if editor.would_replace(&target) {
        (format!("{} is another file, and would be replaced.", target.display()), "Replace it and go on")
    } else {
        (format!("It would be saved as {}.", target.display()), "Save and go on")
    };
    let modal = Modal::new(Id::unique("leaving")).show(context, |ui| {
        ui.heading(asked);
        ui.label("It has not been saved since the last change.");
        ui.label(told);
        ui.add_space(8.0);
        ui.horizontal(|ui| {
            if ui.button(save).clicked() {
                let path = editor.named("purl");
                editor.leaving = path.as_ref().map(|_| Leaving { to: to.clone(), is_saving: true });
                path.into_iter().for_each(|path| editor.write_over(Request::Save(path)));
            }
            if ui.button("Go on without").clicked() {
                editor.go(to.clone());
            }
            if ui.button("Stay").clicked() {
                editor.leaving = None;
            }
        });
    });
    if modal.should_close() {
        editor.leaving = None;
    }
}
