//! The middle of the window: the picture, the camera under the mouse, and the tools on what the mouse points at.
//!
//! Left button: the tool. Middle or right button: orbit; with Shift pan. Wheel: zoom.

use super::editor::Editor;
use super::session::Request;
use super::tools::Tool;
use crate::command::Command;
use crate::drawing::Stage;
use egui::{PointerButton, Sense};
use glam::{Vec2, Vec3};
use render::{Hit, Lines, Ray, Segment, palette, pick};
use sim_core::Pin;
use stitch_mesh::ids::FaceId;

/// Stiffness with which the hand holds a loop, over the stiffness of its yarn in stretch: firm, and far from tearing.
const GRIP: f64 = 20.0;

/// Shows the viewport and does what the mouse asks for.
pub fn show(editor: &mut Editor, ui: &mut egui::Ui) {
    let frame = egui::Frame::NONE;
    egui::CentralPanel::default().frame(frame).show(ui, |ui| {
        let size = ui.available_size();
        let (rect, response) = ui.allocate_exact_size(size, Sense::click_and_drag());
        editor.panel.aspect = (size.x / size.y.max(1.0)).max(0.01);
        move_camera(editor, ui, &response, rect);
        let pointer = response.hover_pos().or(response.interact_pointer_pos()).map(|p| p - rect.min);
        if let Some(at) = pointer {
            let ray = editor.camera.ray(Vec2::new(at.x, at.y), Vec2::new(size.x, size.y));
            use_tool(editor, ui, &response, ray);
        } else {
            highlight(editor, None);
        }
        if !ui.input(|i| i.pointer.primary_down()) {
            editor.stroke = None;
            if editor.grabbed.is_some() {
                editor.pull(None);
            }
        }
        let scale = ui.ctx().pixels_per_point();
        let pixels = [size.x, size.y].map(|s| (s * scale).round().max(1.0) as u32);
        let moving =
            editor.playing || response.dragged() || ui.ctx().input(|i| i.smooth_scroll_delta.y != 0.0);
        let Some(screen) = &mut editor.screen else { return };
        match screen.draw(pixels, &editor.camera, moving) {
            Ok(texture) => {
                let whole = egui::Rect::from_min_max(egui::pos2(0.0, 0.0), egui::pos2(1.0, 1.0));
                ui.painter().image(texture, rect, whole, egui::Color32::WHITE);
            }
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

fn move_camera(editor: &mut Editor, ui: &egui::Ui, response: &egui::Response, rect: egui::Rect) {
    let turning = response.dragged_by(PointerButton::Middle) || response.dragged_by(PointerButton::Secondary);
    if turning {
        let delta = response.drag_delta();
        if ui.input(|i| i.modifiers.shift) {
            editor.camera.pan(Vec2::new(delta.x, delta.y), rect.height());
        } else {
            editor.camera.orbit(-delta.x * 0.01, delta.y * 0.01);
        }
    }
    if response.hovered() {
        let scroll = ui.input(|i| i.smooth_scroll_delta.y);
        if scroll != 0.0 {
            editor.camera.zoom((-scroll * 0.002).exp());
        }
    }
}

fn use_tool(editor: &mut Editor, ui: &egui::Ui, response: &egui::Response, ray: Ray) {
    if let Some(pin) = editor.grabbed {
        // The hand moves in the plane through the loop that faces the camera.
        let [.., back] = editor.camera.axes();
        let from = pin.target.as_vec3();
        let t = (from - ray.origin).dot(back) / ray.direction.dot(back);
        editor.pull(Some(Pin { target: (ray.origin + ray.direction * t).as_dvec3(), ..pin }));
        return;
    }
    let hit = pick(&editor.faces, ray);
    highlight(editor, hit);
    let Some(hit) = hit else { return };
    let face = FaceId::new(hit.polygon);
    match (editor.stage, editor.tool) {
        (Stage::Labels, tool) if response.clicked() => {
            let labelled = editor.project().labelled.clone();
            let corners = &editor.faces.polygons[hit.polygon].vertices;
            let edge = [corners[hit.edge], corners[(hit.edge + 1) % corners.len()]];
            let onwards = ui.input(clicked_with_shift);
            if let Some(command) = tool.label(&labelled, face, edge, onwards) {
                editor.act(command);
            }
        }
        (Stage::Stitches | Stage::Yarn, Tool::Paint(reach)) => {
            let held = response.is_pointer_button_down_on() && ui.input(|i| i.pointer.primary_down());
            // A quick click is over before the next frame sees the button.
            let clicked = response.clicked() && editor.stroke.is_none();
            if !held && !clicked {
                editor.stroke = None;
                return;
            }
            let Some(fabric) = &editor.view.project.fabric else { return };
            let mut faces = reach.faces(&fabric.stitches, face);
            if let Some(stroke) = &editor.stroke {
                faces.retain(|f| !stroke.contains(f));
            }
            if faces.is_empty() {
                return;
            }
            let command = Command::SetStitch { faces: faces.clone(), stitch: editor.brush.clone() };
            let goes_on = editor.stroke.is_some();
            editor.stroke.get_or_insert_default().extend(faces);
            editor.request(if goes_on { Request::Amend(command) } else { Request::Do(command) });
        }
        (Stage::Yarn, Tool::Grab) => {
            // Taken as soon as the pressed pointer is over yarn: it may have come down in a gap.
            if response.is_pointer_button_down_on()
                && ui.input(|i| i.pointer.primary_down())
                && let Some((node, position)) = editor.nearest_node(hit.position.as_dvec3())
            {
                let material = &editor.view.project.material;
                let stiffness = GRIP * material.bend_stiffness() / material.radius.powi(3);
                editor.pull(Some(Pin { node, target: position, stiffness }));
                if !editor.playing {
                    editor.set_playing(true);
                }
            }
        }
        _ => {}
    }
}

/// Whether Shift was down when the button came up; by the time of the frame it may be up again.
fn clicked_with_shift(input: &egui::InputState) -> bool {
    input.events.iter().any(|event| {
        matches!(event, egui::Event::PointerButton { pressed: false, modifiers, .. } if modifiers.shift)
    })
}

/// Outlines what the pointer is over: an edge for the edge tools, a face for the others.
fn highlight(editor: &mut Editor, hit: Option<Hit>) {
    let on_edge = matches!(editor.tool, Tool::Fill | Tool::Course | Tool::Wale | Tool::Erase);
    let has_tool = editor.stage != Stage::Mesh && !(editor.stage == Stage::Yarn && editor.playing);
    let over = hit.filter(|_| has_tool).map(|h| (h.polygon, if on_edge { h.edge } else { usize::MAX }));
    if over == editor.hovered {
        return;
    }
    editor.hovered = over;
    let mut lines = editor.base_lines.clone();
    if let Some((polygon, edge)) = over {
        let corners: Vec<Vec3> = editor.faces.corners(polygon).collect();
        let n = corners.len();
        let sides = (0..n).filter(|i| edge == usize::MAX || *i == edge);
        lines.segments.extend(sides.map(|i| Segment {
            ends: [corners[i], corners[(i + 1) % n]],
            color: palette::SELECTED,
            width: 5.0,
        }));
    }
    if let Some(screen) = &mut editor.screen {
        // Lines that could not be shown are not worth a message of their own: the next drawing says why.
        let _ = screen.set_lines(&Lines { segments: lines.segments });
    }
}
