//! What surrounds the fabric, and the fabric against itself: kernels against the CPU.

use super::agreement::{Pair, crumpled};
use super::{device, ten_fabrics};
use crate::closed_mesh::ClosedMesh;
use crate::closed_mesh::tests::cuboid;
use crate::gpu::GpuSimulator;
use crate::gpu::pattern::Room;
use crate::material::Material;
use crate::motion::{Key, Motion};
use crate::scene::{Clamp, Scene};
use crate::simulator::Simulator;
use crate::{Body, Pin};
use glam::DVec3;
use std::sync::Arc;

/// Bodies of every kind that reach into a fabric of `middle` [m].
fn bodies(middle: DVec3) -> Vec<(&'static str, Body)> {
    let friction = 0.4;
    let low = middle - DVec3::new(0.0, 2e-3, 0.0);
    let mut mesh = cuboid(DVec3::new(4e-3, 3e-3, 1e-3));
    mesh.positions.iter_mut().for_each(|x| *x += low);
    let capsule = Body::Capsule { from: low, to: low + DVec3::new(5e-3, 1e-3, 0.0), radius: 1e-3, friction };
    let motion = Motion {
        pivot: middle,
        keys: vec![
            Key { time_s: 0.0, shift: DVec3::ZERO, turn: DVec3::ZERO },
            Key { time_s: 1.0, shift: DVec3::new(0.02, 0.1, -0.05), turn: DVec3::new(0.3, 4.0, 1.0) },
        ],
        repeats: false,
    };
    vec![
        ("ground", Body::Ground { height: middle.y, friction }),
        ("sphere", Body::Sphere { center: low, radius: 3e-3, friction }),
        ("capsule", capsule.clone()),
        (
            "box",
            Body::Box { center: low, size: DVec3::splat(5e-3), turn: DVec3::new(0.2, 0.1, 0.4), friction },
        ),
        ("mesh", Body::Mesh { mesh: ClosedMesh::new(mesh).unwrap(), friction }),
        ("moving", Body::Moving { body: Box::new(capsule), motion }),
    ]
}

#[test]
fn bodies_pins_and_clamps_hold_as_on_the_cpu() {
    let Some(device) = device() else { return };
    let (_, net) = &ten_fabrics()[0];
    let state = crumpled(net);
    let middle = state.position.iter().sum::<DVec3>() / state.position.len() as f64;
    let all = bodies(middle);
    let alone = all.iter().map(|(name, body)| (*name, vec![body.clone()]));
    let together = ("all", all.iter().map(|(_, body)| body.clone()).collect());
    for (name, bodies) in alone.chain([together]) {
        let count = bodies.len();
        let pin = |node: u32| Pin { node, target: middle, stiffness: 3.0 };
        let clamp = Clamp {
            name: String::new(),
            nodes: vec![(4, middle), (9, middle)],
            stiffness: 2.0,
            motion: Motion::default(),
        };
        let scene = Scene { bodies, pins: vec![pin(4), pin(7)], clamps: vec![clamp], ..Scene::default() };
        let mut pair =
            Pair::new(&device, device.kernels().unwrap(), net, state.clone(), scene, Room::on(&device));
        let touching = pair.stepper.add_bodies(&pair.now.state.clone(), &pair.scene.clone(), 0.0, 5e-3).len();
        assert!(touching >= count, "{name}: {touching}");
        for (what, difference, bound) in pair.differences() {
            println!("{name}, {touching} touching: {what} {difference:.1e}");
            assert!(difference < bound, "{name}: {what} is off by {difference:.1e}");
        }
    }
}

#[test]
fn layers_press_each_other_as_on_the_cpu() {
    let Some(device) = device() else { return };
    let (_, net) = &ten_fabrics()[0];
    let mut state = crumpled(net);
    // Folded over in the middle, the halves closing in.
    let middle = state.position.iter().map(|x| x.x).sum::<f64>() / state.position.len() as f64;
    for (x, v) in state.position.iter_mut().zip(&mut state.velocity) {
        if x.x > middle {
            x.x = 2.0 * middle - x.x;
            x.z += 1.2e-3;
            v.z -= 0.2;
        }
    }
    let mut pair =
        Pair::new(&device, device.kernels().unwrap(), net, state, Scene::default(), Room::on(&device));
    let found = pair.differences();
    let tail = pair.stepper.system.matrix.tail.len();
    assert!(tail > 20, "{tail}");
    for (what, difference, bound) in found {
        println!("{tail} contacts: {what} {difference:.1e}");
        assert!(difference < bound, "{what} is off by {difference:.1e}");
    }
}

#[test]
fn the_ground_carries_the_weight_of_what_lies_on_it() {
    let Some(device) = device() else { return };
    let (_, net) = ten_fabrics().swap_remove(1);
    let net = Arc::new(net);
    let material = Material { mass_damping: 40.0, ..Material::for_loop_width(3e-3) };
    let mut state = net.laid_state();
    let lying = |x: DVec3| DVec3::new(x.x, x.z + 2.0 * material.drawn_radius, -x.y);
    state.position.iter_mut().for_each(|x| *x = lying(*x));
    let bodies = vec![Body::Ground { height: 0.0, friction: 0.3 }];
    let scene = Scene { bodies, ..Scene::default() };
    let mut on_gpu =
        GpuSimulator::new(&device, &net, material.clone(), scene.clone(), state.clone()).unwrap();
    let mut on_cpu = Simulator::new(&net, material, scene.clone(), state).unwrap();
    while on_cpu.time_s() < 0.3 {
        on_cpu.step().unwrap();
        on_gpu.step().unwrap();
    }
    on_gpu.state().unwrap();
    let weight = on_cpu.model().node_masses(on_cpu.materials()).iter().sum::<f64>() * scene.gravity.length();
    for (name, holds) in [("cpu", on_cpu.holds()), ("gpu", on_gpu.holds())] {
        let [ground] = &holds[..] else { panic!("{holds:?}") };
        println!("{name}: {:?} of {weight:e} N", ground.force_n);
        assert!(ground.force_n.distance(weight * DVec3::Y) < 0.05 * weight, "{name}: {:?}", ground.force_n);
    }
}
