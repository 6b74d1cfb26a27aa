//! What a step costs: `cargo test --release -p sim-core --test timing -- --ignored --nocapture`.

mod common;

use std::time::Instant;

#[test]
#[ignore = "prints timings and checks nothing"]
fn steps_of_stockinette() {
    for side in [24, 56] {
        let net = common::stockinette(side, side);
        let start = Instant::now();
        let mut simulator = common::free(&net);
        let setup = start.elapsed();
        let steps = 10;
        let start = Instant::now();
        for _ in 0..steps {
            simulator.step().unwrap();
        }
        let step = start.elapsed() / steps;
        let start = Instant::now();
        sim_core::curves(&net, simulator.state(), simulator.material().drawn_radius);
        println!("{side} × {side}: setup {setup:.0?}, step {step:.1?}, curves {:.1?}", start.elapsed());
        println!("  {:?}", simulator.facts());
    }
}
