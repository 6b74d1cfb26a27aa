//! Files, history, stages, tools and the camera.

use super::{Action, FABRIC};
use crate::drawing::Stage;
use crate::window::editor::Editor;
use crate::window::panels::leaving::Destination;
use crate::window::pointer::Tool;
use crate::window::request::Request;
use egui::{Key, Modifiers};
use render::NamedView;
use sim_core::SimCommand;
use std::path::PathBuf;

const CTRL_SHIFT: Modifiers = Modifiers::COMMAND.plus(Modifiers::SHIFT);

pub(super) const ACTIONS: &[Action] = &[
    Action::new("Search commands", "Find anything that can be done by its name", |e| {
        e.search = Some(Default::default());
    })
    .key(Modifiers::NONE, Key::F3),
    Action::new(
        "Open…",
        "Open a project or a mesh; without a file dialog, write its path in the field beside and press Enter",
        open,
    )
    .key(Modifiers::COMMAND, Key::O),
    Action::new("Save", "Save the project under the name in the path field", Editor::save)
        .key(Modifiers::COMMAND, Key::S),
    Action::new(
        "Save script",
        "Save the history as a script of commands, beside the project",
        Editor::save_script,
    )
    .unless(no_history),
    Action::new(
        "Save instructions",
        "Write how the fabric or the selection is knitted, row by row, beside the project",
        Editor::save_instructions,
    )
    .unless(no_fabric),
    Action::new("Undo", "Take back the last step", |e| e.request(Request::Undo))
        .key(Modifiers::COMMAND, Key::Z)
        .unless(no_history),
    Action::new("Redo", "Do again what was taken back", |e| e.request(Request::Redo))
        .key(CTRL_SHIFT, Key::Z)
        .unless(|e| e.view.undone.is_empty().then_some("there is nothing to redo")),
    Action::new(
        "Experiments",
        "What fabrics do when they are pulled, sheared, hung and let go, in numbers",
        |e| {
            e.panel.lab.open = !e.panel.lab.open;
        },
    ),
    Action::new("Put down", "Put the tool down; with nothing in hand, select nothing", Editor::put_down)
        .key(Modifiers::NONE, Key::Escape),
    Action::new("Mesh", "The mesh as it was read", |e| e.go_to(Stage::Mesh))
        .key(Modifiers::COMMAND, Key::Num1),
    Action::new("Labels", "Rows and labels of the mesh", |e| e.go_to(Stage::Labels))
        .key(Modifiers::COMMAND, Key::Num2),
    Action::new("Stitches", "The fabric, a face a stitch", |e| e.go_to(Stage::Stitches))
        .key(Modifiers::COMMAND, Key::Num3)
        .unless(no_fabric),
    Action::new("Yarn", "The yarn of the fabric", |e| e.go_to(Stage::Yarn))
        .key(Modifiers::COMMAND, Key::Num4)
        .unless(no_fabric),
    Action::new("Play", "Simulate the yarn, or pause", |e| {
        e.set_playing(!e.playing);
        e.go_to(Stage::Yarn);
    })
    .key(Modifiers::NONE, Key::Space)
    .unless(no_fabric),
    Action::new("Step", "Simulate a single step", |e| _ = e.sim.send(SimCommand::StepOnce))
        .at(&[Stage::Yarn]),
    Action::new("Reset", "Put the yarn back to where this simulation began", |e| {
        e.sim.send(SimCommand::Reset);
    })
    .at(&[Stage::Yarn]),
    Action::new("Select", "Click to select, drag for a box; Shift adds, Ctrl removes", |e| {
        e.take(Tool::Select)
    })
    .key(Modifiers::NONE, Key::B),
    Action::new("Brush select", "Drag a circle over what is to be selected", |e| e.take(Tool::Brush))
        .key(Modifiers::NONE, Key::C)
        .at(&[Stage::Mesh, Stage::Stitches, Stage::Yarn]),
    Action::new("Paint", "Drag over stitches to paint them with the stitch of the palette", |e| {
        e.take(Tool::Paint)
    })
    .key(Modifiers::NONE, Key::D)
    .at(FABRIC),
    Action::new("Grab", "Drag the yarn while it is simulated", |e| e.take(Tool::Grab))
        .key(Modifiers::NONE, Key::G)
        .at(&[Stage::Yarn]),
    Action::new("Scissors", "Click yarn to cut it where the pointer is", |e| e.take(Tool::Scissors))
        .key(Modifiers::SHIFT, Key::X)
        .at(&[Stage::Yarn]),
    Action::new(
        "Chart",
        "Show the rows as a knitting chart, or put it away; a selection of several as it is now",
        |e| {
            e.toggle_chart();
        },
    )
    .key(Modifiers::SHIFT, Key::C)
    .at(FABRIC)
    .unless(no_fabric),
    Action::new("Chart all rows", "Show all rows of the lowest piece in the chart", |e| e.chart_part(false))
        .at(FABRIC)
        .unless(|e| e.chart.is_none().then_some("there is no chart")),
    Action::new("Chart the selection", "Show the rows and columns around the selected stitches", |e| {
        e.chart_part(true);
    })
    .at(FABRIC)
    .unless(Editor::no_faces),
    Action::new("Save chart as SVG", "Save the chart beside the project, as lines", |e| e.save_chart("svg"))
        .at(FABRIC)
        .unless(no_fabric),
    Action::new("Save chart as PNG", "Save the chart beside the project, as a picture", |e| {
        e.save_chart("png")
    })
    .at(FABRIC)
    .unless(no_fabric),
    Action::new("Frame all", "Fit the view to everything", |e| e.frame(None)).key(Modifiers::NONE, Key::Home),
    Action::new("Frame selected", "Fit the view to what is selected", Editor::frame_selected)
        .key(Modifiers::NONE, Key::Period)
        .unless(|e| e.selection().is_empty().then_some("nothing is selected")),
    Action::new("Front", "Look at the front", |e| e.frame(Some(NamedView::Front)))
        .key(Modifiers::NONE, Key::Num5),
    Action::new("Back", "Look at the back", |e| e.frame(Some(NamedView::Back)))
        .key(Modifiers::NONE, Key::Num6),
    Action::new("Left", "Look from the left", |e| e.frame(Some(NamedView::Left)))
        .key(Modifiers::NONE, Key::Num7),
    Action::new("Right", "Look from the right", |e| e.frame(Some(NamedView::Right)))
        .key(Modifiers::NONE, Key::Num8),
    Action::new("Top", "Look from above", |e| e.frame(Some(NamedView::Top))).key(Modifiers::NONE, Key::Num9),
    Action::new("Three-quarter", "Look from the front, right and above", |e| {
        e.frame(Some(NamedView::ThreeQuarter))
    })
    .key(Modifiers::NONE, Key::Num0),
];

fn open(editor: &mut Editor) {
    // The portal's dialog has an event loop of its own; it runs beside the window and answers as a request.
    let field = PathBuf::from(editor.panel.path.trim());
    let current = editor.view.path.as_ref() == Some(&field);
    editor.leave(match !current && field.is_file() {
        true => Destination::Other(Request::Open(field)),
        false => Destination::Chosen,
    });
}

fn no_history(editor: &Editor) -> Option<&'static str> {
    editor.view.done.is_empty().then_some("there is nothing to undo")
}

fn no_fabric(editor: &Editor) -> Option<&'static str> {
    editor.project().fabric.is_none().then_some("tessellate the labelled mesh first")
}
