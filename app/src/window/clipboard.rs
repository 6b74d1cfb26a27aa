//! Copying stitches, mirroring the copy, and putting it elsewhere.

use super::editor::Editor;
use crate::command::Command;
use stitch_mesh::patch::Patch;

impl Editor {
    /// Copies the stitches that are meant.
    pub(super) fn copy(&mut self) {
        let meant = self.faces_meant();
        let Some(fabric) = &self.view.project.fabric else { return };
        match Patch::copy(&fabric.stitches, &meant) {
            Ok(patch) => self.patch = Some(patch),
            Err(error) => self.error = Some(error.to_string()),
        }
    }

    /// Turns the copy left to right.
    pub(super) fn mirror(&mut self) {
        self.patch = self.patch.as_ref().map(Patch::mirrored);
    }

    /// Puts the copy where the pointer is; its lowest stitch on the left comes there. With the pointer elsewhere, on the first
    /// selected stitch.
    pub(super) fn paste(&mut self) {
        let at = self.face_under().or_else(|| self.selection().faces.first().copied());
        if let (Some(at), Some(patch)) = (at, self.patch.clone()) {
            self.act(Command::Paste { at: at.0, patch });
        }
    }

    /// Why nothing can be pasted.
    pub(super) fn nothing_copied(&self) -> Option<&'static str> {
        self.patch.is_none().then_some("copy some stitches first (Ctrl+C)")
    }
}
