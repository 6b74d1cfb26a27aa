//! Triangles in flat colours: polygons of meshes, and bodies.

use glam::{Vec3, Vec4};
use std::ops::Range;
use wgpu::CompareFunction::{GreaterEqual, Less};

use crate::drawing::{Faces, Polygon, triangles};
use crate::light;
use crate::pipeline::{COLOR_FORMAT, Pipeline, shader};
use crate::scene::GrowingBuffer;
use crate::solids::Solids;
use crate::{Gpu, RenderError};

const SHAPE: [wgpu::VertexAttribute; 2] = wgpu::vertex_attr_array![0 => Float32x3, 1 => Float32x3];
const COLOR: [wgpu::VertexAttribute; 1] = wgpu::vertex_attr_array![2 => Float32x4];

/// Triangles on the GPU.
#[derive(Debug)]
pub(crate) struct SurfaceMesh {
    shape: GrowingBuffer,
    /// Colour and opacity of each corner.
    colors: GrowingBuffer,
    indices: GrowingBuffer,
    /// Number of indices.
    count: u32,
    /// The colours of polygons.
    now: Vec<[f32; 3]>,
    /// Indices of the polygons that have had other colours since all were drawn.
    changed: Vec<Range<u32>>,
}

impl SurfaceMesh {
    pub fn new() -> Self {
        Self {
            shape: GrowingBuffer::new("corners", wgpu::BufferUsages::VERTEX),
            colors: GrowingBuffer::new("colours of corners", wgpu::BufferUsages::VERTEX),
            indices: GrowingBuffer::new("triangles", wgpu::BufferUsages::INDEX),
            count: 0,
            now: Vec::new(),
            changed: Vec::new(),
        }
    }

    /// Replaces the triangles by those of polygons, each shaded by its mean normal so that a warped polygon still reads
    /// as one.
    pub fn set_faces(&mut self, gpu: &Gpu, faces: &Faces) -> Result<(), RenderError> {
        let mut shape = Vec::with_capacity(faces.polygons.len() * 4);
        let mut indices = Vec::with_capacity(faces.polygons.len() * 6);
        for (index, polygon) in faces.polygons.iter().enumerate() {
            let normal = faces.triangles(index).map(|[a, b, c]| (b - a).cross(c - a)).sum::<Vec3>();
            let normal = normal.try_normalize().unwrap_or(Vec3::Z);
            let first = shape.len() as u32;
            shape.extend(faces.corners(index).map(|position| [position, normal]));
            if polygon.vertices.len() > 4 {
                shape.push([faces.mean(index), normal]);
            }
            indices.extend(faces.cut(index).flatten().map(|i| first + i as u32));
        }
        self.set(gpu, &shape, &indices)?;
        self.now.clear();
        self.set_colors(gpu, faces, &Vec::from_iter(faces.polygons.iter().map(|p| p.color)))
    }

    /// Shows the polygons set before in other colours, [polygon_count].
    pub fn set_colors(&mut self, gpu: &Gpu, faces: &Faces, colors: &[[f32; 3]]) -> Result<(), RenderError> {
        let corners = |polygon: &Polygon| match polygon.vertices.len() {
            n @ 0..5 => n,
            n => n + 1,
        };
        let color = |c: &[f32; 3]| Vec3::from(*c).extend(1.0);
        let each = || faces.polygons.iter().zip(colors);
        let mut begin = 0;
        for ((polygon, color), before) in each().zip(&self.now) {
            let end = begin + 3 * triangles(polygon.vertices.len()) as u32;
            if color != before {
                match self.changed.last_mut().filter(|last| last.end == begin) {
                    Some(last) => last.end = end,
                    None => self.changed.push(begin..end),
                }
            }
            begin = end;
        }
        self.now.clear();
        self.now.extend_from_slice(colors);
        let colors: Vec<Vec4> = each().flat_map(|(p, c)| std::iter::repeat_n(color(c), corners(p))).collect();
        self.colors.write(gpu, bytemuck::cast_slice(&colors), gpu.device.limits().max_buffer_size)
    }

    /// Forgets which polygons have changed: they have been drawn.
    pub fn settle(&mut self) {
        self.changed.clear();
    }

    /// Replaces the triangles by those of bodies.
    pub fn set_solids(&mut self, gpu: &Gpu, solids: &Solids) -> Result<(), RenderError> {
        let vertices = solids.vertices();
        let shape: Vec<_> = vertices.iter().map(|v| [v.position, v.normal]).collect();
        let colors: Vec<_> = vertices.iter().map(|v| Vec3::from(v.color).extend(v.opacity)).collect();
        self.set(gpu, &shape, &Vec::from_iter(0..shape.len() as u32))?;
        self.colors.write(gpu, bytemuck::cast_slice(&colors), gpu.device.limits().max_buffer_size)
    }

    /// Replaces positions with normals, and triangles of them.
    fn set(&mut self, gpu: &Gpu, shape: &[[Vec3; 2]], indices: &[u32]) -> Result<(), RenderError> {
        let limit = gpu.device.limits().max_buffer_size;
        self.count = indices.len() as u32;
        self.shape.write(gpu, bytemuck::cast_slice(shape), limit)?;
        self.indices.write(gpu, bytemuck::cast_slice(indices), limit)
    }
}

/// The pipelines that draw them.
#[derive(Debug)]
pub(crate) struct SurfacePipelines {
    faces: wgpu::RenderPipeline,
    solids: wgpu::RenderPipeline,
    shadow: wgpu::RenderPipeline,
}

impl SurfacePipelines {
    pub fn new(
        device: &wgpu::Device,
        frame: &wgpu::BindGroupLayout,
        lit_frame: &wgpu::BindGroupLayout,
        samples: u32,
        shadows: bool,
    ) -> Self {
        let module = shader(device, "surface", &[light::WGSL, include_str!("surface.wgsl")]);
        let buffer = |stride: usize, attributes| {
            let step_mode = wgpu::VertexStepMode::Vertex;
            Some(wgpu::VertexBufferLayout { array_stride: stride as u64, step_mode, attributes })
        };
        let solids = Pipeline {
            label: "solids",
            module: &module,
            vertex: "surface_vertex",
            fragment: Some("surface_fragment"),
            layouts: &[lit_frame],
            vertices: &[buffer(size_of::<[Vec3; 2]>(), &SHAPE), buffer(size_of::<Vec4>(), &COLOR)],
            topology: wgpu::PrimitiveTopology::TriangleList,
            cull: Some(wgpu::Face::Back),
            target: Some(COLOR_FORMAT),
            // Equal depths pass: a face is drawn over itself when it changes colour.
            depth: Some(GreaterEqual),
            samples,
        };
        let [vertex, fragment] =
            if shadows { ["surface_vertex", "surface_fragment"] } else { ["flat_vertex", "flat_fragment"] };
        let faces = Pipeline { label: "faces", cull: None, vertex, fragment: Some(fragment), ..solids };
        let shadow = Pipeline {
            label: "surface shadow",
            fragment: None,
            layouts: &[frame],
            target: None,
            depth: Some(Less),
            samples: 1,
            cull: None,
            ..solids
        };
        Self { solids: solids.build(device), shadow: shadow.build(device), faces: faces.build(device) }
    }

    /// Draws polygons from both sides.
    pub fn draw_faces(&self, pass: &mut wgpu::RenderPass, mesh: &SurfaceMesh) {
        Self::draw_with(&self.faces, pass, mesh);
    }

    /// Draws bodies from outside.
    pub fn draw_solids(&self, pass: &mut wgpu::RenderPass, mesh: &SurfaceMesh) {
        Self::draw_with(&self.solids, pass, mesh);
    }

    pub fn draw_shadow(&self, pass: &mut wgpu::RenderPass, mesh: &SurfaceMesh) {
        Self::draw_with(&self.shadow, pass, mesh);
    }

    /// Draws the polygons that have changed over what they were.
    pub fn draw_changed(&self, pass: &mut wgpu::RenderPass, mesh: &SurfaceMesh) {
        Self::draw_ranges(&self.faces, pass, mesh, &mesh.changed);
    }

    fn draw_with(pipeline: &wgpu::RenderPipeline, pass: &mut wgpu::RenderPass, mesh: &SurfaceMesh) {
        Self::draw_ranges(pipeline, pass, mesh, std::slice::from_ref(&(0..mesh.count)));
    }

    fn draw_ranges(
        pipeline: &wgpu::RenderPipeline,
        pass: &mut wgpu::RenderPass,
        mesh: &SurfaceMesh,
        ranges: &[Range<u32>],
    ) {
        let buffers = [&mesh.shape, &mesh.colors, &mesh.indices].map(GrowingBuffer::buffer);
        if let ([Some(shape), Some(colors), Some(indices)], 1..) = (buffers, mesh.count) {
            pass.set_pipeline(pipeline);
            pass.set_vertex_buffer(0, shape.slice(..));
            pass.set_vertex_buffer(1, colors.slice(..));
            pass.set_index_buffer(indices.slice(..), wgpu::IndexFormat::Uint32);
            ranges.iter().for_each(|range| pass.draw_indexed(range.clone(), 0, 0..1));
        }
    }
}
