//! Changing where stitches increase and decrease: course edges that split and collapse, wale edges that come, go and shift.

use super::{Action, FABRIC, On, ends};
use crate::command::Command;
use crate::window::editor::Editor;
use crate::window::surface::Surface;
use stitch_mesh::edit::{End, Way};
use stitch_mesh::label::EdgeLabel;

pub(super) const ACTIONS: &[Action] = &[
    Action::new("Split loop", "One more loop on a course edge: an increase below, a decrease above", |e| {
        one(e, |edge| Command::SplitCourse { edge });
    })
    .at(FABRIC)
    .on(On::Edges)
    .unless(|e| not_one(e, EdgeLabel::Course)),
    Action::new("Collapse loop", "One loop less: a course edge goes, and its ends become one", |e| {
        one(e, |edge| Command::CollapseCourse { edge });
    })
    .at(FABRIC)
    .on(On::Edges)
    .unless(|e| not_one(e, EdgeLabel::Course)),
    Action::new("Divide stitch", "Make two stitches of one by a new wale edge through its middle", divide)
        .at(FABRIC)
        .on(On::Faces)
        .unless(Editor::no_faces),
    Action::new("Remove wale", "Take a wale edge away: the stitches on both sides become one", |e| {
        one(e, |edge| Command::RemoveWale { edge });
    })
    .at(FABRIC)
    .on(On::Edges)
    .unless(|e| not_one(e, EdgeLabel::Wale)),
    Action::new("Shift top left", "Move the top of a wale edge by one loop to the left", |e| {
        shift(e, End::Top, Way::Left)
    })
    .at(FABRIC)
    .on(On::Edges)
    .unless(|e| not_one(e, EdgeLabel::Wale)),
    Action::new("Shift top right", "Move the top of a wale edge by one loop to the right", |e| {
        shift(e, End::Top, Way::Right);
    })
    .at(FABRIC)
    .on(On::Edges)
    .unless(|e| not_one(e, EdgeLabel::Wale)),
    Action::new("Shift bottom left", "Move the bottom of a wale edge by one loop to the left", |e| {
        shift(e, End::Bottom, Way::Left);
    })
    .at(FABRIC)
    .on(On::Edges)
    .unless(|e| not_one(e, EdgeLabel::Wale)),
    Action::new("Shift bottom right", "Move the bottom of a wale edge by one loop to the right", |e| {
        shift(e, End::Bottom, Way::Right);
    })
    .at(FABRIC)
    .on(On::Edges)
    .unless(|e| not_one(e, EdgeLabel::Wale)),
];

/// Edits change the numbers of faces and edges, so they go one at a time.
fn not_one(editor: &Editor, label: EdgeLabel) -> Option<&'static str> {
    match (&editor.edges_meant()[..], label) {
        ([edge], label) if editor.surface().label(*edge) == Some(label) => None,
        (_, EdgeLabel::Course) => Some("select one course edge (key 1)"),
        (_, EdgeLabel::Wale) => Some("select one wale edge (key 1)"),
    }
}

fn one(editor: &mut Editor, command: impl Fn([u32; 2]) -> Command) {
    let edges = ends(editor, editor.edges_meant());
    editor.act_all(edges.into_iter().take(1).map(command));
}

fn shift(editor: &mut Editor, end: End, to: Way) {
    one(editor, |edge| Command::ShiftWale { edge, end, to });
}

/// From the middle corner below to the middle corner above; of a single loop from its right end below and to its left end above,
/// so that both parts have a loop.
fn divide(editor: &mut Editor) {
    let Surface::Stitched(stitches) = editor.surface() else { return };
    let Some(face) = editor.faces_meant().first().copied() else { return };
    let mesh = stitches.mesh();
    let (bottoms, tops) = (stitches.bottoms(face), stitches.tops(face));
    let middle = |count: usize| count.div_ceil(2);
    let mut below: Vec<u32> = bottoms.map(|h| mesh.tip(h).0).collect();
    below.insert(0, mesh.tip(stitches.left(face)).0);
    // Tops run against the face: left to right, their starts lie on the right.
    let mut above: Vec<u32> = tops.map(|h| mesh.origin(h).0).collect();
    above.insert(0, mesh.origin(stitches.left(face)).0);
    let edge = [below[middle(below.len() - 1)], above[(above.len() - 1) / 2]];
    editor.act(Command::AddWale { face: face.0, edge });
}
