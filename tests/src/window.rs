//! The window with mouse and keys, for tests: everything in it except the window itself, on the graphics adapter of this machine.

use crate::{asset, picture_folder, say};
use app::command::Command;
use app::project::Project;
use app::window::editor::Editor;
use app::window::screen::Screen;
use egui::{Event, Key, Modifiers, PointerButton, Pos2, Rect, pos2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;
use egui_kittest::wgpu::{WgpuTestRenderer, create_render_state, default_wgpu_setup};
use egui_wgpu::RendererOptions;
use glam::{DVec3, Vec4};
use render::{Bounds, Camera, Gpu, NamedView};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::time::{Duration, Instant};
use stitch_mesh::edge_counts::StitchSize;
use stitch_mesh::ids::FaceId;
use stitch_mesh::mesh::PolygonMesh;
use stitch_mesh::obj::Unit;
use stitch_mesh::stitch::Stitch;

/// The editor in a window of the size it opens with.
pub struct Window {
    /// The harness.
    pub harness: Harness<'static, Editor>,
    gpu: Gpu,
    /// Told whenever there is something new to see.
    woken: Receiver<()>,
    /// Told whenever the window is at rest; dropped with it, which ends the watch.
    watch: Sender<()>,
}

/// Ends the tests where a frame never comes back: nothing else would.
fn watch() -> Sender<()> {
    let (watched, gone) = channel();
    std::thread::spawn(move || {
        loop {
            match gone.recv_timeout(Duration::from_secs(90)) {
                Ok(()) => {}
                Err(RecvTimeoutError::Disconnected) => return,
                Err(RecvTimeoutError::Timeout) => {
                    say("the window hangs: a frame has not come back");
                    std::process::exit(101);
                }
            }
        }
    });
    watched
}

impl Window {
    /// Opens it on a project.
    pub fn new(project: Project) -> Self {
        let painter = create_render_state(default_wgpu_setup(), RendererOptions::PREDICTABLE);
        let gpu = Gpu::new(&painter.adapter, &painter.device, &painter.queue).unwrap();
        let screen = Screen::new(gpu.clone(), painter.target_format).unwrap();
        let (wake, woken) = channel();
        // Whoever wakes the window after it has gone wakes nobody.
        let wake = move || wake.send(()).unwrap_or_default();
        let editor = Editor::new(project, None, Some(screen), wake).unwrap();
        let harness = Harness::builder()
            .with_size([1360.0, 860.0])
            .with_step_dt(1.0 / 60.0) // two clicks in as many frames are a double click
            .with_accessibility_check(false) // at every step; here once, in a test of its own
            .renderer(WgpuTestRenderer::from_render_state(painter))
            .build_ui_state(|ui, editor: &mut Editor| editor.ui(ui), editor);
        let mut window = Self { harness, gpu, woken, watch: watch() };
        window.rest();
        window
    }

    /// The editor in it.
    pub fn editor(&self) -> &Editor {
        self.harness.state()
    }

    /// Frames until something is so.
    #[track_caller]
    pub fn wait(&mut self, what: &str, is: impl Fn(&Editor) -> bool) {
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
    pub fn rest(&mut self) {
        self.harness.step();
        self.wait("rest", Editor::is_idle);
        self.harness.step();
        // The watch ends only with the program.
        let _ = self.watch.send(());
    }

    /// Frames until something is so and drawn. No picture is fetched.
    pub fn show(&mut self, is: impl Fn(&Editor) -> bool) {
        loop {
            while self.woken.try_recv().is_ok() {}
            self.harness.step();
            if is(self.editor()) {
                break;
            }
            // It sleeps until it is woken, or has something to move itself.
            let _ = self.woken.recv_timeout(Duration::from_millis(100));
        }
        self.gpu.device.poll(egui_wgpu::wgpu::PollType::wait_indefinitely()).unwrap();
    }

    /// Clicks a button.
    #[track_caller]
    pub fn press(&mut self, label: &str) {
        self.harness.get_by_label(label).click();
        self.rest();
    }

    /// Presses a key.
    #[track_caller]
    pub fn key(&mut self, modifiers: Modifiers, key: Key) {
        self.harness.key_press_modifiers(modifiers, key);
        self.rest();
    }

    /// Where the picture is, between the panels.
    pub fn viewport(&self) -> Rect {
        let panel = |name: &str| {
            egui::PanelState::load(&self.harness.ctx, self.harness.ui_id().with(name)).unwrap().outer_rect
        };
        let (top, status, left, right) = (panel("top"), panel("status"), panel("tools"), panel("facts"));
        // The chart, where it is open, stands on the status bar.
        let chart = self.editor().chart_panel();
        let below = chart.map_or(status.min.y, |chart| chart.min.y);
        Rect::from_min_max(pos2(left.max.x, top.max.y), pos2(right.min.x, below))
    }

    /// Where a point of the fabric is on the screen, right after the button Front was pressed.
    pub fn on_screen(&self, point: DVec3, shown: impl IntoIterator<Item = DVec3>) -> Pos2 {
        let rect = self.viewport();
        let bounds = Bounds::of(shown.into_iter().map(|p| p.as_vec3())).unwrap();
        let camera = Camera::named(NamedView::Front, bounds, rect.aspect_ratio());
        let p: Vec4 = camera.view_projection(rect.aspect_ratio()) * point.as_vec3().extend(1.0);
        rect.min + rect.size() * egui::vec2(0.5 + 0.5 * p.x / p.w, 0.5 - 0.5 * p.y / p.w)
    }

    /// Clicks at a place.
    #[track_caller]
    pub fn click(&mut self, at: Pos2, modifiers: Modifiers) {
        self.drag(at, at, modifiers);
    }

    /// Clicks one place after the other, so that all that is there becomes selected.
    pub fn click_all(&mut self, places: &[Pos2]) {
        for (i, at) in places.iter().enumerate() {
            let modifiers = if i == 0 { Modifiers::NONE } else { Modifiers::SHIFT };
            self.harness.hover_at(*at);
            self.harness.event(Event::ModifiersChanged(modifiers));
            for pressed in [true, false] {
                let button = PointerButton::Primary;
                self.harness.event(Event::PointerButton { pos: *at, button, pressed, modifiers });
            }
            self.harness.event(Event::ModifiersChanged(Modifiers::NONE));
            self.harness.step();
        }
        self.rest();
    }

    /// Clicks twice, quickly.
    pub fn double_click(&mut self, at: Pos2) {
        self.harness.hover_at(at);
        for pressed in [true, false, true, false] {
            let modifiers = Modifiers::NONE;
            let button = Event::PointerButton { pos: at, button: PointerButton::Primary, pressed, modifiers };
            self.harness.event(button);
        }
        self.rest();
    }

    /// Presses the left button at one place and releases it at another.
    #[track_caller]
    pub fn drag(&mut self, from: Pos2, to: Pos2, modifiers: Modifiers) {
        for at in [from, to] {
            assert!(self.viewport().contains(at), "{at} is outside of the viewport");
        }
        let button =
            |pos, pressed| Event::PointerButton { pos, button: PointerButton::Primary, pressed, modifiers };
        self.harness.hover_at(from);
        self.harness.event(Event::ModifiersChanged(modifiers));
        self.harness.event(button(from, true));
        if from != to {
            self.harness.hover_at(from.lerp(to, 0.5));
            self.harness.hover_at(to);
        }
        self.harness.event(button(to, false));
        self.harness.event(Event::ModifiersChanged(Modifiers::NONE));
        self.rest();
    }

    /// Where a face is on the screen near one of its sides, counted from its first: of a plain face 0 is below, 1 right,
    /// 2 above, 3 left. None is its middle.
    pub fn at_face(&self, mesh: &PolygonMesh, face: u32, side: Option<usize>) -> Pos2 {
        let corners: Vec<DVec3> = mesh.face_vertices(FaceId(face)).map(|v| mesh.position(v)).collect();
        let middle = corners.iter().sum::<DVec3>() / corners.len() as f64;
        let point = side.map_or(middle, |side| {
            let side = (corners[side] + corners[(side + 1) % corners.len()]) / 2.0;
            side.lerp(middle, 0.2)
        });
        self.on_screen(point, mesh.positions().iter().copied())
    }

    /// Clicks inside a face of the labelled mesh, near one of its sides.
    #[track_caller]
    pub fn click_side(&mut self, face: u32, side: usize, modifiers: Modifiers) {
        let mesh = self.editor().project().labelled.mesh();
        let at = self.at_face(mesh, face, Some(side));
        self.click(at, modifiers);
    }

    /// Clicks a stitch in its middle, or near one of its sides.
    #[track_caller]
    pub fn click_stitch(&mut self, face: u32, side: Option<usize>, modifiers: Modifiers) {
        let at = self.at_stitch(face, side);
        self.click(at, modifiers);
    }

    /// Where a stitch is on the screen, seen from the front.
    pub fn at_stitch(&self, face: u32, side: Option<usize>) -> Pos2 {
        self.at_face(self.editor().project().fabric().unwrap().stitches.mesh(), face, side)
    }

    /// The selected faces.
    pub fn selected(&self) -> Vec<u32> {
        self.editor().selection().faces.iter().map(|f| f.0).collect()
    }

    /// The symbols of some stitches.
    pub fn stitches(&self, faces: &[u32]) -> Vec<String> {
        let fabric = self.editor().project().fabric().unwrap();
        faces.iter().map(|f| fabric.stitches.stitch(FaceId(*f)).to_string()).collect()
    }

    /// Whether some text stands anywhere in the window.
    pub fn says(&self, text: &str) -> bool {
        self.harness.query_all_by_label_contains(text).next().is_some()
    }

    /// Keeps a picture to look at.
    pub fn keep(&mut self, name: &str) -> image::RgbaImage {
        self.harness.remove_cursor();
        self.harness.run_steps(3);
        let image = self.harness.render().unwrap();
        image.save(picture_folder().join(format!("window-{name}.png"))).unwrap();
        image
    }

    /// How many faces have a row.
    pub fn labelled_faces(&self) -> usize {
        let labelled = &self.editor().project().labelled;
        labelled.mesh().faces().filter(|f| labelled.wales(*f).is_some()).count()
    }

    /// How many stitches are purls.
    pub fn purls(&self) -> usize {
        let Some(fabric) = &self.editor().project().fabric else { return 0 };
        fabric.stitches.stitches().iter().filter(|s| **s == Stitch::purl()).count()
    }

    /// How long the yarn has been simulated [s].
    pub fn simulated(&self) -> f64 {
        self.editor().yarn().map_or(0.0, |s| s.time_s)
    }
}

/// The bundled swatch, without labels.
pub fn swatch() -> Project {
    Project::from_obj(asset("swatch").as_ref(), Unit::M, StitchSize::of_width(0.012)).unwrap()
}

/// A swatch of few stitches, so that simulating it takes no time.
pub fn knitted() -> Project {
    let labelled = Command::Autolabel.apply(&swatch()).unwrap();
    Command::Tessellate { width_mm: Some(16.0) }.apply(&labelled).unwrap()
}

/// A window on a small fabric, seen from the front, and the stitches of its rows.
pub fn fabric() -> (Window, Vec<Vec<u32>>) {
    let mut window = Window::new(knitted());
    window.press("Stitches");
    window.press("Front");
    let rows = window.editor().project().fabric().unwrap().stitches.rows();
    let rows = rows.into_iter().map(|r| r.faces.into_iter().map(|f| f.0).collect()).collect();
    (window, rows)
}
