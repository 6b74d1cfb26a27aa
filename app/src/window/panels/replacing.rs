//! Before a file that this document is not in is written over: whether it may be.

use crate::window::editor::Editor;
use crate::window::request::Request;
use egui::{Context, Id, Modal};
use std::path::{Path, PathBuf};

impl Editor {
    /// Writes a file, or asks first where there is one that this window has neither opened nor written.
    pub(in crate::window) fn write(&mut self, request: Request) {
        match request.writes().filter(|path| self.would_replace(path)) {
            Some(_) => self.replacing = Some(request),
            None => self.write_over(request),
        }
    }

    /// Whether writing a file would take away something that nobody has seen in this window.
    pub(in crate::window) fn would_replace(&self, path: &Path) -> bool {
        path.exists() && self.view.home.as_deref() != Some(path) && !self.written.contains(path)
    }

    /// Writes a file, whatever is there.
    pub(in crate::window) fn write_over(&mut self, request: Request) {
        self.replacing = None;
        self.written.extend(request.writes().map(Path::to_path_buf));
        self.request(request);
    }

    /// The file that the path field names, with an ending; or else a message that there is no name.
    pub(in crate::window) fn named(&mut self, ending: &str) -> Option<PathBuf> {
        let path = PathBuf::from(self.panel.path.trim());
        if path.as_os_str().is_empty() {
            self.error = Some("give the project a name first, in the field beside Save".into());
            return None;
        }
        Some(path.with_extension(ending))
    }
}

/// Asks, if there is something to ask.
pub fn show(editor: &mut Editor, context: &Context) {
    let Some(request) = editor.replacing.clone() else { return };
    let name = request.writes().map(|path| path.display().to_string()).unwrap_or_default();
    let modal = Modal::new(Id::unique("replacing")).show(context, |ui| {
        ui.heading(format!("Replace {name}?"));
        ui.label("There is a file of this name, which was not opened or written here.");
        ui.add_space(8.0);
        ui.horizontal(|ui| {
            if ui.button("Replace").clicked() {
                editor.write_over(request);
            }
            if ui.button("Keep it").clicked() {
                editor.replacing = None;
            }
        });
    });
    if modal.should_close() {
        editor.replacing = None;
    }
}
