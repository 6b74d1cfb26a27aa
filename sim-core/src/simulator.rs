//! The simulator: a net, its state, and time going by.

use crate::costs::Costs;
use crate::energies::Energies;
use crate::facts::{self, Facts};
use crate::friction::Anchors;
use crate::gpu::GpuError;
use crate::handover::Handover;
use crate::local::LEAST_LENGTH;
use crate::material::MaterialError;
use crate::materials::Materials;
use crate::model::{Model, NetError};
use crate::progress::Progress;
use crate::scene::{Scene, SceneError};
use crate::settle::{SettleGoal, SettleProgress, Settled, Settles, settle};
use crate::solver::Method;
use crate::step::{Rejection, Stepper, Stuck};
use crate::surgery::slip::slipped;
use crate::surgery::{self, Operation, Surgery, SurgeryError};
use crate::take_in::TakeIn;
use glam::DVec3;
use std::ops::ControlFlow;
use std::sync::Arc;
use stitch_mesh::ids::{NodeId, VisitId};
use stitch_mesh::yarn_net::{YarnNet, YarnState};

/// Halvings of the time step before a simulation is given up; the last is a thousandth of the first.
pub(crate) const MOST_HALVINGS: i32 = 10;

/// Growth of the time step from step to step at the beginning and after it had to be halved. What made one fail lasts for a few: of a thousand random
/// swatches 2.1 steps in a hundred were taken again with 2.
pub(crate) const GROWTH: f64 = 1.4;

/// Why there is no simulation, or no further step of it.
#[derive(Clone, Debug, thiserror::Error)]
pub enum SimError {
    /// The net.
    #[error(transparent)]
    Net(#[from] NetError),
    /// The material.
    #[error(transparent)]
    Material(#[from] MaterialError),
    /// The scene.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// The state does not belong to the net.
    #[error(
        "the state has {positions} positions and {slidings} sliding coordinates, the net has {nodes} nodes and {visits} visits"
    )]
    StateShape {
        /// Positions in the state.
        positions: usize,
        /// Sliding coordinates in the state.
        slidings: usize,
        /// Nodes of the net.
        nodes: usize,
        /// Visits of the net.
        visits: usize,
    },
    /// The state has a number that is infinite or NaN.
    #[error("the state is not finite")]
    StateNotFinite,
    /// A yarn runs backwards or has no length between two visits of the state.
    #[error("the state leaves no yarn on segment {0}")]
    StateWithoutYarn(usize),
    /// The two ends of a segment are at the same place, so that it has no direction.
    #[error("nodes {} and {} follow each other on a yarn and are at the same place", .0[0], .0[1])]
    CoincidentNodes([NodeId; 2]),
    /// The operation.
    #[error(transparent)]
    Surgery(#[from] SurgeryError),
    /// The GPU.
    #[error(transparent)]
    Gpu(#[from] GpuError),
    /// No time step is small enough. The state is that of the last good step.
    #[error("stuck at {time_s:.3} s: even a step of {step_s:.1e} s fails, because {cause}")]
    Stuck {
        /// Simulated time [s].
        time_s: f64,
        /// The smallest step tried [s].
        step_s: f64,
        /// What was wrong with it.
        cause: Rejection,
    },
}

/// One step that went well.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepReport {
    /// Its length [s].
    pub time_step: f64,
    /// Attempts thrown away before.
    pub rejected: u64,
}

/// A simulation on the CPU. Owns all that it needs.
pub struct Simulator {
    stepper: Stepper,
    take_in: TakeIn,
    materials: Materials,
    scene: Scene,
    now: Stuck,
    /// Step to try next [s].
    step: f64,
    progress: Progress,
    /// None where the faster one is chosen.
    method: Option<Method>,
}

impl Simulator {
    /// A simulation of `net` from `state`, which may be its laid state. Yarns stick where they are.
    pub fn new(
        net: &Arc<YarnNet>,
        materials: impl Into<Materials>,
        scene: Scene,
        state: YarnState,
    ) -> Result<Self, SimError> {
        Ok(Self::resume(Handover::new(net, materials, scene, state)?, None))
    }

    /// Goes on with what another simulation has come to, solved by `method` or by the faster one.
    pub(crate) fn resume(from: Handover, method: Option<Method>) -> Self {
        let step = from.first_step();
        let Handover { model, take_in, materials, scene, state, progress } = from;
        let stepper = Stepper::new(model, &materials, method);
        let anchors = Anchors::at(&stepper.stacks, &state.sliding);
        Self { stepper, take_in, materials, scene, now: Stuck { state, anchors }, step, progress, method }
    }

    /// What another solver can go on with.
    pub(crate) fn handover(&self) -> Handover {
        Handover {
            model: self.stepper.model.clone(),
            take_in: self.take_in.clone(),
            materials: self.materials.clone(),
            scene: self.scene.clone(),
            state: self.now.state.clone(),
            progress: self.progress.clone(),
        }
    }

    /// Goes on by one step: of the scene's time step, or less where that goes wrong. After an error the state is
    /// that of the last good step.
    pub fn step(&mut self) -> Result<StepReport, SimError> {
        let smallest = self.scene.time_step * 0.5f64.powi(MOST_HALVINGS);
        let mut rejected = 0;
        let Stuck { state, anchors } = &mut self.now;
        let Stepper { model, stacks, .. } = &mut self.stepper;
        self.take_in.step(model, state, (stacks, anchors), self.step);
        loop {
            match self.stepper.step(&self.now, &self.scene, self.progress.scene_time_s, self.step) {
                Ok(next) => {
                    self.now = next;
                    let report = StepReport { time_step: self.step, rejected };
                    self.progress.add(self.step);
                    self.step = self.scene.time_step.min(GROWTH * self.step);
                    while let Some(operation) = slipped(self.net(), self.state(), &self.materials) {
                        self.operate(operation)?;
                    }
                    return Ok(report);
                }
                Err(cause) => {
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

    /// Changes the net while it is simulated. Pins on nodes that go are dropped. Nothing has changed after an error.
    pub fn operate(&mut self, operation: Operation) -> Result<(), SimError> {
        let done = surgery::operate(self.net(), self.state(), &operation)?;
        let model = model_after(self.net(), Arc::new(done.net), &done.state, &done.was)?;
        let stepper = Stepper::new(model, &self.materials, self.method);
        let anchors = self.now.anchors.carried(&stepper.stacks, &done.was, &done.state.sliding);
        self.progress.surgery.add(operation, self.state().taken_in);
        self.stepper = stepper;
        self.take_in = TakeIn::default();
        self.now = Stuck { state: done.state, anchors };
        self.scene.follow(&done.node);
        Ok(())
    }

    /// What has been done to the net, and has happened to it, since this simulation began.
    pub fn surgery(&self) -> &Surgery {
        &self.progress.surgery
    }

    /// Steps until the fabric is as good as still, the time limit, or until `progress` breaks off.
    pub fn settle(
        &mut self,
        goal: SettleGoal,
        progress: &mut dyn FnMut(SettleProgress) -> ControlFlow<()>,
    ) -> Result<Settled, SimError> {
        settle(self, goal, progress)
    }

    /// The net.
    pub fn net(&self) -> &Arc<YarnNet> {
        &self.stepper.model.net
    }

    /// The elements of the net.
    pub fn model(&self) -> &Model {
        &self.stepper.model
    }

    /// The state now.
    pub fn state(&self) -> &YarnState {
        &self.now.state
    }

    /// The materials of its yarns.
    pub fn materials(&self) -> &Materials {
        &self.materials
    }

    /// The scene.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// How far it has come.
    pub fn progress(&self) -> &Progress {
        &self.progress
    }

    /// Simulated time [s].
    pub fn time_s(&self) -> f64 {
        self.progress.time_s
    }

    /// Time since the scene began, by which bodies and clamps move [s].
    pub fn scene_time_s(&self) -> f64 {
        self.progress.scene_time_s
    }

    /// Goes on at a time of the scene: for a fabric that was edited while things moved [s].
    pub fn resume_at(&mut self, scene_time_s: f64) {
        self.progress.scene_time_s = scene_time_s;
    }

    /// Force of each body of the last step's scene on the fabric; none before the first step [N].
    pub(crate) fn body_forces(&self) -> &[DVec3] {
        &self.stepper.body_forces
    }

    /// Changes gravity, bodies, pins or time step; refused as a whole if anything in it makes no sense. What moves begins anew,
    /// unless all of it moves as before.
    pub fn set_scene(&mut self, scene: Scene) -> Result<(), SimError> {
        scene.validate(self.net().nodes.len())?;
        self.step = scene.time_step;
        if !scene.moves_like(&self.scene) {
            self.progress.scene_time_s = 0.0;
        }
        self.scene = scene;
        Ok(())
    }

    /// Changes the materials; refused as a whole if anything in them makes no sense.
    pub fn set_materials(&mut self, materials: impl Into<Materials>) -> Result<(), SimError> {
        let materials = materials.into();
        materials.validate()?;
        self.stepper.set_materials(&materials);
        self.materials = materials;
        Ok(())
    }

    /// The energies of the yarn.
    pub fn energies(&self) -> Energies {
        let Stuck { state, anchors } = &self.now;
        let Stepper { model, stacks, .. } = &self.stepper;
        let yarns = model.resolve(&self.materials);
        let stick = |v: VisitId| yarns[model.dye_of[v.index()] as usize].friction_stiffness;
        let sticking = anchors.energy(stacks, &state.sliding, stick);
        Energies { sticking, ..model.energies(&self.materials, state) }
    }

    /// Kinetic energy [J].
    pub fn kinetic_energy(&self) -> f64 {
        self.stepper.model.kinetic_energy(&self.materials, self.state())
    }

    /// How the systems of its steps are solved.
    pub fn method(&self) -> Method {
        self.stepper.solver.method()
    }

    /// What its steps have cost since it began or yarn was last cut.
    pub fn costs(&self) -> Costs {
        self.stepper.costs
    }

    /// Counts what its steps cost from now on.
    pub fn reset_costs(&mut self) {
        self.stepper.costs = Costs::default();
    }

    /// What there is to report of the simulation so far. Looks for the closest yarns, which takes about as long as a step.
    pub fn facts(&self) -> Facts {
        Facts {
            solver: "cpu".to_owned(),
            steps: self.progress.steps,
            time_s: self.progress.time_s,
            kinetic_j: self.kinetic_energy(),
            holds: self.holds(),
            rejected_steps: self.progress.rejected,
            ..facts::measure(
                &self.stepper.model,
                &self.materials,
                (&self.scene, self.progress.scene_time_s),
                self.state(),
            )
        }
    }
}

impl Settles for Simulator {
    fn step(&mut self) -> Result<StepReport, SimError> {
        self.step()
    }

    fn progress(&self) -> &Progress {
        &self.progress
    }

    fn speed(&mut self) -> Result<f64, SimError> {
        Ok(self.stepper.model.speed(&self.materials, self.state()))
    }
}

/// The elements of a net that has been made of another, whose new bends are eased; `was` tells which visit each one was.
pub(crate) fn model_after(
    before: &YarnNet,
    net: Arc<YarnNet>,
    state: &YarnState,
    was: &[Option<(VisitId, f64)>],
) -> Result<Model, SimError> {
    let mut model = Model::new(net)?;
    check_state(&model, state)?;
    model.ease(state, |visits| {
        let was = visits.map(|v| was[v.index()].map(|(old, _)| old));
        let followed = |a: Option<VisitId>, b| a.is_some() && a.and_then(|a| before.next(a)) == b;
        !(followed(was[0], was[1]) && followed(was[1], was[2]))
    });
    Ok(model)
}

pub(crate) fn check_state(model: &Model, state: &YarnState) -> Result<(), SimError> {
    let net = &model.net;
    if !state.fits(net) {
        return Err(SimError::StateShape {
            positions: state.position.len(),
            slidings: state.sliding.len(),
            nodes: net.nodes.len(),
            visits: net.visits.len(),
        });
    }
    if !state.is_finite() {
        return Err(SimError::StateNotFinite);
    }
    let yarn = |q: [f64; 8]| q[7] - q[3];
    if let Some(segment) = model.segments.iter().position(|s| yarn(s.stencil.coordinates(state)) <= 0.0) {
        return Err(SimError::StateWithoutYarn(segment));
    }
    let apart = |nodes: [NodeId; 2]| {
        let [a, b] = nodes.map(|n| state.position[n.index()]);
        a.distance(b) > LEAST_LENGTH
    };
    match model.segments.iter().map(|s| s.stencil.nodes).find(|nodes| !apart(*nodes)) {
        Some(nodes) => Err(SimError::CoincidentNodes(nodes)),
        None => Ok(()),
    }
}
