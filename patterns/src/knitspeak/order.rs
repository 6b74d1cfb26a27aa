//! From sentences to the rows in the order they are worked.

use super::error::Fault;
use super::syntax::{All, Count, Item, MOST, Repeated, RowBody, Side, Statement, What};
use std::collections::BTreeMap;
use std::ops::Range;

/// A row as it is written. Rows of one sentence share what they work.
#[derive(Clone, Copy, Debug)]
pub(super) struct Written<'p> {
    pub number: usize,
    pub items: &'p [Item],
    pub count: Option<&'p Count>,
    pub span: &'p Range<usize>,
}

/// The rows of a pattern.
pub(super) struct Order<'p> {
    /// In the order of working, repeats written out.
    pub rows: Vec<Written<'p>>,
    pub in_the_round: bool,
    /// Side of the first row; the others alternate, unless they are rounds.
    pub first_side: Side,
    /// What the sides say against that.
    pub doubts: Vec<(usize, String)>,
}

/// What a row says, and which of the sentence's rows it is.
#[derive(Clone, Copy)]
struct Sentence<'p> {
    body: &'p RowBody,
    place: usize,
    count: Option<&'p Count>,
    span: &'p Range<usize>,
}

/// A repeat that is worked: the rows that it names, how often, and the number of the row before which it stands.
struct Block {
    rows: Vec<usize>,
    times: usize,
    before: usize,
    span: Range<usize>,
}

pub(super) fn order(statements: &[Statement]) -> Result<Order<'_>, Fault> {
    let in_the_round = rounds(statements)?;
    let (named_side, mut rows) = (side_of_row_1(statements), BTreeMap::new());
    let most = highest(statements);
    let side = |row: usize| side_at(named_side, row);
    let mut number_of_all = Vec::new();
    for statement in statements {
        let What::Rows { ids, body, count, .. } = &statement.what else { continue };
        let sentence = |place| Sentence { body, place, count: count.as_ref(), span: &statement.span };
        for (place, row) in ids.listed.iter().enumerate() {
            if rows.insert(*row, sentence(place)).is_some() {
                return Err(Fault::new(statement.span.clone(), "the row is given twice").in_row(*row));
            }
        }
        if let Some(all) = ids.all {
            number_of_all.push((all, ids.listed.first().copied().unwrap_or(1), sentence(0)));
        }
    }
    for (all, from, sentence) in number_of_all {
        let is_meant = |row: &usize| match all {
            All::Even => row.is_multiple_of(2),
            All::Odd => row % 2 == 1,
            All::Alternate => row % 2 == from % 2,
            All::On(wanted) => side(*row) == wanted,
        };
        // Where the first row is of another kind, the last one is followed by one of these.
        let last = if is_meant(&1) { most } else { most + 1 };
        for row in (from..=last).filter(is_meant) {
            rows.entry(row).or_insert(sentence);
        }
    }
    let blocks = blocks(statements, &rows)?;
    let mut worked = Vec::new();
    let mut expected = rows.keys().next().copied();
    let mut repeats = blocks.iter().peekable();
    for (number, sentence) in &rows {
        let mut repeated = false;
        while let Some(block) = repeats.next_if(|b| b.before <= *number) {
            expand(block, &rows, &mut worked)?;
            repeated = true;
        }
        if !repeated && expected.is_some_and(|n| n != *number) {
            let message = format!("row {} is missing before this one", expected.unwrap_or(1));
            return Err(Fault::new(sentence.span.clone(), message).in_row(*number));
        }
        expected = Some(number + 1);
        work(*number, sentence, &rows, &mut worked, 0)?;
    }
    for block in repeats {
        expand(block, &rows, &mut worked)?;
    }
    let Some(first) = worked.first() else {
        return Err(Fault::new(0..0, "the text has no rows; expected 'Row 1:' or 'Round 1:'"));
    };
    let first_side = if in_the_round { Side::Right } else { side(first.number) };
    let doubts = if in_the_round { Vec::new() } else { doubts(statements, named_side) };
    Ok(Order { rows: worked, in_the_round, first_side, doubts })
}

/// Whether the pattern is worked in rounds. Rounds after rows would need a seam that nobody has described.
fn rounds(statements: &[Statement]) -> Result<bool, Fault> {
    let kinds = || {
        statements.iter().filter_map(|s| match &s.what {
            What::Rows { round, .. } => Some((*round, &s.span)),
            _ => None,
        })
    };
    let first = kinds().next().is_some_and(|(round, _)| round);
    match kinds().find(|(round, _)| *round != first) {
        Some((_, span)) => Err(Fault::new(span.clone(), "found both rows and rounds, expected one of them")),
        None => Ok(first),
    }
}

/// A row whose side is named first, and that side.
fn side_of_row_1(statements: &[Statement]) -> (usize, Side) {
    let named = statements.iter().find_map(|s| match &s.what {
        What::Rows { ids, side: Some(side), .. } => Some((*ids.listed.first()?, *side)),
        _ => None,
    });
    named.unwrap_or((1, Side::Right))
}

fn side_at((row, side): (usize, Side), number: usize) -> Side {
    if row.abs_diff(number) % 2 == 0 { side } else { side.other() }
}

fn doubts(statements: &[Statement], named: (usize, Side)) -> Vec<(usize, String)> {
    let doubt = |s: &Statement| match &s.what {
        What::Rows { ids, side: Some(side), .. } => {
            let row = *ids.listed.first()?;
            let text = || format!("row {row} is said to be on the other side than row {} makes it", named.0);
            (side_at(named, row) != *side).then(|| (s.span.start, text()))
        }
        _ => None,
    };
    statements.iter().filter_map(doubt).collect()
}

fn highest(statements: &[Statement]) -> usize {
    let listed = statements.iter().filter_map(|s| match &s.what {
        What::Rows { ids, .. } => ids.listed.iter().copied().max(),
        _ => None,
    });
    listed.max().unwrap_or(1)
}

/// The repeats that are worked. One without a number at the end only says that the pattern goes on like this.
fn blocks(statements: &[Statement], rows: &BTreeMap<usize, Sentence<'_>>) -> Result<Vec<Block>, Fault> {
    let mut blocks = Vec::new();
    let (mut later, mut total) = (None, 0);
    for statement in statements.iter().rev() {
        let (named, times) = match &statement.what {
            What::Rows { ids, .. } => {
                later = ids.listed.iter().copied().chain(later).min();
                continue;
            }
            What::Repeat { rows, times } => (rows, times),
            What::CastOn(_) => continue,
        };
        let Some(times) = times.or(later.map(|_| 1)) else { continue };
        let before = later.unwrap_or(usize::MAX);
        let listed = match named {
            Repeated::Rows(listed) => listed.clone(),
            Repeated::Last(n) => {
                let known: Vec<usize> = rows.range(..before).map(|(row, _)| *row).collect();
                known[known.len().saturating_sub(n.unwrap_or(known.len()))..].to_vec()
            }
        };
        total += listed.len();
        if total > MOST {
            return Err(Fault::new(statement.span.clone(), format!("the pattern has more than {MOST} rows")));
        }
        blocks.push(Block { rows: listed, times, before, span: statement.span.clone() });
    }
    blocks.reverse();
    blocks.sort_by_key(|b| b.before);
    Ok(blocks)
}

fn expand<'p>(
    block: &Block,
    rows: &BTreeMap<usize, Sentence<'p>>,
    worked: &mut Vec<Written<'p>>,
) -> Result<(), Fault> {
    for _ in 0..block.times {
        for row in &block.rows {
            let Some(sentence) = rows.get(row) else {
                return Err(Fault::new(block.span.clone(), format!("row {row} is not in the pattern")));
            };
            work(*row, sentence, rows, worked, 0)?;
        }
    }
    Ok(())
}

/// Adds a row, or those that it is the same as.
fn work<'p>(
    number: usize,
    sentence: &Sentence<'p>,
    rows: &BTreeMap<usize, Sentence<'p>>,
    worked: &mut Vec<Written<'p>>,
    depth: usize,
) -> Result<(), Fault> {
    let Sentence { body, place, count, span } = *sentence;
    let fault = |message: String| Err(Fault::new(span.clone(), message).in_row(number));
    if worked.len() >= MOST {
        return fault(format!("the pattern has more than {MOST} rows"));
    }
    match body {
        RowBody::Items(items) => {
            worked.push(Written { number, items, count, span });
            Ok(())
        }
        RowBody::As(list) => {
            // "Rows 5-8: repeat rows 1-4" goes through both lists side by side.
            let source = list[place % list.len()];
            match rows.get(&source) {
                Some(same) if depth < 8 => {
                    work(source, same, rows, worked, depth + 1)?;
                    if let Some(last) = worked.last_mut() {
                        (last.number, last.span, last.count) = (number, span, count.or(last.count));
                    }
                    Ok(())
                }
                Some(_) => fault(format!("row {source} refers to rows that refer to each other")),
                None => fault(format!("row {source} is not in the pattern")),
            }
        }
    }
}
