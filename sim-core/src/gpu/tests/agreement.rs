//! Kernel by kernel, from the same state: what the device makes of it against what the CPU does.
//!
//! Differences are relative to the largest number of the same kind, those of the matrix to its diagonal. The bounds stem from
//! single precision, 6e-8 an operation: forces are sums of some thirty terms, and the entries of bends and wraps have the
//! third power of differences of positions in them, which have lost two digits.

use super::{device, spoilt, ten_fabrics};
use crate::assembly::Start;
use crate::costs::Costs;
use crate::friction::Anchors;
use crate::gpu::kernel::Kernels;
use crate::gpu::layout::Params;
use crate::gpu::pattern::Room;
use crate::gpu::{GpuDevice, GpuSimulator};
use crate::handover::Handover;
use crate::material::Material;
use crate::materials::Materials;
use crate::model::{FROZEN, Model};
use crate::rigid;
use crate::scene::{Pin, Scene};
use crate::solver::Solver;
use crate::solver::product::Product;
use crate::step::{Stepper, Stuck};
use glam::DVec3;
use std::collections::HashMap;
use std::sync::Arc;
use stitch_mesh::yarn_net::{YarnNet, YarnState};

/// h [s].
pub(super) const STEP: f64 = 5e-3;

/// Bounds on the differences: of impulses and pulls, of the matrix, and of the velocities solved for. The last are worse by the
/// condition of the system, some 1e5, most of all where layers or bodies are pressed.
const FORCE: f64 = 5e-6;
const MATRIX: f64 = 5e-5;
const VELOCITY: f64 = 1e-2;

/// Tolerance of conjugate gradients here, near what single precision can do.
const TIGHT: f32 = 1e-5;

/// So many that an incomplete factor does, too.
const MOST_ITERATIONS: u32 = 300;

/// The same fabric in the same state, on the CPU and on the device.
pub(super) struct Pair {
    pub stepper: Stepper,
    pub now: Stuck,
    pub scene: Scene,
    pub gpu: GpuSimulator,
}

/// What two vectors of unknowns are to be compared in: positions or sliding coordinates.
struct Kinds {
    is_sliding: Vec<bool>,
}

impl Pair {
    /// A fabric from a state, on a device with so much `room`.
    pub fn new(
        device: &GpuDevice,
        kernels: Kernels,
        net: &YarnNet,
        state: YarnState,
        scene: Scene,
        room: Room,
    ) -> Self {
        Self::of_yarn(Material::for_loop_width(3e-3), device, kernels, net, state, scene, room)
    }

    /// The same of another yarn.
    pub fn of_yarn(
        yarn: Material,
        device: &GpuDevice,
        kernels: Kernels,
        net: &YarnNet,
        state: YarnState,
        scene: Scene,
        room: Room,
    ) -> Self {
        let net = Arc::new(net.clone());
        let materials = Materials::from(yarn);
        let from = Handover::new(&net, materials.clone(), scene.clone(), state).unwrap();
        let gpu = GpuSimulator::with(device, kernels, room, from).unwrap();
        let mut state = gpu.last_state().clone();
        // As the device has it.
        let origin = gpu.origin();
        state.position.iter_mut().for_each(|x| *x = origin + (*x - origin).as_vec3().as_dvec3());
        let stepper = Stepper::new(Model::new(net).unwrap(), &materials, None);
        let anchors = Anchors::at(&stepper.stacks, &state.sliding);
        Self { stepper, now: Stuck { state, anchors }, scene, gpu }
    }

    /// Assembles the system on the CPU: the yarn itself, then what holds it.
    pub fn assemble(&mut self) {
        let state = &self.now.state;
        let omega = rigid::rotation(&state.position, &state.velocity, &self.stepper.masses).omega;
        let materials = self.stepper.materials.clone();
        let Scene { gravity, air, .. } = self.scene;
        let start = Start { materials: &materials, state, gravity, air, omega, step: STEP };
        self.stepper.system.assemble(&self.stepper.model, start);
    }

    /// Adds what touches single nodes. Gives the moved anchors.
    pub fn hold(&mut self) -> Anchors {
        let (now, scene) = (self.now.clone(), self.scene.clone());
        let anchors = self.stepper.add_friction(&now, STEP);
        self.stepper.add_layers(&now.state, &scene, STEP);
        self.stepper.add_bodies(&now.state, &scene, 0.0, STEP);
        self.stepper.add_pins(&now.state, &scene, STEP, STEP);
        anchors
    }

    /// The stages on the device up to one of them.
    pub fn run_until(&mut self, stage: &str) {
        self.gpu.place_surroundings().unwrap();
        let params = Params { tolerance: TIGHT * TIGHT, ..self.gpu.params(STEP) };
        self.gpu.system().prepare_until(params, stage);
    }

    /// Right-hand side (0) or residual of the old velocities (1) on the device.
    fn load(&self, which: usize) -> Vec<f32> {
        let [load] = self.gpu.system().read(["load"]).unwrap();
        load.into_iter().skip(which).step_by(2).collect()
    }

    /// Unknown of the CPU for each of the device's.
    fn dofs(&self) -> Vec<usize> {
        let (pattern, start) = (&self.gpu.system().tables.pattern, &self.stepper.model.start);
        let of = |n: &u32| start[*n as usize] as usize..start[*n as usize + 1] as usize;
        pattern.old.iter().flat_map(of).collect()
    }

    fn kinds(&self) -> Kinds {
        let mut is_sliding = vec![false; self.stepper.model.dof_count()];
        self.stepper
            .model
            .sliding
            .iter()
            .filter(|d| **d != FROZEN)
            .for_each(|d| is_sliding[*d as usize] = true);
        Kinds { is_sliding }
    }

    /// Largest difference of two vectors of unknowns.
    fn unlike(&self, cpu: &[f64], gpu: &[f32]) -> f64 {
        let Kinds { is_sliding } = self.kinds();
        let mut scale = [1e-300_f64; 2];
        for (c, sliding) in cpu.iter().zip(&is_sliding) {
            let scale = &mut scale[usize::from(*sliding)];
            *scale = scale.max(c.abs());
        }
        let difference =
            |(d, g): (usize, &f32)| (cpu[d] - f64::from(*g)).abs() / scale[usize::from(is_sliding[d])];
        worst(self.dofs().into_iter().zip(gpu).map(difference))
    }

    /// Largest difference of matrix entries.
    fn unlike_matrix(&self) -> f64 {
        let matrix = &self.stepper.system.matrix;
        let mut entries = HashMap::new();
        for (i, j, value) in matrix.entries() {
            entries.insert((i, j), value);
            entries.insert((j, i), value);
        }
        let (dofs, tables) = (self.dofs(), &self.gpu.system().tables);
        let mut differences = Vec::with_capacity(entries.len());
        for (c, chunk) in tables.chunks.iter().enumerate() {
            let values = self.gpu.system().read_chunk(c, "values");
            let nodes = chunk.counts.first_node..chunk.counts.first_node + chunk.counts.node_count;
            for node in nodes.map(|n| tables.nodes[n as usize]) {
                let blocks = &chunk.blocks[node.block as usize..node.block_end as usize];
                let columns = blocks.iter().flat_map(|b| b.dof..b.dof + b.size);
                for (j, column) in columns.enumerate() {
                    for i in 0..node.size {
                        let (a, b) = (dofs[(node.dof + i) as usize], dofs[column as usize]);
                        let value = f64::from(values[(node.value + j as u32 * node.size + i) as usize]);
                        let scale = (entries[&(a, a)] * entries[&(b, b)]).sqrt();
                        differences.push((value - entries[&(a, b)]).abs() / scale);
                    }
                }
            }
        }
        assert_eq!(differences.len(), entries.len());
        worst(differences.into_iter())
    }

    /// What each kernel leaves, against the CPU: the name of each comparison, the difference and its bound.
    pub fn differences(&mut self) -> Vec<(&'static str, f64, f64)> {
        self.assemble();
        self.run_until("gather");
        let mut found = vec![
            ("rhs", self.unlike(&self.stepper.system.rhs, &self.load(0)), FORCE),
            ("matrix", self.unlike_matrix(), MATRIX),
        ];
        self.run_until("pull_at");
        found.push(("pull", self.unlike_pull(), FORCE));
        let anchors = self.hold();
        self.run_until("hold");
        let v = self.stepper.rates(&self.now.state);
        let Stepper { system, .. } = &self.stepper;
        let mut q = vec![0.0; v.len()];
        Product::new(&system.matrix).set(&system.matrix, &v, &mut q);
        let residual: Vec<f64> = system.rhs.iter().zip(&q).map(|(b, q)| b - q).collect();
        found.extend([
            ("anchors", self.unlike_anchors(&anchors), FORCE),
            ("rhs, held", self.unlike(&system.rhs, &self.load(0)), FORCE),
            ("matrix, held", self.unlike_matrix(), MATRIX),
            ("residual", self.unlike(&residual, &self.load(1)), FORCE),
        ]);
        let verdict = self.gpu.system().solve_prepared(MOST_ITERATIONS).unwrap();
        let mut x = v;
        let rhs = self.stepper.system.rhs.clone();
        let Stepper { model, system, .. } = &mut self.stepper;
        let mut direct = Solver::direct(model, &system.matrix);
        direct.solve(model, &system.matrix, &rhs, &mut x, &mut Costs::default()).unwrap();
        let [solved] = self.gpu.system().read(["x"]).unwrap();
        let is_solved = verdict.status.solved == 1;
        let difference = if is_solved { self.unlike(&x, &solved) } else { f64::INFINITY };
        found.push(("velocities", difference, VELOCITY));
        found
    }

    fn unlike_pull(&self) -> f64 {
        let [pull] = self.gpu.system().read(["pull"]).unwrap();
        let cpu = &self.stepper.system.pull;
        let scale = cpu.iter().map(|p| p.length()).fold(0.0, f64::max);
        let stacked = self.gpu.system().tables.stacked.iter().zip(cpu).zip(pull.chunks(4));
        let stacked = stacked.filter(|((s, _), _)| self.stepper.model.sliding[s.visit as usize] != FROZEN);
        let vector = |p: &[f32]| DVec3::new(f64::from(p[0]), f64::from(p[1]), f64::from(p[2]));
        worst(stacked.map(|((_, cpu), p)| (*cpu - vector(p)).length() / scale))
    }

    /// Anchors of friction, relative to how far yarns have slid.
    fn unlike_anchors(&self, anchors: &Anchors) -> f64 {
        let [springs] = self.gpu.system().read(["springs"]).unwrap();
        let net = &self.stepper.model.net;
        let base = |v: usize| net.visits[v].u;
        let stacked = self.gpu.system().tables.stacked.iter().zip(springs.chunks(4));
        let stacked = stacked.filter(|(s, _)| self.stepper.model.sliding[s.visit as usize] != FROZEN);
        worst(stacked.map(|(s, spring)| {
            let v = s.visit as usize;
            (anchors.own[v] - base(v) - f64::from(spring[0])).abs() / 1e-3
        }))
    }
}

/// The largest, infinite if one is NaN.
fn worst(differences: impl Iterator<Item = f64>) -> f64 {
    differences.fold(0.0, |w: f64, d| if d.is_nan() { f64::INFINITY } else { w.max(d) })
}

/// A fabric crumpled, its yarn slid, in motion.
pub(super) fn crumpled(net: &YarnNet) -> YarnState {
    let mut state = net.laid_state();
    let mut hash = (0..).map(|i| crate::noise::unit_hash(i) - 0.5);
    let mut noise = |size: f64| size * hash.next().unwrap();
    state.position.iter_mut().for_each(|x| *x += DVec3::new(noise(3e-4), noise(3e-4), noise(3e-4)));
    state.velocity.iter_mut().for_each(|v| *v += DVec3::new(noise(0.02), noise(0.02), 0.01 + noise(0.02)));
    for (v, visit) in net.visits.iter().enumerate() {
        if net.nodes[visit.node.index()].visits.len() > 1 {
            state.sliding[v] += noise(5e-5);
            state.sliding_velocity[v] = noise(0.01);
        }
    }
    state
}

/// Gravity, air, and the topmost nodes pinned.
pub(super) fn pinned(net: &YarnNet) -> Scene {
    let top = net.nodes.iter().map(|n| n.position.y).fold(f64::NEG_INFINITY, f64::max);
    let pins = net.nodes.iter().enumerate().filter(|(_, n)| n.position.y > top - 1e-3);
    let pins = pins.map(|(i, n)| Pin { node: i as u32, target: n.position, stiffness: 10.0 }).collect();
    Scene { pins, air: 1.2, ..Scene::default() }
}

#[test]
fn every_kernel_does_what_the_cpu_does() {
    let Some(device) = device() else { return };
    for (name, net) in ten_fabrics() {
        let mut pair = Pair::new(
            &device,
            device.kernels().unwrap(),
            &net,
            crumpled(&net),
            pinned(&net),
            Room::on(&device),
        );
        for (what, difference, bound) in pair.differences() {
            println!("{name}: {what} {difference:.1e}");
            assert!(difference < bound, "{name}: {what} is off by {difference:.1e}");
        }
    }
}

/// With yarn that hardly stretches or slides under its own force, so that these forces don't hide the others.
#[test]
fn weak_forces_are_those_of_the_cpu() {
    let Some(device) = device() else { return };
    let usual = Material::for_loop_width(3e-3);
    let loose = Material { young_modulus: 1.0, parallel_stiffness: 1e-3, wrap_stiffness: 1e-9, ..usual };
    let bending = Material { bending_modulus: 1.0, ..loose.clone() };
    let wrapping = Material { wrap_stiffness: 1.0, bending_modulus: 1e-9, ..loose.clone() };
    for (name, yarn) in [("bending", bending), ("wrapping", wrapping)] {
        for (fabric, net) in [&ten_fabrics()[1], &ten_fabrics()[5]] {
            let kernels = device.kernels().unwrap();
            let scene = Scene::empty();
            let mut pair =
                Pair::of_yarn(yarn.clone(), &device, kernels, net, crumpled(net), scene, Room::on(&device));
            pair.assemble();
            pair.run_until("gather");
            let rhs = pair.unlike(&pair.stepper.system.rhs, &pair.load(0));
            println!("{name} {fabric}: {rhs:.1e}");
            assert!(rhs < 2.0 * FORCE, "{name} {fabric}: {rhs:e}");
        }
    }
}

#[test]
fn the_same_in_many_chunks() {
    let Some(device) = device() else { return };
    let [.., (_, net), _] = &ten_fabrics()[..] else { panic!("ten fabrics") };
    for complete in [Room::on(&device).complete, 0.0] {
        let room = Room { binding: 40_000, complete };
        let mut pair = Pair::new(&device, device.kernels().unwrap(), net, crumpled(net), pinned(net), room);
        let tables = &pair.gpu.system().tables;
        assert!(tables.chunks.len() >= 3);
        // A level hands on to the next chunk and further.
        let later = tables.pattern.changes.levels.iter().flat_map(|level| &level.later);
        assert!(later.filter(|([from, to], _)| from != to).count() > 2);
        for (what, difference, bound) in pair.differences() {
            println!("{what} {difference:.1e}");
            assert!(difference < bound, "{what} is off by {difference:.1e}");
        }
    }
}

#[test]
fn a_wrong_kernel_is_found() {
    let Some(device) = device() else { return };
    let (_, net) = &ten_fabrics()[0];
    // Each mistake, and the first comparison that must show it.
    for (file, right, wrong, shows) in [
        ("bend", "2.0 * yarn.bend * theta +", "2.2 * yarn.bend * theta +", "rhs"),
        ("gather", "inertia - stiffness", "inertia - 1.001 * stiffness", "matrix"),
        ("pull", "a - b, role == 1u", "b - a, role == 1u", "pull"),
        ("friction", "limits[i + 1u] += limit", "limits[i + 1u] -= limit", "matrix, held"),
        ("hold", "v.x - s.x + h * v.y", "v.x - s.x - h * v.y", "residual"),
    ] {
        let kernels = Kernels::compile(&device, &spoilt(file, right, wrong)).unwrap();
        let mut pair = Pair::new(&device, kernels, net, crumpled(net), pinned(net), Room::on(&device));
        let found = pair.differences().into_iter().find(|(_, difference, bound)| difference >= bound);
        println!("{file}: {found:?}");
        assert_eq!(found.map(|(what, ..)| what), Some(shows), "{file}");
    }
}
