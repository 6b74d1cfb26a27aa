//! The editor: everything in the window, without the window. Tests drive it with simulated mouse and keys.
//!
//! Each frame it looks whether the document or the simulation has something new, shows it, and turns clicks into requests. It
//! never waits: the document lives in a [`Session`], the yarn in a [`SimThread`].

use super::chart::ChartView;
use super::navigation::Navigation;
use super::panels::leaving::Leaving;
use super::pointer::{Gesture, Tool};
use super::request::Request;
use super::screen::Screen;
use super::search::Search;
use super::selection::{Mode, Selection};
use super::session::{Preview, Session};
use super::strung::{Newest, Strung};
use super::view::{Survey, View};
use super::{actions, panels};
use crate::command::Command;
use crate::drawing::Stage;
use crate::fabric::{Fabric, Moved};
use crate::project::Project;
use anyhow::Result;
use glam::{DVec3, Vec3};
use render::palette::StitchColors;
use render::{Bounds, Camera, Faces, Lines, NamedView};
use sim_core::{Materials, Pin, Scene, See, SharedGpu, SimCommand, SimThread, Snapshot, SolverChoice};
use std::collections::{BTreeSet, HashSet};
use std::path::PathBuf;
use std::sync::Arc;
use stitch_mesh::ids::{FaceId, HalfEdgeId};
use stitch_mesh::patch::Patch;
use stitch_mesh::stitch::Stitch;
use stitch_mesh::stitch_mesh::StitchMesh;
use stitch_mesh::yarn_net::{YarnNet, YarnState};

/// The state of the user interface.
pub struct Editor {
    pub(super) session: Session,
    pub(super) sim: SimThread,
    /// What the simulation is to be solved with.
    pub(super) solver: SolverChoice,
    pub(super) screen: Option<Screen>,
    pub(super) view: Arc<View>,
    /// Facts about the view, or about the one before while those are found.
    pub(super) survey: Arc<Survey>,
    pub(super) stage: Stage,
    pub(super) tool: Tool,
    pub(super) gesture: Option<Gesture>,
    pub(super) brush: Stitch,
    pub(super) camera: Camera,
    pub(super) navigation: Navigation,
    pub(super) stitch_colors: StitchColors,
    pub(super) playing: bool,
    pub(super) panel: panels::State,
    pub(super) search: Option<Search>,
    /// The chart, while it is open.
    pub(super) chart: Option<ChartView>,
    /// The patch that was copied.
    pub(super) patch: Option<Patch>,
    /// Whether a text field had the keys in the last frame.
    pub(super) typing: bool,
    /// Selected and hidden parts of the labelled mesh and of the fabric.
    pub(super) selections: [Selection; 2],
    /// What the screen shows beside yarn, for picking; polygons and their sides are those of the mesh.
    pub(super) faces: Faces,
    /// The lines on the screen, kept for their memory: the next ones take it.
    pub(super) lines: Lines,
    /// Whether stitches have the colours of their strain.
    pub(super) strained: bool,
    /// Stitches on their way, as they were shown last.
    pub(super) preview: Option<Arc<Preview>>,
    /// The stitch mesh whose faces are on the screen, and those that are hidden.
    pub(super) drawn: Option<(Arc<StitchMesh>, BTreeSet<FaceId>)>,
    /// The side of a face that the pointer is nearest to, and where it points.
    pub(super) under: Option<(HalfEdgeId, Vec3)>,
    /// What the marks on the screen were made for; none where they are out of date.
    pub(super) marked: Option<Option<HalfEdgeId>>,
    /// The marks on the screen.
    pub(super) marks: Lines,
    pub(super) newest: Newest,
    /// The snapshot that is shown, or is about to be.
    pub(super) strung: Option<Arc<Strung>>,
    /// Whether it is not on the screen yet.
    pub(super) is_new: bool,
    pub(super) shown: Option<(u64, Stage)>,
    /// Whether the faces on the screen have other colours now.
    pub(super) recolour: bool,
    /// The net that the simulation has, how often it had been placed, and materials and scene.
    pub(super) loaded: Option<Arc<YarnNet>>,
    pub(super) placed: u64,
    pub(super) simulated: Option<(Materials, Scene)>,
    pub(super) generation: u64,
    pub(super) framed: bool,
    pub(super) error: Option<String>,
    /// What is to be done once it is clear what happens to work that has not been saved.
    pub(super) leaving: Option<Leaving>,
    pub(super) is_closed: bool,
    /// What would write over a file, once it is clear that it may.
    pub(super) replacing: Option<Request>,
    /// Files that were written from here.
    pub(super) written: HashSet<PathBuf>,
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
        wake: impl Fn() + Send + Sync + Clone + 'static,
    ) -> Result<Self> {
        let stage = first_stage(&project);
        let session = Session::spawn(project, path, Arc::new(wake.clone()))?;
        let (view, survey) = (session.latest(), session.survey());
        let newest = Newest::default();
        let slot = newest.clone();
        let see: See = Box::new({
            let wake = wake.clone();
            move |snapshot| {
                slot.put(snapshot);
                wake();
            }
        });
        let gpu = screen.as_ref().map_or_else(SharedGpu::default, Screen::shared_gpu);
        Ok(Self {
            sim: SimThread::spawn(gpu, see)?,
            solver: SolverChoice::default(),
            panel: panels::State::of(&view),
            session,
            screen,
            view,
            survey,
            stage,
            tool: Tool::Select,
            gesture: None,
            brush: Stitch::purl(),
            camera: Camera::default(),
            navigation: Navigation::default(),
            stitch_colors: StitchColors::default(),
            playing: false,
            search: None,
            chart: None,
            patch: None,
            typing: false,
            selections: [Selection::new(Mode::Edge), Selection::new(Mode::Face)],
            faces: Faces::default(),
            lines: Lines::default(),
            strained: false,
            preview: None,
            drawn: None,
            under: None,
            marked: None,
            marks: Lines::default(),
            newest,
            strung: None,
            is_new: false,
            shown: None,
            recolour: false,
            loaded: None,
            placed: 0,
            simulated: None,
            generation: 0,
            framed: false,
            error: None,
            leaving: None,
            is_closed: false,
            replacing: None,
            written: HashSet::new(),
        })
    }

    /// One frame.
    pub fn ui(&mut self, ui: &mut egui::Ui) {
        self.take_news();
        actions::shortcuts(self, ui.ctx());
        panels::top::show(self, ui);
        panels::status::show(self, ui);
        panels::left::show(self, ui);
        panels::right::show(self, ui);
        panels::lab::show(self, ui.ctx());
        super::chart::show(self, ui);
        self.load_yarn();
        // Keys and buttons may have gone to another stage: the pointer has to find the faces of that one.
        self.show_news();
        super::viewport::show(self, ui);
        self.session.has_shown(self.view.revision);
        super::search::show(self, ui.ctx());
        panels::leaving::show(self, ui.ctx());
        panels::replacing::show(self, ui.ctx());
        if self.session.is_busy() {
            ui.ctx().request_repaint_after(std::time::Duration::from_millis(100));
        }
    }

    /// The stage that is shown.
    pub fn stage(&self) -> Stage {
        self.stage
    }

    /// The project as last seen.
    pub fn project(&self) -> &Project {
        &self.view.project
    }

    /// The newest snapshot of the simulation of this project's yarn.
    pub fn yarn(&self) -> Option<&Snapshot> {
        let snapshot = self.strung.as_ref().map(|s| &*s.snapshot);
        // What is still on the screen may be yarn of a net that has been replaced since.
        snapshot.filter(|s| s.generation == self.generation)
    }

    /// Steps of the relaxation that is on the screen just now.
    pub fn watched(&self) -> Option<usize> {
        self.preview.as_ref().map(|p| p.steps)
    }

    /// Whether nothing is under way but the simulation.
    pub fn is_idle(&self) -> bool {
        !self.session.is_busy()
            && self.shown.is_some_and(|(revision, _)| revision == self.session.latest().revision)
            && self.survey.revision == self.view.revision
    }

    /// Sends a request, with the yarn as it is just now.
    pub(super) fn request(&mut self, request: Request) {
        if let Request::Do(command) | Request::Amend(command) = &request
            && !matches!(command, Command::RelaxMesh { .. })
        {
            // Whoever edits stitches wants to see them.
            self.set_strained(false);
        }
        let moved = self.yarn().filter(|s| s.moved);
        let yarn = moved.zip(self.loaded.as_ref()).map(|(s, from)| Moved {
            from: Arc::clone(from),
            net: Arc::clone(&s.net),
            surgery: s.surgery.clone(),
            state: Arc::new(s.state.clone()),
        });
        self.session.send(request, yarn, self.view.opened);
    }

    pub(super) fn act(&mut self, command: Command) {
        self.request(Request::Do(command));
    }

    pub(super) fn set_playing(&mut self, playing: bool) {
        self.playing = playing;
        self.sim.send(if playing { SimCommand::Play } else { SimCommand::Pause });
    }

    pub(super) fn solve_with(&mut self, solver: SolverChoice) {
        self.solver = solver;
        self.sim.send(SimCommand::SetSolver(solver));
    }

    /// Goes to another stage; what is in the hand is put down.
    pub(super) fn go_to(&mut self, stage: Stage) {
        if std::mem::replace(&mut self.stage, stage) != stage {
            self.take(Tool::Select);
            self.under = None;
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

    pub(super) fn bounds(&self) -> Option<Bounds> {
        let mesh = match (self.stage, &self.view.project.fabric) {
            (Stage::Yarn, Some(fabric)) => {
                return Bounds::of(self.yarn_now(fabric)?.1.position.iter().map(|p| p.as_vec3()));
            }
            (Stage::Stitches, Some(fabric)) => fabric.stitches.mesh(),
            _ => self.view.project.labelled.mesh(),
        };
        Bounds::of(mesh.positions().iter().map(|p| p.as_vec3()))
    }

    /// The yarn where it is now, in the simulation or in the document.
    /// Nothing where it has not been laid yet after an edit.
    pub(super) fn yarn_now(&self, fabric: &Fabric) -> Option<(Arc<YarnNet>, Arc<YarnState>)> {
        let laid = fabric.net_if_laid()?;
        let is_of = |net: &Arc<YarnNet>| Arc::ptr_eq(net, laid);
        match self.yarn() {
            Some(s) if self.loaded.as_ref().is_some_and(is_of) && s.state.fits(&s.net) => {
                Some((Arc::clone(&s.net), Arc::new(s.state.clone())))
            }
            _ => Some((Arc::clone(laid), fabric.state())),
        }
    }

    /// Sends the scene with the grabbed node added to its pins, or without.
    pub(super) fn pull(&mut self, pin: Option<Pin>) {
        let mut scene = self.view.project.scene.clone();
        scene.pins.extend(pin);
        self.gesture = pin.map(Gesture::Grab);
        self.sim.send(SimCommand::SetScene(scene));
    }

    /// The node nearest to a point of the yarn.
    pub(super) fn nearest_node(&self, point: DVec3) -> Option<(u32, DVec3)> {
        let fabric = self.view.project.fabric.as_ref()?;
        let (_, state) = self.yarn_now(fabric)?;
        let nodes = state.position.iter().enumerate();
        nodes.min_by(|a, b| a.1.distance(point).total_cmp(&b.1.distance(point))).map(|(i, p)| (i as u32, *p))
    }

    /// Saves under the name in the path field.
    pub(super) fn save(&mut self) {
        if let Some(path) = self.named("purl") {
            self.write(Request::Save(path));
        }
    }

    /// Saves the history beside the project.
    pub(super) fn save_script(&mut self) {
        if let Some(path) = self.named("jsonl") {
            self.write(Request::SaveScript(path));
        }
    }

    /// Saves knitting instructions beside the project: for what is selected, or for everything.
    pub(super) fn save_instructions(&mut self) {
        let selected = &self.selection().faces;
        let faces = (!selected.is_empty()).then(|| selected.iter().map(|f| f.0).collect());
        if let Some(path) = self.named("ks") {
            self.write(Request::SaveInstructions(path, faces));
        }
    }

    /// Cuts the mesh into stitches: of the width in the panel where it was changed, or as edges are counted now.
    pub(super) fn tessellate(&mut self) {
        let changed = std::mem::take(&mut self.panel.width_changed);
        self.act(Command::Tessellate { width_mm: changed.then_some(self.panel.width_mm) });
        self.go_to(Stage::Stitches);
    }
}

/// The stage that one begins with.
pub(super) fn first_stage(project: &Project) -> Stage {
    if project.fabric.is_some() { Stage::Yarn } else { Stage::Labels }
}
