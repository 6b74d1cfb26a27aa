//! Knitting a mesh row by row: loops on a needle, and stitches worked into them.
//!
//! A [`Needle`] holds the loops of the topmost row, left to right as seen from the front. Working a stretch of a row takes
//! loops off and puts others in their place; what is not worked waits, so rows may be turned before they end, loops may be bound
//! off or cast on anywhere, and rows may grow and shrink.
//!
//! Where a row was turned, its end is a step in the needle: the loops beside it hang on another vertex. The next row over it
//! has a slit there, with the ends of the turned rows on its sides, and is joined above it, as a short row without a wrap
//! leaves a small hole.

use crate::cable::{Cable, CableError};
use crate::edge_counts::StitchSize;
use crate::ids::VertexId;
use crate::mesh::PolygonMesh;
use crate::pieces::PieceError;
use crate::stitch::Stitch;
use crate::stitch_mesh::StitchMesh;
use glam::{DVec2, DVec3};
use std::f64::consts::TAU;

/// What is worked into the loops of a needle.
#[derive(Clone, Debug, PartialEq)]
pub enum Item {
    /// A stitch.
    Stitch(Stitch),
    /// Loops cross, and stitches are worked into them where they have come to. The path of the cable is not read.
    Cross(Cable, Vec<Stitch>),
    /// So many loops are left behind, to be bound off.
    BindOff(usize),
    /// So many loops are cast on.
    CastOn(usize),
}

impl Item {
    fn uses(&self) -> usize {
        match self {
            Self::Stitch(stitch) => stitch.bottoms(),
            Self::Cross(cable, _) => cable.loops(),
            Self::BindOff(n) => *n,
            Self::CastOn(_) => 0,
        }
    }
}

/// Why something cannot be worked.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum NeedleError {
    /// A tube of one or two loops.
    #[error("{0} stitches cannot be joined in the round; it takes three")]
    Round(usize),
    /// More is worked than there is.
    #[error("{wanted} loops are worked, but {left} are left on the needle")]
    Loops {
        /// Loops that are worked.
        wanted: usize,
        /// Loops that there are.
        left: usize,
    },
    /// Loops worked together, or crossed, that do not lie beside each other.
    #[error(
        "it joins loops from both sides of a turn or of bound-off stitches, which no stitch of the mesh can"
    )]
    Apart,
    /// A yarn-over that no stitch holds.
    #[error("a yarn-over needs a stitch beside it")]
    Alone,
    /// A cable in the first row.
    #[error("loops can only cross above a row of stitches, and there is none below the first row")]
    Crossing,
    /// A cable that cannot cross.
    #[error(transparent)]
    Cable(#[from] CableError),
}

/// A loop: an edge on which something is worked later.
#[derive(Clone, Copy, Debug)]
struct Loop {
    left: u32,
    right: u32,
    /// Whether there is a stitch below it.
    borne: bool,
    /// Whether loops were bound off on its right.
    open: bool,
}

/// Loops on a needle, and the fabric below them.
pub struct Needle {
    size: StitchSize,
    /// Loops cast on, if they are joined in the round.
    round: Option<usize>,
    loops: Vec<Loop>,
    /// Places in stitches along the row, and in rows.
    places: Vec<DVec2>,
    /// Loops of the row that a vertex belongs to: how wide a tube is there.
    around: Vec<usize>,
    faces: Vec<Vec<u32>>,
    stitches: Vec<Stitch>,
    cables: Vec<Cable>,
}

impl Needle {
    /// Casts on, flat or in the round.
    ///
    /// # Errors
    /// Too few loops for a tube.
    pub fn cast_on(count: usize, round: bool, size: StitchSize) -> Result<Self, NeedleError> {
        if round && count < 3 {
            return Err(NeedleError::Round(count));
        }
        let vertices = if round { count } else { count + 1 };
        let next = |i: usize| ((i + 1) % vertices) as u32;
        let cast = |i: usize| Loop { left: i as u32, right: next(i), borne: false, open: false };
        Ok(Self {
            size,
            round: round.then_some(count),
            loops: (0..count).map(cast).collect(),
            places: (0..vertices).map(|i| DVec2::new(i as f64, 0.0)).collect(),
            around: vec![count; vertices],
            faces: Vec::new(),
            stitches: Vec::new(),
            cables: Vec::new(),
        })
    }

    /// Loops on the needle.
    pub fn loops(&self) -> usize {
        self.loops.len()
    }

    /// Works a stretch of a row into the loops from `from` on, everything in the order in which it stands, left to right. The
    /// loops beside it wait. In the round all loops make one row, whose ends meet. Returns how many loops stand in their place.
    ///
    /// # Errors
    /// [`NeedleError`]; the needle is to be dropped then.
    pub fn work(&mut self, from: usize, what: &[Item]) -> Result<usize, NeedleError> {
        let wanted: usize = what.iter().map(Item::uses).sum();
        let left = self.loops.len() - from.min(self.loops.len());
        if wanted > left {
            return Err(NeedleError::Loops { wanted, left });
        }
        let below = self.loops[from..from + wanted].to_vec();
        let whole_round = self.round.is_some() && wanted == self.loops.len();
        let around = (self.loops.len() - wanted) + what.iter().map(made).sum::<usize>();
        let mut row = Row {
            needle: self,
            below,
            around,
            at: 0,
            above: Vec::new(),
            runs: Vec::new(),
            joint: None,
            first: None,
        };
        for item in what {
            match item {
                Item::Stitch(stitch) => row.stitch(stitch)?,
                Item::Cross(cable, stitches) => row.cross(cable, stitches)?,
                Item::BindOff(n) => row.bind_off(*n),
                Item::CastOn(n) => row.cast_on(*n),
            }
        }
        let above = row.close(whole_round);
        let count = above.len();
        if from > 0 && what.first().is_some_and(|w| matches!(w, Item::BindOff(_))) {
            self.loops[from - 1].open = true;
        }
        self.loops.splice(from..from + wanted, above);
        Ok(count)
    }

    /// Takes the fabric off the needle.
    ///
    /// # Errors
    /// No stitches, or a cable that cannot cross.
    pub fn finish(self) -> Result<StitchMesh, PieceError> {
        let Self { size, round, places, around, faces, stitches, cables, .. } = self;
        let (low, high) = places
            .iter()
            .fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(low, high), p| (low.min(*p), high.max(*p)));
        let middle = (low + high) / 2.0;
        let place = |(p, around): (&DVec2, &usize)| {
            let y = (p.y - middle.y) * size.height;
            match round {
                Some(count) => {
                    let angle = p.x / count as f64 * TAU;
                    let radius = *around as f64 * size.width / TAU;
                    DVec3::new(radius * angle.sin(), y, radius * angle.cos())
                }
                None => DVec3::new((p.x - middle.x) * size.width, y, 0.0),
            }
        };
        let positions = places.iter().zip(&around).map(place).collect();
        let mut used = vec![false; places.len()];
        faces.iter().flatten().for_each(|v| used[*v as usize] = true);
        let (positions, faces, now) = without_unused(positions, faces, &used);
        let mut fabric = StitchMesh::new(PolygonMesh::new(positions, &faces)?, stitches)?;
        for mut cable in cables {
            cable.path.iter_mut().for_each(|v| *v = VertexId(now[v.index()]));
            fabric.set_cable(cable)?;
        }
        Ok(fabric)
    }

    fn vertex(&mut self, place: DVec2, around: usize) -> u32 {
        self.places.push(place);
        self.around.push(around);
        (self.places.len() - 1) as u32
    }
}

/// Loops that something makes.
fn made(what: &Item) -> usize {
    match what {
        Item::Stitch(stitch) => stitch.tops(),
        Item::Cross(_, stitches) => stitches.iter().map(Stitch::tops).sum(),
        Item::BindOff(_) => 0,
        Item::CastOn(n) => *n,
    }
}

/// Cast-on edges into which nothing was worked leave vertices without faces.
fn without_unused(
    positions: Vec<DVec3>,
    mut faces: Vec<Vec<u32>>,
    used: &[bool],
) -> (Vec<DVec3>, Vec<Vec<u32>>, Vec<u32>) {
    let mut now = Vec::with_capacity(used.len());
    let mut count = 0;
    for used in used {
        now.push(count);
        count += u32::from(*used);
    }
    faces.iter_mut().flatten().for_each(|v| *v = now[*v as usize]);
    let kept = positions.into_iter().zip(used).filter(|(_, used)| **used).map(|(p, _)| p);
    (kept.collect(), faces, now)
}

/// A stretch without a gap: from where to where it lies below, and its vertices above.
struct Run {
    range: [f64; 2],
    above: Vec<u32>,
}

/// A stretch of a row while it is worked, left to right.
struct Row<'n> {
    needle: &'n mut Needle,
    below: Vec<Loop>,
    /// The next loop below.
    at: usize,
    above: Vec<Loop>,
    /// Stretches without a gap.
    runs: Vec<Run>,
    /// Right corners, below and above, of the last stitch; none where nothing joins it to the next.
    joint: Option<[u32; 2]>,
    /// The first stitch, and its left corners.
    first: Option<(usize, [u32; 2])>,
    around: usize,
}

impl Row<'_> {
    fn stitch(&mut self, stitch: &Stitch) -> Result<(), NeedleError> {
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
        let face = self.needle.faces.len();
        self.first.get_or_insert((face, [below[0], above[0]]));
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

    fn cross(&mut self, cable: &Cable, stitches: &[Stitch]) -> Result<(), NeedleError> {
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

    fn bind_off(&mut self, count: usize) {
        self.at += count;
        self.joint = None;
        if let Some(last) = self.above.last_mut() {
            last.open = true;
        }
    }

    fn cast_on(&mut self, count: usize) {
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
    fn close(mut self, whole_round: bool) -> Vec<Loop> {
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
        if let (true, Some(([below, above], (_, [first_below, first_above])))) = (whole_round, ends)
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lay::lay;
    use crate::unravel::loose_loops;

    fn row(text: &str) -> Vec<Item> {
        text.split_whitespace()
            .map(|word| match word.split_at(1) {
                ("-", n) => Item::BindOff(n.parse().unwrap()),
                ("+", n) => Item::CastOn(n.parse().unwrap()),
                _ => Item::Stitch(word.parse().unwrap()),
            })
            .collect()
    }

    fn knitted(count: usize, round: bool, rows: &[(usize, &str)]) -> StitchMesh {
        let mut needle = Needle::cast_on(count, round, StitchSize::of_width(3e-3)).unwrap();
        for (from, text) in rows {
            needle.work(*from, &row(text)).unwrap();
        }
        let fabric = needle.finish().unwrap();
        assert!(loose_loops(&fabric, &lay(&fabric)).is_empty());
        fabric
    }

    fn rows(fabric: &StitchMesh) -> Vec<usize> {
        fabric.rows().iter().map(|r| r.faces.len()).collect()
    }

    #[test]
    fn rows_grow_and_shrink() {
        let fabric = knitted(4, false, &[(0, "k k k k"), (0, "k ky k k"), (0, "d12k k k k")]);
        assert_eq!(rows(&fabric), [4, 4, 4]);
        let [low, high] = fabric.mesh().bounds();
        assert!((high.y - low.y - 3.0 * StitchSize::of_width(3e-3).height).abs() < 1e-12);
    }

    #[test]
    fn a_round_is_closed() {
        let fabric = knitted(6, true, &[(0, "k k k k k k"), (0, "k k ky k k k"), (0, "p d12k k k k k")]);
        assert!(fabric.rows().iter().all(|r| r.closed));
        assert_eq!(rows(&fabric), [6, 6, 6]);
        let net = lay(&fabric);
        assert!(net.yarns.iter().all(|y| y.period.is_some()));
    }

    #[test]
    fn a_buttonhole_is_a_hole() {
        let fabric = knitted(
            8,
            false,
            &[(0, "k k k k k k k k"), (0, "k k k -2 k k k"), (0, "k k k +2 k k k"), (0, "k k k k k k k k")],
        );
        // Around the piece, and around the hole.
        assert_eq!(fabric.mesh().borders().len(), 2);
        assert_eq!(rows(&fabric), [8, 3, 3, 3, 3, 8]);
    }

    #[test]
    fn loops_are_cast_on_and_bound_off_at_the_edges() {
        let fabric =
            knitted(3, false, &[(0, "k k k"), (0, "+2 k k k +1"), (0, "k k k k k k"), (0, "-2 k k -2")]);
        assert_eq!(fabric.mesh().borders().len(), 1);
        assert_eq!(fabric.mesh().face_count(), 3 + 3 + 6 + 2);
    }

    #[test]
    fn short_rows_leave_a_slit() {
        // The right half is worked twice more, then all of it.
        let all = (0, "k k k k k k");
        let fabric = knitted(6, false, &[all, (3, "k k k"), (3, "k k k"), all, all]);
        assert_eq!(fabric.mesh().borders().len(), 2, "around the piece, and around the slit");
        let mut found = rows(&fabric);
        found.sort_unstable();
        assert_eq!(found, [3, 3, 3, 3, 6, 6]);
    }

    #[test]
    fn what_the_mesh_cannot_hold_is_refused() {
        let mut needle = Needle::cast_on(4, false, StitchSize::of_width(3e-3)).unwrap();
        assert_eq!(needle.work(0, &row("k k k k k")), Err(NeedleError::Loops { wanted: 5, left: 4 }));
        let cross = Item::Cross(Cable::cross(Vec::new(), 1, 1, true), vec![Stitch::knit(); 2]);
        assert_eq!(needle.work(0, &[cross]), Err(NeedleError::Crossing));
        needle.work(2, &row("k k")).unwrap();
        assert_eq!(needle.work(0, &row("k d12k k")), Err(NeedleError::Apart));
        assert!(matches!(Needle::cast_on(2, true, StitchSize::of_width(3e-3)), Err(NeedleError::Round(2))));
    }
}
