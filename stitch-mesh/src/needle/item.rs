//! What is worked into the loops of a needle.

use crate::cable::Cable;
use crate::stitch::Stitch;

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
    /// Loops that it works.
    pub fn uses(&self) -> usize {
        match self {
            Self::Stitch(stitch) => stitch.bottoms(),
            Self::Cross(cable, _) => cable.loops(),
            Self::BindOff(n) => *n,
            Self::CastOn(_) => 0,
        }
    }

    /// Loops that it makes.
    pub fn makes(&self) -> usize {
        match self {
            Self::Stitch(stitch) => stitch.tops(),
            Self::Cross(_, stitches) => stitches.iter().map(Stitch::tops).sum(),
            Self::BindOff(_) => 0,
            Self::CastOn(n) => *n,
        }
    }

    /// What it is in a mirror.
    pub fn mirrored(&self) -> Self {
        match self {
            Self::Stitch(stitch) => Self::Stitch(stitch.mirrored()),
            Self::Cross(cable, stitches) => {
                let other = |s: &u8| cable.strands.len() as u8 - 1 - s;
                let mirrored = Cable {
                    path: Vec::new(),
                    strands: cable.strands.iter().rev().copied().collect(),
                    order: cable.order.iter().rev().map(other).collect(),
                    front: cable.front.iter().map(other).collect(),
                };
                Self::Cross(mirrored, stitches.iter().rev().map(Stitch::mirrored).collect())
            }
            Self::BindOff(_) | Self::CastOn(_) => self.clone(),
        }
    }
}
