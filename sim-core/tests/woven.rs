//! Woven cloth: stable, stiff along its yarns, soft in shear until it locks.

#![allow(clippy::unwrap_used, reason = "helpers of tests are tests, and clippy can't tell")]

mod common;

use common::run;
use glam::DVec3;
use sim_core::{Body, Material, Pin, Scene, Simulator};
use std::sync::Arc;
use stitch_mesh::dye::Dye;
use stitch_mesh::weave::Woven;
use stitch_mesh::yarn_net::YarnNet;

/// Distance of the yarns [m].
const SPACING: f64 = 1.5e-3;

fn cloth(draft: &str, count: usize, flat: bool) -> Arc<YarnNet> {
    let draft = draft.parse().unwrap();
    let [warp, weft] = [[200, 180, 160], [40, 60, 120]].map(|rgb| Dye(rgb).into());
    let middle = DVec3::ZERO;
    Arc::new(Woven { draft, ends: count, picks: count, spacing: SPACING, warp, weft, middle, flat }.lay())
}

/// Yarn as thick as the cloth has it.
fn material() -> Material {
    let unit = Material::for_loop_width(1.0).drawn_radius;
    Material::for_loop_width(0.26 * SPACING / unit)
}

/// Force on the upper edge of a square piece whose lower edge is held, when the upper one is moved by `shift`, over its width
/// [N/m].
fn force(net: &Arc<YarnNet>, material: &Material, shift: DVec3) -> DVec3 {
    let heights = || net.nodes.iter().map(|n| n.position.y);
    let (low, high) = (heights().fold(f64::INFINITY, f64::min), heights().fold(-f64::INFINITY, f64::max));
    // The ends of the yarns with the crossings before them: held at crossings alone, yarn would be drawn through.
    let band = SPACING;
    let stiffness = 10.0 * material.stretch_stiffness() / SPACING;
    let mut pins = Vec::new();
    for (i, node) in net.nodes.iter().enumerate() {
        let moved = (node.position.y > high - band).then_some(shift);
        let held = (node.position.y < low + band).then_some(DVec3::ZERO);
        pins.extend(moved.or(held).map(|by| (i, moved.is_some(), node.position + by)));
    }
    let pin = |(i, _, target): &(usize, bool, DVec3)| Pin { node: *i as u32, target: *target, stiffness };
    let scene = Scene { pins: pins.iter().map(pin).collect(), ..Scene::empty() };
    // Sheared or stretched evenly to begin with, so that nothing leaps.
    let mut state = net.laid_state();
    for x in &mut state.position {
        *x += shift * ((x.y - low - band) / (high - low - 2.0 * band)).clamp(0.0, 1.0);
    }
    let mut simulator = Simulator::new(net, material.clone(), scene, state).unwrap();
    run(&mut simulator, 0.3);
    assert!(simulator.facts().rejected_steps < 5, "{:?}", simulator.facts());
    let upper = pins.iter().filter(|p| p.1);
    let pull = |(i, _, target): &(usize, bool, DVec3)| stiffness * (*target - simulator.state().position[*i]);
    upper.map(pull).sum::<DVec3>() / (high - low)
}

#[test]
fn cloth_is_stiff_along_its_yarns_and_shears_before_it_stretches() {
    let net = cloth("plain", 16, false);
    let material = material();
    let height = 14.6 * SPACING; // between the bands that are held
    let stretch = force(&net, &material, DVec3::Y * 0.01 * height).y / 0.01;
    let shear = force(&net, &material, DVec3::X * 0.05 * height).x / 0.05;
    let knit = common::stockinette(8, 10);
    let knitted = Material::for_loop_width(common::WIDTH);
    let knit_height = knit.nodes.iter().map(|n| n.position.y).fold(0.0, f64::max) * 2.0 - 2.0 * SPACING;
    let loops = force(&knit, &knitted, DVec3::Y * 0.01 * knit_height).y / 0.01;
    println!("stretch {stretch:.0} N/m, shear {shear:.1} N/m, knit {loops:.1} N/m");
    assert!(stretch > 100.0 * shear, "stretch {stretch} N/m, shear {shear} N/m");
    assert!(stretch > 10.0 * loops, "cloth {stretch} N/m, knit {loops} N/m");
    assert!(shear > 3.0 && shear < 300.0, "{shear} N/m");
}

/// Elastic energy of a piece in a picture frame that is sheared by an angle [J].
fn framed(net: &Arc<YarnNet>, angle: f64) -> f64 {
    let sheared = |x: DVec3| DVec3::new(x.x + angle.sin() * x.y, angle.cos() * x.y, x.z);
    let reach = net.nodes.iter().map(|n| n.position.x.max(n.position.y)).fold(0.0, f64::max);
    let stiffness = 10.0 * material().stretch_stiffness() / SPACING;
    let edge = |x: DVec3| x.x.abs().max(x.y.abs()) > reach - SPACING;
    let held = net.nodes.iter().enumerate().filter(|(_, n)| edge(n.position));
    let pins = held.map(|(i, n)| Pin { node: i as u32, target: sheared(n.position), stiffness });
    let scene = Scene { pins: pins.collect(), ..Scene::empty() };
    let mut state = net.laid_state();
    state.position.iter_mut().for_each(|x| *x = sheared(*x));
    let mut simulator = Simulator::new(net, material(), scene, state).unwrap();
    run(&mut simulator, 0.1);
    simulator.energies().elastic()
}

#[test]
fn shear_locks_when_neighbours_touch() {
    // They do at arccos(2R/s) = arccos 0.52 = 1.024.
    let net = cloth("plain", 10, false);
    let torque = |angle: f64| (framed(&net, angle + 0.02) - framed(&net, angle - 0.02)) / 0.04;
    let [soft, before, after] = [0.5, 0.95, 1.15].map(torque);
    println!("torque {soft:.2e}, {before:.2e} before locking, {after:.2e} N m after");
    assert!(before > 1.5 * soft && before < 3.0 * soft, "{soft} N m, {before} N m");
    // Without locking it would be 1.2 times. It is less than the stiffness of jamming alone makes it: the yarns give way between
    // the crossings.
    assert!(after > 4.0 * before, "{before} N m, {after} N m");
}

#[test]
fn cloth_hangs_and_drapes_and_keeps_its_yarn() {
    for draft in ["plain", "twill", "satin"] {
        let net = cloth(draft, 20, true);
        let material = material();
        let sphere = Body::Sphere { center: DVec3::NEG_Y * 7.5e-3, radius: 6e-3, friction: 0.4 };
        let scene = Scene { bodies: vec![sphere], ..Scene::default() };
        let mut simulator = Simulator::new(&net, material, scene, net.laid_state()).unwrap();
        run(&mut simulator, 0.4);
        let facts = simulator.facts();
        let low = simulator.state().position.iter().map(|x| x.y).fold(0.0, f64::min);
        println!("{draft}: {low:.4} m, {facts:?}");
        assert!(low < -6e-3, "{draft} does not drape: {low}");
        assert!(facts.max_stretch < 0.01 && facts.rejected_steps == 0, "{draft}: {facts:?}");
        assert!(facts.min_yarn_distance_over_diameter > 0.6, "{draft}: {facts:?}");
    }
}
