//! Triangles in flat colours: polygons of meshes, and bodies.

use glam::Vec3;
use wgpu::CompareFunction::{Greater, Less};

use crate::drawing::Faces;
use crate::light;
use crate::pipeline::{COLOR_FORMAT, Pipeline, shader};
use crate::scene::GrowingBuffer;
use crate::solids::{Solids, Vertex};
use crate::{Gpu, RenderError};

const ATTRIBUTES: [wgpu::VertexAttribute; 4] =
    wgpu::vertex_attr_array![0 => Float32x3, 1 => Float32x3, 2 => Float32x3, 3 => Float32];

/// Triangles on the GPU.
#[derive(Debug)]
pub(crate) struct SurfaceMesh {
    vertices: GrowingBuffer,
    count: u32,
}

impl SurfaceMesh {
    pub fn new() -> Self {
        Self { vertices: GrowingBuffer::new("triangles", wgpu::BufferUsages::VERTEX), count: 0 }
    }

    /// Replaces the triangles by those of polygons, each shaded by its mean normal so that a warped polygon still reads
    /// as one.
    pub fn set_faces(&mut self, gpu: &Gpu, faces: &Faces) -> Result<(), RenderError> {
        let mut vertices = Vec::with_capacity(faces.polygons.len() * 12);
        for (index, polygon) in faces.polygons.iter().enumerate() {
            let normal = faces.triangles(index).map(|[a, b, c]| (b - a).cross(c - a)).sum::<Vec3>();
            let normal = normal.try_normalize().unwrap_or(Vec3::Z);
            let corner = |position| Vertex { position, normal, color: polygon.color, opacity: 1.0 };
            vertices.extend(faces.triangles(index).flatten().map(corner));
        }
        self.set(gpu, &vertices)
    }

    /// Replaces the triangles by those of bodies.
    pub fn set_solids(&mut self, gpu: &Gpu, solids: &Solids) -> Result<(), RenderError> {
        self.set(gpu, &solids.vertices())
    }

    fn set(&mut self, gpu: &Gpu, vertices: &[Vertex]) -> Result<(), RenderError> {
        self.count = vertices.len() as u32;
        self.vertices.write(gpu, bytemuck::cast_slice(vertices), gpu.device.limits().max_buffer_size)
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
        let faces = Pipeline {
            label: "faces",
            module: &module,
            vertex: "surface_vertex",
            fragment: Some("surface_fragment"),
            layouts: &[lit_frame],
            vertices: Some(wgpu::VertexBufferLayout {
                array_stride: size_of::<Vertex>() as u64,
                step_mode: wgpu::VertexStepMode::Vertex,
                attributes: &ATTRIBUTES,
            }),
            topology: wgpu::PrimitiveTopology::TriangleList,
            cull: None,
            target: Some(COLOR_FORMAT),
            depth: Some(Greater),
            samples,
        };
        let vertices = || faces.vertices.clone();
        let solids =
            Pipeline { label: "solids", vertices: vertices(), cull: Some(wgpu::Face::Back), ..faces };
        let shadow = Pipeline {
            label: "surface shadow",
            fragment: None,
            layouts: &[frame],
            target: None,
            depth: Some(Less),
            samples: 1,
            vertices: vertices(),
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
        if let Some(buffer) = mesh.vertices.buffer().filter(|_| mesh.count > 0) {
            pass.set_pipeline(pipeline);
            pass.set_vertex_buffer(0, buffer.slice(..));
            pass.draw(0..mesh.count, 0..1);
        }
    }
}
