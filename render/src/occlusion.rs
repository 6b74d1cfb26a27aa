//! Ambient occlusion: how deep in a hollow each point lies, so that loops read clearly.

use crate::pipeline::{
    Pipeline, UNIFORM, begin_pass, bind_group, bind_group_layout, depth_alias, shader, target, texture,
};

/// Light that arrives, and distance, at half the resolution of the scene.
const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rg32Float;
const COARSE: wgpu::BindingType = texture(wgpu::TextureSampleType::Float { filterable: false }, false);

/// The two passes: find the hollows, blur them.
#[derive(Debug)]
pub(crate) struct Occlusion {
    depth_layout: wgpu::BindGroupLayout,
    coarse_layout: wgpu::BindGroupLayout,
    find: wgpu::RenderPipeline,
    blur: wgpu::RenderPipeline,
}

/// What the passes draw into, for a scene of one size.
#[derive(Debug)]
pub(crate) struct OcclusionTargets {
    depth: wgpu::BindGroup,
    coarse: wgpu::BindGroup,
    coarse_view: wgpu::TextureView,
    /// The result.
    pub view: wgpu::TextureView,
}

impl Occlusion {
    /// `pairs` taps are taken on either side of each point.
    pub fn new(device: &wgpu::Device, samples: u32, pairs: u32) -> Self {
        let stages = wgpu::ShaderStages::FRAGMENT;
        let depth = texture(wgpu::TextureSampleType::Depth, samples > 1);
        let depth_layout = bind_group_layout(device, "depth", stages, &[UNIFORM, depth]);
        let coarse_layout = bind_group_layout(device, "coarse occlusion", stages, &[COARSE]);
        let constants = format!("const PAIRS = {pairs};");
        let module =
            shader(device, "occlusion", &[depth_alias(samples), &constants, include_str!("occlusion.wgsl")]);
        let pipeline = |fragment, layouts: &[&wgpu::BindGroupLayout]| {
            let pipeline = Pipeline {
                label: fragment,
                module: &module,
                vertex: "cover",
                fragment: Some(fragment),
                layouts,
                vertices: &[],
                topology: wgpu::PrimitiveTopology::TriangleList,
                cull: None,
                target: Some(FORMAT),
                depth: None,
                samples: 1,
            };
            pipeline.build(device)
        };
        let find = pipeline("find_hollows", &[&depth_layout]);
        let blur = pipeline("blur", &[&depth_layout, &coarse_layout]);
        Self { find, blur, depth_layout, coarse_layout }
    }

    /// Targets for a scene of `size`, whose depth is in `depth`.
    pub fn targets(
        &self,
        device: &wgpu::Device,
        frame: &wgpu::Buffer,
        depth: &wgpu::TextureView,
        size: [u32; 2],
    ) -> OcclusionTargets {
        let half = size.map(|pixels| pixels.div_ceil(2));
        let view = |label| target(device, label, half, FORMAT, 1).create_view(&Default::default());
        let (coarse_view, smooth) = (view("hollows"), view("blurred hollows"));
        let depth_resources = vec![frame.as_entire_binding(), wgpu::BindingResource::TextureView(depth)];
        let coarse_resources = vec![wgpu::BindingResource::TextureView(&coarse_view)];
        OcclusionTargets {
            depth: bind_group(device, &self.depth_layout, depth_resources),
            coarse: bind_group(device, &self.coarse_layout, coarse_resources),
            coarse_view,
            view: smooth,
        }
    }

    pub fn draw(&self, encoder: &mut wgpu::CommandEncoder, targets: &OcclusionTargets) {
        let mut pass = begin_pass(encoder, "find hollows", Some((&targets.coarse_view, None)), None, false);
        pass.set_pipeline(&self.find);
        pass.set_bind_group(0, &targets.depth, &[]);
        pass.draw(0..3, 0..1);
        drop(pass);
        let mut pass = begin_pass(encoder, "blur hollows", Some((&targets.view, None)), None, false);
        pass.set_pipeline(&self.blur);
        pass.set_bind_group(0, &targets.depth, &[]);
        pass.set_bind_group(1, &targets.coarse, &[]);
        pass.draw(0..3, 0..1);
    }
}
