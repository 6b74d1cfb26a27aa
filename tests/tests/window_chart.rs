//! The knitting chart in the window, and on the command line.

#![allow(clippy::unwrap_used, reason = "helpers of tests are tests, which clippy cannot see")]

use app::fabric::Fabric;
use app::project::Project;
use egui::{Key, Modifiers, Pos2};
use egui_kittest::kittest::Queryable as _;
use stitch_mesh::edge_counts::StitchSize;
use stitch_mesh::ids::FaceId;
use stitch_mesh::pieces::from_rows;
use stitch_mesh::stitch::Stitch;
use tests::window::{Window, fabric, knitted};
use tests::{Program, picture_folder};

const NONE: Modifiers = Modifiers::NONE;

/// Lace over eight rows, with twisted stitches, purls, wide decreases and increases.
fn lace() -> Project {
    let rows = [
        "k k k k k k k k k k k k k k k",
        "k d12k yk ky d21k k d12k yk ky d21k k k",
        "p p p p p p p p p p p p p p p p",
        "k yk d231k ky k k yk d312k ky k k1 k p1",
        "k k k k k k k k k k k k k k k k s",
        "k d12p d0y k kpk k d123k d0y1 k d0y-1 k k x k k k",
        "k k k k k k k k k k k k k k k k k k k",
    ];
    let row = |text: &str| text.split_whitespace().map(|s| s.parse().unwrap()).collect::<Vec<Stitch>>();
    let mut rows: Vec<Vec<Stitch>> = rows.iter().map(|r| row(r)).collect();
    // Every row as wide as the one below has loops: knits at its end, or fewer of them.
    let mut loops = 16;
    for row in &mut rows {
        let joined = |row: &[Stitch]| row.iter().map(Stitch::bottoms).sum::<usize>();
        while joined(row) < loops {
            row.push(Stitch::knit());
        }
        while joined(row) > loops {
            row.pop();
        }
        loops = row.iter().map(Stitch::tops).sum();
    }
    let piece = from_rows(&rows, StitchSize::of_width(0.008)).unwrap();
    Project { fabric: Some(Fabric::new(piece)), ..knitted() }
}

fn square(window: &Window, face: u32) -> Pos2 {
    window.editor().in_chart(FaceId(face)).unwrap().center()
}

/// A window with the chart open, and the faces of its rows.
fn chart() -> (Window, Vec<Vec<u32>>) {
    let (mut window, rows) = fabric();
    window.key(Modifiers::SHIFT, Key::C);
    (window, rows)
}

/// Clicks in the chart.
fn click(window: &mut Window, at: Pos2, modifiers: Modifiers) {
    drag(window, at, at, modifiers);
}

fn drag(window: &mut Window, from: Pos2, to: Pos2, modifiers: Modifiers) {
    let button = |pos, pressed| egui::Event::PointerButton {
        pos,
        button: egui::PointerButton::Primary,
        pressed,
        modifiers,
    };
    window.harness.hover_at(from);
    window.harness.event(button(from, true));
    if from != to {
        window.harness.step();
        for i in 1..=20 {
            window.harness.hover_at(from.lerp(to, i as f32 / 20.0));
            window.harness.step();
        }
    }
    window.harness.event(button(to, false));
    window.rest();
}

#[test]
fn chart_and_picture_select_the_same() {
    let (mut window, rows) = chart();
    let diagram = window.editor().diagram().unwrap();
    assert_eq!((diagram.rows.len(), diagram.left_out()), (rows.len(), None));
    let at = [square(&window, rows[1][2]), square(&window, rows[1][4])];
    click(&mut window, at[0], NONE);
    assert_eq!(window.selected(), [rows[1][2]]);
    click(&mut window, at[1], Modifiers::SHIFT);
    assert_eq!(window.selected(), [rows[1][2], rows[1][4]]);
    click(&mut window, at[0], Modifiers::COMMAND);
    assert_eq!(window.selected(), [rows[1][4]]);
    let before = window.keep("chart");
    window.press("Front");
    window.click_stitch(rows[2][3], None, NONE);
    assert_eq!(window.selected(), [rows[2][3]]);
    let after = window.keep("chart-selected");
    let edge = window.editor().in_chart(FaceId(rows[2][3])).unwrap().left_center() + egui::vec2(1.0, 0.0);
    let pixel = |image: &image::RgbaImage| *image.get_pixel(edge.x as u32, edge.y as u32);
    assert!(pixel(&before) != pixel(&after), "it is outlined in the chart");
    window.key(Modifiers::SHIFT, Key::C);
    assert!(window.editor().diagram().is_none());
}

#[test]
fn a_box_in_the_chart_selects_what_it_touches() {
    let (mut window, rows) = chart();
    let [from, to] = [rows[1][2], rows[3][4]].map(|face| square(&window, face));
    let block: Vec<u32> = rows[1..4].iter().flat_map(|row| row[2..5].iter().copied()).collect();
    let sorted = |mut faces: Vec<u32>| {
        faces.sort_unstable();
        faces
    };
    drag(&mut window, from, to, NONE);
    assert_eq!(sorted(window.selected()), sorted(block.clone()));
    let beside = square(&window, rows[1][5]);
    click(&mut window, beside, Modifiers::SHIFT);
    assert_eq!(window.selected().len(), block.len() + 1);
    window.keep("chart-box");
    drag(&mut window, from, to, Modifiers::COMMAND);
    assert_eq!(window.selected(), [rows[1][5]]);
}

#[test]
fn a_stroke_in_the_chart_is_one_step() {
    let (mut window, rows) = chart();
    window.harness.remove_cursor();
    window.key(NONE, Key::D);
    let [from, to] = [rows[1][1], rows[1][4]].map(|f| square(&window, f));
    drag(&mut window, from, to, NONE);
    assert_eq!(window.stitches(&rows[1][..6]).concat(), "kppppk");
    assert_eq!(window.editor().diagram().unwrap().cells().filter(|(_, c)| is_purl(c)).count(), 4);
    window.keep("chart-painted");
    window.harness.remove_cursor();
    window.key(Modifiers::COMMAND, Key::Z);
    assert_eq!(window.stitches(&rows[1][..6]).concat(), "kkkkkk");
    window.harness.hover_at(square(&window, rows[2][2]));
    window.rest();
    window.key(NONE, Key::P);
    assert_eq!(window.stitches(&rows[2][1..4]).concat(), "kpk", "keys work on what is under the pointer");
}

fn is_purl(cell: &patterns::diagram::Cell) -> bool {
    cell.stitch == Some(Stitch::purl())
}

#[test]
fn a_selection_has_a_chart_of_its_own() {
    let (mut window, rows) = fabric();
    window.click_stitch(rows[1][1], None, NONE);
    window.click_stitch(rows[3][4], None, Modifiers::SHIFT);
    window.key(Modifiers::SHIFT, Key::C);
    let size = |window: &Window| window.editor().diagram().map(|d| (d.columns, d.rows.len())).unwrap();
    assert_eq!(size(&window), (4, 2));
    window.press("All rows");
    assert_eq!(size(&window).1, rows.len());
}

#[test]
fn lace_in_the_window_and_as_files() {
    let project = lace();
    let program = Program::new(env!("CARGO_BIN_EXE_purlwise-tested"));
    project.save(&program.path("lace.purl")).unwrap();
    let mut window = Window::new(project);
    window.key(Modifiers::SHIFT, Key::C);
    window.keep("chart-lace");
    window.press("Save SVG…");
    assert!(window.says("give the project a name first"));
    window.harness.get_by_label("Path").focus();
    window.harness.step();
    window.harness.get_by_label("Path").type_text(program.path("saved.purl").to_str().unwrap());
    window.rest();
    window.press("Save SVG…");
    window.press("Save PNG…");
    assert!(window.says("Saved the chart as"));
    for name in ["lace.svg", "lace.png"] {
        let facts = program.json(&["chart", "lace.purl", "-o", name]);
        assert_eq!(facts["rows"], 7);
        std::fs::write(picture_folder().join(format!("chart-{name}")), program.read(name)).unwrap();
    }
    assert!(program.read("lace.svg").starts_with(b"<svg "));
    assert_eq!(program.read("saved.svg"), program.read("lace.svg"), "window and command line write the same");
    assert_eq!(program.read("saved.png"), program.read("lace.png"));
    assert_eq!(program.json(&["chart", "lace.purl", "-o", "part.png", "--rows", "2..3"])["rows"], 2);
    for (arguments, says) in [
        (&["chart", "lace.purl", "-o", "lace.gif"][..], ".svg or .png"),
        (
            &["chart", "lace.purl", "-o", "a.svg", "--rows", "3..9"],
            "there are no rows 3–9: the piece has rows 0–6",
        ),
        (&["chart", "none.purl", "-o", "a.svg"], "none.purl"),
    ] {
        let run = program.run(arguments);
        assert_eq!((run.status, run.stderr.lines().count()), (Some(1), 1), "{}", run.stderr);
        assert!(run.stderr.contains(says), "{}", run.stderr);
    }
}

#[test]
fn a_repeat_is_boxed_and_a_garment_is_cut() {
    let (mut window, _) = chart();
    window.press("Basket");
    assert_eq!(window.editor().diagram().unwrap().repeat, None, "not there twice");
    window.press("Moss");
    let repeat = window.editor().diagram().unwrap().repeat.clone().unwrap();
    assert_eq!((repeat.columns, repeat.rows), (10..12, 0..2));
    window.keep("chart-repeat");
    let mut window = Window::new(app::bundled::pullover().unwrap());
    window.press("Stitches");
    window.key(Modifiers::SHIFT, Key::C);
    assert!(window.says("the first 60 of"));
    let rows = &window.editor().diagram().unwrap().rows;
    assert!(rows.iter().zip(&rows[1..]).all(|(a, b)| b.number > a.number));
    window.keep("chart-pullover");
}

#[test]
fn a_cable_shows_in_the_chart() {
    let (mut window, rows) = chart();
    window.harness.remove_cursor();
    window.press("Front");
    window.click_stitch(rows[3][4], None, NONE);
    window.click_stitch(rows[3][5], None, Modifiers::SHIFT);
    window.key(NONE, Key::P);
    window.key(NONE, Key::Num1);
    for (i, face) in rows[3][2..6].iter().enumerate() {
        window.click_stitch(*face, Some(0), if i == 0 { NONE } else { Modifiers::SHIFT });
    }
    window.key(NONE, Key::X);
    let crossings = &window.editor().diagram().unwrap().crossings;
    assert_eq!(crossings.len(), 1);
    assert_eq!((&crossings[0].columns, &crossings[0].purled[..]), (&(2..6), &[true, false][..]));
    window.keep("chart-cable");
}
