//! Scenes as people write them: files, errors, forces; holding by hand in the window.

#![allow(clippy::unwrap_used, clippy::panic, reason = "helpers of tests are tests, which clippy cannot see")]

use app::project::Project;
use egui::{Key, Modifiers};
use egui_kittest::kittest::Queryable as _;
use sim_core::Body;
use tests::window::{Window, knitted};
use tests::{Program, asset, root};

const CUBE: &str = "v -1 -1 -1\nv 1 -1 -1\nv -1 1 -1\nv 1 1 -1\nv -1 -1 1\nv 1 -1 1\nv -1 1 1\nv 1 1 1\n\
                    f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";

fn program() -> Program {
    let program = Program::new(env!("CARGO_BIN_EXE_purlwise-tested"));
    program.json(&["new", &asset("swatch"), "-o", "a.purl"]);
    program
}

/// What a scene file comes to.
fn simulated(program: &Program, text: &str) -> (serde_json::Value, Project) {
    program.write("scene.json", text);
    let facts =
        program.json(&["simulate", "a.purl", "--scene", "scene.json", "--seconds", "0.02", "-o", "b.purl"]);
    (facts, Project::open(&program.path("b.purl")).unwrap())
}

fn error(program: &Program, text: &str) -> String {
    program.write("scene.json", text);
    let run = program.run(&["simulate", "a.purl", "--scene", "scene.json", "-o", "b.purl"]);
    assert_eq!(run.status, Some(1), "{text}");
    run.stderr
}

#[test]
fn the_example_of_the_documentation_is_a_scene() {
    let document = std::fs::read_to_string(root().join("docs/scenes.md")).unwrap();
    let example = document.split("```").nth(1).unwrap();
    let (facts, project) = simulated(&program(), example);
    let scene = &project.scene;
    assert_eq!((scene.clamps.len(), scene.bodies.len()), (2, 1));
    assert_eq!(scene.bodies[0].pose(2.0).apply(glam::DVec3::ZERO).y, 0.0);
    let holds: Vec<&str> =
        facts["sim"]["holds"].as_array().unwrap().iter().map(|h| h["what"].as_str().unwrap()).collect();
    assert_eq!(holds, ["top", "jaw", "sphere 0"]);
}

#[test]
fn parts_of_the_fabric_are_found_by_name_and_by_place() {
    let program = program();
    let (_, project) = simulated(
        &program,
        r#"{"origin": "fabric", "hold": [
            {"row": 1}, {"stitches": [0, 3]}, {"nodes": [5]}, {"stiffness": 2.5, "region": {"from": [0,-500,-500], "to": [500,500,500]}}]}"#,
    );
    let fabric = project.fabric().unwrap();
    let counts: Vec<usize> = project.scene.clamps.iter().map(|c| c.nodes.len()).collect();
    assert_eq!(counts[0], 4 * fabric.stitches.rows()[1].faces.len());
    assert_eq!(counts[1..3], [8, 1]);
    let half = fabric.net().nodes.len() as f64 / 2.0;
    assert!((counts[3] as f64 / half - 1.0).abs() < 0.1, "{} of {half}", counts[3]);
    assert_eq!(project.scene.clamps[3].stiffness, 2.5);
}

#[test]
fn bodies_come_from_shapes_meshes_and_skeletons() {
    let program = program();
    program.write("cube.obj", CUBE);
    let (_, project) = simulated(
        &program,
        r#"{"gravity": [0,0,0], "bodies": [
            {"mesh": {"file": "cube.obj", "unit": "cm", "at": [0, -300, 0]}},
            {"box": {"center": [0,-400,0], "size": [10,20,30], "turn": [0,45,0]}, "move": {"speed": [1,0,0]}},
            {"skeleton": {"bones": [{"name": "a", "from": [0,-500,0], "to": [0,-600,0], "radius": 10}],
                          "keys": [{"at": 0}, {"at": 1, "turns": {"a": [0,0,360]}}], "repeat": true}}]}"#,
    );
    let [mesh, moving, bone] = &project.scene.bodies[..] else { panic!("three bodies") };
    let Body::Mesh { mesh, .. } = mesh else { panic!("a mesh") };
    assert_eq!(mesh.triangles().triangles.len(), 12);
    assert!((mesh.distance(glam::DVec3::new(0.0, -0.31, 0.0)).0).abs() < 1e-3);
    assert_eq!(moving.pose(10.0).apply(glam::DVec3::ZERO).x.mul_add(1e3, 0.5).floor(), 10.0);
    // Sampled by keys, a whole round is still one.
    assert!(
        bone.pose(0.75).apply(glam::DVec3::new(0.0, -0.6, 0.0)).distance(glam::DVec3::new(-0.1, -0.5, 0.0))
            < 1e-6
    );
}

/// The cube as it is when it has grown upwards by `more` cm.
fn taller(more: u32) -> String {
    CUBE.replace(" 1 -1\n", &format!(" {} -1\n", 1 + more)).replace(" 1 1\n", &format!(" {} 1\n", 1 + more))
}

#[test]
fn a_sequence_of_meshes_is_a_body() {
    let program = program();
    std::fs::create_dir(program.path("grow")).unwrap();
    (0..3).for_each(|i| program.write(&format!("grow/cube-{i:02}.obj"), taller(i)));
    program.write("grow/cube-1.obj", "another one");
    let (_, project) = simulated(
        &program,
        r#"{"gravity": [0,0,0], "bodies": [
            {"mesh_sequence": {"pattern": "grow/cube-##.obj", "rate": 10, "unit": "cm", "at": [0, -300, 0]}},
            {"mesh_sequence": {"files": ["grow/cube-00.obj", "grow/cube-02.obj"], "rate": 2, "repeat": true, "unit": "cm",
                               "at": [0, -500, 0]}, "move": {"speed": [5, 0, 0]}}]}"#,
    );
    let top = |body: &Body, time_s: f64| {
        let mesh = body.sequence().unwrap().at(time_s);
        mesh.positions.iter().map(|x| 1e3 * x.y).fold(f64::NEG_INFINITY, f64::max)
    };
    let [once, again] = &project.scene.bodies[..] else { panic!("two bodies") };
    assert!((top(once, 0.15) + 275.0).abs() < 1e-9 && (top(once, 9.0) + 270.0).abs() < 1e-9);
    assert!((top(again, 0.75) + 480.0).abs() < 1e-9);
    assert_eq!(again.pose(1.0).apply(glam::DVec3::ZERO), glam::DVec3::X * 5e-3);
}

#[test]
fn errors_say_what_and_where() {
    let program = program();
    program.write("open.obj", CUBE.rsplit_once("f 2").unwrap().0);
    program.write("cube.obj", CUBE);
    program.write("other.obj", format!("# another\n{}", CUBE.replace("f 3 7 8 4", "f 7 8 4 3")));
    program.write("more.obj", CUBE.replace("f 1 3 4 2", "v 0 -2 -1\nf 1 3 4 2 9"));
    for (text, words) in [
        ("# two lines\n{\"gravty\": [0,0,0]}", &["scene.json", "gravty", "line 2"][..]),
        (r#"{"hold": [{"name": "top", "row": 99}]}"#, &["top", "no row 99", "0–"]),
        (r#"{"hold": [{"stitches": [9999]}]}"#, &["hold 0", "no stitch 9999"]),
        (r#"{"hold": [{"region": {"from": [9000,0,0], "to": [9001,1,1]}}]}"#, &["hold 0", "no yarn there"]),
        (r#"{"hold": [{"row": 0, "nodes": [1]}]}"#, &["hold 0", "one of"]),
        (r#"{"bodies": [{"ground": {"height": 0}}, {"friction": 1}]}"#, &["body 1", "one of"]),
        (r#"{"bodies": [{"mesh": {"file": "open.obj"}}]}"#, &["body 0", "open.obj", "not closed"]),
        (r#"{"bodies": [{"mesh": {"file": "none.obj"}}]}"#, &["body 0", "none.obj"]),
        (
            r#"{"bodies": [{"mesh_sequence": {"files": ["cube.obj", "other.obj"], "rate": 25}}]}"#,
            &["body 0", "other.obj: line 13", "face 3 is not that of cube.obj"],
        ),
        (
            r#"{"bodies": [{"mesh_sequence": {"files": ["cube.obj", "more.obj"], "rate": 25}}]}"#,
            &["body 0", "more.obj: line 9", "9 vertices, where cube.obj has 8"],
        ),
        (r#"{"bodies": [{"mesh_sequence": {"pattern": "no-##.obj", "rate": 25}}]}"#, &["'no-##.obj'"]),
        (r#"{"bodies": [{"mesh_sequence": {"files": ["cube.obj"], "rate": 0}}]}"#, &["body 0", "positive"]),
        (
            r#"{"bodies": [{"mesh_sequence": {"files": ["open.obj"], "rate": 25}}]}"#,
            &["open.obj", "not closed"],
        ),
        (r#"{"bodies": [{"sphere": {"center": [0,0,0], "radius": -1}}]}"#, &["body 0"]),
        (
            r#"{"bodies": [{"ground": {"height": 0}, "move": {"keys": [{"at": 1}, {"at": 1}]}}]}"#,
            &["body 0", "order"],
        ),
        (r#"{"time_step_ms": 0}"#, &["time step"]),
    ] {
        let message = error(&program, text);
        assert!(words.iter().all(|w| message.contains(w)), "{text}: {message}");
    }
}

#[test]
fn the_window_holds_stitches_and_shows_the_force() {
    let mut window = Window::new(knitted());
    window.press("Simulate");
    window.press("hang");
    let clamps = |window: &Window| window.editor().project().scene.clamps.len();
    assert_eq!(clamps(&window), 1);
    window.press("Stitches");
    window.press("Front");
    window.key(Modifiers::NONE, Key::Num2);
    let corner = window.at_stitch(0, None);
    window.click_all(&[corner]);
    window.press("Yarn");
    window.press("Simulate");
    window.press("Hold");
    assert_eq!((clamps(&window), window.editor().project().scene.clamps[1].nodes.len()), (2, 4));
    window.press("Step");
    window.wait("a force", |e| e.yarn().is_some_and(|y| y.holds.len() == 2 && y.holds[0].force_n.y > 0.0));
    window.rest();
    let force = &window.editor().yarn().unwrap().holds[0];
    assert!(force.what == "top" && window.harness.query_by_label_contains("top: ").is_some());
    window.keep("scene");
    window.press("Let go");
    assert_eq!(clamps(&window), 0);
}
