//! Dependencies run one way: stitch-mesh ← patterns, sim-core, render ← app ← tests.

#![allow(clippy::unwrap_used, clippy::panic, reason = "helpers of tests are tests, which clippy cannot see")]

use std::collections::BTreeSet;

const WINDOW: [&str; 6] = ["egui", "egui-wgpu", "egui-winit", "winit", "rfd", "egui_kittest"];

/// Crates of the workspace, from the bottom up; what each may use of the others; what it must not use beside.
const LAYERS: [(&str, &[&str], &[&str]); 6] = [
    ("stitch-mesh", &[], &["wgpu"]),
    ("patterns", &["stitch-mesh"], &["wgpu"]),
    ("sim-core", &["stitch-mesh"], &[]),
    ("render", &["stitch-mesh"], &[]),
    ("app", &["stitch-mesh", "patterns", "sim-core", "render"], &[]),
    ("tests", &["stitch-mesh", "patterns", "sim-core", "render", "app"], &[]),
];

/// Names under every `…dependencies` heading of a manifest.
fn dependencies(manifest: &str) -> BTreeSet<String> {
    let mut names = BTreeSet::new();
    let mut inside = false;
    for line in manifest.lines().map(str::trim) {
        if let Some(heading) = line.strip_prefix('[') {
            let heading = heading.trim_end_matches(']');
            inside = heading.ends_with("dependencies");
            // The long form, `[dependencies.NAME]`.
            if let Some((before, name)) = heading.rsplit_once('.')
                && before.ends_with("dependencies")
            {
                names.insert(name.to_owned());
            }
        } else if inside && !line.is_empty() && !line.starts_with('#') {
            names.extend(line.split(['.', '=', ' ']).next().map(str::to_owned));
        }
    }
    names
}

/// What a manifest uses against the rules of its layer.
fn offences(name: &str, manifest: &str) -> Vec<String> {
    let (_, may, never) = LAYERS.iter().find(|(n, ..)| *n == name).unwrap();
    let may_have_windows = ["app", "tests"].contains(&name);
    let is_ours = |d: &str| LAYERS.iter().any(|(n, ..)| *n == d);
    let wrong = |d: &str| {
        (is_ours(d) && !may.contains(&d)) || never.contains(&d) || (!may_have_windows && WINDOW.contains(&d))
    };
    dependencies(manifest).into_iter().filter(|d| wrong(d)).collect()
}

fn manifest(folder: &str) -> String {
    std::fs::read_to_string(tests::root().join(folder).join("Cargo.toml")).unwrap()
}

#[test]
fn every_crate_keeps_to_its_layer() {
    for (name, ..) in LAYERS {
        assert_eq!(offences(name, &manifest(name)), [""; 0], "{name}");
    }
    assert!(dependencies(&manifest("app")).contains("stitch-mesh"), "the reader finds what is there");
}

#[test]
fn every_crate_has_a_layer() {
    let root = manifest(".");
    let members = root.lines().find_map(|l| l.strip_prefix("members = ")).unwrap();
    let members: Vec<&str> = members.split(['[', ']', ',', '"', ' ']).filter(|w| !w.is_empty()).collect();
    assert_eq!(members, LAYERS.map(|(name, ..)| name));
}

#[test]
fn an_offence_is_found_in_any_notation() {
    let with =
        |lines: &str| format!("[package]\nname = \"x\"\n\n[dependencies]\nserde.workspace = true\n{lines}\n");
    assert_eq!(offences("stitch-mesh", &with("wgpu.workspace = true")), ["wgpu"]);
    assert_eq!(offences("sim-core", &with("[dev-dependencies]\nwinit = \"0.30\"")), ["winit"]);
    assert_eq!(
        offences("render", &with("[target.'cfg(unix)'.dependencies.egui]\nversion = \"1\"")),
        ["egui"]
    );
    assert_eq!(offences("render", &with("sim-core = { path = \"../sim-core\" }")), ["sim-core"]);
    assert_eq!(offences("patterns", &with("app.workspace = true")), ["app"]);
    assert_eq!(offences("sim-core", &with("wgpu.workspace = true")), [""; 0]);
}
