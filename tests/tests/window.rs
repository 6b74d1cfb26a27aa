//! The window, with mouse and keys: everything in it except the window itself, on the graphics adapter of this machine.

#![allow(clippy::unwrap_used, clippy::panic, reason = "helpers of tests are tests, which clippy cannot see")]

use app::command::Command;
use app::drawing::Stage;
use app::project::Project;
use app::window::editor::Editor;
use app::window::screen::Screen;
use egui::{Event, Key, Modifiers, PointerButton, Pos2, Rect, pos2};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use egui_kittest::wgpu::{WgpuTestRenderer, create_render_state, default_wgpu_setup};
use egui_wgpu::RendererOptions;
use glam::{DVec3, Vec4};
use render::{Bounds, Camera, Gpu, NamedView};
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::time::{Duration, Instant};
use stitch_mesh::edge_counts::StitchSize;
use stitch_mesh::ids::FaceId;
use stitch_mesh::obj::Unit;
use stitch_mesh::stitch::Stitch;
use tests::{asset, picture_folder, say};

/// The editor in a window of the size it opens with.
struct Window {
    harness: Harness<'static, Editor>,
    /// Dropped with the window, which ends the watch.
    _watch: Sender<()>,
}

/// Ends the tests where a frame never comes back: nothing else would.
fn watch() -> Sender<()> {
    let (watched, gone) = channel();
    std::thread::spawn(move || {
        if gone.recv_timeout(Duration::from_secs(90)) == Err(RecvTimeoutError::Timeout) {
            say("the window hangs: a frame has not come back");
            std::process::exit(101);
        }
    });
    watched
}

impl Window {
    fn new(project: Project) -> Self {
        let painter = create_render_state(default_wgpu_setup(), RendererOptions::PREDICTABLE);
        let gpu = Gpu::new(&painter.adapter, &painter.device, &painter.queue);
        let screen = Screen::new(gpu, painter.renderer.clone()).unwrap();
        let editor = Editor::new(project, None, Some(screen), || ()).unwrap();
        let harness = Harness::builder()
            .with_size([1360.0, 860.0])
            .with_accessibility_check(false) // at every step; here once, in a test of its own
            .renderer(WgpuTestRenderer::from_render_state(painter))
            .build_ui_state(|ui, editor: &mut Editor| editor.ui(ui), editor);
        let mut window = Self { harness, _watch: watch() };
        window.rest();
        window
    }

    fn editor(&self) -> &Editor {
        self.harness.state()
    }

    /// Frames until something is so.
    #[track_caller]
    fn wait(&mut self, what: &str, is: impl Fn(&Editor) -> bool) {
        let deadline = Instant::now() + Duration::from_secs(60);
        loop {
            self.harness.step();
            if is(self.editor()) {
                return;
            }
            assert!(Instant::now() < deadline, "{what}: not within a minute");
            std::thread::sleep(Duration::from_millis(5));
        }
    }

    /// Frames until all requests are carried out and shown.
    #[track_caller]
    fn rest(&mut self) {
        self.harness.step();
        self.wait("rest", Editor::is_idle);
        self.harness.step();
    }

    /// Clicks a button.
    #[track_caller]
    fn press(&mut self, label: &str) {
        self.harness.get_by_label(label).click();
        self.rest();
    }

    #[track_caller]
    fn key(&mut self, modifiers: Modifiers, key: Key) {
        self.harness.key_press_modifiers(modifiers, key);
        self.rest();
    }

    /// Where the picture is, between the panels.
    fn viewport(&self) -> Rect {
        let panel = |name: &str| {
            egui::PanelState::load(&self.harness.ctx, self.harness.ui_id().with(name)).unwrap().outer_rect
        };
        let (top, status, left, right) = (panel("top"), panel("status"), panel("tools"), panel("facts"));
        Rect::from_min_max(pos2(left.max.x, top.max.y), pos2(right.min.x, status.min.y))
    }

    /// Where a point of the fabric is on the screen, right after the button Front was pressed.
    fn on_screen(&self, point: DVec3, shown: impl IntoIterator<Item = DVec3>) -> Pos2 {
        let rect = self.viewport();
        let bounds = Bounds::of(shown.into_iter().map(|p| p.as_vec3())).unwrap();
        let camera = Camera::named(NamedView::Front, bounds, rect.aspect_ratio());
        let p: Vec4 = camera.view_projection(rect.aspect_ratio()) * point.as_vec3().extend(1.0);
        rect.min + rect.size() * egui::vec2(0.5 + 0.5 * p.x / p.w, 0.5 - 0.5 * p.y / p.w)
    }

    #[track_caller]
    fn click(&mut self, at: Pos2, modifiers: Modifiers) {
        assert!(self.viewport().contains(at), "{at} is outside of the viewport");
        let button =
            |pressed| Event::PointerButton { pos: at, button: PointerButton::Primary, pressed, modifiers };
        self.harness.hover_at(at);
        self.harness.event(Event::ModifiersChanged(modifiers));
        self.harness.event(button(true));
        self.harness.event(button(false));
        self.harness.event(Event::ModifiersChanged(Modifiers::NONE));
        self.rest();
    }

    /// Clicks inside a face of the labelled mesh, near one of its sides: 0 below, 1 right, 2 above, 3 left.
    #[track_caller]
    fn click_side(&mut self, face: u32, side: usize, modifiers: Modifiers) {
        let mesh = self.editor().project().labelled.mesh();
        let corners: Vec<DVec3> = mesh.face_vertices(FaceId(face)).map(|v| mesh.position(v)).collect();
        let middle = corners.iter().sum::<DVec3>() / corners.len() as f64;
        let side = (corners[side] + corners[(side + 1) % corners.len()]) / 2.0;
        let at = self.on_screen(side.lerp(middle, 0.2), mesh.positions().iter().copied());
        self.click(at, modifiers);
    }

    /// Keeps a picture to look at.
    fn keep(&mut self, name: &str) -> image::RgbaImage {
        self.harness.remove_cursor();
        self.harness.run_steps(3);
        let image = self.harness.render().unwrap();
        image.save(picture_folder().join(format!("window-{name}.png"))).unwrap();
        image
    }

    fn labelled_faces(&self) -> usize {
        let labelled = &self.editor().project().labelled;
        labelled.mesh().faces().filter(|f| labelled.wales(*f).is_some()).count()
    }

    fn purls(&self) -> usize {
        let Some(fabric) = &self.editor().project().fabric else { return 0 };
        fabric.stitches.stitches().iter().filter(|s| **s == Stitch::purl()).count()
    }

    fn simulated(&self) -> f64 {
        self.editor().yarn().map_or(0.0, |s| s.time_s)
    }
}

fn swatch() -> Project {
    Project::from_obj(asset("swatch").as_ref(), Unit::M, StitchSize::of_width(0.012)).unwrap()
}

/// A swatch of few stitches, so that simulating it takes no time.
fn knitted() -> Project {
    let labelled = Command::Autolabel.apply(&swatch()).unwrap();
    Command::Tessellate { width_mm: Some(16.0) }.apply(&labelled).unwrap()
}

#[test]
fn labels_come_with_clicks_and_go_with_a_button() {
    let mut window = Window::new(swatch());
    let faces = window.editor().project().labelled.mesh().face_count();
    window.press("Front");
    assert_eq!(window.labelled_faces(), 0);
    assert!(window.harness.get_by_label("Tessellate").accesskit_node().is_disabled());

    window.click_side(0, 0, Modifiers::NONE);
    let row = window.labelled_faces();
    assert!(row > 1 && row < faces, "one row of {faces} faces: {row}");
    window.keep("one-row");
    window.click_side(0, 2, Modifiers::NONE);
    assert_eq!(window.labelled_faces(), 2 * row, "the next row from its course edge");
    window.key(Modifiers::COMMAND, Key::Z);
    assert_eq!(window.labelled_faces(), row);
    window.click_side(0, 2, Modifiers::SHIFT);
    assert_eq!(window.labelled_faces(), faces, "all rows onwards");
    window.keep("all-rows");

    window.press("Clear labels");
    assert_eq!(window.labelled_faces(), 0);
    window.press("Label automatically");
    assert_eq!(window.labelled_faces(), faces);
    assert!(!window.harness.get_by_label("Tessellate").accesskit_node().is_disabled());
    window.press("Tessellate");
    let fabric = window.editor().project().fabric().unwrap();
    assert_eq!(fabric.stitches.stitches().len(), fabric.stitches.mesh().face_count());
    assert!(fabric.stitches.mesh().face_count() > faces);
    window.keep("stitches");
}

#[test]
fn tabs_show_the_stages() {
    let mut window = Window::new(knitted());
    let mut pictures = Vec::new();
    for (tab, key) in
        [("Mesh", Key::Num1), ("Labels", Key::Num2), ("Stitches", Key::Num3), ("Yarn", Key::Num4)]
    {
        window.press(tab);
        window.press("Front");
        let by_click = window.keep(&format!("stage-{}", tab.to_lowercase()));
        window.press("Mesh");
        window.key(Modifiers::NONE, key);
        let by_key = window.keep("stage-by-key");
        assert!(by_click == by_key, "{tab} by click and by key");
        pictures.push(by_click);
    }
    for (i, a) in pictures.iter().enumerate() {
        assert!(pictures[..i].iter().all(|b| b != a), "{:?} looks like another stage", Stage::ALL[i]);
    }
}

#[test]
fn a_painted_row_shows_plays_undoes_and_is_saved() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("painted.purl");
    let mut window = Window::new(knitted());
    window.press("Stitches");
    window.press("Front");
    window.press("Row");
    let fabric = window.editor().project().fabric().unwrap().clone();
    let mesh = fabric.stitches.mesh();
    let row = fabric.stitches.rows()[2].faces.clone();
    let corners: Vec<DVec3> = mesh.face_vertices(row[1]).map(|v| mesh.position(v)).collect();
    let middle = corners.iter().sum::<DVec3>() / corners.len() as f64;
    let at = window.on_screen(middle, mesh.positions().iter().copied());
    window.click(at, Modifiers::NONE);
    assert_eq!(window.purls(), row.len());
    let is_purl =
        |f: &FaceId| *window.editor().project().fabric().unwrap().stitches.stitch(*f) == Stitch::purl();
    assert!(row.iter().all(is_purl));
    window.keep("painted");

    window.press("Yarn");
    window.key(Modifiers::NONE, Key::Space);
    window.wait("playing", |e| e.yarn().is_some_and(|s| s.playing && s.time_s > 0.02));
    window.key(Modifiers::NONE, Key::Space);
    window.wait("pausing", |e| e.yarn().is_some_and(|s| !s.playing));
    let time = window.simulated();
    window.rest();
    assert_eq!(window.simulated(), time, "time stands still");
    assert!(window.editor().yarn().unwrap().error.is_none());
    window.keep("played");

    window.harness.get_by_role(egui::accesskit::Role::TextInput).focus();
    window.harness.step();
    window.harness.get_by_role(egui::accesskit::Role::TextInput).type_text(path.to_str().unwrap());
    window.rest();
    window.press("Save");
    let saved = Project::open(&path).unwrap();
    let (saved, shown) = (saved.fabric.unwrap(), window.editor().project().fabric().unwrap());
    assert_eq!(saved.stitches, shown.stitches);
    assert_eq!(
        *saved.state.unwrap(),
        window.editor().yarn().unwrap().state,
        "saved with the yarn as it is shown"
    );

    window.key(Modifiers::COMMAND, Key::Z);
    assert_eq!(window.purls(), 0);
    window.key(Modifiers::COMMAND | Modifiers::SHIFT, Key::Z);
    assert_eq!(window.purls(), row.len());
}

#[test]
fn painting_while_it_plays_keeps_it_playing() {
    // Garter stays flat: on a slow machine the yarn has not gone from under the pointer between two frames.
    let garter = Command::SetChart { chart: vec!["k".into(), "p".into()], rows: None, faces: None };
    let mut window = Window::new(garter.apply(&knitted()).unwrap());
    let purls_before = window.purls();
    window.press("Yarn");
    window.press("Front");
    window.press("Row");
    let fabric = window.editor().project().fabric().unwrap().clone();
    let state = fabric.state();
    let row = fabric.stitches.rows()[2].faces.clone();
    window.key(Modifiers::NONE, Key::Space);
    window.wait("playing", |e| e.yarn().is_some_and(|s| s.time_s > 0.01));
    // Where the stitch is by now; the camera still looks at where the yarn was laid.
    let now = window.editor().yarn().unwrap().state.position.clone();
    let nodes = fabric.net.nodes.iter().zip(&now).filter(|(n, _)| n.face == Some(row[2]));
    let nodes: Vec<DVec3> = nodes.map(|(_, p)| *p).collect();
    let middle = nodes.iter().sum::<DVec3>() / nodes.len() as f64;
    let at = window.on_screen(middle, state.position.iter().copied());
    window.click(at, Modifiers::NONE);
    assert_eq!(window.purls(), purls_before + row.len());
    window.wait("playing on", |e| e.yarn().is_some_and(|s| s.playing && s.time_s > 0.05));
    assert!(window.editor().yarn().unwrap().state.is_finite());
    window.keep("painted-while-playing");
}

#[test]
fn laying_anew_puts_the_yarn_back_and_undo_brings_it_again() {
    let mut window = Window::new(knitted());
    window.press("Yarn");
    let laid = window.editor().project().fabric().unwrap().net.laid_state().position;
    let moved = move |e: &Editor| {
        let now = &e.yarn().unwrap().state.position;
        laid.iter().zip(now).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max)
    };
    window.key(Modifiers::NONE, Key::Space);
    window.wait("moved", |e| e.yarn().is_some() && moved(e) > 1e-3);
    window.key(Modifiers::NONE, Key::Space);
    window.press("Lay anew");
    // The simulation stirs what it is given by a thousandth of a millimetre.
    window.wait("laid anew", |e| e.yarn().is_some() && moved(e) < 1e-5);
    window.key(Modifiers::COMMAND, Key::Z);
    window.wait("undone", |e| e.yarn().is_some() && moved(e) > 1e-3);
}

#[test]
fn what_cannot_be_done_is_said() {
    let mut window = Window::new(swatch());
    window.press("Save");
    window.harness.get_by_label("give the project a name first, in the field beside Save");
    assert!(window.harness.get_by_label("Yarn").accesskit_node().is_disabled());
    window.key(Modifiers::COMMAND, Key::Z);
    window.harness.get_by_label("there is nothing to undo");
}

#[test]
fn every_control_has_a_name_for_screen_readers() {
    let mut window = Window::new(knitted());
    for tab in ["Mesh", "Labels", "Stitches", "Yarn"] {
        window.press(tab);
        window.harness.check_accessibility();
    }
}
