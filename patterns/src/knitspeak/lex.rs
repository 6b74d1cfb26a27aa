//! Words, numbers and marks of a KnitSpeak text.
//!
//! `k2tog` is the three tokens `k`, `2`, `tog`, and so is `K 2 tog`: names are put together again by the vocabulary, so that
//! blanks, capitals and hyphens make no difference to it.

use std::ops::Range;
use winnow::ascii::digit1;
use winnow::combinator::{alt, repeat};
use winnow::prelude::*;
use winnow::stream::LocatingSlice;
use winnow::token::{any, take_while};

/// What a token is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind<'t> {
    /// Letters, in lower case; `w&t` is one word.
    Word(&'t str),
    /// A number; one that is too large for anything is the largest.
    Number(usize),
    /// Any other character. All dashes are `-`.
    Mark(char),
}

/// A token and where it stands.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Token<'t> {
    pub kind: Kind<'t>,
    pub span: Range<usize>,
}

impl Token<'_> {
    pub fn is(&self, word: &str) -> bool {
        self.kind == Kind::Word(word)
    }

    pub fn is_mark(&self, mark: char) -> bool {
        self.kind == Kind::Mark(mark)
    }
}

type Input<'t> = LocatingSlice<&'t str>;

/// Tokens of a text in lower case. Quotation marks mean nothing in it.
pub(super) fn tokens(lower: &str) -> Vec<Token<'_>> {
    let mut input = LocatingSlice::new(lower);
    let mut tokens = Vec::new();
    while blank(&mut input).is_ok() {
        let Ok(token) = token(&mut input) else { break };
        tokens.push(token);
    }
    tokens
}

fn blank(input: &mut Input<'_>) -> winnow::Result<()> {
    let silent = |c: char| c.is_whitespace() || "\u{feff}\"'“”„‘’`".contains(c);
    repeat(0.., alt((take_while(1.., silent).void(), ('#', take_while(0.., |c| c != '\n')).void())))
        .parse_next(input)
}

fn token<'t>(input: &mut Input<'t>) -> winnow::Result<Token<'t>> {
    let letters = take_while(1.., |c: char| c.is_ascii_lowercase() || c == '&');
    alt((
        letters.map(Kind::Word),
        digit1.map(|digits: &str| Kind::Number(digits.parse().unwrap_or(usize::MAX))),
        '×'.value(Kind::Word("x")),
        any.map(|c| Kind::Mark(if "‐‑‒–—−".contains(c) { '-' } else { c })),
    ))
    .with_span()
    .map(|(kind, span)| Token { kind, span })
    .parse_next(input)
}
