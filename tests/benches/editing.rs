//! How long an edit of a garment takes: `cargo bench --workspace --bench editing`.
//!
//! A tube of 65 000 stitches. "Laying" is all yarn from nothing, "restacking" what painting a purl does to the net, the
//! commands are what the document thread does for one edit (yarn, pins, what is carried over), and "redrawing" is the picture of
//! the stitch mesh at 1280 × 720 on whatever adapter there is.

#![allow(missing_docs, clippy::unwrap_used, reason = "a benchmark that cannot begin has to stop")]

use app::command::Command;
use app::drawing::{Stage, drawing};
use criterion::{BatchSize, Criterion, criterion_group, criterion_main};
use render::{Camera, NamedView, Quality, Renderer, Scene, Viewport};
use std::time::Duration;
use stitch_mesh::edge_counts::StitchSize;
use stitch_mesh::ids::FaceId;
use stitch_mesh::lay::{lay, relay};
use stitch_mesh::pieces::tube;
use stitch_mesh::stitch::Stitch;
use tests::fabrics::project_of;

fn editing(bench: &mut Criterion) {
    let stitches = tube(260, 250, StitchSize::of_width(3e-3)).unwrap();
    let mut group = bench.benchmark_group("65 000 stitches");
    group.sample_size(10).measurement_time(Duration::from_secs(4)).warm_up_time(Duration::from_secs(1));
    group.bench_function("laying all yarn", |b| b.iter_with_large_drop(|| lay(&stitches)));

    let net = lay(&stitches);
    let mut purled = stitches.clone();
    purled.set_stitch(FaceId(31_000), Stitch::purl()).unwrap();
    group.bench_function("restacking after a purl", |b| {
        b.iter_with_large_drop(|| relay(&net, &stitches, &purled))
    });

    let project = project_of(stitches.clone());
    let edge = project.fabric().unwrap().stitches.tops(FaceId(31_000)).next().unwrap();
    let edge = [stitches.mesh().origin(edge).0, stitches.mesh().tip(edge).0];
    let commands = [
        ("command: a purl", Command::SetStitch { faces: vec![31_000], stitch: Stitch::purl() }),
        ("command: a slip", Command::SetStitch { faces: vec![31_000], stitch: "s".parse().unwrap() }),
        ("command: split a course edge", Command::SplitCourse { edge }),
    ];
    for (name, command) in commands {
        group.bench_function(name, |b| b.iter_with_large_drop(|| command.apply(&project).unwrap()));
    }

    let gpu = render::Gpu::headless().unwrap();
    let renderer = Renderer::new(&gpu, Quality::Interactive);
    let size = [1280, 720];
    let viewport = Viewport::new(&gpu, &renderer, size).unwrap();
    group.bench_function("redrawing the stitch mesh", |b| {
        b.iter_batched(
            Scene::new,
            |mut scene| {
                let picture = drawing(&project, Stage::Stitches).unwrap();
                let camera = Camera::named(NamedView::Front, picture.bounds().unwrap(), 1280.0 / 720.0);
                scene.set(&gpu, &picture).unwrap();
                let mut encoder = gpu.device.create_command_encoder(&Default::default());
                renderer.draw(&gpu, &mut encoder, &viewport, &camera, &scene);
                gpu.queue.submit([encoder.finish()]);
                gpu.device.poll(egui_wgpu::wgpu::PollType::wait_indefinitely()).unwrap();
            },
            BatchSize::PerIteration,
        );
    });
    group.finish();
}

criterion_group!(benches, editing);
criterion_main!(benches);
