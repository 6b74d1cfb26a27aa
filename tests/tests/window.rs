//! The window, with mouse and keys: from labels to yarn.

#![allow(clippy::unwrap_used, clippy::panic, reason = "helpers of tests are tests, which clippy cannot see")]

use app::command::Command;
use app::drawing::Stage;
use app::project::Project;
use app::window::editor::Editor;
use egui::{Key, Modifiers};
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use glam::DVec3;
use stitch_mesh::ids::FaceId;
use stitch_mesh::stitch::Stitch;
use tests::window::{Window, knitted, swatch};

#[test]
fn labels_come_with_clicks_and_go_with_a_button() {
    let mut window = Window::new(swatch());
    let faces = window.editor().project().labelled.mesh().face_count();
    window.press("Front");
    assert_eq!(window.labelled_faces(), 0);
    assert!(window.harness.get_by_label("Tessellate").accesskit_node().is_disabled());

    window.click_side(0, 0, Modifiers::NONE);
    window.key(Modifiers::NONE, Key::R);
    let row = window.labelled_faces();
    assert!(row > 1 && row < faces, "one row of {faces} faces: {row}");
    window.keep("one-row");
    window.click_side(0, 2, Modifiers::NONE);
    window.key(Modifiers::NONE, Key::R);
    assert_eq!(window.labelled_faces(), 2 * row, "the next row from its course edge");
    window.key(Modifiers::COMMAND, Key::Z);
    assert_eq!(window.labelled_faces(), row);
    window.press("Fill onwards");
    assert_eq!(window.labelled_faces(), faces, "all rows onwards");
    window.keep("all-rows");

    window.press("Clear labels");
    assert_eq!(window.labelled_faces(), 0);
    window.press("Label automatically");
    assert_eq!(window.labelled_faces(), faces);
    assert!(!window.harness.get_by_label("Tessellate").accesskit_node().is_disabled());
    window.press("Tessellate");
    let fabric = window.editor().project().fabric().unwrap();
    assert_eq!(fabric.stitches.stitches().len(), fabric.stitches.mesh().face_count());
    assert!(fabric.stitches.mesh().face_count() > faces);
    window.keep("stitches");
}

#[test]
fn tabs_show_the_stages() {
    let mut window = Window::new(knitted());
    let mut pictures = Vec::new();
    for (tab, key) in
        [("Mesh", Key::Num1), ("Labels", Key::Num2), ("Stitches", Key::Num3), ("Yarn", Key::Num4)]
    {
        window.press(tab);
        window.press("Front");
        let by_click = window.keep(&format!("stage-{}", tab.to_lowercase()));
        window.press("Mesh");
        window.key(Modifiers::COMMAND, key);
        let by_key = window.keep("stage-by-key");
        assert!(by_click == by_key, "{tab} by click and by key");
        pictures.push(by_click);
    }
    for (i, a) in pictures.iter().enumerate() {
        assert!(pictures[..i].iter().all(|b| b != a), "{:?} looks like another stage", Stage::ALL[i]);
    }
}

#[test]
fn a_painted_row_shows_plays_undoes_and_is_saved() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("painted.purl");
    let mut window = Window::new(knitted());
    window.press("Stitches");
    window.press("Front");
    window.press("Row");
    window.press("Paint");
    window.press("p · purl");
    let fabric = window.editor().project().fabric().unwrap().clone();
    let mesh = fabric.stitches.mesh();
    let row = fabric.stitches.rows()[2].faces.clone();
    let corners: Vec<DVec3> = mesh.face_vertices(row[1]).map(|v| mesh.position(v)).collect();
    let middle = corners.iter().sum::<DVec3>() / corners.len() as f64;
    let at = window.on_screen(middle, mesh.positions().iter().copied());
    window.click(at, Modifiers::NONE);
    assert_eq!(window.purls(), row.len());
    let is_purl =
        |f: &FaceId| *window.editor().project().fabric().unwrap().stitches.stitch(*f) == Stitch::purl();
    assert!(row.iter().all(is_purl));
    window.keep("painted");

    window.press("Yarn");
    window.key(Modifiers::NONE, Key::Space);
    window.wait("playing", |e| e.yarn().is_some_and(|s| s.playing && s.time_s > 0.02));
    window.key(Modifiers::NONE, Key::Space);
    window.wait("pausing", |e| e.yarn().is_some_and(|s| !s.playing));
    let time = window.simulated();
    window.rest();
    assert_eq!(window.simulated(), time, "time stands still");
    assert!(window.editor().yarn().unwrap().error.is_none());
    window.keep("played");

    window.harness.get_by_label("Path").focus();
    window.harness.step();
    window.harness.get_by_label("Path").type_text(path.to_str().unwrap());
    window.rest();
    window.press("Save");
    let saved = Project::open(&path).unwrap();
    let (saved, shown) = (saved.fabric.unwrap(), window.editor().project().fabric().unwrap());
    assert_eq!(saved.stitches, shown.stitches);
    assert_eq!(
        *saved.simulated().unwrap(),
        window.editor().yarn().unwrap().state,
        "saved with the yarn as it is shown"
    );

    window.key(Modifiers::COMMAND, Key::Z);
    assert_eq!(window.purls(), 0);
    window.key(Modifiers::COMMAND | Modifiers::SHIFT, Key::Z);
    assert_eq!(window.purls(), row.len());
}

#[test]
fn painting_while_it_plays_keeps_it_playing() {
    // Garter stays flat: on a slow machine the yarn has not gone from under the pointer between two frames.
    let garter = Command::SetChart { chart: vec!["k".into(), "p".into()], rows: None, faces: None };
    let mut window = Window::new(garter.apply(&knitted()).unwrap());
    let purls_before = window.purls();
    window.press("Yarn");
    window.press("Front");
    window.press("Row");
    window.press("Paint");
    let fabric = window.editor().project().fabric().unwrap().clone();
    let state = fabric.state();
    let row = fabric.stitches.rows()[2].faces.clone();
    window.key(Modifiers::NONE, Key::Space);
    window.wait("playing", |e| e.yarn().is_some_and(|s| s.time_s > 0.01));
    // Where the stitch is by now; the camera still looks at where the yarn was laid.
    let now = window.editor().yarn().unwrap().state.position.clone();
    let nodes = fabric.net().nodes.iter().zip(&now).filter(|(n, _)| n.face == Some(row[2]));
    let nodes: Vec<DVec3> = nodes.map(|(_, p)| *p).collect();
    let middle = nodes.iter().sum::<DVec3>() / nodes.len() as f64;
    let at = window.on_screen(middle, state.position.iter().copied());
    window.click(at, Modifiers::NONE);
    assert_eq!(window.purls(), purls_before + row.len());
    window.wait("playing on", |e| e.yarn().is_some_and(|s| s.playing && s.time_s > 0.05));
    assert!(window.editor().yarn().unwrap().state.is_finite());
    window.keep("painted-while-playing");
}

#[test]
fn laying_anew_puts_the_yarn_back_and_undo_brings_it_again() {
    let mut window = Window::new(knitted());
    window.press("Yarn");
    let laid = window.editor().project().fabric().unwrap().net().laid_state().position;
    let moved = move |e: &Editor| {
        let now = &e.yarn().unwrap().state.position;
        laid.iter().zip(now).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max)
    };
    window.key(Modifiers::NONE, Key::Space);
    window.wait("moved", |e| e.yarn().is_some() && moved(e) > 1e-3);
    window.key(Modifiers::NONE, Key::Space);
    window.press("Lay anew");
    // The simulation stirs what it is given by a thousandth of a millimetre.
    window.wait("laid anew", |e| e.yarn().is_some() && moved(e) < 1e-5);
    window.key(Modifiers::COMMAND, Key::Z);
    window.wait("undone", |e| e.yarn().is_some() && moved(e) > 1e-3);
}

#[test]
fn what_cannot_be_done_is_said() {
    let mut window = Window::new(swatch());
    window.press("Save");
    window.harness.get_by_label("give the project a name first, in the field beside Save");
    assert!(window.harness.get_by_label("Yarn").accesskit_node().is_disabled());
    window.key(Modifiers::COMMAND, Key::Z);
    window.harness.get_by_label("Undo: there is nothing to undo");
}

#[test]
fn what_comes_with_the_program_is_begun_from_a_menu() {
    let mut window = Window::new(knitted());
    window.press("New");
    window.keep("bundled");
    window.press("cowl");
    let project = window.editor().project();
    assert_eq!(project.labelled.mesh().face_count(), 80);
    assert!(project.fabric().unwrap().stitches.rows().iter().all(|r| r.closed), "knitted, not only read");
    let path = window.harness.get_by_label("Path").accesskit_node().value();
    assert_eq!(path.as_deref(), Some("cowl.purl"), "where it will be saved");
}

#[test]
fn yarn_of_hidden_stitches_is_hidden() {
    let mut window = Window::new(knitted());
    window.press("Yarn");
    window.press("Front");
    window.wait("yarn", |e| e.yarn().is_some());
    let fabric = window.editor().project().fabric().unwrap().clone();
    let state = fabric.state();
    let row = fabric.stitches.rows()[2].faces.clone();
    let place = |face: FaceId| {
        let nodes = fabric.net().nodes.iter().zip(&state.position).filter(|(n, _)| n.face == Some(face));
        let nodes: Vec<DVec3> = nodes.map(|(_, p)| *p).collect();
        nodes.iter().sum::<DVec3>() / nodes.len() as f64
    };
    let at = window.on_screen(place(row[2]), state.position.iter().copied());
    window.press("Row");
    let before = window.keep("yarn");
    window.click(at, Modifiers::NONE);
    assert_eq!(window.selected().len(), row.len());
    window.key(Modifiers::NONE, Key::H);
    assert!(window.selected().is_empty());
    let hidden = window.keep("yarn-hidden");
    window.click(at, Modifiers::NONE);
    assert!(window.selected().is_empty(), "there is nothing to click");
    // Where the row was there is the ground, which changes little along a line.
    let ground = *hidden.get_pixel(at.x as u32, at.y as u32);
    let [bare, covered] = [&hidden, &before].map(|picture| {
        let across = (at.x as u32 - 150)..(at.x as u32 + 150);
        let near = |x: &u32| {
            let pixel = picture.get_pixel(*x, at.y as u32);
            (0..3).all(|i| pixel.0[i].abs_diff(ground.0[i]) < 12)
        };
        across.filter(near).count()
    });
    assert!(bare == 300 && covered < 200, "{bare} and {covered} of 300 pixels are bare");
    window.key(Modifiers::ALT, Key::H);
    assert!(!window.says("hidden)") && window.keep("yarn-again") == before);
}

#[test]
fn scissors_cut_the_yarn_in_front() {
    let mut window = Window::new(knitted());
    window.press("Yarn");
    window.press("Front");
    window.wait("yarn", |e| e.yarn().is_some());
    let fabric = window.editor().project().fabric().unwrap().clone();
    let state = fabric.state();
    let face = fabric.stitches.rows()[3].faces[4];
    let node = fabric.net().nodes.iter().position(|n| n.face == Some(face)).unwrap();
    let at = window.on_screen(state.position[node], state.position.iter().copied());
    window.key(Modifiers::SHIFT, Key::X);
    window.click(at, Modifiers::NONE);
    let after = window.editor().project().fabric().unwrap().clone();
    assert_eq!(after.net().yarns.len(), fabric.net().yarns.len() + 1);
    let [sim_core::Operation::Cut(visit)] = after.surgery.operations[..] else { panic!("one cut") };
    let ends = [Some(visit), fabric.net().next(visit)].map(|v| fabric.net().visits[v.unwrap().index()].node);
    let front = fabric.net().nodes[node].visits[0];
    assert!(ends.contains(&fabric.net().visits[front.index()].node), "at the node under the pointer");
    assert!([Some(visit), fabric.net().next(visit)].contains(&Some(front)), "of the yarn in front");
    window.keep("cut");
    let corner = window.viewport().min + egui::vec2(8.0, 8.0);
    window.click(corner, Modifiers::NONE);
    assert!(window.says("there is no yarn under the scissors"));
    window.key(Modifiers::COMMAND, Key::Z);
    assert_eq!(window.editor().project().fabric().unwrap().net().yarns.len(), fabric.net().yarns.len());
}
