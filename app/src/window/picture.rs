//! What the screen is given: the stage, the selection on it, and the mark under the pointer.

use super::editor::Editor;
use super::selection::Mode;
use super::strung::Strung;
use crate::drawing::{Stage, draw_stitches, drawing_where, stitch_colors};
use crate::solids::solids;
use glam::Vec3;
use render::{Drawing, Faces, Lines, Polygon, Segment, Solids, YarnLayout, palette};
use sim_core::{DeviceYarn, Snapshot, curves};
use smallvec::SmallVec;
use std::borrow::Cow;
use std::sync::Arc;
use stitch_mesh::ids::{FaceId, VisitId};
use stitch_mesh::yarn_curves::YarnCurves;

/// Width of lines around what is selected and around what the pointer is over [px].
const SELECTED_WIDTH: f32 = 4.0;
const HOVERED_WIDTH: f32 = 3.0;
/// How much of the colour of a selection its faces take on: enough to see, and the stitch's own colour still shows.
const TINT: f32 = 0.45;
/// How far before and behind the yarn its marks lie, in radii of the yarn: loops reach two radii from the middle.
const LIFT: f64 = 2.6;

/// Yarn as it is shown.
enum ShownYarn<'a> {
    LaidOut(Cow<'a, YarnLayout>),
    /// It is on the device already.
    OnDevice(&'a DeviceYarn),
}

impl Editor {
    /// Puts the stage on the screen. Stitches that have only changed their kind keep their polygons and lines.
    pub(super) fn show_stage(&mut self) {
        let stage = self.shown_stage();
        let fabric = self.view.project.fabric.as_ref().filter(|_| stage == Stage::Stitches);
        let drawn = fabric.map(|f| (f.stitches.clone(), self.selection().hidden.clone()));
        let same = match (&drawn, &self.drawn) {
            (Some((new, hidden)), Some((old, were))) => {
                new.has_mesh_of(old) && new.cables() == old.cables() && hidden == were
            }
            _ => false,
        };
        self.drawn = drawn;
        self.preview = None;
        if !same {
            self.show_polygons(stage);
        } else if let (Some(fabric), Some(rows)) = (fabric, &self.view.fabric_rows) {
            let colors = stitch_colors(&fabric.stitches, &rows.rows, self.stitch_colors);
            for (polygon, color) in self.faces.polygons.iter_mut().zip(colors) {
                polygon.color = color;
            }
        }
        self.show_colors();
    }

    fn show_polygons(&mut self, stage: Stage) {
        let hidden = &self.selections[self.surface_index()].hidden;
        let shown = |f: FaceId| !hidden.contains(&f);
        let (project, colors) = (&self.view.project, self.stitch_colors);
        let drawing = match (stage, &project.fabric, &self.view.fabric_rows) {
            // The yarn comes with the snapshots, laid out in the simulation's thread.
            (Stage::Yarn, ..) => Drawing { solids: self.solids_now(), ..Drawing::default() },
            (Stage::Stitches, Some(fabric), Some(rows)) => {
                let faces = std::mem::take(&mut self.faces);
                let mut drawing =
                    Drawing { faces, lines: std::mem::take(&mut self.lines), ..Drawing::default() };
                draw_stitches(&mut drawing, &fabric.stitches, &rows.rows, &shown, colors);
                drawing
            }
            _ => drawing_where(project, stage, &shown, colors).unwrap_or_default(),
        };
        let shown = self.screen.as_mut().map(|screen| screen.set(&drawing));
        self.report(shown);
        if stage == Stage::Yarn {
            self.show_curves();
        }
        self.faces = if stage == Stage::Yarn { self.loop_faces() } else { drawing.faces };
        self.lines = drawing.lines;
    }

    /// Says what could not be shown.
    fn report(&mut self, shown: Option<anyhow::Result<()>>) {
        if let Some(Err(error)) = shown {
            self.error = Some(format!("{error:#}"));
        }
    }

    /// Shows stitches that are being relaxed where they are just now.
    pub(super) fn show_preview(&mut self) {
        let now = self.session.work().and_then(|w| w.preview);
        let now = now.filter(|p| self.stage == Stage::Stitches && p.revision == self.view.revision);
        match (now, &self.preview) {
            (Some(now), before) => {
                let is_new = before.as_ref().is_none_or(|b| !Arc::ptr_eq(b, &now));
                if is_new && now.positions.len() == self.faces.positions.len() {
                    self.faces.positions.clone_from(&now.positions);
                    for (polygon, strain) in self.faces.polygons.iter_mut().zip(&now.strain) {
                        polygon.color = palette::strain(*strain);
                    }
                    let shown = self.screen.as_mut().map(|screen| screen.set_faces(&self.faces));
                    self.report(shown);
                    self.preview = Some(now);
                    self.drawn = None;
                }
            }
            // Done and shown by now, or given up.
            (None, Some(_)) => self.show_stage(),
            (None, None) => {}
        }
    }

    /// Puts yarn that has moved on the screen.
    pub(super) fn show_yarn(&mut self) {
        self.show_curves();
        if self.view.project.scene.bodies.iter().any(|b| b.motion().is_some()) {
            let solids = self.solids_now();
            let shown = self.screen.as_mut().map(|screen| screen.set_solids(&solids));
            self.report(shown);
        }
        self.faces = self.loop_faces();
        self.marked = None;
    }

    /// Puts the yarn on the screen, whatever else is on it.
    fn show_curves(&mut self) {
        let Some(strung) = self.strung.clone() else { return };
        let shown = match self.yarn_of(&strung) {
            ShownYarn::LaidOut(yarn) => self.screen.as_mut().map(|screen| screen.set_yarn(&yarn)),
            ShownYarn::OnDevice(yarn) => self.screen.as_mut().map(|screen| {
                screen.share_yarn(yarn);
                Ok(())
            }),
        };
        self.report(shown);
    }

    /// The yarn of a snapshot as it is shown.
    fn yarn_of<'a>(&self, strung: &'a Strung) -> ShownYarn<'a> {
        match &strung.snapshot.on_device {
            _ if !self.selection().hidden.is_empty() => {
                ShownYarn::LaidOut(Cow::Owned(YarnLayout::of(&self.shown_yarn(&strung.snapshot))))
            }
            Some(yarn) => ShownYarn::OnDevice(yarn),
            None => ShownYarn::LaidOut(Cow::Borrowed(&strung.yarn)),
        }
    }

    /// The curves of a snapshot's yarn, without that of hidden stitches.
    pub(super) fn shown_yarn<'a>(&self, snapshot: &'a Snapshot) -> Cow<'a, YarnCurves> {
        let Snapshot { net, state, .. } = snapshot;
        let yarn = match &snapshot.on_device {
            // It comes without curves.
            Some(_) => Cow::Owned(curves(net, state, &self.view.project.materials)),
            None => Cow::Borrowed(&snapshot.curves),
        };
        let hidden = &self.selection().hidden;
        if hidden.is_empty() {
            return yarn;
        }
        let gone = |visit: VisitId| {
            let node = net.visits.get(visit.index()).and_then(|v| net.nodes.get(v.node.index()));
            node.and_then(|n| n.face).is_some_and(|f| hidden.contains(&f))
        };
        let curves = yarn.curves.iter().flat_map(|curve| curve.without(gone)).collect();
        Cow::Owned(YarnCurves { curves })
    }

    /// The bodies where they are in the simulation.
    fn solids_now(&self) -> Solids {
        let time_s = self.yarn().map_or(0.0, |s| s.scene_time_s);
        solids(&self.view.project.scene, time_s)
    }

    /// Colours the faces: by their own colours or by strain, tinted where they are selected.
    pub(super) fn show_colors(&mut self) {
        self.marked = None;
        if self.shown_stage() == Stage::Yarn {
            return; // yarn has its outline only
        }
        let mut colors: Vec<[f32; 3]> = self.faces.polygons.iter().map(|p| p.color).collect();
        if let Some(strain) = self.strain() {
            colors.iter_mut().zip(strain).for_each(|(color, strain)| *color = palette::strain(*strain));
        }
        for face in &self.selection().faces {
            if let Some(color) = colors.get_mut(face.index()) {
                let mix = |own: f32, tint: f32| own + (tint - own) * TINT;
                *color = [0, 1, 2].map(|i| mix(color[i], palette::SELECTED[i]));
            }
        }
        let shown = self.screen.as_mut().map(|screen| screen.set_colors(&colors));
        self.report(shown);
    }

    /// Colours stitches by strain, or by kind.
    pub(super) fn set_strained(&mut self, strained: bool) {
        self.recolour |= std::mem::replace(&mut self.strained, strained) != strained;
    }

    /// Strain of the faces on the screen, if that is to be seen and known.
    pub(super) fn strain(&self) -> Option<&[f32]> {
        let strain = self.survey.facts.mesh_strain.as_ref();
        let shows = self.strained && self.shown_stage() == Stage::Stitches;
        strain.filter(|s| shows && s.faces.len() == self.faces.polygons.len()).map(|s| &*s.faces)
    }

    /// Draws the outlines of what is selected and of what the pointer is over, where either has changed.
    pub(super) fn show_marks(&mut self) {
        let over = self.under.map(|(half, _)| half).filter(|_| self.stage != Stage::Mesh);
        if self.marked == Some(over) {
            return;
        }
        self.marked = Some(over);
        let surface = self.surface();
        let mesh = surface.mesh();
        let mut segments = Vec::new();
        let lift = match self.shown_stage() {
            Stage::Yarn => (LIFT * self.view.project.materials.base.drawn_radius) as f32,
            _ => 0.0,
        };
        let mut mark = |half: stitch_mesh::ids::HalfEdgeId, color, width| {
            let face = mesh.face(half);
            let side = half.index() - mesh.first_half_edge(face).index();
            let corners: Vec<Vec3> = match self.faces.polygons.get(face.index()) {
                Some(polygon) if !polygon.vertices.is_empty() => self.faces.corners(face.index()).collect(),
                _ => return,
            };
            let ends = [corners[side], corners[(side + 1) % corners.len()]];
            if lift == 0.0 {
                segments.push(Segment { ends, color, width });
            } else {
                let normal = normal(&corners) * lift;
                let moved = [normal, -normal].map(|n| ends.map(|p| p + n));
                segments.extend(moved.map(|ends| Segment { ends, color, width }));
            }
        };
        for edge in self.selection().outline(mesh) {
            let (first, second) = mesh.edge_sides(edge);
            // Of a yarn, each side has a place of its own; the mark belongs to the selected face.
            let selected = |h| self.selection().faces.contains(&mesh.face(h));
            let side = second.filter(|h| selected(*h) && !selected(first)).unwrap_or(first);
            mark(side, palette::SELECTED, SELECTED_WIDTH);
        }
        if let Some(half) = over {
            let on_edge = self.selection().mode == Mode::Edge;
            let sides = mesh.face_half_edges(mesh.face(half)).filter(|h| !on_edge || *h == half);
            sides.for_each(|h| mark(h, palette::HOVERED, HOVERED_WIDTH));
        }
        let marks = Lines { segments };
        if marks != self.marks {
            if let Some(screen) = &mut self.screen {
                // Marks that could not be shown are not worth a message of their own: the next drawing says why.
                let _ = screen.set_marks(&marks);
            }
            self.marks = marks;
        }
    }

    /// The stage that can be shown: without stitches, the labels they are made from.
    fn shown_stage(&self) -> Stage {
        match self.stage {
            Stage::Stitches | Stage::Yarn if self.view.project.fabric.is_none() => Stage::Labels,
            stage => stage,
        }
    }

    /// A polygon over every stitch, where the yarn is now, side by side like the face in the stitch mesh: what the pointer hits
    /// in the yarn. The nodes of a stitch span its middle (see `stitch_mesh::lay`); the polygon goes on to its edges, so that
    /// neighbours leave no gap.
    fn loop_faces(&self) -> Faces {
        let Some(fabric) = &self.view.project.fabric else { return Faces::default() };
        let Some((net, state)) = self.yarn_now(fabric) else { return Faces::default() };
        let mesh = fabric.stitches.mesh();
        let mut nodes: Vec<Vec<[Vec3; 2]>> = vec![Vec::new(); mesh.face_count()];
        for (node, position) in net.nodes.iter().zip(&state.position) {
            if let Some(face) = node.face {
                nodes[face.index()].push([position.as_vec3(), node.position.as_vec3()]);
            }
        }
        let hidden = &self.selection().hidden;
        let mut faces = Faces::default();
        for (face, nodes) in mesh.faces().zip(nodes) {
            if hidden.contains(&face) {
                faces.polygons.push(Polygon { vertices: SmallVec::new(), color: [0.0; 3] });
                continue;
            }
            let stitch = fabric.stitches.stitch(face);
            let outline = match nodes[..] {
                // Four nodes an operation, as LL, LU, RU, RL.
                [[ll, _], [lu, _], .., [ru, _], [rl, _]] if nodes.len() == 4 * stitch.tops() => {
                    let across = (rl - ll) / (1.0 - 0.4 / stitch.tops() as f32);
                    let up = ((lu + ru) - (ll + rl)) / 2.0 / 0.4;
                    let left = (ll + rl) / 2.0 - 0.1 * up - across / 2.0;
                    outline(left, across, up, stitch.bottoms(), stitch.tops())
                }
                _ => carried(mesh.face_vertices(face).map(|v| mesh.position(v).as_vec3()), &nodes),
            };
            let first = faces.positions.len() as u32;
            faces.positions.extend(outline);
            let vertices = (first..faces.positions.len() as u32).collect();
            faces.polygons.push(Polygon { vertices, color: [0.0; 3] });
        }
        faces
    }

    /// The corners of a face as it is shown.
    pub(super) fn shown_corners(&self, face: FaceId) -> Vec<Vec3> {
        let shown = self.faces.polygons.get(face.index()).is_some();
        if shown { self.faces.corners(face.index()).collect() } else { Vec::new() }
    }
}

/// Corners of a parallelogram with so many edges below and above, in the order of a face: from the left along its bottoms, up,
/// back along its tops.
fn outline(left: Vec3, across: Vec3, up: Vec3, bottoms: usize, tops: usize) -> Vec<Vec3> {
    let part = |i: usize, n: usize| if n == 0 { 0.5 } else { i as f32 / n as f32 };
    let below = (0..=bottoms).map(|i| left + across * part(i, bottoms));
    let above = (0..=tops).rev().map(|i| left + up + across * part(i, tops));
    below.chain(above).collect()
}

/// The corners of a face moved as the nodes of its yarn have moved in the mean. Each node is `[now, as laid]`.
fn carried(corners: impl Iterator<Item = Vec3>, nodes: &[[Vec3; 2]]) -> Vec<Vec3> {
    let moved = nodes.iter().map(|[now, laid]| now - laid).sum::<Vec3>() / nodes.len().max(1) as f32;
    corners.map(|p| p + moved).collect()
}

/// Unit normal of a polygon; zero if it has no area.
fn normal(corners: &[Vec3]) -> Vec3 {
    let n = corners.len();
    (0..n).map(|i| corners[i].cross(corners[(i + 1) % n])).sum::<Vec3>().normalize_or_zero()
}
