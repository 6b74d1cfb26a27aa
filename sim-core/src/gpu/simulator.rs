//! The simulator on the GPU: what `simulator.rs` does on the CPU.

use super::GpuError;
use super::device::{GpuDevice, LIMITS};
use super::kernel::Kernels;
use super::layout::{
    Body as BodyRecord, NONE, Params, Pin as PinRecord, REJECTED_LEAPING, REJECTED_SHRINKING,
};
use super::system::{System, Verdict};
use super::tables::Tables;
use crate::body::Body;
use crate::curves::string_together;
use crate::facts::{self, Facts};
use crate::friction::{Anchors, Stack};
use crate::material::Material;
use crate::materials::Materials;
use crate::model::{FROZEN, Model, SegmentTerm};
use crate::noise::unit_hash;
use crate::scene::Scene;
use crate::simulator::{GROWTH, MOST_HALVINGS, NOISE, SimError, StepReport, check_state, model_after};
use crate::solver::{SolveError, TOLERANCE};
use crate::step::Rejection;
use crate::surgery::{self, Operation, Surgery, slip};
use crate::take_in::{TIME, TakeIn};
use glam::{DQuat, DVec3};
use std::collections::{BTreeMap, HashMap};
use std::sync::Arc;
use stitch_mesh::yarn_curves::YarnCurves;
use stitch_mesh::yarn_net::{NodeKind, YarnNet, YarnState};

/// Iterations of conjugate gradients recorded beyond those that the last step took, so that most steps are one submission.
const SPARE_ITERATIONS: u32 = 4;

/// Iterations after which a step is given up.
const MOST_ITERATIONS: u32 = 300;

/// Simulated time between two states that are read back in any case, to go on from should the GPU be lost [s].
const KEEP: f64 = 0.05;

/// A simulation on the GPU.
pub struct GpuSimulator {
    system: System,
    model: Model,
    take_in: TakeIn,
    materials: Materials,
    scene: Scene,
    origin: DVec3,
    mass_damping: f64,
    /// Part of what is taken in that has been.
    taken_in: f64,
    /// Meshes among the bodies, and where each one's distances begin.
    fields: Vec<(usize, u32)>,
    step: f64,
    time: f64,
    scene_time: f64,
    steps: u64,
    rejected: u64,
    iterations: u32,
    surgery: Surgery,
    /// The state as last read back.
    state: YarnState,
    is_read: bool,
    /// Simulated time when it was [s].
    read_at: f64,
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
        let most = LIMITS.max_storage_buffer_binding_size / 4;
        Self::with(gpu, gpu.kernels()?, most, net, materials.into(), scene, state)
    }

    /// The same with other kernels, and another limit to the numbers in a binding.
    pub(crate) fn with(
        gpu: &GpuDevice,
        kernels: Kernels,
        most: u64,
        net: &Arc<YarnNet>,
        materials: Materials,
        scene: Scene,
        mut state: YarnState,
    ) -> Result<Self, SimError> {
        materials.validate()?;
        scene.validate(net.nodes.len())?;
        let mut model = Model::new(Arc::clone(net))?;
        let take_in = TakeIn::new(net);
        take_in.shorten_turns(&mut model, state.taken_in);
        check_state(&model, &state)?;
        for (i, x) in state.position.iter_mut().enumerate() {
            let noise = |k: usize| NOISE * (unit_hash((3 * i + k) as u64) - 0.5);
            *x += DVec3::new(noise(0), noise(1), noise(2));
        }
        let origin = state.position.iter().sum::<DVec3>() / state.position.len().max(1) as f64;
        let tables = Tables::new(&Model::new(Arc::clone(net))?, &materials, &take_in, origin, most)?;
        let system = System::new(gpu, kernels, tables, &model.resolve(&materials), net.visits.len())?;
        let mut simulator = Self {
            system,
            take_in,
            scene: Scene::default(),
            origin,
            mass_damping: mass_damping(&model, &materials),
            model,
            materials,
            taken_in: state.taken_in,
            fields: Vec::new(),
            step: scene.time_step,
            time: 0.0,
            scene_time: 0.0,
            steps: 0,
            rejected: 0,
            iterations: 16,
            surgery: Surgery::default(),
            state,
            is_read: true,
            read_at: 0.0,
        };
        let anchors = Anchors::at(&Stack::all(net), &simulator.state.sliding);
        simulator.upload_state(&anchors);
        simulator.set_scene(scene)?;
        Ok(simulator)
    }

    /// Goes on by one step: of the scene's time step, or less where that goes wrong. After an error the state is that of the
    /// last good step.
    ///
    /// # Errors
    /// No time step is small enough, or the GPU fails.
    pub fn step(&mut self) -> Result<StepReport, SimError> {
        let smallest = self.scene.time_step * 0.5f64.powi(MOST_HALVINGS);
        let part = (self.step / TIME).min(1.0 - self.taken_in).max(0.0);
        self.taken_in += part;
        self.take_in.shorten_turns(&mut self.model, part);
        let mut rejected = 0;
        loop {
            match self.attempt()? {
                None => {
                    let report = StepReport { time_step: self.step, rejected };
                    self.time += self.step;
                    self.scene_time += self.step;
                    self.steps += 1;
                    self.step = self.scene.time_step.min(GROWTH * self.step);
                    while let Some(operation) = self.slipped()? {
                        self.operate(operation)?;
                    }
                    return Ok(report);
                }
                Some(cause) => {
                    rejected += 1;
                    self.rejected += 1;
                    tracing::debug!(time_s = self.time, step_s = self.step, %cause, "step rejected");
                    if self.step <= smallest {
                        let step_s = self.step;
                        self.step = self.scene.time_step;
                        return Err(SimError::Stuck { time_s: self.time, step_s, cause });
                    }
                    self.step *= 0.5;
                }
            }
        }
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
        let most = LIMITS.max_storage_buffer_binding_size / 4;
        let tables = Tables::new(&model, &self.materials, &take_in, self.origin, most)?;
        let gpu = self.system.gpu.clone();
        let kernels = gpu.kernels()?;
        self.system = System::new(&gpu, kernels, tables, &model.resolve(&self.materials), net.visits.len())?;
        self.surgery.add(operation, self.taken_in);
        (self.model, self.take_in, self.state) = (model, take_in, done.state);
        self.mass_damping = mass_damping(&self.model, &self.materials);
        let anchors = anchors.carried(&Stack::all(&net), &done.was, &self.state.sliding);
        self.upload_state(&anchors);
        let (mut scene, step) = (self.scene.clone(), self.step);
        scene.follow(&done.node);
        self.set_scene(scene)?;
        self.step = step;
        Ok(())
    }

    /// Where yarns stick now.
    fn anchors(&self) -> Result<Anchors, GpuError> {
        let [visits] = self.system.read(["visits"])?;
        let own = |v: usize| self.unslid(v) + f64::from(visits[4 * v + 2]);
        let mut anchors = Anchors {
            own: (0..self.state.sliding.len()).map(own).collect(),
            between: vec![0.0; self.state.sliding.len()],
        };
        for pair in self.model.net.nodes.iter().flat_map(|n| n.visits.windows(2)) {
            let [a, b] = [pair[0].index(), pair[1].index()];
            anchors.between[a] = self.unslid(a) - self.unslid(b) + f64::from(visits[4 * a + 3]);
        }
        Ok(anchors)
    }

    /// One attempt at a step, and why it was thrown away if it was.
    fn attempt(&mut self) -> Result<Option<Rejection>, GpuError> {
        self.place_surroundings()?;
        let params = self.params(self.step);
        let mut recorded = self.iterations + SPARE_ITERATIONS;
        self.is_read = false;
        let mut verdict = self.system.step(params, recorded)?;
        while verdict.status.solved == 0 && recorded < MOST_ITERATIONS {
            let more = recorded.min(MOST_ITERATIONS - recorded);
            recorded += more;
            verdict = self.system.go_on(more)?;
        }
        // The first look at the error counts as one.
        self.iterations = verdict.status.iterations.saturating_sub(1).max(4);
        Ok(if self.system.had_room(&verdict) { rejection(&verdict) } else { Some(Rejection::Crowded) })
    }

    /// What is the same for all elements in a step of `h`.
    pub(crate) fn params(&self, h: f64) -> Params {
        let Scene { gravity, air, time_step, bodies, pins, clamps, .. } = &self.scene;
        let [gravity, origin] = [gravity.as_vec3(), self.origin.as_vec3()];
        let widest = self.system.tables.nodes.iter().map(|n| n.clearance).fold(0.0, f32::max);
        let is_free = pins.is_empty() && clamps.iter().all(|c| c.nodes.is_empty()) && *air == 0.0;
        self.system.sized(Params {
            h: h as f32,
            scene_step: *time_step as f32,
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
            body_count: bodies.len() as u32,
            touching: 2.0 * widest,
            ..Params::default()
        })
    }

    /// Puts bodies and springs where they are at the end of the step.
    pub(crate) fn place_surroundings(&mut self) -> Result<(), GpuError> {
        let end = self.scene_time + self.step;
        let mut springs: BTreeMap<u32, (f64, DVec3)> = BTreeMap::new();
        let clamped = self.scene.clamps.iter().flat_map(|c| c.pins(end));
        for pin in self.scene.pins.iter().copied().chain(clamped) {
            // Springs on one node are one spring.
            let (stiffness, pull) = springs.entry(pin.node).or_default();
            *stiffness += pin.stiffness;
            *pull += pin.stiffness * (pin.target - self.origin);
        }
        let pin = |(node, (stiffness, pull)): (&u32, &(f64, DVec3))| {
            let target = (*pull / stiffness.max(f64::MIN_POSITIVE)).as_vec3();
            let node = self.system.tables.pattern.new[*node as usize];
            PinRecord { node, stiffness: *stiffness as f32, x: target.x, y: target.y, z: target.z }
        };
        let pins: Vec<PinRecord> = springs.iter().map(pin).collect();
        let bodies: Vec<BodyRecord> = (0..self.scene.bodies.len()).map(|b| self.body(b)).collect();
        self.system.set_surroundings(&bodies, None, &pins, pins.len() as u32)
    }

    /// A body of the scene during the step to come.
    fn body(&self, index: usize) -> BodyRecord {
        let body = &self.scene.bodies[index];
        let poses = [self.scene_time, self.scene_time + self.step].map(|t| body.pose(t));
        let shift = poses.map(|pose| (pose.apply(self.origin) - self.origin).as_vec3());
        let turn = poses.map(|pose| pose.rotation().as_quat());
        let mut record = BodyRecord {
            friction: body.friction() as f32,
            moves: u32::from(body.motion().is_some()),
            turn_w: 1.0,
            ..BodyRecord::default()
        };
        (record.from_x, record.from_y, record.from_z, record.from_w) = turn[0].into();
        (record.to_x, record.to_y, record.to_z, record.to_w) = turn[1].into();
        (record.from_shift_x, record.from_shift_y, record.from_shift_z) = shift[0].into();
        (record.to_shift_x, record.to_shift_y, record.to_shift_z) = shift[1].into();
        let mut place = |a: DVec3, b: DVec3, size: f64| {
            (record.a_x, record.a_y, record.a_z) = (a - self.origin).as_vec3().into();
            (record.b_x, record.b_y, record.b_z) = b.as_vec3().into();
            record.size = size as f32;
        };
        let resting = match body {
            Body::Moving { body, .. } => &**body,
            resting => resting,
        };
        match resting {
            Body::Ground { height, .. } => place(*height * DVec3::Y, DVec3::ZERO, 0.0),
            Body::Sphere { center, radius, .. } => {
                place(*center, DVec3::ZERO, *radius);
                record.kind = 1;
            }
            Body::Capsule { from, to, radius, .. } => {
                place(*from, *to - self.origin, *radius);
                record.kind = 2;
            }
            Body::Box { center, size, turn, .. } => {
                place(*center, *size, 0.0);
                record.kind = 3;
                let turn = DQuat::from_scaled_axis(*turn).as_quat();
                (record.turn_x, record.turn_y, record.turn_z, record.turn_w) = turn.into();
            }
            Body::Mesh { mesh, .. } => {
                let (low, cell, corners, _) = mesh.grid();
                place(low, DVec3::ZERO, cell);
                record.kind = 4;
                (record.corners_x, record.corners_y, record.corners_z) = corners.into();
                record.field = self.fields.iter().find(|(b, _)| *b == index).map_or(0, |(_, field)| *field);
            }
            // Refused by `set_scene`.
            Body::Sequence { .. } | Body::Moving { .. } => {}
        }
        record
    }

    /// Changes gravity, bodies, pins or time step; refused as a whole if anything in it makes no sense. What moves begins anew,
    /// unless all of it moves as before.
    ///
    /// # Errors
    /// A scene that makes no sense, or distances of meshes that the GPU has no place for.
    pub fn set_scene(&mut self, scene: Scene) -> Result<(), SimError> {
        scene.validate(self.model.net.nodes.len())?;
        let mut distances: Vec<f32> = Vec::new();
        let mut fields = Vec::new();
        for (index, body) in scene.bodies.iter().enumerate() {
            let resting = match body {
                Body::Moving { body, .. } => &**body,
                resting => resting,
            };
            if let Body::Sequence { .. } = resting {
                return Err(GpuError::Unsupported(format!("body {index} changes its shape")).into());
            }
            if let Body::Mesh { mesh, .. } = resting {
                fields.push((index, distances.len() as u32));
                distances.extend(mesh.grid().3);
            }
        }
        if 4 * distances.len() as u64 > LIMITS.max_storage_buffer_binding_size {
            return Err(
                GpuError::Unsupported("the meshes of the scene have too large a grid".to_owned()).into()
            );
        }
        self.step = scene.time_step;
        if !scene.moves_like(&self.scene) {
            self.scene_time = 0.0;
        }
        self.scene = scene;
        self.fields = fields;
        let bodies = vec![BodyRecord::default(); self.scene.bodies.len()];
        self.system.set_surroundings(&bodies, Some(&distances), &[], 0)?;
        Ok(())
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
        Ok(())
    }

    /// Writes the whole state to the device: positions about the origin, sliding from what is laid, anchors where yarns are.
    fn upload_state(&self, anchors: &Anchors) {
        let Self { state, system, .. } = self;
        let pattern = &system.tables.pattern;
        let four = |v: DVec3| v.as_vec3().extend(0.0).to_array();
        let position: Vec<[f32; 4]> =
            pattern.old.iter().map(|n| four(state.position[*n as usize] - self.origin)).collect();
        let velocity: Vec<[f32; 4]> = pattern.old.iter().map(|n| four(state.velocity[*n as usize])).collect();
        let slide = |v: usize| (state.sliding[v] - self.unslid(v)) as f32;
        let mut visits: Vec<[f32; 4]> = (0..state.sliding.len())
            .map(|v| {
                let frozen = self.model.sliding[v] == FROZEN;
                let rate = if frozen { 0.0 } else { state.sliding_velocity[v] as f32 };
                [slide(v), rate, (anchors.own[v] - self.unslid(v)) as f32, 0.0]
            })
            .collect();
        for node in &self.model.net.nodes {
            for pair in node.visits.windows(2) {
                let [a, b] = [pair[0].index(), pair[1].index()];
                visits[a][3] = (anchors.between[a] - self.unslid(a) + self.unslid(b)) as f32;
            }
        }
        system.write("position", &position);
        system.write("velocity", &velocity);
        system.write("visits", &visits);
    }

    /// Sliding coordinate of a visit that has not slid [m].
    fn unslid(&self, visit: usize) -> f64 {
        let id = stitch_mesh::ids::VisitId::new(visit);
        self.model.net.visits[visit].u - self.taken_in * self.take_in.total(id)
    }

    /// The state now, read back from the device if it has changed since it last was.
    ///
    /// # Errors
    /// The GPU fails; [`Self::last_state`] is that of the last good read.
    pub fn state(&mut self) -> Result<&YarnState, GpuError> {
        if !self.is_read {
            let [position, velocity, visits] = self.system.read(["position", "velocity", "visits"])?;
            let of = |numbers: &[f32], i: usize| {
                DVec3::new(
                    f64::from(numbers[4 * i]),
                    f64::from(numbers[4 * i + 1]),
                    f64::from(numbers[4 * i + 2]),
                )
            };
            for (i, old) in self.system.tables.pattern.old.iter().enumerate() {
                self.state.position[*old as usize] = self.origin + of(&position, i);
                self.state.velocity[*old as usize] = of(&velocity, i);
            }
            for v in 0..self.state.sliding.len() {
                self.state.sliding[v] = self.unslid(v) + f64::from(visits[4 * v]);
                self.state.sliding_velocity[v] = f64::from(visits[4 * v + 1]);
            }
            self.state.taken_in = self.taken_in;
            self.is_read = true;
            self.read_at = self.time;
        }
        Ok(&self.state)
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
        if self.time - self.read_at >= KEEP {
            self.state()?;
        }
        Ok(())
    }

    /// Simulated time of the state that was last read back [s].
    pub fn last_time_s(&self) -> f64 {
        self.read_at
    }

    /// The yarns as they are drawn: `curves` on the device.
    ///
    /// # Errors
    /// The GPU fails.
    pub fn curves(&mut self) -> Result<YarnCurves, GpuError> {
        let points = self.system.points(self.params(self.step))?;
        let net = &self.model.net;
        let at = |i: usize| {
            let p = &points[4 * i..4 * i + 4];
            let x = DVec3::new(f64::from(p[0]), f64::from(p[1]), f64::from(p[2]));
            (p[3] > 0.0).then(|| (self.origin + x).as_vec3())
        };
        let mut middles = HashMap::new();
        for (joint, contact) in self.system.tables.joints.iter().zip(&net.contacts) {
            let yarns = std::iter::once(contact.new).chain(contact.old.iter().copied());
            yarns.enumerate().for_each(|(i, ends)| {
                middles.insert(ends, at(joint.point as usize + i));
            });
        }
        Ok(string_together(net, &self.materials, &|visit| at(visit.index()), &|a, b| {
            middles.get(&[a, b]).or_else(|| middles.get(&[b, a])).copied().flatten()
        }))
    }

    /// What there is to report of the simulation so far; the forces of what holds the fabric are left out.
    ///
    /// # Errors
    /// The GPU fails.
    pub fn facts(&mut self) -> Result<Facts, GpuError> {
        self.state()?;
        let Self { model, materials, state, .. } = &*self;
        Ok(Facts {
            solver: "gpu".to_owned(),
            steps: self.steps,
            time_s: self.time,
            kinetic_j: model.kinetic_energy(materials, state),
            rejected_steps: self.rejected,
            ..facts::measure(model, materials, (&self.scene, self.scene_time), state)
        })
    }

    /// What has been done to the net, and has happened to it, since this simulation began.
    pub fn surgery(&self) -> &Surgery {
        &self.surgery
    }

    /// The net.
    pub fn net(&self) -> &Arc<YarnNet> {
        &self.model.net
    }

    /// The scene.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// Simulated time [s].
    pub fn time_s(&self) -> f64 {
        self.time
    }

    /// Time since the scene began, by which bodies and clamps move [s].
    pub fn scene_time_s(&self) -> f64 {
        self.scene_time
    }

    /// Steps taken.
    pub fn steps(&self) -> u64 {
        self.steps
    }

    /// Attempts thrown away.
    pub fn rejected(&self) -> u64 {
        self.rejected
    }

    /// Iterations that the last step took.
    pub fn iterations(&self) -> u32 {
        self.iterations
    }

    /// Bytes on the device.
    pub fn bytes(&self) -> u64 {
        self.system.tables.bytes()
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

/// Why a step has to be thrown away, if it has.
fn rejection(verdict: &Verdict) -> Option<Rejection> {
    if verdict.status.solved != 1 {
        return Some(Rejection::Solve(SolveError::NotConverged));
    }
    let segment = (verdict.worst / 4) as usize;
    match (verdict.worst, verdict.worst % 4) {
        (NONE, _) => None,
        (_, REJECTED_SHRINKING) => Some(Rejection::Shrinking(segment)),
        (_, REJECTED_LEAPING) => Some(Rejection::Leaping(segment)),
        _ => Some(Rejection::NotFinite),
    }
}
