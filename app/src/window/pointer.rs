//! What the left button does in the viewport: selecting, painting, grabbing.

use super::editor::Editor;
use super::navigation::Navigation;
use super::request::Request;
use super::selection::{Change, Mode, Picked};
use crate::command::Command;
use crate::drawing::Stage;
use egui::{Modifiers, PointerButton, Pos2, Rect, Response, Stroke, StrokeKind, Ui};
use glam::Vec2;
use render::{Ray, Visible, pick};
use sim_core::Pin;
use std::collections::HashSet;
use stitch_mesh::ids::{EdgeId, FaceId, HalfEdgeId};

/// Stiffness with which the hand holds a loop, over the stiffness of its yarn in stretch: firm, and far from tearing.
const GRIP: f64 = 20.0;

/// How far outside of the fabric the pointer still finds the edge on its border [px].
const BESIDE: f32 = 6.0;

/// What the hand holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Tool {
    /// Click to select, drag for a box.
    Select,
    /// Drag a circle over what is to be selected.
    Brush,
    /// Drag over stitches to paint them.
    Paint,
    /// Drag the yarn.
    Grab,
    /// Click yarn to cut it.
    Scissors,
}

/// A drag that is under way.
pub enum Gesture {
    /// A box from where the button went down.
    Box(Pos2),
    /// A circle, over what showed when the button went down; whether it takes away.
    Brush(Visible, Change),
    /// Painting.
    Paint(PaintStroke),
    /// A loop in the hand.
    Grab(Pin),
}

/// A stroke of the painting brush.
pub struct PaintStroke {
    /// Faces reached so far.
    reached: HashSet<FaceId>,
    /// Where the pointer was last.
    last: Pos2,
    /// Whether something was painted.
    has_painted: bool,
}

/// Does what the left button asks for; draws what it drags.
pub fn use_tool(editor: &mut Editor, ui: &Ui, response: &Response, rect: Rect) {
    work(editor, ui, response, rect);
    if !ui.input(|i| i.pointer.primary_down())
        && let Some(Gesture::Grab(_)) = editor.gesture.take()
    {
        editor.pull(None);
    }
}

fn work(editor: &mut Editor, ui: &Ui, response: &Response, rect: Rect) {
    let pointer = response.hover_pos().or(response.interact_pointer_pos());
    let Some(at) = pointer else {
        editor.point_at(super::chart::pointed(editor));
        return;
    };
    let local = at - rect.min;
    let size = Vec2::new(rect.width(), rect.height());
    let ray = editor.camera.ray(Vec2::new(local.x, local.y), size);
    if let Some(Gesture::Grab(pin)) = editor.gesture {
        move_grabbed(editor, pin, ray);
        return;
    }
    let hit = pick(&editor.faces, ray).or_else(|| {
        // An edge on the border is pointed at from outside, too.
        let is_edge = editor.selection().mode == Mode::Edge && editor.tool == Tool::Select;
        let around = (0..8).map(|i| Vec2::from_angle(std::f32::consts::TAU * i as f32 / 8.0) * BESIDE);
        let mut rays = around.map(|off| editor.camera.ray(Vec2::new(local.x, local.y) + off, size));
        is_edge.then(|| rays.find_map(|ray| pick(&editor.faces, ray)))?
    });
    let first = |face: usize| editor.surface().mesh().first_half_edge(FaceId::new(face));
    editor.point_at(hit.map(|h| (HalfEdgeId::new(first(h.polygon).index() + h.edge), h.position)));
    if editor.navigation.takes_left_button(ui) {
        return;
    }
    let modifiers = ui.input(modifiers_of_click);
    let held = response.is_pointer_button_down_on() && ui.input(|i| i.pointer.primary_down());
    match editor.tool {
        Tool::Select => select(editor, ui, response, rect, modifiers),
        Tool::Brush => brush(editor, ui, at, rect, held || response.clicked(), modifiers),
        Tool::Paint => paint(editor, ui, response, rect, at, modifiers),
        Tool::Grab if held => grab(editor),
        Tool::Grab => {}
        Tool::Scissors if response.clicked() => editor.cut_at(ray),
        Tool::Scissors => ui.ctx().set_cursor_icon(egui::CursorIcon::Crosshair),
    }
}

/// The modifiers with which the button came up, if it has just done so: by the time of the frame they may be released.
pub(super) fn modifiers_of_click(input: &egui::InputState) -> Modifiers {
    let of = |event: &egui::Event| match event {
        egui::Event::PointerButton { pressed: false, modifiers, .. } => Some(*modifiers),
        _ => None,
    };
    input.events.iter().find_map(of).unwrap_or(input.modifiers)
}

fn select(editor: &mut Editor, ui: &Ui, response: &Response, rect: Rect, modifiers: Modifiers) {
    if response.drag_started_by(PointerButton::Primary)
        && let Some(from) = ui.input(|i| i.pointer.press_origin())
    {
        editor.gesture = Some(Gesture::Box(from));
    }
    if let Some(Gesture::Box(from)) = editor.gesture
        && let Some(to) = response.interact_pointer_pos()
    {
        let area = Rect::from_two_pos(from, to).intersect(rect);
        if response.drag_stopped() {
            editor.gesture = None;
            let visible = seen(editor, rect);
            let inside = |p: Vec2| area.contains(rect.min + egui::vec2(p.x, p.y));
            let picked = covered(editor, &visible, inside);
            editor.select(picked, Change::of(modifiers));
        } else {
            let visuals = ui.visuals();
            ui.painter().rect(
                area,
                0.0,
                visuals.selection.bg_fill.gamma_multiply(0.25),
                Stroke::new(1.5, visuals.selection.stroke.color),
                StrokeKind::Inside,
            );
        }
        return;
    }
    let looped = match editor.navigation {
        Navigation::MiddleButton => modifiers.alt,
        // A click elsewhere shortly before makes three of two.
        Navigation::Alt => response.double_clicked() || response.triple_clicked(),
    };
    if response.clicked() {
        let mode = editor.selection().mode;
        let nothing = if mode == Mode::Edge { Picked::Edges(vec![]) } else { Picked::Faces(vec![]) };
        let picked = editor.under.map(|(half, _)| Picked::at(editor.surface(), half, mode, looped));
        editor.select(picked.unwrap_or(nothing), Change::of(modifiers));
    }
}

fn brush(editor: &mut Editor, ui: &Ui, at: Pos2, rect: Rect, held: bool, modifiers: Modifiers) {
    let radius = editor.panel.brush_radius;
    ui.painter().circle_stroke(at, radius, Stroke::new(1.5, ui.visuals().strong_text_color()));
    if !held {
        return;
    }
    if editor.gesture.is_none() {
        let change = Change::of(modifiers);
        if change == Change::Replace {
            editor.select(Picked::Faces(vec![]), Change::Replace);
        }
        let goes_on = if change == Change::Remove { Change::Remove } else { Change::Add };
        editor.gesture = Some(Gesture::Brush(seen(editor, rect), goes_on));
    }
    if let Some(Gesture::Brush(visible, change)) = &editor.gesture {
        let center = Vec2::new(at.x - rect.min.x, at.y - rect.min.y);
        let (picked, change) = (covered(editor, visible, |p| p.distance(center) <= radius), *change);
        editor.select(picked, change);
    }
}

/// What shows of the mesh just now.
fn seen(editor: &Editor, rect: Rect) -> Visible {
    let size = [rect.width(), rect.height()].map(|s| s.max(1.0) as usize);
    Visible::new(&editor.faces, &editor.camera, size)
}

/// Faces whose middle shows inside of an area, or edges; whole rows in that mode.
fn covered(editor: &Editor, visible: &Visible, inside: impl Fn(Vec2) -> bool) -> Picked {
    /// How far towards the middle of its face an edge is looked at: on the edge itself two faces meet.
    const INWARDS: f32 = 0.15;
    let (surface, faces) = (editor.surface(), &editor.faces);
    let mode = editor.selection().mode;
    let (mut covered, mut edges) = (Vec::new(), Vec::<EdgeId>::new());
    for polygon in (0..faces.polygons.len()).filter(|p| !faces.polygons[*p].vertices.is_empty()) {
        let corners: Vec<_> = faces.corners(polygon).collect();
        let middle = corners.iter().sum::<glam::Vec3>() / corners.len() as f32;
        let covers = |p| visible.sees(p, polygon).is_some_and(&inside);
        if mode != Mode::Edge {
            covered.extend(covers(middle).then_some(FaceId::new(polygon)));
            continue;
        }
        for (i, half) in surface.mesh().face_half_edges(FaceId::new(polygon)).enumerate() {
            let on_edge = (corners[i] + corners[(i + 1) % corners.len()]) / 2.0;
            edges.extend(covers(on_edge.lerp(middle, INWARDS)).then(|| surface.mesh().edge(half)));
        }
    }
    match mode {
        Mode::Edge => Picked::Edges(edges),
        Mode::Face => Picked::Faces(covered),
        Mode::Row => Picked::Faces(covered.into_iter().flat_map(|f| surface.row(f)).collect()),
    }
}

fn paint(editor: &mut Editor, ui: &Ui, response: &Response, rect: Rect, at: Pos2, modifiers: Modifiers) {
    let held = holds(ui, response);
    if !held && !response.clicked() {
        return;
    }
    let mode = if editor.selection().mode == Mode::Row { Mode::Row } else { Mode::Face };
    let reached = |half, looped| match Picked::at(editor.surface(), half, mode, looped) {
        Picked::Faces(faces) => faces,
        Picked::Edges(_) => Vec::new(),
    };
    let way = stroke(editor, ui, at);
    let mut faces = Vec::new();
    if way.len() > 1 {
        let visible = seen(editor, rect);
        let passed = way.iter().filter_map(|p| visible.at(Vec2::new(p.x - rect.min.x, p.y - rect.min.y)));
        let mut passed: Vec<usize> = passed.collect();
        passed.dedup();
        let mesh = editor.surface().mesh();
        faces.extend(passed.into_iter().flat_map(|f| reached(mesh.first_half_edge(FaceId::new(f)), false)));
    }
    faces.extend(editor.under.into_iter().flat_map(|(half, _)| reached(half, modifiers.alt)));
    paint_over(editor, faces, at, held, response.clicked());
}

/// Whether the button is held on something, or has been until this frame.
pub(super) fn holds(ui: &Ui, response: &Response) -> bool {
    let is_down = response.is_pointer_button_down_on() && ui.input(|i| i.pointer.primary_down());
    is_down || response.drag_stopped_by(PointerButton::Primary)
}

/// Where the pointer has been since the stroke's last frame: it is told of places with gaps between them, and a frame may take a while.
pub(super) fn stroke(editor: &Editor, ui: &Ui, at: Pos2) -> Vec<Pos2> {
    /// From place to place of a stroke [px].
    const STEP: f32 = 3.0;
    let last = match &editor.gesture {
        Some(Gesture::Paint(stroke)) => stroke.last,
        _ => ui.input(|input| input.pointer.press_origin()).unwrap_or(at),
    };
    let moved = |event: &egui::Event| match event {
        egui::Event::PointerMoved(to) => Some(*to),
        _ => None,
    };
    let told: Vec<Pos2> = ui.input(|input| input.events.iter().filter_map(moved).collect());
    let mut from = last;
    let mut way = Vec::new();
    for to in told.into_iter().chain([at]) {
        let steps = (from.distance(to) / STEP).ceil().max(1.0);
        way.extend((1..=steps as usize).map(|i| from.lerp(to, i as f32 / steps)));
        from = to;
    }
    way.dedup();
    way
}

/// Paints what a stroke has reached, where the stitch in the hand fits. All of a stroke is one step of the history.
pub(super) fn paint_over(editor: &mut Editor, mut faces: Vec<FaceId>, at: Pos2, held: bool, clicked: bool) {
    // A quick click is over before the next frame sees the button.
    let begins = clicked && editor.gesture.is_none();
    if !(held || begins) {
        return;
    }
    let mut stroke = match editor.gesture.take() {
        Some(Gesture::Paint(stroke)) => stroke,
        _ => PaintStroke { reached: HashSet::new(), last: at, has_painted: false },
    };
    faces.retain(|f| stroke.reached.insert(*f));
    stroke.last = at;
    let faces = editor.that_take(&editor.brush, &faces);
    if !faces.is_empty() {
        let command = Command::SetStitch { faces, stitch: editor.brush.clone() };
        let goes_on = std::mem::replace(&mut stroke.has_painted, true);
        editor.request(if goes_on { Request::Amend(command) } else { Request::Do(command) });
    }
    editor.gesture = (held && !stroke.reached.is_empty()).then_some(Gesture::Paint(stroke));
}

fn grab(editor: &mut Editor) {
    // Taken as soon as the pressed pointer is over yarn: it may have come down in a gap.
    if editor.stage == Stage::Yarn
        && let Some((_, at)) = editor.under
        && let Some((node, position)) = editor.nearest_node(at.as_dvec3())
    {
        let material = &editor.view.project.materials.base;
        let stiffness = GRIP * material.bend_stiffness() / material.radius.powi(3);
        editor.pull(Some(Pin { node, target: position, stiffness }));
        if !editor.playing {
            editor.set_playing(true);
        }
    }
}

/// The hand moves in the plane through the loop that faces the camera.
fn move_grabbed(editor: &mut Editor, pin: Pin, ray: Ray) {
    let [.., back] = editor.camera.axes();
    let from = pin.target.as_vec3();
    let t = (from - ray.origin).dot(back) / ray.direction.dot(back);
    editor.pull(Some(Pin { target: (ray.origin + ray.direction * t).as_dvec3(), ..pin }));
}
