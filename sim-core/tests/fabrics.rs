//! What knitted fabrics are known to do.

mod common;

use common::{edge_heights, free, run, size, stockinette, swatch};
use sim_core::Model;

#[test]
fn free_stockinette_curls() {
    let net = stockinette(24, 24);
    let mut simulator = free(&net);
    run(&mut simulator, 1.0);
    let [bottom, top, left, right] = edge_heights(&net, simulator.state(), 24, 24);
    println!("{:?}", [bottom, top, left, right].map(|x| 1e3 * x));
    println!("{:?} {:?}", size(simulator.state()), simulator.facts());
}

#[test]
fn narrow_stockinette_rolls_its_sides_to_the_back() {
    let net = stockinette(10, 36);
    let mut simulator = free(&net);
    run(&mut simulator, 1.0);
    let [bottom, top, left, right] = edge_heights(&net, simulator.state(), 10, 36);
    println!("{:?}", [bottom, top, left, right].map(|x| 1e3 * x));
    println!("{:?} {:?}", size(simulator.state()), simulator.facts());
}

#[test]
fn rib_draws_in() {
    let net = swatch(20, 12, |s, _| s / 2 % 2 == 1);
    let mut simulator = free(&net);
    let laid = size(simulator.state()).x;
    for t in 1..5 {
        run(&mut simulator, 0.5 * t as f64);
        let relaxed = size(simulator.state()).x;
        println!("{laid} -> {relaxed} {:?} {:?}", size(simulator.state()), simulator.facts());
    }
}

#[test]
fn garter_stays_flat() {
    let net = swatch(20, 20, |_, t| t % 2 == 1);
    let mut simulator = free(&net);
    let laid = size(simulator.state());
    run(&mut simulator, 1.0);
    let relaxed = size(simulator.state());
    println!("{laid} -> {relaxed} {:?}", simulator.facts());
}

#[test]
fn plain_knit_has_at_most_eleven_blocks_a_row() {
    let net = stockinette(12, 12);
    let sizes = Model::new(net.clone()).unwrap().block_row_sizes();
    let inside = net.nodes.iter().zip(&sizes).filter(|(n, _)| {
        n.face.is_some_and(|f| (1..11).contains(&(f.index() % 12)) && (1..11).contains(&(f.index() / 12)))
    });
    let most = inside.map(|(_, s)| *s).max();
    println!("{most:?}");
}
