//! Yarn that is cut and loops that are dropped: in scripts, in files, in the window.

use app::command::Command;
use app::document::Document;
use app::project::Project;
use egui::{Key, Modifiers};
use tests::fabrics::project_of;
use tests::window::{Window, knitted};
use tests::{Program, asset};

#[test]
fn a_script_cuts_and_the_file_keeps_it() {
    let program = Program::new(env!("CARGO_BIN_EXE_purlwise-tested"));
    program.json(&["new", &asset("swatch"), "-o", "a.purl"]);
    program.write(
        "cut.jsonl",
        "{\"do\":\"cut_yarn\",\"faces\":[30,31]}\n{\"do\":\"drop_loops\",\"faces\":[50]}\n",
    );
    let before = program.json(&["inspect", "a.purl"]);
    program.json(&["edit", "a.purl", "cut.jsonl", "-o", "b.purl"]);
    let cut = program.json(&["inspect", "b.purl"]);
    let open = |facts: &serde_json::Value| facts["yarns"]["open"].as_u64().unwrap();
    assert_eq!(open(&cut), open(&before) + 2);
    let yarn = |facts: &serde_json::Value| facts["yarn_length_m"].as_f64().unwrap();
    assert!((yarn(&cut) / yarn(&before) - 1.0).abs() < 0.01, "{} m, {} m", yarn(&cut), yarn(&before));
    let problems = cut["problems"].to_string();
    assert!(problems.contains("laying the yarn anew mends it"), "{problems}");
    program.json(&["simulate", "b.purl", "-o", "c.purl", "--scene", "free", "--seconds", "0.05"]);
    // What slips out while it is simulated is in the file too, or this state would not fit.
    let simulated = Project::open(&program.path("c.purl")).unwrap();
    let fabric = simulated.fabric().unwrap();
    assert!(fabric.surgery.operations.len() >= 3 && fabric.state().fits(fabric.net()));

    program.write("bad.jsonl", "{\"do\":\"cut_yarn\",\"faces\":[99999]}\n");
    let run = program.run(&["edit", "a.purl", "bad.jsonl", "-o", "d.purl"]);
    assert_eq!(run.status, Some(1));
    assert!(run.stderr.contains("there is no face 99999"), "{}", run.stderr);
}

#[test]
fn a_cut_is_undone_and_mended_by_laying_anew() {
    let stitches =
        stitch_mesh::pieces::rectangle(6, 6, stitch_mesh::edge_counts::StitchSize::of_width(0.004));
    let mut document = Document::new(project_of(stitches.unwrap()));
    let yarns = |d: &Document| d.project().fabric().unwrap().net().yarns.len();
    let whole = yarns(&document);
    document.apply(Command::CutYarn { faces: vec![14] }).unwrap();
    assert_eq!(yarns(&document), whole + 1);
    assert!(document.undo());
    assert_eq!(yarns(&document), whole);
    assert!(document.redo());
    assert_eq!(yarns(&document), whole + 1);
    document.apply(Command::ResetYarn).unwrap();
    assert_eq!(yarns(&document), whole);
}

#[test]
fn the_window_cuts_while_it_plays() {
    let mut window = Window::new(knitted());
    window.press("Stitches");
    window.press("Front");
    let mesh = window.editor().project().fabric().unwrap().stitches.mesh().clone();
    let at = window.at_face(&mesh, 30, None);
    window.click(at, Modifiers::NONE);
    window.press("Yarn");
    window.key(Modifiers::NONE, Key::Space);
    window.wait("playing", |e| e.yarn().is_some_and(|s| s.playing && s.time_s > 0.02));
    let whole = window.editor().yarn().unwrap().curves.curves.len();
    window.key(Modifiers::NONE, Key::F3);
    window.harness.event(egui::Event::Text("cut yarn".to_owned()));
    window.rest();
    window.key(Modifiers::NONE, Key::Enter);
    window.wait("cut", |e| e.yarn().is_some_and(|s| s.curves.curves.len() == whole + 1 && s.time_s > 0.02));
    assert!(window.editor().yarn().unwrap().error.is_none());
    window.key(Modifiers::NONE, Key::Space);
    window.keep("cut");
    window.key(Modifiers::COMMAND, Key::Z);
    window.wait("mended", |e| e.yarn().is_some_and(|s| s.curves.curves.len() == whole));
}
