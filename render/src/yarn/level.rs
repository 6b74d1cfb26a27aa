//! Level of detail: how finely a stretch of yarn is drawn, and whether at all.
//!
//! # Theory
//!
//! Yarn that is a few pixels wide is drawn as a flat ribbon that faces the eye, with the normals of a round yarn; wider
//! yarn as a tube with enough sides for its outline. Where a yarn is hardly wider than a pixel, the ribbon is a thread: one
//! pixel takes in all of its roundness, so it has the mean of the light on it all across.
//! Along the yarn, a chord of length L of an arc of radius R misses it
//! by L²/8R. The tightest bends of a knitted yarn have a radius of about one yarn diameter, so a chord may be as long as
//! 4 √(error · radius) for an error in pixels and the yarn's radius in pixels. From afar that is more than a span, and a step
//! takes in two or four of them.
//!
//! # Practice
//!
//! Every level draws a part of one fine grid of [`SAMPLES`] steps along a span by [`SIDES`] around it, so the vertex
//! shader knows no levels, and the rings where two levels meet coincide.
//!
//! On a software adapter a garment of 9 500 loops, 390 pixels high, takes 39 ms of processor time in threads of two spans a step,
//! and 46 with ribbons in their place.

use glam::Vec3;

/// Steps along a span in the finest level, a power of two.
pub(crate) const SAMPLES: u32 = 16;
/// Sides of a tube in the finest level.
pub(crate) const SIDES: u32 = 24;
/// Vertices of the finest grid of a span; its last ring is the first of the next span.
pub(crate) const SPAN_VERTICES: u32 = SAMPLES * (SIDES + 1);
/// Spans that one draw call can take.
pub(crate) const RUN: u32 = 128;
/// log₂ of the spans that one step of the coarsest level takes in.
const MERGED: u32 = 2;
/// Numbers of steps that a span can have: from a step that takes in several spans to [`SAMPLES`] steps.
const STEPS: u32 = MERGED + SAMPLES.ilog2() + 1;
/// Sides of the tubes, finest last; each divides [`SIDES`]. The first stands for a thread, the second for a ribbon.
const TUBES: [u32; 6] = [1, 1, 6, 8, 12, SIDES];
const RIBBON: usize = 1;
/// From this of the tubes on, the yarn is wide enough to fray.
const FRAYED: usize = 4;
/// A tube of so many sides is used up to this radius [px], where the flat sides show by half a pixel or so; a thread up to
/// where the two sides of the yarn can be told apart.
const TUBE_RADII: [f32; 5] = [0.75, 5.0, 7.0, 13.0, 28.0];
/// How far drawn yarn may lie beside the spline in a picture that is looked at [px]: 0.5 is seen at the outline, 0.2 only costs time.
pub(crate) const ERROR: f32 = 0.35;

/// How finely to draw.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Level {
    /// Index into [`TUBES`].
    tube: usize,
    /// log₂ of the steps along as many spans as the coarsest step takes in.
    steps: u32,
}

impl Level {
    /// All levels, in the order of their `index`.
    pub fn all() -> impl Iterator<Item = Self> {
        (0..TUBES.len()).flat_map(|tube| (0..STEPS).map(move |steps| Self { tube, steps }))
    }

    pub fn index(self) -> usize {
        self.tube * STEPS as usize + self.steps as usize
    }

    /// The level for `spans` spans of yarn of a radius and a length of spans, which may lie beside the spline by `error` [px].
    pub fn of(radius: f32, span: f32, spans: u32, error: f32) -> Self {
        let tube = TUBE_RADII.iter().filter(|&&limit| radius > limit).count();
        let chord = 4.0 * (error * radius.max(0.5)).sqrt();
        // Where a curve ends a step must not go beyond it.
        let merged = spans.trailing_zeros().min(MERGED) as f32;
        let steps = (span / chord).log2().round().clamp(-merged, SAMPLES.ilog2() as f32);
        Self { tube, steps: (steps + MERGED as f32) as u32 }
    }

    /// The coarsest of ribbons with these steps: what casts shadows.
    pub fn as_ribbon(self) -> Self {
        Self { tube: RIBBON, ..self }
    }

    pub fn is_thread(self) -> bool {
        self.tube < RIBBON
    }

    /// Whether it is flat: a ribbon, or a thread.
    pub fn is_flat(self) -> bool {
        self.tube <= RIBBON
    }

    /// Whether single fibres show at the outline.
    pub fn is_frayed(self) -> bool {
        self.tube >= FRAYED
    }

    /// Triangles of [`RUN`] spans, as numbers of vertices: step times ([`SIDES`] + 1) plus side, in steps of the finest level.
    pub fn triangles(self) -> Vec<u32> {
        let (step, side) = ((SAMPLES << MERGED) >> self.steps, SIDES / TUBES[self.tube]);
        let at = |i: u32, j: u32| i * (SIDES + 1) + j;
        let mut out = Vec::new();
        for i in (0..RUN * SAMPLES).step_by(step as usize) {
            for j in (0..SIDES).step_by(side as usize) {
                let [a, b, c, d] = [at(i, j), at(i, j + side), at(i + step, j + side), at(i + step, j)];
                out.extend([a, b, c, a, c, d]);
            }
        }
        out
    }

    /// How many numbers of vertices `spans` spans have: the first so many of [`Self::triangles`]. For as many spans as were
    /// told to [`Self::of`], or several times that.
    pub fn indices(self, spans: u32) -> u32 {
        ((spans << self.steps) >> MERGED) * TUBES[self.tube] * 6
    }
}

/// A run of spans of one curve, culled and drawn together.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Chunk {
    /// The first span: the index of its start in the buffer of control points.
    pub first: u32,
    /// Number of spans.
    pub spans: u32,
    /// Sphere around it, yarn included [m].
    pub center: Vec3,
    pub reach: f32,
    /// Yarn radius [m].
    pub radius: f32,
    /// Mean length of a span [m].
    pub span: f32,
}

/// Spans to draw at one level, at most [`RUN`].
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Batch {
    pub level: Level,
    pub first: u32,
    pub end: u32,
}

/// Chooses levels: `scale` says how many pixels a metre covers at the nearest point of a sphere, or `None` if the sphere
/// is not in the picture; yarn may lie beside its spline by `error` [px]. Batches come coarse to fine, runs of neighbouring chunks of
/// one level as one.
pub(crate) fn batches(chunks: &[Chunk], error: f32, scale: impl Fn(Vec3, f32) -> Option<f32>) -> Vec<Batch> {
    let mut out: Vec<Batch> = Vec::new();
    for chunk in chunks {
        let Some(pixels) = scale(chunk.center, chunk.reach) else { continue };
        let level = Level::of(chunk.radius * pixels, chunk.span * pixels, chunk.spans, error);
        let end = chunk.first + chunk.spans;
        match out.last_mut() {
            Some(last) if last.level == level && last.end == chunk.first && end - last.first <= RUN => {
                last.end = end
            }
            _ => out.push(Batch { level, first: chunk.first, end }),
        }
    }
    out.sort_by_key(|batch| batch.level);
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn levels_are_indexed_in_their_order() {
        assert!(Level::all().enumerate().all(|(i, level)| level.index() == i));
    }

    #[test]
    fn yarn_gets_finer_as_it_comes_nearer() {
        let counts: Vec<_> = (0..12)
            .map(|i| 0.15 * f32::powi(2.0, i))
            .map(|radius| Level::of(radius, 2.0 * radius, 32, ERROR).indices(32) / 3)
            .collect();
        assert!(counts.is_sorted() && counts[0] == 16 && counts[9] >= 24 * 32, "{counts:?}");
    }

    #[test]
    fn yarn_that_may_lie_further_beside_its_spline_takes_fewer_steps() {
        let steps = |error| Level::of(0.5, 2.0, 32, error).indices(32) / 6;
        assert_eq!([ERROR, 4.0 * ERROR, 16.0 * ERROR].map(steps), [32, 16, 8]);
    }

    #[test]
    fn a_step_takes_in_no_more_spans_than_there_are() {
        let steps = |spans: u32| Level::of(0.1, 0.1, spans, ERROR).indices(spans) / 6;
        assert_eq!([1, 2, 3, 4, 6, 32, 31].map(steps), [1, 1, 3, 1, 3, 8, 31]);
    }

    #[test]
    fn triangles_of_a_tube_close_around_it() {
        for level in Level::all() {
            let triangles = level.triangles();
            assert_eq!(triangles.len() as u32, level.indices(RUN));
            // Every edge across or along appears in two triangles, but for the rings at the ends and the seam.
            assert!(triangles.contains(&0) && triangles.contains(&(RUN * SPAN_VERTICES + SIDES)));
            let few = &triangles[..level.indices(4) as usize];
            assert_eq!(
                few.iter().max(),
                Some(&(4 * SPAN_VERTICES + SIDES)),
                "the ring that four spans end with"
            );
        }
    }

    #[test]
    fn neighbours_of_one_level_are_one_batch_and_hidden_chunks_none() {
        let chunk = |first| Chunk {
            first,
            spans: 10,
            center: Vec3::X * first as f32,
            reach: 1.0,
            radius: 1.0,
            span: 2.0,
        };
        let chunks = [1, 11, 21, 31, 45].map(chunk);
        let drawn = batches(&chunks, ERROR, |center, _| (center.x != 21.0).then_some(2.0));
        let ranges: Vec<_> = drawn.iter().map(|batch| (batch.first, batch.end)).collect();
        assert_eq!(ranges, [(1, 21), (31, 41), (45, 55)]);
    }
}
