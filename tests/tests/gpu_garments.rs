//! Garments on the GPU: a small one on a software adapter, and on a graphics card what would take that minutes or more, skipped with a line that says
//! so where there is none. All kernels run in the tests of `sim-core` on any adapter.

#![allow(clippy::unwrap_used, reason = "helpers of tests are tests, which clippy cannot see")]

use sim_core::{Scene, SharedGpu, Simulation, SolverChoice};
use tests::{gpu, skip};

/// The simulation of a garment of so many loops in steps of `time_step` [s].
fn garment(name: &str, loops: usize, time_step: f64, solver: SolverChoice) -> Simulation {
    let project = app::bundled::find(name).unwrap().of_loops(loops).unwrap();
    let fabric = project.fabric().unwrap();
    let scene = Scene { time_step, ..project.scene.clone() };
    let state = (*fabric.state()).clone();
    Simulation::new(&SharedGpu::default(), solver, fabric.net(), project.materials.clone(), scene, state)
        .unwrap()
}

#[test]
fn a_sweater_lands_as_on_the_cpu() {
    let loops = if gpu().is_software() { 1_000 } else { 10_000 };
    let [mut on_cpu, mut on_gpu] =
        [SolverChoice::Cpu, SolverChoice::Gpu].map(|solver| garment("sweater", loops, 1.0 / 30.0, solver));
    for simulation in [&mut on_cpu, &mut on_gpu] {
        while simulation.progress().time_s < 0.3 {
            simulation.step().unwrap();
            let stretch = simulation.max_stretch().unwrap();
            assert!(stretch < 0.02, "{stretch} at {} s", simulation.progress().time_s);
        }
    }
    assert_eq!((on_gpu.solver(), on_gpu.notice()), ("gpu", None));
    // Single nodes part by a millimetre where one runs into another a step sooner, and what is near follows. The sweater as a whole falls as one.
    let (a, b) = (on_cpu.state().unwrap().clone(), on_gpu.state().unwrap());
    let apart = a.position.iter().zip(&b.position).map(|(a, b)| a.distance(*b)).sum::<f64>();
    let mean = apart / a.position.len() as f64;
    println!("{mean:e} m apart in the mean");
    assert!(mean < 3e-4, "{mean} m");
}

#[test]
fn a_t_shirt_of_325_000_loops_steps() {
    if gpu().is_software() {
        return skip("t-shirt on the GPU: there is no graphics card here, only a software adapter");
    }
    let mut simulation = garment("t-shirt", 325_000, 1.0 / 60.0, SolverChoice::Gpu);
    for _ in 0..2 {
        simulation.step().unwrap();
    }
    assert_eq!((simulation.solver(), simulation.notice()), ("gpu", None));
    assert!(simulation.state().unwrap().is_finite());
}
