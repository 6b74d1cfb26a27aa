//! What a simulation thread does.

use super::{See, SimCommand, Snapshot};
use crate::choice::{SharedGpu, SolverChoice};
use crate::curves::curves;
use crate::materials::Materials;
use crate::pace::Pace;
use crate::progress::Progress;
use crate::scene::Scene;
use crate::simulation::Simulation;
use crate::simulator::SimError;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, RecvTimeoutError};
use std::time::{Duration, Instant};
use stitch_mesh::yarn_curves::YarnCurves;
use stitch_mesh::yarn_net::{YarnNet, YarnState};

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

pub(super) struct Worker {
    see: See,
    gpu: SharedGpu,
    choice: SolverChoice,
    run: Option<Run>,
    loads: u64,
}

impl Worker {
    /// One that simulates on `gpu` where that is the best, and lets `see` have its snapshots.
    pub fn new(gpu: SharedGpu, see: See) -> Self {
        Self { see, gpu, choice: SolverChoice::default(), run: None, loads: 0 }
    }

    /// Carries out what comes until nobody can send any more.
    pub fn work(mut self, commands: Receiver<SimCommand>) {
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
        (self.see)(snapshot.as_ref());
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
