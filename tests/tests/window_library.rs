//! The pattern library in the window.

#![allow(clippy::unwrap_used, reason = "helpers of tests are tests, which clippy cannot see")]

use egui::{Key, Modifiers};
use egui_kittest::kittest::Queryable as _;
use tests::window::fabric;

#[test]
fn a_pattern_is_found_and_tiled_over_the_selection() {
    let (mut window, rows) = fabric();
    window.press("Library");
    window.harness.get_by_label("Find a pattern").focus();
    window.harness.step();
    window.harness.get_by_label("Find a pattern").type_text("2x2 rib");
    window.rest();
    window.keep("library");
    let below = window.stitches(&rows[0]);
    window.key(Modifiers::NONE, Key::Escape);
    for (i, row) in rows[1..4].iter().enumerate() {
        let modifiers = if i == 0 { Modifiers::ALT } else { Modifiers::ALT | Modifiers::SHIFT };
        window.click_stitch(row[2], Some(1), modifiers);
    }
    assert!(window.selected().len() >= 3 * rows[1].len() - 3);
    window.press("Tile");
    assert!(window.purls() >= rows[1].len(), "{} purls", window.purls());
    assert_eq!(window.stitches(&rows[0]), below, "outside of the selection nothing has changed");
    assert!(window.says("Tile 2x2"), "in the history");
    window.key(Modifiers::COMMAND, Key::Z);
    assert_eq!(window.purls(), 0);
}

#[test]
fn a_swatch_takes_the_place_of_everything() {
    let (mut window, _) = fabric();
    window.press("Library");
    window.harness.get_by_label("Find a pattern").focus();
    window.harness.step();
    window.harness.get_by_label("Find a pattern").type_text("feather fan");
    window.rest();
    let buttons: Vec<_> = window.harness.get_all_by_label("Swatch").collect();
    buttons[0].click();
    window.rest();
    let fabric = window.editor().project().fabric().map(|f| f.stitches.loop_count());
    assert_eq!(fabric.ok(), Some(36 * 4));
    window.press("Front");
    window.keep("library-swatch");
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("fan.purl");
    window.harness.get_by_label("Path").focus();
    window.harness.step();
    window.harness.get_by_label("Path").type_text(path.to_str().unwrap());
    window.rest();
    window.press("Save instructions");
    let told = std::fs::read_to_string(path.with_extension("ks")).unwrap();
    assert!(told.starts_with("# Cast on 36 stitches.") && told.contains("[yo, k1]"), "{told}");
    window.key(Modifiers::NONE, Key::Escape);
    window.key(Modifiers::COMMAND, Key::Z);
    assert!(window.editor().project().labelled.mesh().face_count() < 100, "back at the mesh");
}
