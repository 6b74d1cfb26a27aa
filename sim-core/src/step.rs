//! One step of the simulation, as a list of stages.
//!
//! # Theory
//! Cirio et al. integrate with linearised backward Euler (one Newton step a time step), which at 5 ms is stable and needs
//! no line search. See `assembly.rs` for the system.
//!
//! # Practice
//! A step that goes wrong is thrown away and taken with half the time step; the state is replaced only by a step
//! that went well. Wrong is: the matrix has no factorisation, a number is not finite, a segment loses more than half of its
//! yarn, its ends move against each other by more than its length. Where that is a few segments, they are held and
//! the step is solved again first (`brace.rs`). Wrong is, too, that more than a few segments turn so far that they stay too long
//! (`overshoot.rs`).

use crate::assembly::{Start, System};
use crate::brace::{Braces, Excess, Failure};
use crate::costs::{Costs, Stage, Watch};
use crate::curves::normal;
use crate::friction::{Anchors, FrictionSpring, PerYarn, Stack};
use crate::layers::{LayerContact, Layers, Press};
use crate::local::Element;
use crate::material::Material;
use crate::materials::{Materials, Touch};
use crate::model::{FROZEN, Model, SegmentTerm};
use crate::overshoot::{draw_back, most_left};
use crate::rigid::{self, Rotation};
use crate::scene::Scene;
use crate::solver::tail::Link;
use crate::solver::{Method, SolveError, Solver};
use crate::surroundings::{body_forces, stiffness_by_mass};
use glam::{DMat3, DVec3};
use smallvec::SmallVec;
use stitch_mesh::ids::VisitId;
use stitch_mesh::yarn_net::{Node, YarnState};

/// How far the ends of a segment may move against each other in a step, over its length. The paper allows a half. But the yarn that a
/// segment gains by turning is drawn back (`overshoot.rs`), and in a garment that comes to lie on shoulders in steps of 1/30 s the segments
/// of its seams turn by a radian.
pub(crate) const LEAP: f64 = 1.0;

/// Why a step was thrown away.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum Rejection {
    /// The system could not be solved.
    #[error(transparent)]
    Solve(#[from] SolveError),
    /// The new state is not finite.
    #[error("the new state is not finite")]
    NotFinite,
    /// A segment would lose more than half of its yarn.
    #[error("segment {0} loses more than half of its yarn")]
    Shrinking(usize),
    /// The ends of a segment would move against each other by more than its length.
    #[error("the ends of segment {0} move too far against each other")]
    Leaping(usize),
    /// So many segments turn so far that they come out too long.
    #[error("{0} segments turn too far")]
    Overshooting(usize),
    /// More layers of the fabric meet than the GPU has room for.
    #[error("more layers of the fabric meet than there is room for")]
    Crowded,
}

/// The pieces of a simulator that a step works on.
pub(crate) struct Stepper {
    pub model: Model,
    pub system: System,
    pub solver: Solver,
    /// Of each colour of the model.
    pub(crate) materials: Vec<Material>,
    /// Mass of the yarn around each node [node_count] [kg].
    pub masses: Vec<f64>,
    /// Distance that each node keeps from bodies, half of that from other layers [node_count] [m].
    pub clearances: Vec<f64>,
    /// √μ of the yarn at each node [node_count].
    grips: Vec<f64>,
    layers: Layers,
    /// How firmly bodies, pins and other layers hold each node in this step, as a mass: h²k + hc in the mean of all directions,
    /// [node_count] [kg].
    held: Vec<f64>,
    /// Velocities and rates of the last system that was solved, of the model's unknowns.
    solution: Vec<f64>,
    /// The nodes at which yarns slide on each other.
    pub stacks: Vec<Stack>,
    /// Force of each body on the fabric in the last step that went well [N].
    pub body_forces: Vec<DVec3>,
    /// What all steps have cost.
    pub costs: Costs,
}

/// A state of the yarn with all that the next step needs of the last.
#[derive(Clone)]
pub(crate) struct Stuck {
    pub state: YarnState,
    /// Where its yarns stick.
    pub anchors: Anchors,
}

/// What came of a step.
pub(crate) struct Attempt {
    pub next: Stuck,
    /// Of the bodies on the fabric [N].
    forces: Vec<DVec3>,
    /// Segments that turned too far.
    left: usize,
}

impl Stepper {
    pub fn new(model: Model, materials: &Materials, method: Option<Method>) -> Self {
        let system = System::new(&model);
        let solver = Solver::new(&model, &system.matrix, method);
        let layers = Layers::new(&model.net);
        let stacks = Stack::all(&model.net);
        let mut stepper = Self {
            model,
            system,
            solver,
            materials: Vec::new(),
            masses: Vec::new(),
            clearances: Vec::new(),
            grips: Vec::new(),
            layers,
            held: Vec::new(),
            solution: Vec::new(),
            stacks,
            body_forces: Vec::new(),
            costs: Costs::default(),
        };
        stepper.set_materials(materials);
        stepper
    }

    pub fn set_materials(&mut self, materials: &Materials) {
        self.materials = self.model.resolve(materials);
        self.masses = self.model.node_masses(materials);
        self.clearances = clearances(&self.model, materials);
        let grip =
            |node: &Node| materials.of(self.model.net.visits[node.visits[0].index()].dye).friction.sqrt();
        self.grips = self.model.net.nodes.iter().map(grip).collect();
    }

    /// The state after a step of `h` from `now`, `time_s` after the scene has begun [s].
    pub fn step(&mut self, now: &Stuck, scene: &Scene, time_s: f64, h: f64) -> Result<Stuck, Rejection> {
        let mut braces = Braces::new(self.model.segments.len());
        loop {
            let Attempt { next, forces, left } = self.attempt(now, scene, time_s, h, &braces)?;
            let failures = self.judge(&now.state, &next.state)?;
            if failures.is_empty() {
                if left > most_left(self.model.segments.len()) {
                    return Err(Rejection::Overshooting(left));
                }
                self.body_forces = forces;
                return Ok(next);
            }
            braces.hold(&failures)?;
        }
    }

    /// A step with these braces, whether or not it may follow.
    pub(crate) fn attempt(
        &mut self,
        now: &Stuck,
        scene: &Scene,
        time_s: f64,
        h: f64,
        braces: &Braces,
    ) -> Result<Attempt, Rejection> {
        let mut watch = Watch::start();
        let state = &now.state;
        let rotation = rigid::rotation(&state.position, &state.velocity, &self.masses);
        let Scene { gravity, air, .. } = *scene;
        let start = Start { materials: &self.materials, state, gravity, air, omega: rotation.omega, step: h };
        watch.lap(&mut self.costs, Stage::Rest);
        self.system.assemble(&self.model, start);
        watch.lap(&mut self.costs, Stage::Assembly);
        let anchors = self.add_friction(now, h);
        watch.lap(&mut self.costs, Stage::Friction);
        self.held.clear();
        self.held.resize(self.masses.len(), 0.0);
        self.add_layers(state, scene, h);
        let touching = self.add_bodies(state, scene, time_s, h);
        let held = self.add_pins(state, scene, time_s + h, h);
        braces.add(&self.model, &mut self.system, &self.materials, state, h);
        watch.lap(&mut self.costs, Stage::Contacts);
        if braces.is_empty() {
            self.solution = self.rates(state);
        }
        self.costs.attempts += 1;
        let System { matrix, rhs, .. } = &self.system;
        let solve = if braces.is_empty() { Solver::solve } else { Solver::solve_again };
        solve(&mut self.solver, &self.model, matrix, rhs, &mut self.solution, &mut self.costs)?;
        let mut watch = Watch::start();
        let (mut velocity, rate) = self.split(&self.solution);
        if touching.is_empty() && held == 0 && air == 0.0 {
            let kept = Rotation { omega: rotation.omega / (1.0 + h * self.mean_mass_damping()), ..rotation };
            self.keep_rotation(state, &mut velocity, kept);
        }
        let mut next = advanced(state, velocity, rate, h);
        let forces = body_forces(scene, &touching, &next.velocity, h);
        let left = draw_back(&self.model, (&self.masses, &self.held), state, &mut next, h);
        watch.lap(&mut self.costs, Stage::Rest);
        Ok(Attempt { next: Stuck { state: next, anchors }, forces, left })
    }

    /// Compression from the forces just assembled, and the friction springs that it carries. Gives the moved anchors.
    pub(crate) fn add_friction(&mut self, now: &Stuck, h: f64) -> Anchors {
        let mut anchors = now.anchors.clone();
        let (slid, rate) = (&now.state.sliding, &now.state.sliding_velocity);
        let Self { model, system, materials, stacks, .. } = self;
        let material = |v: VisitId| &materials[model.dye_of[v.index()] as usize];
        for stack in stacks {
            let slots = model.slot[stack.node] as usize..model.slot[stack.node + 1] as usize;
            let pull: PerYarn<DVec3> = system.pull[slots].iter().copied().collect();
            let many = stack.visits.len() > 2;
            let back = if many { -normal(&model.net, &now.state, stack.node) } else { DVec3::ZERO };
            let mut limits: PerYarn<f64> = SmallVec::from_elem(0.0, stack.visits.len());
            for (i, lambda) in stack.compression(&pull, back).iter().enumerate() {
                let [a, b] = [stack.visits[i], stack.visits[i + 1]];
                let limit = Touch::between(material(a), material(b)).limit(*lambda);
                if !stack.parallel[i] {
                    limits[i] += limit;
                    limits[i + 1] += limit;
                    continue;
                }
                let stick = material(a).friction_stiffness;
                let [a, b] = [a.index(), b.index()];
                let (apart, slip) = (slid[a] - slid[b], rate[a] - rate[b]);
                let spring = FrictionSpring::new(anchors.between[a], apart, slip, limit, h, stick);
                anchors.between[a] = spring.anchor;
                let dofs = [a, b].map(|v| model.sliding[v] as usize);
                system.add_spring_between(model.start[stack.node], dofs, &spring, apart, h);
            }
            for (visit, limit) in stack.visits.iter().zip(limits).filter(|(_, limit)| *limit > 0.0) {
                let (v, stick) = (visit.index(), material(*visit).friction_stiffness);
                let spring = FrictionSpring::new(anchors.own[v], slid[v], rate[v], limit, h, stick);
                anchors.own[v] = spring.anchor;
                system.add_spring(model.sliding[v] as usize, &spring, slid[v], h);
            }
        }
        anchors
    }

    /// Layers of the fabric that lie on each other.
    pub(crate) fn add_layers(&mut self, state: &YarnState, scene: &Scene, h: f64) {
        let contact = LayerContact {
            clearances: &self.clearances,
            masses: &self.masses,
            grips: &self.grips,
            stiffness_by_mass: stiffness_by_mass(scene),
            step: h,
        };
        for Press { nodes, force, normal, stiffness, drag } in self.layers.contacts(state, contact) {
            let along = DMat3::from_cols(normal.x * normal, normal.y * normal, normal.z * normal);
            let block = h * (h * stiffness * along + drag * (DMat3::IDENTITY - along));
            let start = nodes.map(|n| self.model.start[n]);
            for (node, force) in nodes.into_iter().zip([force, -force]) {
                self.push(node, h * force);
                self.add_block(node, |i, j| block.col(j)[i]);
            }
            self.system.matrix.tail.push(Link { start, block });
        }
    }

    /// α of the whole fabric: that of its yarns by their mass [1/s].
    fn mean_mass_damping(&self) -> f64 {
        let mass = |s: &SegmentTerm| self.materials[s.dye as usize].density * s.rest;
        let sum = |of: &dyn Fn(&SegmentTerm) -> f64| self.model.segments.iter().map(of).sum::<f64>();
        sum(&|s| mass(s) * self.materials[s.dye as usize].mass_damping) / sum(&mass)
    }

    /// Adds a force on the position of one node.
    pub fn add_point(&mut self, node: usize, element: &impl Element<3>, x: DVec3, h: f64) {
        let local = element.expand(&x.to_array());
        for i in 0..3 {
            self.system.rhs[self.model.start[node] as usize + i] -= h * local.gradient[i];
        }
        self.add_block(node, |i, j| h * h * local.hessian[i][j]);
    }

    /// Adds an impulse on one node [N s].
    pub fn push(&mut self, node: usize, impulse: DVec3) {
        let first = self.model.start[node] as usize;
        (0..3).for_each(|i| self.system.rhs[first + i] += impulse[i]);
    }

    /// Adds a 3 × 3 block to the matrix.
    pub fn add_block(&mut self, node: usize, entry: impl Fn(usize, usize) -> f64) {
        if let Some(held) = self.held.get_mut(node) {
            *held += (0..3).map(|i| entry(i, i)).sum::<f64>() / 3.0;
        }
        for j in 0..3 {
            for i in j..3 {
                let place = self.system.matrix.place(self.model.start[node], 0, i as u32, j as u32);
                self.system.matrix.value[place] += entry(i, j);
            }
        }
    }

    /// The velocities of nodes and the rates of sliding coordinates as one vector of unknowns.
    pub(crate) fn rates(&self, state: &YarnState) -> Vec<f64> {
        let mut rates = vec![0.0; self.model.dof_count()];
        for (start, v) in self.model.start.iter().zip(&state.velocity) {
            rates[*start as usize..*start as usize + 3].copy_from_slice(&v.to_array());
        }
        for (dof, rate) in
            self.model.sliding.iter().zip(&state.sliding_velocity).filter(|(d, _)| **d != FROZEN)
        {
            rates[*dof as usize] = *rate;
        }
        rates
    }

    /// The velocities of nodes and the rates of sliding coordinates out of one vector of unknowns.
    fn split(&self, rates: &[f64]) -> (Vec<DVec3>, Vec<f64>) {
        let nodes = &self.model.start[..self.model.net.nodes.len()];
        let velocity = nodes.iter().map(|s| DVec3::from_slice(&rates[*s as usize..])).collect();
        let rate = |dof: &u32| if *dof == FROZEN { 0.0 } else { rates[*dof as usize] };
        (velocity, self.model.sliding.iter().map(rate).collect())
    }

    /// Gives `velocity` the rigid rotation `kept` instead of its own.
    fn keep_rotation(&self, state: &YarnState, velocity: &mut [DVec3], kept: Rotation) {
        let solved = rigid::rotation(&state.position, velocity, &self.masses);
        for (v, x) in velocity.iter_mut().zip(&state.position) {
            *v += (kept.omega - solved.omega).cross(*x - kept.center);
        }
    }

    /// The segments because of which `next` may not follow `state`.
    pub(crate) fn judge(&self, state: &YarnState, next: &YarnState) -> Result<Vec<Failure>, Rejection> {
        if !next.is_finite() {
            return Err(Rejection::NotFinite);
        }
        let failure = |(segment, term): (usize, &SegmentTerm)| {
            let [a, b] = term.stencil.nodes.map(|n| n.index());
            let [ua, ub] = term.stencil.visits.map(|v| v.index());
            let yarn = |s: &YarnState| s.sliding[ub] + term.stencil.turn[1] - s.sliding[ua];
            let span = |s: &YarnState| s.position[b] - s.position[a];
            let length = span(state).length().max(yarn(state));
            let excess = if yarn(next) < 0.5 * yarn(state) {
                Excess::Shrinking
            } else if span(next).distance(span(state)) > LEAP * length {
                Excess::Leaping
            } else {
                return None;
            };
            Some(Failure { segment, excess })
        };
        Ok(self.model.segments.iter().enumerate().filter_map(failure).collect())
    }
}

/// `state` moved on for `h` with the given velocities.
fn advanced(state: &YarnState, velocity: Vec<DVec3>, sliding_velocity: Vec<f64>, h: f64) -> YarnState {
    let moved = |(x, v): (&DVec3, &DVec3)| *x + h * *v;
    let slid = |(u, rate): (&f64, &f64)| u + h * rate;
    YarnState {
        position: state.position.iter().zip(&velocity).map(moved).collect(),
        sliding: state.sliding.iter().zip(&sliding_velocity).map(slid).collect(),
        velocity,
        sliding_velocity,
        taken_in: state.taken_in,
    }
}

/// Distance that nodes keep from bodies, [node_count]: two yarns lie on each other at a node, each as thick as the yarns
/// there in the mean [m].
pub(crate) fn clearances(model: &Model, materials: &Materials) -> Vec<f64> {
    let radius = |v: &VisitId| materials.of(model.net.visits[v.index()].dye).drawn_radius;
    let of = |node: &Node| 2.0 * node.visits.iter().map(radius).sum::<f64>() / node.visits.len() as f64;
    model.net.nodes.iter().map(of).collect()
}
