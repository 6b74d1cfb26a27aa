//! Yarns of unlike materials in one fabric.

mod common;

use common::{WIDTH, stockinette};
use glam::DVec3;
use sim_core::{Material, Materials, Preset, Scene, SimError, Simulator};
use std::sync::Arc;
use stitch_mesh::dye::Dye;
use stitch_mesh::yarn_net::YarnNet;

const RED: Dye = Dye([0xc0, 0x40, 0x30]);

/// A piece whose right half (by the laid positions of its nodes) is worked with red yarn.
fn half_red(wide: usize, high: usize) -> Arc<YarnNet> {
    let mut net = (*stockinette(wide, high)).clone();
    let middle = net.nodes.iter().map(|n| n.position.x).sum::<f64>() / net.nodes.len() as f64;
    let nodes = net.nodes.clone();
    for visit in Arc::make_mut(&mut net.visits) {
        if nodes[visit.node.index()].position.x > middle {
            visit.dye = RED;
        }
    }
    Arc::new(net)
}

fn with_red(red: Material) -> Materials {
    let mut materials = Materials::from(Material::for_loop_width(WIDTH));
    materials.by_dye.insert(RED, red);
    materials
}

#[test]
fn a_colour_with_the_material_of_the_rest_changes_nothing() {
    let net = half_red(6, 6);
    let wool = Material::for_loop_width(WIDTH);
    let run = |materials: Materials| {
        let mut simulator = Simulator::new(&net, materials, Scene::default(), net.laid_state()).unwrap();
        common::run(&mut simulator, 0.05);
        simulator.state().clone()
    };
    assert_eq!(run(wool.clone().into()), run(with_red(wool)));
}

#[test]
fn heavy_yarn_weighs_on_its_own_side() {
    let net = half_red(6, 6);
    let wool = Material::for_loop_width(WIDTH);
    let heavy = with_red(Material { density: 3.0 * wool.density, ..wool.clone() });
    let simulator = Simulator::new(&net, heavy.clone(), Scene::default(), net.laid_state()).unwrap();
    let masses = simulator.model().node_masses(&heavy);
    let plain = simulator.model().node_masses(&wool.into());
    let middle = net.nodes.iter().map(|n| n.position.x).sum::<f64>() / net.nodes.len() as f64;
    for (node, (mass, plain)) in net.nodes.iter().zip(masses.iter().zip(plain)) {
        // A segment belongs to the visit that it begins with, so a node beside the change may have some of both.
        if (node.position.x - middle).abs() > 2.0 * WIDTH {
            let factor = if node.position.x > middle { 3.0 } else { 1.0 };
            assert!((mass / plain - factor).abs() < 1e-12, "{} at {}", mass / plain, node.position.x);
        }
    }
}

#[test]
fn soft_yarn_gives_way_where_it_is() {
    // Pulled apart in its width by forces, the elastane half becomes the longer one.
    let net = half_red(8, 5);
    let soft = with_red(Preset::Elastane.material(WIDTH));
    let mut simulator = Simulator::new(&net, soft, Scene::empty(), net.laid_state()).unwrap();
    let ends = |low: bool| {
        let edge = net.nodes.iter().map(|n| n.position.x);
        let edge =
            if low { edge.fold(f64::INFINITY, f64::min) } else { edge.fold(f64::NEG_INFINITY, f64::max) };
        move |x: f64| (x - edge).abs() < 0.5 * WIDTH
    };
    let (left, right) = (ends(true), ends(false));
    let pins = net.nodes.iter().zip(0..).filter_map(|(n, node)| {
        let x = n.position.x;
        let pull = if left(x) {
            -0.3
        } else if right(x) {
            0.3
        } else {
            return None;
        };
        // As good as a constant force: a soft spring to a far target.
        Some(sim_core::Pin { node, target: n.position + DVec3::X * pull, stiffness: 0.1 })
    });
    simulator.set_scene(Scene { pins: pins.collect(), ..Scene::empty() }).unwrap();
    common::run(&mut simulator, 0.3);
    let stretch = |red: bool| {
        let of = |s: stitch_mesh::yarn_net::Segment| {
            let [a, b] = s.ends.map(|v| v.index());
            let state = simulator.state();
            let [p, q] = [a, b].map(|v| state.position[net.visits[v].node.index()]);
            p.distance(q) / (state.sliding[b] + s.wrap - state.sliding[a]) - 1.0
        };
        let chosen = net.segments().filter(|s| (net.visits[s.ends[0].index()].dye == RED) == red);
        chosen.map(of).fold(0.0, f64::max)
    };
    assert!(stretch(true) > 5.0 * stretch(false), "{} against {}", stretch(true), stretch(false));
}

#[test]
fn air_slows_what_falls() {
    let net = stockinette(5, 5);
    let fall = |air: f64| {
        let undamped = Material { mass_damping: 0.0, ..Material::for_loop_width(WIDTH) };
        let scene = Scene { air, ..Scene::default() };
        let mut simulator = Simulator::new(&net, undamped, scene, net.laid_state()).unwrap();
        common::run(&mut simulator, 1.0);
        let v = &simulator.state().velocity;
        -v.iter().sum::<DVec3>().y / v.len() as f64
    };
    assert!((fall(0.0) - 9.81).abs() < 0.01);
    // Where drag and weight balance: ρ g = c v, with ρ = 0.88 g/m and d = 0.84 mm that is 3.6 m/s.
    let (density, diameter) = (8.8e-4, 0.84e-3);
    let drag = |v: f64| {
        let reynolds = v * diameter / 1.5e-5;
        0.5 * 1.2 * diameter * v * v * (1.0 + 10.0 / f64::powf(reynolds, 2.0 / 3.0))
    };
    let (mut v, steps) = (1e-9, 10_000);
    for _ in 0..steps {
        v += (9.81 - drag(v) / density) / f64::from(steps);
    }
    assert!((fall(1.2) / v - 1.0).abs() < 0.02, "{} against {v}", fall(1.2));
}

#[test]
fn every_preset_knits() {
    let net = stockinette(6, 6);
    for preset in Preset::ALL {
        let mut simulator =
            Simulator::new(&net, preset.material(WIDTH), Scene::empty(), net.laid_state()).unwrap();
        common::run(&mut simulator, 0.3);
        let facts = simulator.facts();
        assert!(facts.rejected_steps < 10 && facts.max_stretch < 0.2, "{preset:?}: {facts:?}");
    }
}

#[test]
fn a_bad_yarn_is_named() {
    let net = half_red(3, 3);
    let bad = with_red(Material { radius: 0.0, ..Material::for_loop_width(WIDTH) });
    let refused = Simulator::new(&net, bad, Scene::empty(), net.laid_state());
    let Some(error @ SimError::Material(_)) = refused.err() else { panic!("not refused") };
    assert!(error.to_string().contains("yarn #c04030: radius is 0"), "{error}");
}
