//! The document in a thread of its own, so that the window never waits for an edit, a file or a large mesh.
//!
//! Requests go in, in order; the newest [`View`] comes out. The window draws what it last saw.

use crate::command::{Command, write_script};
use crate::document::Document;
use crate::files;
use crate::inspect::{Inspection, inspect};
use crate::project::Project;
use anyhow::{Context, Result};
use std::path::PathBuf;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc::{Sender, channel};
use std::sync::{Arc, Mutex, PoisonError};
use stitch_mesh::yarn_net::YarnState;

/// What a session can be asked to do.
#[derive(Debug)]
pub enum Request {
    /// Do a command.
    Do(Command),
    /// Do a command as part of the last one (a brush stroke).
    Amend(Command),
    /// Take back the last command.
    Undo,
    /// Do again what was taken back.
    Redo,
    /// Open a project or mesh in place of this one.
    Open(PathBuf),
    /// Save the project.
    Save(PathBuf),
    /// Save the history as a script.
    SaveScript(PathBuf),
}

/// What the window sees of the document.
#[derive(Clone, Debug)]
pub struct View {
    /// Counts the changes.
    pub revision: u64,
    /// Counts how often the document itself has put the yarn somewhere (laid it anew, or took that back); otherwise the
    /// simulation knows best where it is.
    pub placed: u64,
    /// The project.
    pub project: Project,
    /// Facts about it.
    pub facts: Inspection,
    /// The file it was read from or written to.
    pub path: Option<PathBuf>,
    /// Names of the commands done, oldest first.
    pub done: Vec<String>,
    /// Name of the command that redo would do.
    pub redo: Option<String>,
    /// What the last request came to: done, or why not.
    pub message: Result<String, String>,
}

/// A running session. Dropping it lets the thread finish what it was asked and end.
pub struct Session {
    requests: Sender<(Request, Option<Arc<YarnState>>)>,
    latest: Arc<Mutex<Arc<View>>>,
    waiting: Arc<AtomicUsize>,
}

impl Session {
    /// Starts a session. `wake` is called whenever there is a new view.
    ///
    /// # Errors
    /// The system has no thread to give.
    pub fn spawn(
        project: Project,
        path: Option<PathBuf>,
        wake: Box<dyn Fn() + Send>,
    ) -> std::io::Result<Self> {
        let (requests, received) = channel::<(Request, Option<Arc<YarnState>>)>();
        let mut worker = Worker { document: Document::new(project), path, revision: 0, placed: 0 };
        let latest = Arc::new(Mutex::new(Arc::new(worker.view(Ok(String::new())))));
        let waiting = Arc::new(AtomicUsize::new(0));
        let (slot, count) = (Arc::clone(&latest), Arc::clone(&waiting));
        std::thread::Builder::new().name("document".to_owned()).spawn(move || {
            for (request, yarn) in received {
                let view = worker.carry_out(request, yarn);
                *slot.lock().unwrap_or_else(PoisonError::into_inner) = Arc::new(view);
                count.fetch_sub(1, Ordering::Release);
                wake();
            }
        })?;
        Ok(Self { requests, latest, waiting })
    }

    /// Asks for something. `yarn` is where the simulation has brought the yarn, if it is running.
    pub fn send(&self, request: Request, yarn: Option<Arc<YarnState>>) {
        self.waiting.fetch_add(1, Ordering::Release);
        // The thread ends only when this sender is dropped.
        let _ = self.requests.send((request, yarn));
    }

    /// Shows the system's file dialog, beside the window, and opens what is chosen. Where there is no dialog nothing happens.
    pub fn ask_for_file(&self) {
        let (requests, waiting) = (self.requests.clone(), Arc::clone(&self.waiting));
        let ask = move || {
            let dialog = rfd::FileDialog::new().add_filter("Projects and meshes", &["purl", "obj"]);
            if let Some(path) = dialog.pick_file() {
                waiting.fetch_add(1, Ordering::Release);
                let _ = requests.send((Request::Open(path), None));
            }
        };
        if let Err(error) = std::thread::Builder::new().name("file dialog".to_owned()).spawn(ask) {
            tracing::warn!("no file dialog: {error}");
        }
    }

    /// The newest view.
    pub fn latest(&self) -> Arc<View> {
        self.latest.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    /// Whether requests are still being worked on.
    pub fn is_busy(&self) -> bool {
        self.waiting.load(Ordering::Acquire) > 0
    }
}

struct Worker {
    document: Document,
    path: Option<PathBuf>,
    revision: u64,
    placed: u64,
}

impl Worker {
    fn carry_out(&mut self, request: Request, yarn: Option<Arc<YarnState>>) -> View {
        if let Some(yarn) = yarn {
            self.document.set_state(yarn, None);
        }
        let places = match &request {
            Request::Do(command) => Some(command),
            Request::Undo => self.document.done().last(),
            Request::Redo => self.document.next_redo(),
            _ => None,
        } == Some(&Command::ResetYarn);
        let message = self.try_to(request).map_err(|e| format!("{e:#}"));
        self.placed += u64::from(places);
        self.revision += 1;
        self.view(message)
    }

    fn try_to(&mut self, request: Request) -> Result<String> {
        match request {
            Request::Do(command) => {
                let name = command.name();
                self.document.apply(command)?;
                Ok(name)
            }
            Request::Amend(command) => {
                self.document.amend(command)?;
                Ok(self.document.done().last().map(Command::name).unwrap_or_default())
            }
            Request::Undo => {
                let name =
                    self.document.done().last().map(Command::name).context("there is nothing to undo")?;
                self.document.undo();
                Ok(format!("Undone: {name}"))
            }
            Request::Redo => {
                let name =
                    self.document.next_redo().map(Command::name).context("there is nothing to redo")?;
                self.document.redo();
                Ok(format!("Redone: {name}"))
            }
            Request::Open(path) => {
                self.document = Document::new(Project::open_any(&path)?);
                let message = format!("Opened {}", path.display());
                self.path = Some(path);
                Ok(message)
            }
            Request::Save(path) => {
                self.document.project().save(&path)?;
                let message = format!("Saved {}", path.display());
                self.path = Some(path);
                Ok(message)
            }
            Request::SaveScript(path) => {
                files::write(&path, write_script(self.document.done())?.as_bytes())?;
                Ok(format!("Saved the history as {}", path.display()))
            }
        }
    }

    fn view(&self, message: Result<String, String>) -> View {
        View {
            revision: self.revision,
            placed: self.placed,
            project: self.document.project().clone(),
            facts: inspect(self.document.project()),
            path: self.path.clone(),
            done: self.document.done().map(Command::name).collect(),
            redo: self.document.next_redo().map(Command::name),
            message,
        }
    }
}
