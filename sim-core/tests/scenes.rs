//! What surrounds a fabric: clamps, bodies that move, and the forces of both.

#![allow(clippy::unwrap_used, clippy::panic, reason = "helpers of tests are tests, and clippy can't tell")]

mod common;

use common::{WIDTH, run, stockinette};
use glam::DVec3;
use sim_core::{
    Body, Clamp, ClosedMesh, Frames, Key, Material, MeshSequence, Motion, Pin, Scene, Simulator, Triangles,
};
use std::sync::Arc;
use stitch_mesh::yarn_net::YarnNet;

fn simulator(net: &Arc<YarnNet>, scene: Scene) -> Simulator {
    Simulator::new(net, Material::for_loop_width(WIDTH), scene, net.laid_state()).unwrap()
}

fn weight(simulator: &Simulator) -> f64 {
    9.81 * simulator.model().node_masses(simulator.materials()).iter().sum::<f64>()
}

fn mean_velocity(simulator: &Simulator) -> DVec3 {
    let v = &simulator.state().velocity;
    v.iter().sum::<DVec3>() / v.len() as f64
}

/// A motion at a speed [m/s] for `time_s`, then rest.
fn speed(v: DVec3, time_s: f64) -> Motion {
    let key = |time_s: f64| Key { time_s, shift: time_s * v, turn: DVec3::ZERO };
    Motion { keys: vec![key(0.0), key(time_s)], ..Motion::default() }
}

fn moving(body: Body, motion: Motion) -> Body {
    Body::Moving { body: Box::new(body), motion }
}

/// The nodes at one end of a net along an axis, within half a loop, as a clamp that holds them where they were laid.
fn clamp(net: &YarnNet, direction: DVec3, motion: Motion) -> Clamp {
    let along = |x: DVec3| x.dot(direction);
    let end = net.nodes.iter().map(|n| along(n.position)).fold(f64::NEG_INFINITY, f64::max);
    let nodes = net.nodes.iter().zip(0..).filter(|(n, _)| along(n.position) > end - 0.5 * WIDTH);
    let nodes = nodes.map(|(n, i)| (i, n.position)).collect();
    Clamp { name: "end".into(), nodes, stiffness: 10.0, motion }
}

#[test]
fn pins_and_clamps_carry_the_weight() {
    let net = stockinette(6, 6);
    let top = clamp(&net, DVec3::Y, Motion::default());
    let pins = top.pins(0.0).collect::<Vec<Pin>>();
    for scene in [
        Scene { clamps: vec![top.clone()], ..Scene::default() },
        Scene { pins: pins.clone(), ..Scene::default() },
    ] {
        let mut simulator = simulator(&net, scene);
        run(&mut simulator, 3.0);
        let forces = simulator.forces();
        let sum: DVec3 = forces.pins.iter().chain(&forces.clamps).sum();
        let weight = weight(&simulator);
        assert!((sum - weight * DVec3::Y).length() < 0.01 * weight, "{sum} against {weight}");
        let [hold] = &simulator.holds()[..] else { panic!("one hold") };
        assert_eq!(hold.force_n, sum);
    }
}

#[test]
fn the_ground_carries_the_weight() {
    let net = stockinette(5, 5);
    let low = net.nodes.iter().map(|n| n.position.y).fold(f64::INFINITY, f64::min);
    // Flat on its back.
    let mut state = net.laid_state();
    state.position.iter_mut().for_each(|x| *x = DVec3::new(x.x, low + x.z, x.y));
    let ground = Body::Ground { height: low - 1e-3, friction: 0.4 };
    let scene = Scene { bodies: vec![ground], ..Scene::default() };
    let mut simulator = Simulator::new(&net, Material::for_loop_width(WIDTH), scene, state).unwrap();
    run(&mut simulator, 1.5);
    let (force, weight) = (simulator.forces().bodies[0], weight(&simulator));
    assert!((force.y / weight - 1.0).abs() < 0.02, "{force} against {weight}");
}

#[test]
fn moving_clamps_pull_each_other() {
    let net = stockinette(8, 5);
    let (right, left) = (
        clamp(&net, DVec3::X, speed(DVec3::X * 0.02, 0.2)),
        clamp(&net, DVec3::NEG_X, speed(DVec3::NEG_X * 0.02, 0.2)),
    );
    let mut simulator = simulator(&net, Scene { clamps: vec![right.clone(), left], ..Scene::empty() });
    run(&mut simulator, 1.2);
    let [a, b] = simulator.forces().clamps[..] else { panic!("two clamps") };
    assert!(a.x > 1e-3 && (a + b).length() < 0.01 * a.length(), "{a} {b}");
    // Hooke's law at every node, the clamp 4 mm further out than it began.
    let state = simulator.state();
    let spring =
        |(node, target): &(u32, DVec3)| 10.0 * (target + 0.004 * DVec3::X - state.position[*node as usize]);
    let expected: DVec3 = right.nodes.iter().map(spring).sum();
    assert!((a - expected).length() < 1e-9, "{a} {expected}");
}

#[test]
fn a_moving_ground_takes_fabric_along() {
    let net = stockinette(5, 5);
    let mut state = net.laid_state();
    let low = net.nodes.iter().map(|n| n.position.z).fold(f64::INFINITY, f64::min);
    state.position.iter_mut().for_each(|x| *x = DVec3::new(x.x, x.z - low, x.y));
    let belt = |friction: f64| {
        let ground = Body::Ground { height: -0.9e-3, friction };
        let scene = Scene { bodies: vec![moving(ground, speed(DVec3::X * 0.1, 10.0))], ..Scene::default() };
        let mut simulator =
            Simulator::new(&net, Material::for_loop_width(WIDTH), scene, state.clone()).unwrap();
        run(&mut simulator, 0.6);
        mean_velocity(&simulator).x
    };
    assert!((belt(0.4) - 0.1).abs() < 5e-3, "{}", belt(0.4));
    assert!(belt(0.0).abs() < 2e-3, "{}", belt(0.0));
}

#[test]
fn a_moving_capsule_pushes_fabric_without_going_through() {
    let net = stockinette(8, 8);
    let middle = net.nodes.iter().map(|n| n.position).sum::<DVec3>() / net.nodes.len() as f64;
    let radius = 0.01;
    let from = middle + DVec3::new(-0.05, 0.0, -0.015);
    let rod = Body::Capsule { from, to: from + DVec3::X * 0.1, radius, friction: 0.3 };
    let scene = Scene { bodies: vec![moving(rod, speed(DVec3::Z * 0.4, 0.2))], ..Scene::empty() };
    let mut simulator = simulator(&net, scene);
    let mut deepest: f64 = 0.0;
    while simulator.time_s() < 0.2 {
        simulator.step().unwrap();
        deepest = deepest.max(simulator.facts().max_penetration_mm);
    }
    // Less than the radius of the yarn as drawn: the yarn itself does not reach the rod.
    assert!(deepest < 0.42, "{deepest} mm");
    // What was hit in its middle flies along, in front of the rod.
    assert!(mean_velocity(&simulator).z > 0.35, "{}", mean_velocity(&simulator));
    let rod_z = from.z + 0.4 * 0.2;
    let in_front = simulator.state().position.iter().all(|x| x.z > rod_z - 2.0 * radius);
    assert!(in_front && simulator.scene_time_s() >= 0.2);
}

#[test]
fn fabric_lies_on_a_mesh() {
    let net = stockinette(5, 5);
    let mut state = net.laid_state();
    let (low, middle) = (
        net.nodes.iter().map(|n| n.position.z).fold(f64::INFINITY, f64::min),
        net.nodes.iter().map(|n| n.position).sum::<DVec3>() / net.nodes.len() as f64,
    );
    state.position.iter_mut().for_each(|x| *x = DVec3::new(x.x - middle.x, x.z - low + 2e-3, x.y - middle.y));
    // A table: an octahedron cut flat would do, a box has corners to fall over.
    let half = DVec3::new(0.02, 0.01, 0.02);
    let corner = |i: u32| {
        let sign = |bit: u32| if i >> bit & 1 == 1 { 1.0 } else { -1.0 };
        half * DVec3::new(sign(0), sign(1), sign(2)) - DVec3::Y * 0.01
    };
    let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let mesh = Triangles {
        positions: (0..8).map(corner).collect(),
        triangles: quads.iter().flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]).collect(),
    };
    let table = Body::Mesh { mesh: ClosedMesh::new(mesh).unwrap(), friction: 0.4 };
    let scene = Scene { bodies: vec![table], ..Scene::default() };
    let mut simulator = Simulator::new(&net, Material::for_loop_width(WIDTH), scene, state).unwrap();
    run(&mut simulator, 0.5);
    let facts = simulator.facts();
    assert!(facts.max_penetration_mm < 0.1, "{facts:?}");
    let clearance = 2.0 * simulator.materials().base.drawn_radius;
    let lowest = simulator.state().position.iter().map(|x| x.y).fold(f64::INFINITY, f64::min);
    assert!((lowest - clearance).abs() < 0.3e-3, "lies at {lowest}");
}

/// A table that walks to the right on its frames and lies down meanwhile takes along what lies on it.
#[test]
fn fabric_is_carried_by_a_mesh_that_changes_its_shape() {
    let net = stockinette(5, 5);
    let mut state = net.laid_state();
    let low = net.nodes.iter().map(|n| n.position.z).fold(f64::INFINITY, f64::min);
    state.position.iter_mut().for_each(|x| *x = DVec3::new(x.x, x.z - low + 2e-3, x.y));
    let middle = state.position.iter().sum::<DVec3>() / state.position.len() as f64;
    state.position.iter_mut().for_each(|x| *x -= middle.with_y(0.0));
    // Its top stays level and goes 0.1 m/s to the right and 0.02 m/s down; its feet stay.
    let frame = |i: usize| {
        let t = i as f64 * 0.04;
        let corner = |i: u32| {
            let sign = |bit: u32| if i >> bit & 1 == 1 { 1.0 } else { -1.0 };
            let moved = if i >> 1 & 1 == 1 { DVec3::new(0.1, -0.02, 0.0) * t } else { DVec3::ZERO };
            DVec3::new(0.025, 0.02, 0.02) * DVec3::new(sign(0), sign(1), sign(2)) - DVec3::Y * 0.02 + moved
        };
        (0..8).map(corner).collect()
    };
    let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let frames = Frames {
        triangles: quads.iter().flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]).collect(),
        positions: (0..10).map(frame).collect(),
        interval_s: 0.04,
        repeats: false,
    };
    let table = |friction| Body::Sequence { frames: MeshSequence::new(frames.clone()).unwrap(), friction };
    let carried = |friction: f64| {
        let scene = Scene { bodies: vec![table(friction)], ..Scene::default() };
        let material = Material::for_loop_width(WIDTH);
        let mut simulator = Simulator::new(&net, material, scene, state.clone()).unwrap();
        run(&mut simulator, 0.3);
        let facts = simulator.facts();
        assert!(facts.max_penetration_mm < 0.2, "{facts:?}");
        mean_velocity(&simulator)
    };
    let (rough, smooth) = (carried(0.5), carried(0.0));
    println!("{rough} with friction, {smooth} without");
    assert!((rough.x - 0.1).abs() < 0.01 && (rough.y + 0.02).abs() < 5e-3);
    assert!(smooth.x.abs() < 0.03, "without friction the table goes away under it");
}

#[test]
fn what_moves_begins_with_its_scene_and_goes_on_through_a_drag() {
    let net = stockinette(3, 3);
    let ground = moving(Body::Ground { height: -1.0, friction: 0.4 }, speed(DVec3::Y * 0.01, 1.0));
    let scene = Scene { bodies: vec![ground], ..Scene::empty() };
    let mut simulator = simulator(&net, Scene::empty());
    run(&mut simulator, 0.1);
    simulator.set_scene(scene.clone()).unwrap();
    assert_eq!(simulator.scene_time_s(), 0.0);
    run(&mut simulator, 0.2);
    let before = simulator.scene_time_s();
    let pin = Pin { node: 0, target: DVec3::ZERO, stiffness: 0.1 };
    simulator.set_scene(Scene { pins: vec![pin], ..scene }).unwrap();
    assert_eq!(simulator.scene_time_s(), before);
}

#[test]
fn scenes_without_sense_name_what_is_wrong() {
    let net = stockinette(3, 3);
    let refused = |scene: Scene| {
        Simulator::new(&net, Material::for_loop_width(WIDTH), scene, net.laid_state())
            .err()
            .unwrap()
            .to_string()
    };
    let jaw = Clamp {
        name: "jaw".into(),
        nodes: vec![(9999, DVec3::ZERO)],
        stiffness: 1.0,
        motion: Motion::default(),
    };
    let message = refused(Scene { clamps: vec![jaw.clone()], ..Scene::empty() });
    assert!(message.contains("clamp 'jaw' holds node 9999"), "{message}");
    let weak = Clamp { nodes: vec![], stiffness: -1.0, ..jaw };
    assert!(refused(Scene { clamps: vec![weak], ..Scene::empty() }).contains("clamp 'jaw'"));
    let twice = moving(
        moving(Body::Ground { height: 0.0, friction: 0.0 }, speed(DVec3::X, 1.0)),
        speed(DVec3::X, 1.0),
    );
    assert!(refused(Scene { bodies: vec![twice], ..Scene::empty() }).contains("body 0"));
    assert!(refused(Scene { air: -1.0, ..Scene::empty() }).contains("density of the air"));
}
