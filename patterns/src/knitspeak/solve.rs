//! Which cast-ons fit a pattern.
//!
//! The loops before each row are `at_0 + slope × t` for the same whole number t ≥ 0, and so is the cast-on. A row without an
//! open group settles t, or finds that nothing fits. A row with one, which works A loops and U more for each pass, asks for
//! at_0 + slope × t = A + U × k: a congruence for t modulo U / gcd(slope, U), whose solutions are again counted by a t ≥ 0. So
//! one walk over the rows finds all cast-ons, however the rows grow and shrink.

use super::error::Fault;
use super::measure::{Open, Segment};
use super::order::Written;
use super::syntax::MOST;
use std::fmt;
use std::rc::Rc;

/// A row and its segments.
pub(super) type Measured<'p> = (Written<'p>, Rc<Vec<Segment<'p>>>);

/// A number of loops that depends on t.
#[derive(Clone, Copy, Debug)]
struct Line {
    at_0: i128,
    slope: i128,
}

/// The cast-ons that fit.
struct State {
    cast_on: Line,
    /// Loops on the left needle, and those that wait on the right one behind a turn.
    left: Line,
    waiting: Line,
    /// Smallest cast-on with which all groups are worked twice, as far as that is free.
    wish: i128,
}

/// The smallest cast-on that fits: with `repeats`, one with so many passes of the first open group; otherwise one with which
/// every open group is worked twice.
pub(super) fn cast_on(rows: &[Measured<'_>], repeats: Option<usize>) -> Result<usize, Fault> {
    let segments = || rows.iter().flat_map(|(_, segments)| segments.iter());
    let groups = segments().any(|s| s.open.is_some_and(|o| o.is_group));
    // Without a group, "knit to end" is what can be repeated.
    let mut passes = repeats.map(|n| n as i128);
    let mut state = State {
        cast_on: Line { at_0: 0, slope: 1 },
        left: Line { at_0: 0, slope: 1 },
        waiting: Line { at_0: 0, slope: 0 },
        wish: if groups { 0 } else { PLAIN },
    };
    for (row, segments) in rows {
        for segment in segments.iter() {
            let asked = segment.open.filter(|o| o.is_group == groups).and_then(|_| passes.take());
            let done = state.work(segment, asked);
            done.map_err(|why| Fault::new(row.span.clone(), why).in_row(row.number))?;
        }
    }
    let Line { at_0, slope } = state.cast_on;
    let t = if slope == 0 || repeats.is_some() { 0 } else { div_up(state.wish - at_0, slope).max(0) };
    usize::try_from(state.cast_on.at(t)).ok().filter(|n| *n <= MOST).ok_or_else(|| {
        let span = rows.first().map_or(0..0, |(row, _)| row.span.clone());
        Fault::new(span, format!("no cast-on of {MOST} stitches or less fits all rows"))
    })
}

/// Stitches of a swatch that fits any number, as the one of stockinette.
const PLAIN: i128 = 8;

impl State {
    /// Goes over one segment, with a certain number of passes if one is asked for.
    fn work(&mut self, segment: &Segment<'_>, passes: Option<i128>) -> Result<(), String> {
        let fixed = (segment.uses + segment.leaves) as i128;
        let (mut worked, mut made) = (Line::fixed(segment.uses), Line::fixed(segment.makes));
        match (segment.open, passes) {
            (Some(open), None) => {
                let k = self.passes(fixed, open)?;
                let (uses, makes) = (open.uses as i128, open.makes as i128);
                worked = Line { at_0: worked.at_0 + uses * k.at_0, slope: uses * k.slope };
                made = Line { at_0: made.at_0 + makes * k.at_0, slope: makes * k.slope };
            }
            (Some(open), Some(k)) => {
                let (uses, makes) = (open.uses as i128 * k, open.makes as i128 * k);
                self.settle(fixed + uses)?;
                (worked.at_0, made.at_0) = (worked.at_0 + uses, made.at_0 + makes);
            }
            (None, _) if segment.turn.is_some() => self.at_least(fixed)?,
            (None, _) if segment.binds_off && self.left.slope == 0 && self.left.at_0 == fixed - 1 => {
                (worked.at_0, made.at_0) = (worked.at_0 - 1, made.at_0 - 1);
            }
            (None, _) => self.settle(fixed)?,
        }
        let rest = Line { at_0: self.left.at_0 - worked.at_0, slope: self.left.slope - worked.slope };
        self.left = Line { at_0: self.waiting.at_0 + made.at_0, slope: self.waiting.slope + made.slope };
        self.waiting = rest;
        let lines = [self.cast_on, self.left, self.waiting];
        if lines.iter().any(|l| l.at_0.abs() > TOO_LARGE || l.slope.abs() > TOO_LARGE) {
            return Err(format!("up to here the rows need more than {MOST} stitches"));
        }
        Ok(())
    }

    /// How often the open group is worked.
    fn passes(&mut self, fixed: i128, open: Open) -> Result<Line, String> {
        let (uses, least) = (open.uses as i128, i128::from(open.is_group));
        let Line { at_0, slope } = self.left;
        let common = gcd(slope, uses);
        let needs =
            || format!("{self_left}, but this row needs {}", wanted(fixed, open), self_left = self.left);
        if (fixed - at_0) % common != 0 {
            return Err(needs());
        }
        // slope × t = fixed − at_0 modulo uses
        let step = uses / common;
        let mut t = ((fixed - at_0) / common * inverse(slope / common, step)).rem_euclid(step);
        if slope == 0 {
            t = 0;
            if at_0 < fixed + least * uses {
                return Err(needs());
            }
        } else {
            let short = fixed + least * uses - (at_0 + slope * t);
            t += div_up(short, slope * step).max(0) * step;
        }
        self.substitute(t, step);
        let k = Line { at_0: (self.left.at_0 - fixed) / uses, slope: self.left.slope / uses };
        if open.is_group && k.slope > 0 {
            let t = div_up(2 - k.at_0, k.slope).max(0);
            self.wish = self.wish.max(self.cast_on.at(t));
        }
        Ok(k)
    }

    /// There are exactly so many loops.
    fn settle(&mut self, loops: i128) -> Result<(), String> {
        let Line { at_0, slope } = self.left;
        let t = if slope == 0 { 0 } else { (loops - at_0) / slope };
        if at_0 + slope * t != loops || t < 0 {
            return Err(format!("{}, but this row works {loops}", self.left));
        }
        self.substitute(t, 0);
        Ok(())
    }

    /// There are at least so many loops.
    fn at_least(&mut self, loops: i128) -> Result<(), String> {
        let Line { at_0, slope } = self.left;
        if at_0 < loops && slope == 0 {
            return Err(format!("{}, but this row works {loops}", self.left));
        }
        if at_0 < loops {
            self.substitute(div_up(loops - at_0, slope), 1);
        }
        Ok(())
    }

    /// t becomes `from + step × t`; with a step of 0 everything is settled.
    fn substitute(&mut self, from: i128, step: i128) {
        for line in [&mut self.cast_on, &mut self.left, &mut self.waiting] {
            *line = Line { at_0: line.at(from), slope: line.slope * step };
        }
    }
}

/// No pattern gets there, and products of two such numbers are far from overflow.
const TOO_LARGE: i128 = 1 << 40;

impl Line {
    fn fixed(n: usize) -> Self {
        Self { at_0: n as i128, slope: 0 }
    }

    fn at(self, t: i128) -> i128 {
        self.at_0 + self.slope * t
    }
}

impl fmt::Display for Line {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.slope {
            0 => write!(f, "there are {} stitches", self.at_0),
            1 => write!(f, "there are {} stitches or more", self.at_0),
            n => write!(f, "there are a multiple of {n} plus {} stitches", self.at_0.rem_euclid(n)),
        }
    }
}

/// "a multiple of 6 plus 1".
pub(super) fn wanted(fixed: i128, open: Open) -> String {
    match (open.uses as i128, fixed + i128::from(open.is_group) * open.uses as i128) {
        (1, least) => format!("{least} or more"),
        (uses, _) if fixed % uses == 0 => format!("a multiple of {uses}"),
        (uses, least) if fixed < uses => format!("a multiple of {uses} plus {}", least % uses),
        (uses, _) => format!("a multiple of {uses} plus {fixed}"),
    }
}

fn div_up(a: i128, b: i128) -> i128 {
    -(-a).div_euclid(b)
}

fn gcd(a: i128, b: i128) -> i128 {
    if b == 0 { a.abs() } else { gcd(b, a % b) }
}

/// The number by which `a` times it is 1 modulo `m`; they have no common divisor.
fn inverse(a: i128, m: i128) -> i128 {
    let (mut old, mut new) = ((a.rem_euclid(m), 1), (m, 0));
    while new.0 != 0 {
        let q = old.0 / new.0;
        (old, new) = (new, (old.0 - q * new.0, old.1 - q * new.1));
    }
    old.1.rem_euclid(m)
}
