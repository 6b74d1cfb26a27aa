//! How long an edit of a garment takes: `cargo bench --workspace --bench editing`.
//!
//! A tube of 65 000 stitches. "Laying" is all yarn from nothing, "laying again" what an edit of one stitch does to the yarn,
//! the commands are what the document's thread does before the window has the new stitches, and the last ones are all of it: a key or
//! a button in the window, until the stitch mesh is drawn as it is then, on whatever adapter there is.

#![allow(missing_docs, clippy::unwrap_used, reason = "a benchmark that cannot begin has to stop")]

use app::command::Command;
use criterion::{Criterion, criterion_group, criterion_main};
use egui::{Key, Modifiers};
use egui_kittest::kittest::Queryable as _;
use std::sync::Arc;
use std::time::{Duration, Instant};
use stitch_mesh::edge_counts::StitchSize;
use stitch_mesh::ids::FaceId;
use stitch_mesh::lay::{lay, relay};
use stitch_mesh::pieces::tube;
use tests::fabrics::project_of;
use tests::window::Window;

/// The stitch that is edited, in the middle of the fabric.
const FACE: u32 = 31_000;

fn editing(bench: &mut Criterion) {
    let stitches = tube(260, 250, StitchSize::of_width(3e-3)).unwrap();
    let mut group = bench.benchmark_group("65 000 stitches");
    group.sample_size(10).measurement_time(Duration::from_secs(4)).warm_up_time(Duration::from_secs(1));
    group.bench_function("laying all yarn", |b| b.iter_with_large_drop(|| lay(&stitches)));

    let top = stitches.tops(FaceId(FACE)).next().unwrap();
    let edge = [stitches.mesh().origin(top).0, stitches.mesh().tip(top).0];
    let project = project_of(stitches.clone());
    let net = project.fabric().unwrap().net();
    let set = |symbol: &str| Command::SetStitch { faces: vec![FACE], stitch: symbol.parse().unwrap() };
    let edits = [("a purl", set("p")), ("a slip", set("s")), ("a split edge", Command::SplitCourse { edge })];
    for (name, command) in edits {
        group.bench_function(format!("command: {name}"), |b| b.iter(|| command.apply(&project).unwrap()));
        let after = command.apply(&project).unwrap().fabric.unwrap().stitches;
        group.bench_function(format!("laying again: {name}"), |b| b.iter(|| relay(net, &stitches, &after)));
    }

    let mut window = Window::new(project);
    window.press("Stitches");
    window.press("Front");
    window.press("Finish");
    let mut until_drawn = |name: &str, side: Option<usize>, act: &dyn Fn(&mut Window)| {
        group.bench_function(format!("until drawn: {name}"), |b| {
            b.iter_custom(|times| {
                let mut taken = Duration::ZERO;
                for _ in 0..times {
                    window.key(Modifiers::NONE, if side.is_some() { Key::Num1 } else { Key::Num2 });
                    window.click_stitch(FACE, side, Modifiers::NONE);
                    // What follows an edit (yarn, facts) is over before the next one.
                    window.rest();
                    let before = window.editor().project().fabric().unwrap().stitches.clone();
                    let begun = Instant::now();
                    act(&mut window);
                    window.show(|e| !Arc::ptr_eq(&before, &e.project().fabric().unwrap().stitches));
                    taken += begun.elapsed();
                    window.key(Modifiers::COMMAND, Key::Z);
                }
                taken
            });
        });
    };
    until_drawn("a purl", None, &|w| w.harness.key_press(Key::P));
    until_drawn("a twist", None, &|w| w.harness.key_press(Key::T));
    until_drawn("a split edge", Some(2), &|w| w.harness.get_by_label("Split loop").click());
    group.finish();
}

criterion_group!(benches, editing);
criterion_main!(benches);
