//! The simulation in a thread of its own.
//!
//! Commands go in through a channel; the newest snapshot lies in a slot that is replaced after every step. Nobody waits: a
//! snapshot that nobody took is dropped, and between two steps the thread looks at everything that was sent meanwhile.
//! Time goes no faster than on the clock, so that a small swatch falls as one would see it fall.

use crate::curves::curves;
use crate::forces::HoldFact;
use crate::materials::Materials;
use crate::scene::Scene;
use crate::simulator::{SimError, Simulator};
use crate::surgery::{Operation, Surgery};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};
use stitch_mesh::yarn_curves::YarnCurves;
use stitch_mesh::yarn_net::{YarnNet, YarnState};

/// What a simulation thread can be told.
#[derive(Clone, Debug)]
pub enum SimCommand {
    /// Simulate this from now on, paused at first.
    Load {
        /// The net.
        net: Arc<YarnNet>,
        /// The materials of its yarns.
        materials: Materials,
        /// What surrounds it.
        scene: Scene,
        /// Where it starts; as it was laid, if nowhere else.
        state: Option<Arc<YarnState>>,
    },
    /// Let time go by.
    Play,
    /// Hold.
    Pause,
    /// One step while held.
    StepOnce,
    /// Replace the scene: dragging a pin, moving a body.
    SetScene(Scene),
    /// Replace the materials.
    SetMaterials(Materials),
    /// Change the net: cut a yarn.
    Operate(Operation),
    /// Forget the net.
    Stop,
}

/// The newest state of a simulation thread.
#[derive(Clone, Debug)]
pub struct Snapshot {
    /// Which `Load` it belongs to, counted from 1.
    pub generation: u64,
    /// The state; the one loaded, if that can't be simulated.
    pub state: YarnState,
    /// The net, which is no longer the one loaded once yarn has been cut or has slipped out.
    pub net: Arc<YarnNet>,
    /// What has happened to it since the load.
    pub surgery: Surgery,
    /// Its yarns, drawn with the radii of their materials; none where the state does not belong to the net.
    pub curves: YarnCurves,
    /// Simulated time since the load [s].
    pub time_s: f64,
    /// Whether time goes by.
    pub playing: bool,
    /// Time since the scene began, by which its bodies move [s].
    pub scene_time_s: f64,
    /// What holds the fabric, or touches it, and how hard.
    pub holds: Vec<HoldFact>,
    /// What last went wrong, if anything. A simulation that is stuck is paused.
    pub error: Option<String>,
    /// Clock time of the last step [ms].
    pub ms_per_step: f64,
}

/// A simulation thread. Dropping it ends the thread after the step it is in.
pub struct SimThread {
    commands: Option<Sender<SimCommand>>,
    latest: Arc<Mutex<Option<Arc<Snapshot>>>>,
    loads: AtomicU64,
    thread: Option<JoinHandle<()>>,
}

impl SimThread {
    /// Starts a thread, idle until something is loaded. `wake` is called, in that thread, whenever there is a new snapshot.
    ///
    /// # Errors
    /// The system has no thread to give.
    pub fn spawn(wake: Box<dyn Fn() + Send>) -> std::io::Result<Self> {
        let (commands, received) = channel();
        let latest = Arc::new(Mutex::new(None));
        let worker = Worker { latest: Arc::clone(&latest), wake, run: None, loads: 0 };
        let thread =
            std::thread::Builder::new().name("simulation".to_owned()).spawn(|| worker.work(received))?;
        Ok(Self { commands: Some(commands), latest, loads: AtomicU64::new(0), thread: Some(thread) })
    }

    /// Sends a command. Gives the generation that snapshots will have once it is carried out.
    pub fn send(&self, command: SimCommand) -> u64 {
        let new = u64::from(matches!(command, SimCommand::Load { .. }));
        let generation = self.loads.fetch_add(new, Ordering::Relaxed) + new;
        if let Some(commands) = &self.commands {
            // The thread ends only when this sender is dropped.
            let _ = commands.send(command);
        }
        generation
    }

    /// The newest snapshot, if anything is loaded. Does not wait for the simulation.
    pub fn latest(&self) -> Option<Arc<Snapshot>> {
        self.latest.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }
}

impl Drop for SimThread {
    fn drop(&mut self) {
        self.commands = None;
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}

/// One loaded net.
struct Run {
    net: Arc<YarnNet>,
    /// None where the net, material, scene or state can't be simulated.
    simulator: Option<Simulator>,
    loaded: Arc<YarnState>,
    materials: Materials,
    playing: bool,
    error: Option<String>,
    ms_per_step: f64,
    /// When the next step is due.
    due: Instant,
}

struct Worker {
    latest: Arc<Mutex<Option<Arc<Snapshot>>>>,
    wake: Box<dyn Fn() + Send>,
    run: Option<Run>,
    loads: u64,
}

impl Worker {
    fn work(mut self, commands: Receiver<SimCommand>) {
        loop {
            let wait = self
                .run
                .as_ref()
                .filter(|r| r.playing)
                .map(|r| r.due.saturating_duration_since(Instant::now()));
            let command = match wait {
                Some(time) => commands.recv_timeout(time),
                None => commands.recv().map_err(|_| RecvTimeoutError::Disconnected),
            };
            match command {
                Ok(first) => {
                    self.carry_out(first);
                    while let Ok(next) = commands.try_recv() {
                        self.carry_out(next);
                    }
                }
                Err(RecvTimeoutError::Timeout) => self.run.iter_mut().for_each(Run::step),
                Err(RecvTimeoutError::Disconnected) => return,
            }
            self.publish();
        }
    }

    fn carry_out(&mut self, command: SimCommand) {
        match (command, &mut self.run) {
            (SimCommand::Load { net, materials, scene, state }, run) => {
                self.loads += 1;
                let is_laid_no_more = state.is_some();
                let state = state.unwrap_or_else(|| Arc::new(net.laid_state()));
                // After an edit, what moves goes on.
                let before = run.as_ref().and_then(|r| r.simulator.as_ref());
                let before = before
                    .filter(|s| is_laid_no_more && s.scene().moves_like(&scene))
                    .map(Simulator::scene_time_s);
                let mut new = Run::new(net, materials, scene, state);
                if let (Some(simulator), Some(time_s)) = (&mut new.simulator, before) {
                    simulator.resume_at(time_s);
                }
                *run = Some(new);
            }
            (SimCommand::Stop, run) => *run = None,
            (_, None) => {}
            (SimCommand::Play, Some(run)) => run.play(),
            (SimCommand::Pause, Some(run)) => run.playing = false,
            (SimCommand::StepOnce, Some(run)) => run.step(),
            (SimCommand::SetScene(scene), Some(run)) => run.set(|s| s.set_scene(scene)),
            (SimCommand::SetMaterials(materials), Some(run)) => {
                run.materials = materials.clone();
                run.set(|s| s.set_materials(materials));
            }
            (SimCommand::Operate(operation), Some(run)) => run.set(|s| s.operate(operation)),
        }
    }

    fn publish(&self) {
        let snapshot = self.run.as_ref().map(|run| Arc::new(run.snapshot(self.loads)));
        *self.latest.lock().unwrap_or_else(PoisonError::into_inner) = snapshot;
        (self.wake)();
    }
}

impl Run {
    fn new(net: Arc<YarnNet>, materials: Materials, scene: Scene, state: Arc<YarnState>) -> Self {
        let made = Simulator::new(&net, materials.clone(), scene, (*state).clone());
        let (simulator, error) = match made {
            Ok(simulator) => (Some(simulator), None),
            Err(error) => (None, Some(error.to_string())),
        };
        Self {
            net,
            simulator,
            loaded: state,
            materials,
            playing: false,
            error,
            ms_per_step: 0.0,
            due: Instant::now(),
        }
    }

    fn play(&mut self) {
        self.playing = self.simulator.is_some();
        self.due = Instant::now();
    }

    fn step(&mut self) {
        let Some(simulator) = &mut self.simulator else { return };
        let start = Instant::now();
        match simulator.step() {
            Ok(report) => {
                self.error = None;
                // Never catch up on time that was lost: a slow step makes slow motion, not a jump.
                self.due = start.max(self.due) + Duration::from_secs_f64(report.time_step);
            }
            Err(error) => {
                self.error = Some(error.to_string());
                self.playing = false;
            }
        }
        self.ms_per_step = start.elapsed().as_secs_f64() * 1e3;
    }

    fn set(&mut self, change: impl FnOnce(&mut Simulator) -> Result<(), SimError>) {
        if let Some(simulator) = &mut self.simulator {
            self.error = change(simulator).err().map(|e| e.to_string());
        }
    }

    fn snapshot(&self, generation: u64) -> Snapshot {
        let state = self.simulator.as_ref().map_or(&*self.loaded, Simulator::state);
        let net = self.simulator.as_ref().map_or(&self.net, Simulator::net);
        let drawable = state.fits(net) && state.is_finite();
        Snapshot {
            generation,
            state: state.clone(),
            net: Arc::clone(net),
            surgery: self.simulator.as_ref().map(|s| s.surgery().clone()).unwrap_or_default(),
            curves: if drawable { curves(net, state, &self.materials) } else { YarnCurves::default() },
            time_s: self.simulator.as_ref().map_or(0.0, Simulator::time_s),
            scene_time_s: self.simulator.as_ref().map_or(0.0, Simulator::scene_time_s),
            holds: self.simulator.as_ref().map_or_else(Vec::new, Simulator::holds),
            playing: self.playing,
            error: self.error.clone(),
            ms_per_step: self.ms_per_step,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::Material;
    use std::sync::mpsc::Receiver;
    use stitch_mesh::ids::VisitId;

    /// A thread, and what its wake-ups arrive at.
    fn thread() -> (SimThread, Receiver<()>) {
        let (woken, wakes) = channel();
        let wake = Box::new(move || woken.send(()).unwrap_or_default());
        (SimThread::spawn(wake).unwrap(), wakes)
    }

    fn load(thread: &SimThread, spoil: impl Fn(&mut YarnState)) -> u64 {
        let net = Arc::clone(&crate::testing::swatch_model(4, 4).net);
        let mut state = net.laid_state();
        spoil(&mut state);
        let materials = Material::for_loop_width(3e-3).into();
        thread.send(SimCommand::Load { net, materials, scene: Scene::empty(), state: Some(Arc::new(state)) })
    }

    /// Waits for a snapshot that `is` so.
    fn wait(thread: &SimThread, wakes: &Receiver<()>, is: impl Fn(&Snapshot) -> bool) -> Arc<Snapshot> {
        loop {
            if let Some(snapshot) = thread.latest().filter(|s| is(s)) {
                return snapshot;
            }
            wakes.recv_timeout(Duration::from_secs(20)).expect("a snapshot in time");
        }
    }

    #[test]
    fn plays_pauses_and_steps() {
        let (thread, wakes) = thread();
        assert!(thread.latest().is_none());
        assert_eq!(load(&thread, |_| {}), 1);
        let loaded = wait(&thread, &wakes, |s| s.generation == 1);
        assert!(!loaded.playing && loaded.time_s == 0.0 && loaded.error.is_none());
        assert_eq!(thread.send(SimCommand::StepOnce), 1);
        wait(&thread, &wakes, |s| s.time_s > 0.0 && !s.playing);
        thread.send(SimCommand::Play);
        let played = wait(&thread, &wakes, |s| s.time_s > 0.03);
        assert!(played.playing && !played.curves.curves.is_empty());
        thread.send(SimCommand::Pause);
        wait(&thread, &wakes, |s| !s.playing);
        assert_eq!(load(&thread, |_| {}), 2);
        wait(&thread, &wakes, |s| s.generation == 2 && s.time_s == 0.0);
    }

    #[test]
    fn a_cut_goes_on_from_where_the_yarn_is() {
        let (thread, wakes) = thread();
        load(&thread, |_| {});
        thread.send(SimCommand::StepOnce);
        let whole = wait(&thread, &wakes, |s| s.time_s > 0.0);
        thread.send(SimCommand::Operate(Operation::Cut(VisitId(40))));
        let cut = wait(&thread, &wakes, |s| s.surgery.operations.len() == 1);
        assert_eq!(cut.net.yarns.len(), whole.net.yarns.len() + 1);
        assert!(cut.state.fits(&cut.net) && cut.curves.curves.len() == cut.net.yarns.len());
        assert_eq!(cut.time_s, whole.time_s);
        thread.send(SimCommand::Operate(Operation::Cut(VisitId(1 << 20))));
        let refused = wait(&thread, &wakes, |s| s.error.is_some());
        assert!(refused.error.as_deref().unwrap().contains("there is no visit 1048576"));
        assert_eq!(refused.surgery.operations.len(), 1);
    }

    #[test]
    fn reports_what_it_cannot_simulate_and_goes_on() {
        let (thread, wakes) = thread();
        load(&thread, |state| state.position[3].x = f64::NAN);
        let failed = wait(&thread, &wakes, |s| s.error.is_some());
        assert_eq!(failed.error.as_deref(), Some("the state is not finite"));
        thread.send(SimCommand::Play);
        load(&thread, |_| {});
        wait(&thread, &wakes, |s| s.error.is_none() && s.generation == 2);
        let scene = Scene { time_step: -1.0, ..Scene::empty() };
        thread.send(SimCommand::SetScene(scene));
        let refused = wait(&thread, &wakes, |s| s.error.is_some());
        assert_eq!(refused.error.as_deref(), Some("scene: time step is -1 s, and must be positive"));
    }

    #[test]
    fn stopping_forgets_and_dropping_joins() {
        let (thread, wakes) = thread();
        load(&thread, |_| {});
        wait(&thread, &wakes, |_| true);
        thread.send(SimCommand::Play);
        thread.send(SimCommand::Stop);
        while thread.latest().is_some() {
            wakes.recv_timeout(Duration::from_secs(20)).expect("a wake-up in time");
        }
        load(&thread, |_| {});
        thread.send(SimCommand::Play);
        drop(thread);
    }
}
