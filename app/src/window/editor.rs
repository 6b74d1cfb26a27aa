//! The editor: everything in the window, without the window. Tests drive it with simulated mouse and keys.
//!
//! Each frame it looks whether the document or the simulation has something new, shows it, and turns clicks into requests. It
//! never waits: the document lives in a [`Session`], the yarn in a [`SimThread`].

use super::panels;
use super::screen::Screen;
use super::session::{Request, Session, View};
use super::tools::Tool;
use crate::command::Command;
use crate::drawing::{Stage, drawing, solids};
use crate::project::Project;
use anyhow::Result;
use egui::{Key, KeyboardShortcut, Modifiers};
use glam::{DVec3, Vec3};
use render::{Bounds, Camera, Drawing, Faces, Lines, NamedView};
use sim_core::{Material, Pin, Scene, SimCommand, SimThread, Snapshot};
use std::path::PathBuf;
use std::sync::Arc;
use stitch_mesh::stitch::Stitch;
use stitch_mesh::yarn_net::{YarnNet, YarnState};

/// The state of the user interface.
pub struct Editor {
    pub(super) session: Session,
    pub(super) sim: SimThread,
    pub(super) screen: Option<Screen>,
    pub(super) view: Arc<View>,
    pub(super) stage: Stage,
    pub(super) tool: Tool,
    pub(super) brush: Stitch,
    pub(super) camera: Camera,
    pub(super) playing: bool,
    pub(super) panel: panels::State,
    /// What the screen shows beside yarn, for picking.
    pub(super) faces: Faces,
    pub(super) base_lines: Lines,
    /// What the pointer was over when the overlay was made.
    pub(super) hovered: Option<(usize, usize)>,
    /// Whether a brush stroke is under way, and what it has reached.
    pub(super) stroke: Option<Vec<u32>>,
    pub(super) grabbed: Option<Pin>,
    pub(super) snapshot: Option<Arc<Snapshot>>,
    shown: Option<(u64, Stage)>,
    /// The net that the simulation has, how often it had been placed, and material and scene.
    loaded: Option<Arc<YarnNet>>,
    placed: u64,
    simulated: Option<(Material, Scene)>,
    generation: u64,
    framed: bool,
    pub(super) error: Option<String>,
}

impl Editor {
    /// An editor of `project`. `wake` asks for another frame; it is called from other threads.
    ///
    /// # Errors
    /// The system has no threads to give.
    pub fn new(
        project: Project,
        path: Option<PathBuf>,
        screen: Option<Screen>,
        wake: impl Fn() + Send + Clone + 'static,
    ) -> Result<Self> {
        let stage = match (&project.fabric, project.labelled.labels().iter().any(Option::is_some)) {
            (Some(_), _) => Stage::Yarn,
            (None, _) => Stage::Labels,
        };
        let session = Session::spawn(project, path, Box::new(wake.clone()))?;
        let view = session.latest();
        Ok(Self {
            sim: SimThread::spawn(Box::new(wake))?,
            panel: panels::State::of(&view),
            session,
            screen,
            view,
            stage,
            tool: Tool::of(stage).first().map_or(Tool::Fill, |(tool, ..)| *tool),
            brush: Stitch::purl(),
            camera: Camera::default(),
            playing: false,
            faces: Faces::default(),
            base_lines: Lines::default(),
            hovered: None,
            stroke: None,
            grabbed: None,
            snapshot: None,
            shown: None,
            loaded: None,
            placed: 0,
            simulated: None,
            generation: 0,
            framed: false,
            error: None,
        })
    }

    /// One frame.
    pub fn ui(&mut self, ui: &mut egui::Ui) {
        self.take_news();
        self.shortcuts(ui.ctx());
        panels::top(self, ui);
        panels::status(self, ui);
        panels::left(self, ui);
        panels::right(self, ui);
        super::viewport::show(self, ui);
        if self.session.is_busy() {
            ui.ctx().request_repaint_after(std::time::Duration::from_millis(100));
        }
    }

    /// The project as last seen.
    pub fn project(&self) -> &Project {
        &self.view.project
    }

    /// The newest snapshot of the simulation of this project's yarn.
    pub fn yarn(&self) -> Option<&Snapshot> {
        self.snapshot.as_deref()
    }

    /// Whether nothing is under way but the simulation.
    pub fn is_idle(&self) -> bool {
        !self.session.is_busy()
            && self.shown.is_some_and(|(revision, _)| revision == self.session.latest().revision)
    }

    /// Sends a request, with the yarn as it is just now.
    pub(super) fn request(&mut self, request: Request) {
        let moved = self.snapshot.as_ref().filter(|s| s.time_s > 0.0);
        let yarn = moved.map(|s| Arc::new(s.state.clone()));
        self.session.send(request, yarn);
    }

    pub(super) fn act(&mut self, command: Command) {
        self.request(Request::Do(command));
    }

    pub(super) fn set_playing(&mut self, playing: bool) {
        self.playing = playing;
        self.sim.send(if playing { SimCommand::Play } else { SimCommand::Pause });
    }

    /// Goes to another stage; tools that make no sense there are put down.
    pub(super) fn go_to(&mut self, stage: Stage) {
        self.stage = stage;
        let tools = Tool::of(stage);
        if let (false, Some((first, ..))) = (tools.iter().any(|(t, ..)| *t == self.tool), tools.first()) {
            self.tool = *first;
        }
    }

    /// Fits the camera to what is shown.
    pub(super) fn frame(&mut self, view: Option<NamedView>) {
        let Some(bounds) = self.bounds() else { return };
        match view {
            Some(view) => self.camera = Camera::named(view, bounds, self.panel.aspect),
            None => self.camera.frame(bounds, self.panel.aspect),
        }
    }

    fn bounds(&self) -> Option<Bounds> {
        let mesh = match (self.stage, &self.view.project.fabric) {
            (Stage::Yarn, Some(fabric)) => {
                return Bounds::of(self.yarn_state(fabric).position.iter().map(|p| p.as_vec3()));
            }
            (Stage::Stitches, Some(fabric)) => fabric.stitches.mesh(),
            _ => self.view.project.labelled.mesh(),
        };
        Bounds::of(mesh.positions().iter().map(|p| p.as_vec3()))
    }

    fn yarn_state(&self, fabric: &crate::project::Fabric) -> Arc<YarnState> {
        match &self.snapshot {
            Some(s) if s.state.fits(&fabric.net) => Arc::new(s.state.clone()),
            _ => fabric.state(),
        }
    }

    /// Takes over what the document and the simulation have done since the last frame.
    fn take_news(&mut self) {
        let view = self.session.latest();
        if view.revision != self.view.revision {
            if view.path != self.view.path {
                self.panel = panels::State { aspect: self.panel.aspect, ..panels::State::of(&view) };
                self.framed = self.framed
                    && self.view.path.is_none()
                    && view.project.labelled == self.view.project.labelled;
            }
            self.error = view.message.clone().err();
            self.view = view;
            self.load_yarn();
        } else if self.shown.is_none() {
            self.load_yarn(); // the first frame
        }
        let snapshot = self.sim.latest().filter(|s| s.generation == self.generation);
        let is_new = match (&snapshot, &self.snapshot) {
            (Some(new), Some(old)) => !Arc::ptr_eq(new, old),
            (new, _) => new.is_some(),
        };
        if is_new {
            self.playing = self.playing && snapshot.as_ref().is_none_or(|s| s.error.is_none());
            self.snapshot = snapshot;
        }
        if self.shown != Some((self.view.revision, self.stage)) {
            self.shown = Some((self.view.revision, self.stage));
            self.show_stage();
        } else if is_new && self.stage == Stage::Yarn {
            self.show_yarn();
        }
        if !self.framed && self.bounds().is_some() {
            self.framed = true;
            self.frame(Some(NamedView::ThreeQuarter));
        }
    }

    /// Hands the yarn to the simulation where the net, the scene or the material is another one than before.
    fn load_yarn(&mut self) {
        let project = &self.view.project;
        let Some(fabric) = &project.fabric else {
            if self.loaded.take().is_some() {
                self.sim.send(SimCommand::Stop);
                self.snapshot = None;
            }
            return;
        };
        let wants = (project.material.clone(), project.scene.clone());
        let in_place = self.placed == self.view.placed
            && self.loaded.as_ref().is_some_and(|net| Arc::ptr_eq(net, &fabric.net));
        if !in_place {
            self.generation = self.sim.send(SimCommand::Load {
                net: fabric.net.clone(),
                material: wants.0.clone(),
                scene: wants.1.clone(),
                state: (*fabric.state()).clone(),
            });
            self.loaded = Some(fabric.net.clone());
            self.placed = self.view.placed;
            if self.playing {
                self.sim.send(SimCommand::Play);
            }
        } else if self.simulated.as_ref() != Some(&wants) {
            self.sim.send(SimCommand::SetMaterial(wants.0.clone()));
            self.sim.send(SimCommand::SetScene(wants.1.clone()));
        }
        self.simulated = Some(wants);
    }

    /// Puts the stage on the screen.
    fn show_stage(&mut self) {
        let stage =
            if self.view.project.fabric.is_none() && matches!(self.stage, Stage::Stitches | Stage::Yarn) {
                Stage::Labels
            } else {
                self.stage
            };
        let drawing = match stage {
            Stage::Yarn => {
                // Curves come with the snapshots, made in the simulation's thread.
                let yarn = self.snapshot.as_ref().map(|s| s.curves.clone()).unwrap_or_default();
                Drawing { yarn, solids: solids(&self.view.project.scene), ..Drawing::default() }
            }
            stage => drawing(&self.view.project, stage).unwrap_or_default(),
        };
        if let Some(screen) = &mut self.screen
            && let Err(error) = screen.set(&drawing)
        {
            self.error = Some(format!("{error:#}"));
        }
        self.base_lines = drawing.lines;
        self.faces = drawing.faces;
        self.hovered = None;
        if stage == Stage::Yarn {
            self.faces = self.loop_faces();
        }
    }

    fn show_yarn(&mut self) {
        let Some(snapshot) = self.snapshot.clone() else { return };
        if let Some(screen) = &mut self.screen
            && let Err(error) = screen.set_yarn(&snapshot.curves)
        {
            self.error = Some(format!("{error:#}"));
        }
        self.faces = self.loop_faces();
    }

    /// A quadrilateral over every stitch, where the yarn is now: what the brush hits in the yarn. The nodes of a stitch span its
    /// middle (see `stitch_mesh::lay`); the quadrilateral goes on to its edges, so that neighbours leave no gap.
    fn loop_faces(&self) -> Faces {
        let Some(fabric) = &self.view.project.fabric else { return Faces::default() };
        let state = self.yarn_state(fabric);
        let count = fabric.stitches.mesh().face_count();
        let mut corners: Vec<Vec<Vec3>> = vec![Vec::new(); count];
        for (node, position) in fabric.net.nodes.iter().zip(&state.position) {
            if let Some(face) = node.face {
                corners[face.index()].push(position.as_vec3());
            }
        }
        let mut faces = Faces::default();
        for corners in corners {
            // Four nodes an operation, as LL, LU, RU, RL; a gathering stitch has others and is left as small as it is.
            let outline = match corners[..] {
                [ll, lu, .., ru, rl] => {
                    let ops = (corners.len() / 4) as f32;
                    let across = (rl - ll) / (1.0 - 0.4 / ops);
                    let up = ((lu + ru) - (ll + rl)) / 2.0 / 0.4;
                    let foot = (ll + rl) / 2.0 - 0.1 * up;
                    let (left, right) = (foot - across / 2.0, foot + across / 2.0);
                    vec![left, right, right + up, left + up]
                }
                _ => corners,
            };
            let first = faces.positions.len() as u32;
            faces.positions.extend(outline);
            let vertices = (first..faces.positions.len() as u32).collect();
            faces.polygons.push(render::Polygon { vertices, color: [0.0; 3] });
        }
        faces
    }

    /// Sends the scene with the grabbed node added to its pins, or without.
    pub(super) fn pull(&mut self, pin: Option<Pin>) {
        let mut scene = self.view.project.scene.clone();
        scene.pins.extend(pin);
        self.grabbed = pin;
        self.sim.send(SimCommand::SetScene(scene));
    }

    /// The node nearest to a point of the yarn.
    pub(super) fn nearest_node(&self, point: DVec3) -> Option<(u32, DVec3)> {
        let fabric = self.view.project.fabric.as_ref()?;
        let state = self.yarn_state(fabric);
        let nodes = state.position.iter().enumerate();
        nodes.min_by(|a, b| a.1.distance(point).total_cmp(&b.1.distance(point))).map(|(i, p)| (i as u32, *p))
    }

    fn shortcuts(&mut self, ctx: &egui::Context) {
        let pressed =
            |modifiers, key| ctx.input_mut(|i| i.consume_shortcut(&KeyboardShortcut::new(modifiers, key)));
        if pressed(Modifiers::COMMAND | Modifiers::SHIFT, Key::Z) || pressed(Modifiers::COMMAND, Key::Y) {
            self.request(Request::Redo);
        }
        if pressed(Modifiers::COMMAND, Key::Z) {
            self.request(Request::Undo);
        }
        if pressed(Modifiers::COMMAND, Key::S) {
            self.save();
        }
        if ctx.egui_wants_keyboard_input() {
            return;
        }
        if pressed(Modifiers::NONE, Key::Space) {
            self.set_playing(!self.playing);
        }
        if pressed(Modifiers::NONE, Key::F) {
            self.frame(None);
        }
        for (key, stage) in [Key::Num1, Key::Num2, Key::Num3, Key::Num4].into_iter().zip(Stage::ALL) {
            if pressed(Modifiers::NONE, key) {
                self.go_to(stage);
            }
        }
    }

    /// Saves under the name in the path field.
    pub(super) fn save(&mut self) {
        let mut path = PathBuf::from(self.panel.path.trim());
        if path.as_os_str().is_empty() {
            self.error = Some("give the project a name first, in the field beside Save".into());
            return;
        }
        path.set_extension("purl");
        self.request(Request::Save(path));
    }
}
