//! Lines of constant width on the screen.

use glam::Vec3;

use crate::damage::{Damage, Only, Part, differences, runs};
use crate::drawing::Lines;
use crate::pipeline::{COLOR_FORMAT, Pipeline, shader};
use crate::scene::GrowingBuffer;
use crate::{Gpu, RenderError};

const ATTRIBUTES: [wgpu::VertexAttribute; 4] =
    wgpu::vertex_attr_array![0 => Float32x3, 1 => Float32x3, 2 => Float32x3, 3 => Float32];

/// Lines shorter than so many of their widths on the screen, in the mean, are left out.
const ROOM: f32 = 3.0;

/// A segment as the GPU reads it, one instance of a quad.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
struct Instance {
    ends: [Vec3; 2],
    color: [f32; 3],
    width: f32,
}

/// Lines on the GPU.
#[derive(Debug)]
pub(crate) struct LineMesh {
    instances: GrowingBuffer,
    lines: Vec<Instance>,
    /// Mean length [m] and width [px], and what they were when all was drawn last.
    mean: [f32; 2],
    drawn: [f32; 2],
}

impl LineMesh {
    pub fn new() -> Self {
        Self {
            instances: GrowingBuffer::new("lines", wgpu::BufferUsages::VERTEX),
            lines: Vec::new(),
            mean: [0.0; 2],
            drawn: [0.0; 2],
        }
    }

    pub fn set(&mut self, gpu: &Gpu, lines: &Lines, damage: &mut Damage) -> Result<(), RenderError> {
        let instance = |s: &crate::Segment| Instance { ends: s.ends, color: s.color, width: s.width };
        let instances: Vec<_> = lines.segments.iter().map(instance).collect();
        let before = std::mem::replace(&mut self.lines, instances);
        let (now, mut same) = (&self.lines, before.len());
        differences(
            [before.len(), now.len()],
            |i, j| before[i] == now[j],
            |only| {
                let (line, place) = match only {
                    Only::Before(i) => (&before[i], i),
                    Only::After(j) => (&now[j], j),
                };
                damage.add(line.ends, line.width);
                same = same.min(place);
            },
        );
        let sum = |of: fn(&crate::Segment) -> f32| lines.segments.iter().map(of).sum::<f32>();
        let sums = [sum(|s| s.ends[0].distance(s.ends[1])), sum(|s| s.width)];
        self.mean = sums.map(|sum| sum / lines.segments.len().max(1) as f32);
        let (bytes, limit) = (bytemuck::cast_slice(&self.lines), gpu.device.limits().max_buffer_size);
        self.instances.write_from(gpu, bytes, same * size_of::<Instance>(), limit)
    }
}

impl LineMesh {
    /// Whether there is room between the lines where a metre is `scale` pixels. Where there is none they would cover what they
    /// outline, and cost more than it does.
    fn has_room(&self, scale: f32) -> bool {
        let [length, width] = self.mean;
        length * scale > ROOM * width
    }

    /// Whether all lines come or go, since there was room for them before and is none now, or the other way round.
    pub fn flips(&self, scale: f32) -> bool {
        let [length, width] = self.drawn;
        self.has_room(scale) != (length * scale > ROOM * width)
    }

    /// Says that the lines have been drawn.
    pub fn settle(&mut self) {
        self.drawn = self.mean;
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
            vertices: &[Some(wgpu::VertexBufferLayout {
                array_stride: size_of::<Instance>() as u64,
                step_mode: wgpu::VertexStepMode::Instance,
                attributes: &ATTRIBUTES,
            })],
            topology: wgpu::PrimitiveTopology::TriangleStrip,
            cull: None,
            target: Some(COLOR_FORMAT),
            depth: Some(wgpu::CompareFunction::GreaterEqual),
            samples,
        };
        Self(pipeline.build(device))
    }

    /// Draws lines if there is room between them where a metre is `scale` pixels.
    pub fn draw_outlines(
        &self,
        pass: &mut wgpu::RenderPass,
        mesh: &LineMesh,
        scale: f32,
        part: Option<&Part>,
    ) {
        if mesh.has_room(scale) {
            self.draw(pass, mesh, part);
        }
    }

    /// Draws lines, all or those that reach into a part of the picture.
    pub fn draw(&self, pass: &mut wgpu::RenderPass, mesh: &LineMesh, part: Option<&Part>) {
        if let Some(buffer) = mesh.instances.buffer().filter(|_| !mesh.lines.is_empty()) {
            pass.set_pipeline(&self.0);
            pass.set_vertex_buffer(0, buffer.slice(..));
            let lines = &mesh.lines;
            let reached = |line: usize| part.is_none_or(|p| p.is_reached_by(lines[line].ends.into_iter()));
            for run in runs(lines.len(), reached) {
                pass.draw(0..4, run.start as u32..run.end as u32);
            }
        }
    }
}
