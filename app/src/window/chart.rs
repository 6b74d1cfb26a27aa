//! The chart: the rows of the fabric as knitters write them down, under the picture. A click selects the stitch, and with the
//! brush in the hand it is painted; what is selected is outlined here too.

use super::actions;
use super::editor::Editor;
use super::pointer::{Tool, holds, modifiers_of_click, paint_over, stroke};
use super::request::Request;
use super::selection::{Change, Mode, Picked};
use crate::drawing::Stage;
use egui::{Color32, Pos2, Rect, Response, Sense, Shape, Stroke, StrokeKind, Ui, pos2, vec2};
use glam::Vec3;
use patterns::diagram::mark::{Mark, Paint};
use patterns::diagram::{Cell, Course, Diagram, sheet};
use std::collections::BTreeSet;
use std::sync::Arc;
use stitch_mesh::ids::{FaceId, HalfEdgeId};
use stitch_mesh::stitch_mesh::StitchMesh;

/// Columns and rows at the most: more cannot be read.
const MOST: [usize; 2] = [60, 80];

/// Size of a square [points].
const SQUARE: f32 = 20.0;

/// An open chart.
#[derive(Default)]
pub struct ChartView {
    /// The faces around which it is; where there are none, the piece that begins with the lowest row.
    pub(super) part: BTreeSet<FaceId>,
    /// What it shows, and for what it was made.
    shown: Option<(Arc<StitchMesh>, BTreeSet<FaceId>, Drawn)>,
    /// Where the panel and the drawing are.
    panel: Option<Rect>,
    corner: Option<Pos2>,
    /// The face under the pointer.
    over: Option<FaceId>,
    /// Where a box began that is being drawn.
    box_from: Option<Pos2>,
}

/// A chart with its marks.
struct Drawn {
    diagram: Diagram,
    marks: Vec<Mark>,
}

impl Editor {
    /// Opens the chart, around what is selected where that is more than one stitch, or closes it.
    pub(super) fn toggle_chart(&mut self) {
        if self.chart.take().is_none() {
            self.chart_part(self.selection().faces.len() > 1);
        }
    }

    /// Charts what is selected, or the piece that begins with the lowest row.
    pub(super) fn chart_part(&mut self, selected: bool) {
        let part = if selected { self.selection().faces.clone() } else { BTreeSet::new() };
        self.chart.get_or_insert_default().part = part;
    }

    /// Saves the chart beside the project.
    pub(super) fn save_chart(&mut self, extension: &str) {
        if let Some(path) = self.named(extension) {
            self.write(Request::SaveChart(path, self.courses()));
        }
    }

    fn courses(&self) -> Vec<Course> {
        let view = &self.view;
        let (Some(fabric), Some(rows)) = (&view.project.fabric, &view.fabric_rows) else {
            return Vec::new();
        };
        match &self.chart {
            Some(chart) if !chart.part.is_empty() => {
                Course::around(&fabric.stitches, &rows.rows, &chart.part)
            }
            _ => Course::piece(&fabric.stitches, &rows.rows),
        }
    }

    /// Where the chart's panel is, if it is open.
    pub fn chart_panel(&self) -> Option<Rect> {
        self.chart.as_ref()?.panel
    }

    /// Where the first square of a face is in the window.
    pub fn in_chart(&self, face: FaceId) -> Option<Rect> {
        let chart = self.chart.as_ref()?;
        let (.., drawn) = chart.shown.as_ref()?;
        let (row, cell) = drawn.diagram.cells().find(|(_, c)| c.face == Some(face))?;
        Some(place(&drawn.diagram, chart.corner?, row, cell))
    }

    /// The chart that is open.
    pub fn diagram(&self) -> Option<&Diagram> {
        self.chart.as_ref()?.shown.as_ref().map(|(.., drawn)| &drawn.diagram)
    }

    /// Makes the chart where its stitches or its part are others than before.
    fn draw_chart(&mut self) {
        let Some(fabric) = &self.view.project.fabric else { return };
        let (stitches, courses) = (Arc::clone(&fabric.stitches), self.courses());
        let Some(chart) = &mut self.chart else { return };
        let diagram = Diagram::of(&stitches, &courses, MOST);
        let marks = diagram.marks();
        chart.shown = Some((stitches, chart.part.clone(), Drawn { diagram, marks }));
    }

    fn chart_is_old(&self) -> bool {
        let now = self.view.project.fabric.as_ref().map(|f| &f.stitches);
        let shown = self.chart.as_ref().and_then(|c| c.shown.as_ref().map(|shown| (c, shown)));
        !shown.zip(now).is_some_and(|((chart, (stitches, part, _)), now)| {
            Arc::ptr_eq(stitches, now) && *part == chart.part
        })
    }
}

/// What the pointer is over in the chart, as the side of a face and a place.
pub(super) fn pointed(editor: &Editor) -> Option<(HalfEdgeId, Vec3)> {
    let face = editor.chart.as_ref()?.over?;
    let mesh = editor.surface().mesh();
    (face.index() < mesh.face_count()).then(|| (mesh.first_half_edge(face), mesh.face_center(face).as_vec3()))
}

/// Shows the panel, where there is a fabric.
pub fn show(editor: &mut Editor, ui: &mut Ui) {
    let has_stitches = matches!(editor.stage, Stage::Stitches | Stage::Yarn);
    if editor.chart.is_none() || editor.project().fabric.is_none() || !has_stitches {
        if let Some(chart) = &mut editor.chart {
            (chart.panel, chart.over) = (None, None);
        }
        return;
    }
    if editor.chart_is_old() {
        editor.draw_chart();
    }
    let half = ui.available_height() / 2.0;
    let panel = egui::Panel::bottom("chart").resizable(true).default_size(half.min(340.0)).max_size(half);
    let shown = panel.show(ui, |ui| {
        ui.horizontal(|ui| {
            ui.heading("Chart");
            for (name, text) in [
                ("Chart all rows", "All rows"),
                ("Chart the selection", "Selection"),
                ("Save chart as SVG", "Save SVG…"),
                ("Save chart as PNG", "Save PNG…"),
                ("Chart", "Close"),
            ] {
                actions::button_as(editor, ui, name, text);
            }
            if let Some(part) = editor.diagram().and_then(Diagram::left_out) {
                ui.label(egui::RichText::new(part).weak());
            }
        });
        // Knitters begin below on the right.
        let scroll = egui::ScrollArea::both().auto_shrink(false).stick_to_bottom(true).stick_to_right(true);
        scroll.show(ui, |ui| squares(editor, ui));
    });
    if let Some(chart) = &mut editor.chart {
        chart.panel = Some(shown.response.rect);
    }
}

fn place(diagram: &Diagram, corner: Pos2, row: usize, cell: &Cell) -> Rect {
    let [x, y] = diagram.corner(row, cell.columns.start);
    let size = vec2(cell.columns.len() as f32, 1.0);
    Rect::from_min_size(corner + SQUARE * vec2(x, y), SQUARE * size)
}

/// The drawing, and what the mouse does in it.
fn squares(editor: &mut Editor, ui: &mut Ui) {
    // Out of the editor while it is drawn, as clicks change the editor.
    let Some(mut chart) = editor.chart.take() else { return };
    if let Some((.., drawn)) = &chart.shown {
        let size = SQUARE * egui::Vec2::from(drawn.diagram.size());
        let (rect, response) = ui.allocate_exact_size(size, Sense::click_and_drag());
        ui.ctx().accesskit_node_builder(response.id, |node| node.set_label("Squares of the chart"));
        let area = ui.clip_rect();
        let painter = ui.painter();
        painter.rect_filled(rect, 0.0, Color32::WHITE);
        // What does not show costs nothing.
        let [from, to] = [area.min, area.max].map(|p| <[f32; 2]>::from((p - rect.min) / SQUARE));
        let shows = |m: &&Mark| {
            [0, 1].into_iter().all(|i| {
                m.points.iter().any(|p| p[i] >= from[i] - 1.0) && m.points.iter().any(|p| p[i] <= to[i] + 1.0)
            })
        };
        painter.extend(drawn.marks.iter().filter(shows).map(|m| shape(m, rect.min)));
        let selected = &editor.selection().faces;
        let color = ui.visuals().selection.bg_fill;
        for (row, cell) in drawn.diagram.cells() {
            if cell.face.is_some_and(|f| selected.contains(&f)) {
                let at = place(&drawn.diagram, rect.min, row, cell);
                painter.rect_filled(at, 0.0, color.gamma_multiply(0.25));
                painter.rect_stroke(at, 0.0, Stroke::new(2.5, color), StrokeKind::Inside);
            }
        }
        chart.corner = Some(rect.min);
        let pointer = response.hover_pos().or(response.interact_pointer_pos()).filter(|p| area.contains(*p));
        let cell = pointer.map(|p| (p - rect.min) / SQUARE).and_then(|p| drawn.diagram.cell_at([p.x, p.y]));
        chart.over = cell.and_then(|c| c.face);
        let response = match cell {
            Some(cell) => {
                let name = cell.stitch.as_ref().map_or("no stitch".to_owned(), sheet::name);
                response.on_hover_text_at_pointer(name)
            }
            None => response,
        };
        if response.drag_started_by(egui::PointerButton::Primary) && editor.tool != Tool::Paint {
            chart.box_from = ui.input(|i| i.pointer.press_origin());
        }
        let drawn_box =
            chart.box_from.zip(response.interact_pointer_pos()).map(|(a, b)| Rect::from_two_pos(a, b));
        let over = match drawn_box {
            Some(drawn_box) => {
                ui.painter().rect_stroke(drawn_box, 0.0, Stroke::new(1.5, color), StrokeKind::Middle);
                let cells = drawn.diagram.cells();
                let inside = cells
                    .filter(|(row, cell)| place(&drawn.diagram, rect.min, *row, cell).intersects(drawn_box));
                inside.filter_map(|(_, cell)| cell.face).collect()
            }
            None if editor.tool == Tool::Paint => {
                let way = pointer.map(|at| stroke(editor, ui, at)).unwrap_or_default();
                let squares = way.iter().map(|p| (*p - rect.min) / SQUARE);
                let cells = squares.filter_map(|p| drawn.diagram.cell_at([p.x, p.y]));
                cells.filter_map(|cell| cell.face).collect()
            }
            None => chart.over.into_iter().collect(),
        };
        if response.drag_stopped() {
            chart.box_from = None;
        }
        use_mouse(editor, ui, &response, pointer, over, drawn_box.is_some());
    }
    editor.chart = Some(chart);
}

/// A click selects or paints what it hits, a box selects what it touches once it is drawn.
fn use_mouse(
    editor: &mut Editor,
    ui: &Ui,
    response: &Response,
    at: Option<Pos2>,
    over: Vec<FaceId>,
    in_box: bool,
) {
    let held = holds(ui, response);
    let faces: Vec<FaceId> = match editor.selection().mode {
        Mode::Row => over.into_iter().flat_map(|face| editor.surface().row(face)).collect(),
        _ => over,
    };
    if editor.tool == Tool::Paint {
        if let Some(at) = at {
            paint_over(editor, faces, at, held, response.clicked());
        }
    } else if response.clicked() || in_box && response.drag_stopped() {
        editor.select(Picked::Faces(faces), Change::of(ui.input(modifiers_of_click)));
    }
}

/// A mark in the window.
fn shape(mark: &Mark, corner: Pos2) -> Shape {
    let points = mark.points.iter().map(|p| pos2(corner.x + SQUARE * p[0], corner.y + SQUARE * p[1]));
    let color = |[r, g, b]: [u8; 3]| Color32::from_rgb(r, g, b);
    match mark.paint {
        Paint::Fill(ink) => Shape::convex_polygon(points.collect(), color(ink.rgb()), Stroke::NONE),
        Paint::Line(ink, width) => {
            Shape::line(points.collect(), Stroke::new(width * SQUARE, color(ink.rgb())))
        }
    }
}
