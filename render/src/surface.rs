//! Triangles in flat colours: polygons of meshes, and bodies.

use glam::{Vec3, Vec4};
use std::ops::Range;
use wgpu::CompareFunction::{GreaterEqual, Less};

use crate::damage::{Damage, Only, Part, differences, runs};
use crate::drawing::Faces;
use crate::light;
use crate::pipeline::{COLOR_FORMAT, Pipeline, shader};
use crate::scene::GrowingBuffer;
use crate::solids::{Solids, Triangles};
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
    now: Polygons,
}

/// Polygons as they are on the GPU.
#[derive(Debug, PartialEq)]
struct Polygons {
    /// Corners with normals.
    corners: Vec<[Vec3; 2]>,
    /// Corners of triangles.
    indices: Vec<u32>,
    /// First corner and first index of each polygon, and the end of all.
    starts: Vec<[u32; 2]>,
    colors: Vec<[f32; 3]>,
}

impl Polygons {
    /// Some of the polygons of a mesh, each shaded by its mean normal so that a warped polygon still reads as one.
    fn of(faces: &Faces, range: Range<usize>) -> Self {
        let mut polygons = Self {
            corners: Vec::with_capacity(range.len() * 4),
            indices: Vec::with_capacity(range.len() * 6),
            starts: Vec::with_capacity(range.len() + 1),
            colors: faces.polygons[range.clone()].iter().map(|p| p.color).collect(),
        };
        polygons.starts.push([0, 0]);
        for index in range {
            let normal = faces.triangles(index).map(|[a, b, c]| (b - a).cross(c - a)).sum::<Vec3>();
            let normal = normal.try_normalize().unwrap_or(Vec3::Z);
            let first = polygons.corners.len() as u32;
            polygons.corners.extend(faces.corners(index).map(|position| [position, normal]));
            if has_mean(faces.polygons[index].vertices.len()) {
                polygons.corners.push([faces.mean(index), normal]);
            }
            polygons.indices.extend(faces.cut(index).flatten().map(|i| first + i as u32));
            polygons.starts.push([polygons.corners.len() as u32, polygons.indices.len() as u32]);
        }
        polygons
    }

    fn count(&self) -> usize {
        self.starts.len() - 1
    }

    fn corners(&self, polygon: usize) -> &[[Vec3; 2]] {
        &self.corners[self.starts[polygon][0] as usize..self.starts[polygon + 1][0] as usize]
    }

    fn outline(&self, polygon: usize) -> impl Iterator<Item = Vec3> + Clone + '_ {
        self.corners(polygon).iter().map(|[position, _]| *position)
    }

    /// Whether a polygon is one of `faces`.
    fn is(&self, polygon: usize, faces: &Faces, other: usize) -> bool {
        let corners = faces.polygons[other].vertices.len();
        self.colors[polygon] == faces.polygons[other].color
            && self.corners(polygon).len() == corners + usize::from(has_mean(corners))
            && self.outline(polygon).zip(faces.corners(other)).all(|(a, b)| a == b)
    }

    /// Becomes the polygons of `faces`; of those that are as before at the beginning and at the end of the list nothing is worked out
    /// again. Returns the first that is not.
    fn become_those_of(&mut self, faces: &Faces, damage: &mut Damage) -> usize {
        let [n, m] = [self.count(), faces.polygons.len()];
        let least = n.min(m);
        let head = (0..least).find(|i| !self.is(*i, faces, *i)).unwrap_or(least);
        let rest = least - head;
        let tail = (0..rest).find(|i| !self.is(n - 1 - i, faces, m - 1 - i)).unwrap_or(rest);
        let others = Self::of(faces, head..m - tail);
        let alike = |i: usize, j: usize| self.is(head + i, faces, head + j);
        differences([n - tail - head, others.count()], alike, |only| match only {
            Only::Before(i) => damage.add(self.outline(head + i), 0.0),
            Only::After(j) => damage.add(others.outline(j), 0.0),
        });
        self.replace(head..n - tail, others);
        head
    }

    /// Puts others in place of some polygons.
    fn replace(&mut self, range: Range<usize>, by: Self) {
        let [from, to] = [range.start, range.end].map(|p| self.starts[p].map(|n| n as usize));
        let added = by.starts[by.count()];
        // Those behind move by as much as there is more now, or less.
        let moved = |n: u32, i: usize| n + from[i] as u32 + added[i] - to[i] as u32;
        self.indices[to[1]..].iter_mut().for_each(|n| *n = moved(*n, 0));
        self.starts[range.end..].iter_mut().for_each(|s| *s = [moved(s[0], 0), moved(s[1], 1)]);
        self.corners.splice(from[0]..to[0], by.corners);
        self.indices.splice(from[1]..to[1], by.indices.iter().map(|n| n + from[0] as u32));
        let starts = by.starts[..by.starts.len() - 1].iter();
        self.starts.splice(range.clone(), starts.map(|s| [s[0] + from[0] as u32, s[1] + from[1] as u32]));
        self.colors.splice(range, by.colors);
    }

    /// Colour and opacity of the corners of some polygons.
    fn corner_colors(&self, polygons: Range<usize>) -> Vec<Vec4> {
        let each = polygons.map(|p| (Vec3::from(self.colors[p]).extend(1.0), self.corners(p).len()));
        each.flat_map(|(color, n)| std::iter::repeat_n(color, n)).collect()
    }
}

/// Whether a polygon of so many corners has their mean as one more: see [`Faces::cut`].
fn has_mean(corners: usize) -> bool {
    corners > 4
}

impl SurfaceMesh {
    pub fn new() -> Self {
        Self {
            shape: GrowingBuffer::new("corners", wgpu::BufferUsages::VERTEX),
            colors: GrowingBuffer::new("colours of corners", wgpu::BufferUsages::VERTEX),
            indices: GrowingBuffer::new("triangles", wgpu::BufferUsages::INDEX),
            count: 0,
            now: Polygons::of(&Faces::default(), 0..0),
        }
    }

    /// Replaces the triangles by those of polygons. Those at the beginning that are as before are not written again.
    pub fn set_faces(&mut self, gpu: &Gpu, faces: &Faces, damage: &mut Damage) -> Result<(), RenderError> {
        let head = self.now.become_those_of(faces, damage);
        let now = &self.now;
        let [corner, index] = now.starts[head].map(|n| n as usize);
        let limit = gpu.device.limits().max_buffer_size;
        self.count = now.indices.len() as u32;
        let shape = bytemuck::cast_slice(&now.corners);
        self.shape.write_from(gpu, shape, corner * size_of::<[Vec3; 2]>(), limit)?;
        let indices = bytemuck::cast_slice(&now.indices);
        self.indices.write_from(gpu, indices, index * size_of::<u32>(), limit)?;
        let colors = now.corner_colors(0..now.count());
        self.colors.write_from(gpu, bytemuck::cast_slice(&colors), corner * size_of::<Vec4>(), limit)
    }

    /// Shows the polygons set before in other colours, [polygon_count].
    pub fn set_colors(&mut self, gpu: &Gpu, colors: &[[f32; 3]], damage: &mut Damage) {
        let count = self.now.count().min(colors.len());
        let mut changed = count..0;
        for polygon in (0..count).filter(|p| colors[*p] != self.now.colors[*p]) {
            damage.add(self.now.outline(polygon), 0.0);
            changed = changed.start.min(polygon)..polygon + 1;
        }
        if changed.is_empty() {
            return;
        }
        self.now.colors[changed.clone()].copy_from_slice(&colors[changed.clone()]);
        let first = self.now.starts[changed.start][0] as usize;
        let colors = self.now.corner_colors(changed);
        self.colors.overwrite(gpu, bytemuck::cast_slice(&colors), first * size_of::<Vec4>());
    }

    /// Replaces the triangles by those of bodies.
    pub fn set_solids(&mut self, gpu: &Gpu, solids: &Solids) -> Result<(), RenderError> {
        let Triangles { vertices, indices } = solids.triangles();
        let shape: Vec<_> = vertices.iter().map(|v| [v.position, v.normal]).collect();
        let colors: Vec<_> = vertices.iter().map(|v| Vec3::from(v.color).extend(v.opacity)).collect();
        let limit = gpu.device.limits().max_buffer_size;
        self.count = indices.len() as u32;
        self.shape.write(gpu, bytemuck::cast_slice(&shape), limit)?;
        self.indices.write(gpu, bytemuck::cast_slice(&indices), limit)?;
        self.colors.write(gpu, bytemuck::cast_slice(&colors), limit)
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
        let module = shader(device, "surface", &[&light::wgsl(shadows), include_str!("surface.wgsl")]);
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
            // Equal depths pass: what comes later is in front, as of two faces in one place.
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

    /// Draws polygons from both sides, all or those that reach into a part of the picture.
    pub fn draw_faces(&self, pass: &mut wgpu::RenderPass, mesh: &SurfaceMesh, part: Option<&Part>) {
        let Some(part) = part else {
            Self::draw_with(&self.faces, pass, mesh);
            return;
        };
        let polygons = &mesh.now;
        let drawn = runs(polygons.count(), |p| part.is_reached_by(polygons.outline(p)));
        let indices = drawn.into_iter().map(|r| polygons.starts[r.start][1]..polygons.starts[r.end][1]);
        Self::draw_ranges(&self.faces, pass, mesh, indices);
    }

    /// Draws bodies from outside.
    pub fn draw_solids(&self, pass: &mut wgpu::RenderPass, mesh: &SurfaceMesh) {
        Self::draw_with(&self.solids, pass, mesh);
    }

    pub fn draw_shadow(&self, pass: &mut wgpu::RenderPass, mesh: &SurfaceMesh) {
        Self::draw_with(&self.shadow, pass, mesh);
    }

    fn draw_with(pipeline: &wgpu::RenderPipeline, pass: &mut wgpu::RenderPass, mesh: &SurfaceMesh) {
        Self::draw_ranges(pipeline, pass, mesh, std::iter::once(0..mesh.count));
    }

    fn draw_ranges(
        pipeline: &wgpu::RenderPipeline,
        pass: &mut wgpu::RenderPass,
        mesh: &SurfaceMesh,
        ranges: impl Iterator<Item = Range<u32>>,
    ) {
        let buffers = [&mesh.shape, &mesh.colors, &mesh.indices].map(GrowingBuffer::buffer);
        if let ([Some(shape), Some(colors), Some(indices)], 1..) = (buffers, mesh.count) {
            pass.set_pipeline(pipeline);
            pass.set_vertex_buffer(0, shape.slice(..));
            pass.set_vertex_buffer(1, colors.slice(..));
            pass.set_index_buffer(indices.slice(..), wgpu::IndexFormat::Uint32);
            ranges.for_each(|range| pass.draw_indexed(range, 0, 0..1));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::drawing::Polygon;

    /// Polygons of these numbers of corners on a spiral, so that no two are alike.
    fn faces(corners: &[usize]) -> Faces {
        let mut faces = Faces::default();
        for (i, n) in corners.iter().enumerate() {
            let first = faces.positions.len() as u32;
            let middle = Vec3::new(i as f32, (*n * *n) as f32, 0.0);
            let around = |k: usize| Vec3::from((glam::Vec2::from_angle(k as f32 / *n as f32 * 6.2), 0.0));
            faces.positions.extend((0..*n).map(|k| middle + around(k)));
            let vertices = (first..first + *n as u32).collect();
            faces.polygons.push(Polygon { vertices, color: [0.5; 3] });
        }
        faces
    }

    #[test]
    fn what_is_kept_and_what_is_new_make_the_same_polygons() {
        let lists: [&[usize]; 7] =
            [&[4, 4, 4, 4], &[4, 5, 4, 4], &[4, 6, 4], &[4, 6, 0, 4, 4], &[], &[5, 3], &[4, 4, 4, 4]];
        let mut polygons = Polygons::of(&Faces::default(), 0..0);
        for list in lists {
            let faces = faces(list);
            let mut damage = Damage::none();
            polygons.become_those_of(&faces, &mut damage);
            assert_eq!(polygons, Polygons::of(&faces, 0..list.len()), "{list:?}");
            assert!(!damage.is_none());
            assert_eq!(polygons.become_those_of(&faces, &mut Damage::none()), list.len(), "all as before");
        }
    }
}
