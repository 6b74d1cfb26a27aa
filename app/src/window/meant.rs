//! What an action works on: the selection, or where nothing is selected, what is under the pointer.

use super::editor::Editor;
use super::pointer::Tool;
use super::request::Request;
use super::selection::{Change, Picked, Selection};
use super::surface::Surface;
use crate::command::Command;
use crate::drawing::Stage;
use crate::project::Project;
use glam::Vec3;
use render::Bounds;
use stitch_mesh::ids::{EdgeId, FaceId, HalfEdgeId};
use stitch_mesh::mesh::PolygonMesh;
use stitch_mesh::stitch::Stitch;

impl Editor {
    /// The mesh that the stage shows.
    pub(super) fn surface(&self) -> Surface<'_> {
        let project = &self.view.project;
        match (self.stage, &project.fabric) {
            (Stage::Stitches | Stage::Yarn, Some(fabric)) => Surface::Stitched(&fabric.stitches),
            _ => Surface::Labelled(&project.labelled),
        }
    }

    pub(super) fn surface_index(&self) -> usize {
        usize::from(matches!(self.surface(), Surface::Stitched(_)))
    }

    /// What is selected and hidden of the mesh that the stage shows.
    pub fn selection(&self) -> &Selection {
        &self.selections[self.surface_index()]
    }

    /// Selects and hides as `selection` says, and shows it.
    pub(super) fn set_selection(&mut self, selection: Selection) {
        let index = self.surface_index();
        let before = std::mem::replace(&mut self.selections[index], selection);
        if before.hidden != self.selections[index].hidden {
            self.show_stage();
        } else if before != self.selections[index] {
            self.show_colors();
        }
    }

    /// Changes the selection by what was picked.
    pub(super) fn select(&mut self, picked: Picked, change: Change) {
        let mut selection = self.selection().clone();
        selection.change(picked, change);
        self.set_selection(selection);
    }

    /// Forgets selections in meshes that `project` has others for: their numbers mean something else there.
    pub(super) fn forget_parts(&mut self, project: &Project) {
        let fabric = |p: &Project| p.fabric.as_ref().map(|f| f.stitches.clone());
        let (old, new) = (&self.view.project, project);
        let same = [
            same_parts(Some(old.labelled.mesh()), Some(new.labelled.mesh())),
            same_parts(fabric(old).as_ref().map(|s| s.mesh()), fabric(new).as_ref().map(|s| s.mesh())),
        ];
        for (selection, _) in self.selections.iter_mut().zip(same).filter(|(_, same)| !same) {
            *selection = Selection::new(selection.mode);
            self.under = None;
        }
        if let Some(chart) = self.chart.as_mut().filter(|_| !same[1]) {
            chart.part.clear();
        }
    }

    /// Notes what the pointer is over.
    pub(super) fn point_at(&mut self, under: Option<(HalfEdgeId, Vec3)>) {
        self.under = under;
    }

    /// The face under the pointer.
    pub(super) fn face_under(&self) -> Option<FaceId> {
        self.under.map(|(half, _)| self.surface().mesh().face(half))
    }

    /// The selected faces, or the one under the pointer.
    pub(super) fn faces_meant(&self) -> Vec<FaceId> {
        let selection = self.selection();
        if selection.is_empty() {
            self.face_under().into_iter().collect()
        } else {
            selection.faces.iter().copied().collect()
        }
    }

    /// The selected edges, or the one under the pointer.
    pub(super) fn edges_meant(&self) -> Vec<EdgeId> {
        let selection = self.selection();
        if selection.is_empty() {
            self.under.map(|(half, _)| self.surface().mesh().edge(half)).into_iter().collect()
        } else {
            selection.edges.iter().copied().collect()
        }
    }

    /// Why an action on faces cannot be done.
    pub(super) fn no_faces(&self) -> Option<&'static str> {
        self.faces_meant().is_empty().then_some("select faces first, or point at one")
    }

    /// Why an action on edges cannot be done.
    pub(super) fn no_edges(&self) -> Option<&'static str> {
        self.edges_meant().is_empty().then_some("select edges first (key 1), or point at one")
    }

    /// Does commands that are one step of the history.
    pub(super) fn act_all(&mut self, commands: impl IntoIterator<Item = Command>) {
        for (i, command) in commands.into_iter().enumerate() {
            self.request(if i == 0 { Request::Do(command) } else { Request::Amend(command) });
        }
    }

    /// Those of some faces that have as many edges below and above as a stitch needs.
    pub(super) fn that_take(&self, stitch: &Stitch, faces: &[FaceId]) -> Vec<u32> {
        let Some(fabric) = &self.view.project.fabric else { return Vec::new() };
        let shape = |s: &Stitch| (s.bottoms(), s.tops());
        let fits = |f: &&FaceId| shape(fabric.stitches.stitch(**f)) == shape(stitch);
        faces.iter().filter(fits).map(|f| f.0).collect()
    }

    /// Sets the stitches that are meant; where none are, it becomes the one to paint with.
    pub(super) fn use_stitch(&mut self, stitch: Stitch) {
        let meant = self.faces_meant();
        if meant.is_empty() {
            self.brush = stitch;
            self.take(Tool::Paint);
            return;
        }
        let faces = self.that_take(&stitch, &meant);
        if faces.is_empty() {
            let loops = |n: usize| if n == 1 { "1 loop".to_owned() } else { format!("{n} loops") };
            let (below, above) = (loops(stitch.bottoms()), loops(stitch.tops()));
            self.error = Some(format!("{stitch} joins {below} below to {above} above: no stitch here does"));
        } else {
            self.act(Command::SetStitch { faces, stitch });
        }
    }

    /// Takes a tool in the hand.
    pub(super) fn take(&mut self, tool: Tool) {
        self.tool = tool;
        self.gesture = None;
    }

    /// Puts the tool down; with nothing in the hand, selects nothing.
    pub(super) fn put_down(&mut self) {
        if self.tool == Tool::Select && self.gesture.is_none() {
            self.select(Picked::Faces(Vec::new()), Change::Replace);
        }
        self.take(Tool::Select);
    }

    /// Fits the camera to what is selected.
    pub(super) fn frame_selected(&mut self) {
        let mesh = self.surface().mesh();
        let selection = self.selection();
        let at_edges = selection.edges.iter().map(|e| mesh.face(mesh.edge_sides(*e).0));
        let faces = selection.faces.iter().copied().chain(at_edges);
        let Some(bounds) = Bounds::of(faces.flat_map(|f| self.shown_corners(f))) else { return };
        // A single stitch fills the picture and nobody sees where it is: some of what is around it shows too.
        let margin = Vec3::splat(bounds.radius());
        let bounds = Bounds { min: bounds.min - margin, max: bounds.max + margin };
        self.camera.frame(bounds, self.panel.aspect);
    }
}

/// Whether faces and edges of two meshes have the same numbers.
fn same_parts(a: Option<&PolygonMesh>, b: Option<&PolygonMesh>) -> bool {
    match (a, b) {
        (Some(a), Some(b)) => {
            std::ptr::eq(a, b)
                || (a.vertex_count() == b.vertex_count()
                    && a.half_edge_count() == b.half_edge_count()
                    && a.face_lists() == b.face_lists())
        }
        (a, b) => a.is_none() && b.is_none(),
    }
}
