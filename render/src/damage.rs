//! What of a picture is out of date, and the part of it to be drawn again.
//!
//! After an edit of one stitch in many thousands the picture is the one from before but for a few pixels. Where something changes, its
//! outline before and after is **damage**. As long as the camera stays where it is, only the rectangle of the picture around all
//! damage is drawn again, and in it only what reaches into it: on a software adapter that is the difference between one frame
//! and five.

use crate::Camera;
use crate::pipeline::{COLOR_FORMAT, Pipeline, shader};
use glam::{Mat4, Vec2, Vec3, Vec4};
use std::ops::Range;

/// More damaged points than this are not worth counting.
const MOST: usize = 1 << 14;
/// A part larger than this share of the picture is not drawn faster than all of it.
const LARGEST: f32 = 0.4;

/// Lines reach so far beyond their points [px].
const BESIDE: f32 = 16.0;

/// What has changed since a scene was drawn.
#[derive(Debug)]
pub(crate) struct Damage {
    /// Corners of what has gone, come, or changed [m].
    points: Vec<Vec3>,
    /// Width of the widest line among it [px].
    width: f32,
    /// Whether all has to be drawn again.
    all: bool,
}

impl Damage {
    /// Nothing has been drawn yet.
    pub fn all() -> Self {
        Self { points: Vec::new(), width: 0.0, all: true }
    }

    /// Everything has been drawn.
    pub fn none() -> Self {
        Self { points: Vec::new(), width: 0.0, all: false }
    }

    pub fn is_none(&self) -> bool {
        !self.all && self.points.is_empty()
    }

    /// Adds a line or an outline.
    pub fn add(&mut self, points: impl IntoIterator<Item = Vec3>, width: f32) {
        if !self.all {
            self.points.extend(points);
            self.width = self.width.max(width);
            self.all = self.points.len() > MOST;
        }
    }

    /// The part of a picture of `size` pixels to be drawn again; none where it has to be all of it.
    pub fn part(&self, camera: &Camera, size: Vec2, supersampling: f32) -> Option<Part> {
        if self.all {
            return None;
        }
        let projection = camera.view_projection(size.x / size.y);
        let (mut low, mut high) = (Vec2::INFINITY, Vec2::NEG_INFINITY);
        for point in &self.points {
            let clip = projection * point.extend(1.0);
            // What reaches behind the eye may reach anywhere in the picture.
            if clip.w <= camera.near() {
                return None;
            }
            let pixel = (Vec2::new(0.5, -0.5) * Vec2::new(clip.x, clip.y) / clip.w + 0.5) * size;
            (low, high) = (low.min(pixel), high.max(pixel));
        }
        // Half the width of a line on either side of it and beyond its ends, along a diagonal, and a pixel for rounding.
        let margin = self.width * supersampling + 2.0;
        let low = (low - margin).floor().clamp(Vec2::ZERO, size);
        let high = (high + margin).ceil().clamp(Vec2::ZERO, size);
        let extent = high - low;
        (extent.min_element() > 0.0 && extent.element_product() < LARGEST * size.element_product())
            .then(|| Part::of(projection, low, high, size))
    }
}

/// Empties a part of a picture.
#[derive(Debug)]
pub(crate) struct Wipe(wgpu::RenderPipeline);

impl Wipe {
    pub fn new(device: &wgpu::Device, samples: u32) -> Self {
        let pipeline = Pipeline {
            label: "wipe",
            module: &shader(device, "wipe", &[include_str!("wipe.wgsl")]),
            vertex: "cover",
            fragment: Some("nothing"),
            layouts: &[],
            vertices: &[],
            topology: wgpu::PrimitiveTopology::TriangleList,
            cull: None,
            target: Some(COLOR_FORMAT),
            depth: Some(wgpu::CompareFunction::Always),
            samples,
        };
        Self(pipeline.build(device))
    }

    /// Empties what the pass may draw on.
    pub fn draw(&self, pass: &mut wgpu::RenderPass) {
        pass.set_pipeline(&self.0);
        pass.draw(0..3, 0..1);
    }
}

/// A rectangle of a picture, and what of the scene can be seen in it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Part {
    /// Left, top, width and height [px].
    pub rectangle: [u32; 4],
    /// Planes through the eye and its sides, [`BESIDE`] of them; what is inside is on the positive side of all.
    planes: [Vec4; 4],
}

impl Part {
    fn of(projection: Mat4, low: Vec2, high: Vec2, size: Vec2) -> Self {
        let [x, y, w] = [0, 1, 3].map(|i| projection.row(i));
        let [left, right] = [low.x - BESIDE, high.x + BESIDE].map(|pixel| 2.0 * pixel / size.x - 1.0);
        let [top, bottom] = [low.y - BESIDE, high.y + BESIDE].map(|pixel| 1.0 - 2.0 * pixel / size.y);
        let [at, extent] = [low, high - low].map(|v| v.as_uvec2());
        Self {
            rectangle: [at.x, at.y, extent.x, extent.y],
            planes: [x - left * w, right * w - x, y - bottom * w, top * w - y],
        }
    }

    /// Whether a polygon or a line may reach into the part. Never false where it does.
    pub fn is_reached_by(&self, points: impl Iterator<Item = Vec3> + Clone) -> bool {
        !self.planes.iter().any(|plane| points.clone().all(|p| plane.dot(p.extend(1.0)) < 0.0))
    }
}

/// The numbers up to `count` for which something holds, as runs.
pub(crate) fn runs(count: usize, holds: impl Fn(usize) -> bool) -> Vec<Range<usize>> {
    let mut runs: Vec<Range<usize>> = Vec::new();
    for i in (0..count).filter(|i| holds(*i)) {
        match runs.last_mut().filter(|run| run.end == i) {
            Some(run) => run.end += 1,
            None => runs.push(i..i + 1),
        }
    }
    runs
}

/// Where two lists differ, if they are the same but for some things that were changed, put in or taken out.
#[derive(Debug, Default, PartialEq)]
pub(crate) struct Differences {
    /// Places in the first list of what is not in the second.
    pub gone: Vec<usize>,
    /// Places in the second list of what was not in the first.
    pub come: Vec<usize>,
}

impl Differences {
    /// Compares lists of these lengths, from both ends at once.
    pub fn of(lengths: [usize; 2], same: impl Fn(usize, usize) -> bool + Sync) -> Self {
        let [n, m] = lengths;
        let least = n.min(m);
        let (head, tail) = rayon::join(
            || (0..least).find(|i| !same(*i, *i)).unwrap_or(least),
            || (0..least).find(|i| !same(n - 1 - i, m - 1 - i)).unwrap_or(least),
        );
        let tail = tail.min(least - head);
        let [n, m] = [n - tail, m - tail];
        let mut found = Self::default();
        let (mut i, mut j) = (head, head);
        while i < n && j < m {
            let (gone, come) = match () {
                () if same(i, j) => (false, false),
                () if i + 1 < n && same(i + 1, j) => (true, false),
                () if j + 1 < m && same(i, j + 1) => (false, true),
                () => (true, true),
            };
            if gone {
                found.gone.push(i);
            }
            if come {
                found.come.push(j);
            }
            let step = gone == come;
            i += usize::from(step || gone);
            j += usize::from(step || come);
        }
        found.gone.extend(i..n);
        found.come.extend(j..m);
        found
    }

    /// What everything in the second list, `count` long, was in the first; none for what was not there.
    pub fn before(&self, count: usize) -> impl Iterator<Item = Option<usize>> + '_ {
        let (mut gone, mut come) = (self.gone.iter().peekable(), self.come.iter().peekable());
        let mut i = 0;
        (0..count).map(move |j| {
            if come.next_if(|c| **c == j).is_some() {
                return None;
            }
            while gone.next_if(|g| **g == i).is_some() {
                i += 1;
            }
            i += 1;
            Some(i - 1)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn differences_are_found_and_nothing_else() {
        let found = |a: &str, b: &str| {
            let [x, y] = [a, b].map(|t| t.as_bytes().to_vec());
            let found = Differences::of([x.len(), y.len()], |i, j| x[i] == y[j]);
            for (j, before) in found.before(y.len()).enumerate() {
                assert_eq!(before.map(|i| x[i]), (!found.come.contains(&j)).then_some(y[j]));
            }
            (found.gone, found.come)
        };
        assert_eq!(found("abcd", "abcd"), (vec![], vec![]));
        assert_eq!(found("abcd", "abxd"), (vec![2], vec![2]));
        assert_eq!(found("abcd", "abd"), (vec![2], vec![]));
        assert_eq!(found("abd", "abcd"), (vec![], vec![2]));
        assert_eq!(found("ab", "abcd"), (vec![], vec![2, 3]));
        assert_eq!(found("abcd", "cd"), (vec![0, 1], vec![]));
        assert_eq!(found("aaa", "aa"), (vec![2], vec![]));
        assert_eq!(found("abcdef", "aXceYf"), (vec![1, 3], vec![1, 4]));
        assert_eq!(found("", "a"), (vec![], vec![0]));
    }

    #[test]
    fn a_part_is_reached_by_what_it_shows_only() {
        let camera = Camera::default();
        let size = Vec2::new(400.0, 300.0);
        let mut damage = Damage::none();
        assert!(damage.is_none());
        let at = camera.target;
        let [right, up, _] = camera.axes();
        let step = camera.distance * 0.05;
        damage.add([at, at + right * step], 1.0);
        let part = damage.part(&camera, size, 1.0).unwrap();
        assert!(part.is_reached_by([at + up * step * 9.0, at - up * step * 9.0].into_iter()));
        assert!(!part.is_reached_by([at + up * step * 9.0, at + up * step * 5.0].into_iter()));
        damage.add([camera.eye() * 2.0 - at], 1.0);
        assert!(damage.part(&camera, size, 1.0).is_none(), "behind the eye");
        assert!(Damage::all().part(&camera, size, 1.0).is_none());
    }
}
