//! How long relaxing a stitch mesh takes, from nothing to settled: `cargo bench --bench mesh_relax`.
//!
//! The pullover that comes with the program, its stitches of 4.1 mm (about a sweater of 21 500 stitches) and of 2.4 mm (about a
//! dress of 65 000), and a tube of 21 600 whose stitches are badly distorted.

#![allow(missing_docs, clippy::unwrap_used, reason = "a benchmark that cannot begin has to stop")]

use criterion::{Criterion, criterion_group, criterion_main};
use glam::DVec3;
use sim_core::mesh_relax::{MeshRelaxation, RelaxParams};
use std::f64::consts::TAU;
use std::ops::ControlFlow;
use std::time::Duration;
use stitch_mesh::autolabel::autolabel;
use stitch_mesh::edge_counts::{EdgeCounts, StitchSize};
use stitch_mesh::label::LabelledMesh;
use stitch_mesh::mesh::PolygonMesh;
use stitch_mesh::obj::{Unit, read_obj};
use stitch_mesh::pieces::tube;
use stitch_mesh::stitch_mesh::StitchMesh;
use stitch_mesh::tessellate::tessellate;

const PULLOVER: &[u8] = include_bytes!("../../assets/meshes/pullover.obj");

fn pullover(width: f64) -> (PolygonMesh, StitchMesh) {
    let mesh = read_obj(PULLOVER, Unit::M).unwrap();
    let labelled = autolabel(&LabelledMesh::new(mesh.clone()));
    let counts = EdgeCounts::from_size(&labelled, StitchSize::of_width(width)).unwrap();
    (mesh, tessellate(&labelled, &counts).unwrap())
}

fn distorted_tube() -> (PolygonMesh, StitchMesh) {
    let input = tube(12, 5, StitchSize { width: 0.08, height: 0.12 }).unwrap().mesh().clone();
    let stitches = tube(144, 150, StitchSize { width: 0.96 / 144.0, height: 0.6 / 150.0 }).unwrap();
    let [low, high] = input.bounds();
    let shift = |p: &DVec3| {
        let turn = p.x.atan2(p.z);
        let t = (p.y - low.y) / (high.y - low.y);
        let turn = turn + 0.7 * turn.sin() + 0.1 * (7.0 * t).sin();
        let t = t + 0.11 * (TAU * t).sin();
        DVec3::new(high.z * turn.sin(), low.y + t * (high.y - low.y), high.z * turn.cos())
    };
    let positions = stitches.mesh().positions().iter().map(shift).collect();
    (input, stitches.moved_to(positions).unwrap())
}

fn relax(bench: &mut Criterion) {
    let mut group = bench.benchmark_group("mesh_relax");
    group.sample_size(10).measurement_time(Duration::from_secs(20)).warm_up_time(Duration::from_secs(1));
    let cases =
        [("sweater", pullover(4.14e-3)), ("dress", pullover(2.43e-3)), ("distorted tube", distorted_tube())];
    for (name, (input, stitches)) in cases {
        let title = format!("{name}, {} stitches", stitches.mesh().face_count());
        group.bench_function(title, |b| {
            b.iter(|| {
                let mut relaxation =
                    MeshRelaxation::new(&stitches, Some(&input), RelaxParams::default()).unwrap();
                relaxation.run(&mut |_, _| ControlFlow::Continue(()));
                relaxation.positions()
            });
        });
    }
    group.finish();
}

criterion_group!(benches, relax);
criterion_main!(benches);
