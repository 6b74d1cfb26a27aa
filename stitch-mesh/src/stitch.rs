//! Stitches: what is knitted in one face of a stitch mesh (Yuksel et al. §4.2, Table 1).
//!
//! A face has bottoms (loops of the row below) and tops (loops that it makes). A stitch says, for each top, how its loop is
//! made, and for several bottoms, in which order they are stacked. Any number of either is allowed; Table 1 is the part of
//! it that knitters use. There is no behaviour per stitch type anywhere: the yarn layer reads these two lists.
//!
//! Symbols are the paper's: `k`, `p`, `ky`, `kyk`, `d12k`, `d312p`; `k1` and `y-1` for a top twisted clockwise or
//! counter-clockwise; `d123` alone for loops gathered on a yarn that makes no loop of its own, `d0y` for a yarn-over with no loop
//! below it. `s` and `x` make no loop either:
//! there the old one goes on up, slipped, and the row's yarn passes it behind (`s`) or woven through its legs (`x`); so `sk`
//! is a loop slipped and knitted into as well.
//!
//! Orders count from the left as the fabric is seen: the first in `d12k` is the left loop, and in front, so it is a knitter's
//! k2tog; `d21k` is ssk.

use serde::{Deserialize, Serialize};
use smallvec::{SmallVec, smallvec};
use std::fmt;
use std::str::FromStr;

/// How one loop is made.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Make {
    /// Knit: pulled through the old loops from back to front.
    Knit,
    /// Purl: pulled through from front to back.
    Purl,
    /// Yarn-over: laid over the needle, through nothing.
    YarnOver,
    /// Slipped: the old loop itself goes on up, the yarn passes behind it.
    Slip,
    /// Crossed: the old loop goes on up, and the yarn crosses it in front of one leg and behind the other.
    Cross,
}

/// One top of a stitch.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Op {
    /// How the loop is made.
    pub make: Make,
    /// Twist of the loop's legs: +1 clockwise, −1 counter-clockwise, 0 none. It is seen from the needle, looking down on the
    /// loop: clockwise, the leg of the right foot passes in front, up to the left, as in a k tbl.
    pub twist: i8,
}

/// The stitch of one face.
#[derive(Clone, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub struct Stitch {
    /// One operation for each top, left to right.
    pub ops: SmallVec<[Op; 2]>,
    /// Stacking order of the bottoms, front to back: indices counted from the left.
    pub stack: SmallVec<[u8; 2]>,
}

/// A text that is not a stitch symbol.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("'{symbol}' is not a stitch: {why}")]
pub struct StitchError {
    /// The text.
    pub symbol: String,
    /// What is wrong.
    pub why: &'static str,
}

impl Make {
    /// Whether yarn is pulled through the old loops.
    pub fn pulls_through(self) -> bool {
        matches!(self, Self::Knit | Self::Purl)
    }

    /// Whether the old loop itself goes on up.
    pub fn passes_on(self) -> bool {
        matches!(self, Self::Slip | Self::Cross)
    }
}

impl Stitch {
    /// The plain knit stitch, `k`.
    pub fn knit() -> Self {
        Self::plain(Make::Knit)
    }

    /// The plain purl stitch, `p`.
    pub fn purl() -> Self {
        Self::plain(Make::Purl)
    }

    fn plain(make: Make) -> Self {
        Self { ops: smallvec![Op { make, twist: 0 }], stack: smallvec![0] }
    }

    /// The stitch that a face with these numbers of bottoms and tops gets when nobody has chosen one: knit where it can be,
    /// `kp` (which makes no hole) for an increase, a decrease with the leftmost or the rightmost loop in front.
    pub fn default_for(bottoms: usize, tops: usize, left_in_front: bool) -> Self {
        let make = |i: usize| match (bottoms, i % 2) {
            (0, _) => Make::YarnOver,
            (_, 0) => Make::Knit,
            _ => Make::Purl,
        };
        let stack = 0..bottoms as u8;
        Self {
            ops: (0..tops).map(|i| Op { make: make(i), twist: 0 }).collect(),
            stack: if left_in_front { stack.collect() } else { stack.rev().collect() },
        }
    }

    /// Number of bottom edges of a face that holds this stitch.
    pub fn bottoms(&self) -> usize {
        self.stack.len()
    }

    /// Number of top edges.
    pub fn tops(&self) -> usize {
        self.ops.len()
    }

    /// Whether it holds its old loops, or hands them on to the stitch above.
    pub fn holds(&self) -> bool {
        self.ops.is_empty() || self.ops.iter().any(|op| op.make != Make::YarnOver)
    }

    /// What it is in a mirror: loops and stack the other way round, twists the other way.
    pub fn mirrored(&self) -> Self {
        let last = self.bottoms().saturating_sub(1) as u8;
        let mut mirrored = self.clone();
        mirrored.ops.reverse();
        mirrored.ops.iter_mut().for_each(|op| op.twist = -op.twist);
        mirrored.stack.iter_mut().for_each(|b| *b = last - *b);
        mirrored
    }

    /// What no yarn can do, if the stitch asks for it.
    fn fault(&self) -> Option<&'static str> {
        if !self.holds() && self.bottoms() > 1 {
            return Some("its loops would be held by nothing");
        }
        if self.bottoms() == 0 && self.holds() {
            return Some("without a loop below it only yarn-overs can be made");
        }
        match (self.ops.iter().filter(|op| op.make.passes_on()).count(), self.bottoms()) {
            (0, _) | (1, 1) => None,
            (1, _) => Some("only one loop can be slipped at a time"),
            _ => Some("the same loop cannot be slipped twice"),
        }
    }
}

impl fmt::Display for Stitch {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.stack.is_empty() {
            f.write_str("d0")?;
        } else if self.stack.len() > 1 || self.ops.is_empty() {
            f.write_str("d")?;
            self.stack.iter().try_for_each(|b| write!(f, "{}", b + 1))?;
        }
        for op in &self.ops {
            f.write_str(match op.make {
                Make::Knit => "k",
                Make::Purl => "p",
                Make::YarnOver => "y",
                Make::Slip => "s",
                Make::Cross => "x",
            })?;
            match op.twist {
                0 => {}
                twist => write!(f, "{twist}")?,
            }
        }
        Ok(())
    }
}

impl FromStr for Stitch {
    type Err = StitchError;

    fn from_str(symbol: &str) -> Result<Self, StitchError> {
        let fail = |why| StitchError { symbol: symbol.to_owned(), why };
        let mut rest = symbol;
        let mut stack: SmallVec<[u8; 2]> = smallvec![0];
        if let Some(after) = rest.strip_prefix('d') {
            let digits = after.len() - after.trim_start_matches(|c: char| c.is_ascii_digit()).len();
            let order = if &after[..digits] == "0" { "" } else { &after[..digits] };
            stack = order.bytes().map(|b| b.wrapping_sub(b'1')).collect();
            let mut sorted = stack.clone();
            sorted.sort_unstable();
            if digits == 0 || sorted.iter().enumerate().any(|(i, b)| *b as usize != i) {
                return Err(fail("after d stand the loops from front to back, each once, as in d21k"));
            }
            rest = &after[digits..];
        } else if rest.is_empty() {
            return Err(fail("it is empty"));
        }
        let mut ops = SmallVec::new();
        while let Some(letter) = rest.chars().next() {
            let make = match letter {
                'k' => Make::Knit,
                'p' => Make::Purl,
                'y' => Make::YarnOver,
                's' => Make::Slip,
                'x' => Make::Cross,
                _ => return Err(fail("only k, p and y make loops, and s and x hand them on")),
            };
            rest = &rest[1..];
            let twist = if let Some(after) = rest.strip_prefix("-1") {
                rest = after;
                -1
            } else if let Some(after) = rest.strip_prefix('1') {
                rest = after;
                1
            } else {
                0
            };
            ops.push(Op { make, twist });
        }
        let stitch = Self { ops, stack };
        stitch.fault().map_or(Ok(stitch), |why| Err(fail(why)))
    }
}

impl TryFrom<String> for Stitch {
    type Error = StitchError;

    fn try_from(symbol: String) -> Result<Self, StitchError> {
        symbol.parse()
    }
}

impl From<Stitch> for String {
    fn from(stitch: Stitch) -> String {
        stitch.to_string()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn table_1_reads_and_writes() {
        let table = "k p kp ky yk py yp kpk kyk yky kpy ykp pkp pyp ypy pky ypk d12k d21k d12p d21p d123k d132k d213k \
                     d231k d312k d321k d123p d132p d213p d231p d312p d321p k1 k-1 y1 y-1 k1y kp1 d21k-1 d1 d213 \
                     s x sk ks s1 kxk d0y d0yy";
        for symbol in table.split_whitespace() {
            let stitch: Stitch = symbol.parse().unwrap();
            assert_eq!(stitch.to_string(), symbol);
        }
        let sk2p: Stitch = "d312k".parse().unwrap();
        assert_eq!((sk2p.bottoms(), sk2p.tops(), &sk2p.stack[..]), (3, 1, &[2, 0, 1][..]));
    }

    #[test]
    fn nonsense_is_refused() {
        for symbol in [
            "", "d", "dk", "d11k", "d13k", "d0k", "q", "k2", "kå", "d12y", "1", "d0", "d01k", "d12s", "ss",
            "sx",
        ] {
            assert!(symbol.parse::<Stitch>().is_err(), "{symbol}");
        }
    }

    #[test]
    fn defaults_fit_their_face() {
        for (bottoms, tops) in [(1, 1), (1, 2), (1, 3), (2, 1), (3, 1), (2, 2), (4, 0), (0, 3)] {
            let stitch = Stitch::default_for(bottoms, tops, true);
            assert_eq!((stitch.bottoms(), stitch.tops()), (bottoms, tops));
            assert!(stitch.holds() || bottoms == 0);
        }
    }
}
