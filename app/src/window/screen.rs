//! The picture in the middle of the window: drawn by the renderer on egui's own device, shown by egui as a texture.

use anyhow::Result;
use egui_wgpu::Renderer as Painter;
use egui_wgpu::wgpu::FilterMode;
use render::{
    Camera, Drawing, Faces, Gpu, LaidRun, LaidYarn, Lines, Quality, Renderer, Scene, Solids, Viewport,
};
use sim_core::{DeviceYarn, SharedGpu, YarnRun};
use std::sync::Arc;
use stitch_mesh::yarn_curves::YarnCurves;

/// egui's painter, which holds the textures that egui can show.
pub type SharedPainter = Arc<egui::mutex::RwLock<Painter>>;

/// Renderer, viewport and what is in it.
pub struct Screen {
    gpu: Gpu,
    painter: SharedPainter,
    renderer: Renderer,
    viewport: Viewport,
    scene: Scene,
    texture: egui::TextureId,
    /// What the picture in the texture was drawn for.
    drawn: Option<([u32; 2], Camera)>,
}

impl Screen {
    /// A screen on the device that egui paints with.
    ///
    /// # Errors
    /// The device cannot hold a viewport.
    pub fn new(gpu: Gpu, painter: SharedPainter) -> Result<Self> {
        let renderer = Renderer::new(&gpu, Quality::Interactive);
        let viewport = Viewport::new(&gpu, &renderer, [64, 64])?;
        let texture =
            painter.write().register_native_texture(&gpu.device, viewport.view(), FilterMode::Linear);
        Ok(Self { gpu, painter, renderer, viewport, scene: Scene::new(), texture, drawn: None })
    }

    /// The device of the screen, to simulate on.
    pub fn shared_gpu(&self) -> SharedGpu {
        SharedGpu::of(&self.gpu.adapter_info, &self.gpu.device, &self.gpu.queue)
    }

    /// Replaces all that is shown.
    ///
    /// # Errors
    /// It is more than the device holds.
    pub fn set(&mut self, drawing: &Drawing) -> Result<()> {
        Ok(self.scene.set(&self.gpu, drawing)?)
    }

    /// Shows the faces set last in other colours.
    pub fn set_colors(&mut self, colors: &[[f32; 3]]) {
        self.scene.set_colors(&self.gpu, colors);
    }

    /// Replaces the faces only.
    ///
    /// # Errors
    /// As [`Self::set`].
    pub fn set_faces(&mut self, faces: &Faces) -> Result<()> {
        Ok(self.scene.set_faces(&self.gpu, faces)?)
    }

    /// Replaces the marks: lines around what is selected and what the pointer is over.
    ///
    /// # Errors
    /// As [`Self::set`].
    pub fn set_marks(&mut self, marks: &Lines) -> Result<()> {
        Ok(self.scene.set_marks(&self.gpu, marks)?)
    }

    /// Replaces the yarn only.
    ///
    /// # Errors
    /// As [`Self::set`].
    pub fn set_yarn(&mut self, yarn: &YarnCurves) -> Result<()> {
        Ok(self.scene.set_yarn(&self.gpu, yarn)?)
    }

    /// Replaces the yarn by some that is on the device already.
    pub fn share_yarn(&mut self, yarn: &DeviceYarn) {
        self.scene.share_yarn(laid(yarn));
    }

    /// Replaces the bodies only.
    ///
    /// # Errors
    /// As [`Self::set`].
    pub fn set_solids(&mut self, solids: &Solids) -> Result<()> {
        Ok(self.scene.set_solids(&self.gpu, solids)?)
    }

    /// Draws a picture of `size` pixels; of half that where the processor itself draws and something is `moving`. Where nothing
    /// has changed it is the picture that was drawn last.
    ///
    /// # Errors
    /// No such size.
    pub fn draw(&mut self, size: [u32; 2], camera: &Camera, moving: bool) -> Result<egui::TextureId> {
        let shrink = if moving && self.gpu.is_software() { 2 } else { 1 };
        let size = size.map(|pixels| (pixels / shrink).max(1));
        if self.viewport.resize(&self.gpu, &self.renderer, size)? {
            self.painter.write().update_egui_texture_from_wgpu_texture(
                &self.gpu.device,
                self.viewport.view(),
                FilterMode::Linear,
                self.texture,
            );
        }
        let wanted = Some((size, *camera));
        if self.drawn != wanted || !self.scene.is_settled() {
            let mut encoder = self.gpu.device.create_command_encoder(&Default::default());
            if self.drawn == wanted {
                self.renderer.redraw(&self.gpu, &mut encoder, &self.viewport, camera, &self.scene);
            } else {
                self.renderer.draw(&self.gpu, &mut encoder, &self.viewport, camera, &self.scene);
            }
            self.gpu.queue.submit([encoder.finish()]);
            self.scene.settle();
            self.drawn = wanted;
        }
        Ok(self.texture)
    }
}

/// Yarn on the device as the renderer knows it.
pub fn laid(yarn: &DeviceYarn) -> LaidYarn {
    let run = |run: &YarnRun| {
        let YarnRun { first, spans, center, far, span, radius } = *run;
        LaidRun { first, spans, center, far, span, radius }
    };
    let DeviceYarn { points, stretches, dyes, runs } = yarn.clone();
    LaidYarn { points, stretches, dyes, runs: runs.iter().map(run).collect() }
}
