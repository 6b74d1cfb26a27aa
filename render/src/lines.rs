//! Lines of constant width on the screen.

use glam::Vec3;
use std::ops::Range;

use crate::damage::{Damage, Differences, Part, runs};
use crate::drawing::{Lines, Segment};
use crate::mirror::Mirror;
use crate::pipeline::{COLOR_FORMAT, Pipeline, shader};
use crate::{Gpu, RenderError};

const ATTRIBUTES: [wgpu::VertexAttribute; 4] =
    wgpu::vertex_attr_array![0 => Float32x3, 1 => Float32x3, 2 => Float32x3, 3 => Float32];

/// Lines shorter than so many of their widths on the screen, in the mean, are left out.
const ROOM: f32 = 3.0;

/// Where there is no line: nothing of it is drawn.
const HOLE: Segment = Segment { ends: [Vec3::ZERO; 2], color: [0.0; 3], width: 0.0 };

/// Lines on the GPU.
#[derive(Debug)]
pub(crate) struct LineMesh {
    lines: Mirror<Segment>,
    /// Where each line is among these.
    places: Vec<u32>,
    /// Mean length [m] and width [px], and what they were when all was drawn last.
    mean: [f32; 2],
    drawn: [f32; 2],
}

impl LineMesh {
    pub fn new() -> Self {
        Self {
            lines: Mirror::new("lines", wgpu::BufferUsages::VERTEX),
            places: Vec::new(),
            mean: [0.0; 2],
            drawn: [0.0; 2],
        }
    }

    pub fn set(&mut self, gpu: &Gpu, lines: &Lines, damage: &mut Damage) -> Result<(), RenderError> {
        let segments = &lines.segments;
        let (now, places) = (self.lines.items(), &self.places);
        let at = |i: usize| &now[places[i] as usize];
        let found = Differences::of([places.len(), segments.len()], |i, j| *at(i) == segments[j]);
        let gone = found.gone.iter().map(|i| at(*i));
        let others = gone.chain(found.come.iter().map(|j| &segments[*j])).filter(|line| line.width > 0.0);
        others.for_each(|line| damage.add(line.ends, line.width));

        let holes = now.len() - places.len() + found.gone.len();
        if self.lines.has_too_many_holes(holes) {
            self.lines.clear();
            self.lines.extend(segments.iter().copied());
            self.places = (0..segments.len() as u32).collect();
        } else if found != Differences::default() {
            for place in found.gone.iter().map(|i| self.places[*i] as usize) {
                self.lines.fill(place..place + 1, HOLE);
            }
            let mut end = self.lines.items().len() as u32..;
            self.lines.extend(found.come.iter().map(|j| segments[*j]));
            let before = found.before(segments.len());
            let places =
                before.filter_map(|before| before.map_or_else(|| end.next(), |i| Some(self.places[i])));
            self.places = places.collect();
        }
        let drawn = segments.iter().filter(|s| s.width > 0.0);
        let add =
            |[n, l, w]: [f32; 3], s: &Segment| [n + 1.0, l + s.ends[0].distance(s.ends[1]), w + s.width];
        let [count, length, width] = drawn.fold([0.0; 3], add);
        self.mean = [length, width].map(|sum| sum / count.max(1.0));
        self.lines.upload(gpu)
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
                array_stride: size_of::<Segment>() as u64,
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
        if let Some(buffer) = mesh.lines.buffer() {
            pass.set_pipeline(&self.0);
            pass.set_vertex_buffer(0, buffer.slice(..));
            let lines = mesh.lines.items();
            let mut draw = |run: Range<usize>| pass.draw(0..4, run.start as u32..run.end as u32);
            match part {
                // Holes are quads without an area.
                None => draw(0..lines.len()),
                Some(part) => {
                    let reached = |line: usize| {
                        let Segment { ends, width, .. } = lines[line];
                        width > 0.0 && part.is_reached_by(ends.into_iter())
                    };
                    runs(lines.len(), reached).into_iter().for_each(draw);
                }
            }
        }
    }
}
