//! What knitted fabrics are known to do. Distances in mm.

mod common;

use common::{
    WIDTH, edge_heights, free, least_layer_distance, mean_position, run, size, stockinette, swatch,
};
use sim_core::{Body, Material, Model, Scene, Simulator, least_distance};

/// Curl is bistable: either pair of edges rolls in the end and pulls the other pair with it. At first both go their way.
#[test]
fn free_stockinette_curls_top_and_bottom_to_the_front_and_sides_to_the_back() {
    let net = stockinette(24, 24);
    let mut simulator = free(&net);
    run(&mut simulator, 0.2);
    let [bottom, top, left, right] = edge_heights(&net, simulator.state(), 24, 24).map(|x| 1e3 * x);
    println!("after 0.2 s: bottom {bottom:.1} top {top:.1} left {left:.1} right {right:.1}");
    assert!(bottom > 2.0 && top > 2.0 && left < -1.5 && right < -1.5);
    run(&mut simulator, 0.6);
    let [bottom, top, ..] = edge_heights(&net, simulator.state(), 24, 24).map(|x| 1e3 * x);
    println!("after 0.6 s: bottom {bottom:.1} top {top:.1}");
    assert!(bottom > 8.0 && top > 8.0);
    let facts = simulator.facts();
    println!("{facts:?}");
    assert!(facts.max_stretch < 0.02 && facts.rejected_steps < 5);
}

#[test]
fn narrow_stockinette_rolls_its_sides_to_the_back() {
    let net = stockinette(10, 36);
    let mut simulator = free(&net);
    run(&mut simulator, 0.5);
    let [.., left, right] = edge_heights(&net, simulator.state(), 10, 36).map(|x| 1e3 * x);
    println!("left {left:.1} right {right:.1}");
    assert!(left < -4.0 && right < -4.0);
}

#[test]
fn rib_draws_in_to_less_than_half_its_width() {
    let (wide, high) = (20, 20);
    let net = swatch(wide, high, |s, _| s / 2 % 2 == 1);
    let mut simulator = free(&net);
    // Cast-on and bind-off do not draw in; the width is that of the rows between.
    let width = |simulator: &Simulator| {
        let side = |column| {
            mean_position(&net, simulator.state(), |f| f % wide == column && (7..13).contains(&(f / wide)))
        };
        1e3 * side(0).distance(side(wide - 1))
    };
    let laid = width(&simulator);
    run(&mut simulator, 0.8);
    let relaxed = width(&simulator);
    println!("rib {laid:.1} -> {relaxed:.1} {:?}", simulator.facts());
    assert!(relaxed < 0.5 * laid);
}

#[test]
fn garter_stays_flat_and_keeps_its_size() {
    let (wide, high) = (20, 20);
    let net = swatch(wide, high, |_, t| t % 2 == 1);
    let mut simulator = free(&net);
    let laid = size(simulator.state());
    run(&mut simulator, 0.6);
    let relaxed = size(simulator.state());
    let heights = edge_heights(&net, simulator.state(), wide, high).map(|x| 1e3 * x);
    println!("garter {laid} -> {relaxed}, {heights:.1?}");
    assert!(heights.iter().all(|h| h.abs() < 3.0));
    assert!((0.9..1.1).contains(&(relaxed.x / laid.x)) && (0.85..1.1).contains(&(relaxed.y / laid.y)));
}

#[test]
fn rows_of_stockinette_do_not_lean() {
    let (wide, high) = (16, 16);
    let net = stockinette(wide, high);
    let mut simulator = free(&net);
    run(&mut simulator, 0.3);
    let stitch = |s: usize, t: usize| mean_position(&net, simulator.state(), |f| f == t * wide + s);
    // A herringbone leans to the left in one row and to the right in the next.
    let (mut lean, mut count) = (0.0, 0.0);
    for (s, t) in (5..11).flat_map(|s| (4..12).map(move |t| (s, t))) {
        let wale = (stitch(s, t + 1) - stitch(s, t)).normalize();
        let course = (stitch(s + 1, t) - stitch(s - 1, t)).normalize();
        lean += if t % 2 == 0 { 1.0 } else { -1.0 } * wale.dot(course);
        count += 1.0;
    }
    println!("lean {:.4}", lean / count);
    assert!((lean / count).abs() < 0.03);
}

#[test]
fn plain_knit_has_at_most_eleven_blocks_a_row() {
    let side = 12;
    let net = stockinette(side, side);
    let sizes = Model::new(net.clone()).unwrap().block_row_sizes();
    let inside = |f: usize| (1..side - 1).contains(&(f % side)) && (1..side - 1).contains(&(f / side));
    let inner = net.nodes.iter().zip(&sizes).filter(|(n, _)| n.face.is_some_and(|f| inside(f.index())));
    let most = inner.map(|(_, s)| *s).max().unwrap();
    println!("{most} blocks");
    assert!(most <= 11);
}

#[test]
fn yarns_of_a_flat_fabric_pass_each_other() {
    // Corners left out: there the ends of three rows meet in one place.
    let net = stockinette(8, 8);
    let thin = Material { drawn_radius: 0.3e-3, ..Material::for_loop_width(WIDTH) };
    let curves = sim_core::curves(&net, &net.laid_state(), &thin.into());
    let least = least_distance(&curves) / 0.6e-3;
    println!("least distance {least:.2} diameters");
    assert!(least > 0.2);
}

#[test]
fn a_rolled_up_edge_does_not_pass_through_itself() {
    // Without contact between layers the roll is down to a tenth of its thickness by then.
    let net = stockinette(8, 24);
    let mut simulator = free(&net);
    run(&mut simulator, 1.0);
    let least = least_layer_distance(&net, simulator.state(), simulator.materials().base.drawn_radius);
    println!("layers {least:.2} of their thickness apart, size {:.1}", 1e3 * size(simulator.state()));
    assert!((0.85..1.0).contains(&least), "rolled up until it touches, and no further");
    // The forces between layers are no outer ones: the roll falls as anything does.
    let speed = |simulator: &Simulator| {
        let velocity = &simulator.state().velocity;
        velocity.iter().map(|v| v.y).sum::<f64>() / velocity.len() as f64
    };
    let before = speed(&simulator);
    simulator.set_scene(Scene { air: 0.0, ..Scene::default() }).unwrap();
    run(&mut simulator, 1.05);
    let gained = before - speed(&simulator);
    println!("falls {gained:.4} m/s in 0.05 s");
    // Damping by mass takes some.
    assert!((0.9 * 0.49..0.5).contains(&gained));
}

#[test]
fn a_strip_that_falls_lies_in_folds() {
    let net = swatch(6, 48, |_, t| t % 2 == 1);
    let ground = Body::Ground { height: -0.065, friction: 0.4 };
    let scene = Scene { bodies: vec![ground], ..Scene::default() };
    let mut state = net.laid_state();
    // Not quite upright.
    state.position.iter_mut().for_each(|x| x.z += 0.5 * x.y * x.y);
    let material = Material::for_loop_width(WIDTH);
    let radius = material.drawn_radius;
    let mut simulator = Simulator::new(&net, material, scene, state).unwrap();
    run(&mut simulator, 0.8);
    let least = least_layer_distance(&net, simulator.state(), radius);
    let height = size(simulator.state()).y;
    println!("{least:.2} of the thickness, {:.1} mm high, {:?}", 1e3 * height, simulator.facts());
    assert!((0.6..1.0).contains(&least));
    // Layers on each other: higher than one, and much less than the 108 mm it was.
    assert!((3.0 * radius..0.03).contains(&height));
    assert!(simulator.facts().rejected_steps < 5);
}
