//! Written patterns through the program: swatches, tiling, instructions.

#![allow(clippy::unwrap_used, reason = "helpers of tests are tests, which clippy cannot see")]

use serde_json::json;
use tests::{Program, asset, root, skip};

fn program() -> Program {
    Program::new(env!("CARGO_BIN_EXE_purlwise-tested"))
}

const EYELETS: &str = "# Eyelets\nRow 1 (RS): K1, *yo, k2tog, repeat from * to last st, k1.\nRow 2: Purl.\n";

#[test]
fn a_swatch_has_the_figures_that_its_text_says() {
    let program = program();
    program.write("eyelets.ks", EYELETS);
    let facts = program.json(&["swatch", "eyelets.ks", "-o", "a.purl"]);
    assert_eq!(facts, json!({"cast_on": 6, "rows": 2, "most_stitches": 6, "warnings": []}));
    let wide = program.json(&["swatch", "eyelets.ks", "-o", "b.purl", "--repeats", "5x3"]);
    assert_eq!((&wide["cast_on"], &wide["rows"]), (&json!(12), &json!(6)));
    let cast = program.json(&["swatch", "eyelets.ks", "-o", "c.purl", "--cast-on", "20"]);
    assert_eq!(cast["cast_on"], 20);
    let inspected = program.json(&["inspect", "c.purl"]);
    assert_eq!((&inspected["loops"], &inspected["yarns"]["open"]), (&json!(40), &json!(1)));
    assert_eq!(inspected["problems"], json!([]));
}

#[test]
fn a_folder_of_patterns_is_knitted_with_a_report() {
    let program = program();
    let library = root().join("assets/patterns").display().to_string();
    let report = program.json(&["swatch", &library, "-o", "all"]);
    let count = std::fs::read_dir(&library).unwrap().count();
    assert_eq!((report["patterns"].as_array().unwrap().len(), &report["failed"]), (count, &json!(0)));
    assert!(program.path("all/feather-and-fan.purl").exists());

    std::fs::create_dir(program.path("mixed")).unwrap();
    program.write("mixed/good.ks", EYELETS);
    program.write("mixed/bad.ks", "Row 1: K2, k3 tog of them.");
    let run = program.run(&["swatch", "mixed", "-o", "out", "--json"]);
    assert_eq!(run.status, Some(1));
    assert!(run.stdout.contains("\"failed\":1") && run.stderr.contains("1 of 2 patterns"), "{run:?}");
    assert!(program.path("out/good.purl").exists() && !program.path("out/bad.purl").exists());
}

#[test]
fn the_patterns_beside_the_repository_come_out_as_they_say() {
    let folder = root().join("../shared/patterns");
    if !folder.exists() {
        return skip("there are no patterns beside the repository");
    }
    let program = program();
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let text = std::fs::read_to_string(&path).unwrap();
        let facts = program.json(&["swatch", path.to_str().unwrap(), "-o", "x.purl"]);
        let said = format!(
            "# check: cast on {}, rows {}, most stitches {}",
            facts["cast_on"], facts["rows"], facts["most_stitches"]
        );
        assert!(text.lines().any(|line| line.starts_with(&said)), "{}: {facts}", path.display());
        // A line further on, the same once more: what is written for the swatch is knitted into the same swatch.
        program.json(&["instructions", "x.purl", "-o", "again.ks"]);
        program.json(&["swatch", "again.ks", "-o", "y.purl"]);
        let [first, again] = ["x.purl", "y.purl"].map(|file| program.json(&["inspect", file]));
        assert_eq!(first["stitches"], again["stitches"], "{}", path.display());
        assert_eq!((&first["loops"], &first["cable_edges"]), (&again["loops"], &again["cable_edges"]));
    }
}

#[test]
fn a_pattern_is_tiled_over_a_garment() {
    let program = program();
    let library = |name: &str| root().join(format!("assets/patterns/{name}.ks")).display().to_string();
    program.json(&["new", &asset("hat"), "-o", "hat.purl"]);
    let cables = program.json(&["tile", "hat.purl", &library("braid-cables"), "-o", "braids.purl"]);
    assert!(cables["cable_edges"].as_u64() > Some(40) && cables["covered"].as_u64() > Some(900), "{cables}");
    assert_eq!(cables["problems"], json!([]));
    program.json(&["new", &asset("pullover"), "-o", "pullover.purl"]);
    let lace = program.json(&["tile", "pullover.purl", &library("mrs-montagues-pattern"), "-o", "lace.purl"]);
    assert!(lace["covered"].as_u64() > Some(2000), "{lace}");
    assert_eq!(lace["problems"], json!([]));
    let some = program.json(&[
        "tile",
        "pullover.purl",
        &library("2x2-rib"),
        "-o",
        "some.purl",
        "--rows",
        "10..13",
        "--layout",
        "mirrored",
    ]);
    assert!(some["covered"].as_u64() < Some(500));
    let script =
        json!({"do": "tile", "text": "Row 1: *K1, p1, repeat from *.", "rows": [10, 11]}).to_string();
    program.write("tile.jsonl", script + "\n");
    let edited = program.json(&["edit", "pullover.purl", "tile.jsonl", "-o", "edited.purl"]);
    assert!(edited["stitches"]["p"].as_u64() > Some(80), "{edited}");
}

#[test]
fn what_cannot_be_done_is_one_line() {
    let program = program();
    let fails = |arguments: &[&str], says: &str| {
        let run = program.run(arguments);
        assert_eq!((run.status, run.stderr.lines().count()), (Some(1), 1), "{arguments:?}: {}", run.stderr);
        assert!(run.stderr.contains(says), "{arguments:?}: {}", run.stderr);
    };
    program.write("short.ks", "Row 1 (RS): K4.\nRow 2: P5.\n");
    fails(&["swatch", "short.ks", "-o", "x.purl"], "short.ks: line 2, column 1, row 2");
    program.write("bobble.ks", "Row 1 (RS): K2, MB, k2.\n");
    fails(&["swatch", "bobble.ks", "-o", "x.purl"], "line 1, column 17, row 1: 'MB' cannot be held");
    program.write("eyelets.ks", EYELETS);
    program.json(&["swatch", "eyelets.ks", "-o", "a.purl"]);
    fails(&["tile", "a.purl", "missing.ks", "-o", "x.purl"], "missing.ks");
    program.write("wide.ks", "Row 1 (RS): *K20, p20, repeat from *. Row 2: *K20, p20, repeat from *.");
    fails(&["tile", "a.purl", "wide.ks", "-o", "x.purl"], "needs 40 stitches side by side and 2 rows");
    fails(&["tile", "a.purl", "eyelets.ks", "-o", "x.purl", "--rows", "1..9"], "there are no rows 1–9");
    program.json(&["new", &asset("pullover"), "-o", "p.purl"]);
    fails(&["instructions", "p.purl"], "stitch ");
    assert!(!program.path("x.purl").exists(), "nothing was written");
}
