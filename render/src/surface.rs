//! Triangles in flat colours: polygons of meshes, and bodies.

use glam::{Vec3, Vec4};
use std::ops::Range;
use wgpu::CompareFunction::{GreaterEqual, Less};

use crate::damage::{Damage, Differences, Part};
use crate::drawing::{Faces, Polygon};
use crate::light;
use crate::mirror::{Mirror, bridged};
use crate::pipeline::{COLOR_FORMAT, Pipeline, shader};
use crate::solids::{Solids, Triangles};
use crate::{Gpu, RenderError};

const SHAPE: [wgpu::VertexAttribute; 2] = wgpu::vertex_attr_array![0 => Float32x3, 1 => Float32x3];
const COLOR: [wgpu::VertexAttribute; 1] = wgpu::vertex_attr_array![2 => Float32x4];

/// Triangles on the GPU.
#[derive(Debug)]
pub(crate) struct SurfaceMesh {
    /// Corners with normals.
    shape: Mirror<[Vec3; 2]>,
    /// Colour and opacity of each corner.
    colors: Mirror<Vec4>,
    /// Corners of triangles.
    indices: Mirror<u32>,
    /// Where polygons are among these; bodies are not known one by one.
    polygons: Vec<Place>,
}

/// Where a polygon is.
#[derive(Clone, Copy, Debug)]
struct Place {
    first_corner: u32,
    corners: u32,
    first_index: u32,
    indices: u32,
}

impl Place {
    fn corners(self) -> Range<usize> {
        self.first_corner as usize..(self.first_corner + self.corners) as usize
    }

    fn indices(self) -> Range<usize> {
        self.first_index as usize..(self.first_index + self.indices) as usize
    }
}

/// Whether a polygon of so many corners has their mean as one more: see [`Faces::cut`].
fn has_mean(corners: usize) -> bool {
    corners > 4
}

impl SurfaceMesh {
    pub fn new() -> Self {
        Self {
            shape: Mirror::new("corners", wgpu::BufferUsages::VERTEX),
            colors: Mirror::new("colours of corners", wgpu::BufferUsages::VERTEX),
            indices: Mirror::new("triangles", wgpu::BufferUsages::INDEX),
            polygons: Vec::new(),
        }
    }

    /// Replaces the triangles by those of polygons. While there are few holes nothing of those that are as before is worked out or written
    /// again.
    pub fn set_faces(&mut self, gpu: &Gpu, faces: &Faces, damage: &mut Damage) -> Result<(), RenderError> {
        self.become_those_of(faces, damage);
        self.upload(gpu)
    }

    fn become_those_of(&mut self, faces: &Faces, damage: &mut Damage) {
        let count = faces.polygons.len();
        let found = Differences::of([self.polygons.len(), count], |i, j| self.is(i, faces, j));
        found.gone.iter().for_each(|i| damage.add(self.outline(*i), 0.0));
        found.come.iter().for_each(|j| damage.add(faces.corners(*j), 0.0));
        let gone = found.gone.iter().map(|i| self.polygons[*i].corners as usize).sum::<usize>();
        let filled = self.polygons.iter().map(|p| p.corners as usize).sum::<usize>();
        if self.shape.has_too_many_holes(self.shape.items().len() - filled + gone) {
            self.clear();
            self.polygons = (0..count).map(|polygon| self.add(faces, polygon)).collect();
        } else if found != Differences::default() {
            let old = std::mem::take(&mut self.polygons);
            for place in found.gone.iter().map(|i| old[*i].indices()) {
                self.indices.fill(place, 0);
            }
            let before = found.before(count).enumerate();
            self.polygons = before.map(|(j, i)| i.map_or_else(|| self.add(faces, j), |i| old[i])).collect();
        }
    }

    /// Adds a polygon, shaded by its mean normal so that a warped one still reads as one.
    fn add(&mut self, faces: &Faces, polygon: usize) -> Place {
        let [corner, index] = [self.shape.items().len(), self.indices.items().len()];
        let normal = faces.triangles(polygon).map(|[a, b, c]| (b - a).cross(c - a)).sum::<Vec3>();
        let normal = normal.try_normalize().unwrap_or(Vec3::Z);
        self.shape.extend(faces.corners(polygon).map(|position| [position, normal]));
        let Polygon { vertices, color } = &faces.polygons[polygon];
        if has_mean(vertices.len()) {
            self.shape.extend([[faces.mean(polygon), normal]]);
        }
        let corners = self.shape.items().len() - corner;
        self.colors.extend(std::iter::repeat_n(Vec3::from(*color).extend(1.0), corners));
        self.indices.extend(faces.cut(polygon).flatten().map(|i| (corner + i) as u32));
        let indices = self.indices.items().len() - index;
        let [first_corner, corners, first_index, indices] =
            [corner, corners, index, indices].map(|n| n as u32);
        Place { first_corner, corners, first_index, indices }
    }

    fn clear(&mut self) {
        self.shape.clear();
        self.colors.clear();
        self.indices.clear();
        self.polygons.clear();
    }

    fn upload(&mut self, gpu: &Gpu) -> Result<(), RenderError> {
        self.shape.upload(gpu)?;
        self.indices.upload(gpu)?;
        self.colors.upload(gpu)
    }

    fn outline(&self, polygon: usize) -> impl Iterator<Item = Vec3> + Clone + '_ {
        self.shape.items()[self.polygons[polygon].corners()].iter().map(|[position, _]| *position)
    }

    /// The colour of a polygon; of one without corners it does not matter.
    fn color(&self, polygon: usize) -> Option<Vec4> {
        self.colors.items()[self.polygons[polygon].corners()].first().copied()
    }

    /// Whether a polygon is one of `faces`.
    fn is(&self, polygon: usize, faces: &Faces, other: usize) -> bool {
        let Polygon { vertices, color } = &faces.polygons[other];
        let corners = vertices.len();
        self.polygons[polygon].corners as usize == corners + usize::from(has_mean(corners))
            && self.color(polygon).is_none_or(|now| now == Vec3::from(*color).extend(1.0))
            && self.outline(polygon).zip(faces.corners(other)).all(|(a, b)| a == b)
    }

    /// Shows the polygons set before in other colours, [polygon_count].
    pub fn set_colors(
        &mut self,
        gpu: &Gpu,
        colors: &[[f32; 3]],
        damage: &mut Damage,
    ) -> Result<(), RenderError> {
        for (polygon, color) in (0..self.polygons.len()).zip(colors) {
            let color = Vec3::from(*color).extend(1.0);
            if self.color(polygon).is_some_and(|now| now != color) {
                damage.add(self.outline(polygon), 0.0);
                self.colors.fill(self.polygons[polygon].corners(), color);
            }
        }
        self.colors.upload(gpu)
    }

    /// Replaces the triangles by those of bodies.
    pub fn set_solids(&mut self, gpu: &Gpu, solids: &Solids) -> Result<(), RenderError> {
        let Triangles { vertices, indices } = solids.triangles();
        self.clear();
        self.shape.extend(vertices.iter().map(|v| [v.position, v.normal]));
        self.colors.extend(vertices.iter().map(|v| Vec3::from(v.color).extend(v.opacity)));
        self.indices.extend(indices);
        self.upload(gpu)
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
            // Equal depths pass: of two faces in one place the one that is drawn later is in front.
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
        let reached = (0..mesh.polygons.len()).filter(|p| part.is_reached_by(mesh.outline(*p)));
        // In the order in which all are drawn.
        let drawn = bridged(reached.map(|p| mesh.polygons[p].indices()).collect(), 0);
        let drawn = drawn.into_iter().map(|range| range.start as u32..range.end as u32);
        Self::draw_ranges(&self.faces, pass, mesh, drawn);
    }

    /// Draws bodies from outside.
    pub fn draw_solids(&self, pass: &mut wgpu::RenderPass, mesh: &SurfaceMesh) {
        Self::draw_with(&self.solids, pass, mesh);
    }

    pub fn draw_shadow(&self, pass: &mut wgpu::RenderPass, mesh: &SurfaceMesh) {
        Self::draw_with(&self.shadow, pass, mesh);
    }

    fn draw_with(pipeline: &wgpu::RenderPipeline, pass: &mut wgpu::RenderPass, mesh: &SurfaceMesh) {
        Self::draw_ranges(pipeline, pass, mesh, std::iter::once(0..mesh.indices.items().len() as u32));
    }

    fn draw_ranges(
        pipeline: &wgpu::RenderPipeline,
        pass: &mut wgpu::RenderPass,
        mesh: &SurfaceMesh,
        ranges: impl Iterator<Item = Range<u32>>,
    ) {
        let buffers = [mesh.shape.buffer(), mesh.colors.buffer(), mesh.indices.buffer()];
        if let [Some(shape), Some(colors), Some(indices)] = buffers {
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

    /// Corners and colours of the triangles of all polygons, in their order, and how many more have an area.
    fn triangles(mesh: &SurfaceMesh) -> (Vec<([Vec3; 2], Vec4)>, usize) {
        let indices = mesh.indices.items();
        let corner = |i: u32| (mesh.shape.items()[i as usize], mesh.colors.items()[i as usize]);
        let known = mesh.polygons.iter().flat_map(|p| p.indices()).map(|i| corner(indices[i]));
        let known: Vec<_> = known.collect();
        let all = indices.chunks(3).filter(|t| t[0] != t[1]).count();
        let more = all - known.len() / 3;
        (known, more)
    }

    #[test]
    fn what_is_kept_and_what_is_new_make_the_same_polygons() {
        let lists: [&[usize]; 8] = [
            &[4, 4, 4, 4, 4, 4, 4, 4],
            &[4, 5, 4, 4, 4, 4, 4, 4],
            &[4, 5, 4, 4, 0, 4, 4, 4],
            &[4, 6, 4],
            &[4, 6, 0, 4, 4],
            &[],
            &[5, 3],
            &[4, 4, 4, 4],
        ];
        let mut mesh = SurfaceMesh::new();
        let mut has_held_holes = false;
        for list in lists {
            let faces = faces(list);
            let mut damage = Damage::none();
            mesh.become_those_of(&faces, &mut damage);
            let mut anew = SurfaceMesh::new();
            anew.become_those_of(&faces, &mut Damage::none());
            assert_eq!(triangles(&mesh), (triangles(&anew).0, 0), "{list:?}");
            assert!(!damage.is_none());
            has_held_holes |= mesh.shape.items().len() > anew.shape.items().len();
            let mut damage = Damage::none();
            mesh.become_those_of(&faces, &mut damage);
            assert!(damage.is_none(), "all as before");
        }
        assert!(has_held_holes);
    }
}
