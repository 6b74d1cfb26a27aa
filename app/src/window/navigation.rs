//! Moving the camera with the mouse, as one is used to from Blender or from Maya.

use super::editor::Editor;
use egui::{PointerButton, Rect, Response, Ui};
use glam::Vec2;

/// Which buttons move the camera.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Navigation {
    /// Middle or right button: orbit; with Shift pan. As in Blender.
    #[default]
    MiddleButton,
    /// With Alt: left button orbit, middle pan, right zoom. As in Maya.
    Alt,
}

enum Move {
    Orbit,
    Pan,
    Zoom,
}

impl Navigation {
    /// Both, with a name and what they mean.
    pub const ALL: [(Self, &'static str, &'static str); 2] = [
        (
            Self::MiddleButton,
            "Middle button (Blender)",
            "Middle or right button orbits, with Shift it pans; Alt-click selects a loop",
        ),
        (
            Self::Alt,
            "Alt (Maya)",
            "Alt with the left button orbits, middle pans, right zooms; a double click selects a loop",
        ),
    ];

    /// Whether the left button belongs to the camera just now.
    pub fn takes_left_button(self, ui: &Ui) -> bool {
        self == Self::Alt && ui.input(|i| i.modifiers.alt)
    }

    fn asked(self, ui: &Ui, response: &Response) -> Option<Move> {
        let modifiers = ui.input(|i| i.modifiers);
        let by = |button| response.dragged_by(button);
        match self {
            Self::MiddleButton if by(PointerButton::Middle) || by(PointerButton::Secondary) => {
                Some(if modifiers.shift { Move::Pan } else { Move::Orbit })
            }
            Self::Alt if modifiers.alt && by(PointerButton::Primary) => Some(Move::Orbit),
            Self::Alt if modifiers.alt && by(PointerButton::Middle) => Some(Move::Pan),
            Self::Alt if modifiers.alt && by(PointerButton::Secondary) => Some(Move::Zoom),
            _ => None,
        }
    }
}

/// Moves the camera as the mouse asks.
pub fn move_camera(editor: &mut Editor, ui: &Ui, response: &Response, rect: Rect) {
    let delta = response.drag_delta();
    match editor.navigation.asked(ui, response) {
        Some(Move::Orbit) => editor.camera.orbit(-delta.x * 0.01, delta.y * 0.01),
        Some(Move::Pan) => editor.camera.pan(Vec2::new(delta.x, delta.y), rect.height()),
        Some(Move::Zoom) => editor.camera.zoom(((delta.x - delta.y) * 0.01).exp()),
        None => {}
    }
    if response.hovered() {
        let scroll = ui.input(|i| i.smooth_scroll_delta.y);
        if scroll != 0.0 {
            // Up comes closer.
            editor.camera.zoom((scroll * 0.002).exp());
        }
    }
}
