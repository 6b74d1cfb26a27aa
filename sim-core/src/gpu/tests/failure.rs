//! When the GPU fails, and how much of it is needed.

use super::{GpuDevice, device, ten_fabrics};
use crate::gpu::{GpuError, GpuSimulator};
use crate::material::Material;
use crate::scene::Scene;
use crate::simulator::{SimError, Simulator};
use std::sync::Arc;
use stitch_mesh::edge_counts::StitchSize;
use stitch_mesh::lay::lay;
use stitch_mesh::pieces::rectangle;

#[test]
fn a_lost_device_leaves_the_last_good_state() {
    if device().is_none() {
        return;
    }
    // A device of its own, as it does not come back.
    let device = GpuDevice::open().unwrap();
    let (_, net) = ten_fabrics().swap_remove(0);
    let net = Arc::new(net);
    let material = Material::for_loop_width(3e-3);
    let mut gpu =
        GpuSimulator::new(&device, &net, material.clone(), Scene::default(), net.laid_state()).unwrap();
    gpu.step().unwrap();
    let good = gpu.state().unwrap().clone();
    device.destroy();
    let error = gpu.step().unwrap_err();
    assert!(matches!(error, SimError::Gpu(GpuError::Lost(_))), "{error}");
    assert!(error.to_string().starts_with("the GPU was lost"), "{error}");
    assert_eq!(gpu.last_state(), &good);
    let mut cpu = Simulator::new(&net, material, Scene::default(), gpu.last_state().clone()).unwrap();
    cpu.step().unwrap();
}

/// 325 000 loops, of 23 KB each, need 7.4 GB in chunks; what is not in chunks has to fit into one binding.
#[test]
fn a_third_of_a_million_loops_fit_into_chunks() {
    let Some(device) = device() else { return };
    let (wide, high) = (24, 24);
    let net = Arc::new(lay(&rectangle(wide, high, StitchSize::of_width(3e-3)).unwrap()));
    let material = Material::for_loop_width(3e-3);
    let gpu = GpuSimulator::new(&device, &net, material, Scene::default(), net.laid_state()).unwrap();
    let loops = (wide * high) as u64;
    println!(
        "{} bytes a loop, the largest binding {}",
        gpu.bytes() / loops,
        gpu.system().buffers.largest_whole() / loops
    );
    assert!(gpu.bytes() / loops < 23_000);
    // Whole arrays are one binding; a swatch has more border a loop than a large piece.
    assert!(325_000 * gpu.system().buffers.largest_whole() / loops < 128 << 20);
}
