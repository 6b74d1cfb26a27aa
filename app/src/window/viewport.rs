//! The middle of the window: the picture, with the camera and the tools under the mouse.

use super::editor::Editor;
use super::{legend, navigation, numbers, pointer};
use egui::Sense;

/// Shows the viewport and does what the mouse asks for.
pub fn show(editor: &mut Editor, ui: &mut egui::Ui) {
    let frame = egui::Frame::NONE;
    egui::CentralPanel::default().frame(frame).show(ui, |ui| {
        let size = ui.available_size();
        let (rect, response) = ui.allocate_exact_size(size, Sense::click_and_drag());
        super::panels::library::take_dropped(editor, &response);
        editor.panel.aspect = (size.x / size.y.max(1.0)).max(0.01);
        // The picture lies under what tools draw, and is drawn after what they do.
        let picture = ui.painter().add(egui::Shape::Noop);
        navigation::move_camera(editor, ui, &response, rect);
        pointer::use_tool(editor, ui, &response, rect);
        numbers::show(editor, ui, rect);
        legend::show(editor, ui, rect);
        editor.show_marks();
        let scale = ui.ctx().pixels_per_point();
        let pixels = [size.x, size.y].map(|s| (s * scale).round().max(1.0) as u32);
        let moving =
            editor.playing || response.dragged() || ui.ctx().input(|i| i.smooth_scroll_delta.y != 0.0);
        let Some(screen) = &mut editor.screen else { return };
        match screen.draw(pixels, &editor.camera, moving) {
            Ok(pasted) => ui.painter().set(picture, egui_wgpu::Callback::new_paint_callback(rect, pasted)),
            Err(error) => editor.error = Some(format!("{error:#}")),
        }
        // A last frame in full once everything is at rest.
        let was_moving = ui.ctx().data_mut(|data| {
            let before = data.get_temp::<bool>(response.id).unwrap_or(false);
            data.insert_temp(response.id, moving);
            before
        });
        if was_moving && !moving {
            ui.ctx().request_repaint();
        }
    });
}
