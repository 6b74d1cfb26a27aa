//! A panel as an artist would make it, command by command, and the figures that it has to come to.

#![allow(clippy::unwrap_used, reason = "helpers of tests are tests, which clippy cannot see")]

use app::command::read_script;
use app::document::Document;
use app::project::Project;
use serde_json::json;
use tests::{PANEL, Program, asset};

/// The program, with the swatch without labels as `bare.purl` in its folder.
fn program() -> Program {
    let program = Program::new(env!("CARGO_BIN_EXE_purlwise-tested"));
    program.write("clear.jsonl", "{\"do\":\"clear_labels\"}\n");
    program.json(&["new", &asset("swatch"), "-o", "bare.purl", "--script", "clear.jsonl"]);
    program.write("panel.jsonl", PANEL);
    program
}

#[test]
fn a_scripted_session_knits_a_panel() {
    let program = program();
    let facts = program.json(&["edit", "bare.purl", "panel.jsonl", "-o", "panel.purl"]);
    // 18 columns by 20 rows; a stitch less on both sides in the last row and where the corners decrease before it (−4); a
    // column more for one row (+1); five pairs worked together (−5).
    assert_eq!((&facts["faces"], &facts["rows"]), (&json!(18 * 20 - 4 + 1 - 5), &json!(20)));
    // Purls: eight columns of the hem, half the moss, two of the patch, and the columns beside the cables.
    let purls = 4 * 8 + 6 + 2 + 24;
    let stitches = json!({"d12k": 3, "k": 352 - purls - 6, "k-1": 1, "k1": 1, "kp": 1, "p": purls});
    assert_eq!(facts["stitches"], stitches);
    assert_eq!(facts["loops"], 353, "every stitch makes one, the increase two");
    assert_eq!(facts["cable_edges"], 8);
    assert_eq!(facts["yarns"], json!({"open": 1, "closed": 0}));
    assert_eq!(facts["problems"], json!([]));
    assert_eq!(program.json(&["inspect", "panel.purl"]), facts);
}

#[test]
fn the_session_leads_back_to_the_bare_mesh() {
    let program = program();
    let saved = |project: &Project, name: &str| {
        project.save(&program.path(name)).unwrap();
        program.read(name)
    };
    let mut document = Document::new(Project::open(&program.path("bare.purl")).unwrap());
    let bare = saved(document.project(), "a.purl");
    for (_, command) in read_script(PANEL).unwrap() {
        document.apply(command).unwrap();
    }
    let panel = saved(document.project(), "a.purl");
    while document.undo() {}
    assert!(saved(document.project(), "a.purl") == bare);
    while document.redo() {}
    assert!(saved(document.project(), "a.purl") == panel);
    program.json(&["edit", "bare.purl", "panel.jsonl", "-o", "panel.purl"]);
    assert!(program.read("panel.purl") == panel);
}
