//! Prints what a step of stockinette takes: `cargo run --release -p sim-core --example timing -- 24 56`.

#[path = "../tests/common/mod.rs"]
mod common;

use std::time::Instant;

fn main() {
    for side in std::env::args().skip(1).filter_map(|a| a.parse::<usize>().ok()) {
        let net = common::stockinette(side, side);
        let start = Instant::now();
        let mut simulator = common::free(&net);
        let setup = start.elapsed().as_secs_f64() * 1e3;
        let start = Instant::now();
        let steps: usize = std::env::var("STEPS").ok().and_then(|s| s.parse().ok()).unwrap_or(10);
        for _ in 0..steps {
            simulator.step().unwrap();
        }
        let step = start.elapsed().as_secs_f64() * 1e3 / steps as f64;
        println!("{side} x {side}: setup {setup:.0} ms, step {step:.1} ms");
        println!("{:?}", simulator.facts());
        println!(
            "{:?} {:?}",
            common::size(simulator.state()),
            common::edge_heights(&net, simulator.state(), side, side).map(|x| 1e3 * x)
        );
    }
}
