//! What holds for any fabric: conservation, energy that does not grow, and bad input that changes nothing.

mod common;

use common::{WIDTH, stockinette, swatch};
use glam::DVec3;
use sim_core::{Body, Material, Materials, Pin, Scene, SettleGoal, Settled, SimError, Simulator};
use std::ops::ControlFlow;
use std::sync::Arc;
use stitch_mesh::yarn_net::{YarnNet, YarnState};

fn undamped() -> Material {
    Material { mass_damping: 0.0, stiffness_damping: 0.0, ..Material::for_loop_width(WIDTH) }
}

/// Mass-weighted sums over nodes: momentum and angular momentum about the centre of mass.
fn momenta(simulator: &Simulator) -> (DVec3, DVec3, f64) {
    let masses = simulator.model().node_masses(simulator.materials());
    let state = simulator.state();
    let sum = |of: &dyn Fn(usize) -> DVec3| (0..masses.len()).map(|i| masses[i] * of(i)).sum::<DVec3>();
    let mass: f64 = masses.iter().sum();
    let center = sum(&|i| state.position[i]) / mass;
    let momentum = sum(&|i| state.velocity[i]);
    let spin = sum(&|i| (state.position[i] - center).cross(state.velocity[i]));
    (momentum, spin, mass)
}

fn thrown(net: &Arc<YarnNet>) -> YarnState {
    let mut state = net.laid_state();
    for (v, x) in state.velocity.iter_mut().zip(&state.position) {
        *v = DVec3::new(0.5, 1.0, -0.3) + DVec3::new(2.0, 1.0, 8.0).cross(*x);
    }
    state
}

#[test]
fn momentum_is_conserved() {
    let net = swatch(8, 8, |s, _| s / 2 % 2 == 1);
    let mut simulator = Simulator::new(&net, undamped(), Scene::empty(), thrown(&net)).unwrap();
    let (momentum, spin, mass) = momenta(&simulator);
    common::run(&mut simulator, 0.2);
    let (momentum_after, spin_after, _) = momenta(&simulator);
    println!("{momentum} -> {momentum_after}, {spin} -> {spin_after}, mass {mass}");
    assert!(momentum.distance(momentum_after) < 0.02 * momentum.length());
    assert!(spin.distance(spin_after) < 0.05 * spin.length());
}

#[test]
fn rotation_survives_a_taut_fabric() {
    // Two percent longer than the yarn: tension everywhere, which a plain linearised step turns into a brake.
    let net = stockinette(6, 6);
    let mut state = thrown(&net);
    state.position.iter_mut().for_each(|x| *x *= 1.02);
    let mut simulator = Simulator::new(&net, undamped(), Scene::empty(), state).unwrap();
    let (_, spin, _) = momenta(&simulator);
    common::run(&mut simulator, 0.1);
    let (_, spin_after, _) = momenta(&simulator);
    println!("{spin} -> {spin_after}");
    assert!(spin.distance(spin_after) < 0.05 * spin.length());
}

#[test]
fn energy_of_a_free_swing_does_not_grow() {
    let net = stockinette(8, 8);
    // From a relaxed shape: the first steps from the laid one are far from any linearisation.
    let mut relaxed = common::free(&net);
    common::run(&mut relaxed, 0.3);
    let materials = Materials::from(undamped());
    let node = 0;
    let pin = Pin { node: 0, target: relaxed.state().position[node], stiffness: 10.0 };
    let scene = Scene { pins: vec![pin], ..Scene::default() };
    let mut simulator = relaxed;
    simulator.set_materials(materials.clone()).unwrap();
    simulator.set_scene(scene).unwrap();
    let energy = |s: &Simulator| {
        let masses = s.model().node_masses(&materials);
        let weight: f64 = masses.iter().zip(&s.state().position).map(|(m, x)| 9.81 * m * x.y).sum();
        let held = 0.5 * 10.0 * s.state().position[node].distance_squared(pin.target);
        s.energies().kinetic + s.energies().elastic() + weight + held
    };
    let (start, mut before) = (energy(&simulator), 0.0);
    let mut largest_kinetic: f64 = 0.0;
    for _ in 0..100 {
        simulator.step().unwrap();
        largest_kinetic = largest_kinetic.max(simulator.kinetic_energy());
        let now = energy(&simulator);
        // Yarns slide back a little as damping ends; what their friction springs held is not counted here.
        assert!(now < 1.01 * start, "{start} -> {now}");
        before = now;
    }
    println!("{start:.3e} -> {before:.3e}, kinetic at most {largest_kinetic:.3e}");
    assert!(before < start);
}

#[test]
fn cloth_falls_and_lies_on_a_ball_and_the_ground() {
    let net = stockinette(10, 10);
    let turn = |x: DVec3| DVec3::new(x.x, x.z, -x.y);
    let mut state = net.laid_state();
    state.position.iter_mut().for_each(|x| *x = turn(*x) + DVec3::Y * 0.03);
    let ball = Body::Sphere { center: DVec3::ZERO, radius: 0.008, friction: 0.4 };
    let ground = Body::Ground { height: -0.001, friction: 0.4 };
    let scene = Scene { bodies: vec![ball, ground], ..Scene::default() };
    let mut simulator = Simulator::new(&net, Material::for_loop_width(WIDTH), scene, state).unwrap();
    common::run(&mut simulator, 1.0);
    let facts = simulator.facts();
    println!("{facts:?}");
    assert!(facts.max_penetration_mm < 0.3 && facts.max_stretch < 0.05);
    let height = |x: &DVec3| x.y;
    let lowest = simulator.state().position.iter().map(height).fold(f64::INFINITY, f64::min);
    let highest = simulator.state().position.iter().map(height).fold(f64::NEG_INFINITY, f64::max);
    println!("from {lowest:.4} to {highest:.4} m");
    assert!(highest > 0.008 && highest - lowest > 0.006, "draped over the ball");
    assert!(lowest > -0.001);
}

#[test]
fn same_input_same_bits() {
    let go = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let net = stockinette(6, 6);
            let mut simulator = common::free(&net);
            common::run(&mut simulator, 0.05);
            simulator.state().clone()
        })
    };
    assert_eq!(go(1), go(2));
}

#[test]
fn bad_input_is_refused() {
    let net = stockinette(4, 4);
    let material = Material::for_loop_width(WIDTH);
    let with_state = |spoil: &dyn Fn(&mut YarnState)| {
        let mut state = net.laid_state();
        spoil(&mut state);
        Simulator::new(&net, material.clone(), Scene::empty(), state).err()
    };
    assert!(matches!(with_state(&|s| s.position[7].y = f64::NAN), Some(SimError::StateNotFinite)));
    assert!(matches!(with_state(&|s| s.position.truncate(3)), Some(SimError::StateShape { .. })));
    assert!(matches!(with_state(&|s| s.sliding[5] = s.sliding[6]), Some(SimError::StateWithoutYarn(5))));
    let coincident = with_state(&|s| s.position[9] = s.position[8]).unwrap().to_string();
    assert_eq!(coincident, "nodes 8 and 9 follow each other on a yarn and are at the same place");
    let mut broken = (*net).clone();
    let same = broken.visits[6].u;
    Arc::make_mut(&mut broken.visits)[5].u = same;
    let refused = Simulator::new(&Arc::new(broken), material.clone(), Scene::empty(), net.laid_state());
    assert!(matches!(refused.err(), Some(SimError::Net(_))));
}

#[test]
fn absurd_forces_are_rejected_and_leave_the_state_as_it_was() {
    let net = stockinette(4, 4);
    let mut simulator = common::free(&net);
    simulator.step().unwrap();
    let before = simulator.state().clone();
    for target in [DVec3::X * 1e30, DVec3::splat(1e200)] {
        let pin = Pin { node: 20, target, stiffness: 1e30 };
        simulator.set_scene(Scene { pins: vec![pin], ..Scene::empty() }).unwrap();
        assert!(matches!(simulator.step(), Err(SimError::Stuck { .. })));
        assert_eq!(simulator.state(), &before);
    }
    let no_node = Pin { node: 1_000_000, target: DVec3::ZERO, stiffness: 1.0 };
    assert!(simulator.set_scene(Scene { pins: vec![no_node], ..Scene::empty() }).is_err());
    let absurd = Material { density: f64::INFINITY, ..simulator.materials().base.clone() };
    assert!(simulator.set_materials(absurd).is_err());
    simulator.set_scene(Scene::empty()).unwrap();
    simulator.step().unwrap();
}

#[test]
fn a_simulation_begins_with_short_steps() {
    let net = stockinette(3, 3);
    let steps = |time_step: f64| -> Vec<f64> {
        let scene = Scene { time_step, ..Scene::empty() };
        let material = Material::for_loop_width(WIDTH);
        let mut simulator = Simulator::new(&net, material, scene, net.laid_state()).unwrap();
        (0..5).map(|_| simulator.step().unwrap().time_step).collect()
    };
    let near = |a: &[f64], b: [f64; 5]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-9);
    assert!(near(&steps(2e-3), [2e-3; 5]));
    assert!(near(&steps(12e-3), [5e-3, 7e-3, 9.8e-3, 12e-3, 12e-3]));
}

#[test]
fn time_step_recovers_after_rejections() {
    let net = stockinette(6, 6);
    // Drawn away by one node so strongly that only small steps take the fabric along at first.
    let target = net.nodes[50].position + 0.05 * DVec3::Z;
    let pin = Pin { node: 50, target, stiffness: 5.0 };
    let scene = Scene { pins: vec![pin], time_step: 1e-2, ..Scene::empty() };
    let material = Material::for_loop_width(WIDTH);
    let mut simulator = Simulator::new(&net, material, scene, net.laid_state()).unwrap();
    let first = simulator.step().unwrap();
    assert!(first.rejected > 0 && first.time_step < 5e-3, "{first:?}");
    // Each step that goes well at once is longer than the one before, up to that of the scene.
    let mut before = first.time_step;
    let mut whole = 0;
    for _ in 0..100 {
        let step = simulator.step().unwrap();
        let wanted = (1.4 * before).min(1e-2);
        assert!(step.rejected > 0 || (step.time_step - wanted).abs() < 1e-12, "{step:?} after {before}");
        assert!(step.rejected == 0 || step.time_step < wanted, "{step:?} after {before}");
        whole += usize::from(step.time_step == 1e-2);
        before = step.time_step;
    }
    assert!(whole > 0);
}

#[test]
fn settling_ends() {
    let net = swatch(6, 6, |_, t| t % 2 == 1);
    let mut simulator = common::free(&net);
    let goal = SettleGoal { speed: 1e-3, time_limit_s: 2.0 };
    let mut reports = 0;
    let settled = simulator.settle(goal, &mut |_| {
        reports += 1;
        ControlFlow::Continue(())
    });
    println!("settled after {:.2} s", simulator.time_s());
    assert_eq!(settled.unwrap(), Settled::Still);
    assert!(reports > 0);
    let goal = SettleGoal { speed: 0.0, time_limit_s: 2.0 };
    assert_eq!(simulator.settle(goal, &mut |_| ControlFlow::Break(())).unwrap(), Settled::Interrupted);
    let goal = SettleGoal { speed: 0.0, time_limit_s: 0.03 };
    assert_eq!(simulator.settle(goal, &mut |_| ControlFlow::Continue(())).unwrap(), Settled::TimeLimit);
}
