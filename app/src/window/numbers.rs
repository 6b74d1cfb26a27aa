//! Counts of stitches and rows, written at the edges that are selected or under the pointer.

use super::editor::Editor;
use crate::drawing::Stage;
use egui::{Align2, Color32, FontId, Rect, Ui};
use stitch_mesh::ids::EdgeId;

/// Numbers written at once; more would cover the picture.
const MOST: usize = 200;

impl Editor {
    /// How many stitches or rows go on an edge of the input mesh, once that has been decided.
    pub(super) fn count(&self, edge: EdgeId) -> Option<u32> {
        let project = self.project();
        let counts = project.counts.as_ref().filter(|_| self.stage == Stage::Labels)?;
        counts.counts.get(edge.index()).copied()
    }
}

/// Writes them over the picture.
pub fn show(editor: &Editor, ui: &Ui, rect: Rect) {
    let mesh = editor.surface().mesh();
    let aspect = rect.width() / rect.height().max(1.0);
    let to_clip = editor.camera.view_projection(aspect);
    let selected = editor.selection().edges.iter().copied();
    let under = editor.under.map(|(half, _)| mesh.edge(half));
    let edges = selected.chain(under.filter(|e| !editor.selection().edges.contains(e)));
    for edge in edges.take(MOST) {
        let Some(count) = editor.count(edge) else { return };
        let [a, b] = mesh.edge_ends(edge).map(|v| mesh.position(v).as_vec3());
        let p = to_clip * ((a + b) / 2.0).extend(1.0);
        if p.w <= editor.camera.near() {
            continue;
        }
        let at = rect.min + rect.size() * egui::vec2(0.5 + 0.5 * p.x / p.w, 0.5 - 0.5 * p.y / p.w);
        let painter = ui.painter().with_clip_rect(rect);
        let text = painter.layout_no_wrap(count.to_string(), FontId::proportional(13.0), Color32::WHITE);
        let place = Align2::CENTER_CENTER.anchor_size(at, text.size());
        painter.rect_filled(place.expand2(egui::vec2(4.0, 1.0)), 4.0, Color32::from_black_alpha(190));
        painter.galley(place.min, text, Color32::WHITE);
    }
}
