//! The names of stitches: one table, and the families of names with numbers in them.
//!
//! Symbols are given as the knitter sees the side that is worked; [`super::term`] turns them over for the wrong side. They are
//! worked right to left, so the stitch worked first stands last in a symbol: the knit of a kfb is on the right, and its twisted
//! loop, whose bar looks like a purl, on the left of it: `pk`.
//!
//! Decreases, front to back. In a k2tog the needle enters the left loop first, which comes to lie in front: `d12k`, and for
//! more loops `d123k`. Slipped loops are passed over, so they lie in front of what is knitted after them: an ssk is `d21k`, a
//! sssk `d321k`. A sk2p has the slipped right loop in front, and of the pair the left: `d312k`. In a s2kp two are slipped
//! together, like a k2tog, so the middle lies in front of the right, and both in front of the left: `d231k`. Purled decreases
//! are those of which the wrong side looks so: p2tog `d12p`, ssp `d21p`, cddp `d312p`. Through the back loop, k2tog and p2tog
//! stack as ssk and ssp do; that the old loops are twisted under them too has no symbol.
//!
//! A twist belongs to the loop that is made: `k1` is k tbl. A M1L is the strand below, knitted through the back loop, so it
//! has the twist of k tbl, `d0y1`, and M1R the other, `d0y-1`; a plain M1 is a M1L. Whether a loop that grows from a strand was
//! knitted or purled has no symbol, so M1p and M1Lp are M1L too. Lifted increases (inc L, LLI) use no stitch of their own and
//! make one; here they are the M1 of the same lean.

use super::cable::cable;
use super::term::{Term, Work, Yarn};
use smallvec::smallvec;
use std::collections::HashMap;
use std::sync::LazyLock;
use stitch_mesh::stitch::{Make, Op, Stitch};
use winnow::ascii::digit1;
use winnow::combinator::{alt, eof, opt};
use winnow::prelude::*;

/// Symbol, and names with the one to write first.
const STITCHES: [(&str, &[&str]); 18] = [
    ("k", &["k", "knit"]),
    ("p", &["p", "purl"]),
    ("k1", &["k1 tbl", "k tbl", "knit tbl"]),
    ("p1", &["p1 tbl", "p tbl", "purl tbl"]),
    ("d0y", &["yo", "yfwd", "yrn", "yon", "yarn over"]),
    ("d0y1", &["M1L", "M1", "M1p", "M1Lp", "make 1", "inc L", "inc Lp", "LLI", "LLIp"]),
    ("d0y-1", &["M1R", "M1Rp", "inc R", "inc Rp", "RLI", "RLIp"]),
    ("pk", &["kfb", "k1f&b", "kf&b"]),
    ("kp", &["pfb", "p1f&b", "pf&b"]),
    ("ky1k", &["ctr dbl inc"]),
    ("kpk", &["kfbf"]),
    ("d21k", &["ssk", "skp", "skpo", "sl1-k1-psso"]),
    ("d321k", &["sssk"]),
    ("d312k", &["sk2p", "sk2po", "sl1-k2tog-psso"]),
    ("d231k", &["cdd", "s2kp", "s2kp2", "s2kpo", "sl2-k1-p2sso", "sl2tog-k1-p2sso"]),
    ("d21p", &["ssp"]),
    ("d321p", &["sssp"]),
    ("d312p", &["cddp"]),
];

/// Stitches that only have a name: names with the one to write first, loops used, loops made.
const SPECIALS: [(&[&str], usize, usize); 8] = [
    (&["MB", "make bobble", "bobble"], 1, 1),
    (&["k1 below", "k1-b", "k1b", "k below"], 1, 1),
    (&["p1 below", "p1-b", "p1b", "p below"], 1, 1),
    (&["drop st", "drop 1 st"], 1, 0),
    (&["bunny ears dec"], 3, 2),
    (&["bunny ears back dec"], 3, 2),
    (&["bunny ears yo"], 3, 3),
    (&["bunny ears back yo"], 3, 3),
];

/// A name as it is looked up: letters and digits, with the strokes of cables.
pub(super) fn compact(name: &str) -> String {
    let kept = name.chars().filter(|c| c.is_ascii_alphanumeric() || "/&".contains(*c));
    kept.map(|c| c.to_ascii_lowercase()).collect()
}

static NAMES: LazyLock<HashMap<String, Term>> = LazyLock::new(|| {
    let mut names = HashMap::new();
    for (symbol, all) in STITCHES {
        let term = symbol.parse().map(|stitch| Term::Work(Work::Stitch(stitch)));
        names.extend(all.iter().flat_map(|name| Some((compact(name), term.clone().ok()?))));
    }
    for (all, uses, makes) in SPECIALS {
        let term = special(all[0], uses, makes);
        names.extend(all.iter().map(|name| (compact(name), term.clone())));
    }
    for (name, wrapped) in [("turn", false), ("wt", true), ("w&t", true), ("wrapandturn", true)] {
        names.insert(name.to_owned(), Term::Work(Work::Turn { wrapped }));
    }
    names
});

fn special(name: &str, uses: usize, makes: usize) -> Term {
    Term::Work(Work::Special { name: name.to_owned(), uses, makes })
}

/// What a name means, and how often if it has a number of its own, as in k5. The name is [`compact`].
pub(super) fn find(name: &str) -> Option<(Term, Option<usize>)> {
    let known = NAMES.get(name).map(|term| (term.clone(), None));
    known.or_else(|| family.parse(name).ok())
}

fn number(input: &mut &str) -> winnow::Result<usize> {
    digit1.parse_to().parse_next(input)
}

/// Loops in one decrease or increase: no more than a symbol has digits for.
fn few(input: &mut &str) -> winnow::Result<usize> {
    number.verify(|n| (2..=9).contains(n)).parse_next(input)
}

fn stitches(input: &mut &str) -> winnow::Result<()> {
    opt(alt(("stitches", "stitch", "sts", "st"))).void().parse_next(input)
}

fn family(input: &mut &str) -> winnow::Result<(Term, Option<usize>)> {
    let once = |term| (term, None);
    alt((
        (decrease, eof).map(|(term, _)| once(term)),
        (increase, eof).map(|(term, _)| once(term)),
        (run, eof).map(|(term, _)| term),
        (slip, eof).map(|(term, _)| term),
        (bind_off, eof).map(|(term, _)| once(term)),
        (cast_on, eof).map(|(term, _)| once(term)),
        (cluster, eof).map(|(term, _)| once(term)),
        (cable, eof).map(|(crossing, _)| once(Term::Work(Work::Cross(crossing)))),
    ))
    .parse_next(input)
}

fn make(input: &mut &str) -> winnow::Result<Make> {
    alt((alt(("knit", "k")).value(Make::Knit), alt(("purl", "p")).value(Make::Purl))).parse_next(input)
}

fn plain(make: Make, twist: i8) -> Stitch {
    Stitch { ops: smallvec![Op { make, twist }], stack: smallvec![0] }
}

fn stitch(stitch: Stitch) -> Term {
    Term::Work(Work::Stitch(stitch))
}

/// `k3tog`, `p2tog tbl`.
fn decrease(input: &mut &str) -> winnow::Result<Term> {
    let (make, n, _, tbl) = (make, few, "tog", opt("tbl")).parse_next(input)?;
    let stack = 0..n as u8;
    let stack = if tbl.is_some() { stack.rev().collect() } else { stack.collect() };
    Ok(stitch(Stitch { ops: smallvec![Op { make, twist: 0 }], stack }))
}

/// `1-to-5 inc`: knitted, purled, knitted … into one stitch; `1-to-5 inc p` begins with a purl.
fn increase(input: &mut &str) -> winnow::Result<Term> {
    let (n, purled) = ("1to", few, "inc", opt("p")).map(|t| (t.1, t.3.is_some())).parse_next(input)?;
    let make = |i: usize| if (i % 2 == 1) == purled { Make::Knit } else { Make::Purl };
    let ops = (0..n).rev().map(|i| Op { make: make(i), twist: 0 }).collect();
    Ok(stitch(Stitch { ops, stack: smallvec![0] }))
}

/// `k5`, `k3 tbl`, `k2 wrapping yarn 3 times`.
fn run(input: &mut &str) -> winnow::Result<(Term, Option<usize>)> {
    #[derive(Clone)]
    enum How {
        Plain,
        Tbl,
        Wrapping(usize),
    }
    let times = alt(("twice".value(2), (number, "times").map(|t| t.0)));
    let how = alt((
        "tbl".value(How::Tbl),
        ("wrappingyarn", times).map(|t| How::Wrapping(t.1)),
        stitches.value(How::Plain),
    ));
    let (make, count, how) = (make, opt(number), how).parse_next(input)?;
    let term = match how {
        How::Plain => stitch(plain(make, 0)),
        How::Tbl => stitch(plain(make, 1)),
        How::Wrapping(n) => {
            let letter = if make == Make::Knit { 'k' } else { 'p' };
            special(&format!("{letter}1 wrapping yarn {n} times"), 1, 1)
        }
    };
    Ok((term, count))
}

/// `sl 1`, `sl 2 wyif`, `slip 1 purlwise with yarn in back`.
fn slip(input: &mut &str) -> winnow::Result<(Term, Option<usize>)> {
    let wise = opt(alt(("purlwise", "pwise", "knitwise", "kwise")));
    let yarn = opt(alt((
        alt(("wyib", "wyb", "withyarninback")).value(Yarn::Back),
        alt(("wyif", "wyf", "withyarninfront")).value(Yarn::Front),
    )));
    let (_, count, _, _, yarn) =
        (alt(("slip", "sl", "s")), opt(number), stitches, wise, yarn).parse_next(input)?;
    Ok((Term::Slip(yarn), count))
}

/// `BO 3 sts`, `BO rem sts`, `bind off all`, `BO`.
fn bind_off(input: &mut &str) -> winnow::Result<Term> {
    let rest = alt((
        alt(("allrem", "allremaining", "remaining", "rem", "all")).value(Term::BindOffRest),
        number.map(Term::BindOff),
    ));
    let how = opt(alt(("loosely", "knitwise", "purlwise", "inpattern", "inpatt")));
    let (_, term, _, _) = (alt(("bo", "bindoff", "castoff")), opt(rest), stitches, how).parse_next(input)?;
    Ok(term.unwrap_or(Term::BindOffRest))
}

/// `CO 5 sts`.
fn cast_on(input: &mut &str) -> winnow::Result<Term> {
    let (_, n, _) = (alt(("co", "caston")), number, stitches).parse_next(input)?;
    Ok(Term::Work(Work::CastOn(n)))
}

/// `cluster 3`, `wrap 3 sts`: stitches with the yarn around them.
fn cluster(input: &mut &str) -> winnow::Result<Term> {
    let (_, n, _) = (alt(("cluster", "wrap")), few, stitches).parse_next(input)?;
    Ok(special(&format!("cluster {n}"), n, n))
}

/// The name to write for a stitch as the knitter sees it, if there is one.
pub(super) fn name_of(stitch: &Stitch) -> Option<String> {
    let symbol = stitch.to_string();
    if let Some((_, names)) = STITCHES.iter().find(|(s, _)| *s == symbol) {
        return Some(names[0].to_owned());
    }
    let letter = match stitch.ops[..] {
        [Op { make: Make::Knit, twist: 0 }] => 'k',
        [Op { make: Make::Purl, twist: 0 }] => 'p',
        _ => return None,
    };
    let n = stitch.bottoms();
    let rising = (0..n as u8).eq(stitch.stack.iter().copied());
    let falling = (0..n as u8).rev().eq(stitch.stack.iter().copied());
    match n {
        2.. if rising => Some(format!("{letter}{n}tog")),
        2.. if falling => Some(format!("{letter}{n}tog tbl")),
        _ => None,
    }
}

/// The stitch that makes all of these loops in one, in the order they are worked.
pub(super) fn in_one(worked: impl DoubleEndedIterator<Item = Op>) -> Stitch {
    Stitch { ops: worked.rev().collect(), stack: smallvec![0] }
}
