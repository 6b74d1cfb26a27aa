//! What drawing needs for one picture of one size.

use crate::compose::PICTURE_FORMAT;
use crate::frame::FrameBuffer;
use crate::occlusion::OcclusionTargets;
use crate::pipeline::{COLOR_FORMAT, DEPTH_FORMAT, bind_group, target};
use crate::{Gpu, RenderError, Renderer};

/// The textures of a picture. Make one for each place that shows a scene; resize it when that place changes.
#[derive(Debug)]
pub struct Viewport {
    size: [u32; 2],
    /// Whether pictures are drawn cheaply, as the next replaces them soon.
    pub(crate) rough: bool,
    picture: wgpu::Texture,
    view: wgpu::TextureView,
    /// Where the scene is drawn, in linear light: multisampled or not, and where samples are resolved to.
    pub(crate) color: wgpu::TextureView,
    pub(crate) resolved: Option<wgpu::TextureView>,
    pub(crate) depth: wgpu::TextureView,
    pub(crate) occlusion: OcclusionTargets,
    pub(crate) compose: wgpu::BindGroup,
    pub(crate) camera: FrameBuffer,
    pub(crate) light: FrameBuffer,
    pub(crate) lit_frame: wgpu::BindGroup,
    pub(crate) plain_frame: wgpu::BindGroup,
    pub(crate) light_frame: wgpu::BindGroup,
}

impl Viewport {
    /// A picture of `size` pixels for a renderer.
    pub fn new(gpu: &Gpu, renderer: &Renderer, size: [u32; 2]) -> Result<Self, RenderError> {
        let device = &gpu.device;
        let limit = device.limits().max_texture_dimension_2d / renderer.supersampling;
        let [width, height] = size;
        if width == 0 || height == 0 || width > limit || height > limit {
            return Err(RenderError::Size { width, height, limit });
        }
        let scene_size = size.map(|pixels| pixels * renderer.supersampling);
        let samples = renderer.samples;
        let view = |label, format, samples| {
            target(device, label, scene_size, format, samples).create_view(&Default::default())
        };
        let color = view("scene", COLOR_FORMAT, samples);
        let resolved = (samples > 1).then(|| view("resolved scene", COLOR_FORMAT, 1));
        let depth = view("scene depth", DEPTH_FORMAT, samples);
        let picture = target(device, "picture", size, PICTURE_FORMAT, 1);

        let (camera, light) = (FrameBuffer::new(device), FrameBuffer::new(device));
        let occlusion = renderer.occlusion.targets(device, &camera.buffer, &depth, scene_size);
        let scene = resolved.as_ref().unwrap_or(&color);
        let compose = renderer.compose.inputs(device, &camera.buffer, [&depth, scene, &occlusion.view]);
        let plain = |buffer: &FrameBuffer| {
            bind_group(device, &renderer.frame_layout, vec![buffer.buffer.as_entire_binding()])
        };
        let lit = vec![
            camera.buffer.as_entire_binding(),
            wgpu::BindingResource::TextureView(&renderer.shadow_map.view),
            wgpu::BindingResource::Sampler(&renderer.shadow_map.sampler),
        ];
        Ok(Self {
            size,
            rough: false,
            view: picture.create_view(&Default::default()),
            picture,
            lit_frame: bind_group(device, &renderer.lit_frame_layout, lit),
            plain_frame: plain(&camera),
            light_frame: plain(&light),
            color,
            resolved,
            depth,
            occlusion,
            compose,
            camera,
            light,
        })
    }

    /// Changes the size of the picture. Returns whether the texture is another one than before.
    pub fn resize(&mut self, gpu: &Gpu, renderer: &Renderer, size: [u32; 2]) -> Result<bool, RenderError> {
        let changed = size != self.size;
        if changed {
            *self = Self { rough: self.rough, ..Self::new(gpu, renderer, size)? };
        }
        Ok(changed)
    }

    /// Whether to draw pictures cheaply from now on, as the next replaces them soon: where yarn is thin, with longer steps along it and
    /// without hollows.
    pub fn set_rough(&mut self, rough: bool) {
        self.rough = rough;
    }

    /// Width and height [px].
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// The picture: `Rgba8Unorm` holding sRGB values, opaque.
    pub fn picture(&self) -> &wgpu::Texture {
        &self.picture
    }

    /// A view of the picture, ready for a window's user interface.
    pub fn view(&self) -> &wgpu::TextureView {
        &self.view
    }
}
