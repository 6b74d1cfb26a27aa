//! Yarns of several materials: in scripts, in files, in the window.

#![allow(clippy::unwrap_used, reason = "helpers of tests are tests, which clippy cannot see")]

use app::command::Command;
use app::document::Document;
use app::project::Project;
use egui_kittest::kittest::Queryable as _;
use serde_json::{Value, json};
use sim_core::{Material, Preset};
use stitch_mesh::dye::Dye;
use stitch_mesh::wrapping::Wrapping;
use tests::window::{Window, knitted};
use tests::{Program, asset};

const RED: Dye = Dye([0xc0, 0x40, 0x30]);

fn program() -> Program {
    let program = Program::new(env!("CARGO_BIN_EXE_purlwise-tested"));
    program.json(&["new", &asset("swatch"), "-o", "a.purl"]);
    program
}

#[test]
fn scripts_give_colours_their_materials_and_files_keep_them() {
    let program = program();
    program.write(
        "yarns.jsonl",
        concat!(
            "{\"do\":\"dye_rows\",\"rows\":[2,4],\"color\":\"#c04030\"}\n",
            "{\"do\":\"use_preset\",\"color\":\"#c04030\",\"preset\":\"cotton\"}\n",
            "{\"do\":\"use_preset\",\"preset\":\"sweater\"}\n",
        ),
    );
    program.json(&["edit", "a.purl", "yarns.jsonl", "-o", "b.purl"]);
    let project = Project::open(&program.path("b.purl")).unwrap();
    let width = project.materials.base.radius * 4.0;
    let cotton = Preset::Cotton.material(width);
    assert!((project.materials.of(RED).density / cotton.density - 1.0).abs() < 1e-9);
    assert_eq!(project.materials.of(RED).friction, 0.4);
    assert_eq!(project.materials.of(Dye::UNDYED).friction, 0.3);

    // A file from before there were several yarns.
    let mut old: Value = serde_json::from_slice(&program.read("b.purl")).unwrap();
    old.as_object_mut().unwrap().remove("yarns").unwrap();
    old["scene"].as_object_mut().unwrap().remove("air").unwrap();
    program.write("old.purl", old.to_string());
    assert!(Project::open(&program.path("old.purl")).unwrap().materials.by_dye.is_empty());

    let mut bad: Value = serde_json::from_slice(&program.read("b.purl")).unwrap();
    bad["yarns"]["#c04030"]["density"] = json!(0.0);
    program.write("bad.purl", bad.to_string());
    let run = program.run(&["simulate", "bad.purl", "-o", "c.purl"]);
    assert_eq!(run.status, Some(1));
    assert!(run.stderr.contains("material of the yarn #c04030: density is 0.0"), "{}", run.stderr);
}

#[test]
fn scripts_wrap_single_stitches_and_files_keep_it() {
    let program = program();
    program.write(
        "wrap.jsonl",
        concat!(
            "{\"do\":\"set_wrap\",\"faces\":[3,4,5],\"modulus\":2.0,\"angle_deg\":60}\n",
            "{\"do\":\"set_wrap\",\"faces\":[4],\"modulus\":0}\n",
            "{\"do\":\"set_wrap\",\"faces\":[5],\"angle_deg\":null}\n",
            "{\"do\":\"tessellate\"}\n",
        ),
    );
    program.json(&["edit", "a.purl", "wrap.jsonl", "-o", "b.purl"]);
    let wrappings = |name: &str| {
        let project = Project::open(&program.path(name)).unwrap();
        project.fabric().unwrap().stitches.wrappings().to_vec()
    };
    let of_material = Wrapping::OF_MATERIAL;
    let third = Wrapping { modulus: 2.0, angle: Some(60f64.to_radians()) };
    let fourth = Wrapping { modulus: 0.0, angle: None };
    assert_eq!(wrappings("b.purl")[2..7], [of_material, third, fourth, of_material, of_material]);

    // A file from before stitches had wrappings.
    let mut old: Value = serde_json::from_slice(&program.read("b.purl")).unwrap();
    old["fabric"].as_object_mut().unwrap().remove("wrappings").unwrap();
    program.write("old.purl", old.to_string());
    assert!(wrappings("old.purl").iter().all(|w| *w == of_material));
    assert!(!String::from_utf8(program.read("a.purl")).unwrap().contains("wrappings"), "nothing to write");

    let mut bad: Value = serde_json::from_slice(&program.read("b.purl")).unwrap();
    bad["fabric"]["wrappings"][4]["modulus"] = json!(-0.5);
    program.write("bad.purl", bad.to_string());
    let run = program.run(&["simulate", "bad.purl", "-o", "c.purl"]);
    assert_eq!(run.status, Some(1));
    assert!(run.stderr.contains("face 4: wrapping: modulus is -0.5"), "{}", run.stderr);
}

#[test]
fn wrapping_that_no_stitch_has_is_named() {
    let program = program();
    for (what, says) in [
        ("\"modulus\":-1", "line 1: wrapping: modulus is -1.0, and must be at least 0"),
        ("\"modulus\":1e9", "modulus is 1000000000.0"),
        ("\"modulus\":1e999", "line 1"),
        ("\"angle_deg\":200", "wrapping: angle is 200°, and must be at least 0° and at most 180°"),
        ("\"angle_deg\":-5", "angle is -5°"),
        ("\"angle\":1", "unknown field `angle`"),
    ] {
        program.write("wrap.jsonl", format!("{{\"do\":\"set_wrap\",\"faces\":[3],{what}}}\n"));
        let run = program.run(&["edit", "a.purl", "wrap.jsonl", "-o", "b.purl"]);
        assert_eq!(run.status, Some(1), "{what}");
        assert!(run.stderr.contains(says), "{}", run.stderr);
    }
    program.write("wrap.jsonl", "{\"do\":\"set_wrap\",\"faces\":[99999],\"modulus\":1}\n");
    let run = program.run(&["edit", "a.purl", "wrap.jsonl", "-o", "b.purl"]);
    assert!(run.stderr.contains("there is no face 99999"), "{}", run.stderr);
}

#[test]
fn wrapping_can_be_undone() {
    let mut document = Document::new(knitted());
    let wrapping = |document: &Document| document.project().fabric().unwrap().stitches.wrappings()[7];
    let half = Command::SetWrap { faces: vec![7, 8], modulus: Some(0.5), angle_deg: Some(60.0) };
    document.apply(half).unwrap();
    document.apply(Command::SetWrap { faces: vec![7], modulus: None, angle_deg: None }).unwrap();
    let names: Vec<String> = document.steps().collect();
    assert_eq!(names, ["Wrap 2 stitches × 0.5 at 60°", "Wrap 1 stitch as the material has it"]);
    assert_eq!(wrapping(&document), Wrapping::OF_MATERIAL);
    assert!(document.undo());
    assert_eq!(wrapping(&document), Wrapping { modulus: 0.5, angle: Some(60f64.to_radians()) });
    assert!(document.undo());
    assert_eq!(wrapping(&document), Wrapping::OF_MATERIAL);
    assert!(document.redo());
    assert_eq!(wrapping(&document).modulus, 0.5);
}

#[test]
fn a_material_that_is_not_there_cannot_be_cleared() {
    let program = program();
    program.write("clear.jsonl", "{\"do\":\"clear_material\",\"color\":\"#c04030\"}\n");
    let run = program.run(&["edit", "a.purl", "clear.jsonl", "-o", "b.purl"]);
    assert_eq!(run.status, Some(1));
    assert!(run.stderr.contains("#c04030 has no material of its own"), "{}", run.stderr);
}

#[test]
fn the_window_chooses_materials_by_colour() {
    let mut project = knitted();
    let faces = (0..40).collect();
    project = Command::Dye { faces, color: RED }.apply(&project).unwrap();
    let mut window = Window::new(project);
    window.press("Simulate");
    window.press("Yarn #c04030");
    window.press("Preset…");
    window.press("Cotton");
    let of = |window: &Window, dye: Dye| window.editor().project().materials.of(dye).clone();
    assert_eq!(of(&window, RED).friction, 0.4);
    assert_eq!(of(&window, Dye::UNDYED).friction, 0.3);

    // A number typed into a field is a step of the history, too.
    window.harness.get_by_label("Friction").click();
    window.harness.step();
    window.harness.get_by_label("Friction").type_text("0.7");
    window.key(egui::Modifiers::NONE, egui::Key::Enter);
    assert_eq!(of(&window, RED).friction, 0.7);
    window.keep("materials");
    window.press("As the rest");
    let base: Material = of(&window, Dye::UNDYED);
    assert_eq!(of(&window, RED), base);
}
