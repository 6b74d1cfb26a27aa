//! Triangles in flat colours: polygons of meshes, and bodies.

use glam::{Vec3, Vec4};
use wgpu::CompareFunction::{Greater, Less};

use crate::drawing::{Faces, Polygon};
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
}

impl SurfaceMesh {
    pub fn new() -> Self {
        Self {
            shape: GrowingBuffer::new("corners", wgpu::BufferUsages::VERTEX),
            colors: GrowingBuffer::new("colours of corners", wgpu::BufferUsages::VERTEX),
            indices: GrowingBuffer::new("triangles", wgpu::BufferUsages::INDEX),
            count: 0,
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
        self.set_colors(gpu, faces, &Vec::from_iter(faces.polygons.iter().map(|p| p.color)))
    }

    /// Shows the polygons set before in other colours, [polygon_count].
    pub fn set_colors(&mut self, gpu: &Gpu, faces: &Faces, colors: &[[f32; 3]]) -> Result<(), RenderError> {
        let corners = |polygon: &Polygon| match polygon.vertices.len() {
            n @ 0..5 => n,
            n => n + 1,
        };
        let color = |c: &[f32; 3]| Vec3::from(*c).extend(1.0);
        let each = faces.polygons.iter().zip(colors);
        let colors: Vec<Vec4> = each.flat_map(|(p, c)| std::iter::repeat_n(color(c), corners(p))).collect();
        self.colors.write(gpu, bytemuck::cast_slice(&colors), gpu.device.limits().max_buffer_size)
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
    ) -> Self {
        let module = shader(device, "surface", &[light::WGSL, include_str!("surface.wgsl")]);
        let buffer = |stride: usize, attributes| {
            let step_mode = wgpu::VertexStepMode::Vertex;
            Some(wgpu::VertexBufferLayout { array_stride: stride as u64, step_mode, attributes })
        };
        let faces = Pipeline {
            label: "faces",
            module: &module,
            vertex: "surface_vertex",
            fragment: Some("surface_fragment"),
            layouts: &[lit_frame],
            vertices: &[buffer(size_of::<[Vec3; 2]>(), &SHAPE), buffer(size_of::<Vec4>(), &COLOR)],
            topology: wgpu::PrimitiveTopology::TriangleList,
            cull: None,
            target: Some(COLOR_FORMAT),
            depth: Some(Greater),
            samples,
        };
        let solids = Pipeline { label: "solids", cull: Some(wgpu::Face::Back), ..faces };
        let shadow = Pipeline {
            label: "surface shadow",
            fragment: None,
            layouts: &[frame],
            target: None,
            depth: Some(Less),
            samples: 1,
            ..faces
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

    fn draw_with(pipeline: &wgpu::RenderPipeline, pass: &mut wgpu::RenderPass, mesh: &SurfaceMesh) {
        let buffers = [&mesh.shape, &mesh.colors, &mesh.indices].map(GrowingBuffer::buffer);
        if let ([Some(shape), Some(colors), Some(indices)], 1..) = (buffers, mesh.count) {
            pass.set_pipeline(pipeline);
            pass.set_vertex_buffer(0, shape.slice(..));
            pass.set_vertex_buffer(1, colors.slice(..));
            pass.set_index_buffer(indices.slice(..), wgpu::IndexFormat::Uint32);
            pass.draw_indexed(0..mesh.count, 0, 0..1);
        }
    }
}
