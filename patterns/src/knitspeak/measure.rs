//! How many loops a row works and makes, with at most one open group in it.
//!
//! A row falls into segments where the work is turned. With `left` loops on the left needle a segment works
//! `uses + k × open.uses` of them and leaves `leaves`; it fits if that comes out for some number k of passes. Once a group says
//! how many stitches it leaves ("to last 3 sts"), what follows can be open as well: it is known how often it is worked.

use super::error::Fault;
use super::syntax::{Body, Item, MOST, Reach};
use super::term::{Term, Work};

/// Part of a row up to a turn or to its end.
pub(super) struct Segment<'p> {
    pub parts: Vec<Part<'p>>,
    /// Loops worked and made by all but the open group.
    pub uses: usize,
    pub makes: usize,
    /// Loops left unworked before the turn, if the open group says so.
    pub leaves: usize,
    pub open: Option<Open>,
    /// The turn that ends it.
    pub turn: Option<&'p Item>,
    /// Whether it ends with binding off a number of stitches and has no open group. If one loop less is there than that takes,
    /// the last of them is fastened off.
    pub binds_off: bool,
}

/// An item, and how often it is worked: `None` for the open group.
pub(super) struct Part<'p> {
    pub item: &'p Item,
    pub times: Option<usize>,
    /// Binds off the last loop too, which is fastened off, as the open group before says.
    pub to_the_last: bool,
}

/// The open group of a segment.
#[derive(Clone, Copy)]
pub(super) struct Open {
    pub uses: usize,
    pub makes: usize,
    /// Whether it is a group, which is worked at least once, or a stitch such as "knit to end", which may find no room.
    pub is_group: bool,
}

/// Splits a row at its turns and measures what lies between them.
pub(super) fn segments(items: &[Item]) -> Result<Vec<Segment<'_>>, Fault> {
    let mut segments = Vec::new();
    for chunk in items.split_inclusive(is_turn) {
        segments.push(match chunk.split_last() {
            Some((turn, items)) if is_turn(turn) => segment(items, Some(turn))?,
            _ => segment(chunk, None)?,
        });
    }
    Ok(segments)
}

fn is_turn(item: &Item) -> bool {
    matches!(item.body, Body::Term(Term::Work(Work::Turn { .. }))) && item.reach == Reach::Times(1)
}

fn segment<'p>(items: &'p [Item], turn: Option<&'p Item>) -> Result<Segment<'p>, Fault> {
    let mut segment =
        Segment { parts: Vec::new(), uses: 0, makes: 0, leaves: 0, open: None, turn, binds_off: false };
    // Loops still to be worked, once that is known.
    let mut known: Option<usize> = None;
    for (i, item) in items.iter().enumerate() {
        let (uses, makes) = size(&item.body)?;
        let fault = |message: String| Err(Fault::new(item.span.clone(), message));
        if matches!(item.body, Body::Term(Term::Work(Work::Turn { .. }))) {
            return fault("the work can be turned only once in one place".to_owned());
        }
        let leave = match item.reach {
            Reach::Times(times) => {
                let to_the_last = match item.body {
                    Body::Term(Term::BindOff(n)) => i + 1 == items.len() && known == Some(n),
                    _ => false,
                };
                let (uses, makes) = if to_the_last { (uses - 1, 0) } else { (uses, makes) };
                add(&mut segment, item, (uses, makes), times)?;
                if let Some(rest) = known {
                    let Some(rest) = rest.checked_sub(uses * times) else {
                        return fault(format!(
                            "the stitches before leave {rest}, but this works {}",
                            uses * times
                        ));
                    };
                    known = Some(rest);
                }
                segment.parts.push(Part { item, times: Some(times), to_the_last });
                continue;
            }
            Reach::ToLast(leave) => Some(leave),
            Reach::Rest => None,
        };
        if uses == 0 {
            return fault("the group works no stitches, so it would never end".to_owned());
        }
        let mut times = None;
        if segment.open.is_none() {
            segment.open = Some(Open { uses, makes, is_group: matches!(item.body, Body::Group(_)) });
            known = leave;
        } else {
            let (Some(rest), leave) = (known, leave.unwrap_or(0)) else {
                return fault(
                    "a second open group in the row: nothing says where the first one ends".to_owned(),
                );
            };
            if rest < leave || (rest - leave) % uses != 0 {
                return fault(format!("{rest} stitches are left here, which does not come out"));
            }
            let fits = (rest - leave) / uses;
            add(&mut segment, item, (uses, makes), fits)?;
            (times, known) = (Some(fits), Some(leave));
        }
        segment.parts.push(Part { item, times, to_the_last: false });
    }
    let open = segment.parts.iter().find(|p| p.times.is_none()).map(|p| p.item.span.clone());
    let last = segment.parts.last().map(|p| (&p.item.body, p.times));
    segment.binds_off =
        open.is_none() && turn.is_none() && matches!(last, Some((Body::Term(Term::BindOff(_)), Some(1))));
    match (known, open) {
        (Some(rest @ 1..), Some(span)) if turn.is_none() => {
            let message =
                format!("the row goes on to the last stitches, but what follows leaves {rest} of them");
            return Err(Fault::new(span, message));
        }
        (rest, _) => segment.leaves = rest.unwrap_or(0),
    }
    Ok(segment)
}

fn add(
    segment: &mut Segment<'_>,
    item: &Item,
    (uses, makes): (usize, usize),
    times: usize,
) -> Result<(), Fault> {
    let total = |sum: usize, one: usize| one.checked_mul(times)?.checked_add(sum).filter(|n| *n <= MOST);
    let (Some(uses), Some(makes)) = (total(segment.uses, uses), total(segment.makes, makes)) else {
        return Err(too_many(item));
    };
    (segment.uses, segment.makes) = (uses, makes);
    Ok(())
}

fn too_many(item: &Item) -> Fault {
    Fault::new(item.span.clone(), format!("the row has more than {MOST} stitches"))
}

/// Loops that one pass of it works and makes.
fn size(body: &Body) -> Result<(usize, usize), Fault> {
    let group = match body {
        Body::Term(term) => return Ok(term.size()),
        Body::Group(items) => items,
    };
    let mut sum = (0usize, 0usize);
    for item in group {
        let Reach::Times(times) = item.reach else {
            let message = "what goes on as long as there is room cannot stand inside another group";
            return Err(Fault::new(item.span.clone(), message));
        };
        if matches!(item.body, Body::Term(Term::Work(Work::Turn { .. }) | Term::BindOffRest)) {
            return Err(Fault::new(item.span.clone(), "this cannot stand inside a group"));
        }
        let one = size(&item.body)?;
        let total = |sum: usize, one: usize| one.checked_mul(times)?.checked_add(sum).filter(|n| *n <= MOST);
        let (Some(uses), Some(makes)) = (total(sum.0, one.0), total(sum.1, one.1)) else {
            return Err(too_many(item));
        };
        sum = (uses, makes);
    }
    Ok(sum)
}
