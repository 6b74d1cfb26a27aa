//! The command search, the status bar, the history, the problems and the palette.

use app::command::Command;
use egui::{Key, Modifiers};
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use tests::window::{Window, fabric, knitted, swatch};

const NONE: Modifiers = Modifiers::NONE;

/// Writes into the text field that has the focus.
fn write(window: &mut Window, text: &str) {
    window.harness.event(egui::Event::Text(text.to_owned()));
    window.rest();
}

#[test]
fn the_search_finds_a_command_and_runs_it() {
    let (mut window, rows) = fabric();
    window.click_stitch(rows[1][1], None, NONE);
    window.key(NONE, Key::F3);
    assert!(window.harness.query_by_label("Label automatically").is_none(), "of another stage, so far down");
    write(&mut window, "Purl");
    window.keep("search");
    window.key(NONE, Key::Enter);
    assert_eq!(window.stitches(&[rows[1][1]]), ["p"]);
    window.key(NONE, Key::F3);
    write(&mut window, "select all");
    window.key(NONE, Key::Enter);
    assert_eq!(window.selected().len(), rows.concat().len());
    window.key(NONE, Key::F3);
    write(&mut window, "twisted count");
    window.key(NONE, Key::ArrowDown);
    window.key(NONE, Key::Enter);
    assert_eq!(window.stitches(&[rows[0][0]]), ["p-1"], "the second stitch of that name");
    window.key(NONE, Key::F3);
    write(&mut window, "knit");
    window.key(NONE, Key::Escape);
    assert_eq!(window.stitches(&[rows[0][0]]), ["p-1"], "closed without doing anything");
}

#[test]
fn keys_do_not_reach_the_fabric_while_one_writes() {
    let (mut window, rows) = fabric();
    window.click_stitch(rows[1][1], None, NONE);
    window.key(NONE, Key::F3);
    window.key(NONE, Key::P);
    window.key(NONE, Key::Escape);
    assert_eq!(window.purls(), 0);
    window.key(NONE, Key::P);
    assert_eq!(window.purls(), 1);
}

#[test]
fn the_status_bar_names_what_is_under_the_pointer() {
    let (mut window, rows) = fabric();
    let face = rows[2][3];
    window.harness.hover_at(window.at_stitch(face, None));
    window.rest();
    let wanted = format!("stitch {face}, knit (k), row 3, 4th of {}", rows[2].len());
    assert!(window.says(&wanted), "{wanted}");
    assert!(window.says("P purl"), "and the keys");
    window.key(NONE, Key::Num1);
    window.harness.hover_at(window.at_stitch(face, Some(0)));
    window.rest();
    assert!(window.says("course, "));
    assert!(!window.says("P purl"), "which acts on stitches only");
    window.keep("status");
}

#[test]
fn stages_change_under_the_pointer() {
    let (mut window, rows) = fabric();
    let last = rows.last().and_then(|r| r.last()).copied().unwrap_or(0);
    window.harness.hover_at(window.at_stitch(last, None));
    for (key, says) in
        [(Key::Num2, "edge "), (Key::Num4, "stitch "), (Key::Num1, "edge "), (Key::Num3, "stitch ")]
    {
        window.key(Modifiers::COMMAND, key);
        assert!(window.says(says), "the pointer is over a part of what is shown now: {says}");
    }
}

#[test]
fn a_click_in_the_history_goes_there() {
    let (mut window, rows) = fabric();
    window.click_stitch(rows[1][1], None, NONE);
    window.key(NONE, Key::P);
    window.click_stitch(rows[1][2], None, NONE);
    window.key(NONE, Key::P);
    window.click_stitch(rows[1][3], None, NONE);
    window.key(NONE, Key::T);
    assert_eq!((window.purls(), window.stitches(&[rows[1][3]])), (2, vec!["k1".to_owned()]));
    window.keep("history");
    window.press("Beginning");
    assert_eq!((window.purls(), window.stitches(&[rows[1][3]])), (0, vec!["k".to_owned()]));
    window.press("Set 1 stitch to k1");
    assert_eq!((window.purls(), window.stitches(&[rows[1][3]])), (2, vec!["k1".to_owned()]));
}

#[test]
fn a_click_on_a_problem_selects_and_frames_it() {
    let labelled = Command::Autolabel.apply(&swatch()).unwrap();
    let mesh = labelled.labelled.mesh();
    let edge = mesh.edge_ends(mesh.edge(mesh.first_half_edge(stitch_mesh::ids::FaceId(0)))).map(|v| v.0);
    let mut window =
        Window::new(Command::LabelEdges { edges: vec![edge], label: None }.apply(&labelled).unwrap());
    let before = window.keep("problem-before");
    let problem = window.editor().project().labelled.problems()[0].clone();
    assert!(window.says(&problem.what()), "what is wrong stands beside where it is");
    window.press(&format!("face {}", problem.face()));
    assert_eq!(window.selected(), [problem.face().0]);
    assert!(window.keep("problem") != before, "the view goes there");
}

#[test]
fn the_palette_sets_what_is_selected_or_is_painted_with() {
    let (mut window, rows) = fabric();
    window.click_stitch(rows[1][1], None, NONE);
    window.press("k-1 · knit twisted counter-clockwise");
    assert_eq!(window.stitches(&[rows[1][1]]), ["k-1"]);
    window.press("d12k · k2tog · knit two together, leaning right");
    assert!(window.says("d12k joins 2 loops below to 1 loop above"), "it says why not");
    window.key(NONE, Key::Escape);
    window.harness.remove_cursor();
    window.press("p1 · p tbl · purl through the back loop");
    let [from, to] = [window.at_stitch(rows[2][1], None), window.at_stitch(rows[2][2], None)];
    window.drag(from, to, NONE);
    assert_eq!(window.stitches(&rows[2][1..3]), ["p1", "p1"]);
}

#[test]
fn patterns_come_by_number() {
    let (mut window, rows) = fabric();
    window.press("Rib");
    let row: String = window.stitches(&rows[1]).concat();
    assert!("kkppkkppkkppkkpp".starts_with(&row), "{row}");
    window.press("Moss");
    let row: String = window.stitches(&rows[1]).concat();
    assert!("pkpkpkpkpkpkpkpk".starts_with(&row), "{row}");
}

#[test]
fn every_control_has_a_name_for_screen_readers() {
    let mut window = Window::new(knitted());
    for tab in ["Mesh", "Labels", "Stitches", "Yarn"] {
        window.press(tab);
        window.harness.check_accessibility();
    }
    window.key(NONE, Key::F3);
    window.harness.check_accessibility();
    assert!(!window.harness.get_by_label("Search commands").accesskit_node().is_disabled());
}
