//! Yarn as lit wool, straight from its control points.
//!
//! The control points lie in a storage buffer, and the vertex shader evaluates the spline; the number of a vertex says
//! which span, how far along and where around. So an update uploads 36 bytes a control point, whatever the level of detail.
//! (An instance a span would be the obvious way, but a GPU, and a software one even more, fills badly with instances of
//! two triangles.)

#[cfg(test)]
mod catmull_rom;
mod level;
mod transport;

use glam::Vec3;
use stitch_mesh::dye::Dye;
use stitch_mesh::yarn_curves::{YarnCurve, YarnCurves};
use wgpu::CompareFunction::{Greater, Less};

use self::level::{Batch, Chunk, Level, RUN, SAMPLES, SIDES, SPAN_VERTICES, batches};
use self::transport::{ControlPoint, END, lay_out};
use crate::pipeline::{COLOR_FORMAT, Pipeline, STORAGE, bind_group, bind_group_layout, shader};
use crate::scene::GrowingBuffer;
use crate::{Bounds, Gpu, RenderError, light};

/// Plies twisted together in the yarn.
const PLIES: f32 = 3.0;
/// Length of one turn of the twist, in yarn diameters.
const PITCH: f32 = 4.5;
/// Spans that are culled together: few enough to leave out most of what is not seen, enough to keep draw calls cheap.
const CHUNK: usize = 32;

/// A stretch of a curve that has one thickness, as `yarn.wgsl` reads it.
#[repr(C)]
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
struct Stretch {
    radius: f32,
    /// Turn of the frame a span, beside its transport [rad].
    roll: f32,
}

/// Yarn on the GPU.
#[derive(Debug)]
pub(crate) struct YarnMesh {
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
            points: GrowingBuffer::new("yarn control points", wgpu::BufferUsages::STORAGE),
            dyes: GrowingBuffer::new("yarn colours", wgpu::BufferUsages::STORAGE),
            stretches: GrowingBuffer::new("stretches of yarn", wgpu::BufferUsages::STORAGE),
            chunks: Vec::new(),
            bounds: None,
            radius: 0.0,
        }
    }

    /// Replaces the yarn.
    pub fn set(&mut self, gpu: &Gpu, yarn: &YarnCurves) -> Result<(), RenderError> {
        let mut points = Vec::with_capacity(yarn.curves.iter().map(|curve| curve.points.len() + 4).sum());
        let mut dyes: Vec<u32> = Vec::with_capacity(points.capacity());
        let mut stretches = Vec::with_capacity(yarn.curves.len());
        self.chunks.clear();
        for curve in &yarn.curves {
            let first = points.len() + 1;
            let roll = lay_out(curve, stretches.len() as u32, &mut points);
            // One control point lies before the first of the curve, and some after its last.
            let packed = |dye: &Dye| u32::from_le_bytes([dye.0[0], dye.0[1], dye.0[2], 0]);
            dyes.resize(first.min(points.len()), 0);
            dyes.extend(curve.dyes.iter().cycle().take(points.len() - dyes.len()).map(packed));
            dyes.resize(points.len(), 0);
            if points.len() > first {
                self.chunks.extend(chunks(&points[first..points.len() - 2], first, curve.greatest_radius()));
            }
            let radii = curve.radii.chunk_by(|a, b| a == b);
            stretches.extend(radii.map(|equal| Stretch { radius: equal[0], roll }));
        }
        self.bounds = Bounds::of(
            self.chunks.iter().flat_map(|chunk| [chunk.center - chunk.reach, chunk.center + chunk.reach]),
        );
        self.radius = yarn.curves.iter().map(YarnCurve::greatest_radius).fold(0.0, f32::max);
        let limits = gpu.device.limits();
        // The numbers of vertices must fit, too: five million control points.
        let numbered = (i32::MAX as u32 / SPAN_VERTICES) as u64 * size_of::<ControlPoint>() as u64;
        let limit = limits.max_storage_buffer_binding_size.min(limits.max_buffer_size).min(numbered);
        let written = self
            .points
            .write(gpu, bytemuck::cast_slice(&points), limit)
            .and_then(|()| self.dyes.write(gpu, bytemuck::cast_slice(&dyes), limit))
            .and_then(|()| self.stretches.write(gpu, bytemuck::cast_slice(&stretches), limit));
        if written.is_err() {
            self.chunks.clear();
        }
        written
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

/// Cuts the points of a curve, which start at `first` in the buffer, into runs of spans.
fn chunks(points: &[ControlPoint], first: usize, radius: f32) -> impl Iterator<Item = Chunk> + '_ {
    let spans = points.len() - 1;
    (0..spans).step_by(CHUNK).map(move |start| {
        let run = &points[start..=(start + CHUNK).min(spans)];
        let center = run.iter().map(|p| p.position).sum::<Vec3>() / run.len() as f32;
        let length: f32 = run.windows(2).map(|w| w[0].position.distance(w[1].position)).sum();
        let count = run.len() - 1;
        let span = length / count as f32;
        let far = run.iter().map(|p| p.position.distance(center)).fold(0.0, f32::max);
        // Between its points the spline bulges, by less than half a span in any sane curve.
        Chunk {
            first: (first + start) as u32,
            spans: count as u32,
            center,
            reach: far + radius + 0.5 * span,
            radius,
            span,
        }
    })
}

/// The pipelines that draw it, and the triangles of all levels.
#[derive(Debug)]
pub(crate) struct YarnPipelines {
    frayed: wgpu::RenderPipeline,
    tube: wgpu::RenderPipeline,
    ribbon: wgpu::RenderPipeline,
    shadow: wgpu::RenderPipeline,
    layout: wgpu::BindGroupLayout,
    triangles: wgpu::Buffer,
    /// Where the triangles of a level start in the buffer, and where those of the last end.
    starts: Vec<u32>,
}

impl YarnPipelines {
    pub fn new(
        gpu: &Gpu,
        frame: &wgpu::BindGroupLayout,
        lit_frame: &wgpu::BindGroupLayout,
        samples: u32,
    ) -> Self {
        let device = &gpu.device;
        let layout =
            bind_group_layout(device, "yarn", wgpu::ShaderStages::VERTEX, &[STORAGE, STORAGE, STORAGE]);
        let constants = constants();
        let sources =
            [light::WGSL, &constants, include_str!("yarn/catmull_rom.wgsl"), include_str!("yarn.wgsl")];
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
        let [frayed, tube, ribbon, shadow] =
            [frayed, tube, ribbon, shadow].map(|pipeline| pipeline.build(device));

        let mut indices = Vec::new();
        let mut starts = vec![0];
        for level in Level::all() {
            indices.extend((0..RUN).flat_map(|span| level.triangles(span)));
            starts.push(indices.len() as u32);
        }
        let triangles = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("yarn triangles"),
            size: (indices.len() * size_of::<u32>()) as u64,
            usage: wgpu::BufferUsages::INDEX | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        gpu.queue.write_buffer(&triangles, 0, bytemuck::cast_slice(&indices));
        Self { frayed, tube, ribbon, shadow, layout, triangles, starts }
    }

    /// Draws what is in the picture; `scale` as in [`batches`].
    pub fn draw(
        &self,
        gpu: &Gpu,
        pass: &mut wgpu::RenderPass,
        mesh: &YarnMesh,
        scale: impl Fn(Vec3, f32) -> Option<f32>,
    ) {
        let batches = batches(&mesh.chunks, scale);
        let (ribbons, tubes) = batches.split_at(batches.partition_point(|batch| batch.level.is_ribbon()));
        let (plain, frayed) = tubes.split_at(tubes.partition_point(|batch| !batch.level.is_frayed()));
        // The widest yarn is nearest and hides some of the rest.
        self.draw_batches(gpu, pass, &self.frayed, mesh, frayed);
        self.draw_batches(gpu, pass, &self.tube, mesh, plain);
        self.draw_batches(gpu, pass, &self.ribbon, mesh, ribbons);
    }

    /// Draws into the shadow map; `scale` as in [`batches`].
    pub fn draw_shadow(
        &self,
        gpu: &Gpu,
        pass: &mut wgpu::RenderPass,
        mesh: &YarnMesh,
        scale: impl Fn(Vec3, f32) -> Option<f32>,
    ) {
        let mut batches = batches(&mesh.chunks, scale);
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
        let buffers = [&mesh.points, &mesh.stretches, &mesh.dyes].map(GrowingBuffer::buffer);
        let [Some(points), Some(stretches), Some(dyes)] = buffers else { return };
        if batches.is_empty() {
            return;
        }
        let buffers = [points, stretches, dyes].map(wgpu::Buffer::as_entire_binding);
        pass.set_pipeline(pipeline);
        pass.set_bind_group(1, &bind_group(&gpu.device, &self.layout, buffers.to_vec()), &[]);
        pass.set_index_buffer(self.triangles.slice(..), wgpu::IndexFormat::Uint32);
        for batch in batches {
            let level = batch.level.index();
            let (start, end) = (self.starts[level], self.starts[level + 1]);
            let count = (end - start) / RUN * (batch.end - batch.first);
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
