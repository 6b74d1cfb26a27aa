//! A stretch of a row while it is worked.

use super::{Loop, Needle, NeedleError};
use crate::cable::Cable;
use crate::ids::VertexId;
use crate::stitch::Stitch;
use glam::DVec2;

/// A stretch without a gap: from where to where it lies below, and its vertices above.
struct Run {
    range: [f64; 2],
    above: Vec<u32>,
}

/// A stretch of a row while it is worked, left to right.
pub(super) struct Row<'n> {
    needle: &'n mut Needle,
    below: Vec<Loop>,
    /// The next loop below.
    at: usize,
    above: Vec<Loop>,
    /// Stretches without a gap.
    runs: Vec<Run>,
    /// Right corners, below and above, of the last stitch; none where nothing joins it to the next.
    joint: Option<[u32; 2]>,
    /// Left corners, below and above, of the first stitch.
    first: Option<[u32; 2]>,
    around: usize,
}

impl<'n> Row<'n> {
    pub fn new(needle: &'n mut Needle, below: Vec<Loop>, around: usize) -> Self {
        Self { needle, below, around, at: 0, above: Vec::new(), runs: Vec::new(), joint: None, first: None }
    }

    pub fn stitch(&mut self, stitch: &Stitch) -> Result<(), NeedleError> {
        if stitch.bottoms() == 0 {
            return Err(NeedleError::Alone);
        }
        let loops = self.below[self.at..self.at + stitch.bottoms()].to_vec();
        if loops.windows(2).any(|w| w[0].right != w[1].left || w[0].open) {
            return Err(NeedleError::Apart);
        }
        self.at += loops.len();
        let below: Vec<u32> = std::iter::once(loops[0].left).chain(loops.iter().map(|l| l.right)).collect();
        let start = self.needle.places[below[0] as usize];
        let end = self.unrolled(end_of(&below), below[0]);
        let tops = stitch.tops();
        let height = |i: usize| 1.0 + start.lerp(end, if tops == 0 { 0.5 } else { i as f64 / tops as f64 }).y;
        if self.joint.is_none() {
            let first = self.needle.vertex(DVec2::new(0.0, height(0)), self.around);
            self.runs.push(Run { range: [start.x, end.x], above: vec![first] });
            self.joint = Some([below[0], first]);
        }
        let Some(run) = self.runs.last_mut() else { return Ok(()) };
        run.range[1] = end.x;
        // Above a turn the row goes on from where it was, over the higher side.
        let shared = end_of(&run.above);
        let place = &mut self.needle.places[shared as usize];
        place.y = place.y.max(height(0));
        let first = run.above.len() - 1;
        for i in 1..=tops {
            let vertex = self.needle.vertex(DVec2::new(0.0, height(i)), self.around);
            run.above.push(vertex);
        }
        let above = run.above[first..].to_vec();
        self.first.get_or_insert([below[0], above[0]]);
        let open = loops[loops.len() - 1].open;
        self.joint = (!open).then_some([end_of(&below), end_of(&above)]);
        self.above.extend(above.windows(2).map(|w| Loop {
            left: w[0],
            right: w[1],
            borne: true,
            open: false,
        }));
        if open && let Some(last) = self.above.last_mut() {
            last.open = true;
        }
        self.needle.faces.push(below.into_iter().chain(above.into_iter().rev()).collect());
        self.needle.stitches.push(stitch.clone());
        Ok(())
    }

    /// The place of a vertex, seen from one to its left: around a tube places begin again.
    fn unrolled(&self, vertex: u32, from: u32) -> DVec2 {
        let [place, from] = [vertex, from].map(|v| self.needle.places[v as usize]);
        match self.needle.round {
            Some(count) if place.x < from.x => place + DVec2::new(count as f64, 0.0),
            _ => place,
        }
    }

    pub fn cross(&mut self, cable: &Cable, stitches: &[Stitch]) -> Result<(), NeedleError> {
        let loops = &self.below[self.at..self.at + cable.loops()];
        if loops.windows(2).any(|w| w[0].right != w[1].left || w[0].open) {
            return Err(NeedleError::Apart);
        }
        if loops.iter().any(|l| !l.borne) {
            return Err(NeedleError::Crossing);
        }
        let ends = loops.iter().map(|l| l.right);
        let path = std::iter::once(loops[0].left).chain(ends).map(VertexId).collect();
        self.needle.cables.push(Cable { path, ..cable.clone() });
        stitches.iter().try_for_each(|stitch| self.stitch(stitch))
    }

    pub fn bind_off(&mut self, count: usize) {
        self.at += count;
        self.joint = None;
        if let Some(last) = self.above.last_mut() {
            last.open = true;
        }
    }

    pub fn cast_on(&mut self, count: usize) {
        let n = count as f64;
        // Over bound-off loops the row is joined again.
        if let Some(last) = self.above.last_mut() {
            last.open = false;
        }
        let run = match self.runs.last_mut() {
            Some(run) => {
                run.range[1] += n;
                run
            }
            None => {
                let edge = self.below.get(self.at).map_or(0, |l| l.left);
                let edge = self.needle.places[edge as usize];
                let start = self.needle.vertex(edge + DVec2::Y, self.around);
                self.runs.push(Run { range: [edge.x - n, edge.x], above: vec![start] });
                let last = self.runs.len() - 1;
                &mut self.runs[last]
            }
        };
        let y = self.needle.places[end_of(&run.above) as usize].y;
        for _ in 0..count {
            let left = end_of(&run.above);
            let right = self.needle.vertex(DVec2::new(0.0, y), self.around);
            run.above.push(right);
            self.above.push(Loop { left, right, borne: false, open: false });
        }
        // The next stitch begins at the last of them; below it nothing joins it to the one before.
        self.joint = Some([u32::MAX, end_of(&run.above)]);
    }

    /// Puts the vertices above at even distances, joins the ends of a round, and returns the loops above.
    pub fn close(mut self, whole_round: bool) -> Vec<Loop> {
        for run in &self.runs {
            let [start, end] = run.range;
            let loops = (run.above.len() - 1) as f64;
            // Flat pieces grow to both sides; tubes have another radius.
            let wide = if self.needle.round.is_some() { (end - start) / loops.max(1.0) } else { 1.0 };
            for (i, vertex) in run.above.iter().enumerate() {
                self.needle.places[*vertex as usize].x =
                    (start + end) / 2.0 + (i as f64 - loops / 2.0) * wide;
            }
        }
        let ends = self.joint.zip(self.first);
        if let (true, Some(([below, above], [first_below, first_above]))) = (whole_round, ends)
            && below == first_below
        {
            // The last vertex was put where the first one is.
            let swap = |v: &mut u32| {
                if *v == above {
                    *v = first_above;
                }
            };
            self.needle.faces.iter_mut().rev().take(self.above.len() + 1).flatten().for_each(swap);
            self.above.iter_mut().for_each(|l| swap(&mut l.right));
        }
        self.above
    }
}

fn end_of(chain: &[u32]) -> u32 {
    chain[chain.len() - 1]
}
