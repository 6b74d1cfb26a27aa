//! What single names of the language stand for, as the knitter sees it, and what that is from the right side.
//!
//! Fabric is turned over by a rotation about its wale: left becomes right and front becomes back, so knit becomes purl and both
//! the order of loops and their stack are reversed. The handedness of a twist stays what it was.

use super::syntax::Side;
use smallvec::SmallVec;
use stitch_mesh::stitch::{Make, Op, Stitch};

/// Loops that change places, and the stitches above them; strands, order and front are those of
/// [`stitch_mesh::cable::Cable`].
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Crossing {
    /// Loops of each strand, left to right below.
    pub strands: Vec<u8>,
    /// Strands left to right above.
    pub order: Vec<u8>,
    /// Strands front to back.
    pub front: Vec<u8>,
    /// Stitches above the crossing, left to right.
    pub stitches: Vec<Stitch>,
}

/// What is worked, in right-side form: as it is seen from the front, whatever side faced the knitter.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum Work {
    /// A stitch.
    Stitch(Stitch),
    /// A cable and the stitches above it.
    Cross(Crossing),
    /// So many loops are bound off. The one that is left on the needle after them is a stitch of its own.
    BindOff(usize),
    /// So many loops are cast on in the row.
    CastOn(usize),
    /// The work is turned before the row's end.
    Turn {
        /// Whether the next stitch is wrapped, as in w&t.
        wrapped: bool,
    },
    /// A stitch that has no form of its own here: its name as the knitter works it, and what it does to the count.
    Special {
        /// Its name in KnitSpeak.
        name: String,
        /// Loops that it works.
        uses: usize,
        /// Loops that it makes.
        makes: usize,
    },
}

/// A name of the vocabulary, as the knitter sees the side that is worked.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Term {
    Work(Work),
    /// Slipped with the yarn where it is out of sight from the right side, or held where the text says.
    Slip(Option<Yarn>),
    /// Binds off so many, which takes one more stitch to pass the last of them over.
    BindOff(usize),
    /// Binds off what there is.
    BindOffRest,
}

/// Where the yarn is held while a stitch is slipped, as the knitter sees it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Yarn {
    Back,
    Front,
}

impl Work {
    /// Loops that it works.
    pub fn uses(&self) -> usize {
        match self {
            Self::Stitch(stitch) => stitch.bottoms(),
            Self::Cross(crossing) => crossing.strands.iter().map(|n| usize::from(*n)).sum(),
            Self::BindOff(n) => *n,
            Self::CastOn(_) | Self::Turn { .. } => 0,
            Self::Special { uses, .. } => *uses,
        }
    }

    /// Loops that it makes.
    pub fn makes(&self) -> usize {
        match self {
            Self::Stitch(stitch) => stitch.tops(),
            Self::Cross(crossing) => crossing.stitches.iter().map(Stitch::tops).sum(),
            Self::CastOn(n) => *n,
            Self::BindOff(_) | Self::Turn { .. } => 0,
            Self::Special { makes, .. } => *makes,
        }
    }

    /// What it is from the other side of the fabric.
    pub(super) fn turned(&self) -> Self {
        match self {
            Self::Stitch(stitch) => Self::Stitch(turned(stitch)),
            Self::Cross(crossing) => Self::Cross(crossing.turned()),
            other => other.clone(),
        }
    }

    /// What the knitter sees who works it with this side facing, and the other way round.
    pub(super) fn facing(&self, side: Side) -> Self {
        if side == Side::Right { self.clone() } else { self.turned() }
    }
}

impl Crossing {
    fn turned(&self) -> Self {
        let last = self.strands.len() as u8;
        let mirrored = |list: &[u8]| list.iter().rev().map(|s| last - 1 - s).collect();
        Self {
            strands: self.strands.iter().rev().copied().collect(),
            order: mirrored(&self.order),
            front: mirrored(&self.front),
            stitches: self.stitches.iter().rev().map(turned).collect(),
        }
    }
}

/// A stitch from the other side of the fabric.
pub(super) fn turned(stitch: &Stitch) -> Stitch {
    let last = stitch.stack.len() as u8;
    let mut ops: SmallVec<[Op; 2]> = stitch.ops.iter().rev().copied().collect();
    for op in &mut ops {
        op.make = match op.make {
            Make::Knit => Make::Purl,
            Make::Purl => Make::Knit,
            make => make,
        };
    }
    Stitch { ops, stack: stitch.stack.iter().rev().map(|b| last - 1 - b).collect() }
}

impl Term {
    /// Loops that it works and loops that it makes.
    pub fn size(&self) -> (usize, usize) {
        match self {
            Self::Work(work) => (work.uses(), work.makes()),
            Self::Slip(_) => (1, 1),
            Self::BindOff(n) => (n.saturating_add(1), 1),
            Self::BindOffRest => (1, 0),
        }
    }
}
