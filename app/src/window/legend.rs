//! The scale of the colours of strain, in a corner of the picture.

use super::editor::Editor;
use super::panels::color32;
use egui::{Align2, Color32, FontId, Mesh, Rect, Ui, pos2, vec2};
use render::palette;

/// Size of the scale [points].
const SIZE: [f32; 2] = [220.0, 12.0];
/// Pieces with a colour of their own at either end.
const PIECES: usize = 24;

/// Paints it over the picture where stitches have the colours of their strain.
pub fn show(editor: &Editor, ui: &Ui, picture: Rect) {
    if editor.strain().is_none() && editor.preview.is_none() {
        return;
    }
    let painter = ui.painter().with_clip_rect(picture);
    let scale = Rect::from_min_size(picture.left_bottom() + vec2(24.0, -56.0), SIZE.into());
    let back = scale.expand2(vec2(16.0, 24.0));
    painter.rect_filled(back, 6.0, Color32::from_black_alpha(190));
    let mut mesh = Mesh::default();
    for i in 0..=PIECES {
        let part = i as f32 / PIECES as f32;
        let color = color32(palette::strain((2.0 * part - 1.0) * palette::MOST_STRAIN));
        let x = scale.left() + part * scale.width();
        mesh.colored_vertex(pos2(x, scale.top()), color);
        mesh.colored_vertex(pos2(x, scale.bottom()), color);
        if i > 0 {
            let n = 2 * i as u32;
            mesh.add_triangle(n - 2, n - 1, n);
            mesh.add_triangle(n - 1, n, n + 1);
        }
    }
    painter.add(mesh);
    let most = 100.0 * palette::MOST_STRAIN;
    let font = || FontId::proportional(12.0);
    for (part, align, number, word) in [
        (0.0, Align2::LEFT_TOP, format!("−{most:.0} %"), "pressed"),
        (0.5, Align2::CENTER_TOP, "0".to_owned(), "even"),
        (1.0, Align2::RIGHT_TOP, format!("+{most:.0} %"), "stretched"),
    ] {
        let x = scale.left() + part * scale.width();
        painter.text(pos2(x, scale.bottom() + 4.0), align, number, font(), Color32::WHITE);
        let above = Align2([align.x(), egui::Align::BOTTOM]);
        painter.text(pos2(x, scale.top() - 4.0), above, word, font(), Color32::WHITE);
    }
}
