//! Reads the sentences of a pattern: rows, repeats, and what is cast on.

use super::amounts::{count, counted};
use super::error::Fault;
use super::grammar::{REPEAT, ROW, Tokens, expected, mark, next_span, number, read_to, word};
use super::items::items;
use super::lex::{Kind, tokens};
use super::syntax::{All, Body, Count, Ids, Item, MOST, Reach, Repeated, RowBody, Side, Statement, What};
use winnow::combinator::{alt, opt, peek};
use winnow::prelude::*;
use winnow::stream::{Stream, TokenSlice};
use winnow::token::any;

/// Reads all sentences of a text in lower case.
pub(super) fn statements(lower: &str) -> Result<Vec<Statement>, Fault> {
    let tokens = tokens(lower);
    let input = &mut TokenSlice::new(&tokens[..]);
    let (mut statements, mut rows) = (Vec::new(), 0);
    loop {
        while opt(mark('.')).parse_next(input)?.is_some() {}
        if input.is_empty() {
            return Ok(statements);
        }
        let begin = next_span(input);
        let statement = statement(input).map_err(|fault| match fault.message.is_empty() {
            true => Fault::new(begin, "this sentence is not KnitSpeak"),
            false => fault,
        })?;
        rows += match &statement.what {
            What::Rows { ids, body: RowBody::As(list), .. } => ids.listed.len() + list.len(),
            What::Rows { ids, .. } => ids.listed.len(),
            What::Repeat { rows: Repeated::Rows(list), .. } => list.len(),
            _ => 0,
        };
        if rows > 2 * MOST {
            return Err(Fault::new(statement.span, format!("the pattern has more than {MOST} rows")));
        }
        statements.push(statement);
    }
}

fn statement(input: &mut Tokens<'_, '_>) -> Result<Statement, Fault> {
    let begin = next_span(input).start;
    let what = if peek(alt((word(ROW), word(&["all", "every"])))).parse_next(input).is_ok() {
        rows(input)?
    } else if opt(word(REPEAT)).parse_next(input)?.is_some() {
        repeat(input)?
    } else if opt(alt((word(&["co"]).void(), (word(&["cast"]), word(&["on"])).void())))
        .parse_next(input)?
        .is_some()
    {
        let from = next_span(input).start;
        let Ok((multiple_of, number)) = counted(input) else {
            return expected(input, "a number of stitches, as in '20 sts' or 'a multiple of 8 sts plus 1'");
        };
        What::CastOn(Count { multiple_of, number, span: from..read_to(input) })
    } else {
        return expected(input, "'Row', 'Round' or 'Repeat'");
    };
    Ok(Statement { what, span: begin..read_to(input) })
}

fn rows(input: &mut Tokens<'_, '_>) -> Result<What, Fault> {
    let mut ids = Ids::default();
    let round;
    if let Some((all, is_round)) = opt(all).parse_next(input)? {
        (ids.all, round) = (Some(all), is_round);
    } else if let Some(name) = opt(word(ROW)).parse_next(input)? {
        round = !(name.is("row") || name.is("rows"));
        ids.listed = listed(input)?;
        ids.all = opt(and_all).parse_next(input)?;
    } else {
        return expected(input, "which rows, as in 'all WS rows'");
    }
    let first = ids.listed.first().copied();
    let in_row = |fault: Fault| if let Some(row) = first { fault.in_row(row) } else { fault };
    let (side, before) = labels(input, &mut ids).map_err(in_row)?;
    ids.all = opt(and_all).parse_next(input)?.or(ids.all);
    if opt(mark(':')).parse_next(input)?.is_none() {
        return expected(input, "':' after the rows' numbers").map_err(in_row);
    }
    let face = opt((mark('('), self::side, mark(')')).map(|t| t.1)).parse_next(input).map_err(in_row)?;
    let side = side.or(face);
    let body = body(input).map_err(in_row)?;
    let after = ending(input).map_err(in_row)?;
    Ok(What::Rows { ids, round, side, body, count: after.or(before) })
}

fn body(input: &mut Tokens<'_, '_>) -> Result<RowBody, Fault> {
    let same = alt(((word(&["as"]), opt(word(&["for", "in"]))).void(), word(REPEAT).void()));
    if opt((opt(word(&["work", "same"])), same, peek(word(ROW)))).parse_next(input)?.is_some() {
        input.next_token();
        return listed(input).map(RowBody::As);
    }
    let first = input.first().map(|t| t.kind);
    let bare = matches!(first, Some(Kind::Word("k" | "p")))
        && !input.get(1).is_some_and(|t| matches!(t.kind, Kind::Number(_)));
    let mut items = items(input, 0)?;
    // "Row 1: k." and "Row 2: p tbl." are whole rows of it.
    if let [Item { body: Body::Term(term), reach: reach @ Reach::Times(1), .. }] = &mut items[..]
        && bare
        && term.size() == (1, 1)
    {
        *reach = Reach::ToLast(0);
    }
    Ok(RowBody::Items(items))
}

/// The end of a row with the writer's count before or behind the full stop, which a line's end stands for as well.
fn ending(input: &mut Tokens<'_, '_>) -> Result<Option<Count>, Fault> {
    let before = opt(count).parse_next(input)?.flatten();
    let stop = opt(mark('.')).parse_next(input)?;
    let after = opt(count).parse_next(input)?.flatten();
    let next = alt((word(ROW), word(REPEAT), word(&["all", "every", "co", "cast"])));
    if stop.is_none() && after.is_none() && !input.is_empty() && peek(next).parse_next(input).is_err() {
        return expected(input, "a comma or a full stop");
    }
    Ok(before.or(after))
}

/// `1`, `2, 4, and 6`, `2-8`.
fn listed(input: &mut Tokens<'_, '_>) -> Result<Vec<usize>, Fault> {
    let mut list = Vec::new();
    loop {
        let begin = next_span(input).start;
        let Ok(from) = number(input) else { return expected(input, "a row's number") };
        let range = (alt((mark('-').void(), word(&["to", "through"]).void())), number);
        let to = opt(range).parse_next(input)?.map_or(from, |t| t.1);
        if to < from || to >= MOST || list.len() + (to - from) >= MOST {
            let message = format!("found rows {from} to {to}, expected rising numbers below {MOST}");
            return Err(Fault::new(begin..read_to(input), message));
        }
        list.extend(from..=to);
        let separator = alt(((mark(','), opt(word(&["and"]))).void(), word(&["and", "&"]).void()));
        if opt((separator, peek(number))).parse_next(input)?.is_none() {
            return Ok(list);
        }
    }
}

/// `all even rows`, `every following WS row`.
fn all(input: &mut Tokens<'_, '_>) -> Result<(All, bool), Fault> {
    let which = alt((word(&["even"]).value(All::Even), word(&["odd"]).value(All::Odd), side.map(All::On)));
    let named = (opt(word(&["other", "following"])), which, opt(word(&["numbered"]))).map(|t| t.1);
    let alternate = word(&["other", "alternate"]).value(All::Alternate);
    let (_, which, name) = (word(&["all", "every"]), alt((named, alternate)), word(ROW)).parse_next(input)?;
    Ok((which, !(name.is("row") || name.is("rows"))))
}

/// `, and all even rows` after those that are listed.
fn and_all(input: &mut Tokens<'_, '_>) -> Result<All, Fault> {
    (opt(mark(',')), word(&["and"]), all).map(|t| t.2.0).parse_next(input)
}

fn side(input: &mut Tokens<'_, '_>) -> Result<Side, Fault> {
    alt((
        word(&["rs"]).value(Side::Right),
        word(&["ws"]).value(Side::Wrong),
        (word(&["right"]), word(&["side"])).value(Side::Right),
        (word(&["wrong"]), word(&["side"])).value(Side::Wrong),
    ))
    .parse_next(input)
}

/// What stands between the numbers and the colon: the side, which of a range, or a count.
fn labels(input: &mut Tokens<'_, '_>, ids: &mut Ids) -> Result<(Option<Side>, Option<Count>), Fault> {
    let (mut faces, mut counts) = (None, None);
    loop {
        if let Some(count) = opt(count).parse_next(input)? {
            counts = count;
            continue;
        }
        let bracket = opt(mark('(')).parse_next(input)?;
        if let Some(side) = opt(side).parse_next(input)? {
            faces = Some(side);
        } else if let Some(parity) = opt(word(&["even", "odd"])).parse_next(input)? {
            let rest = usize::from(parity.is("odd"));
            ids.listed.retain(|row| row % 2 == rest);
        } else if bracket.is_some() {
            return expected(input, "RS or WS");
        } else {
            return Ok((faces, counts));
        }
        opt(word(&["row", "rows"])).parse_next(input)?;
        if bracket.is_some() && opt(mark(')')).parse_next(input)?.is_none() {
            return expected(input, "')'");
        }
    }
}

/// `rows 1-4`, `these 4 rows`, `rows 1-4 twice more`, and prose up to the full stop: "for pattern until long enough".
fn repeat(input: &mut Tokens<'_, '_>) -> Result<What, Fault> {
    opt(word(&["from"])).parse_next(input)?;
    let rows = if opt(word(ROW)).parse_next(input)?.is_some() {
        Repeated::Rows(listed(input)?)
    } else {
        let these =
            (opt(word(&["these", "the", "all"])), opt(word(&["last", "previous"])), opt(number), word(ROW));
        let Some((_, _, last, _)) = opt(these).parse_next(input)? else {
            return expected(input, "'row' or 'rows' and their numbers");
        };
        Repeated::Last(last)
    };
    let more = || opt(word(&["more"]));
    let times = alt((
        (word(&["once"]), more()).value(1),
        (word(&["twice"]), more()).value(2),
        (number, more(), word(&["times", "time"])).map(|t| t.0),
    ));
    let begin = next_span(input).start;
    let times = opt(times).parse_next(input)?;
    if times.is_some_and(|n| n > MOST) {
        return Err(Fault::new(begin..read_to(input), format!("expected at most {MOST} repeats")));
    }
    let prose = |t: &Tokens<'_, '_>| t.first().is_some_and(|t| !t.is_mark('.'));
    while prose(input) {
        any::<_, Fault>.parse_next(input)?;
    }
    Ok(What::Repeat { rows, times })
}
