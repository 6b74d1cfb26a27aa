//! Random swatches: stitches of all kinds, stacks, increases, twisted and slipped loops and cables beside and above each other.

#![allow(
    clippy::unwrap_used,
    clippy::panic,
    clippy::print_stdout,
    reason = "helpers of tests are tests, and clippy can't tell"
)]

mod common;

use common::WIDTH;
use sim_core::{Material, Scene, Simulator};
use std::sync::Arc;
use stitch_mesh::cable::Cable;
use stitch_mesh::edge_counts::StitchSize;
use stitch_mesh::ids::VertexId;
use stitch_mesh::lay::lay;
use stitch_mesh::pieces::from_rows;
use stitch_mesh::stitch::Stitch;
use stitch_mesh::stitch_mesh::StitchMesh;
use stitch_mesh::yarn_net::YarnNet;

/// What a row is made of, by the loops that each stitch joins. Plain ones more often.
const STITCHES: [&[&str]; 4] = [
    &[],
    &["k", "k", "k", "k", "p", "p", "p", "k1", "k-1", "p1", "ky", "yk", "kp", "kyk", "kpk", "s", "x", "sk"],
    &["d12k", "d21k", "d12p", "d21p"],
    &["d123k", "d213k", "d321k", "d231p"],
];

/// Loops in a row: no fewer, no more.
const LOOPS: std::ops::RangeInclusive<usize> = 5..=10;

/// Numbers that look random (xorshift), the same for the same seed.
struct Numbers(u64);

impl Numbers {
    /// One below `bound`.
    fn below(&mut self, bound: usize) -> usize {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as usize % bound
    }
}

/// A row on so many loops.
fn row(numbers: &mut Numbers, below: usize) -> Vec<Stitch> {
    loop {
        let (mut left, mut stitches) = (below, Vec::new());
        while left > 0 {
            let joined = [1, 1, 1, 1, 1, 1, 2, 3][numbers.below(8)].min(left);
            let symbol = STITCHES[joined][numbers.below(STITCHES[joined].len())];
            stitches.push(symbol.parse::<Stitch>().unwrap());
            left -= joined;
        }
        if LOOPS.contains(&stitches.iter().map(Stitch::tops).sum()) {
            return stitches;
        }
    }
}

/// A swatch, and how many cables are on it.
fn swatch(seed: u64) -> (StitchMesh, usize) {
    let mut numbers = Numbers(0x9e37_79b9_7f4a_7c15 ^ (seed + 1).wrapping_mul(0xd134_2543_de82_ef95));
    let plain = |n: usize| vec![Stitch::knit(); n];
    let mut loops = vec![7];
    let mut rows = vec![plain(7)];
    for _ in 0..5 {
        rows.push(row(&mut numbers, loops[loops.len() - 1]));
        loops.push(rows[rows.len() - 1].iter().map(Stitch::tops).sum());
    }
    rows.push(plain(loops[loops.len() - 1]));
    let mut stitches = from_rows(&rows, StitchSize::of_width(WIDTH)).unwrap();
    let (mut first, mut cables) = (8, 0);
    for count in &loops[..5] {
        let strand = 1 + numbers.below(2);
        let at = first + numbers.below(count + 1 - 2 * strand);
        let path = (at..=at + 2 * strand).map(|v| VertexId(v as u32)).collect();
        let cross = Cable::cross(path, strand as u8, strand as u8, numbers.below(2) == 0);
        // Some cannot cross there: shaping is in the way.
        cables += usize::from(numbers.below(3) == 0 && stitches.set_cable(cross).is_ok());
        first += count + 1;
    }
    (stitches, cables)
}

/// Least yarn on any segment [m].
fn least_yarn(net: &YarnNet, u: &[f64]) -> f64 {
    let shortest =
        net.segments().filter(|s| s.wrap == 0.0).map(|s| u[s.ends[1].index()] - u[s.ends[0].index()]);
    shortest.fold(f64::INFINITY, f64::min)
}

/// Relaxes swatches for half a second each at 5 ms.
fn relax(seeds: std::ops::Range<u64>) {
    let (mut steps, mut rejected, mut cables, mut worst) = (0, 0, 0, f64::INFINITY);
    for seed in seeds {
        let (stitches, crossed) = swatch(seed);
        let net = Arc::new(lay(&stitches));
        let material = Material::for_loop_width(WIDTH);
        let mut simulator = Simulator::new(&net, material, Scene::empty(), net.laid_state()).unwrap();
        while simulator.time_s() < 0.5 {
            let step = simulator.step();
            let step = step.unwrap_or_else(|error| panic!("swatch {seed}: {error}"));
            rejected += step.rejected;
            steps += 1;
        }
        assert!(simulator.state().is_finite(), "swatch {seed}");
        let least = least_yarn(simulator.net(), &simulator.state().sliding);
        assert!(least > 0.0, "swatch {seed}: {least} m of yarn on a segment");
        worst = worst.min(least);
        cables += crossed;
    }
    println!("{steps} steps, {rejected} rejected, {cables} cables, least yarn {worst:.1e} m");
    assert!(cables > 0);
    assert!(50 * rejected < steps, "{rejected} of {steps} steps rejected");
}

#[test]
fn random_swatches_relax() {
    relax(0..24);
}

#[test]
#[ignore = "takes minutes: what the test above does, a thousand times"]
fn a_thousand_random_swatches_relax() {
    relax(0..1000);
}
