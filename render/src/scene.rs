//! A drawing on the GPU. Buffers live as long as the scene and grow; updating one part leaves the others alone, so that
//! yarn can move every frame while everything else stays.

use crate::damage::Damage;
use crate::drawing::{Drawing, Faces, Lines};
use crate::lines::LineMesh;
use crate::surface::SurfaceMesh;
use crate::yarn::{LaidYarn, YarnLayout, YarnMesh};
use crate::{Bounds, Gpu, RenderError, Solids};

/// What to draw, on the GPU.
#[derive(Debug)]
pub struct Scene {
    pub(crate) faces: SurfaceMesh,
    pub(crate) solids: SurfaceMesh,
    pub(crate) lines: LineMesh,
    pub(crate) marks: LineMesh,
    pub(crate) yarn: YarnMesh,
    /// What has changed since it was drawn.
    pub(crate) damage: Damage,
    face_bounds: Option<Bounds>,
    solid_bounds: Option<Bounds>,
}

impl Default for Scene {
    fn default() -> Self {
        Self::new()
    }
}

impl Scene {
    /// An empty scene.
    pub fn new() -> Self {
        Self {
            faces: SurfaceMesh::new(),
            solids: SurfaceMesh::new(),
            lines: LineMesh::new(),
            marks: LineMesh::new(),
            yarn: YarnMesh::new(),
            damage: Damage::all(),
            face_bounds: None,
            solid_bounds: None,
        }
    }

    /// Replaces everything but the marks.
    pub fn set(&mut self, gpu: &Gpu, drawing: &Drawing) -> Result<(), RenderError> {
        self.set_faces(gpu, &drawing.faces)?;
        self.set_lines(gpu, &drawing.lines)?;
        self.set_solids(gpu, &drawing.solids)?;
        self.set_yarn(gpu, &YarnLayout::of(&drawing.yarn))
    }

    /// Replaces the polygons.
    pub fn set_faces(&mut self, gpu: &Gpu, faces: &Faces) -> Result<(), RenderError> {
        self.face_bounds = Bounds::of(faces.positions.iter().copied());
        self.faces.set_faces(gpu, faces, &mut self.damage)
    }

    /// Shows the faces that were set before in other colours, [polygon_count].
    pub fn set_colors(&mut self, gpu: &Gpu, colors: &[[f32; 3]]) -> Result<(), RenderError> {
        self.faces.set_colors(gpu, colors, &mut self.damage)
    }

    /// Says that what the scene holds now has been drawn.
    pub fn settle(&mut self) {
        self.damage = Damage::none();
        self.lines.settle();
    }

    /// Whether what the scene holds has been drawn.
    pub fn is_settled(&self) -> bool {
        self.damage.is_none()
    }

    /// Replaces the lines.
    pub fn set_lines(&mut self, gpu: &Gpu, lines: &Lines) -> Result<(), RenderError> {
        self.lines.set(gpu, lines, &mut self.damage)
    }

    /// Replaces the marks: lines over everything else that come and go with the pointer, however many other lines there are.
    pub fn set_marks(&mut self, gpu: &Gpu, marks: &Lines) -> Result<(), RenderError> {
        self.marks.set(gpu, marks, &mut self.damage)
    }

    /// Replaces the bodies.
    pub fn set_solids(&mut self, gpu: &Gpu, solids: &Solids) -> Result<(), RenderError> {
        let bounds = solids.bounds();
        if bounds.is_some() || self.solid_bounds.is_some() {
            self.damage = Damage::all();
        }
        self.solid_bounds = bounds;
        self.solids.set_solids(gpu, solids)
    }

    /// Replaces the yarn.
    pub fn set_yarn(&mut self, gpu: &Gpu, yarn: &YarnLayout) -> Result<(), RenderError> {
        if !yarn.is_empty() || self.yarn.radius() > 0.0 {
            self.damage = Damage::all();
        }
        self.yarn.set(gpu, yarn)
    }

    /// Draws from now on yarn that lies in buffers of the same device.
    pub fn share_yarn(&mut self, yarn: LaidYarn) {
        self.damage = Damage::all();
        self.yarn.share(yarn);
    }

    /// The box around everything that casts a shadow, but the ground.
    pub(crate) fn bounds(&self) -> Option<Bounds> {
        [self.face_bounds, self.solid_bounds, self.yarn.bounds()].into_iter().flatten().reduce(Bounds::union)
    }
}

/// A buffer that is replaced by a larger one when its contents outgrow it.
#[derive(Debug)]
pub(crate) struct GrowingBuffer {
    what: &'static str,
    usage: wgpu::BufferUsages,
    buffer: Option<wgpu::Buffer>,
}

impl GrowingBuffer {
    pub fn new(what: &'static str, usage: wgpu::BufferUsages) -> Self {
        Self { what, usage: usage | wgpu::BufferUsages::COPY_DST, buffer: None }
    }

    /// The buffer, once something was written.
    pub fn buffer(&self) -> Option<&wgpu::Buffer> {
        self.buffer.as_ref()
    }

    /// Replaces the contents.
    pub fn write(&mut self, gpu: &Gpu, bytes: &[u8], limit: u64) -> Result<(), RenderError> {
        self.write_from(gpu, bytes, 0, limit)
    }

    /// Replaces the contents, which are the same as before up to byte `same`.
    pub fn write_from(
        &mut self,
        gpu: &Gpu,
        bytes: &[u8],
        same: usize,
        limit: u64,
    ) -> Result<(), RenderError> {
        let needed = bytes.len() as u64;
        if needed > limit {
            self.buffer = None; // what it holds is no part of what comes next
            return Err(RenderError::TooLarge { what: self.what, bytes: needed, limit });
        }
        if needed == 0 {
            return Ok(());
        }
        let fits = |buffer: &wgpu::Buffer| buffer.size() >= needed;
        let mut same = same.min(bytes.len());
        let buffer = self.buffer.take().filter(fits).unwrap_or_else(|| {
            same = 0;
            gpu.device.create_buffer(&wgpu::BufferDescriptor {
                label: Some(self.what),
                // A quarter more than needed: a fabric that grows by the row is not reallocated at every row.
                size: (needed + needed / 4).next_multiple_of(16).min(limit),
                usage: self.usage,
                mapped_at_creation: false,
            })
        });
        gpu.queue.write_buffer(&buffer, same as u64, &bytes[same..]);
        self.buffer = Some(buffer);
        Ok(())
    }

    /// Replaces some of the contents, from byte `first` on.
    pub fn overwrite(&self, gpu: &Gpu, bytes: &[u8], first: usize) {
        if let Some(buffer) = &self.buffer {
            gpu.queue.write_buffer(buffer, first as u64, bytes);
        }
    }
}
