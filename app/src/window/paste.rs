//! The picture in the window, pasted by a pipeline of its own.
//!
//! egui could show it as one of its textures. But its shader goes through all the ways of filtering that it knows, whichever is
//! used, where the processor itself draws: at 1360 × 860 it took as long as the drawing of a garment, once for every frame.

use egui::PaintCallbackInfo;
use egui_wgpu::wgpu::{self, include_wgsl};
use egui_wgpu::{CallbackResources, CallbackTrait};
use render::Gpu;

/// What pastes pictures into egui's pass.
pub struct Paste {
    pipeline: wgpu::RenderPipeline,
    sampler: wgpu::Sampler,
}

/// A picture to be pasted: of sRGB values, as the target's.
#[derive(Clone)]
pub struct Pasted {
    pipeline: wgpu::RenderPipeline,
    picture: wgpu::BindGroup,
}

impl Paste {
    /// One for targets of a format, which is to hold sRGB values as they are.
    pub fn new(gpu: &Gpu, target: wgpu::TextureFormat) -> Self {
        let device = &gpu.device;
        let module = device.create_shader_module(include_wgsl!("paste.wgsl"));
        let pipeline = device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some("paste"),
            layout: None,
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: Some("cover"),
                compilation_options: Default::default(),
                buffers: &[],
            },
            primitive: Default::default(),
            depth_stencil: None,
            multisample: Default::default(),
            fragment: Some(wgpu::FragmentState {
                module: &module,
                entry_point: Some("paste"),
                compilation_options: Default::default(),
                targets: &[Some(target.into())],
            }),
            multiview_mask: None,
            cache: None,
        });
        let sampler = device.create_sampler(&wgpu::SamplerDescriptor {
            label: Some("between pixels"),
            mag_filter: wgpu::FilterMode::Linear,
            min_filter: wgpu::FilterMode::Linear,
            ..Default::default()
        });
        Self { pipeline, sampler }
    }

    /// A picture to be pasted, as often as it is drawn.
    pub fn of(&self, gpu: &Gpu, picture: &wgpu::TextureView) -> Pasted {
        let group = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("paste"),
            layout: &self.pipeline.get_bind_group_layout(0),
            entries: &[
                wgpu::BindGroupEntry { binding: 0, resource: wgpu::BindingResource::TextureView(picture) },
                wgpu::BindGroupEntry { binding: 1, resource: wgpu::BindingResource::Sampler(&self.sampler) },
            ],
        });
        Pasted { pipeline: self.pipeline.clone(), picture: group }
    }
}

impl CallbackTrait for Pasted {
    fn paint(&self, _: PaintCallbackInfo, pass: &mut wgpu::RenderPass<'static>, _: &CallbackResources) {
        // egui has set the viewport to the place of the picture.
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &self.picture, &[]);
        pass.draw(0..3, 0..1);
    }
}
