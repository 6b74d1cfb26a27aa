//! Whole steps against those of the CPU.

use super::agreement::pinned;
use super::{device, spoilt, ten_fabrics};
use crate::gpu::GpuSimulator;
use crate::gpu::device::LIMITS;
use crate::gpu::kernel::{Kernels, SOURCES, Source};
use crate::gpu::pattern::Room;
use crate::gpu::stages::parts;
use crate::handover::Handover;
use crate::material::Material;
use crate::noise::unit_hash;
use crate::scene::Scene;
use crate::simulator::{SimError, Simulator};
use glam::DVec3;
use std::sync::Arc;
use stitch_mesh::edge_counts::StitchSize;
use stitch_mesh::lay::lay;
use stitch_mesh::pieces::rectangle;
use stitch_mesh::yarn_net::{YarnNet, YarnState};

/// How far nodes may be apart after a step, in which they move by some tenths of a millimetre [m]: what conjugate gradients
/// leave of the error moves them by a thousandth of that.
const CLOSE: f64 = 2e-6;

/// The largest distance between nodes of two states [m].
pub(super) fn apart(a: &YarnState, b: &YarnState) -> f64 {
    a.position.iter().zip(&b.position).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max)
}

/// A simulation on the CPU after some steps, and one on the device and on the CPU from there.
fn both(net: &Arc<YarnNet>, scene: &Scene, steps: usize) -> Option<(Simulator, GpuSimulator)> {
    let device = device()?;
    let material = Material::for_loop_width(3e-3);
    let mut cpu = Simulator::new(net, material.clone(), scene.clone(), net.laid_state()).unwrap();
    (0..steps).for_each(|_| {
        cpu.step().unwrap();
    });
    let state = cpu.state().clone();
    let cpu = Simulator::new(net, material.clone(), scene.clone(), state.clone()).unwrap();
    let gpu = GpuSimulator::new(&device, net, material, scene.clone(), state).unwrap();
    Some((cpu, gpu))
}

#[test]
fn ten_fabrics_at_rest_step_like_on_the_cpu() {
    for (name, net) in ten_fabrics() {
        let net = Arc::new(net);
        let Some((mut cpu, mut gpu)) = both(&net, &pinned(&net), 60) else { return };
        assert_eq!(cpu.step().unwrap(), gpu.step().unwrap(), "{name}");
        let difference = apart(cpu.state(), gpu.state().unwrap());
        println!("{name}: {difference:.1e} m, {} iterations", gpu.iterations());
        assert!(difference < CLOSE, "{name}: {difference:e}");
    }
}

#[test]
fn a_piece_of_many_levels_steps_like_on_the_cpu() {
    let Some(device) = device() else { return };
    let net = Arc::new(lay(&rectangle(2, 420, StitchSize::of_width(3e-3)).unwrap()));
    let begin = || Handover::new(&net, Material::for_loop_width(3e-3), Scene::empty(), net.laid_state());
    let mut cpu = Simulator::resume(begin().unwrap(), None);
    let room = Room { complete: 0.0, ..Room::on(&device) };
    let mut gpu = GpuSimulator::with(&device, device.kernels().unwrap(), room, begin().unwrap()).unwrap();
    // Row by row there are so many levels that their parts fill more than a uniform binding may have; they are bound one at a time.
    assert!(parts(&gpu.system.tables, 0).len() as u64 > LIMITS.max_uniform_buffer_binding_size);
    for _ in 0..4 {
        assert_eq!(cpu.step().unwrap(), gpu.step().unwrap());
    }
    let (moved, difference) =
        (apart(cpu.state(), &net.laid_state()), apart(cpu.state(), gpu.state().unwrap()));
    println!("moved {moved:.1e} m, {difference:.1e} m apart, {} iterations", gpu.iterations());
    assert!(difference < 5e-2 * moved, "{difference:e} of {moved:e}");
}

/// A fabric whose nodes have these velocities, on the CPU and with these kernels.
fn moving(
    sources: &[Source],
    net: YarnNet,
    velocity: impl Fn(usize, DVec3) -> DVec3,
) -> Option<(Simulator, GpuSimulator)> {
    let device = device()?;
    let net = Arc::new(net);
    let material = Material::for_loop_width(3e-3);
    let mut state = net.laid_state();
    for (i, (x, v)) in state.position.iter().zip(&mut state.velocity).enumerate() {
        *v = velocity(i, *x);
    }
    let scene = Scene { time_step: 4e-3, ..Scene::empty() };
    let cpu = Simulator::new(&net, material.clone(), scene.clone(), state.clone()).unwrap();
    let from = Handover::new(&net, material, scene, state).unwrap();
    let kernels = Kernels::compile(&device, sources).unwrap();
    Some((cpu, GpuSimulator::with(&device, kernels, Room::on(&device), from).unwrap()))
}

/// Fabric thrown about so that its segments turn.
fn thrown_about(sources: &[Source]) -> Option<(Simulator, GpuSimulator)> {
    let number = |k: usize| 0.2 * (unit_hash(k as u64) - 0.5);
    let thrown = |i: usize, _| DVec3::new(number(3 * i), number(3 * i + 1), number(3 * i + 2));
    moving(sources, ten_fabrics().swap_remove(0).1, thrown)
}

/// A strip that turns about its lower end, by half a radian a step.
fn turning(sources: &[Source]) -> Option<(Simulator, GpuSimulator)> {
    let net = lay(&rectangle(4, 40, StitchSize::of_width(3e-3)).unwrap());
    moving(sources, net, |_, x| DVec3::Z * 0.5 / 4e-3 * x.y)
}

/// How far a step of fabric thrown about is from that of the CPU with these kernels, and how much longer its longest segment is.
fn unlike_thrown_about(sources: &[Source]) -> Option<(f64, f64)> {
    let (mut cpu, mut gpu) = thrown_about(sources)?;
    assert_eq!(cpu.step().unwrap(), gpu.step().unwrap());
    let longer = gpu.max_stretch().unwrap() - crate::facts::max_stretch(cpu.model(), cpu.state());
    Some((apart(cpu.state(), gpu.state().unwrap()), longer))
}

#[test]
fn segments_that_turn_are_drawn_back_as_on_the_cpu() {
    let Some((apart, longer)) = unlike_thrown_about(SOURCES) else { return };
    println!("{apart:.1e} m apart, {longer:.1e} longer");
    // They fly by 0.4 mm, twice as far as those that CLOSE is for.
    assert!(apart < 3.0 * CLOSE && longer.abs() < 1e-4);
    let wrong = spoilt("overshoot", "sum += drawn", "sum += 0.1 * drawn");
    let Some((apart, longer)) = unlike_thrown_about(&wrong) else { return };
    println!("spoilt: {apart:.1e} m apart, {longer:.1e} longer");
    assert!(longer > 1e-3);
}

#[test]
fn a_step_in_which_many_turn_too_far_is_taken_again() {
    let Some((mut cpu, mut gpu)) = turning(SOURCES) else { return };
    let (report, reported) = (cpu.step().unwrap(), gpu.step().unwrap());
    println!("{report:?}");
    assert!(report.rejected > 0);
    assert_eq!(report, reported);
    let wrong = spoilt("judge", "atomicAdd(&faults[1], 1u)", "atomicAdd(&faults[1], 0u)");
    let Some((_, mut gpu)) = turning(&wrong) else { return };
    assert!(gpu.step().unwrap().rejected < report.rejected);
}

#[test]
fn a_free_swatch_curls_as_on_the_cpu() {
    let (_, net) = ten_fabrics().swap_remove(0);
    let net = Arc::new(net);
    let Some((mut cpu, mut gpu)) = both(&net, &Scene::empty(), 0) else { return };
    while cpu.time_s() < 0.15 {
        cpu.step().unwrap();
    }
    while gpu.progress().time_s < 0.15 {
        gpu.step().unwrap();
    }
    let moved = apart(cpu.state(), &net.laid_state());
    let difference = apart(cpu.state(), gpu.state().unwrap());
    println!("moved {moved:.1e}, apart {difference:.1e}, rejected {}", gpu.progress().rejected);
    assert!(moved > 1e-3 && difference < 0.05 * moved);
}

#[test]
fn a_step_that_goes_wrong_is_thrown_away() {
    let (_, net) = ten_fabrics().swap_remove(0);
    let net = Arc::new(net);
    let Some((_, mut gpu)) = both(&net, &Scene::empty(), 5) else { return };
    gpu.step().unwrap();
    let before = gpu.state().unwrap().clone();
    // Pulled so hard that no step is small enough.
    let node = net.nodes.len() as u32 / 2;
    let target = net.nodes[node as usize].position + DVec3::Z;
    let pins = vec![crate::Pin { node, target, stiffness: 1e9 }];
    gpu.set_scene(Scene { pins, ..Scene::empty() }).unwrap();
    let error = gpu.step().unwrap_err();
    assert!(matches!(error, SimError::Stuck { .. }), "{error}");
    assert!(apart(&before, gpu.state().unwrap()) == 0.0, "the state is that of the last good step");
}

#[test]
fn yarns_are_drawn_as_on_the_cpu() {
    for (name, net) in ten_fabrics() {
        let net = Arc::new(net);
        let Some((cpu, mut gpu)) = both(&net, &pinned(&net), 10) else { return };
        let ours = crate::curves(&net, cpu.state(), cpu.materials());
        let theirs = gpu.curves().unwrap();
        assert_eq!(ours.curves.len(), theirs.curves.len(), "{name}");
        let mut worst = 0.0_f32;
        for (a, b) in ours.curves.iter().zip(&theirs.curves) {
            assert_eq!((a.points.len(), &a.radii, &a.dyes), (b.points.len(), &b.radii, &b.dyes), "{name}");
            worst = a.points.iter().zip(&b.points).map(|(a, b)| a.distance(*b)).fold(worst, f32::max);
        }
        println!("{name}: {worst:.1e} m");
        // A thousandth of the yarn's radius.
        assert!(worst < 4e-7, "{name}: {worst:e}");
    }
}

#[test]
fn a_cut_goes_on_as_on_the_cpu() {
    let (_, net) = ten_fabrics().swap_remove(0);
    let net = Arc::new(net);
    let Some((mut cpu, mut gpu)) = both(&net, &pinned(&net), 20) else { return };
    let cut = crate::Operation::Cut(stitch_mesh::ids::VisitId(40));
    cpu.operate(cut.clone()).unwrap();
    gpu.operate(cut).unwrap();
    for _ in 0..3 {
        cpu.step().unwrap();
        gpu.step().unwrap();
    }
    assert_eq!(cpu.net().yarns.len(), gpu.net().yarns.len());
    assert_eq!(gpu.progress().surgery.operations.len(), cpu.surgery().operations.len());
    let difference = apart(cpu.state(), gpu.state().unwrap());
    println!("{difference:.1e} m");
    assert!(difference < 10.0 * CLOSE);
}
