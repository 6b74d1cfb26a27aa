//! The pieces that all sentences are read with: single words, marks and numbers, and what to say when another one stands there.

use super::error::Fault;
use super::lex::{Kind, Token};
use std::ops::Range;
use winnow::error::ParserError;
use winnow::prelude::*;
use winnow::stream::TokenSlice;
use winnow::token::any;

/// The rest of the tokens of a text.
pub(super) type Tokens<'s, 't> = TokenSlice<'s, Token<'t>>;

/// Words for stitches.
pub(super) const STITCHES: &[&str] = &["st", "sts", "stitch", "stitches"];
/// Words for repeating.
pub(super) const REPEAT: &[&str] = &["repeat", "rep"];
/// Words for rows; the first two are not rounds.
pub(super) const ROW: &[&str] = &["row", "rows", "round", "rounds", "rnd", "rnds"];

impl<'s, 't> ParserError<Tokens<'s, 't>> for Fault {
    type Inner = Self;

    /// Most of these are thrown away when the next alternative is tried, so it does not say what was found.
    fn from_input(input: &Tokens<'s, 't>) -> Self {
        Self::new(next_span(input), "")
    }

    fn into_inner(self) -> Result<Self, Self> {
        Ok(self)
    }
}

/// Where the next token is; at the end of the text, right behind the last one.
pub(super) fn next_span(input: &Tokens<'_, '_>) -> Range<usize> {
    let end = || input.previous_tokens().next().map_or(0, |t| t.span.end);
    input.first().map_or_else(|| end()..end(), |t| t.span.clone())
}

/// End of what has been read.
pub(super) fn read_to(input: &Tokens<'_, '_>) -> usize {
    input.previous_tokens().next().map_or(0, |t| t.span.end)
}

fn found(input: &Tokens<'_, '_>) -> String {
    match input.first().map(|t| t.kind) {
        None => "the end of the text".to_owned(),
        Some(Kind::Word(word)) => format!("'{word}'"),
        Some(Kind::Number(n)) => format!("'{n}'"),
        Some(Kind::Mark(mark)) => format!("'{}'", mark.escape_debug()),
    }
}

/// A fault at the next token.
pub(super) fn expected<T>(input: &Tokens<'_, '_>, what: &str) -> Result<T, Fault> {
    Err(Fault::new(next_span(input), format!("found {}, expected {what}", found(input))))
}

/// One of these words.
pub(super) fn word<'s, 't: 's>(
    words: &'static [&'static str],
) -> impl Parser<Tokens<'s, 't>, &'s Token<'t>, Fault> {
    any.verify(move |t: &Token<'t>| words.iter().any(|w| t.is(w)))
}

/// This mark.
pub(super) fn mark<'s, 't: 's>(mark: char) -> impl Parser<Tokens<'s, 't>, &'s Token<'t>, Fault> {
    any.verify(move |t: &Token<'t>| t.is_mark(mark))
}

/// A number.
pub(super) fn number(input: &mut Tokens<'_, '_>) -> Result<usize, Fault> {
    any.verify_map(|t: &Token<'_>| if let Kind::Number(n) = t.kind { Some(n) } else { None })
        .parse_next(input)
}
