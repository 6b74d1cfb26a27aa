//! Nets that are not plain rectangles: tubes, stacked loops, several loops out of one, twisted loops, other sizes.

mod common;

use common::WIDTH;
use sim_core::{Material, Scene, Simulator};
use std::sync::Arc;
use stitch_mesh::edge_counts::StitchSize;
use stitch_mesh::ids::FaceId;
use stitch_mesh::lay::lay;
use stitch_mesh::mesh::PolygonMesh;
use stitch_mesh::pieces::{rectangle, tube};
use stitch_mesh::stitch_mesh::StitchMesh;

/// Hangs the piece by its top nodes for 0.3 s and sees that it holds.
#[allow(clippy::unwrap_used, reason = "a helper of tests is a test, and clippy can't tell")]
fn hangs_well(stitches: &StitchMesh, width: f64) {
    let net = Arc::new(lay(stitches));
    let top = net.nodes.iter().map(|n| n.position.y).fold(f64::NEG_INFINITY, f64::max);
    let material = Material::for_loop_width(width);
    let weight: f64 = 9.81 * material.density * net.segments().count() as f64 * width;
    let pins = net.nodes.iter().enumerate().filter(|(_, n)| n.position.y > top - width);
    let pins =
        pins.map(|(i, n)| sim_core::Pin { node: i as u32, target: n.position, stiffness: weight / width });
    let scene = Scene { pins: pins.collect(), ..Scene::default() };
    let mut simulator = Simulator::new(&net, material, scene, net.laid_state()).unwrap();
    common::run(&mut simulator, 0.3);
    let facts = simulator.facts();
    assert!(simulator.state().is_finite());
    assert!(facts.max_stretch < 0.1, "{facts:?}");
    assert!(facts.rejected_steps < 20, "{facts:?}");
}

#[test]
fn a_tube_of_closed_yarns() {
    hangs_well(&tube(16, 8, StitchSize::of_width(WIDTH)).unwrap(), WIDTH);
}

#[test]
fn loops_of_every_size() {
    for width in [3e-3, 6e-3, 12e-3] {
        hangs_well(&rectangle(8, 8, StitchSize::of_width(width)).unwrap(), width);
    }
}

#[test]
fn twisted_loops() {
    let mut stitches = rectangle(8, 8, StitchSize::of_width(WIDTH)).unwrap();
    for (i, symbol) in ["k1", "p-1", "k", "p"].iter().cycle().take(64).enumerate() {
        stitches.set_stitch(FaceId::new(i), symbol.parse().unwrap()).unwrap();
    }
    hangs_well(&stitches, WIDTH);
}

/// Eight loops joined to four and four opened to eight again.
#[test]
fn stacked_and_divided_loops() {
    let (wide, size) = (4, StitchSize::of_width(WIDTH));
    let row = |level: f64, count: usize| {
        let step = 2.0 * wide as f64 * size.width / count as f64;
        (0..=count).map(move |i| glam::DVec3::new(i as f64 * step, level * size.height, 0.0))
    };
    let counts = [8, 8, 4, 8, 8];
    let positions: Vec<_> = counts.iter().enumerate().flat_map(|(j, n)| row(j as f64, *n)).collect();
    let first = |level: usize| counts[..level].iter().map(|n| n + 1).sum::<usize>();
    let mut faces: Vec<Vec<u32>> = Vec::new();
    for level in 0..counts.len() - 1 {
        let (below, above) = (counts[level], counts[level + 1]);
        let columns = below.min(above);
        for c in 0..columns {
            let (b, a) = (below / columns, above / columns);
            let bottom = (0..=b).map(|k| first(level) + c * b + k);
            let top = (0..=a).rev().map(|k| first(level + 1) + c * a + k);
            faces.push(bottom.chain(top).map(|v| v as u32).collect());
        }
    }
    let symbols = faces.iter().enumerate().map(|(i, f)| match (f.len(), i) {
        (4, _) => "k",
        (_, 0..12) => "d21k",
        _ => "kp",
    });
    let stitches = symbols.map(|s| s.parse().unwrap()).collect();
    let mesh = PolygonMesh::new(positions, &faces).unwrap();
    hangs_well(&StitchMesh::new(mesh, stitches).unwrap(), WIDTH);
}
