//! What a step costs: `cargo test --release -p sim-core --test timing -- --ignored --nocapture`.

mod common;

use std::sync::Arc;
use std::time::Instant;
use stitch_mesh::{edge_counts::StitchSize, lay::lay, pieces::tube};

#[test]
#[ignore = "prints timings and checks nothing"]
fn steps_of_stockinette() {
    let tube = lay(&tube(60, 60, StitchSize::of_width(common::WIDTH)).unwrap());
    let nets = [("24 × 24", common::stockinette(24, 24)), ("56 × 56", common::stockinette(56, 56))];
    for (name, net) in nets.into_iter().chain([("tube, 60 × 60", Arc::new(tube))]) {
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
        sim_core::curves(&net, simulator.state(), simulator.materials());
        println!("{name}: setup {setup:.0?}, step {step:.1?}, curves {:.1?}", start.elapsed());
        println!("  {:?}", simulator.facts());
    }
}
