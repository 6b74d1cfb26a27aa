//! Lines of constant width on the screen.

use glam::Vec3;

use crate::drawing::Lines;
use crate::pipeline::{COLOR_FORMAT, Pipeline, shader};
use crate::scene::GrowingBuffer;
use crate::{Gpu, RenderError};

const ATTRIBUTES: [wgpu::VertexAttribute; 4] =
    wgpu::vertex_attr_array![0 => Float32x3, 1 => Float32x3, 2 => Float32x3, 3 => Float32];

/// A segment as the GPU reads it, one instance of a quad.
#[repr(C)]
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
struct Instance {
    ends: [Vec3; 2],
    color: [f32; 3],
    width: f32,
}

/// Lines on the GPU.
#[derive(Debug)]
pub(crate) struct LineMesh {
    instances: GrowingBuffer,
    count: u32,
}

impl LineMesh {
    pub fn new() -> Self {
        Self { instances: GrowingBuffer::new("lines", wgpu::BufferUsages::VERTEX), count: 0 }
    }

    pub fn set(&mut self, gpu: &Gpu, lines: &Lines) -> Result<(), RenderError> {
        let instance = |s: &crate::Segment| Instance { ends: s.ends, color: s.color, width: s.width };
        let instances: Vec<_> = lines.segments.iter().map(instance).collect();
        self.count = instances.len() as u32;
        self.instances.write(gpu, bytemuck::cast_slice(&instances), gpu.device.limits().max_buffer_size)
    }
}

/// The pipeline that draws them.
#[derive(Debug)]
pub(crate) struct LinePipeline(wgpu::RenderPipeline);

impl LinePipeline {
    pub fn new(device: &wgpu::Device, frame: &wgpu::BindGroupLayout, samples: u32) -> Self {
        let pipeline = Pipeline {
            label: "lines",
            module: &shader(device, "lines", &[include_str!("lines.wgsl")]),
            vertex: "line_vertex",
            fragment: Some("line_fragment"),
            layouts: &[frame],
            vertices: Some(wgpu::VertexBufferLayout {
                array_stride: size_of::<Instance>() as u64,
                step_mode: wgpu::VertexStepMode::Instance,
                attributes: &ATTRIBUTES,
            }),
            topology: wgpu::PrimitiveTopology::TriangleStrip,
            cull: None,
            target: Some(COLOR_FORMAT),
            depth: Some(wgpu::CompareFunction::GreaterEqual),
            samples,
        };
        Self(pipeline.build(device))
    }

    pub fn draw(&self, pass: &mut wgpu::RenderPass, mesh: &LineMesh) {
        if let Some(buffer) = mesh.instances.buffer().filter(|_| mesh.count > 0) {
            pass.set_pipeline(&self.0);
            pass.set_vertex_buffer(0, buffer.slice(..));
            pass.draw(0..4, 0..mesh.count);
        }
    }
}
