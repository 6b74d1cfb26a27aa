//! The document in a thread of its own, so that the window never waits for an edit, a file or a large mesh.
//!
//! Requests go in, in order; the newest [`View`] comes out. Its yarn and a [`Survey`] of it follow when nothing else waits. The
//! window draws what it last saw.
//!
//! Long work can be cancelled. A command makes a new project and leaves the old one alone, so whatever it is, it runs in yet
//! another thread and its result is simply not taken over: the document is as it was, at once. Work that can be watched, a
//! relaxation, ends with its next step; other work runs out with nobody waiting for it.

use super::request::Request;
use super::view::{Standing, Survey, View};
use crate::charts;
use crate::command::{Command, write_script};
use crate::document::Document;
use crate::fabric::Moved;
use crate::files;
use crate::open::open_any;
use crate::project::Project;
use crate::scenes;
use crate::written::{tiled, told};
use anyhow::{Context, Result, anyhow, bail};
use glam::Vec3;
use sim_core::mesh_relax::{MeshRelaxation, StepFacts};
use std::ops::ControlFlow;
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, AtomicU64, AtomicUsize, Ordering};
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread::Thread;
use std::time::{Duration, Instant};

/// How long yarn waits for the stitches to be shown, should the window not be drawn just now.
const PATIENCE: Duration = Duration::from_millis(50);
/// How often work that goes on is looked at, for whether somebody has cancelled it.
const LOOK: Duration = Duration::from_millis(10);

/// Said where no file was chosen, perhaps as the system has no dialog.
const NOTHING_CHOSEN: &str = "No file was chosen. A path in the field beside Open… and Enter open one, too";

/// Work that is going on.
#[derive(Clone, Debug)]
pub struct Work {
    /// What it is.
    pub name: String,
    /// Since when.
    pub since: Instant,
    /// What it has come to so far, if it can be watched.
    pub preview: Option<Arc<Preview>>,
    cancelled: Arc<AtomicBool>,
}

/// Stitches on their way while they are relaxed.
#[derive(Clone, Debug)]
pub struct Preview {
    /// The revision that they were in before.
    pub revision: u64,
    /// Steps so far.
    pub steps: usize,
    /// Vertices of the stitch mesh [m].
    pub positions: Vec<Vec3>,
    /// Strain of its faces.
    pub strain: Vec<f32>,
}

/// A running session. Dropping it lets the thread finish what it was asked and end.
pub struct Session {
    requests: Sender<Asked>,
    latest: Arc<Mutex<(Arc<View>, Arc<Survey>)>>,
    waiting: Arc<AtomicUsize>,
    work: Arc<Mutex<Option<Work>>>,
    /// The revision that the window has shown.
    shown: Arc<AtomicU64>,
    thread: Thread,
}

/// What the window has asked for.
struct Asked {
    request: Request,
    yarn: Option<Moved>,
    /// The document that it was looking at.
    opened: u64,
}

/// Asks for another frame.
type Wake = Arc<dyn Fn() + Send + Sync>;

/// The value behind a lock; what a thread that panicked has left there is as good as any.
fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Session {
    /// Starts a session. `wake` is called whenever there is a new view.
    ///
    /// # Errors
    /// The system has no thread to give.
    pub fn spawn(project: Project, path: Option<PathBuf>, wake: Wake) -> std::io::Result<Self> {
        let (requests, received) = channel::<Asked>();
        let work = Arc::new(Mutex::new(None));
        let mut worker = Worker {
            document: Document::new(project),
            standing: Standing {
                home: path.clone().filter(|p| p.extension().is_some_and(|e| e == "purl")),
                path,
                ..Standing::default()
            },
            work: Arc::clone(&work),
            latest: None,
            wake: Arc::clone(&wake),
            is_as_before: false,
        };
        let view = worker.view(Ok(String::new()));
        let survey = Arc::new(Survey::of(&view));
        let latest = Arc::new(Mutex::new((view, survey)));
        let waiting = Arc::new(AtomicUsize::new(0));
        let (slot, count, work_slot) = (Arc::clone(&latest), Arc::clone(&waiting), Arc::clone(&work));
        let shown = Arc::new(AtomicU64::new(0));
        let seen = Arc::clone(&shown);
        let document = std::thread::Builder::new().name("document".to_owned()).spawn(move || {
            for asked in received {
                let view = worker.carry_out(asked);
                lock(&slot).0 = Arc::clone(&view);
                *lock(&work_slot) = None;
                wake();
                // Drawing the stitches and laying their yarn both take all processors: what is waited for goes first.
                let until = Instant::now() + PATIENCE;
                let is_last = || count.load(Ordering::Acquire) == 1;
                while is_last() && seen.load(Ordering::Acquire) < view.revision && Instant::now() < until {
                    std::thread::park_timeout(until.saturating_duration_since(Instant::now()));
                }
                // Of a state that is about to change nobody needs to know more.
                if is_last() {
                    if let Some(fabric) = &view.project.fabric {
                        fabric.state();
                        wake();
                    }
                    lock(&slot).1 = Arc::new(Survey::of(&view));
                }
                count.fetch_sub(1, Ordering::Release);
                wake();
            }
        })?;
        let thread = document.thread().clone();
        Ok(Self { requests, latest, waiting, work, shown, thread })
    }

    /// Says which revision the window has given to the graphics adapter to draw.
    pub fn has_shown(&self, revision: u64) {
        if self.shown.swap(revision, Ordering::Release) != revision {
            self.thread.unpark();
        }
    }

    /// Asks for something. `yarn` is where the simulation has brought the yarn, if it is running, and `opened` says which document is
    /// meant, as in [`View`].
    pub fn send(&self, request: Request, yarn: Option<Moved>, opened: u64) {
        self.waiting.fetch_add(1, Ordering::Release);
        // The thread ends only when this sender is dropped.
        let _ = self.requests.send(Asked { request, yarn, opened });
        self.thread.unpark();
    }

    /// Shows the system's file dialog, beside the window, and opens what is chosen. Where there is no dialog it is as if nothing were.
    pub fn ask_for_file(&self) {
        let (requests, waiting) = (self.requests.clone(), Arc::clone(&self.waiting));
        let thread = self.thread.clone();
        let ask = move || {
            let dialog = rfd::FileDialog::new().add_filter("Projects and meshes", &["purl", "obj"]);
            let chosen = dialog.pick_file().map_or(Request::Say(NOTHING_CHOSEN), Request::Open);
            waiting.fetch_add(1, Ordering::Release);
            // Neither of them is about a certain document.
            let _ = requests.send(Asked { request: chosen, yarn: None, opened: 0 });
            thread.unpark();
        };
        if let Err(error) = std::thread::Builder::new().name("file dialog".to_owned()).spawn(ask) {
            tracing::warn!("no file dialog: {error}");
        }
    }

    /// The newest view.
    pub fn latest(&self) -> Arc<View> {
        lock(&self.latest).0.clone()
    }

    /// The newest survey; it may be of an earlier view.
    pub fn survey(&self) -> Arc<Survey> {
        lock(&self.latest).1.clone()
    }

    /// Whether requests are still being worked on.
    pub fn is_busy(&self) -> bool {
        self.waiting.load(Ordering::Acquire) > 0
    }

    /// What is going on just now.
    pub fn work(&self) -> Option<Work> {
        lock(&self.work).clone()
    }

    /// Gives up what is going on; the document stays as it was before.
    pub fn cancel(&self) {
        if let Some(work) = &mut *lock(&self.work) {
            work.cancelled.store(true, Ordering::Release);
        }
    }
}

struct Worker {
    document: Document,
    standing: Standing,
    work: Arc<Mutex<Option<Work>>>,
    latest: Option<Arc<View>>,
    wake: Wake,
    /// Whether the last command has left everything as it was.
    is_as_before: bool,
}

impl Worker {
    fn carry_out(&mut self, Asked { request, yarn, opened }: Asked) -> Arc<View> {
        let (name, since) = (request.doing(), Instant::now());
        *lock(&self.work) = Some(Work { name, since, preview: None, cancelled: Arc::default() });
        if let Some(yarn) = yarn {
            self.document.take_over(yarn);
        }
        let resets = |document: &Document| document.done().filter(|c| **c == Command::ResetYarn).count();
        let before = resets(&self.document);
        let changes = request.changes();
        let is_of_another = request.writes().is_some() && opened != self.standing.opened;
        let done = match is_of_another {
            true => Err(anyhow!("another document was opened meanwhile, so nothing was written")),
            false => self.try_to(request),
        };
        let message = done.map_err(|e| format!("{e:#}"));
        // Laid anew, or that taken back: the document has put the yarn somewhere itself.
        self.standing.placed += u64::from(resets(&self.document) != before);
        let is_another = !std::mem::take(&mut self.is_as_before);
        self.standing.is_changed |= changes && message.is_ok() && is_another;
        self.standing.revision += 1;
        self.view(message)
    }

    fn try_to(&mut self, request: Request) -> Result<String> {
        match request {
            Request::Do(command) => self.apply(command, false),
            Request::Amend(command) => self.apply(command, true),
            Request::Undo => {
                let name = self.document.steps().last().context("there is nothing to undo")?;
                self.document.undo();
                Ok(format!("Undone: {name}"))
            }
            Request::Redo => {
                let name = self.document.undone().next().context("there is nothing to redo")?;
                self.document.redo();
                Ok(format!("Redone: {name}"))
            }
            Request::GoTo(steps) => {
                while self.document.steps().len() > steps && self.document.undo() {}
                while self.document.steps().len() < steps && self.document.redo() {}
                let at = self.document.steps().last();
                Ok(at.map_or_else(|| "Back at the beginning".into(), |name| format!("At: {name}")))
            }
            Request::Open(path) => {
                let file = path.clone();
                let project = self.unless_cancelled(move || open_any(&file))?;
                let message = format!("Opened {}", path.display());
                let home = path.extension().is_some_and(|e| e == "purl").then(|| path.clone());
                self.take_up(project, path, home);
                Ok(message)
            }
            Request::Begin(bundled) => {
                let project = self.unless_cancelled(|| bundled.knitted(bundled.width))?;
                self.take_up(project, PathBuf::from(bundled.name).with_extension("purl"), None);
                Ok(format!("Begun: {}", bundled.name))
            }
            Request::Say(message) => Ok(message.into()),
            Request::Scene(name) => {
                let project = self.document.project().clone();
                // A mesh in it takes its time.
                let made = move || scenes::scene(&name, project.fabric()?, &project.materials.base);
                let scene = self.unless_cancelled(made)?;
                self.apply(Command::SetScene { scene }, false)
            }
            Request::Save(path) => {
                self.document.project().save(&path)?;
                let message = format!("Saved {}", path.display());
                (self.standing.path, self.standing.home) = (Some(path.clone()), Some(path));
                self.standing.is_changed = false;
                Ok(message)
            }
            Request::SaveInstructions(path, faces) => {
                let text = told(self.document.project(), None, faces.as_deref())?;
                files::write(&path, text.as_bytes())?;
                let of = faces.map_or(String::new(), |f| format!(" for the {} selected stitches", f.len()));
                Ok(format!("Saved the instructions{of} as {}", path.display()))
            }
            Request::SaveScript(path) => {
                files::write(&path, write_script(self.document.done())?.as_bytes())?;
                Ok(format!("Saved the history as {}", path.display()))
            }
            Request::SaveChart(path, courses) => {
                charts::write(&self.document.project().knitted()?.stitches, &courses, &path)?;
                Ok(format!("Saved the chart as {}", path.display()))
            }
        }
    }

    /// Goes on with another project.
    fn take_up(&mut self, project: Project, path: PathBuf, home: Option<PathBuf>) {
        self.document = Document::new(project);
        let Standing { revision, placed, opened, .. } = self.standing;
        let (opened, path) = (opened + 1, Some(path));
        self.standing = Standing { revision, placed, opened, is_changed: false, path, home };
    }

    fn apply(&mut self, command: Command, amends: bool) -> Result<String> {
        let (doing, before) = (command.clone(), self.document.project().clone());
        let (work, wake) = (Arc::clone(&self.work), Arc::clone(&self.wake));
        let cancelled = lock(&self.work).as_ref().map(|w| Arc::clone(&w.cancelled)).unwrap_or_default();
        let (revision, mut steps) = (self.standing.revision, 0);
        let mut watch = move |relaxation: &MeshRelaxation, _: &StepFacts| {
            steps += 1;
            let positions = relaxation.positions().iter().map(|p| p.as_vec3()).collect();
            let strain = relaxation.strain().iter().map(|s| *s as f32).collect();
            if cancelled.load(Ordering::Acquire) {
                return ControlFlow::Break(()); // other work may be going on by now
            }
            if let Some(work) = &mut *lock(&work) {
                work.preview = Some(Arc::new(Preview { revision, steps, positions, strain }));
            }
            wake();
            ControlFlow::Continue(())
        };
        let after = self.unless_cancelled(move || doing.perform(&before, &mut watch)).inspect_err(|_| {
            // What was to go on with it begins a step of its own.
            self.document.close_step();
        })?;
        let mut name = command.name();
        if let Command::Tile { text, rows, faces, layout } = &command {
            // What did not fit is not an error, but nobody would guess it.
            let tiled = tiled(self.document.project(), text, *rows, faces.as_deref(), *layout)?;
            name = std::iter::once(name).chain(tiled.left_out).collect::<Vec<_>>().join(" · ");
        }
        self.is_as_before = !self.document.keep(command, after, amends);
        Ok(if self.is_as_before { format!("{name}: it is so already") } else { name })
    }

    /// What `work` comes to, unless somebody cancels it first.
    fn unless_cancelled<T: Send + 'static>(
        &self,
        work: impl FnOnce() -> Result<T> + Send + 'static,
    ) -> Result<T> {
        let (done, result) = channel();
        std::thread::Builder::new().name("command".to_owned()).spawn(move || {
            // Nobody waits any more where the work has been cancelled.
            let _ = done.send(work());
        })?;
        loop {
            match result.recv_timeout(LOOK) {
                Ok(result) => return result,
                Err(RecvTimeoutError::Disconnected) => bail!("the work ended without a result"),
                Err(RecvTimeoutError::Timeout) => {
                    if lock(&self.work).as_ref().is_some_and(|w| w.cancelled.load(Ordering::Acquire)) {
                        bail!("cancelled");
                    }
                }
            }
        }
    }

    fn view(&mut self, message: Result<String, String>) -> Arc<View> {
        let view = Arc::new(View::of(&self.document, self.standing.clone(), message, self.latest.as_deref()));
        self.latest = Some(Arc::clone(&view));
        view
    }
}
