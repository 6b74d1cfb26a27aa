//! How often something is worked, in how many stitches, and how many stitches the writer counts.

use super::error::Fault;
use super::grammar::{ROW, STITCHES, Tokens, mark, next_span, number, read_to, word};
use super::lex::{Kind, Token};
use super::syntax::{Count, MOST, Reach};
use winnow::combinator::{alt, opt, repeat};
use winnow::prelude::*;
use winnow::token::any;

/// `in next st`, `all into same st`, `in each of next 3 sts`: in how many.
pub(super) fn in_next_stitches(input: &mut Tokens<'_, '_>) -> Result<usize, Fault> {
    let which = repeat::<_, _, (), _, _>(0.., word(&["each", "of", "next", "same", "the"]));
    let stitches = (number, word(STITCHES)).map(|t| t.0);
    let one = (opt(word(&["one"])), word(STITCHES)).value(1);
    (opt(word(&["all"])), word(&["in", "into"]), which, alt((stitches, one)))
        .map(|t| t.3)
        .verify(|n| (1..MOST).contains(n))
        .parse_next(input)
}

/// How far something is worked: `twice`, `3 times`, `x3`, `to end`, `to last 3 sts`.
pub(super) fn reach(input: &mut Tokens<'_, '_>) -> Result<Reach, Fault> {
    let end = || {
        (
            opt(word(&["the"])),
            word(&["end"]),
            opt((word(&["of"]), opt(word(&["the"])), alt((word(ROW), word(&["needle"]))))),
        )
    };
    let last = (opt(word(&["the"])), word(&["last"]), opt(number), word(STITCHES));
    let before = (number, word(STITCHES), word(&["before", "from"]), end());
    let to = (
        word(&["to", "until"]),
        alt((
            end().value(0),
            last.map(|t| t.2.unwrap_or(1)),
            before.map(|t| t.0),
            (number, opt(word(STITCHES)), word(&["remain", "remains", "rem"])).map(|t| t.0),
        )),
    );
    let more = || opt(word(&["more"]));
    alt((
        (opt(word(&["across", "around"])), to).map(|t| Reach::ToLast(t.1.1)),
        (word(&["across", "around"]), opt((opt(word(&["the"])), word(ROW)))).value(Reach::ToLast(0)),
        (word(&["all"]), opt(number), opt(word(STITCHES))).value(Reach::ToLast(0)),
        (word(&["once"]), more()).value(Reach::Times(1)),
        (word(&["twice"]), more()).value(Reach::Times(2)),
        (word(&["x"]), number).map(|t| Reach::Times(t.1)),
        (number, more(), word(&["times", "time"])).map(|t| Reach::Times(t.0)),
    ))
    .verify(|reach| !matches!(reach, Reach::Times(0 | MOST..) | Reach::ToLast(MOST..)))
    .parse_next(input)
}

/// `(10 sts)`, `(multiple of 8 sts, plus 1)`, `— 10 sts`.
pub(super) fn count(input: &mut Tokens<'_, '_>) -> Result<Option<Count>, Fault> {
    let begin = next_span(input).start;
    let open = alt((mark('('), mark('['), mark('-'))).parse_next(input)?;
    let counted = counted(input)?;
    // "(2 sts inc'd)" and "(2 more sts)" say what has changed, not what there is.
    let mut changes = false;
    if !open.is_mark('-') {
        while let Ok(token) = any::<_, Fault>.verify(|t: &&Token<'_>| !closes(t)).parse_next(input) {
            changes |= matches!(token.kind, Kind::Word("inc" | "dec" | "increased" | "decreased"));
        }
        any.verify(|t: &Token<'_>| closes(t)).parse_next(input)?;
    }
    let (multiple_of, number) = counted;
    Ok((!changes).then(|| Count { multiple_of, number, span: begin..read_to(input) }))
}

fn closes(token: &Token<'_>) -> bool {
    matches!(token.kind, Kind::Mark(')' | ']' | '.'))
}

/// `10 sts`, `multiple of 8 sts plus 1`, `multiple of 8 + 1`.
pub(super) fn counted(input: &mut Tokens<'_, '_>) -> Result<(Option<usize>, usize), Fault> {
    let plus = (opt(mark(',')), alt((word(&["plus"]), mark('+'))), number, opt(word(STITCHES))).map(|t| t.2);
    let multiple = (
        opt(word(&["a", "any"])),
        word(&["multiple"]),
        word(&["of"]),
        number,
        opt(word(STITCHES)),
        opt(plus),
    )
        .map(|t| (Some(t.3), t.5.unwrap_or(0)));
    let exact = (number, word(STITCHES)).map(|t| (None, t.0));
    alt((multiple, exact)).parse_next(input)
}
