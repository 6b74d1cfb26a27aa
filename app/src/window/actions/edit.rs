//! Labels, stitches and yarn.

use super::{Action, FABRIC, On, ends};
use crate::command::Command;
use crate::drawing::Stage;
use crate::window::editor::Editor;
use egui::{Key, Modifiers};
use stitch_mesh::ids::FaceId;
use stitch_mesh::label::EdgeLabel;
use stitch_mesh::stitch::Stitch;

const LABELS: &[Stage] = &[Stage::Labels];

pub(super) const ACTIONS: &[Action] = &[
    Action::new("Label wale", "Label edges as wale edges: a row's yarn passes across them", |e| {
        label(e, Some(EdgeLabel::Wale));
    })
    .key(Modifiers::NONE, Key::W)
    .at(LABELS)
    .on(On::Edges)
    .unless(Editor::no_edges),
    Action::new("Label course", "Label edges as course edges: they run along the rows", |e| {
        label(e, Some(EdgeLabel::Course));
    })
    .key(Modifiers::NONE, Key::C)
    .at(LABELS)
    .on(On::Edges)
    .unless(Editor::no_edges),
    Action::new("Clear label", "Take the labels of edges away", |e| label(e, None))
        .key(Modifiers::NONE, Key::Delete)
        .at(LABELS)
        .on(On::Edges)
        .unless(Editor::no_edges),
    Action::new("Fill row", "Label the row on a border, or beyond a course edge", |e| fill(e, false))
        .key(Modifiers::NONE, Key::R)
        .at(LABELS)
        .on(On::Edges)
        .unless(Editor::no_edges),
    Action::new("Fill onwards", "Label the row on a border or course edge, and all rows beyond", |e| {
        fill(e, true)
    })
    .key(Modifiers::SHIFT, Key::R)
    .at(LABELS)
    .on(On::Edges)
    .unless(Editor::no_edges),
    Action::new("Flip row", "Knit a row the other way: turns its wale direction", flip_rows)
        .key(Modifiers::NONE, Key::F)
        .at(LABELS)
        .on(On::Faces)
        .unless(|e| e.faces_meant().is_empty().then_some("point at a row or select faces (key 2)")),
    Action::new("Label automatically", "Label whatever can be labelled without asking", |e| {
        e.act(Command::Autolabel)
    })
    .at(LABELS),
    Action::new("Clear labels", "Take all labels away", |e| e.act(Command::ClearLabels)).at(LABELS),
    Action::new("Tessellate", "Cut the mesh into stitches of this width", Editor::tessellate)
        .at(LABELS)
        .unless(|e| (!e.project().labelled.problems().is_empty()).then_some("every face needs a row first")),
    Action::new("Knit", "Make stitches knit", |e| e.use_stitch(Stitch::knit()))
        .key(Modifiers::NONE, Key::K)
        .at(FABRIC)
        .on(On::Faces),
    Action::new("Purl", "Make stitches purl", |e| e.use_stitch(Stitch::purl()))
        .key(Modifiers::NONE, Key::P)
        .at(FABRIC)
        .on(On::Faces),
    Action::new("Yarn-over", "Make stitches yarn-overs", yarn_over)
        .key(Modifiers::NONE, Key::Y)
        .at(FABRIC)
        .on(On::Faces),
    Action::new("Twist", "Twist the loops: none, clockwise, counter-clockwise by turns", twist)
        .key(Modifiers::NONE, Key::T)
        .at(FABRIC)
        .on(On::Faces)
        .unless(Editor::no_faces),
    Action::new("Lay anew", "Put the yarn back to where it was laid", |e| e.act(Command::ResetYarn))
        .at(&[Stage::Yarn]),
];

fn label(editor: &mut Editor, label: Option<EdgeLabel>) {
    let edges = ends(editor, editor.edges_meant());
    editor.act(Command::LabelEdges { edges, label });
}

fn fill(editor: &mut Editor, onwards: bool) {
    let meant = editor.edges_meant();
    let labelled = editor.project().labelled.clone();
    let one = meant.first().copied();
    let on_course = one.is_some_and(|e| labelled.label(e) == Some(EdgeLabel::Course));
    // One edge stands for its row, and others of the same border or row would find it labelled already.
    let command = ends(editor, meant).into_iter().take(1).map(|edge| match (onwards, on_course) {
        (true, _) => Command::FillOnwards { edge },
        (false, true) => Command::FillFromCourse { edge },
        (false, false) => Command::FillFromBorder { edge },
    });
    editor.act_all(command);
}

fn flip_rows(editor: &mut Editor) {
    let labelled = editor.project().labelled.clone();
    let mut turned: Vec<FaceId> = Vec::new();
    let mut rows = Vec::new();
    for face in editor.faces_meant() {
        if !turned.contains(&face) {
            turned.extend(labelled.row_of(face).faces);
            rows.push(Command::FlipRow { face: face.0 });
        }
    }
    editor.act_all(rows);
}

/// A yarn-over from a loop below and one from nothing are different stitches: whichever has a place here.
fn yarn_over(editor: &mut Editor) {
    let meant = editor.faces_meant();
    let kinds = ["y", "d0y"].into_iter().flat_map(str::parse::<Stitch>);
    let mut kinds: Vec<Stitch> = kinds.collect();
    kinds.sort_by_key(|kind| editor.that_take(kind, &meant).is_empty());
    if let Some(kind) = kinds.into_iter().next() {
        editor.use_stitch(kind);
    }
}

/// Every loop of the chosen stitches takes the next twist after that of the first.
fn twist(editor: &mut Editor) {
    let Some(fabric) = &editor.view.project.fabric else { return };
    let stitches = fabric.stitches.clone();
    let faces = editor.faces_meant();
    let first = faces.first().and_then(|f| stitches.stitch(*f).ops.first()).map_or(0, |op| op.twist);
    let next = match first {
        0 => 1,
        1 => -1,
        _ => 0,
    };
    let mut groups: Vec<(Stitch, Vec<u32>)> = Vec::new();
    for face in faces {
        let mut stitch = stitches.stitch(face).clone();
        stitch.ops.iter_mut().for_each(|op| op.twist = next);
        match groups.iter_mut().find(|(s, _)| *s == stitch) {
            Some((_, faces)) => faces.push(face.0),
            None => groups.push((stitch, vec![face.0])),
        }
    }
    editor.act_all(groups.into_iter().map(|(stitch, faces)| Command::SetStitch { faces, stitch }));
}
