//! The picture in the middle of the window: drawn by the renderer on egui's own device, and pasted into egui's pass.

use super::paste::{Paste, Pasted};
use anyhow::Result;
use egui_wgpu::wgpu::TextureFormat;
use render::{
    Camera, Drawing, Faces, Gpu, LaidRun, LaidYarn, Lines, Quality, Renderer, Scene, Solids, Viewport,
    YarnLayout,
};
use sim_core::{DeviceYarn, SharedGpu, YarnRun};

/// Renderer, viewport and what is in it.
pub struct Screen {
    gpu: Gpu,
    paste: Paste,
    renderer: Renderer,
    viewport: Viewport,
    scene: Scene,
    pasted: Pasted,
    /// What the picture was drawn for: its size, the camera, and whether it is rough.
    drawn: Option<([u32; 2], Camera, bool)>,
}

impl Screen {
    /// A screen on the device that egui paints with, into targets of a format.
    ///
    /// # Errors
    /// The device cannot hold a viewport.
    pub fn new(gpu: Gpu, target: TextureFormat) -> Result<Self> {
        let renderer = Renderer::new(&gpu, Quality::Interactive);
        let viewport = Viewport::new(&gpu, &renderer, [64, 64])?;
        let paste = Paste::new(&gpu, target);
        let pasted = paste.of(&gpu, viewport.view());
        Ok(Self { gpu, paste, renderer, viewport, scene: Scene::new(), pasted, drawn: None })
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
    ///
    /// # Errors
    /// As [`Self::set`].
    pub fn set_colors(&mut self, colors: &[[f32; 3]]) -> Result<()> {
        Ok(self.scene.set_colors(&self.gpu, colors)?)
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
    pub fn set_yarn(&mut self, yarn: &YarnLayout) -> Result<()> {
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

    /// Draws a picture of `size` pixels; of half that, and rough, where the processor itself draws and something is `moving`. Where
    /// nothing has changed it is the picture that was drawn last.
    ///
    /// # Errors
    /// No such size.
    pub fn draw(&mut self, size: [u32; 2], camera: &Camera, moving: bool) -> Result<Pasted> {
        let rough = moving && self.gpu.is_software();
        let size = size.map(|pixels| if rough { pixels / 2 } else { pixels }.max(1));
        self.viewport.set_rough(rough);
        if self.viewport.resize(&self.gpu, &self.renderer, size)? {
            self.pasted = self.paste.of(&self.gpu, self.viewport.view());
        }
        let wanted = Some((size, *camera, rough));
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
        Ok(self.pasted.clone())
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
