//! Selecting in the window, and what the keys do with what is selected.

use app::command::Command;
use egui::{Key, Modifiers};
use std::collections::BTreeSet;
use stitch_mesh::ids::FaceId;
use tests::window::{Window, fabric, swatch};

const NONE: Modifiers = Modifiers::NONE;

fn sorted(faces: impl IntoIterator<Item = u32>) -> Vec<u32> {
    faces.into_iter().collect::<BTreeSet<_>>().into_iter().collect()
}

#[test]
fn clicks_select_shift_adds_and_ctrl_removes() {
    let (mut window, rows) = fabric();
    let [a, b] = [rows[1][1], rows[2][3]];
    window.click_stitch(a, None, NONE);
    assert_eq!(window.selected(), [a]);
    let before = window.keep("selected-one");
    window.click_stitch(b, None, Modifiers::SHIFT);
    assert_eq!(window.selected(), sorted([a, b]));
    let after = window.keep("selected-two");
    assert!(before != after, "what is selected shows");
    window.click_stitch(a, None, Modifiers::COMMAND);
    assert_eq!(window.selected(), [b]);
    window.click_stitch(a, None, NONE);
    assert_eq!(window.selected(), [a]);
    window.key(NONE, Key::Escape);
    assert_eq!(window.selected(), [0u32; 0]);
}

#[test]
fn alt_click_takes_the_row_or_the_column() {
    let (mut window, rows) = fabric();
    let face = rows[2][3];
    // Sides: 1 is the right wale edge, across which the row goes on; 2 a course edge, across which the column does.
    window.click_stitch(face, Some(1), Modifiers::ALT);
    assert_eq!(window.selected(), sorted(rows[2].clone()));
    window.click_stitch(face, Some(2), Modifiers::ALT);
    assert_eq!(window.selected(), sorted(rows.iter().map(|r| r[3])));
    window.key(NONE, Key::Num3);
    assert_eq!(window.selected().len(), rows.concat().len(), "each stitch of the column grew to its row");
    window.click_stitch(face, Some(2), NONE);
    assert_eq!(window.selected(), sorted(rows[2].clone()), "in mode Row a click takes the row");
}

#[test]
fn edges_are_selected_one_by_one_and_in_lines() {
    let (mut window, rows) = fabric();
    window.key(NONE, Key::Num1);
    window.click_stitch(rows[1][2], Some(0), NONE);
    let edges = |window: &Window| window.editor().selection().edges.len();
    assert_eq!((edges(&window), window.selected().len()), (1, 0));
    window.click_stitch(rows[1][2], Some(0), Modifiers::ALT);
    assert_eq!(edges(&window), rows[1].len(), "the course line along the row");
    window.click_stitch(rows[1][2], Some(1), Modifiers::ALT);
    assert_eq!(edges(&window), rows.len(), "the wale line up the column");
    window.keep("selected-edges");
}

#[test]
fn a_box_takes_what_it_covers_and_a_key_makes_it_purl() {
    let (mut window, rows) = fabric();
    window.key(NONE, Key::B);
    let [from, to] = [window.at_stitch(rows[1][1], Some(0)), window.at_stitch(rows[3][4], Some(2))];
    window.drag(from, to + egui::vec2(4.0, 0.0), NONE);
    let covered = sorted((1..=3).flat_map(|r| rows[r][1..=4].to_vec()));
    assert_eq!(window.selected(), covered);
    window.keep("box");
    window.key(NONE, Key::P);
    assert_eq!(window.purls(), covered.len());
    assert!(window.stitches(&covered).iter().all(|s| s == "p"));
    window.key(NONE, Key::T);
    assert!(window.stitches(&covered).iter().all(|s| s == "p1"));
    window.key(NONE, Key::T);
    assert!(window.stitches(&covered).iter().all(|s| s == "p-1"));
    window.key(NONE, Key::T);
    window.key(NONE, Key::K);
    assert_eq!((window.purls(), window.selected()), (0, covered), "what is selected stays so");
}

#[test]
fn twisting_unlike_stitches_is_one_step() {
    let (mut window, rows) = fabric();
    let pair = [rows[1][1], rows[1][2]];
    window.click_stitch(pair[0], None, NONE);
    window.key(NONE, Key::P);
    window.click_stitch(pair[1], None, Modifiers::SHIFT);
    window.key(NONE, Key::T);
    assert_eq!(window.stitches(&pair), ["p1", "k1"]);
    window.key(Modifiers::COMMAND, Key::Z);
    assert_eq!(window.stitches(&pair), ["p", "k"]);
    window.key(Modifiers::COMMAND | Modifiers::SHIFT, Key::Z);
    assert_eq!(window.stitches(&pair), ["p1", "k1"]);
}

#[test]
fn a_brush_selects_along_its_way() {
    let (mut window, rows) = fabric();
    window.key(NONE, Key::C);
    let [from, to] = [window.at_stitch(rows[2][1], None), window.at_stitch(rows[2][4], None)];
    window.drag(from, to, NONE);
    let selected = window.selected();
    assert!(selected.contains(&rows[2][1]) && selected.contains(&rows[2][4]), "{selected:?}");
    let all = selected.len();
    window.drag(from, from + egui::vec2(2.0, 0.0), Modifiers::COMMAND);
    assert!(window.selected().len() < all && !window.selected().contains(&rows[2][1]));
}

#[test]
fn all_none_linked_and_hidden() {
    let (mut window, rows) = fabric();
    let count = rows.concat().len();
    window.key(NONE, Key::A);
    assert_eq!(window.selected().len(), count);
    window.key(Modifiers::ALT, Key::A);
    assert_eq!(window.selected().len(), 0);
    window.harness.hover_at(window.at_stitch(rows[1][1], None));
    window.key(NONE, Key::L);
    assert_eq!(window.selected().len(), count, "the piece under the pointer");
    let shown = window.keep("before-hiding");
    window.click_stitch(rows[1][1], None, NONE);
    window.key(NONE, Key::H);
    assert_eq!(window.selected().len(), 0);
    assert!(window.keep("hidden") != shown);
    window.key(NONE, Key::A);
    assert_eq!(window.selected().len(), count - 1, "what is hidden is left out");
    let at = window.at_stitch(rows[1][1], None);
    window.click(at, NONE);
    assert_eq!(window.selected().len(), 0, "there is nothing to click");
    window.key(Modifiers::ALT, Key::H);
    window.click(at, NONE);
    assert_eq!(window.selected(), [rows[1][1]]);
}

#[test]
fn keys_label_what_is_selected() {
    let mut window = Window::new(swatch());
    window.press("Front");
    let label = |window: &Window, text: &str| window.says(text);
    window.click_side(0, 1, NONE);
    assert!(label(&window, "no label"));
    window.key(NONE, Key::W);
    assert!(label(&window, ", wale,"));
    window.key(NONE, Key::C);
    assert!(label(&window, ", course,"), "C labels here, and is a brush elsewhere");
    window.click_side(0, 0, Modifiers::ALT);
    let line = window.editor().selection().edges.len();
    assert!(line > 1, "straight on along the border");
    window.key(NONE, Key::W);
    let labels = window.editor().project().labelled.labels().iter().flatten().count();
    assert_eq!(labels, line + 1);
    window.key(Modifiers::COMMAND, Key::Z);
    let labels = window.editor().project().labelled.labels().iter().flatten().count();
    assert_eq!(labels, 1, "one step");
}

#[test]
fn flipping_turns_the_row_under_the_pointer() {
    let labelled = Command::Autolabel.apply(&swatch()).unwrap();
    let mut window = Window::new(labelled);
    window.press("Front");
    let wales = |window: &Window| window.editor().project().labelled.wales(FaceId(0));
    let before = wales(&window);
    let mesh = window.editor().project().labelled.mesh();
    window.harness.hover_at(window.at_face(mesh, 0, None));
    window.key(NONE, Key::F);
    assert!(wales(&window).is_some() && wales(&window) != before);
}

#[test]
fn selecting_is_no_step_and_survives_edits() {
    let (mut window, rows) = fabric();
    window.click_stitch(rows[1][1], None, NONE);
    window.key(NONE, Key::P);
    window.key(Modifiers::COMMAND, Key::Z);
    assert_eq!(window.purls(), 0);
    assert_eq!(window.selected(), [rows[1][1]]);
    window.key(Modifiers::COMMAND, Key::Z);
    assert!(window.says("there is nothing to undo"), "selecting was not a step");
}

#[test]
fn the_maya_preset_leaves_alt_to_the_camera() {
    let (mut window, rows) = fabric();
    window.press("⚙ Settings");
    window.press("Alt (Maya)");
    window.key(NONE, Key::Escape);
    window.press("Front");
    let face = rows[2][3];
    window.click_stitch(face, Some(1), Modifiers::ALT);
    assert_eq!(window.selected().len(), 0);
    let (before, at) = (window.keep("maya-before"), window.at_stitch(face, Some(1)));
    window.drag(at, at + egui::vec2(60.0, 0.0), Modifiers::ALT);
    assert!(window.keep("maya-turned") != before, "Alt with the left button turns the view");
    assert_eq!(window.selected().len(), 0, "and selects nothing");
    window.press("Front");
    window.double_click(at);
    assert_eq!(window.selected(), sorted(rows[2].clone()), "a double click takes the loop");
}

#[test]
fn an_edge_on_the_border_is_hit_from_outside() {
    let (mut window, rows) = fabric();
    window.key(NONE, Key::Num1);
    let [inside, middle] = [Some(0), None].map(|side| window.at_stitch(rows[0][3], side));
    // The first lies four fifths of the way from the middle to the edge.
    let out = (inside - middle).normalized();
    let edge = middle + (inside - middle) * 1.25;
    window.click(edge + out * 4.0, NONE);
    assert_eq!(window.editor().selection().edges.len(), 1);
    window.click(edge + out * 20.0, NONE);
    assert_eq!(window.editor().selection().edges.len(), 0);
    window.key(NONE, Key::Num2);
    window.click(edge + out * 4.0, NONE);
    assert!(window.selected().is_empty(), "a stitch is hit where it is");
}
