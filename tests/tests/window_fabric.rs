//! Cables, colours, regions, edge counts and relaxing, in the window.

#![allow(clippy::unwrap_used, reason = "helpers of tests are tests, which clippy cannot see")]

use app::command::Command;
use egui::{Key, Modifiers};
use stitch_mesh::dye::Dye;
use stitch_mesh::ids::FaceId;
use tests::window::{Window, fabric, swatch};

const NONE: Modifiers = Modifiers::NONE;

#[test]
fn a_cable_crosses_left_then_right_then_not() {
    let (mut window, rows) = fabric();
    window.key(NONE, Key::Num1);
    for (i, face) in rows[3][2..6].iter().enumerate() {
        window.click_stitch(*face, Some(0), if i == 0 { NONE } else { Modifiers::SHIFT });
    }
    let cables = |window: &Window| {
        let fabric = window.editor().project().fabric().unwrap();
        let of = |c: &stitch_mesh::cable::Cable| (c.strands.clone(), c.front.clone());
        fabric.stitches.marks().cables.iter().map(of).collect::<Vec<_>>()
    };
    window.key(NONE, Key::X);
    assert_eq!(cables(&window), [(vec![2, 2], vec![1, 0])]);
    let left = window.keep("cable");
    assert!(window.says("Cable 2/2 left"), "in the history");
    window.key(NONE, Key::X);
    assert_eq!(cables(&window), [(vec![2, 2], vec![0, 1])]);
    assert!(window.says("Cable 2/2 right") && !window.says("Clear cables"));
    // The strands are on the stitches, and lie otherwise now.
    let right = window.keep("cable-right");
    let other = left.pixels().zip(right.pixels()).filter(|(a, b)| a != b).count();
    assert!(other > 200, "{other} pixels");
    window.key(Modifiers::COMMAND, Key::Z);
    assert_eq!(cables(&window), [(vec![2, 2], vec![1, 0])], "turning it round was one step");
    window.key(NONE, Key::X);
    window.key(NONE, Key::X);
    assert_eq!(cables(&window).len(), 0);
}

#[test]
fn colours_and_regions_go_over_what_is_selected() {
    let (mut window, rows) = fabric();
    window.click_stitch(rows[2][3], Some(1), Modifiers::ALT);
    window.press("Finish");
    window.press("Vermilion");
    window.press("Dye the selection");
    let dyes = window.editor().project().fabric().unwrap().stitches.dyes().to_vec();
    let dyed: Vec<u32> =
        (0..dyes.len() as u32).filter(|f| dyes[*f as usize] == Dye([0xd5, 0x5e, 0])).collect();
    let mut row = rows[2].clone();
    row.sort_unstable();
    assert_eq!(dyed, row);

    window.key(NONE, Key::P);
    window.key(NONE, Key::Escape);
    window.harness.remove_cursor();
    window.press("Palette");
    window.press("k1 · k tbl · knit through the back loop");
    window.key(NONE, Key::Escape);
    window.harness.hover_at(window.at_stitch(rows[0][1], None));
    window.key(NONE, Key::F);
    assert_eq!(window.stitches(&[rows[0][0], rows[1][5], rows[2][3], rows[3][3]]), ["k1", "k1", "p", "k"]);
}

#[test]
fn patterns_keep_to_the_selection() {
    let (mut window, rows) = fabric();
    window.click_stitch(rows[2][3], Some(1), Modifiers::ALT);
    window.press("Rib");
    assert!("kkppkkppkkppkkpp".starts_with(&window.stitches(&rows[2]).concat()));
    assert!(window.stitches(&rows[1]).iter().all(|s| s == "k"));
}

#[test]
fn counts_are_changed_at_edges_and_their_consequences_are_told_before() {
    let labelled = Command::Autolabel.apply(&swatch()).unwrap();
    let mut window = Window::new(Command::Tessellate { width_mm: Some(16.0) }.apply(&labelled).unwrap());
    window.press("Labels");
    window.press("Front");
    let count = |window: &Window| window.editor().project().fabric().unwrap().stitches.stitches().len();
    let before = count(&window);
    window.click_side(0, 0, NONE);
    window.press("+");
    assert!(window.says("1 increases") || window.says("1 decreases"), "the consequences");
    window.keep("counts");
    assert_eq!(count(&window), before, "nothing is done yet");
    window.press("Tessellate");
    let stitches = &window.editor().project().fabric().unwrap().stitches;
    let uneven = stitches.stitches().iter().filter(|s| s.bottoms() != s.tops()).count();
    assert_eq!(uneven, 1);
}

#[test]
fn relaxing_moves_the_stitches_and_keeps_them() {
    let (mut window, _) = fabric();
    let mesh = |window: &Window| window.editor().project().fabric().unwrap().stitches.mesh().clone();
    let before = mesh(&window);
    window.press("Finish");
    window.press("Relax mesh");
    let after = mesh(&window);
    assert!(before.positions() != after.positions());
    assert_eq!(before.face_lists(), after.face_lists());
    assert!(window.says("Relax"), "in the history");
}

#[test]
fn long_work_can_be_given_up() {
    let labelled = Command::Autolabel.apply(&swatch()).unwrap();
    let mut window = Window::new(Command::Tessellate { width_mm: Some(0.4) }.apply(&labelled).unwrap());
    window.press("Stitches");
    window.press("Finish");
    let before = window.editor().project().fabric().unwrap().stitches.clone();
    use egui_kittest::kittest::Queryable as _;
    window.harness.get_by_label("Relax mesh").click();
    window.wait("the button", |_| true);
    let mut cancelled = false;
    for _ in 0..400 {
        window.harness.step();
        if let Some(button) = window.harness.query_by_label("Cancel") {
            button.click();
            cancelled = true;
            break;
        }
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    assert!(cancelled, "there is a button while it works");
    window.rest();
    assert!(window.says("cancelled"));
    let after = &window.editor().project().fabric().unwrap().stitches;
    assert!(std::sync::Arc::ptr_eq(&before, after), "the document is as it was");
    assert_eq!(window.editor().project().fabric().unwrap().stitches.stitch(FaceId(0)).to_string(), "k");
}

#[test]
fn a_patch_is_copied_mirrored_and_pasted() {
    let (mut window, rows) = fabric();
    window.click_stitch(rows[0][0], None, NONE);
    window.key(NONE, Key::P);
    window.click_stitch(rows[0][1], None, Modifiers::SHIFT);
    window.key(Modifiers::COMMAND, Key::C);
    window.harness.hover_at(window.at_stitch(rows[3][4], None));
    window.key(Modifiers::COMMAND, Key::V);
    assert_eq!(window.stitches(&rows[3][4..6]), ["p", "k"]);
    window.key(Modifiers::COMMAND, Key::M);
    window.harness.hover_at(window.at_stitch(rows[5][4], None));
    window.key(Modifiers::COMMAND, Key::V);
    assert_eq!(window.stitches(&rows[5][4..6]), ["k", "p"]);
}

#[test]
fn structure_changes_at_one_edge() {
    let (mut window, rows) = fabric();
    window.press("Finish");
    window.key(NONE, Key::Num1);
    window.click_stitch(rows[3][4], Some(0), NONE);
    let loops = |window: &Window| window.editor().project().fabric().unwrap().stitches.loop_count();
    let before = loops(&window);
    window.press("Split loop");
    assert_eq!(loops(&window), before + 1);
    assert_eq!(window.editor().selection().edges.len(), 0, "numbers of edges mean something else now");
    window.key(Modifiers::COMMAND, Key::Z);
    assert_eq!(loops(&window), before);
    window.key(NONE, Key::Num2);
    window.click_stitch(rows[3][4], None, NONE);
    let faces = |window: &Window| window.editor().project().fabric().unwrap().stitches.stitches().len();
    let before = faces(&window);
    window.press("Divide stitch");
    assert_eq!(faces(&window), before + 1);
}

/// Writes into a text field in place of what stands there.
fn write(window: &mut Window, field: &str, text: &str) {
    use egui_kittest::kittest::Queryable as _;
    window.harness.get_by_label(field).focus();
    window.harness.step();
    window.harness.key_press_modifiers(Modifiers::COMMAND, Key::A);
    window.harness.step();
    window.harness.get_by_label(field).type_text(text);
    window.rest();
}

#[test]
fn strands_of_a_cable_are_written_out() {
    let (mut window, rows) = fabric();
    window.key(NONE, Key::Num1);
    for (i, face) in rows[3][2..7].iter().enumerate() {
        window.click_stitch(*face, Some(0), if i == 0 { NONE } else { Modifiers::SHIFT });
    }
    let cables = |window: &Window| {
        let fabric = window.editor().project().fabric().unwrap();
        let of = |c: &stitch_mesh::cable::Cable| (c.strands.clone(), c.order.clone(), c.front.clone());
        fabric.stitches.cables().iter().map(of).collect::<Vec<_>>()
    };
    window.press("Finish");
    for (loops, above, front) in [("3/2", "BA", "AB"), ("2/1/2", "CBA", "ACB")] {
        write(&mut window, "Strands", loops);
        write(&mut window, "Above", above);
        write(&mut window, "In front", front);
        window.press("Cross strands");
        assert!(!window.says("Cross strands:"));
    }
    assert_eq!(cables(&window), [(vec![2, 1, 2], vec![2, 1, 0], vec![0, 2, 1])], "in place of the first");
    window.keep("plait");
    window.press("Yarn");
    window.press("Front");
    window.keep("plait-yarn");
    window.key(Modifiers::COMMAND, Key::Z);
    assert_eq!(cables(&window), [(vec![3, 2], vec![1, 0], vec![0, 1])]);
    window.press("Finish");
    write(&mut window, "Strands", "2/2");
    window.press("Cross strands");
    assert!(window.says("the strands have 4 loops, but the cable lies on 5 course edges"));
}

#[test]
fn stitches_have_the_colours_that_are_chosen() {
    let (mut window, rows) = fabric();
    window.click_stitch(rows[2][3], Some(1), Modifiers::ALT);
    window.key(NONE, Key::P);
    window.key(NONE, Key::Escape);
    let before = window.keep("colours-distinct");
    window.press("⚙ Settings");
    window.press("As in the paper");
    window.key(NONE, Key::Escape);
    let paper = window.keep("colours-paper");
    assert!(paper != before);
    window.press("⚙ Settings");
    window.press("Distinct");
    window.key(NONE, Key::Escape);
    assert!(window.keep("colours-distinct") == before);
}

#[test]
fn single_stitches_are_wrapped_otherwise() {
    use egui_kittest::kittest::Queryable as _;
    let (mut window, rows) = fabric();
    window.press("Finish");
    window.click_stitch(rows[2][3], None, NONE);
    window.harness.get_by_label("Modulus").click();
    window.harness.step();
    window.harness.get_by_label("Modulus").type_text("0.5");
    window.key(NONE, Key::Enter);
    window.press("Wrap");
    let wrapping = |window: &Window, face: u32| {
        window.editor().project().fabric().unwrap().stitches.wrappings()[face as usize]
    };
    let of_material = wrapping(&window, rows[2][4]);
    assert_eq!((wrapping(&window, rows[2][3]).modulus, wrapping(&window, rows[2][3]).angle), (0.5, None));
    assert_eq!((of_material.modulus, of_material.angle), (1.0, None));
    window.press("Angle of the material");
    window.press("Wrap");
    window.keep("wrapping");
    let right = std::f64::consts::FRAC_PI_2;
    assert!(wrapping(&window, rows[2][3]).angle.is_some_and(|a| (a - right).abs() < 1e-12));
}

/// Between two frames the pointer may pass over several stitches.
#[test]
fn a_quick_stroke_of_the_brush_leaves_no_gaps() {
    let (mut window, rows) = fabric();
    window.key(NONE, Key::D);
    let [from, to] = [1, 5].map(|i| window.at_stitch(rows[2][i], None));
    window.harness.hover_at(from);
    let button = |pos, pressed| egui::Event::PointerButton {
        pos,
        button: egui::PointerButton::Primary,
        pressed,
        modifiers: NONE,
    };
    window.harness.event(button(from, true));
    window.harness.step();
    window.harness.hover_at(to);
    window.harness.event(button(to, false));
    window.rest();
    assert_eq!(window.stitches(&rows[2][..7]).concat(), "kpppppk");
    window.key(Modifiers::COMMAND, Key::Z);
    assert_eq!(window.purls(), 0, "one step");
}
