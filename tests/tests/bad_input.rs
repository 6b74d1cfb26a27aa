//! Bad input: one clear line, the right exit status, and whatever was there before is still there.

#![allow(clippy::unwrap_used, clippy::panic, reason = "helpers of tests are tests, which clippy cannot see")]

use tests::{Program, asset};

/// The program, with a good project `good.purl` in its folder.
fn program() -> Program {
    let program = Program::new(env!("CARGO_BIN_EXE_purlwise-tested"));
    program.json(&["new", &asset("swatch"), "-o", "good.purl", "--stitch-size", "25"]);
    program
}

/// Runs something that has to fail with status 1 and one line on standard error that contains all of `says`.
fn fails(program: &Program, arguments: &[&str], says: &[&str]) {
    let run = program.run(arguments);
    assert_eq!(run.status, Some(1), "{arguments:?}: {run:?}");
    assert_eq!(run.stdout, "", "{arguments:?}");
    assert!(run.stderr.starts_with("purlwise: ") && run.stderr.ends_with('\n'), "{run:?}");
    assert_eq!(run.stderr.lines().count(), 1, "{}", run.stderr);
    for part in says {
        assert!(run.stderr.contains(part), "{arguments:?} does not say '{part}': {}", run.stderr);
    }
}

#[test]
fn broken_meshes_are_named_with_the_place_and_overwrite_nothing() {
    let square = b"v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 0 0 -1\n";
    let faces = |faces: &[u8]| [square, faces].concat();
    let cases: [(&str, Vec<u8>, &str); 9] = [
        ("empty.obj", vec![], "no faces"),
        ("binary.obj", vec![0x7f, b'E', b'L', b'F', 0, 0xff, 0xfe], "is not text"),
        ("image.obj", vec![0x89, b'P', b'N', b'G'], "byte 0"),
        ("fins.obj", faces(b"f 1 2 3\nf 2 1 5\nf 1 2 6\n"), "edge 0–1"),
        ("nan.obj", b"v 0 0 0\nv 1 NaN 0\nv 1 1 0\nf 1 2 3\n".to_vec(), "line 2"),
        ("inf.obj", b"v 0 0 0\nv 1 1e999 0\nv 1 1 0\nf 1 2 3\n".to_vec(), "line 2"),
        ("line.obj", faces(b"f 1 2 3 4\nf 1 2\n"), "line 8"),
        ("missing.obj", faces(b"f 1 2 77\n"), "face 0 names vertex 76"),
        ("flipped.obj", faces(b"f 1 2 3\nf 1 2 4\n"), "face 1 is flipped"),
    ];
    let program = program();
    let before = program.read("good.purl");
    for (name, bytes, place) in &cases {
        program.write(name, bytes);
        fails(&program, &["new", name, "-o", "good.purl"], &[name, place]);
        fails(&program, &["new", name, "-o", "none.purl"], &[name, place]);
    }
    fails(&program, &["new", "nowhere.obj", "-o", "good.purl"], &["nowhere.obj", "No such file"]);
    assert_eq!(program.read("good.purl"), before);
    assert!(!program.path("none.purl").exists());
}

#[test]
fn broken_projects_are_named_with_the_place_and_overwrite_nothing() {
    let program = program();
    let before = program.read("good.purl");
    let text = String::from_utf8(before.clone()).unwrap();
    program.write("cut.purl", &before[..before.len() / 2]);
    program.write("newer.purl", text.replacen("\"purlwise\":1", "\"purlwise\":99", 1));
    program.write("not-finite.purl", text.replacen("\"positions\":[[", "\"positions\":[[1e999,", 1));
    program.write("empty.purl", "");
    let cases = [
        ("cut.purl", "line 1 column"),
        ("newer.purl", "newer Purlwise"),
        ("not-finite.purl", "line 1 column"),
        ("empty.purl", "line 1 column"),
        ("nowhere.purl", "No such file"),
    ];
    program.json(&["export", "good.purl", "-o", "yarn.obj"]);
    let yarn = program.read("yarn.obj");
    for (name, place) in cases {
        fails(&program, &["inspect", name], &[name, place]);
        fails(&program, &["relax", name, "-o", "good.purl"], &[name, place]);
        fails(&program, &["simulate", name, "-o", "good.purl"], &[name, place]);
        fails(&program, &["export", name, "-o", "yarn.obj"], &[name, place]);
        fails(&program, &["render", name, "-o", "yarn.obj"], &[name, place]);
    }
    assert_eq!((program.read("good.purl"), program.read("yarn.obj")), (before, yarn));
}

#[test]
fn broken_scripts_are_named_with_the_line() {
    let program = program();
    let before = program.read("good.purl");
    let cases = [
        ("{\"do\":\"autolabel\"}\n{\"do\":\"dance\"}\n", "line 2"),
        ("# a remark\n\nknit\n", "line 3"),
        ("\n{\"do\":\"set_stitch\",\"faces\":[9999],\"stitch\":\"p\"}\n", "line 2: there is no face 9999"),
        ("{\"do\":\"fill_from_border\",\"edge\":[0,9999]}\n", "line 1: there is no edge 0–9999"),
        ("{\"do\":\"set_chart\",\"chart\":[\"k q\"]}\n", "line 1"),
    ];
    for (script, place) in cases {
        program.write("script.jsonl", script);
        fails(&program, &["edit", "good.purl", "script.jsonl", "-o", "good.purl"], &["script.jsonl", place]);
    }
    assert_eq!(program.read("good.purl"), before);
}

#[test]
fn a_mesh_without_labels_says_what_to_do_first() {
    let program = program();
    program.write("clear.jsonl", "{\"do\":\"clear_labels\"}\n");
    let facts = program.json(&["new", &asset("swatch"), "-o", "bare.purl", "--script", "clear.jsonl"]);
    let problems = facts["problems"].as_array().unwrap();
    assert_eq!(problems.len() as u64, facts["faces"].as_u64().unwrap());
    assert!(problems.iter().all(|p| p["where"].as_str().unwrap().starts_with("face ")));
    for verb in ["relax", "simulate"] {
        fails(&program, &[verb, "bare.purl", "-o", "no.purl"], &["label all its rows"]);
    }
    fails(&program, &["export", "bare.purl", "-o", "no.bcc"], &["label all its rows"]);
    assert!(!program.path("no.purl").exists() && !program.path("no.bcc").exists());
}

#[test]
fn unusable_outputs_and_values_are_named() {
    let program = program();
    fails(&program, &["new", &asset("swatch"), "-o", "no/such/folder.purl"], &["no/such/folder.purl"]);
    fails(&program, &["export", "good.purl", "-o", "yarn.xyz"], &["yarn.xyz", ".bcc"]);
    fails(&program, &["simulate", "good.purl", "-o", "q.purl", "--scene", "moon"], &["moon", "sphere"]);
    fails(&program, &["simulate", "good.purl", "-o", "q.purl", "--seconds", "0"], &["--seconds"]);
    fails(&program, &["new", &asset("swatch"), "-o", "q.purl", "--stitch-size", "0"], &["--stitch-size"]);
    assert!(!program.path("q.purl").exists() && !program.path("yarn.xyz").exists());
}

#[test]
fn wrong_usage_is_told_apart() {
    let program = program();
    let cases: [(&[&str], &str); 5] = [
        (&["render", "good.purl", "-o", "a.png", "--stage", "crochet"], "mesh, labels, stitches, yarn"),
        (&["render", "good.purl", "-o", "a.png", "--view", "inside"], "three-quarter"),
        (&["render", "good.purl", "-o", "a.png", "--size", "big"], "WIDTHxHEIGHT"),
        (&["render", "good.purl"], "-o"),
        (&["new", "a.obj", "-o", "b.purl", "--unit", "furlong"], "mm, cm, dm, m, in"),
    ];
    for (arguments, says) in cases {
        let run = program.run(arguments);
        assert_eq!((run.status, run.stdout.as_str()), (Some(2), ""), "{arguments:?}");
        assert!(run.stderr.contains(says), "{}", run.stderr);
    }
}

#[test]
fn a_machine_that_cannot_draw_is_told_what_it_lacks() {
    let mut program = program();
    program.set("WGPU_BACKEND", "gl");
    // With OpenGL alone, or without that.
    fails(&program, &["render", "good.purl", "-o", "out.png"], &["graphics adapter", "mesa-vulkan-drivers"]);
    assert!(!program.path("out.png").exists());
}
