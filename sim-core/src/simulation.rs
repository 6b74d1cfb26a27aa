//! A simulation, whatever solves it.
//!
//! Three solvers do the same steps: the direct and the iterative one on the CPU ([`Simulator`]), and the iterative one on the GPU
//! ([`GpuSimulator`]). They come to the same rest shape: nodes of ten fabrics of 30 loops are within 0.02 mm of each other
//! (`gpu/tests/rest.rs`).
//!
//! A GPU can be lost, run out of memory, or have no kernel for what it is asked for. Then the CPU goes on from the last state
//! that was read back, at most 0.05 s of simulated time before, and [`Simulation::notice`] says so.

use crate::choice::{SharedGpu, SolverChoice};
use crate::costs::Costs;
use crate::curves::curves;
use crate::facts::{Facts, max_stretch};
use crate::forces::HoldFact;
use crate::gpu::{DeviceYarn, GpuError, GpuSimulator};
use crate::handover::Handover;
use crate::materials::Materials;
use crate::progress::Progress;
use crate::scene::Scene;
use crate::settle::{SettleGoal, SettleProgress, Settled, Settles, settle};
use crate::simulator::{SimError, Simulator, StepReport};
use crate::solver::Method;
use crate::step::Rejection;
use crate::surgery::Operation;
use std::ops::ControlFlow;
use std::sync::Arc;
use stitch_mesh::yarn_curves::YarnCurves;
use stitch_mesh::yarn_net::{YarnNet, YarnState};

/// A simulation on the CPU or on the GPU.
pub struct Simulation {
    on: On,
    choice: SolverChoice,
    notice: Option<String>,
}

enum On {
    Cpu(Box<Simulator>),
    Gpu(Box<GpuSimulator>),
}

impl Simulation {
    /// A simulation of `net` from `state`, which may be its laid state. Yarns stick where they are.
    ///
    /// # Errors
    /// Net, material, scene or state make no sense.
    pub fn new(
        gpu: &SharedGpu,
        choice: SolverChoice,
        net: &Arc<YarnNet>,
        materials: impl Into<Materials>,
        scene: Scene,
        state: YarnState,
    ) -> Result<Self, SimError> {
        Ok(Self::resume(gpu, choice, Handover::new(net, materials, scene, state)?))
    }

    /// Goes on with what another simulation has come to.
    fn resume(gpu: &SharedGpu, choice: SolverChoice, from: Handover) -> Self {
        let mut notice = None;
        if choice.is_gpu(gpu, from.model.net.nodes.len()) {
            let made = gpu.get().map_err(SimError::from);
            match made.and_then(|gpu| GpuSimulator::resume(&gpu, from.clone())) {
                Ok(simulator) => return Self { on: On::Gpu(Box::new(simulator)), choice, notice },
                Err(error) => notice = Some(on_cpu_instead(&error, from.progress.time_s)),
            }
        }
        let on = On::Cpu(Box::new(Simulator::resume(from, choice.method())));
        Self { on, choice, notice }
    }

    /// Goes on with another solver, from the state now.
    pub fn set_choice(&mut self, gpu: &SharedGpu, choice: SolverChoice) {
        if choice != self.choice {
            let from = match &mut self.on {
                On::Cpu(cpu) => cpu.handover(),
                On::Gpu(gpu) => {
                    // Where it can't be read any more, from the last state that was.
                    let _ = gpu.state();
                    gpu.handover()
                }
            };
            *self = Self::resume(gpu, choice, from);
        }
    }

    /// Does something where the simulation is, and on the CPU once the GPU has failed at it.
    fn go_on<T>(
        &mut self,
        on_gpu: impl FnOnce(&mut GpuSimulator) -> Result<T, SimError>,
        on_cpu: impl FnOnce(&mut Simulator) -> Result<T, SimError>,
    ) -> Result<T, SimError> {
        let (error, from) = match &mut self.on {
            On::Cpu(cpu) => return on_cpu(cpu),
            On::Gpu(gpu) => match on_gpu(gpu) {
                Err(error) if is_of_gpu(&error) => {
                    // Nothing is lost but what can't be read any more.
                    let _ = gpu.state();
                    (error, gpu.handover())
                }
                done => return done,
            },
        };
        self.notice = Some(on_cpu_instead(&error, from.progress.time_s));
        let mut cpu = Box::new(Simulator::resume(from, self.choice.method()));
        let done = on_cpu(&mut cpu);
        self.on = On::Cpu(cpu);
        done
    }

    /// Goes on by one step: of the scene's time step, or less where that goes wrong. After an error the state is that of the
    /// last good step.
    ///
    /// # Errors
    /// No time step is small enough.
    pub fn step(&mut self) -> Result<StepReport, SimError> {
        let on_gpu = |gpu: &mut GpuSimulator| {
            let report = gpu.step()?;
            gpu.keep()?;
            Ok(report)
        };
        self.go_on(on_gpu, Simulator::step)
    }

    /// Steps until the fabric is as good as still, the time limit, or until `progress` breaks off.
    ///
    /// # Errors
    /// As [`Self::step`].
    pub fn settle(
        &mut self,
        goal: SettleGoal,
        progress: &mut dyn FnMut(SettleProgress) -> ControlFlow<()>,
    ) -> Result<Settled, SimError> {
        settle(self, goal, progress)
    }

    /// Changes the net while it is simulated. Pins on nodes that go are dropped. Nothing has changed after an error.
    ///
    /// # Errors
    /// The net has no such yarn.
    pub fn operate(&mut self, operation: &Operation) -> Result<(), SimError> {
        self.go_on(|gpu| gpu.operate(operation.clone()), |cpu| cpu.operate(operation.clone()))
    }

    /// Changes gravity, bodies, pins or time step; refused as a whole if anything in it makes no sense. What moves begins anew,
    /// unless all of it moves as before.
    ///
    /// # Errors
    /// The scene makes no sense.
    pub fn set_scene(&mut self, scene: &Scene) -> Result<(), SimError> {
        self.go_on(|gpu| gpu.set_scene(scene.clone()), |cpu| cpu.set_scene(scene.clone()))
    }

    /// Changes the materials; refused as a whole if anything in them makes no sense.
    ///
    /// # Errors
    /// They make no sense.
    pub fn set_materials(&mut self, materials: &Materials) -> Result<(), SimError> {
        self.go_on(|gpu| gpu.set_materials(materials.clone()), |cpu| cpu.set_materials(materials.clone()))
    }

    /// Goes on at a time of the scene: for a fabric that was edited while things moved [s].
    pub fn resume_at(&mut self, scene_time_s: f64) {
        match &mut self.on {
            On::Cpu(cpu) => cpu.resume_at(scene_time_s),
            On::Gpu(gpu) => gpu.resume_at(scene_time_s),
        }
    }

    /// The state now.
    ///
    /// # Errors
    /// None, but for those of a CPU that has to take over.
    pub fn state(&mut self) -> Result<&YarnState, SimError> {
        self.go_on(|gpu| Ok(gpu.state().map(|_| ())?), |_| Ok(()))?;
        Ok(self.last_state())
    }

    /// The state as the CPU last had it: the one now, or on a GPU one of at most 0.05 s of simulated time before.
    pub fn last_state(&self) -> &YarnState {
        match &self.on {
            On::Cpu(cpu) => cpu.state(),
            On::Gpu(gpu) => gpu.last_state(),
        }
    }

    /// The yarns as they are drawn.
    ///
    /// # Errors
    /// As [`Self::state`].
    pub fn curves(&mut self) -> Result<YarnCurves, SimError> {
        self.go_on(|gpu| Ok(gpu.curves()?), |cpu| Ok(curves(cpu.net(), cpu.state(), cpu.materials())))
    }

    /// The yarns as they are drawn, on the device of the renderer; none where it is simulated elsewhere, or that is too much.
    ///
    /// # Errors
    /// As [`Self::state`].
    pub fn device_yarn(&mut self) -> Result<Option<DeviceYarn>, SimError> {
        self.go_on(|gpu| Ok(gpu.device_yarn()?), |_| Ok(None))
    }

    /// What there is to report of the simulation so far. Looks for the closest yarns, which takes about as long as a step.
    ///
    /// # Errors
    /// As [`Self::state`].
    pub fn facts(&mut self) -> Result<Facts, SimError> {
        self.go_on(|gpu| Ok(gpu.facts()?), |cpu| Ok(cpu.facts()))
    }

    /// Largest strain of a segment now, as in [`Facts`].
    ///
    /// # Errors
    /// As [`Self::state`].
    pub fn max_stretch(&mut self) -> Result<f64, SimError> {
        self.go_on(|gpu| Ok(gpu.max_stretch()?), |cpu| Ok(max_stretch(cpu.model(), cpu.state())))
    }

    /// What holds the fabric, or touches it, and how hard.
    pub fn holds(&self) -> Vec<HoldFact> {
        match &self.on {
            On::Cpu(cpu) => cpu.holds(),
            On::Gpu(gpu) => gpu.holds(),
        }
    }

    /// The net.
    pub fn net(&self) -> &Arc<YarnNet> {
        match &self.on {
            On::Cpu(cpu) => cpu.net(),
            On::Gpu(gpu) => gpu.net(),
        }
    }

    /// The materials of its yarns.
    pub fn materials(&self) -> &Materials {
        match &self.on {
            On::Cpu(cpu) => cpu.materials(),
            On::Gpu(gpu) => gpu.materials(),
        }
    }

    /// The scene.
    pub fn scene(&self) -> &Scene {
        match &self.on {
            On::Cpu(cpu) => cpu.scene(),
            On::Gpu(gpu) => gpu.scene(),
        }
    }

    /// How far it has come.
    pub fn progress(&self) -> &Progress {
        match &self.on {
            On::Cpu(cpu) => cpu.progress(),
            On::Gpu(gpu) => gpu.progress(),
        }
    }

    /// What solves it: "direct", "iterative" or "gpu".
    pub fn solver(&self) -> &'static str {
        match &self.on {
            On::Cpu(cpu) => match cpu.method() {
                Method::Direct => "direct",
                Method::Iterative => "iterative",
            },
            On::Gpu(_) => "gpu",
        }
    }

    /// The name of the GPU that it runs on.
    pub fn adapter(&self) -> Option<&str> {
        match &self.on {
            On::Cpu(_) => None,
            On::Gpu(gpu) => Some(gpu.adapter()),
        }
    }

    /// Why the GPU that was to simulate does not, or no longer.
    pub fn notice(&self) -> Option<&str> {
        self.notice.as_deref()
    }

    /// Measures from now on what steps cost. On a GPU that makes them a little slower: every stage is waited for.
    pub fn measure_costs(&mut self) {
        match &mut self.on {
            On::Cpu(cpu) => cpu.reset_costs(),
            On::Gpu(gpu) => gpu.measure_costs(),
        }
    }

    /// What its steps have cost since they began to be measured, or yarn was last cut.
    pub fn costs(&self) -> Costs {
        match &self.on {
            On::Cpu(cpu) => cpu.costs(),
            On::Gpu(gpu) => gpu.costs(),
        }
    }

    /// What it takes on the GPU [bytes].
    pub fn device_bytes(&self) -> u64 {
        match &self.on {
            On::Cpu(_) => 0,
            On::Gpu(gpu) => gpu.bytes(),
        }
    }
}

impl From<GpuSimulator> for Simulation {
    fn from(simulator: GpuSimulator) -> Self {
        Self { on: On::Gpu(Box::new(simulator)), choice: SolverChoice::Gpu, notice: None }
    }
}

impl Settles for Simulation {
    fn step(&mut self) -> Result<StepReport, SimError> {
        self.step()
    }

    fn progress(&self) -> &Progress {
        self.progress()
    }

    fn speed(&mut self) -> Result<f64, SimError> {
        self.go_on(|gpu| Ok(gpu.speed()?), Settles::speed)
    }
}

/// Whether the CPU may do better: the GPU failed, has no room for layers, or no complete factorisation to fall back on.
fn is_of_gpu(error: &SimError) -> bool {
    matches!(
        error,
        SimError::Gpu(_) | SimError::Stuck { cause: Rejection::Crowded | Rejection::Solve(_), .. }
    )
}

fn on_cpu_instead(error: &SimError, time_s: f64) -> String {
    let notice = match error {
        SimError::Gpu(GpuError::NoAdapter) => format!("{error}; simulating on the CPU"),
        _ => format!("{error}; going on on the CPU from {time_s:.2} s"),
    };
    tracing::warn!("{notice}");
    notice
}
