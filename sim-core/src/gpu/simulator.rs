//! The simulator on the GPU: what `simulator.rs` does on the CPU.

use super::GpuError;
use super::constants::{NONE, REJECTED_LEAPING, REJECTED_SHRINKING};
use super::device::GpuDevice;
use super::drawn::Drawn;
use super::kernel::Kernels;
use super::layout::{Params, Status};
use super::pattern::Room;
use super::shift::Shift;
use super::surroundings::fit;
use super::system::{System, Verdict};
use super::tables::Tables;
use crate::costs::Costs;
use crate::friction::{Anchors, Stack};
use crate::handover::Handover;
use crate::material::Material;
use crate::materials::Materials;
use crate::model::{Model, SegmentTerm};
use crate::overshoot::{far, most_left};
use crate::progress::Progress;
use crate::scene::Scene;
use crate::simulator::{GROWTH, MOST_HALVINGS, SimError, StepReport, model_after};
use crate::solver::{SolveError, TOLERANCE};
use crate::step::Rejection;
use crate::surgery::{self, Operation, slip};
use crate::surroundings::stiffness_by_mass;
use crate::take_in::TakeIn;
use glam::DVec3;
use std::sync::Arc;
use stitch_mesh::yarn_net::{NodeKind, YarnNet, YarnState};

/// Iterations of conjugate gradients recorded beyond those that the last step took, so that most steps are one submission.
const SPARE_ITERATIONS: u32 = 4;

/// Iterations that are recorded in any case, but for the spare ones.
const LEAST_ITERATIONS: u32 = 4;

/// Iterations after which a step is given up, or tried with another shift.
const MOST_ITERATIONS: u32 = 300;

/// Simulated time between two states that are read back in any case, to go on from should the GPU be lost [s].
const KEEP: f64 = 0.05;

/// A simulation on the GPU.
pub struct GpuSimulator {
    pub(super) system: System,
    pub(super) model: Model,
    pub(super) take_in: TakeIn,
    pub(super) materials: Materials,
    pub(super) scene: Scene,
    pub(super) origin: DVec3,
    mass_damping: f64,
    /// Part of what is taken in that has been.
    pub(super) taken_in: f64,
    /// Meshes among the bodies, and where each one's distances begin.
    pub(super) fields: Vec<(usize, u32)>,
    pub(super) step: f64,
    pub(super) progress: Progress,
    pub(super) iterations: u32,
    shift: Shift,
    /// What the steps have cost; none where nobody wants to know.
    pub(super) costs: Option<Costs>,
    /// What lays out the yarn for a renderer, once one wants it; none where it can't.
    pub(super) drawn: Option<Option<Drawn>>,
    /// The state as last read back.
    pub(super) state: YarnState,
    pub(super) is_read: bool,
    /// How far the simulation had come then.
    pub(super) read_at: Progress,
}

impl GpuSimulator {
    /// A simulation of `net` from `state` on `gpu`. Yarns stick where they are.
    ///
    /// # Errors
    /// What can't be simulated at all, and what the GPU can't.
    pub fn new(
        gpu: &GpuDevice,
        net: &Arc<YarnNet>,
        materials: impl Into<Materials>,
        scene: Scene,
        state: YarnState,
    ) -> Result<Self, SimError> {
        Self::resume(gpu, Handover::new(net, materials, scene, state)?)
    }

    /// Goes on with what another simulation has come to.
    pub(crate) fn resume(gpu: &GpuDevice, from: Handover) -> Result<Self, SimError> {
        Self::with(gpu, gpu.kernels()?, Room::on(gpu), from)
    }

    /// The same with other kernels, and other room.
    pub(crate) fn with(
        gpu: &GpuDevice,
        kernels: Kernels,
        room: Room,
        from: Handover,
    ) -> Result<Self, SimError> {
        let step = from.first_step();
        let Handover { model, take_in, materials, scene, state, progress } = from;
        fit(&scene)?;
        let origin = state.position.iter().sum::<DVec3>() / state.position.len().max(1) as f64;
        // What has been taken in stands in the tables beside the turns.
        let mut laid = model.clone();
        take_in.shorten_turns(&mut laid, -state.taken_in);
        let tables = Tables::new(&laid, &materials, &take_in, origin, room)?;
        let mut simulator = Self {
            system: System::new(gpu, kernels, tables, &model.resolve(&materials))?,
            take_in,
            origin,
            mass_damping: mass_damping(&model, &materials),
            model,
            materials,
            taken_in: state.taken_in,
            fields: Vec::new(),
            step,
            scene,
            read_at: progress.clone(),
            progress,
            iterations: 16,
            shift: Shift::default(),
            costs: None,
            drawn: None,
            state,
            is_read: true,
        };
        let anchors = Anchors::at(&Stack::all(&simulator.model.net), &simulator.state.sliding);
        simulator.upload_state(&anchors);
        simulator.upload_fields()?;
        Ok(simulator)
    }

    /// Goes on by one step: of the scene's time step, or less where that goes wrong. After an error the state is that of the
    /// last good step.
    ///
    /// # Errors
    /// No time step is small enough, or the GPU fails.
    pub fn step(&mut self) -> Result<StepReport, SimError> {
        let smallest = self.scene.time_step * 0.5f64.powi(MOST_HALVINGS);
        self.take_in()?;
        let mut rejected = 0;
        loop {
            match self.attempt()? {
                None => {
                    let report = StepReport { time_step: self.step, rejected };
                    self.progress.add(self.step);
                    self.step = self.scene.time_step.min(GROWTH * self.step);
                    while let Some(operation) = self.slipped()? {
                        self.operate(operation)?;
                    }
                    return Ok(report);
                }
                Some(cause) => {
                    rejected += 1;
                    self.progress.rejected += 1;
                    tracing::debug!(time_s = self.progress.time_s, step_s = self.step, %cause, "step rejected");
                    if self.step <= smallest {
                        let step_s = self.step;
                        self.step = self.scene.time_step;
                        return Err(SimError::Stuck { time_s: self.progress.time_s, step_s, cause });
                    }
                    self.step *= 0.5;
                }
            }
        }
    }

    /// Takes in as much as a step does, on the CPU: it goes along whole yarns, and is soon over.
    fn take_in(&mut self) -> Result<(), GpuError> {
        if self.take_in.is_over(self.taken_in) {
            return Ok(());
        }
        self.state()?;
        let mut anchors = self.anchors()?;
        let stacks = Stack::all(&self.model.net);
        self.take_in.step(&mut self.model, &mut self.state, (&stacks, &mut anchors), self.step);
        self.taken_in = self.state.taken_in;
        self.upload_state(&anchors);
        Ok(())
    }

    /// What has slipped out in the state now; only yarn that is loose somewhere, or a loop that nothing holds, can.
    fn slipped(&mut self) -> Result<Option<Operation>, GpuError> {
        let net = Arc::clone(&self.model.net);
        let may = net.nodes.iter().any(|n| n.kind == NodeKind::Loose) || slip::unheld(&net).next().is_some();
        if !may {
            return Ok(None);
        }
        self.state()?;
        Ok(slip::slipped(&net, &self.state, &self.materials))
    }

    /// Changes the net while it is simulated, as on the CPU, and puts the new one on the device. Nothing has changed after an
    /// error.
    ///
    /// # Errors
    /// The net has no such yarn, or the GPU fails.
    pub fn operate(&mut self, operation: Operation) -> Result<(), SimError> {
        let before = self.state()?.clone();
        let anchors = self.anchors()?;
        let done = surgery::operate(&self.model.net, &before, &operation)?;
        let net = Arc::new(done.net);
        let model = model_after(&self.model.net, Arc::clone(&net), &done.state, &done.was)?;
        let take_in = TakeIn::default();
        let gpu = self.system.gpu.clone();
        let tables = Tables::new(&model, &self.materials, &take_in, self.origin, Room::on(&gpu))?;
        let kernels = gpu.kernels()?;
        self.system = System::new(&gpu, kernels, tables, &model.resolve(&self.materials))?;
        self.progress.surgery.add(operation, self.taken_in);
        (self.model, self.take_in, self.state) = (model, take_in, done.state);
        self.mass_damping = mass_damping(&self.model, &self.materials);
        let anchors = anchors.carried(&Stack::all(&net), &done.was, &self.state.sliding);
        self.upload_state(&anchors);
        self.read_at = self.progress.clone();
        self.drawn = None;
        self.scene.follow(&done.node);
        self.upload_fields()
    }

    /// One attempt at a step, and why it was thrown away if it was.
    fn attempt(&mut self) -> Result<Option<Rejection>, GpuError> {
        self.place_surroundings()?;
        self.is_read = false;
        let mut verdict = self.solve()?;
        if !self.system.tables.pattern.is_complete {
            while verdict.status.solved != 1 && self.shift.failed() {
                verdict = self.solve()?;
            }
            if verdict.status.solved == 1 {
                self.shift.solved_in(verdict.iterations());
            }
        }
        Ok(self.rejection(&verdict))
    }

    /// Why a step has to be thrown away, if it has.
    fn rejection(&self, verdict: &Verdict) -> Option<Rejection> {
        if !self.system.had_room(verdict) {
            return Some(Rejection::Crowded);
        }
        if verdict.status.solved != 1 {
            return Some(Rejection::Solve(SolveError::NotConverged));
        }
        let (segment, left) = ((verdict.worst / 4) as usize, verdict.left as usize);
        match (verdict.worst, verdict.worst % 4) {
            (NONE, _) => {
                (left > most_left(self.model.segments.len())).then_some(Rejection::Overshooting(left))
            }
            (_, REJECTED_SHRINKING) => Some(Rejection::Shrinking(segment)),
            (_, REJECTED_LEAPING) => Some(Rejection::Leaping(segment)),
            _ => Some(Rejection::NotFinite),
        }
    }

    /// A step with the shift that there is, whether or not it may follow.
    fn solve(&mut self) -> Result<Verdict, GpuError> {
        let mut recorded = self.iterations + SPARE_ITERATIONS;
        let params = self.params(self.step);
        let mut verdict = self.system.step(params, recorded, self.costs.as_mut())?;
        while verdict.status.solved == 0 && recorded < MOST_ITERATIONS {
            let more = recorded.min(MOST_ITERATIONS - recorded);
            recorded += more;
            verdict = self.system.go_on(more, self.costs.as_mut())?;
        }
        let iterations = verdict.iterations();
        self.iterations = iterations.max(LEAST_ITERATIONS);
        if let Some(costs) = &mut self.costs {
            costs.attempts += 1;
            costs.iterations += u64::from(iterations);
            let Status { error, goal, .. } = verdict.status;
            costs.residual = TOLERANCE * f64::from(error / goal.max(f32::MIN_POSITIVE)).sqrt();
        }
        Ok(verdict)
    }

    /// What is the same for all elements in a step of `h`.
    pub(crate) fn params(&self, h: f64) -> Params {
        let Scene { gravity, air, bodies, pins, clamps, .. } = &self.scene;
        let [gravity, origin] = [gravity.as_vec3(), self.origin.as_vec3()];
        let widest = self.system.tables.nodes.iter().map(|n| n.clearance).fold(0.0, f32::max);
        let is_free = pins.is_empty() && clamps.iter().all(|c| c.nodes.is_empty()) && *air == 0.0;
        self.system.sized(Params {
            h: h as f32,
            stiffness_by_mass: stiffness_by_mass(&self.scene) as f32,
            gravity_x: gravity.x,
            gravity_y: gravity.y,
            gravity_z: gravity.z,
            origin_x: origin.x,
            origin_y: origin.y,
            origin_z: origin.z,
            air: *air as f32,
            taken_in: self.taken_in as f32,
            mass_damping: self.mass_damping as f32,
            is_free: u32::from(is_free),
            tolerance: (TOLERANCE * TOLERANCE) as f32,
            shift: self.shift.part(),
            body_count: bodies.len() as u32,
            touching: 2.0 * widest,
            far: far(self.model.segments.len()) as f32,
            most_left: most_left(self.model.segments.len()) as u32,
            ..Params::default()
        })
    }

    /// Changes the materials; refused as a whole if anything in them makes no sense.
    ///
    /// # Errors
    /// A material that no yarn has.
    pub fn set_materials(&mut self, materials: impl Into<Materials>) -> Result<(), SimError> {
        let materials = materials.into();
        materials.validate()?;
        self.system.tables.set_materials(&self.model, &materials);
        self.system.set_materials(&self.model.resolve(&materials));
        self.mass_damping = mass_damping(&self.model, &materials);
        self.materials = materials;
        self.drawn = None;
        Ok(())
    }

    /// The state that was last read back: what the CPU can go on from when the GPU is lost.
    pub fn last_state(&self) -> &YarnState {
        &self.state
    }

    /// Reads the state back if that has not been done for a while.
    ///
    /// # Errors
    /// The GPU fails.
    pub fn keep(&mut self) -> Result<(), GpuError> {
        if self.progress.time_s - self.read_at.time_s >= KEEP {
            self.state()?;
        }
        Ok(())
    }

    /// What another solver can go on with, from the state that was last read back.
    pub(crate) fn handover(&self) -> Handover {
        let mut model = self.model.clone();
        self.take_in.shorten_turns(&mut model, self.state.taken_in - self.taken_in);
        Handover {
            model,
            take_in: self.take_in.clone(),
            materials: self.materials.clone(),
            scene: self.scene.clone(),
            state: self.state.clone(),
            progress: self.read_at.clone(),
        }
    }

    /// Goes on at a time of the scene [s].
    pub fn resume_at(&mut self, scene_time_s: f64) {
        self.progress.scene_time_s = scene_time_s;
        self.read_at.scene_time_s = scene_time_s;
    }

    #[cfg(test)]
    pub(crate) fn origin(&self) -> DVec3 {
        self.origin
    }

    #[cfg(test)]
    pub(crate) fn system(&self) -> &System {
        &self.system
    }
}

/// α of the whole fabric: that of its yarns by their mass [1/s].
fn mass_damping(model: &Model, materials: &Materials) -> f64 {
    let yarns: Vec<Material> = model.resolve(materials);
    let mass = |s: &SegmentTerm| yarns[s.dye as usize].density * s.rest;
    let sum = |of: &dyn Fn(&SegmentTerm) -> f64| model.segments.iter().map(of).sum::<f64>();
    sum(&|s| mass(s) * yarns[s.dye as usize].mass_damping) / sum(&mass)
}
