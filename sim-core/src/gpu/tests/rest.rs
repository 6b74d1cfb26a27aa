//! The rest shape of ten fabrics by each solver.
//!
//! Fabrics hang by their topmost nodes until they are as good as still. What is left between two solvers is friction: where yarn
//! stops sliding hangs on the path there, and the paths part by what conjugate gradients leave of the error.

use super::agreement::{crumpled, pinned};
use super::steps::apart;
use super::{device, spoilt, ten_fabrics};
use crate::choice::{SharedGpu, SolverChoice};
use crate::gpu::GpuSimulator;
use crate::gpu::kernel::Kernels;
use crate::gpu::pattern::Room;
use crate::handover::Handover;
use crate::material::Material;
use crate::scene::Scene;
use crate::settle::{SettleGoal, Settled};
use crate::simulation::Simulation;
use std::ops::ControlFlow;
use std::sync::Arc;
use stitch_mesh::yarn_net::{YarnNet, YarnState};

/// How far nodes may be apart at rest [m]: a hundredth of a loop's width, and an eighth of what a wrong kernel makes. Most are some
/// 1e-6 apart, seed 1.5e-5 and cables 1.7e-5.
const CLOSE: f64 = 3e-5;

/// When a fabric is at rest.
const GOAL: SettleGoal = SettleGoal { speed: 1e-3, time_limit_s: 2.0 };

/// Yarn that comes to rest soon.
fn calm() -> Material {
    Material { mass_damping: 40.0, ..Material::for_loop_width(3e-3) }
}

/// The scene that a fabric comes to rest in.
fn hanging(net: &YarnNet) -> Scene {
    Scene { time_step: 10e-3, ..pinned(net) }
}

/// The state of a fabric at rest, and when that was [s].
fn at_rest(name: &str, mut simulation: Simulation) -> (YarnState, f64) {
    let ended = simulation.settle(GOAL, &mut |_| ControlFlow::Continue(())).unwrap();
    println!("{name}, {}: {ended:?} after {} steps", simulation.solver(), simulation.progress().steps);
    assert_eq!(ended, Settled::Still, "{name}");
    assert_eq!(simulation.notice(), None);
    let time_s = simulation.progress().time_s;
    (simulation.state().unwrap().clone(), time_s)
}

#[test]
fn ten_fabrics_come_to_the_same_rest_by_every_solver() {
    let Some(device) = device() else { return };
    let gpu = SharedGpu::from(device);
    for (name, net) in ten_fabrics() {
        let net = Arc::new(net);
        let begun =
            |choice, start| Simulation::new(&gpu, choice, &net, calm(), hanging(&net), start).unwrap();
        // Cloth rests as it was laid.
        let laid = if name == "woven" { crumpled(&net) } else { net.laid_state() };
        // Crumpled cloth and stacks fly apart when they are let go, by 13 mm in two steps. Whether one node runs into another then hangs on
        // a micrometre, and yarn sticks elsewhere: the CPU alone leaves stacks 0.5 mm apart from starts that are 0.25 µm apart.
        let mut flown = begun(SolverChoice::Direct, laid.clone());
        while flown.progress().time_s < 0.1 {
            flown.step().unwrap();
        }
        let start = if ["woven", "stacks"].contains(&name) { flown.state().unwrap().clone() } else { laid };
        let made = |choice| begun(choice, start.clone());
        let (direct, time_s) = at_rest(name, made(SolverChoice::Direct));
        let moved = apart(&direct, &start);
        assert!(moved > 10.0 * CLOSE, "{name} has hardly moved: {moved:e}");
        for choice in [SolverChoice::Iterative, SolverChoice::Gpu] {
            // As good as still is not still: at the same time, then, as that one was.
            let mut simulation = made(choice);
            while simulation.progress().time_s < time_s - 1e-9 {
                simulation.step().unwrap();
            }
            assert_eq!(simulation.notice(), None);
            let difference = apart(&direct, simulation.state().unwrap());
            println!("{name}: moved {moved:.1e}, {choice:?} is {difference:.1e} m away");
            assert!(difference < CLOSE, "{name}, {choice:?}: {difference:e}");
        }
    }
}

#[test]
fn another_rest_shape_is_found() {
    let Some(device) = device() else { return };
    let (name, net) = ten_fabrics().swap_remove(0);
    let net = Arc::new(net);
    let gpu = SharedGpu::from(device.clone());
    let made = Simulation::new(&gpu, SolverChoice::Direct, &net, calm(), hanging(&net), net.laid_state());
    let (right, _) = at_rest(name, made.unwrap());
    // Yarn that is stiffer in bending by a tenth.
    let sources = spoilt("bend", "2.0 * yarn.bend * theta +", "2.2 * yarn.bend * theta +");
    let kernels = Kernels::compile(&device, &sources).unwrap();
    let from = Handover::new(&net, calm(), hanging(&net), net.laid_state()).unwrap();
    let wrong = GpuSimulator::with(&device, kernels, Room::on(&device), from).unwrap();
    let difference = apart(&right, &at_rest(name, wrong.into()).0);
    println!("{difference:.1e} m");
    assert!(difference > CLOSE, "{difference:e}");
}
