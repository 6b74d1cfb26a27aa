//! When the GPU fails, and how much of it is needed.

use super::steps::apart;
use super::{GpuDevice, device, ten_fabrics};
use crate::body::Body;
use crate::choice::{SharedGpu, SolverChoice};
use crate::closed_mesh::tests::cuboid;
use crate::gpu::pattern::Room;
use crate::gpu::{GpuError, GpuSimulator};
use crate::handover::Handover;
use crate::material::Material;
use crate::mesh_sequence::{Frames, MeshSequence};
use crate::scene::Scene;
use crate::simulation::Simulation;
use crate::simulator::SimError;
use crate::step::Rejection;
use std::sync::Arc;
use stitch_mesh::cable::Cable;
use stitch_mesh::edge_counts::StitchSize;
use stitch_mesh::ids::{FaceId, VertexId};
use stitch_mesh::lay::lay;
use stitch_mesh::pieces::{rectangle, tube};
use stitch_mesh::yarn_net::YarnNet;

/// A simulation of stockinette on a device.
fn on(device: &GpuDevice, net: &Arc<YarnNet>) -> Simulation {
    let material = Material::for_loop_width(3e-3);
    let gpu = SharedGpu::from(device.clone());
    let made =
        Simulation::new(&gpu, SolverChoice::Gpu, net, material, Scene::default(), net.laid_state()).unwrap();
    assert_eq!((made.solver(), made.notice()), ("gpu", None));
    made
}

#[test]
fn a_lost_device_leaves_the_last_good_state() {
    if device().is_none() {
        return;
    }
    // A device of its own, as it does not come back.
    let device = GpuDevice::open().unwrap();
    let (_, net) = ten_fabrics().swap_remove(0);
    let net = Arc::new(net);
    let mut simulation = on(&device, &net);
    simulation.step().unwrap();
    let good = simulation.state().unwrap().clone();
    // This one nobody has read back.
    simulation.step().unwrap();
    device.destroy();
    assert_eq!(simulation.state().unwrap(), &good);
    let notice = simulation.notice().unwrap().to_owned();
    assert!(notice.starts_with("the GPU was lost"), "{notice}");
    let (time_s, h) = (simulation.progress().time_s, Scene::default().time_step);
    assert!(notice.ends_with("going on on the CPU from 0.01 s") && (time_s - h).abs() < 1e-9, "{notice}");
    simulation.step().unwrap();
    assert_eq!((simulation.solver(), simulation.progress().steps), ("direct", 2));
}

#[test]
fn what_the_gpu_has_no_kernel_for_goes_to_the_cpu() {
    let Some(device) = device() else { return };
    let (_, net) = ten_fabrics().swap_remove(0);
    let net = Arc::new(net);
    let mut simulation = on(&device, &net);
    (0..3).for_each(|_| {
        simulation.step().unwrap();
    });
    let mesh = cuboid(glam::DVec3::splat(1e-3));
    let frames = Frames {
        triangles: mesh.triangles,
        positions: vec![mesh.positions.clone(), mesh.positions],
        interval_s: 0.5,
        repeats: true,
    };
    let body = Body::Sequence { frames: MeshSequence::new(frames).unwrap(), friction: 0.3 };
    let before = simulation.last_state().clone();
    simulation.set_scene(&Scene { bodies: vec![body], ..Scene::default() }).unwrap();
    let notice = simulation.notice().unwrap();
    assert!(notice.contains("body 0 changes its shape") && notice.ends_with("from 0.01 s"), "{notice}");
    // Not from the state that happened to be there last, but from where it was.
    assert_ne!(simulation.last_state(), &before);
    assert_eq!((simulation.solver(), simulation.progress().steps), ("direct", 3));
    assert_eq!(simulation.scene().bodies.len(), 1);
    simulation.step().unwrap();
}

#[test]
fn a_binding_that_is_too_large_is_refused_and_forgotten() {
    if device().is_none() {
        return;
    }
    let device = GpuDevice::open().unwrap();
    device.buffer("too large", 1 << 40);
    let error = device.check().unwrap_err();
    assert!(matches!(error, GpuError::Refused(_) | GpuError::OutOfMemory(_)), "{error}");
    device.check().unwrap();
}

/// Going over to another solver, and back, in the middle of taking in.
#[test]
fn solvers_take_turns() {
    let Some(device) = device() else { return };
    let size = StitchSize::of_width(3e-3);
    let mut stitches = tube(12, 5, size).unwrap();
    let first = stitches.mesh().first_half_edge(FaceId(24));
    let base = stitches.mesh().origin(first).0;
    // Across the place where the rings begin, so that the shortened turn matters.
    let path = [base + 10, base + 11, base, base + 1, base + 2].map(VertexId);
    stitches.set_cable(Cable::cross(path.to_vec(), 2, 2, true)).unwrap();
    let net = Arc::new(lay(&stitches));
    assert!(!net.taken_in.is_empty());
    let gpu = SharedGpu::from(device);
    let material = Material::for_loop_width(3e-3);
    let of = |choice| {
        Simulation::new(&gpu, choice, &net, material.clone(), Scene::empty(), net.laid_state()).unwrap()
    };
    let (mut cpu, mut turns) = (of(SolverChoice::Direct), of(SolverChoice::Direct));
    let [direct, iterative, on_gpu] = [SolverChoice::Direct, SolverChoice::Iterative, SolverChoice::Gpu];
    // Yarns stick anew where they are at each change, here and there.
    for (on_cpu, choice) in [(direct, direct), (iterative, on_gpu), (direct, iterative), (iterative, on_gpu)]
    {
        cpu.set_choice(&gpu, on_cpu);
        turns.set_choice(&gpu, choice);
        for _ in 0..4 {
            cpu.step().unwrap();
            turns.step().unwrap();
        }
    }
    assert_eq!((turns.solver(), turns.notice()), ("gpu", None));
    assert_eq!(turns.progress(), cpu.progress());
    let (cpu, turns) = (cpu.state().unwrap(), turns.state().unwrap());
    assert!((turns.taken_in - cpu.taken_in).abs() < 1e-12 && cpu.taken_in > 0.1);
    let (moved, difference) = (apart(cpu, &net.laid_state()), apart(cpu, turns));
    println!("moved {moved:.1e}, apart {difference:.1e}");
    assert!(moved > 5e-4 && difference < 0.02 * moved);
}

#[test]
fn a_crowd_changes_nothing() {
    let Some(device) = device() else { return };
    let (_, net) = ten_fabrics().swap_remove(0);
    let net = Arc::new(net);
    // All nodes within reach of each other, more than there is room for.
    let mut state = net.laid_state();
    state.position.iter_mut().for_each(|x| *x *= 0.1);
    let material = Material::for_loop_width(3e-3);
    let mut gpu = GpuSimulator::new(&device, &net, material, Scene::empty(), state).unwrap();
    let before = gpu.state().unwrap().clone();
    let error = gpu.step().unwrap_err();
    assert!(matches!(error, SimError::Stuck { cause: Rejection::Crowded, .. }), "{error}");
    // But for single precision.
    let after = gpu.state().unwrap();
    assert!(apart(&before, after) < 1e-9 && after.velocity.iter().all(|v| v.length() == 0.0));
}

/// 325 000 loops, of 24 KB each, need 7.8 GB in chunks; what is not in chunks has to fit into one binding.
#[test]
fn a_third_of_a_million_loops_fit_into_chunks() {
    let Some(device) = device() else { return };
    let (wide, high) = (24, 24);
    let net = Arc::new(lay(&rectangle(wide, high, StitchSize::of_width(3e-3)).unwrap()));
    let material = Material::for_loop_width(3e-3);
    let loops = (wide * high) as u64;
    // An incomplete factor, as so many have; and a complete one, which takes the more a loop the more there are.
    for (complete, most) in [(0.0, 25_000), (Room::on(&device).complete, 36_000)] {
        let from = Handover::new(&net, material.clone(), Scene::default(), net.laid_state()).unwrap();
        let room = Room { complete, ..Room::on(&device) };
        let gpu = GpuSimulator::with(&device, device.kernels().unwrap(), room, from).unwrap();
        let (all, whole) = (gpu.bytes() / loops, gpu.system().buffers.largest_whole() / loops);
        println!("{all} bytes a loop, the largest binding {whole}");
        assert!(all < most);
        // Whole arrays are one binding; a swatch has more border a loop than a large piece.
        assert!(325_000 * whole < 128 << 20);
    }
}
