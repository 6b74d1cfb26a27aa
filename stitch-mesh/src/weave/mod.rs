//! Woven fabric: two sets of straight yarns that go over and under each other.
//!
//! # Theory
//! The **ends** of the warp run up, the **picks** of the weft across. A weave draft ([`WeaveDraft`]) says which of them lies in
//! front at each crossing, and repeats. Cirio et al., *Yarn-Level Cloth Simulation with Sliding Persistent Contacts* §3.2, make
//! each crossing a contact node with two visits: five unknowns, the position and a sliding coordinate for either yarn.
//!
//! **Crimp.** The node is the middle of the crossing; the yarns pass it R in front and R behind. Where a yarn changes sides
//! from one crossing to the next it climbs 2R on its way, so the piece between them is √(s² + 4R²) long for crossings s apart,
//! and s where it stays on its side. Whoever simulates the net reads the height of each climb from that.
//!
//! # Practice
//! A woven piece is kept as what the weaver decides ([`Woven`]); its yarn follows, and lies in a [`YarnNet`] as that of stitches
//! does, so nets of both can be joined into one. Every end and pick is a yarn of its own, with a short fringe at both ends.

mod draft;
mod lay;
mod stripes;
#[cfg(test)]
mod tests;

pub use draft::{Cell, DraftError, WeaveDraft};
pub use stripes::{Stripes, StripesError};

use glam::DVec3;
use serde::{Deserialize, Serialize};

/// Radius of the yarns over the distance of their crossings: not far from where plain weave has no room left between the
/// yarns (Peirce 1937: R = s/(2√3) = 0.289 s).
pub const FILL: f64 = 0.26;

/// Most ends or picks of a piece.
pub const MOST_YARNS: usize = 2000;

/// A woven piece, as laid. See the module.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Woven {
    /// Which yarns lie in front.
    pub draft: WeaveDraft,
    /// Yarns of the warp, which run up.
    pub ends: usize,
    /// Yarns of the weft, which run across.
    pub picks: usize,
    /// Distance from a yarn to the next [m].
    pub spacing: f64,
    /// Colours of the warp, from the left.
    pub warp: Stripes,
    /// Colours of the weft, from below.
    pub weft: Stripes,
    /// The middle of the piece [m].
    pub middle: DVec3,
    /// Whether it lies, its front upwards, instead of standing with its front towards +z.
    pub flat: bool,
}

/// A piece that cannot be woven.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum WovenError {
    /// Too few yarns, or too many.
    #[error("{0} {1} cannot be woven: a piece has from 2 to {MOST_YARNS} of them")]
    Count(usize, &'static str),
    /// A spacing that is none.
    #[error("yarns {} mm apart cannot be woven: from 0.01 to 1000", .0 * 1e3)]
    Spacing(f64),
    /// A place that is not finite.
    #[error("the middle of the piece has a coordinate that is not a finite number")]
    Place,
}

impl Woven {
    /// Whether the piece can be woven.
    ///
    /// # Errors
    /// [`WovenError`].
    pub fn check(&self) -> Result<(), WovenError> {
        for (count, what) in [(self.ends, "ends"), (self.picks, "picks")] {
            if !(2..=MOST_YARNS).contains(&count) {
                return Err(WovenError::Count(count, what));
            }
        }
        if !(1e-5..=1.0).contains(&self.spacing) {
            return Err(WovenError::Spacing(self.spacing));
        }
        if self.middle.is_finite() { Ok(()) } else { Err(WovenError::Place) }
    }

    /// R, radius of the yarns [m].
    pub fn radius(&self) -> f64 {
        FILL * self.spacing
    }

    /// The ways along the weft, along the warp, and towards the front.
    fn axes(&self) -> [DVec3; 3] {
        if self.flat { [DVec3::X, DVec3::NEG_Z, DVec3::Y] } else { [DVec3::X, DVec3::Y, DVec3::Z] }
    }

    /// The corners of the piece, counter-clockwise seen from the front [m].
    pub fn corners(&self) -> [DVec3; 4] {
        let [across, up, _] = self.axes();
        let half = |count: usize| 0.5 * self.spacing * count as f64;
        let (across, up) = (across * half(self.ends), up * half(self.picks));
        [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].map(|(s, t)| self.middle + across * s + up * t)
    }
}
