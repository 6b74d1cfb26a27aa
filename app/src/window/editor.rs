//! The editor: everything in the window, without the window. Tests drive it with simulated mouse and keys.
//!
//! Each frame it looks whether the document or the simulation has something new, shows it, and turns clicks into requests. It
//! never waits: the document lives in a [`Session`], the yarn in a [`SimThread`].

use super::chart::ChartView;
use super::navigation::Navigation;
use super::panels::leaving::Leaving;
use super::pointer::{Gesture, Tool};
use super::screen::Screen;
use super::search::Search;
use super::selection::{Mode, Selection};
use super::session::{Preview, Request, Session};
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
    newest: Newest,
    /// The snapshot that is shown, or is about to be.
    pub(super) strung: Option<Arc<Strung>>,
    /// Whether it is not on the screen yet.
    is_new: bool,
    shown: Option<(u64, Stage)>,
    /// Whether the faces on the screen have other colours now.
    pub(super) recolour: bool,
    /// The net that the simulation has, how often it had been placed, and materials and scene.
    loaded: Option<Arc<YarnNet>>,
    placed: u64,
    simulated: Option<(Materials, Scene)>,
    generation: u64,
    framed: bool,
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
        self.session.send(request, yarn);
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

    fn bounds(&self) -> Option<Bounds> {
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

    /// Takes over what the document and the simulation have done since the last frame.
    fn take_news(&mut self) {
        let view = self.session.latest();
        if view.revision != self.view.revision {
            if view.opened != self.view.opened {
                let kept = std::mem::replace(&mut self.panel, panels::State::of(&view));
                (self.panel.aspect, self.panel.lab) = (kept.aspect, kept.lab);
            } else if view.path != self.view.path {
                self.panel.path = panels::path_text(&view);
            }
            self.error = view.message.clone().err();
            self.forget_parts(&view.project);
            if view.opened != self.view.opened {
                self.go_to(first_stage(&view.project));
                self.set_strained(false);
                self.framed = false;
            } else if view.project.fabric.is_none() {
                // Stitches that were taken back leave the labels they were made from.
                self.go_to(self.stage.min(Stage::Labels));
            }
            self.view = view;
        }
        let survey = self.session.survey();
        if !Arc::ptr_eq(&survey, &self.survey) {
            self.survey = survey;
            self.recolour |= self.strained;
        }
        let strung = self.newest.get().filter(|s| s.snapshot.generation == self.generation);
        let is_new = match (&strung, &self.strung) {
            (Some(new), Some(old)) => !Arc::ptr_eq(new, old),
            (new, _) => new.is_some(),
        };
        if is_new {
            self.playing = self.playing && strung.as_ref().is_none_or(|s| s.snapshot.error.is_none());
            self.strung = strung;
            self.is_new = true;
        }
    }

    /// Puts on the screen what is not there yet.
    fn show_news(&mut self) {
        let is_new = std::mem::take(&mut self.is_new);
        if self.shown != Some((self.view.revision, self.stage)) {
            self.shown = Some((self.view.revision, self.stage));
            self.show_stage();
        } else if is_new && self.stage == Stage::Yarn {
            self.show_yarn();
        } else if std::mem::take(&mut self.recolour) {
            self.show_colors();
        }
        self.show_preview();
        if !self.framed && self.bounds().is_some() {
            self.framed = true;
            self.frame(Some(NamedView::ThreeQuarter));
        }
    }

    /// Hands the yarn to the simulation where the net, the scene or the materials are others than before. As long as
    /// nobody looks at it or lets it move, it need not be ready.
    fn load_yarn(&mut self) {
        if self.stage != Stage::Yarn && !self.playing {
            return;
        }
        let project = &self.view.project;
        let Some(fabric) = &project.fabric else {
            if self.loaded.take().is_some() {
                self.sim.send(SimCommand::Stop);
                self.strung = None;
            }
            return;
        };
        // After an edit the yarn follows a little later.
        let Some(net) = fabric.net_if_laid() else { return };
        let wants = (project.materials.clone(), project.scene.clone());
        let in_place = self.placed == self.view.placed
            && self.loaded.as_ref().is_some_and(|loaded| Arc::ptr_eq(loaded, net));
        if !in_place {
            self.generation = self.sim.send(SimCommand::Load {
                net: net.clone(),
                materials: wants.0.clone(),
                scene: wants.1.clone(),
                state: Some(fabric.state()),
            });
            self.loaded = Some(net.clone());
            self.placed = self.view.placed;
            if self.playing {
                self.sim.send(SimCommand::Play);
            }
        } else if self.simulated.as_ref() != Some(&wants) {
            self.sim.send(SimCommand::SetMaterials(wants.0.clone()));
            self.sim.send(SimCommand::SetScene(wants.1.clone()));
        }
        self.simulated = Some(wants);
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
fn first_stage(project: &Project) -> Stage {
    if project.fabric.is_some() { Stage::Yarn } else { Stage::Labels }
}
