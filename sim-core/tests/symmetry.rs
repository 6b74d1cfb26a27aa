//! What a fabric does not depend on: which way it is turned, and which hand knits it.

#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "helpers of tests are tests, and clippy can't tell"
)]

mod common;

use common::{WIDTH, mean_position, run, stockinette, swatch};
use glam::{DQuat, DVec3};
use sim_core::{Material, Scene, Simulator};
use std::sync::Arc;
use stitch_mesh::yarn_net::YarnNet;

/// The same net, turned as a whole.
fn turned(net: &YarnNet, turn: DQuat) -> Arc<YarnNet> {
    let mut net = net.clone();
    for node in &mut net.nodes {
        (node.position, node.normal) = (turn * node.position, turn * node.normal);
    }
    Arc::new(net)
}

fn relaxed(net: &Arc<YarnNet>, gravity: DVec3) -> Simulator {
    let scene = Scene { gravity, ..Scene::empty() };
    let mut simulator =
        Simulator::new(net, Material::for_loop_width(WIDTH), scene, net.laid_state()).unwrap();
    run(&mut simulator, 0.05);
    simulator
}

#[test]
fn a_turned_fabric_does_the_same_turned() {
    let net = stockinette(8, 8);
    let turn = DQuat::from_axis_angle(DVec3::new(0.48, 0.6, 0.64), 1.1);
    let gravity = DVec3::new(0.0, -9.81, 0.0);
    let (plain, other) = (relaxed(&net, gravity), relaxed(&turned(&net, turn), turn * gravity));
    let apart = |a: &Simulator, b: &Simulator, turn: DQuat| {
        let pairs = a.state().position.iter().zip(&b.state().position);
        let squares = pairs.map(|(a, b)| (turn * *a).distance_squared(*b)).sum::<f64>();
        (squares / a.state().position.len() as f64).sqrt()
    };
    let difference = apart(&plain, &other, turn);
    let moved = 0.5 * 9.81 * plain.time_s().powi(2);
    println!("{difference:.1e} m apart after {moved:.1e} m");
    // The noise that it starts with, a micrometre, is not turned along, and grows where loops snap over.
    assert!(difference < 5e-3 * moved);
    // With gravity left as it was they would differ.
    assert!(apart(&plain, &relaxed(&turned(&net, turn), gravity), turn) > 0.1 * moved);
}

#[test]
fn symmetric_fabrics_stay_symmetric() {
    let (wide, high) = (10, 8);
    let asymmetry = |purl: fn(usize, usize) -> bool| {
        let net = swatch(wide, high, purl);
        let simulator = relaxed(&net, DVec3::ZERO);
        let at = |s: usize, t: usize| mean_position(&net, simulator.state(), |f| f == t * wide + s);
        let center = mean_position(&net, simulator.state(), |_| true);
        // Inside: cast-on and bind-off begin at one side, and rows turn at one side.
        let places = (2..high - 2).flat_map(|t| (2..wide / 2).map(move |s| (s, t)));
        let differ = |(s, t)| {
            let (left, right) = (at(s, t) - center, at(wide - 1 - s, t) - center);
            (left * DVec3::new(-1.0, 1.0, 1.0)).distance(right)
        };
        places.map(differ).fold(0.0, f64::max) / WIDTH
    };
    for (name, purl) in [
        ("stockinette", (|_, _| false) as fn(usize, usize) -> bool),
        ("rib 2 × 2", |s, _| s / 2 % 2 == 1),
        ("garter", |_, t| t % 2 == 1),
    ] {
        let found = asymmetry(purl);
        println!("{name}: {found:.3} loops");
        assert!(found < 0.15, "{name}");
    }
    let found = asymmetry(|s, _| s > 6);
    println!("knit beside purl: {found:.3} loops");
    assert!(found > 0.15, "a fabric that is not symmetric");
}
