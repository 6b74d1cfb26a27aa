//! Meshes that were not made for this program: clothes from MakeHuman, in decimetres.
//!
//! They are CC0 but not ours to keep, so they are no part of the repository: they are looked for in `../shared/meshes` beside
//! it, and where that folder is absent these tests say that they were skipped.

#![allow(clippy::unwrap_used, clippy::panic, reason = "helpers of tests are tests, which clippy cannot see")]

use serde_json::Value;
use tests::{Program, root, skip};

fn program() -> Program {
    Program::new(env!("CARGO_BIN_EXE_purlwise-tested"))
}

/// The facts of a new project `a.purl` made from a mesh, or None without the mesh.
fn facts(program: &Program, name: &str, width: &str) -> Option<Value> {
    let path = root().join(format!("../shared/meshes/{name}.obj"));
    if !path.is_file() {
        skip(&format!("{name}.obj: there is no {}", path.display()));
        return None;
    }
    let path = path.display().to_string();
    Some(program.json(&["new", &path, "-o", "a.purl", "--unit", "dm", "--stitch-size", width]))
}

/// Lets the yarn move a little.
fn simulates(program: &Program) {
    let facts = program.json(&["simulate", "a.purl", "-o", "b.purl", "--scene", "free", "--seconds", "0.02"]);
    let sim = &facts["sim"];
    assert!(sim["steps"].as_u64().unwrap() >= 4, "{sim}");
    assert!(sim["max_stretch"].as_f64().unwrap() < 0.5, "{sim}");
    assert!(sim["kinetic_j"].as_f64().unwrap() > 0.0, "{sim}");
}

#[test]
fn the_skirt_becomes_yarn_by_itself() {
    let program = program();
    let Some(facts) = facts(&program, "skirt", "25") else { return };
    assert_eq!(facts["problems"], serde_json::json!([]));
    assert!(facts["loops"].as_u64().unwrap() > 1000, "{facts}");
    // A skirt in decimetres is well under a metre high and wide.
    let size: Vec<f64> = facts["size_mm"].as_array().unwrap().iter().map(|x| x.as_f64().unwrap()).collect();
    assert!(size.iter().all(|x| (100.0..1000.0).contains(x)), "{size:?}");
    simulates(&program);
}

/// Either there are no problems and the yarn moves, or each problem names a face of the mesh and says what to do there.
fn goes_through_or_says_why(name: &str) {
    let program = program();
    let Some(facts) = facts(&program, name, "25") else { return };
    let problems = facts["problems"].as_array().unwrap();
    if problems.is_empty() {
        return simulates(&program);
    }
    assert_eq!(facts["loops"], 0);
    let count = facts["faces"].as_u64().unwrap();
    for problem in problems {
        let (place, what) = (problem["where"].as_str().unwrap(), problem["what"].as_str().unwrap());
        let face: u64 = place.strip_prefix("face ").unwrap().parse().unwrap();
        assert!(face < count, "{place}: {what}");
        let advice = ["fill the row", "label its edges", "change the mesh", "flip", "turn"];
        assert!(advice.iter().any(|a| what.contains(a)), "no advice: {what}");
    }
}

#[test]
fn the_fedora_goes_through_or_says_why() {
    goes_through_or_says_why("fedora");
}

#[test]
fn the_sportsuit_goes_through_or_says_why() {
    goes_through_or_says_why("sportsuit");
}
