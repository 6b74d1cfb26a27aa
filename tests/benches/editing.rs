//! How long an edit of a garment takes: `cargo bench --workspace --bench editing`.
//!
//! A tube of 65 000 stitches. "Laying" is all yarn from nothing, "restacking" what painting a purl does to the net, the
//! commands are what the document thread does for one edit (yarn, pins, what is carried over), and the last is all of it: a key in
//! the window, until the stitch mesh is drawn with the new stitch, on whatever adapter there is.

#![allow(missing_docs, clippy::unwrap_used, reason = "a benchmark that cannot begin has to stop")]

use app::command::Command;
use criterion::{Criterion, criterion_group, criterion_main};
use egui::{Key, Modifiers};
use std::time::{Duration, Instant};
use stitch_mesh::edge_counts::StitchSize;
use stitch_mesh::ids::FaceId;
use stitch_mesh::lay::{lay, relay};
use stitch_mesh::pieces::tube;
use stitch_mesh::stitch::Stitch;
use tests::fabrics::project_of;
use tests::window::Window;

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

    let mut window = Window::new(project);
    window.press("Stitches");
    window.press("Front");
    window.click_stitch(31_000, None, Modifiers::NONE);
    let face = window.selected()[0];
    let mut purl = false;
    group.bench_function("a key in the window until its stitch shows", |b| {
        b.iter_custom(|times| {
            let mut taken = Duration::ZERO;
            for _ in 0..times {
                // What follows an edit (facts, the simulation of the new yarn) is over before the next one.
                window.rest();
                purl = !purl;
                let begun = Instant::now();
                window.harness.key_press(if purl { Key::P } else { Key::K });
                window.show(|editor| {
                    let fabric = editor.project().fabric().unwrap();
                    *fabric.stitches.stitch(FaceId(face))
                        == if purl { Stitch::purl() } else { Stitch::knit() }
                });
                taken += begun.elapsed();
            }
            taken
        });
    });
    group.finish();
}

criterion_group!(benches, editing);
criterion_main!(benches);
