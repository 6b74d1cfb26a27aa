//! The names of cables.
//!
//! `3/2 RC` brings the strand of 3 to the right in front of the strand of 2: below, the three stand on the left. In `3/2 LC`
//! they stand on the right and go to the left. In `2/1/2 RC` the outer strands change places, the first one named in front; the
//! middle one stays where it is, behind both. P purls the strand that lies behind all others, T knits through the back loop
//! what is knitted. `3/2 RC (p1, k1)` is our own: the stitches of that strand, in the order they are worked.

use super::term::Crossing;
use smallvec::smallvec;
use stitch_mesh::cable::MOST_LOOPS;
use stitch_mesh::stitch::{Make, Op, Stitch};
use winnow::ascii::digit1;
use winnow::combinator::{alt, opt, preceded};
use winnow::prelude::*;

/// A cable by its compact name: `3/2rc`, `2/1/2lpc`, or as British writers name it, `c6f`.
pub(super) fn cable(input: &mut &str) -> winnow::Result<Crossing> {
    alt((numbered, british)).verify_map(|cross| cross.crossing()).parse_next(input)
}

struct Cross {
    /// Loops of the strand in front, of the one that stays, and of the one that goes behind.
    front: u8,
    middle: Option<u8>,
    back: u8,
    to_right: bool,
    purled: bool,
    twisted: bool,
}

fn number(input: &mut &str) -> winnow::Result<u8> {
    digit1.parse_to().parse_next(input)
}

fn numbered(input: &mut &str) -> winnow::Result<Cross> {
    let over = |input: &mut &str| preceded('/', number).parse_next(input);
    let direction = alt(('r'.value(true), 'l'.value(false)));
    let kind = alt(('c'.value(false), 't'.value(true)));
    let (front, second, third, to_right, purled, twisted) =
        (number, over, opt(over), direction, opt('p'), kind).parse_next(input)?;
    let (middle, back) = third.map_or((None, second), |third| (Some(second), third));
    Ok(Cross { front, middle, back, to_right, purled: purled.is_some(), twisted })
}

/// `C6B` is 3/3 RC and `C6F` 3/3 LC; of those with a purl `T3B` and `T4B` are 2/1 and 2/2 RPC. Others differ between writers.
fn british(input: &mut &str) -> winnow::Result<Cross> {
    let (purled, loops) = alt((
        ('c'.value(false), number.verify(|n| n % 2 == 0)),
        ('t'.value(true), number.verify(|n| matches!(n, 3 | 4))),
    ))
    .parse_next(input)?;
    let to_right = alt(('b'.value(true), 'f'.value(false))).parse_next(input)?;
    let back = loops / 2;
    Ok(Cross { front: loops - back, middle: None, back, to_right, purled, twisted: false })
}

impl Cross {
    /// `None` if there are more loops than a cable has, or a strand without any.
    fn crossing(self) -> Option<Crossing> {
        let knit = Stitch {
            ops: smallvec![Op { make: Make::Knit, twist: self.twisted.into() }],
            stack: smallvec![0],
        };
        let behind = if self.purled { Stitch::purl() } else { knit.clone() };
        // As a right cross, left to right below.
        let (mut strands, mut front, last) = match self.middle {
            Some(middle) => (vec![self.front, middle, self.back], vec![0, 2, 1], 1),
            None => (vec![self.front, self.back], vec![0, 1], 1),
        };
        let loops: usize = strands.iter().map(|n| usize::from(*n)).sum();
        if strands.contains(&0) || loops > MOST_LOOPS {
            return None;
        }
        if !self.to_right {
            strands.reverse();
            front = front.iter().map(|s| strands.len() as u8 - 1 - s).collect();
        }
        let last = if self.to_right { last } else { strands.len() - 1 - last };
        let order: Vec<u8> = (0..strands.len() as u8).rev().collect();
        let above = order.iter().map(|s| usize::from(*s));
        let stitches = above.flat_map(|s| {
            let stitch = if s == last { &behind } else { &knit };
            std::iter::repeat_n(stitch.clone(), usize::from(strands[s]))
        });
        let stitches = stitches.collect();
        Some(Crossing { strands, order, front, stitches })
    }
}

impl Crossing {
    /// Places above, left to right, of the strand that lies behind all others.
    pub(super) fn behind(&self) -> std::ops::Range<usize> {
        let Some(last) = self.front.last() else { return 0..0 };
        let size = |s: &u8| usize::from(self.strands[usize::from(*s)]);
        let begin = self.order.iter().take_while(|s| *s != last).map(size).sum();
        begin..begin + size(last)
    }

    /// The name to write for a crossing as the knitter sees it, if it is one that has a name; `name_of` names its stitches.
    pub(super) fn name(&self, name_of: impl Fn(&Stitch) -> Option<String>) -> Option<String> {
        let to_right = self.front.first() == Some(&0);
        let sizes: Vec<String> = self.strands.iter().map(u8::to_string).collect();
        let sizes =
            if to_right { sizes.join("/") } else { sizes.into_iter().rev().collect::<Vec<_>>().join("/") };
        let side = if to_right { 'R' } else { 'L' };
        let named = ["C", "PC", "T", "PT"].map(|kind| format!("{sizes} {side}{kind}"));
        let read = |name: &String| cable.parse(&super::vocabulary::compact(name)).ok();
        if let Some(name) = named.iter().find(|name| read(name).as_ref() == Some(self)) {
            return Some(name.clone());
        }
        let behind = self.behind();
        let worked: Option<Vec<String>> = self.stitches[behind.clone()].iter().rev().map(name_of).collect();
        let base = named.iter().find(|name| {
            read(name).is_some_and(|mut plain| {
                plain.stitches.splice(behind.clone(), self.stitches[behind.clone()].iter().cloned());
                plain == *self
            })
        })?;
        Some(format!("{base} ({})", worked?.join(", ")))
    }
}
