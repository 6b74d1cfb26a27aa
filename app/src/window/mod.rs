//! The window: winit's events in, egui and the renderer out. All that is in the window is in [`editor`].

mod actions;
mod catalogue;
pub mod chart;
mod clipboard;
pub mod editor;
mod legend;
mod meant;
mod navigation;
mod news;
mod numbers;
mod panels;
mod paste;
mod picture;
mod pointer;
pub mod request;
mod runs;
mod scissors;
pub mod screen;
mod search;
pub mod selection;
pub mod session;
mod strung;
mod surface;
pub mod view;
mod viewport;

use crate::bundled;
use crate::project::Project;
use anyhow::{Context, Result};
use editor::Editor;
use egui_wgpu::wgpu;
use render::Gpu;
use screen::Screen;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Instant;
use winit::application::ApplicationHandler;
use winit::event::WindowEvent;
use winit::event_loop::{ActiveEventLoop, ControlFlow, EventLoop, EventLoopProxy};
use winit::window::{Window, WindowId};

/// Asks for a frame from another thread.
struct Wake;

/// Opens the window on a project, or on the bundled pullover, and runs until it is closed.
///
/// # Errors
/// There is no display, or no graphics adapter.
pub fn run(project: Option<Project>, path: Option<PathBuf>) -> Result<()> {
    let project = project.map_or_else(bundled::pullover, Ok)?;
    let events = EventLoop::<Wake>::with_user_event()
        .build()
        .context("cannot open a window (on a machine without a display use `purlwise demo`)")?;
    let mut application = Application {
        start: Some((project, path)),
        proxy: events.create_proxy(),
        shown: None,
        failure: None,
        repaint_at: None,
    };
    events.run_app(&mut application)?;
    application.failure.map_or(Ok(()), Err)
}

struct Application {
    start: Option<(Project, Option<PathBuf>)>,
    proxy: EventLoopProxy<Wake>,
    shown: Option<Shown>,
    failure: Option<anyhow::Error>,
    repaint_at: Option<Instant>,
}

/// An open window.
struct Shown {
    window: Arc<Window>,
    surface: wgpu::Surface<'static>,
    config: wgpu::SurfaceConfiguration,
    device: wgpu::Device,
    queue: wgpu::Queue,
    painter: egui_wgpu::Renderer,
    input: egui_winit::State,
    editor: Editor,
}

impl ApplicationHandler<Wake> for Application {
    fn resumed(&mut self, events: &ActiveEventLoop) {
        if let Some((project, path)) = self.start.take() {
            match Shown::open(events, project, path, self.proxy.clone()) {
                Ok(shown) => self.shown = Some(shown),
                Err(error) => {
                    self.failure = Some(error);
                    events.exit();
                }
            }
        }
    }

    fn user_event(&mut self, _: &ActiveEventLoop, Wake: Wake) {
        if let Some(shown) = &self.shown {
            shown.window.request_redraw();
        }
    }

    fn window_event(&mut self, events: &ActiveEventLoop, _: WindowId, event: WindowEvent) {
        let Some(shown) = &mut self.shown else { return };
        match &event {
            WindowEvent::CloseRequested => {
                shown.editor.close();
                shown.window.request_redraw();
            }
            WindowEvent::Resized(size) => shown.resize(size.width, size.height),
            WindowEvent::RedrawRequested => {
                self.repaint_at = match shown.draw() {
                    Ok(delay) => delay.and_then(|d| Instant::now().checked_add(d)),
                    Err(error) => {
                        self.failure = Some(error);
                        return events.exit();
                    }
                };
                if shown.editor.is_closed() {
                    events.exit();
                }
                return; // egui-winit answers this event with "repaint", which would never end
            }
            _ => {}
        }
        if shown.input.on_window_event(&shown.window, &event).repaint {
            shown.window.request_redraw();
        }
    }

    fn about_to_wait(&mut self, events: &ActiveEventLoop) {
        let Some(shown) = &self.shown else { return };
        match self.repaint_at {
            Some(at) if at <= Instant::now() => {
                self.repaint_at = None;
                shown.window.request_redraw();
                events.set_control_flow(ControlFlow::Wait);
            }
            Some(at) => events.set_control_flow(ControlFlow::WaitUntil(at)),
            None => events.set_control_flow(ControlFlow::Wait),
        }
    }

    fn exiting(&mut self, _: &ActiveEventLoop) {
        self.shown = None;
    }
}

impl Shown {
    fn open(
        events: &ActiveEventLoop,
        project: Project,
        path: Option<PathBuf>,
        proxy: EventLoopProxy<Wake>,
    ) -> Result<Self> {
        let attributes = Window::default_attributes()
            .with_title("Purlwise")
            .with_inner_size(winit::dpi::LogicalSize::new(1360.0, 860.0));
        let window = Arc::new(events.create_window(attributes)?);
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_with_display_handle_from_env(
            Box::new(events.owned_display_handle()),
        ));
        let surface = instance.create_surface(window.clone())?;
        let adapter = pollster::block_on(instance.request_adapter(&wgpu::RequestAdapterOptions {
            power_preference: wgpu::PowerPreference::HighPerformance,
            compatible_surface: Some(&surface),
            ..Default::default()
        }))
        .map_err(|_| render::RenderError::NoAdapter)?;
        let (device, queue) = pollster::block_on(adapter.request_device(&wgpu::DeviceDescriptor {
            label: Some("window"),
            required_limits: adapter.limits(),
            ..Default::default()
        }))?;
        let size = window.inner_size();
        let mut config = surface
            .get_default_config(&adapter, size.width.max(1), size.height.max(1))
            .context("the window's surface does not go with the graphics adapter")?;
        config.present_mode = wgpu::PresentMode::AutoVsync;
        // egui mixes colours as sRGB values: a format that does not convert them is what it asks for.
        config.format = config.format.remove_srgb_suffix();
        surface.configure(&device, &config);
        let painter = egui_wgpu::Renderer::new(&device, config.format, egui_wgpu::RendererOptions::default());
        let context = egui::Context::default();
        // A frame begins with the colour of the panels, which is cheaper than to paint them.
        context.all_styles_mut(|style| style.visuals.panel_fill = egui::Color32::TRANSPARENT);
        // Pure red on dark grey is hard to read.
        context.style_mut_of(egui::Theme::Dark, |style| {
            style.visuals.error_fg_color = egui::Color32::from_rgb(255, 128, 112);
        });
        let input = egui_winit::State::new(
            context,
            egui::ViewportId::ROOT,
            &window,
            Some(window.scale_factor() as f32),
            window.theme(),
            Some(device.limits().max_texture_dimension_2d as usize),
        );
        let screen = Screen::new(Gpu::new(&adapter, &device, &queue)?, config.format)?;
        let wake = move || {
            // The loop is gone only when the program ends.
            let _ = proxy.send_event(Wake);
        };
        let editor = Editor::new(project, path, Some(screen), wake)?;
        Ok(Self { window, surface, config, device, queue, painter, input, editor })
    }

    fn resize(&mut self, width: u32, height: u32) {
        if width > 0 && height > 0 {
            (self.config.width, self.config.height) = (width, height);
            self.surface.configure(&self.device, &self.config);
            self.window.request_redraw();
        }
    }

    /// Draws a frame. Returns when egui wants the next one by itself.
    fn draw(&mut self) -> Result<Option<std::time::Duration>> {
        let context = self.input.egui_ctx().clone();
        let input = self.input.take_egui_input(&self.window);
        let mut output = context.run_ui(input, |ui| self.editor.ui(ui));
        self.input.handle_platform_output(&self.window, std::mem::take(&mut output.platform_output));
        let delay = output.viewport_output.get(&egui::ViewportId::ROOT).map(|o| o.repaint_delay);
        let jobs = context.tessellate(std::mem::take(&mut output.shapes), output.pixels_per_point);
        let screen = egui_wgpu::ScreenDescriptor {
            size_in_pixels: [self.config.width, self.config.height],
            pixels_per_point: output.pixels_per_point,
        };
        let painter = &mut self.painter;
        for (id, deltas) in std::mem::take(&mut output.textures_delta.set) {
            for delta in deltas {
                painter.update_texture(&self.device, &self.queue, id, &delta);
            }
        }
        let frame = match self.surface.get_current_texture() {
            wgpu::CurrentSurfaceTexture::Success(frame) | wgpu::CurrentSurfaceTexture::Suboptimal(frame) => {
                Some(frame)
            }
            wgpu::CurrentSurfaceTexture::Outdated | wgpu::CurrentSurfaceTexture::Lost => {
                self.surface.configure(&self.device, &self.config);
                self.window.request_redraw();
                None
            }
            _ => None,
        };
        if let Some(frame) = frame {
            let view = frame.texture.create_view(&Default::default());
            let [r, g, b, a] =
                context.global_style().visuals.window_fill.to_array().map(|value| f64::from(value) / 255.0);
            let ground = wgpu::Color { r, g, b, a };
            let mut encoder = self.device.create_command_encoder(&Default::default());
            let uploads = painter.update_buffers(&self.device, &self.queue, &mut encoder, &jobs, &screen);
            {
                let mut pass = encoder
                    .begin_render_pass(&wgpu::RenderPassDescriptor {
                        label: Some("egui"),
                        color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                            view: &view,
                            resolve_target: None,
                            depth_slice: None,
                            ops: wgpu::Operations {
                                load: wgpu::LoadOp::Clear(ground),
                                store: wgpu::StoreOp::Store,
                            },
                        })],
                        ..Default::default()
                    })
                    .forget_lifetime();
                painter.render(&mut pass, &jobs, &screen);
            }
            self.queue.submit(uploads.into_iter().chain([encoder.finish()]));
            self.window.pre_present_notify();
            self.queue.present(frame);
        }
        for id in std::mem::take(&mut output.textures_delta.free) {
            painter.free_texture(&id);
        }
        Ok(delay.filter(|d| *d < std::time::Duration::from_secs(3600)))
    }
}
