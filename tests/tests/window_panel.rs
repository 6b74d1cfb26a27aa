//! The session of the panel script once more, with mouse and keys: it has to give the same document as `purlwise edit`.

#![allow(clippy::unwrap_used, clippy::panic, reason = "helpers of tests are tests, which clippy cannot see")]

use app::command::{Command, read_script};
use app::project::Project;
use egui::{Key, Modifiers};
use egui_kittest::kittest::Queryable as _;
use stitch_mesh::dye::Dye;
use stitch_mesh::ids::VertexId;
use stitch_mesh::mesh::PolygonMesh;
use stitch_mesh::patch::Patch;
use tests::PANEL;
use tests::window::{Window, swatch};

const NONE: Modifiers = Modifiers::NONE;

/// The mesh of the stage: of stitches once there are any, unless labels are shown.
fn mesh(window: &Window, of_labels: bool) -> PolygonMesh {
    let project = window.editor().project();
    match &project.fabric {
        Some(fabric) if !of_labels => fabric.stitches.mesh().clone(),
        _ => project.labelled.mesh().clone(),
    }
}

/// Goes to the labels or to the stitches, seen from the front.
fn go_to(window: &mut Window, labels: bool) {
    let labels_shown = window.harness.query_by_label("Label automatically").is_some();
    if labels != labels_shown {
        window.press(if labels { "Labels" } else { "Stitches" });
    }
    window.press("Front");
}

fn select_edges(window: &mut Window, of_labels: bool, edges: &[[u32; 2]]) {
    go_to(window, of_labels);
    window.key(NONE, Key::Num1);
    let mesh = mesh(window, of_labels);
    let side = |[a, b]: &[u32; 2]| {
        let [a, b] = [VertexId(*a), VertexId(*b)];
        let half = mesh.half_edge_between(a, b).or(mesh.half_edge_between(b, a)).unwrap();
        let face = mesh.face(half);
        window.at_face(&mesh, face.0, Some(half.index() - mesh.first_half_edge(face).index()))
    };
    let places: Vec<_> = edges.iter().map(side).collect();
    window.click_all(&places);
    assert_eq!(window.editor().selection().edges.len(), edges.len(), "{edges:?}");
}

fn select_faces(window: &mut Window, mode: Key, faces: &[u32]) {
    go_to(window, false);
    window.key(NONE, mode);
    let places: Vec<_> = faces.iter().map(|f| window.at_stitch(*f, None)).collect();
    window.click_all(&places);
}

/// The first faces of some rows.
fn select_rows(window: &mut Window, [first, last]: [usize; 2]) {
    let rows = window.editor().project().fabric().unwrap().stitches.rows();
    let faces: Vec<u32> = rows[first..=last].iter().map(|r| r.faces[0].0).collect();
    select_faces(window, Key::Num3, &faces);
}

fn count_of(window: &Window, [a, b]: [u32; 2]) -> u32 {
    let project = window.editor().project();
    let edge = project.labelled.mesh().edge_between(VertexId(a), VertexId(b)).unwrap();
    project.counts.as_ref().unwrap().counts[edge.index()]
}

/// The button of a stitch in the palette.
fn choose(window: &mut Window, symbol: &str) {
    let label = format!("{symbol} · ");
    window.press("Palette");
    window.harness.get_all_by_label_contains(&label).next().unwrap().click();
    window.rest();
}

fn dye(window: &mut Window, color: Dye) {
    let name = match color.0 {
        [0x00, 0x72, 0xb2] => "Blue",
        [0xd5, 0x5e, 0x00] => "Vermilion",
        other => panic!("no button has the colour {other:?}"),
    };
    window.press("Finish");
    window.press(name);
    window.press("Dye the selection");
}

/// Knits a patch into the upper left corner, copies it from there, takes that back, and puts it where it is to be.
fn paste(window: &mut Window, at: u32, patch: &Patch) {
    let rows = window.editor().project().fabric().unwrap().stitches.rows();
    let spare = |row: usize, column: usize| rows[rows.len() - 4 + row].faces[column].0;
    let mut faces = Vec::new();
    let mut steps = 0;
    for (r, row) in patch.rows.iter().enumerate() {
        for (c, stitch) in row.stitches.iter().enumerate() {
            let Some(stitch) = stitch else { continue };
            let face = spare(r, c);
            select_faces(window, Key::Num2, &[face]);
            if window.stitches(&[face])[0] != stitch.stitch.to_string() {
                choose(window, &stitch.stitch.to_string());
                steps += 1;
            }
            if stitch.color != Dye::UNDYED {
                dye(window, stitch.color);
                steps += 1;
            }
            faces.push(face);
        }
    }
    select_faces(window, Key::Num2, &faces);
    window.key(Modifiers::COMMAND, Key::C);
    (0..steps).for_each(|_| window.key(Modifiers::COMMAND, Key::Z));
    window.key(NONE, Key::Escape);
    window.harness.hover_at(window.at_stitch(at, None));
    window.key(Modifiers::COMMAND, Key::V);
}

/// Does with mouse and keys what a command does.
fn by_hand(window: &mut Window, command: &Command) {
    let press_at = |window: &mut Window, edge: [u32; 2], button: &str| {
        select_edges(window, false, &[edge]);
        window.press("Finish");
        window.press(button);
    };
    match command {
        Command::FillOnwards { edge } => {
            select_edges(window, true, &[*edge]);
            window.press("Fill onwards");
        }
        Command::Tessellate { width_mm } => {
            window.press("Labels");
            if let Some(width) = width_mm {
                window.harness.get_by_label("Stitch width").click();
                window.harness.step();
                window.harness.get_by_label("Stitch width").type_text(&width.to_string());
                window.key(NONE, Key::Enter);
            }
            window.press("Tessellate");
        }
        Command::SetEdgeCounts { edges, count } => {
            select_edges(window, true, edges);
            while count_of(window, edges[0]) > *count {
                window.press("−");
            }
        }
        Command::MarkWale { edges, .. } => {
            select_edges(window, true, edges);
            window.press("Shape along these edges");
        }
        Command::SetChart { chart, rows, faces } => {
            match (rows, faces) {
                (Some(rows), _) => select_rows(window, *rows),
                (_, Some(faces)) => select_faces(window, Key::Num2, faces),
                _ => panic!("of all faces none is selected"),
            }
            window.press("Palette");
            window.press(if chart.len() == 1 { "Rib" } else { "Moss" });
        }
        Command::Paste { at, patch } => paste(window, *at, patch),
        Command::SetCable { cable } => {
            let edges: Vec<_> = cable.path.windows(2).map(|w| [w[0].0, w[1].0]).collect();
            select_edges(window, false, &edges);
            let is_set =
                |w: &Window| w.editor().project().fabric().unwrap().stitches.cables().contains(cable);
            for _ in 0..3 {
                if !is_set(window) {
                    window.key(NONE, Key::X);
                }
            }
            assert!(is_set(window));
        }
        Command::SetStitch { faces, stitch } => {
            select_faces(window, Key::Num2, faces);
            window.key(NONE, if stitch.to_string() == "p" { Key::P } else { Key::K });
        }
        Command::SplitCourse { edge } => press_at(window, *edge, "Split loop"),
        Command::CollapseCourse { edge } => press_at(window, *edge, "Collapse loop"),
        Command::RemoveWale { edge } => press_at(window, *edge, "Remove wale"),
        Command::ShiftWale { edge, .. } => press_at(window, *edge, "Shift bottom right"),
        Command::AddWale { face, .. } => {
            select_faces(window, Key::Num2, &[*face]);
            window.press("Finish");
            window.press("Divide stitch");
        }
        Command::DyeRows { rows, color } => {
            select_rows(window, *rows);
            dye(window, *color);
        }
        Command::Dye { faces, color } => {
            select_faces(window, Key::Num2, faces);
            dye(window, *color);
        }
        Command::SetLive { edges, .. } => {
            for edge in edges {
                press_at(window, *edge, "Live loops");
            }
        }
        other => panic!("nobody has shown how to do {other:?} by hand"),
    }
}

#[test]
fn the_same_panel_comes_from_a_script_and_from_the_window() {
    let folder = tempfile::tempdir().unwrap();
    let saved = |project: &Project| {
        let path = folder.path().join("panel.purl");
        project.save(&path).unwrap();
        std::fs::read(path).unwrap()
    };
    let mut scripted = swatch();
    let mut window = Window::new(swatch());
    for (line, command) in read_script(PANEL).unwrap() {
        scripted = command.apply(&scripted).unwrap();
        by_hand(&mut window, &command);
        assert!(
            saved(window.editor().project()) == saved(&scripted),
            "line {line} of the script comes out otherwise by hand: {command:?}"
        );
    }
    window.press("Stitches");
    window.press("Front");
    window.keep("panel");
}
