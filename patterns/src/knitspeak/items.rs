//! Reads what is worked in a row: stitches, runs, groups in brackets and the open group between stars.

use super::amounts::{count, in_next_stitches, reach};
use super::error::Fault;
use super::grammar::{REPEAT, ROW, Tokens, expected, mark, next_span, read_to, word};
use super::lex::{Kind, Token};
use super::syntax::{Body, Item, Reach};
use super::term::{Crossing, Term, Work};
use super::vocabulary;
use stitch_mesh::stitch::{Op, Stitch};
use winnow::combinator::{alt, opt, peek};
use winnow::prelude::*;
use winnow::stream::Stream;

/// Brackets in brackets at the most; nobody can follow more than three.
const DEEPEST: usize = 32;

/// Tokens of one name at the most: "sl 1, k 2 tog, psso" with its commas has room to spare.
const LONGEST_NAME: usize = 14;

/// Items up to a mark that ends them, or a word that belongs to what surrounds them.
pub(super) fn items(input: &mut Tokens<'_, '_>, depth: usize) -> Result<Vec<Item>, Fault> {
    if depth > DEEPEST {
        return Err(Fault::new(next_span(input), format!("brackets are nested more than {DEEPEST} deep")));
    }
    let mut items: Vec<Item> = Vec::new();
    loop {
        while opt(alt((mark(','), mark(';')))).parse_next(input)?.is_some() {}
        opt((word(&["end", "ending"]), opt(word(&["with"])))).parse_next(input)?;
        let Some(first) = input.first().cloned() else { break };
        let repeats = REPEAT.iter().any(|w| first.is(w));
        if repeats && depth == 0 && !items.is_empty() && items.iter().all(is_repeatable) {
            // "K1, p1, rep to end" without a star.
            if let Some((_, reach)) = opt((word(REPEAT), reach)).parse_next(input)? {
                let mut group = all_of(&mut items, reach);
                group.span.end = read_to(input);
                items = vec![group];
                continue;
            }
        }
        let is_end = matches!(first.kind, Kind::Mark('.' | ']' | ')' | '}'));
        let is_outer =
            REPEAT.iter().chain(ROW).any(|w| first.is(w)) || ["all", "every"].iter().any(|w| first.is(w));
        if is_end || is_outer || peek(count).parse_next(input).is_ok() {
            break;
        }
        if first.is_mark('*') && depth > 0 {
            break;
        }
        let (item, counted) = item(input, depth)?;
        match (item.reach, counted) {
            // "K1, p1 to end" repeats all of it, not the last stitch.
            (reach @ Reach::ToLast(_), Some(n)) if !items.is_empty() && items.iter().all(is_repeatable) => {
                items.push(Item { reach: Reach::Times(n), ..item });
                items = vec![all_of(&mut items, reach)];
            }
            _ => items.push(item),
        }
    }
    if items.is_empty() { expected(input, "a stitch") } else { Ok(items) }
}

/// Whether a group that has no sign where it begins can begin before this.
fn is_repeatable(item: &Item) -> bool {
    let once = |term: &Term| {
        let shapes = matches!(term, Term::Work(Work::CastOn(_) | Work::Turn { .. }));
        shapes || matches!(term, Term::BindOff(_) | Term::BindOffRest)
    };
    matches!(item.reach, Reach::Times(_)) && !matches!(&item.body, Body::Term(term) if once(term))
}

/// All of these items as one group.
fn all_of(items: &mut Vec<Item>, reach: Reach) -> Item {
    let ends = items.first().zip(items.last());
    let span = ends.map_or(0..0, |(first, last)| first.span.start..last.span.end);
    Item { body: Body::Group(std::mem::take(items)), reach, span }
}

/// One item, and the number of its own that a run has.
fn item(input: &mut Tokens<'_, '_>, depth: usize) -> Result<(Item, Option<usize>), Fault> {
    let begin = next_span(input).start;
    let closing = match input.first().map(|t| t.kind) {
        Some(Kind::Mark('*')) => return star(input, depth).map(|item| (item, None)),
        Some(Kind::Mark('[')) => ']',
        Some(Kind::Mark('(')) => ')',
        Some(Kind::Mark('{')) => '}',
        _ => return named(input, depth),
    };
    input.next_token();
    let inner = items(input, depth + 1)?;
    if opt(mark(closing)).parse_next(input)?.is_none() {
        return expected(input, &format!("a comma or '{closing}'"));
    }
    if let Some(stitches) = opt(in_next_stitches).parse_next(input)? {
        let span = begin..read_to(input);
        let ops = increase(&inner).ok_or_else(|| {
            Fault::new(
                span.clone(),
                "only knits, purls and yarn-overs, up to 16, can be worked into one stitch",
            )
        })?;
        let term = Term::Work(Work::Stitch(vocabulary::in_one(ops.into_iter())));
        let reach = opt(reach).parse_next(input)?.unwrap_or(Reach::Times(stitches));
        return Ok((Item { body: Body::Term(term), reach, span: begin..read_to(input) }, None));
    }
    opt(word(REPEAT)).parse_next(input)?;
    let Some(reach) = opt(reach).parse_next(input)? else {
        return expected(input, "how often the group is worked, as in 'twice' or '3 times'");
    };
    Ok((Item { body: Body::Group(inner), reach, span: begin..read_to(input) }, None))
}

/// `* items, repeat from *`, and how far. Without a number it goes on as long as there is room for what follows.
fn star(input: &mut Tokens<'_, '_>, depth: usize) -> Result<Item, Fault> {
    let begin = next_span(input).start;
    input.next_token();
    let mut inner = items(input, depth + 1)?;
    let closed = opt(mark('*')).parse_next(input)?.is_some();
    while opt(alt((mark(','), mark(';')))).parse_next(input)?.is_some() {}
    if opt(word(REPEAT)).parse_next(input)?.is_none() && !closed {
        let goes_on = inner.len() == 1 && matches!(inner[0].reach, Reach::ToLast(_));
        let last = inner.pop().filter(|_| goes_on);
        return last.map_or_else(|| expected(input, "a comma or 'repeat from *'"), Ok);
    }
    opt((opt(word(&["from"])), opt(mark('*')), opt((word(&["to"]), mark('*'))))).parse_next(input)?;
    let reach = match opt(reach).parse_next(input)? {
        // What is repeated so often has been worked once already.
        Some(Reach::Times(n)) if !closed => Reach::Times(n.saturating_add(1)),
        Some(reach) => reach,
        None => Reach::Rest,
    };
    Ok(Item { body: Body::Group(inner), reach, span: begin..read_to(input) })
}

/// A stitch by its name, the longest that the vocabulary knows, and its number.
fn named(input: &mut Tokens<'_, '_>, depth: usize) -> Result<(Item, Option<usize>), Fault> {
    let begin = next_span(input).start;
    let (mut name, mut best) = (String::new(), None);
    let mut commas = false;
    for (i, token) in input.iter().take(LONGEST_NAME).enumerate() {
        match token.kind {
            Kind::Word(word) => name.push_str(word),
            Kind::Number(n) => name.push_str(&n.to_string()),
            Kind::Mark('/') => name.push('/'),
            Kind::Mark('-') => {}
            // Only a stitch passed over another is written with commas inside.
            Kind::Mark(',') => commas = true,
            Kind::Mark(_) => break,
        }
        let whole = !commas || name.ends_with("sso");
        if whole && matches!(token.kind, Kind::Word(_) | Kind::Number(_)) {
            best = vocabulary::find(&name).map(|named| (i + 1, named)).or(best);
        }
    }
    // What hangs on to a name without a blank belongs to it: 'k2tgo' is not k2.
    let hangs_on = |pair: &[Token<'_>]| {
        pair[0].span.end == pair[1].span.start && matches!(pair[1].kind, Kind::Word(_) | Kind::Number(_))
    };
    let length_is = |length: usize| !input.get(length - 1..=length).is_some_and(hangs_on);
    let Some((length, (mut term, count))) = best.filter(|(length, _)| length_is(*length)) else {
        return expected_stitch(input);
    };
    let whole_word = input.first().is_some_and(|t| t.is("knit") || t.is("purl"));
    input.next_slice(length);
    if let Term::Work(Work::Cross(crossing)) = &mut term
        && input.first().is_some_and(|t| t.is_mark('('))
        && peek(super::amounts::count).parse_next(input).is_err()
    {
        strand_behind(input, crossing, depth)?;
    }
    let reach = match (opt(reach).parse_next(input)?, count) {
        (Some(Reach::Times(n)), Some(count)) => Reach::Times(n.saturating_mul(count)),
        (Some(reach), _) => reach,
        (None, Some(n)) => Reach::Times(n),
        (None, None) if whole_word || term == Term::BindOffRest => Reach::ToLast(0),
        (None, None) => Reach::Times(1),
    };
    let span = begin..read_to(input);
    if term == Term::BindOffRest && reach != Reach::ToLast(0) {
        return Err(Fault::new(span, "all stitches can be bound off only once, and to the end"));
    }
    if reach == Reach::Times(0) {
        return Err(Fault::new(span, "a stitch worked 0 times is none; expected 1 or more"));
    }
    Ok((Item { body: Body::Term(term), reach, span }, count))
}

/// A fault about the whole word that stands where a stitch should.
fn expected_stitch<T>(input: &Tokens<'_, '_>) -> Result<T, Fault> {
    let is_part = |t: &&Token<'_>| !matches!(t.kind, Kind::Mark(mark) if mark != '-' && mark != '/');
    let (mut name, mut span) = (String::new(), next_span(input));
    span.end = span.start;
    for token in input.iter().take(LONGEST_NAME).take_while(is_part) {
        if token.span.start != span.end {
            break;
        }
        match token.kind {
            Kind::Word(word) => name.push_str(word),
            Kind::Number(n) => name.push_str(&n.to_string()),
            Kind::Mark(mark) => name.push(mark),
        }
        span.end = token.span.end;
    }
    if name.is_empty() {
        return expected(input, "a stitch");
    }
    Err(Fault::new(span, format!("found '{name}', expected a stitch, a cable, '[' or '*'")))
}

/// `(p1, k1)` after a cable: the stitches of the strand that lies behind, in the order they are worked.
fn strand_behind(input: &mut Tokens<'_, '_>, crossing: &mut Crossing, depth: usize) -> Result<(), Fault> {
    let begin = next_span(input).start;
    input.next_token();
    let inner = items(input, depth + 1)?;
    if opt(mark(')')).parse_next(input)?.is_none() {
        return expected(input, "a comma or ')'");
    }
    let place = crossing.behind();
    let ops =
        increase(&inner).filter(|ops| ops.len() == place.len() && ops.iter().all(|o| o.make.pulls_through()));
    let Some(ops) = ops else {
        let message = format!("expected the {} knits and purls of the strand that lies behind", place.len());
        return Err(Fault::new(begin..read_to(input), message));
    };
    let left_to_right = ops.into_iter().rev().map(|op| vocabulary::in_one([op].into_iter()));
    crossing.stitches.splice(place, left_to_right);
    Ok(())
}

/// What is worked into one stitch, in the order of working.
fn increase(items: &[Item]) -> Option<Vec<Op>> {
    let mut ops = Vec::new();
    for item in items {
        let (Body::Term(Term::Work(Work::Stitch(Stitch { ops: made, stack }))), Reach::Times(n)) =
            (&item.body, item.reach)
        else {
            return None;
        };
        if stack.len() > 1 || made.len() != 1 || n > 16 {
            return None;
        }
        ops.extend(std::iter::repeat_n(made[0], n));
    }
    let is_held = ops.iter().any(|op| op.make.pulls_through());
    (is_held && ops.len() <= 16).then_some(ops)
}
