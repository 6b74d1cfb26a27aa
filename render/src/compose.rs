//! The last pass: scene, occlusion and background become a picture.

use wgpu::BindingResource::TextureView;

use crate::pipeline::{
    Pipeline, UNIFORM, begin_pass, bind_group, bind_group_layout, depth_alias, shader, texture,
};

/// Eight bits a channel, encoded as sRGB by the shader: what image files hold and what egui takes as a native texture.
pub(crate) const PICTURE_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;

/// The pass.
#[derive(Debug)]
pub(crate) struct Compose {
    layout: wgpu::BindGroupLayout,
    pipeline: wgpu::RenderPipeline,
}

impl Compose {
    pub fn new(device: &wgpu::Device, samples: u32, supersampling: u32) -> Self {
        let color = texture(wgpu::TextureSampleType::Float { filterable: false }, false);
        let depth = texture(wgpu::TextureSampleType::Depth, samples > 1);
        let stages = wgpu::ShaderStages::FRAGMENT;
        let layout = bind_group_layout(device, "compose", stages, &[UNIFORM, depth, color, color]);
        let constants = format!("const SUPERSAMPLING = {supersampling};");
        let module =
            shader(device, "compose", &[depth_alias(samples), &constants, include_str!("compose.wgsl")]);
        let pipeline = Pipeline {
            label: "compose",
            module: &module,
            vertex: "cover",
            fragment: Some("compose"),
            layouts: &[&layout],
            vertices: &[],
            topology: wgpu::PrimitiveTopology::TriangleList,
            cull: None,
            target: Some(PICTURE_FORMAT),
            depth: None,
            samples: 1,
        };
        Self { pipeline: pipeline.build(device), layout }
    }

    /// Binds the frame, the scene's depth and colour, and its occlusion.
    pub fn inputs(
        &self,
        device: &wgpu::Device,
        frame: &wgpu::Buffer,
        [depth, scene, hollows]: [&wgpu::TextureView; 3],
    ) -> wgpu::BindGroup {
        let resources =
            vec![frame.as_entire_binding(), TextureView(depth), TextureView(scene), TextureView(hollows)];
        bind_group(device, &self.layout, resources)
    }

    /// Makes the picture, or a rectangle of it.
    pub fn draw(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        inputs: &wgpu::BindGroup,
        picture: &wgpu::TextureView,
        rectangle: Option<[u32; 4]>,
    ) {
        let mut pass = begin_pass(encoder, "compose", Some((picture, None)), None, rectangle.is_some());
        if let Some([left, top, width, height]) = rectangle {
            pass.set_scissor_rect(left, top, width, height);
        }
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, inputs, &[]);
        pass.draw(0..3, 0..1);
    }
}
