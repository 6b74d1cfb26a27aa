//! Whether factors are as good as they are meant to be: what is wrong with one costs iterations, and shows in nothing else.

use super::agreement::{Pair, crumpled, pinned};
use super::{GpuDevice, device, spoilt, ten_fabrics};
use crate::gpu::kernel::Kernels;
use crate::gpu::pattern::Room;
use stitch_mesh::edge_counts::StitchSize;
use stitch_mesh::lay::lay;
use stitch_mesh::pieces::rectangle;
use stitch_mesh::yarn_net::YarnNet;

/// Iterations that a complete factor leaves, for rounding, to a hundredth of what a step is solved to.
const MOST: u32 = 5;

/// Iterations of a crumpled fabric's first step; none where they do not converge.
fn iterations(device: &GpuDevice, kernels: Kernels, net: &YarnNet, room: Room) -> Option<u32> {
    let mut pair = Pair::new(device, kernels, net, crumpled(net), pinned(net), room);
    pair.run_until("hold");
    let verdict = pair.gpu.system().solve_prepared(300).unwrap();
    (verdict.status.solved == 1).then(|| verdict.iterations())
}

/// Fronts of this one are several tiles high, and its groups as large as they may be.
fn larger() -> YarnNet {
    lay(&rectangle(16, 12, StitchSize::of_width(3e-3)).unwrap())
}

#[test]
fn a_complete_factor_leaves_rounding() {
    let Some(device) = device() else { return };
    for (name, net) in ten_fabrics().into_iter().chain([("larger", larger())]) {
        let kernels = || device.kernels().unwrap();
        let complete = iterations(&device, kernels(), &net, Room::on(&device)).unwrap();
        // Room for an incomplete one alone.
        let little = Room { complete: 0.0, ..Room::on(&device) };
        let incomplete = iterations(&device, kernels(), &net, little).unwrap();
        println!("{name}: {complete} and {incomplete} iterations");
        assert!(complete < MOST, "{name}: {complete}");
    }
}

#[test]
fn a_wrong_factor_is_found() {
    let Some(device) = device() else { return };
    let net = larger();
    for (file, right, wrong) in [
        ("fill", "factor[column + row] = values[at]", "factor[column + row] = values[at] * f32(b % 3u)"),
        ("eliminate", "hook[i] * hook[k]", "0.999 * hook[i] * hook[k]"),
        ("tiles", "= sum[a];", "= select(sum[a], 0.0, a == 3u);"),
        ("tiles", "-= sum[a];", "-= select(sum[a], 0.0, rows > TILE / 2u && a == 0u);"),
        ("tiles", "sums.e += beyond", "sums.e -= beyond"),
        ("forward", "handed[group.row + i] = sum", "handed[group.row + i] = 0.99 * sum"),
        ("backward", "k < SIDE", "k < SIDE - 1u"),
    ] {
        let kernels = Kernels::compile(&device, &spoilt(file, right, wrong)).unwrap();
        let found = iterations(&device, kernels, &net, Room::on(&device));
        println!("{file}, {wrong}: {found:?} iterations");
        assert!(found.is_none_or(|found| found >= MOST), "{file}: {found:?}");
    }
}
