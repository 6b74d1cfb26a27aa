//! Tests that both solvers do the same.

use super::gradients::{self, NotConverged};
use super::tail::Link;
use super::{Factor, Method, Pattern, Solver};
use crate::costs::Costs;
use crate::friction::Anchors;
use crate::material::Material;
use crate::model::Model;
use crate::scene::{Pin, Scene};
use crate::step::{Stepper, Stuck};
use crate::testing::fabrics::fabrics;
use glam::{DMat3, DVec3};
use std::sync::Arc;
use stitch_mesh::{lay::lay, stitch_mesh::StitchMesh};

/// Iterations that are enough for every fabric here.
const ENOUGH: usize = 60;

/// Largest difference between velocities, relative to the largest velocity.
const CLOSE: f64 = 1e-3;

/// h [s].
const STEP: f64 = 5e-3;

/// A fabric that hangs by one node, after a few steps.
struct Hanging {
    stepper: Stepper,
    scene: Scene,
    now: Stuck,
}

impl Hanging {
    fn new(stitches: &StitchMesh) -> Self {
        let net = Arc::new(lay(stitches));
        let mut state = net.laid_state();
        let mut noise = (0..).map(|i| 1e-5 * (crate::noise::unit_hash(i) - 0.5));
        let mut next = || noise.next().unwrap();
        state.position.iter_mut().for_each(|x| *x += DVec3::new(next(), next(), next()));
        let material = Material::for_loop_width(3e-3);
        let pin = Pin { node: 0, target: net.nodes[0].position, stiffness: 10.0 };
        let scene = Scene { pins: vec![pin], time_step: STEP, ..Scene::default() };
        let model = Model::new(net).unwrap();
        let stepper = Stepper::new(model, &material.into(), Some(Method::Direct));
        let anchors = Anchors::at(&stepper.stacks, &state.sliding);
        let mut hanging = Self { stepper, scene, now: Stuck { state, anchors } };
        // From the laid shape only small steps go well at first.
        let mut h = 0.5 * STEP;
        while h <= STEP {
            match hanging.stepper.step(&hanging.now, &hanging.scene, 0.0, h) {
                Ok(next) => (hanging.now, h) = (next, 1.1 * h),
                Err(_) => h *= 0.5,
            }
        }
        hanging
    }

    fn step(&mut self) -> Stuck {
        self.stepper.step(&self.now, &self.scene, 0.0, STEP).unwrap()
    }

    fn direct(&self) -> Solver {
        Solver::direct(&self.stepper.model, &self.stepper.system.matrix)
    }

    fn iterative(&self) -> Solver {
        Solver::iterative(&self.stepper.model, &self.stepper.system.matrix)
    }

    /// Solves the last system by conjugate gradients alone.
    fn iterate(&self, preconditioner: &mut Factor) -> Result<usize, NotConverged> {
        let Stepper { model, system, .. } = &self.stepper;
        let nodes = &model.start[..model.net.nodes.len()];
        let mut x = vec![0.0; model.dof_count()];
        let bounds = (super::MOST_ITERATIONS, super::TOLERANCE);
        let solved = gradients::solve(&system.matrix, preconditioner, nodes, &system.rhs, &mut x, bounds);
        solved.map(|s| s.iterations)
    }
}

/// Largest difference between the velocities of `a` and `b`, relative to the largest velocity.
fn difference(a: &Stuck, b: &Stuck) -> f64 {
    let (a, b) = (&a.state.velocity, &b.state.velocity);
    let largest = a.iter().map(|v| v.length()).fold(0.0, f64::max);
    a.iter().zip(b).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max) / largest
}

#[test]
fn both_solvers_take_the_same_step() {
    for (name, stitches) in fabrics() {
        let mut hanging = Hanging::new(&stitches);
        let expected = hanging.step();
        let mut preconditioner =
            Factor::new(Pattern::incomplete(&hanging.stepper.model, &hanging.stepper.system.matrix));
        preconditioner.factorise(&hanging.stepper.system.matrix).unwrap();
        let iterations = hanging.iterate(&mut preconditioner).unwrap();
        hanging.stepper.solver = hanging.iterative();
        let difference = difference(&expected, &hanging.step());
        println!("{name}: {iterations} iterations, difference {difference:.1e}");
        assert!(iterations < ENOUGH, "{name}: {iterations} iterations");
        assert!(difference < CLOSE, "{name}: {difference:e}");
    }
}

#[test]
fn both_solve_a_tail_and_notice_where_it_lacks() {
    let [(_, stitches), ..] = fabrics();
    let mut hanging = Hanging::new(&stitches);
    hanging.step();
    let Stepper { model, system, .. } = &mut hanging.stepper;
    // Nodes that have nothing to do with each other, tied as stiffly as a contact of layers is.
    let count = model.net.nodes.len();
    let stiff = 1e-4 * DMat3::IDENTITY;
    for k in 0..10 {
        let nodes = [3 * k, count - 1 - 5 * k];
        let start = nodes.map(|n| model.start[n]);
        for first in start {
            (0..3).for_each(|i| system.matrix.add_diagonal(first as usize + i, stiff.col(i)[i]));
        }
        system.matrix.tail.push(Link { start, block: stiff });
    }
    let solve = |mut solver: Solver, matrix: &_| {
        let mut x = vec![0.0; system.rhs.len()];
        solver.solve(model, matrix, &system.rhs, &mut x, &mut Costs::default()).unwrap();
        x
    };
    let largest = |x: &[f64]| x.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
    let apart = |a: &[f64], b: &[f64]| {
        let difference: Vec<f64> = a.iter().zip(b).map(|(a, b)| a - b).collect();
        largest(&difference) / largest(a)
    };
    let matrix = &system.matrix;
    let direct = solve(Solver::direct(model, matrix), matrix);
    let iterative = solve(Solver::iterative(model, matrix), matrix);
    println!("{:.1e}", apart(&direct, &iterative));
    assert!(apart(&direct, &iterative) < CLOSE);
    let mut cut = matrix.clone();
    cut.tail.pop();
    assert!(apart(&direct, &solve(Solver::direct(model, matrix), &cut)) > CLOSE);
}

#[test]
fn a_system_that_changed_a_little_is_solved_with_the_old_factor() {
    let [(_, stitches), ..] = fabrics();
    let mut hanging = Hanging::new(&stitches);
    hanging.step();
    let Stepper { model, system, .. } = &hanging.stepper;
    let nodes = model.net.nodes.len();
    let largest = |x: &mut dyn Iterator<Item = f64>| x.fold(0.0, |m: f64, x| m.max(x.abs()));
    // One node is made heavier; or all are, each in its own way.
    for (method, heavier, anew) in [
        (Method::Direct, nodes / 2..nodes / 2 + 1, false),
        (Method::Iterative, nodes / 2..nodes / 2 + 1, false),
        (Method::Direct, 0..nodes, true),
        (Method::Iterative, 0..nodes, true),
    ] {
        let mut changed = system.matrix.clone();
        for node in heavier {
            let mass = 1e-6 * 10_f64.powi(node as i32 % 7);
            (0..3).for_each(|axis| changed.add_diagonal(model.start[node] as usize + axis, mass));
        }
        let solve = |solver: &mut Solver, matrix: &_, x: &mut [f64], costs: &mut Costs| {
            solver.solve(model, matrix, &system.rhs, x, costs).unwrap();
        };
        let (mut expected, mut x) = (vec![0.0; system.rhs.len()], vec![0.0; system.rhs.len()]);
        solve(&mut Solver::direct(model, &changed), &changed, &mut expected, &mut Costs::default());
        let apart = |x: &[f64]| {
            largest(&mut x.iter().zip(&expected).map(|(a, b)| a - b)) / largest(&mut expected.iter().copied())
        };
        let (mut solver, mut costs) = (Solver::new(model, &changed, Some(method)), Costs::default());
        solve(&mut solver, &system.matrix, &mut x, &mut costs);
        let (once, before) = (costs.operations, apart(&x));
        solver.solve_again(model, &changed, &system.rhs, &mut x, &mut costs).unwrap();
        println!("{method:?}: {before:.1e}, then {:.1e}", apart(&x));
        assert!(before > CLOSE && apart(&x) < CLOSE);
        assert_eq!(costs.operations > once, anew);
    }
}

#[test]
fn a_wrong_matrix_is_noticed() {
    let [(_, stitches), ..] = fabrics();
    let mut hanging = Hanging::new(&stitches);
    let mut solved = hanging.step();
    let Stepper { model, system, .. } = &mut hanging.stepper;
    let mut velocities = |mut solver: Solver, matrix: &_, rhs: &[f64]| {
        let mut x = vec![0.0; rhs.len()];
        solver.solve(model, matrix, rhs, &mut x, &mut Costs::default()).unwrap();
        for (v, start) in solved.state.velocity.iter_mut().zip(&model.start) {
            *v = DVec3::from_slice(&x[*start as usize..]);
        }
        solved.clone()
    };
    let expected = velocities(Solver::direct(model, &system.matrix), &system.matrix, &system.rhs);
    let mut solve = |matrix: &_, rhs: &[f64]| {
        difference(&expected, &velocities(Solver::iterative(model, matrix), matrix, rhs))
    };
    assert!(solve(&system.matrix, &system.rhs) < CLOSE);
    let middle = model.start[model.net.nodes.len() / 2] as usize;
    let entry = system.matrix.value[system.matrix.column[middle] as usize];
    system.matrix.add_diagonal(middle, 0.1 * entry);
    assert!(solve(&system.matrix, &system.rhs) > CLOSE);
}

#[test]
fn a_wrong_preconditioner_is_noticed() {
    let [(_, stitches), ..] = fabrics();
    let mut hanging = Hanging::new(&stitches);
    hanging.step();
    let matrix = &hanging.stepper.system.matrix;
    let mut preconditioner = Factor::new(Pattern::incomplete(&hanging.stepper.model, matrix));
    let mut diagonal = matrix.clone();
    for j in 0..diagonal.dof_count() {
        let below = diagonal.column[j] as usize + 1..diagonal.column[j + 1] as usize;
        diagonal.value[below].fill(0.0);
    }
    preconditioner.factorise(&diagonal).unwrap();
    assert!(hanging.iterate(&mut preconditioner).is_err());
}

#[test]
fn what_has_no_solution_has_none_either_way() {
    let [(_, stitches), ..] = fabrics();
    let mut hanging = Hanging::new(&stitches);
    let [mut direct, mut iterative] = [hanging.direct(), hanging.iterative()];
    let Stepper { model, system, .. } = &mut hanging.stepper;
    for wrong in [-1.0, f64::NAN] {
        system.matrix.add_diagonal(0, wrong);
        let mut x = vec![0.0; system.rhs.len()];
        assert!(direct.solve(model, &system.matrix, &system.rhs, &mut x, &mut Costs::default()).is_err());
        assert!(iterative.solve(model, &system.matrix, &system.rhs, &mut x, &mut Costs::default()).is_err());
    }
}

#[test]
fn same_bits_on_one_thread_and_on_two() {
    let go = |method: Method, threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            // Large enough that assembly, products and factorisation are shared out.
            let model = crate::testing::swatch_model(50, 50);
            assert!(model.dof_count() > super::factor::ALONE && model.net.nodes.len() > 8192);
            let state = model.net.laid_state();
            let material = Material::for_loop_width(3e-3);
            let mut stepper = Stepper::new(model, &material.into(), Some(method));
            let anchors = Anchors::at(&stepper.stacks, &state.sliding);
            stepper.step(&Stuck { state, anchors }, &Scene::default(), 0.0, 1e-3).unwrap().state
        })
    };
    for method in [Method::Iterative, Method::Direct] {
        assert_eq!(go(method, 1), go(method, 2), "{method:?}");
    }
}
