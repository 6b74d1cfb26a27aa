//! The syntax tree of a pattern. Every part knows the bytes of the text that it was read from.

use super::term::Term;
use std::ops::Range;

/// Stitches at the most in one row, and rows in one pattern: more is a slip of the pen, not knitting.
pub(super) const MOST: usize = 100_000;

/// Which side of the fabric faces the knitter.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Side {
    /// The side that is seen.
    Right,
    /// The other one.
    Wrong,
}

impl Side {
    /// The other side.
    pub fn other(self) -> Self {
        match self {
            Self::Right => Self::Wrong,
            Self::Wrong => Self::Right,
        }
    }
}

/// How far an item is worked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Reach {
    /// So often.
    Times(usize),
    /// Until so many stitches are left.
    ToLast(usize),
    /// As often as it fits before what follows it.
    Rest,
}

/// What an item works.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Body {
    Term(Term),
    Group(Vec<Item>),
}

/// A stitch or a group, and how far it is worked.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Item {
    pub body: Body,
    pub reach: Reach,
    pub span: Range<usize>,
}

/// How many stitches there are, as the writer counts them.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Count {
    /// `Some(8)` in "multiple of 8 sts, plus 1".
    pub multiple_of: Option<usize>,
    /// 1 in "multiple of 8 sts, plus 1", 10 in "10 sts".
    pub number: usize,
    pub span: Range<usize>,
}

/// Numbers of rows.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Ids {
    pub listed: Vec<usize>,
    /// "and all even rows", "all WS rows": those that nobody has listed.
    pub all: Option<All>,
}

/// Which rows "all" are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum All {
    Even,
    Odd,
    /// Every second one.
    Alternate,
    /// Those worked on this side.
    On(Side),
}

/// What is done in a row.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum RowBody {
    Items(Vec<Item>),
    /// As those rows, one after the other.
    As(Vec<usize>),
}

/// What one sentence says.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum What {
    Rows { ids: Ids, round: bool, side: Option<Side>, body: RowBody, count: Option<Count> },
    Repeat { rows: Repeated, times: Option<usize> },
    CastOn(Count),
}

/// Which rows are repeated.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Repeated {
    Rows(Vec<usize>),
    /// "these rows", "the last 4 rows".
    Last(Option<usize>),
}

/// One sentence.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Statement {
    pub what: What,
    pub span: Range<usize>,
}
