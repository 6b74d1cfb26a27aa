//! One document after another in the same window.

#![allow(clippy::unwrap_used, reason = "helpers of tests are tests, which clippy cannot see")]

use app::drawing::Stage;
use app::project::Project;
use app::window::editor::Editor;
use egui::{Key, Modifiers};
use egui_kittest::kittest::Queryable as _;
use std::path::{Path, PathBuf};
use stitch_mesh::ids::FaceId;
use stitch_mesh::stitch::Stitch;
use tests::window::{Window, fabric};

/// Begins with a mesh that comes with the program.
fn begin(window: &mut Window, name: &str) {
    window.press("New");
    window.press(name);
}

/// Writes a path into its field, and presses a key there.
fn type_path(window: &mut Window, path: &Path, end: Key) {
    window.harness.get_by_label("Path").focus();
    window.harness.step();
    window.key(Modifiers::COMMAND, Key::A);
    window.harness.get_by_label("Path").type_text(path.to_str().unwrap());
    window.key(Modifiers::NONE, end);
}

/// Opens a file by its path.
fn open(window: &mut Window, path: &Path) {
    type_path(window, path, Key::Enter);
}

fn faces(editor: &Editor) -> usize {
    editor.project().fabric().map_or(0, |f| f.stitches.mesh().face_count())
}

/// Whether there is new yarn, and a stitch of it is where the pointer can find it.
fn shows_its_yarn(editor: &Editor) -> bool {
    let net = editor.project().fabric().unwrap().net();
    editor.yarn().is_some_and(|s| s.state.position.len() == net.nodes.len())
}

#[test]
fn less_fabric_takes_the_place_of_more_in_the_yarn_view() {
    let (mut window, _) = fabric();
    begin(&mut window, "cowl");
    window.wait("the cowl's yarn", shows_its_yarn);
    let many = faces(window.editor());
    begin(&mut window, "swatch");
    window.wait("the swatch's yarn", shows_its_yarn);
    assert!(faces(window.editor()) < many);
    window.keep("less-fabric");
    // All of it is in the picture, and can be pointed at.
    let count = faces(window.editor());
    window.press("Front");
    window.click_stitch(count as u32 / 2, None, Modifiers::NONE);
    assert_eq!(window.selected().len(), 1);
}

#[test]
fn work_that_has_not_been_saved_is_asked_about() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("mine.purl");
    let (mut window, rows) = fabric();
    begin(&mut window, "swatch");
    assert!(!window.says("Save what was done"), "nothing was done to it");
    window.press("Stitches");
    window.press("Front");
    window.click_stitch(rows[0][0], None, Modifiers::NONE);
    window.key(Modifiers::NONE, Key::P);
    let purls = window.purls();
    assert!(purls > 0);
    begin(&mut window, "cowl");
    window.keep("leaving");
    assert!(window.says("Save what was done to swatch.purl first?"));
    window.press("Stay");
    assert_eq!(window.purls(), purls);
    // Save, and go on.
    type_path(&mut window, &path, Key::Escape);
    begin(&mut window, "cowl");
    window.press("Save and go on");
    window
        .wait("the cowl", |e| faces(e) > 0 && e.project().fabric().unwrap().stitches.stitches().len() > 500);
    assert_eq!(window.purls(), 0);
    assert!(path.is_file());
    // Without saving.
    window.key(Modifiers::NONE, Key::A);
    window.key(Modifiers::NONE, Key::P);
    assert!(window.purls() > 0);
    window.harness.state_mut().close();
    window.rest();
    assert!(!window.editor().is_closed());
    window.press("Go on without");
    assert!(window.editor().is_closed());
}

/// A small fabric in a file.
fn file(folder: &Path, name: &str) -> PathBuf {
    let path = folder.join(name);
    tests::window::knitted().save(&path).unwrap();
    path
}

#[test]
fn saving_before_another_file_is_opened_leaves_that_file_alone() {
    let folder = tempfile::tempdir().unwrap();
    let [mine, other] = ["mine.purl", "other.purl"].map(|name| file(folder.path(), name));
    let before = std::fs::read(&other).unwrap();
    let (mut window, rows) = fabric();
    open(&mut window, &mine);
    window.rest();
    window.press("Stitches");
    window.press("Front");
    window.click_stitch(rows[0][0], None, Modifiers::NONE);
    window.key(Modifiers::NONE, Key::P);
    open(&mut window, &other);
    assert!(window.says("Save what was done to mine.purl first?") && window.says("mine.purl."));
    // The keys belong to the question.
    window.key(Modifiers::NONE, Key::T);
    assert_eq!(window.stitches(&rows[0][..1]), ["p"]);
    window.key(Modifiers::NONE, Key::Escape);
    assert!(!window.says("Save what was done"), "Escape stays");
    open(&mut window, &other);
    window.press("Save and go on");
    window.wait("the other file", |e| {
        e.project().fabric().unwrap().stitches.stitch(FaceId(0)) == &Stitch::knit()
    });
    assert_eq!(std::fs::read(&other).unwrap(), before, "opened, not written");
    let saved = Project::open(&mine).unwrap();
    assert_eq!(saved.fabric().unwrap().stitches.stitch(FaceId(rows[0][0])), &Stitch::purl());
}

#[test]
fn another_file_is_not_replaced_without_asking() {
    let folder = tempfile::tempdir().unwrap();
    let path = file(folder.path(), "kept.purl");
    let before = std::fs::read(&path).unwrap();
    let (mut window, rows) = fabric();
    window.press("Stitches");
    window.press("Front");
    window.click_stitch(rows[0][0], None, Modifiers::NONE);
    window.key(Modifiers::NONE, Key::P);
    type_path(&mut window, &path, Key::Escape);
    window.press("Save");
    window.keep("replacing");
    window.press("Keep it");
    assert_eq!(std::fs::read(&path).unwrap(), before);
    window.press("Save");
    window.press("Replace");
    let after = std::fs::read(&path).unwrap();
    assert!(after != before);
    // From now on it is this document's.
    window.key(Modifiers::NONE, Key::T);
    window.key(Modifiers::COMMAND, Key::S);
    assert!(!window.says("Replace"));
    let after = std::fs::read(&path).unwrap();
    // To the next document it is a stranger's again.
    begin(&mut window, "swatch");
    type_path(&mut window, &path, Key::Escape);
    window.press("Save");
    assert!(window.says("Replace"));
    window.key(Modifiers::NONE, Key::Escape);
    assert_eq!(std::fs::read(&path).unwrap(), after);
}

#[test]
fn what_cannot_be_saved_is_not_left() {
    let (mut window, rows) = fabric();
    begin(&mut window, "swatch");
    window.press("Stitches");
    window.press("Front");
    window.click_stitch(rows[0][0], None, Modifiers::NONE);
    window.key(Modifiers::NONE, Key::P);
    type_path(&mut window, "/no/such/folder/mine.purl".as_ref(), Key::Escape);
    begin(&mut window, "cowl");
    window.press("Save and go on");
    window.rest();
    assert!(window.purls() > 0, "still here");
    assert!(window.says("/no/such/folder"), "and why");
}

#[test]
fn a_mesh_opens_where_its_labels_are() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("square.obj");
    // Two quadrilaterals and a triangle.
    let text =
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 0\nv 2 1 0\nv 3 0 0\nf 1 2 3 4\nf 2 5 6 3\nf 5 7 6\n";
    std::fs::write(&path, text).unwrap();
    let (mut window, _) = fabric();
    open(&mut window, &path);
    window.wait("the mesh", |e| e.project().labelled.mesh().face_count() == 3);
    window.rest();
    assert_eq!(window.editor().stage(), Stage::Labels);
    window.keep("opened-mesh");
}

#[test]
fn painting_shows_stitches_again_after_relaxing() {
    let (mut window, rows) = fabric();
    window.press("Stitches");
    window.press("Front");
    window.press("Finish");
    window.press("Relax mesh");
    window.wait("relaxed", Editor::is_idle);
    let strained = window.keep("relaxed");
    window.click_stitch(rows[0][0], None, Modifiers::NONE);
    window.key(Modifiers::NONE, Key::P);
    let painted = window.keep("painted-after-relaxing");
    // More than one stitch has another colour now.
    let other = strained.pixels().zip(painted.pixels()).filter(|(a, b)| a != b).count();
    assert!(other > strained.pixels().len() / 20, "{other} pixels");
}
