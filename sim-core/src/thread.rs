//! The simulation in a thread of its own.
//!
//! Commands go in through a channel; the newest snapshot lies in a slot that is replaced after every step. Nobody waits: a
//! snapshot that nobody took is dropped, and between two steps the thread looks at everything that was sent meanwhile.
//! Time goes no faster than on the clock, so that a small swatch falls as one would see it fall (`pace.rs`).

use crate::choice::{SharedGpu, SolverChoice};
use crate::curves::curves;
use crate::forces::HoldFact;
use crate::gpu::DeviceYarn;
use crate::materials::Materials;
use crate::pace::Pace;
use crate::progress::Progress;
use crate::scene::Scene;
use crate::simulation::Simulation;
use crate::simulator::SimError;
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
    /// Back to where it was loaded, in the scene and of the materials that it has now.
    Reset,
    /// Solve with this from now on, whatever is loaded.
    SetSolver(SolverChoice),
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
#[derive(Clone, Debug, Default)]
pub struct Snapshot {
    /// Which `Load` it belongs to, counted from 1.
    pub generation: u64,
    /// The state; the one loaded, if that can't be simulated. While a GPU simulates, one of at most 0.05 s of simulated time
    /// before.
    pub state: YarnState,
    /// The net, which is no longer the one loaded once yarn has been cut or has slipped out.
    pub net: Arc<YarnNet>,
    /// What has happened to it since the load.
    pub surgery: Surgery,
    /// Its yarns, drawn with the radii of their materials; none where the state does not belong to the net.
    pub curves: YarnCurves,
    /// The same where it is simulated on the device that it is drawn on; `curves` is then empty.
    pub on_device: Option<DeviceYarn>,
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
    /// Whether it has been stepped or reset since it was loaded.
    pub moved: bool,
    /// What solves it: "direct", "iterative" or "gpu"; nothing, if it can't be simulated.
    pub solver: &'static str,
    /// The name of the GPU that simulates it.
    pub adapter: Option<String>,
    /// Why the GPU that was to simulate it does not, or no longer.
    pub notice: Option<String>,
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
    /// Starts a thread, idle until something is loaded. It simulates on `gpu` where that is the best. `wake` is called, in that
    /// thread, whenever there is a new snapshot.
    ///
    /// # Errors
    /// The system has no thread to give.
    pub fn spawn(gpu: SharedGpu, wake: Box<dyn Fn() + Send>) -> std::io::Result<Self> {
        let (commands, received) = channel();
        let latest = Arc::new(Mutex::new(None));
        let choice = SolverChoice::default();
        let worker = Worker { latest: Arc::clone(&latest), wake, gpu, choice, run: None, loads: 0 };
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

/// What is loaded.
#[derive(Clone)]
struct Loaded {
    net: Arc<YarnNet>,
    materials: Materials,
    scene: Scene,
    state: Arc<YarnState>,
}

/// One loaded net.
struct Run {
    loaded: Loaded,
    /// None where the net, material, scene or state can't be simulated.
    simulation: Option<Simulation>,
    playing: bool,
    moved: bool,
    error: Option<String>,
    ms_per_step: f64,
    pace: Pace,
}

struct Worker {
    latest: Arc<Mutex<Option<Arc<Snapshot>>>>,
    wake: Box<dyn Fn() + Send>,
    gpu: SharedGpu,
    choice: SolverChoice,
    run: Option<Run>,
    loads: u64,
}

impl Worker {
    fn work(mut self, commands: Receiver<SimCommand>) {
        loop {
            let wait = self.run.as_ref().filter(|r| r.playing).map(|r| r.pace.until_due(Instant::now()));
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
                let before = run.as_ref().and_then(|r| r.simulation.as_ref());
                let before = before
                    .filter(|s| is_laid_no_more && s.scene().moves_like(&scene))
                    .map(|s| s.progress().scene_time_s);
                let mut new = Run::new(&self.gpu, self.choice, Loaded { net, materials, scene, state });
                if let (Some(simulation), Some(time_s)) = (&mut new.simulation, before) {
                    simulation.resume_at(time_s);
                }
                *run = Some(new);
            }
            (SimCommand::SetSolver(choice), run) => {
                self.choice = choice;
                if let Some(simulation) = run.as_mut().and_then(|r| r.simulation.as_mut()) {
                    simulation.set_choice(&self.gpu, choice);
                }
            }
            (SimCommand::Stop, run) => *run = None,
            (_, None) => {}
            (SimCommand::Reset, Some(run)) => {
                let playing = run.playing;
                *run = Run::new(&self.gpu, self.choice, run.loaded.clone());
                run.moved = true;
                if playing {
                    run.play();
                }
            }
            (SimCommand::Play, Some(run)) => run.play(),
            (SimCommand::Pause, Some(run)) => run.playing = false,
            (SimCommand::StepOnce, Some(run)) => run.step(),
            (SimCommand::SetScene(scene), Some(run)) => {
                run.set(|s| s.set_scene(&scene));
                run.loaded.scene = scene;
            }
            (SimCommand::SetMaterials(materials), Some(run)) => {
                run.set(|s| s.set_materials(&materials));
                run.loaded.materials = materials;
            }
            (SimCommand::Operate(operation), Some(run)) => run.set(|s| s.operate(&operation)),
        }
    }

    fn publish(&mut self) {
        let snapshot = self.run.as_mut().map(|run| Arc::new(run.snapshot(self.loads)));
        *self.latest.lock().unwrap_or_else(PoisonError::into_inner) = snapshot;
        (self.wake)();
    }
}

impl Run {
    fn new(gpu: &SharedGpu, choice: SolverChoice, loaded: Loaded) -> Self {
        let Loaded { net, materials, scene, state } = &loaded;
        let made = Simulation::new(gpu, choice, net, materials.clone(), scene.clone(), (**state).clone());
        let (simulation, error) = match made {
            Ok(simulation) => (Some(simulation), None),
            Err(error) => (None, Some(error.to_string())),
        };
        let pace = Pace::starting(Instant::now());
        Self { loaded, simulation, playing: false, moved: false, error, ms_per_step: 0.0, pace }
    }

    fn play(&mut self) {
        self.playing = self.simulation.is_some();
        self.pace = Pace::starting(Instant::now());
    }

    fn step(&mut self) {
        let Some(simulation) = &mut self.simulation else { return };
        let start = Instant::now();
        match simulation.step() {
            Ok(report) => {
                self.error = None;
                self.moved = true;
                self.pace.step(Duration::from_secs_f64(report.time_step), Instant::now());
            }
            Err(error) => {
                self.error = Some(error.to_string());
                self.playing = false;
            }
        }
        self.ms_per_step = start.elapsed().as_secs_f64() * 1e3;
    }

    fn set(&mut self, change: impl FnOnce(&mut Simulation) -> Result<(), SimError>) {
        if let Some(simulation) = &mut self.simulation {
            self.error = change(simulation).err().map(|e| e.to_string());
        }
    }

    fn snapshot(&mut self, generation: u64) -> Snapshot {
        let mut snapshot = match &mut self.simulation {
            Some(simulation) => of_simulation(simulation, self.playing),
            None => of_loaded(&self.loaded),
        };
        snapshot.error = self.error.clone().or(snapshot.error);
        let Self { playing, moved, ms_per_step, .. } = *self;
        Snapshot { generation, playing, moved, ms_per_step, ..snapshot }
    }
}

/// What there is to see of a simulation, its state as the CPU has it while it plays.
fn of_simulation(simulation: &mut Simulation, playing: bool) -> Snapshot {
    let read = if playing { Ok(()) } else { simulation.state().map(|_| ()) };
    let drawn = read.and_then(|()| match simulation.device_yarn()? {
        Some(yarn) => Ok((YarnCurves::default(), Some(yarn))),
        None => Ok((simulation.curves()?, None)),
    });
    let ((curves, on_device), error) = match drawn {
        Ok(drawn) => (drawn, None),
        Err(error) => (Default::default(), Some(error.to_string())),
    };
    let Progress { time_s, scene_time_s, ref surgery, .. } = *simulation.progress();
    Snapshot {
        state: simulation.last_state().clone(),
        net: Arc::clone(simulation.net()),
        surgery: surgery.clone(),
        curves,
        on_device,
        time_s,
        scene_time_s,
        holds: simulation.holds(),
        error,
        solver: simulation.solver(),
        adapter: simulation.adapter().map(str::to_owned),
        notice: simulation.notice().map(str::to_owned),
        ..Snapshot::default()
    }
}

/// What there is to see of what can't be simulated.
fn of_loaded(Loaded { net, materials, state, .. }: &Loaded) -> Snapshot {
    let drawable = state.fits(net) && state.is_finite();
    Snapshot {
        state: (**state).clone(),
        net: Arc::clone(net),
        curves: if drawable { curves(net, state, materials) } else { YarnCurves::default() },
        ..Snapshot::default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::GpuDevice;
    use crate::material::Material;
    use std::sync::mpsc::Receiver;
    use stitch_mesh::ids::VisitId;

    /// A thread, and what its wake-ups arrive at.
    fn thread() -> (SimThread, Receiver<()>) {
        let (woken, wakes) = channel();
        let wake = Box::new(move || woken.send(()).unwrap_or_default());
        (SimThread::spawn(SharedGpu::default(), wake).unwrap(), wakes)
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
    fn reset_goes_back_to_where_it_was_loaded() {
        let (thread, wakes) = thread();
        load(&thread, |state| state.position[3].z += 1e-4);
        let loaded = wait(&thread, &wakes, |s| s.generation == 1);
        assert!(!loaded.moved);
        thread.send(SimCommand::Play);
        wait(&thread, &wakes, |s| s.time_s > 0.02);
        thread.send(SimCommand::Operate(Operation::Cut(VisitId(40))));
        wait(&thread, &wakes, |s| s.surgery.operations.len() == 1);
        thread.send(SimCommand::Pause);
        thread.send(SimCommand::Reset);
        let reset = wait(&thread, &wakes, |s| s.moved && s.time_s == 0.0);
        assert_eq!((&reset.state, reset.surgery.operations.len()), (&loaded.state, 0));
        assert!(Arc::ptr_eq(&reset.net, &loaded.net) && !reset.playing);
    }

    #[test]
    fn goes_on_with_another_solver() {
        let (thread, wakes) = thread();
        load(&thread, |_| {});
        thread.send(SimCommand::StepOnce);
        let before = wait(&thread, &wakes, |s| s.time_s > 0.0);
        assert_eq!(before.solver, "direct");
        thread.send(SimCommand::SetSolver(SolverChoice::Iterative));
        let after = wait(&thread, &wakes, |s| s.solver == "iterative");
        assert_eq!((&after.state, after.time_s), (&before.state, before.time_s));
        load(&thread, |_| {});
        wait(&thread, &wakes, |s| s.generation == 2 && s.solver == "iterative");
    }

    #[test]
    fn a_lost_gpu_is_no_loss() {
        let Ok(gpu) = GpuDevice::open() else {
            println!("SKIPPED: there is no GPU here, nor a software one");
            return;
        };
        let (woken, wakes) = channel();
        let wake = Box::new(move || woken.send(()).unwrap_or_default());
        let thread = SimThread::spawn(SharedGpu::from(gpu.clone()), wake).unwrap();
        thread.send(SimCommand::SetSolver(SolverChoice::Gpu));
        load(&thread, |_| {});
        for n in 1..=3 {
            thread.send(SimCommand::StepOnce);
            wait(&thread, &wakes, |s| s.time_s > (f64::from(n) - 0.5) * Scene::empty().time_step);
        }
        let cut = SimCommand::Operate(Operation::Cut(VisitId(40)));
        thread.send(cut);
        let good = wait(&thread, &wakes, |s| s.surgery.operations.len() == 1);
        assert_eq!((good.solver, good.adapter.as_deref()), ("gpu", Some(gpu.adapter.name.as_str())));
        assert!(good.notice.is_none() && good.error.is_none());
        gpu.destroy();
        thread.send(SimCommand::StepOnce);
        let after = wait(&thread, &wakes, |s| s.time_s > good.time_s);
        assert_eq!((after.solver, after.adapter.as_ref()), ("direct", None));
        let notice = after.notice.as_deref().unwrap();
        assert!(notice.starts_with("the GPU was lost") && notice.contains("going on on the CPU"), "{notice}");
        assert!(after.error.is_none());
        // One step further, with the yarn cut and the simulation as long as before.
        assert!(after.surgery.operations.starts_with(&good.surgery.operations));
        assert!((after.time_s - good.time_s - Scene::empty().time_step).abs() < 1e-9);
        let moved = after.state.position.iter().zip(&good.state.position).map(|(a, b)| a.distance(*b));
        let furthest = moved.fold(0.0, f64::max);
        assert!(furthest > 0.0 && furthest < 1e-3, "{furthest}");
        // What is loaded next begins on the CPU.
        load(&thread, |_| {});
        wait(&thread, &wakes, |s| s.generation == 2 && s.solver == "direct" && s.notice.is_some());
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
