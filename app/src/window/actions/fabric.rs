//! What is marked on the edges of a fabric, and what is done to stitches as a whole: cables, seams, live loops, colours,
//! regions, relaxing.

use super::{Action, FABRIC, On, YARN, ends};
use crate::command::Command;
use crate::drawing::Stage;
use crate::window::editor::Editor;
use crate::window::runs::runs;
use crate::window::surface::Surface;
use egui::{Key, Modifiers};
use stitch_mesh::cable::Cable;
use stitch_mesh::ids::{EdgeId, VertexId};
use stitch_mesh::stitch_mesh::StitchMesh;

pub(super) const ACTIONS: &[Action] = &[
    Action::new(
        "Cable",
        "Cross loops: to the left, to the right, not at all by turns; half of them over the rest",
        cable,
    )
    .key(Modifiers::NONE, Key::X)
    .at(FABRIC)
    .on(On::Edges)
    .unless(no_line),
    Action::new("Cross strands", "Cross loops in the strands that are written out", cross_strands)
        .at(FABRIC)
        .on(On::Edges)
        .unless(|e| no_line(e).or_else(|| e.panel.strands.cable(Vec::new()).err())),
    Action::new("Sew", "Sew two lines of border edges together", sew)
        .key(Modifiers::NONE, Key::S)
        .at(FABRIC)
        .on(On::Edges)
        .unless(|e| (lines(e).len() != 2).then_some("select two lines of border edges (key 1)")),
    Action::new("Unsew", "Undo the seams that edges lie in", |e| {
        let edges = ends(e, e.edges_meant());
        e.act(Command::Unsew { edges });
    })
    .key(Modifiers::SHIFT, Key::S)
    .at(FABRIC)
    .on(On::Edges)
    .unless(|e| none_marked(e, |s| s.marks().seams.is_empty(), "there are no seams")),
    Action::new("Cut yarn", "Cut the yarn in the middle of the loops of stitches", |e| {
        let faces = e.faces_meant().into_iter().map(|f| f.0).collect();
        e.act(Command::CutYarn { faces });
    })
    .at(YARN)
    .on(On::Faces)
    .unless(Editor::no_faces),
    Action::new(
        "Drop stitches",
        "Let the loops of stitches slip off what holds them, so that they may run",
        |e| {
            let faces = e.faces_meant().into_iter().map(|f| f.0).collect();
            e.act(Command::DropLoops { faces });
        },
    )
    .at(YARN)
    .on(On::Faces)
    .unless(Editor::no_faces),
    Action::new("Live loops", "Leave the loops of border edges live, or bind them off again", live)
        .key(Modifiers::NONE, Key::V)
        .at(FABRIC)
        .on(On::Edges)
        .unless(Editor::no_edges),
    Action::new("Spiral", "Knit closed rows as one spiral, or as rings again", |e| {
        let spiral = stitches(e).is_some_and(|s| !s.marks().spiral);
        e.act(Command::SetSpiral { spiral });
    })
    .at(FABRIC),
    Action::new(
        "Fill region",
        "Give all stitches of one kind that hang together the stitch of the palette",
        |e| {
            if let Some(face) = e.faces_meant().first() {
                e.act(Command::FillRegion { face: face.0, stitch: e.brush.clone() });
            }
        },
    )
    .key(Modifiers::NONE, Key::F)
    .at(FABRIC)
    .on(On::Faces)
    .unless(Editor::no_faces),
    Action::new("Copy", "Copy stitches with their colours and cables", Editor::copy)
        .key(Modifiers::COMMAND, Key::C)
        .at(FABRIC)
        .on(On::Faces)
        .unless(Editor::no_faces),
    Action::new("Mirror copy", "Turn what was copied left to right", Editor::mirror)
        .key(Modifiers::COMMAND, Key::M)
        .at(FABRIC)
        .unless(Editor::nothing_copied),
    Action::new(
        "Paste",
        "Put what was copied where the pointer is: its lowest stitch on the left comes there",
        Editor::paste,
    )
    .key(Modifiers::COMMAND, Key::V)
    .at(FABRIC)
    .on(On::Faces)
    .unless(Editor::nothing_copied),
    Action::new("Dye", "Give the yarn of stitches the colour that is chosen", |e| {
        let faces = e.faces_meant().into_iter().map(|f| f.0).collect();
        e.act(Command::Dye { faces, color: e.panel.dye });
    })
    .key(Modifiers::SHIFT, Key::D)
    .at(FABRIC)
    .on(On::Faces)
    .unless(Editor::no_faces),
    Action::new("Wrap", "Wrap the yarns of stitches as the numbers say", |e| {
        let faces = e.faces_meant().into_iter().map(|f| f.0).collect();
        e.act(e.panel.wrap.command(faces));
    })
    .at(FABRIC)
    .on(On::Faces)
    .unless(Editor::no_faces),
    Action::new("Relax mesh", "Make the stitches as even as they can be, and lay the yarn again", |e| {
        let [aspect, fill] = e.panel.relax;
        e.act(Command::RelaxMesh { aspect, fill, surface: e.panel.relax_on_surface });
        // To be watched.
        e.go_to(Stage::Stitches);
        e.set_strained(true);
    })
    .at(FABRIC),
    Action::new("Hold", "Hold stitches where they are", |e| {
        let faces = e.faces_meant().into_iter().map(|f| f.0).collect();
        e.act(Command::Hold { faces });
    })
    .at(FABRIC)
    .on(On::Faces)
    .unless(Editor::no_faces),
    Action::new("Let go", "Let go of everything that is held", |e| e.act(Command::LetGo)).at(FABRIC).unless(
        |e| {
            let scene = &e.project().scene;
            (scene.pins.is_empty() && scene.clamps.is_empty()).then_some("nothing is held")
        },
    ),
    Action::new("Show strain", "Colour stitches by how far they are from even, or by their kind", |e| {
        let strained = !(e.strained && e.stage == Stage::Stitches);
        e.go_to(Stage::Stitches);
        e.set_strained(strained);
    })
    .at(FABRIC),
];

fn stitches(editor: &Editor) -> Option<&StitchMesh> {
    match editor.surface() {
        Surface::Stitched(stitches) => Some(stitches),
        Surface::Labelled(_) => None,
    }
}

fn none_marked(
    editor: &Editor,
    none: impl Fn(&StitchMesh) -> bool,
    why: &'static str,
) -> Option<&'static str> {
    if stitches(editor).is_none_or(none) { Some(why) } else { editor.no_edges() }
}

fn lines(editor: &Editor) -> Vec<Vec<VertexId>> {
    let edges: Vec<EdgeId> = editor.selection().edges.iter().copied().collect();
    runs(editor.surface().mesh(), &edges)
}

fn no_line(editor: &Editor) -> Option<&'static str> {
    let [line] = &lines(editor)[..] else { return Some("select a line of course edges (key 1)") };
    (line.len() < 3).then_some("a cable needs two edges or more")
}

/// The selected line of course edges, left to right: so it runs where it is the bottom of the faces above it.
fn line(editor: &Editor, stitches: &StitchMesh) -> Option<Vec<VertexId>> {
    let mut path = lines(editor).into_iter().next()?;
    let mesh = stitches.mesh();
    let backwards = mesh.edge_between(path[0], path[1]).is_some_and(|edge| {
        let (first, second) = mesh.edge_sides(edge);
        let bottom = [Some(first), second].into_iter().flatten().find(|h| stitches.is_bottom(*h));
        bottom.is_some_and(|h| mesh.origin(h) != path[0])
    });
    if backwards {
        path.reverse();
    }
    Some(path)
}

fn edges_of(path: &[VertexId]) -> Vec<[u32; 2]> {
    path.windows(2).map(|w| [w[0].0, w[1].0]).collect()
}

/// Crosses the strands of the panel, in place of what crosses there now.
fn cross_strands(editor: &mut Editor) {
    let Some(stitches) = stitches(editor) else { return };
    let Some(path) = line(editor, stitches) else { return };
    let edges = edges_of(&path);
    let Ok(cable) = editor.panel.strands.cable(path) else { return };
    let taken = stitches.cables().iter().any(|c| cable.path.windows(2).any(|w| c.covers(w[0], w[1])));
    let clear = taken.then_some(Command::ClearCables { edges });
    editor.act_all(clear.into_iter().chain([Command::SetCable { cable }]));
}

fn cable(editor: &mut Editor) {
    let Some(stitches) = stitches(editor) else { return };
    let Some(path) = line(editor, stitches) else { return };
    let loops = (path.len() - 1) as u8;
    let cross = |to_left| Cable::cross(path.clone(), loops / 2, loops - loops / 2, to_left);
    let now = stitches.marks().cables.iter().find(|c| c.path == path);
    let edges = || edges_of(&path);
    let next = match now {
        None => vec![Command::SetCable { cable: cross(true) }],
        Some(cable) if cable.front.first() == Some(&1) => {
            vec![Command::ClearCables { edges: edges() }, Command::SetCable { cable: cross(false) }]
        }
        Some(_) => vec![Command::ClearCables { edges: edges() }],
    };
    editor.act_all(next);
}

/// The sides are sewn from those ends on that lie nearer to each other.
fn sew(editor: &mut Editor) {
    let mesh = editor.surface().mesh();
    let [a, b] = &lines(editor)[..] else { return };
    let (mut b, a) = (b.clone(), a.clone());
    if let ([a0, .., a1], [b0, .., b1]) = (&a[..], &b[..]) {
        let apart = |x: &VertexId, y: &VertexId| mesh.position(*x).distance(mesh.position(*y));
        if apart(a0, b0) + apart(a1, b1) > apart(a0, b1) + apart(a1, b0) {
            b.reverse();
        }
    }
    let numbers = |line: Vec<VertexId>| line.into_iter().map(|v| v.0).collect();
    editor.act(Command::Sew { a: numbers(a), b: numbers(b) });
}

fn live(editor: &mut Editor) {
    let Some(stitches) = stitches(editor) else { return };
    let meant = editor.edges_meant();
    let live = meant.first().is_some_and(|e| !stitches.is_live(stitches.mesh().edge_sides(*e).0));
    let edges = ends(editor, meant);
    editor.act(Command::SetLive { edges, live });
}
