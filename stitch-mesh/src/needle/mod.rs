//! Knitting a mesh row by row: loops on a needle, and stitches worked into them.
//!
//! A [`Needle`] holds the loops of the topmost row, left to right as seen from the front. Working a stretch of a row takes
//! loops off and puts others in their place; what is not worked waits, so rows may be turned before they end, loops may be bound
//! off or cast on anywhere, and rows may grow and shrink.
//!
//! Where a row was turned, its end is a step in the needle: the loops beside it hang on another vertex. The next row over it
//! has a slit there, with the ends of the turned rows on its sides, and is joined above it, as a short row without a wrap
//! leaves a small hole.

mod item;
mod row;
#[cfg(test)]
mod tests;

pub use item::Item;

use crate::cable::{Cable, CableError};
use crate::edge_counts::StitchSize;
use crate::ids::VertexId;
use crate::mesh::PolygonMesh;
use crate::pieces::PieceError;
use crate::stitch::Stitch;
use crate::stitch_mesh::StitchMesh;
use glam::{DVec2, DVec3};
use row::Row;
use std::f64::consts::TAU;

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
        let around = (self.loops.len() - wanted) + what.iter().map(Item::makes).sum::<usize>();
        let mut row = Row::new(self, below, around);
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
