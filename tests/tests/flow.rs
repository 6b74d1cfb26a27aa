//! The whole job without a window, as a person would type it, and what the figures have to say about it.

#![allow(clippy::unwrap_used, clippy::panic, reason = "helpers of tests are tests, which clippy cannot see")]

use app::command::{Command, read_script, write_script};
use app::document::Document;
use app::project::Project;
use serde_json::Value;
use stitch_mesh::edge_counts::StitchSize;
use stitch_mesh::mesh::PolygonMesh;
use stitch_mesh::obj::Unit;
use stitch_mesh::stitch::Stitch;
use tests::{ASSETS, Program, asset};

fn program() -> Program {
    Program::new(env!("CARGO_BIN_EXE_purlwise-tested"))
}

fn number(facts: &Value, name: &str) -> f64 {
    facts[name].as_f64().unwrap_or_else(|| panic!("no {name} in {facts}"))
}

/// What holds for any fabric.
fn check_facts(facts: &Value) {
    assert_eq!(facts["problems"], serde_json::json!([]));
    let stitches: f64 = facts["stitches"].as_object().unwrap().values().map(|n| n.as_f64().unwrap()).sum();
    assert_eq!(stitches, number(facts, "faces"));
    assert!(number(facts, "rows") > 1.0 && number(facts, "rows") < number(facts, "faces"));
    // Loops at the lower and upper border share their nodes with cast-on and bind-off.
    let nodes_a_loop = number(facts, "contact_nodes") / number(facts, "loops");
    assert!((3.5..6.5).contains(&nodes_a_loop), "{nodes_a_loop} contact nodes a loop");
    assert!(number(facts, "dofs") >= 5.0 * number(facts, "contact_nodes"));
    let mm_a_loop = 1e3 * number(facts, "yarn_length_m") / number(facts, "loops");
    let width = number(facts, "mean_wale_spacing_mm");
    assert!((2.0..6.0).contains(&(mm_a_loop / width)), "{mm_a_loop} mm of yarn for a loop {width} mm wide");
}

/// Mean height of the exported yarn [m].
fn mean_height(program: &Program, project: &str) -> f64 {
    program.json(&["export", project, "-o", "height.obj"]);
    let text = String::from_utf8(program.read("height.obj")).unwrap();
    let heights: Vec<f64> = text
        .lines()
        .filter_map(|l| l.strip_prefix("v "))
        .map(|l| l.split(' ').nth(1).unwrap().parse().unwrap())
        .collect();
    heights.iter().sum::<f64>() / heights.len() as f64
}

/// Mesh, stitch width [mm], yarns with ends, rings.
#[track_caller]
fn goes_through(name: &str, width: &str, open: u64, has_rings: bool) {
    let program = program();
    let laid = program.json(&["new", &asset(name), "-o", "laid.purl", "--stitch-size", width]);
    check_facts(&laid);
    assert_eq!(laid["yarns"]["open"], open, "{}", laid["yarns"]);
    assert_eq!(laid["yarns"]["closed"].as_u64().unwrap() > 0, has_rings, "{}", laid["yarns"]);

    program.write("rib.jsonl", "{\"do\":\"set_chart\",\"chart\":[\"k p\"],\"rows\":[1,2]}\n");
    let ribbed = program.json(&["edit", "laid.purl", "rib.jsonl", "-o", "ribbed.purl"]);
    check_facts(&ribbed);
    assert!(number(&ribbed["stitches"], "p") > 0.0 && laid["stitches"]["p"].is_null());
    for same in ["faces", "rows", "loops", "contact_nodes", "boundary_edges"] {
        assert_eq!(ribbed[same], laid[same], "{same}");
    }

    let relaxed = program.json(&["relax", "ribbed.purl", "-o", "relaxed.purl", "--stage", "contact"]);
    let sim = &relaxed["sim"];
    assert_eq!(sim["solver"], "cpu");
    assert!(number(sim, "steps") > 0.0 && number(sim, "time_s") > 0.0 && number(sim, "kinetic_j") < 1e-3);
    assert!(number(sim, "max_stretch") < 0.05, "{sim}");
    assert_ne!(relaxed["size_mm"], ribbed["size_mm"], "relaxing moves the yarn");
    assert_eq!(relaxed["yarn_length_m"], ribbed["yarn_length_m"], "but makes none");

    let dropped = program.json(&[
        "simulate",
        "relaxed.purl",
        "-o",
        "dropped.purl",
        "--scene",
        "ground",
        "--seconds",
        "0.05",
    ]);
    assert!((number(&dropped["sim"], "time_s") - 0.05).abs() < 0.01, "{}", dropped["sim"]);
    // It fell g t² ÷ 2 = 12 mm, a little less with damping.
    let fallen = mean_height(&program, "relaxed.purl") - mean_height(&program, "dropped.purl");
    assert!((0.008..0.014).contains(&fallen), "fallen by {fallen} m");
    assert_eq!(program.json(&["inspect", "dropped.purl"]), dropped);

    for stage in ["mesh", "labels", "stitches", "yarn"] {
        program.json(&["render", "dropped.purl", "-o", "a.png", "--stage", stage, "--size", "200x150"]);
        let picture = image::load_from_memory(&program.read("a.png")).unwrap().into_rgb8();
        assert_eq!(picture.dimensions(), (200, 150));
        let colours: std::collections::HashSet<_> = picture.pixels().collect();
        // The background alone, a gradient in greys, has some 40.
        assert!(colours.len() > 100, "{stage}: {} colours only", colours.len());
    }
    for format in ["bcc", "obj", "usda"] {
        let exported = program.json(&["export", "dropped.purl", "-o", &format!("yarn.{format}")]);
        let yarns = &dropped["yarns"];
        assert_eq!(exported["yarns"], yarns["open"].as_u64().unwrap() + yarns["closed"].as_u64().unwrap());
        assert!(program.read(&format!("yarn.{format}")).len() > 1000);
    }
}

#[test]
fn a_flat_piece_is_one_yarn() {
    goes_through("swatch", "24", 1, false);
}

#[test]
fn a_tube_is_made_of_rings() {
    goes_through("cowl", "40", 0, true);
}

#[test]
fn a_crown_goes_through_too() {
    goes_through("hat", "36", 0, true);
}

#[test]
fn stitches_relax_on_the_surface_and_the_yarn_follows() {
    let program = program();
    let laid = program.json(&["new", &asset("pullover"), "-o", "laid.purl", "--stitch-size", "20"]);
    let even = program.json(&["relax", "laid.purl", "-o", "even.purl", "--stage", "mesh"]);
    check_facts(&even);
    for same in ["faces", "rows", "loops", "contact_nodes", "boundary_edges", "stitches", "yarns"] {
        assert_eq!(even[same], laid[same], "{same}");
    }
    let rms = |facts: &Value| number(&facts["mesh_strain"], "rms");
    assert!(rms(&even) < 0.8 * rms(&laid), "{} to {}", laid["mesh_strain"], even["mesh_strain"]);
    let worst = even["mesh_strain"]["worst"].as_array().unwrap();
    assert!(worst.len() == 5 && worst[0]["face"].is_u64(), "{worst:?}");
    assert_eq!(even["sim"], Value::Null);

    program.write("relax.jsonl", "{\"do\":\"relax_mesh\"}\n");
    program.json(&["edit", "laid.purl", "relax.jsonl", "-o", "edited.purl"]);
    assert!(program.read("edited.purl") == program.read("even.purl"), "the command is the same work");
    let free = program.json(&["relax", "laid.purl", "-o", "free.purl", "--stage", "mesh", "--free"]);
    assert!(rms(&free) < rms(&even), "in space there is nothing to keep stitches uneven");

    program.write("bad.jsonl", "{\"do\":\"relax_mesh\",\"fill\":7}\n");
    let refused = program.run(&["edit", "laid.purl", "bad.jsonl", "-o", "bad.purl"]);
    assert_eq!(refused.status, Some(1));
    assert!(refused.stderr.contains("the fill is 7"), "{}", refused.stderr);
}

fn opened(name: &str) -> Project {
    Project::from_obj(asset(name).as_ref(), Unit::M, StitchSize::of_width(0.01)).unwrap()
}

#[test]
fn every_bundled_mesh_labels_itself_and_becomes_stitches() {
    for name in ASSETS {
        let labelled = Command::Autolabel.apply(&opened(name)).unwrap();
        assert_eq!(labelled.labelled.problems(), [], "{name}");
        let project = Command::Tessellate { width_mm: Some(10.0) }.apply(&labelled).unwrap();
        let fabric = project.fabric().unwrap();
        let stitches = &fabric.stitches;
        // Inside, a plain stitch has four contact nodes of two yarns each.
        let mut nodes = vec![0; stitches.mesh().face_count()];
        for node in &fabric.net().nodes {
            if let (Some(face), 2) = (node.face, node.visits.len()) {
                nodes[face.index()] += 1;
            }
        }
        let inside = |f: &stitch_mesh::ids::FaceId| {
            let mesh: &PolygonMesh = stitches.mesh();
            *stitches.stitch(*f) == Stitch::knit() && mesh.face_half_edges(*f).all(|h| mesh.twin(h).is_some())
        };
        let inside: Vec<_> = stitches.mesh().faces().filter(inside).collect();
        assert!(inside.len() > 50, "{name}");
        assert!(inside.iter().all(|f| nodes[f.index()] == 4), "{name}");
    }
}

#[test]
fn undo_leads_back_and_a_script_leads_there_again() {
    let program = program();
    let save = |project: &Project, name: &str| project.save(&program.path(name)).unwrap();
    let start = opened("cowl");
    save(&start, "start.purl");
    let mut document = Document::new(start);
    let script = r#"
        {"do":"autolabel"}
        {"do":"clear_labels"}
        {"do":"autolabel"}
        {"do":"tessellate","width_mm":20}
        {"do":"set_chart","chart":["k p","p k"],"rows":[1,3]}
        {"do":"set_stitch","faces":[40,41],"stitch":"p"}
    "#;
    for (_, command) in read_script(script).unwrap() {
        document.apply(command).unwrap();
    }
    save(document.project(), "there.purl");
    let history = write_script(document.done()).unwrap();
    while document.undo() {}
    save(document.project(), "back.purl");
    while document.redo() {}
    save(document.project(), "again.purl");
    program.write("history.jsonl", history);
    program.json(&["edit", "start.purl", "history.jsonl", "-o", "replayed.purl"]);
    assert!(program.read("start.purl") == program.read("back.purl"));
    assert!(program.read("there.purl") == program.read("again.purl"));
    assert!(program.read("there.purl") == program.read("replayed.purl"));
    assert!(program.read("there.purl") != program.read("start.purl"));
}
