//! What a loop takes in memory. All other memory of this program would be counted, too: one test alone lives here.

use peak_alloc::PeakAlloc;
use sim_core::{Material, Pin, Scene, SharedGpu, Simulation, SolverChoice};
use std::sync::Arc;
use stitch_mesh::edge_counts::StitchSize;
use stitch_mesh::lay::lay;
use stitch_mesh::pieces::rectangle;

#[global_allocator]
static MEMORY: PeakAlloc = PeakAlloc;

/// Loops on each side of what is measured.
const SIDE: usize = 60;

/// Memory that a loop may take before the first step, and at most [bytes]: 18 and 19 KB were found with conjugate gradients, 25 and
/// 31 KB by complete factorisation. A complete factor grows with the width of the fabric, all else only with its loops.
const BOUNDS: [(SolverChoice, usize, usize); 2] =
    [(SolverChoice::Iterative, 20_000, 22_000), (SolverChoice::Direct, 28_000, 34_000)];

#[test]
fn a_loop_takes_so_much_memory() {
    let net = Arc::new(lay(&rectangle(SIDE, SIDE, StitchSize::of_width(3e-3)).unwrap()));
    let last = SIDE * (SIDE - 1);
    let held = net.nodes.iter().enumerate().filter(|(_, n)| n.face.is_some_and(|f| f.index() >= last));
    let pins = held.map(|(i, n)| Pin { node: i as u32, target: n.position, stiffness: 10.0 }).collect();
    let hanging = Scene { pins, ..Scene::default() };
    let measure = |choice| {
        let before = MEMORY.current_usage();
        let of_loop = |bytes: usize| (bytes - before) / (SIDE * SIDE);
        MEMORY.reset_peak_usage();
        let (gpu, material) = (SharedGpu::default(), Material::for_loop_width(3e-3));
        let mut simulation =
            Simulation::new(&gpu, choice, &net, material, hanging.clone(), net.laid_state()).unwrap();
        let made = of_loop(MEMORY.current_usage());
        for _ in 0..3 {
            simulation.step().unwrap();
        }
        let (stepped, peak) = (of_loop(MEMORY.current_usage()), of_loop(MEMORY.peak_usage()));
        println!("{choice:?}: {made} bytes a loop, {stepped} after some steps, {peak} at most");
        (made, peak)
    };
    // Matrix products keep some 100 MB for each thread from the first on, however small the fabric.
    measure(SolverChoice::Direct);
    for (choice, most, most_at_peak) in BOUNDS {
        let (made, peak) = measure(choice);
        assert!(made < most && peak < most_at_peak, "{choice:?}: {made}, {peak}");
        // It is counted at all: positions, velocities and sliding of a loop alone take this.
        assert!(made > 4 * 48 + 8 * 16);
    }
}
