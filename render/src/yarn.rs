//! Yarn as lit wool, straight from its control points.
//!
//! The control points lie in a storage buffer, and the vertex shader evaluates the spline; the number of a vertex says
//! which span, how far along and where around. So an update uploads 36 bytes a control point, whatever the level of detail.
//! (An instance a span would be the obvious way, but a GPU, and a software one even more, fills badly with instances of
//! two triangles.)

#[cfg(test)]
mod catmull_rom;
mod layout;
mod level;
mod transport;

use glam::Vec3;
use wgpu::CompareFunction::{Greater, Less};

pub use self::layout::YarnLayout;
use self::layout::reach;
use self::level::{Batch, Chunk, ERROR, Level, SAMPLES, SIDES, SPAN_VERTICES, batches};
use self::transport::{ControlPoint, END};
use crate::pipeline::{COLOR_FORMAT, Pipeline, STORAGE, bind_group, bind_group_layout, shader};
use crate::scene::GrowingBuffer;
use crate::{Bounds, Gpu, RenderError, light};

/// Plies twisted together in the yarn.
const PLIES: f32 = 3.0;
/// Length of one turn of the twist, in yarn diameters.
const PITCH: f32 = 4.5;

/// Yarn that lies in buffers of the device already, put there by whoever moves it.
#[derive(Clone, Debug)]
pub struct LaidYarn {
    /// Control points as `yarn.wgsl` reads them, 32 bytes: position [m], length of yarn up to there in diameters, unit reference
    /// normal, number of its stretch, and a bit more at the ends of open yarns.
    pub points: wgpu::Buffer,
    /// Radius [m] and roll [rad] of each stretch, 8 bytes.
    pub stretches: wgpu::Buffer,
    /// Colour from each control point to the next, as sRGB in the bytes of a number.
    pub dyes: wgpu::Buffer,
    /// Where it is.
    pub runs: Vec<LaidRun>,
}

/// Some spans of yarn in a row.
#[derive(Clone, Copy, Debug)]
pub struct LaidRun {
    /// The control point that the first begins at.
    pub first: u32,
    /// How many there are.
    pub spans: u32,
    /// A place that all their control points are within `far` of [m].
    pub center: Vec3,
    /// See `center`.
    pub far: f32,
    /// Mean length of a span [m].
    pub span: f32,
    /// Radius of the thickest yarn among them [m].
    pub radius: f32,
}

/// Yarn on the GPU.
#[derive(Debug)]
pub(crate) struct YarnMesh {
    /// Yarn that somebody else has put there, in place of the rest.
    laid: Option<[wgpu::Buffer; 3]>,
    points: GrowingBuffer,
    /// Colour from each control point to the next, as sRGB in the bytes of a number.
    dyes: GrowingBuffer,
    stretches: GrowingBuffer,
    chunks: Vec<Chunk>,
    bounds: Option<Bounds>,
    radius: f32,
}

impl YarnMesh {
    pub fn new() -> Self {
        Self {
            laid: None,
            points: GrowingBuffer::new("yarn control points", wgpu::BufferUsages::STORAGE),
            dyes: GrowingBuffer::new("yarn colours", wgpu::BufferUsages::STORAGE),
            stretches: GrowingBuffer::new("stretches of yarn", wgpu::BufferUsages::STORAGE),
            chunks: Vec::new(),
            bounds: None,
            radius: 0.0,
        }
    }

    /// Replaces the yarn.
    pub fn set(&mut self, gpu: &Gpu, yarn: &YarnLayout) -> Result<(), RenderError> {
        self.laid = None;
        self.chunks.clone_from(&yarn.chunks);
        self.bound();
        self.radius = yarn.radius;
        let limits = gpu.device.limits();
        // The numbers of vertices must fit, too: five million control points.
        let numbered = (i32::MAX as u32 / SPAN_VERTICES) as u64 * size_of::<ControlPoint>() as u64;
        let limit = limits.max_storage_buffer_binding_size.min(limits.max_buffer_size).min(numbered);
        let written = self
            .points
            .write(gpu, bytemuck::cast_slice(&yarn.points), limit)
            .and_then(|()| self.dyes.write(gpu, bytemuck::cast_slice(&yarn.dyes), limit))
            .and_then(|()| self.stretches.write(gpu, bytemuck::cast_slice(&yarn.stretches), limit));
        if written.is_err() {
            self.chunks.clear();
        }
        written
    }

    /// Draws from now on what is in buffers of the same device.
    pub fn share(&mut self, yarn: LaidYarn) {
        let chunk = |run: &LaidRun| Chunk {
            first: run.first,
            spans: run.spans,
            center: run.center,
            reach: reach(run.far, run.radius, run.span),
            radius: run.radius,
            span: run.span,
        };
        self.chunks = yarn.runs.iter().map(chunk).collect();
        self.bound();
        self.radius = yarn.runs.iter().map(|run| run.radius).fold(0.0, f32::max);
        self.laid = Some([yarn.points, yarn.stretches, yarn.dyes]);
    }

    fn bound(&mut self) {
        self.bounds = Bounds::of(
            self.chunks.iter().flat_map(|chunk| [chunk.center - chunk.reach, chunk.center + chunk.reach]),
        );
    }

    /// Its control points, stretches and colours.
    fn buffers(&self) -> Option<[&wgpu::Buffer; 3]> {
        match &self.laid {
            Some([points, stretches, dyes]) => Some([points, stretches, dyes]),
            None => {
                let [points, stretches, dyes] =
                    [&self.points, &self.stretches, &self.dyes].map(GrowingBuffer::buffer);
                Some([points?, stretches?, dyes?])
            }
        }
    }

    /// A box around it.
    pub fn bounds(&self) -> Option<Bounds> {
        self.bounds
    }

    /// Radius of the thickest yarn [m].
    pub fn radius(&self) -> f32 {
        self.radius
    }
}

/// The pipelines that draw it, and the triangles of all levels.
#[derive(Debug)]
pub(crate) struct YarnPipelines {
    frayed: wgpu::RenderPipeline,
    tube: wgpu::RenderPipeline,
    ribbon: wgpu::RenderPipeline,
    thread: wgpu::RenderPipeline,
    shadow: wgpu::RenderPipeline,
    layout: wgpu::BindGroupLayout,
    triangles: wgpu::Buffer,
    /// Where the triangles of a level start in the buffer.
    starts: Vec<u32>,
}

impl YarnPipelines {
    pub fn new(
        gpu: &Gpu,
        frame: &wgpu::BindGroupLayout,
        lit_frame: &wgpu::BindGroupLayout,
        samples: u32,
        shadows: bool,
    ) -> Self {
        let device = &gpu.device;
        let layout =
            bind_group_layout(device, "yarn", wgpu::ShaderStages::VERTEX, &[STORAGE, STORAGE, STORAGE]);
        let (light, constants) = (light::wgsl(shadows), constants());
        let sources =
            [light.as_str(), &constants, include_str!("yarn/catmull_rom.wgsl"), include_str!("yarn.wgsl")];
        let module = shader(device, "yarn", &sources);
        let tube = Pipeline {
            label: "yarn tubes",
            module: &module,
            vertex: "tube_vertex",
            fragment: Some("tube_fragment"),
            layouts: &[lit_frame, &layout],
            vertices: &[],
            topology: wgpu::PrimitiveTopology::TriangleList,
            cull: Some(wgpu::Face::Back),
            target: Some(COLOR_FORMAT),
            depth: Some(Greater),
            samples,
        };
        let frayed =
            Pipeline { label: "frayed yarn tubes", fragment: Some("frayed_fragment"), vertices: &[], ..tube };
        let ribbon = Pipeline {
            label: "yarn ribbons",
            vertex: "ribbon_vertex",
            fragment: Some("ribbon_fragment"),
            cull: None,
            vertices: &[],
            ..tube
        };
        let thread = Pipeline {
            label: "yarn threads",
            vertex: "thread_vertex",
            fragment: Some("thread_fragment"),
            vertices: &[],
            ..ribbon
        };
        let shadow = Pipeline {
            label: "yarn shadow",
            vertex: "shadow_vertex",
            fragment: None,
            layouts: &[frame, &layout],
            target: None,
            depth: Some(Less),
            samples: 1,
            vertices: &[],
            ..ribbon
        };
        let [frayed, tube, ribbon, thread, shadow] =
            [frayed, tube, ribbon, thread, shadow].map(|pipeline| pipeline.build(device));

        let mut indices = Vec::new();
        let mut starts = Vec::new();
        for level in Level::all() {
            starts.push(indices.len() as u32);
            indices.extend(level.triangles());
        }
        let triangles = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("yarn triangles"),
            size: (indices.len() * size_of::<u32>()) as u64,
            usage: wgpu::BufferUsages::INDEX | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        gpu.queue.write_buffer(&triangles, 0, bytemuck::cast_slice(&indices));
        Self { frayed, tube, ribbon, thread, shadow, layout, triangles, starts }
    }

    /// Draws what is in the picture, so many times `rougher` than it need be; `scale` as in [`batches`].
    pub fn draw(
        &self,
        gpu: &Gpu,
        pass: &mut wgpu::RenderPass,
        mesh: &YarnMesh,
        rougher: f32,
        scale: impl Fn(Vec3, f32) -> Option<f32>,
    ) {
        let batches = batches(&mesh.chunks, rougher * ERROR, scale);
        let (flat, tubes) = batches.split_at(batches.partition_point(|batch| batch.level.is_flat()));
        let (threads, ribbons) = flat.split_at(flat.partition_point(|batch| batch.level.is_thread()));
        let (plain, frayed) = tubes.split_at(tubes.partition_point(|batch| !batch.level.is_frayed()));
        // The widest yarn is nearest and hides some of the rest.
        self.draw_batches(gpu, pass, &self.frayed, mesh, frayed);
        self.draw_batches(gpu, pass, &self.tube, mesh, plain);
        self.draw_batches(gpu, pass, &self.ribbon, mesh, ribbons);
        self.draw_batches(gpu, pass, &self.thread, mesh, threads);
    }

    /// Draws into the shadow map; `scale` as in [`batches`].
    pub fn draw_shadow(
        &self,
        gpu: &Gpu,
        pass: &mut wgpu::RenderPass,
        mesh: &YarnMesh,
        scale: impl Fn(Vec3, f32) -> Option<f32>,
    ) {
        let mut batches = batches(&mesh.chunks, ERROR, scale);
        for batch in &mut batches {
            batch.level = batch.level.as_ribbon();
        }
        self.draw_batches(gpu, pass, &self.shadow, mesh, &batches);
    }

    fn draw_batches(
        &self,
        gpu: &Gpu,
        pass: &mut wgpu::RenderPass,
        pipeline: &wgpu::RenderPipeline,
        mesh: &YarnMesh,
        batches: &[Batch],
    ) {
        let Some(buffers) = mesh.buffers().filter(|_| !batches.is_empty()) else { return };
        let buffers = buffers.map(wgpu::Buffer::as_entire_binding);
        pass.set_pipeline(pipeline);
        pass.set_bind_group(1, &bind_group(&gpu.device, &self.layout, buffers.to_vec()), &[]);
        pass.set_index_buffer(self.triangles.slice(..), wgpu::IndexFormat::Uint32);
        for batch in batches {
            let start = self.starts[batch.level.index()];
            let count = batch.level.indices(batch.end - batch.first);
            pass.draw_indexed(start..start + count, (batch.first * SPAN_VERTICES) as i32, 0..1);
        }
    }
}

/// The numbers that `yarn.wgsl` shares with this side.
fn constants() -> String {
    format!(
        "const SAMPLES = {SAMPLES}u;\nconst SIDES = {SIDES}u;\nconst PLIES = {PLIES:?};\nconst PITCH = {PITCH:?};\nconst END = {END}u;\n"
    )
}
