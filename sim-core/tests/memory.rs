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

/// Memory that a loop may take once a simulation runs, and while that begins [bytes]. With conjugate gradients 19 KB and as much
/// again at the beginning were found at any size; a complete factor grows with the width of the fabric.
const BOUNDS: [(SolverChoice, usize, usize); 2] =
    [(SolverChoice::Iterative, 100_000, 110_000), (SolverChoice::Direct, 200_000, 220_000)];

#[test]
fn a_loop_takes_so_much_memory() {
    let net = Arc::new(lay(&rectangle(SIDE, SIDE, StitchSize::of_width(3e-3)).unwrap()));
    let last = SIDE * (SIDE - 1);
    let held = net.nodes.iter().enumerate().filter(|(_, n)| n.face.is_some_and(|f| f.index() >= last));
    let pins = held.map(|(i, n)| Pin { node: i as u32, target: n.position, stiffness: 10.0 }).collect();
    let hanging = Scene { pins, ..Scene::default() };
    for (choice, most, most_at_the_beginning) in BOUNDS {
        let before = MEMORY.current_usage();
        MEMORY.reset_peak_usage();
        let (gpu, material) = (SharedGpu::default(), Material::for_loop_width(3e-3));
        let mut simulation =
            Simulation::new(&gpu, choice, &net, material, hanging.clone(), net.laid_state()).unwrap();
        for _ in 0..3 {
            simulation.step().unwrap();
        }
        let of_loop = |bytes: usize| (bytes - before) / (SIDE * SIDE);
        let (now, peak) = (of_loop(MEMORY.current_usage()), of_loop(MEMORY.peak_usage()));
        println!("{choice:?}: {now} bytes a loop, {peak} at most");
        assert!(now < most && peak < most_at_the_beginning, "{choice:?}: {now}, {peak}");
        // It is counted at all: positions, velocities and sliding of a loop alone take this.
        assert!(now > 4 * 48 + 8 * 16);
    }
}
