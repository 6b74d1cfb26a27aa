//! Works the rows of a pattern with a certain number of stitches.

use super::error::{Fault, Warning};
use super::measure::{Part, Segment, segments};
use super::order::{Order, Written, order};
use super::solve::{self, Measured, wanted};
use super::syntax::{Body, Count, Item, MOST, Reach, Side, Statement, What};
use super::term::{Term, Work, Yarn};
use super::{Pattern, Width};
use std::collections::HashMap;
use std::ops::Range;
use std::rc::Rc;
use stitch_mesh::stitch::{Make, Op, Stitch};

/// Steps at the most in a whole pattern.
const MOST_STEPS: usize = 4_000_000;

/// Said of a comment that begins like the writer's figures and does not go on so.
const UNREAD_CHECK: &str =
    "figures that nothing is checked by: expected 'check: cast on 17, rows 6, most stitches 17'";

/// A pattern with a certain number of stitches, worked out stitch by stitch.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Worked {
    /// Stitches cast on.
    pub cast_on: usize,
    /// Whether it is worked in rounds, whose right side always faces the knitter.
    pub in_the_round: bool,
    /// The rows in the order of working.
    pub rows: Vec<WorkedRow>,
    /// What is doubtful in the text.
    pub warnings: Vec<Warning>,
}

/// A row, worked out.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct WorkedRow {
    /// Its number in the pattern; repeated rows keep theirs.
    pub number: usize,
    /// The side that faces the knitter at its beginning.
    pub side: Side,
    /// What is worked, in that order: on the right side from right to left as seen from the front.
    pub steps: Vec<Step>,
    /// Loops on the needles after it.
    pub loops: usize,
    /// The steps of each pass of its open group.
    pub repeats: Vec<Range<usize>>,
    /// Bytes of the sentence that it was read from.
    pub span: Range<usize>,
}

/// One thing worked.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Step {
    /// What it is, as seen from the front.
    pub what: Work,
    /// Bytes of the text that it was read from.
    pub span: Range<usize>,
}

impl Worked {
    /// Most stitches on the needles between two rows.
    pub fn most_stitches(&self) -> usize {
        self.rows.iter().map(|row| row.loops).fold(self.cast_on, usize::max)
    }
}

/// What the writer of a text says about its swatch, in a comment: `# check: cast on 17, rows 6, most stitches 17`.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Check {
    pub cast_on: usize,
    pub rows: usize,
    pub most: usize,
    pub at: usize,
}

/// Works a pattern.
pub(super) fn work(pattern: &Pattern, width: Width) -> Result<Worked, Fault> {
    let order = order(&pattern.statements)?;
    let rows = measured(&order)?;
    let cast_on_said = pattern.statements.iter().find_map(|s| match &s.what {
        What::CastOn(Count { multiple_of: None, number, .. }) => Some(*number),
        _ => None,
    });
    let cast_on = match width {
        Width::CastOn(n) => n,
        Width::Repeats(n) => solve::cast_on(&rows, Some(n))?,
        Width::AsWritten => match pattern.check.as_ref().map(|c| c.cast_on).or(cast_on_said) {
            Some(n) => n,
            None => solve::cast_on(&rows, None)?,
        },
    };
    if cast_on > MOST {
        return Err(Fault::new(
            0..0,
            format!("{cast_on} stitches are more than the {MOST} that can be cast on"),
        ));
    }
    let mut needles = Needles { left: cast_on, waiting: 0, steps: 0 };
    let mut worked =
        Worked { cast_on, in_the_round: order.in_the_round, rows: Vec::new(), warnings: Vec::new() };
    let mut side = order.first_side;
    for (row, segments) in &rows {
        let done = needles.row(row, segments, side).map_err(|fault| fault.in_row(row.number))?;
        if order.in_the_round && segments.iter().filter(|s| s.turn.is_some()).count() % 2 == 1 {
            let message = "the round ends on the wrong side: it is turned an odd number of times";
            return Err(Fault::new(row.span.clone(), message).in_row(row.number));
        }
        worked.rows.push(done);
        side = if order.in_the_round { side } else { side.other() };
    }
    let doubts = doubts(&order, &pattern.statements, &worked)
        .chain(pattern.check.iter().flat_map(|check| check.doubts(&worked)))
        .chain(order.doubts.iter().cloned())
        .chain(pattern.unread_checks.iter().map(|at| (*at, UNREAD_CHECK.to_owned())));
    let mut doubts: Vec<_> = doubts.collect();
    doubts.sort();
    worked.warnings = doubts.into_iter().map(|(at, text)| pattern.lines.warning(at, text)).collect();
    Ok(worked)
}

/// Measures every row once; rows of one sentence share the figures.
fn measured<'p>(order: &Order<'p>) -> Result<Vec<Measured<'p>>, Fault> {
    let mut known: HashMap<*const Item, Rc<Vec<Segment<'p>>>> = HashMap::new();
    let mut rows = Vec::with_capacity(order.rows.len());
    for row in &order.rows {
        let at = row.items.as_ptr();
        let segments = match known.get(&at) {
            Some(segments) => segments.clone(),
            None => Rc::new(segments(row.items).map_err(|fault| fault.in_row(row.number))?),
        };
        known.insert(at, segments.clone());
        rows.push((*row, segments));
    }
    Ok(rows)
}

/// Where the writer's own counts differ from what comes out.
fn doubts<'a>(
    order: &'a Order<'_>,
    statements: &'a [Statement],
    worked: &'a Worked,
) -> impl Iterator<Item = (usize, String)> + 'a {
    let rows = order.rows.iter().zip(&worked.rows).filter_map(|(written, row)| {
        let text = written.count?.differs_from(row.loops)?;
        Some((written.count?.span.start, format!("row {}: {text}", row.number)))
    });
    let cast_on = statements.iter().filter_map(|s| match &s.what {
        What::CastOn(count) => Some((count.span.start, count.differs_from(worked.cast_on)?)),
        _ => None,
    });
    rows.chain(cast_on)
}

impl Count {
    fn differs_from(&self, loops: usize) -> Option<String> {
        let Self { multiple_of, number, .. } = self;
        match multiple_of {
            None if loops != *number => {
                Some(format!("the text says {number} stitches, but there are {loops}"))
            }
            Some(n @ 1..) if loops < *number || !(loops - number).is_multiple_of(*n) => {
                Some(format!("the text says a multiple of {n} stitches plus {number}, but there are {loops}"))
            }
            _ => None,
        }
    }
}

impl Check {
    fn doubts(&self, worked: &Worked) -> Vec<(usize, String)> {
        let says = |what, said: usize, is: usize| {
            (said != is).then(|| (self.at, format!("the check line says {what} {said}, but there are {is}")))
        };
        // With another cast-on the most stitches are others too.
        let most = if self.cast_on == worked.cast_on { worked.most_stitches() } else { self.most };
        [says("rows", self.rows, worked.rows.len()), says("most stitches", self.most, most)]
            .into_iter()
            .flatten()
            .collect()
    }
}

/// Loops to be worked, and loops that wait on the other needle behind a turn.
struct Needles {
    left: usize,
    waiting: usize,
    steps: usize,
}

impl Needles {
    fn row(&mut self, row: &Written<'_>, segments: &[Segment<'_>], side: Side) -> Result<WorkedRow, Fault> {
        let (mut steps, mut repeats, mut facing) = (Vec::new(), Vec::new(), side);
        for segment in segments {
            let passes = self.passes(segment).map_err(|why| Fault::new(row.span.clone(), why))?;
            let (open_uses, open_makes) = segment.open.map_or((0, 0), |o| (o.uses, o.makes));
            let (mut worked, mut made) =
                (segment.uses + passes * open_uses, segment.makes + passes.saturating_mul(open_makes));
            let fastened_off = segment.binds_off && worked == self.left + 1;
            if fastened_off {
                (worked, made) = (worked - 1, made - 1);
            }
            let rest = self.left.saturating_sub(worked);
            self.left = self.waiting.saturating_add(made);
            self.waiting = rest;
            self.steps = self.steps.saturating_add(worked + made);
            if self.left.saturating_add(self.waiting) > MOST || self.steps > MOST_STEPS {
                let message =
                    format!("up to here there are more than {MOST} stitches in a row or {MOST_STEPS} in all");
                return Err(Fault::new(row.span.clone(), message));
            }
            for part in &segment.parts {
                emit_part(part, passes, facing, &mut steps, &mut repeats);
            }
            if fastened_off {
                // The stitch that would be left of the last ones bound off.
                steps.pop();
            }
            if let Some(turn) = segment.turn {
                emit(turn, facing, &mut steps);
                facing = facing.other();
            }
        }
        let loops = self.left + self.waiting;
        Ok(WorkedRow { number: row.number, side, steps, loops, repeats, span: row.span.clone() })
    }

    /// How often the open group is worked, or why the segment does not fit.
    fn passes(&self, segment: &Segment<'_>) -> Result<usize, String> {
        let (left, fixed) = (self.left, segment.uses + segment.leaves);
        let Some(open) = segment.open else {
            let fits = match segment.turn {
                Some(_) => fixed <= left,
                None => fixed == left || segment.binds_off && fixed == left + 1,
            };
            return if fits {
                Ok(0)
            } else {
                Err(format!("the row works {fixed} stitches, but there are {left}"))
            };
        };
        let least = usize::from(open.is_group);
        let passes = left.saturating_sub(fixed).div_ceil(open.uses).max(least);
        let works = fixed + passes * open.uses;
        if works == left {
            return Ok(passes);
        }
        let needs = wanted(fixed as i128, open);
        let what = if open.is_group { "its repeat needs" } else { "it needs" };
        Err(format!("the row works {works} stitches, but there are {left}; {what} {needs}"))
    }
}

fn emit_part(
    part: &Part<'_>,
    passes: usize,
    side: Side,
    steps: &mut Vec<Step>,
    repeats: &mut Vec<Range<usize>>,
) {
    let Part { item, times, to_the_last } = part;
    let step = |what| Step { what, span: item.span.clone() };
    match &item.body {
        Body::Term(Term::BindOffRest) => {
            let n = times.unwrap_or(passes);
            steps.extend((n > 0).then(|| step(Work::BindOff(n))));
        }
        Body::Term(Term::BindOff(n)) if *to_the_last => steps.push(step(Work::BindOff(*n))),
        Body::Group(items) => {
            for _ in 0..times.unwrap_or(passes) {
                let begin = steps.len();
                items.iter().for_each(|item| emit(item, side, steps));
                repeats.extend(times.is_none().then_some(begin..steps.len()));
            }
        }
        Body::Term(term) => emit_term(term, times.unwrap_or(passes), side, &item.span, steps),
    }
}

/// An item inside a group, or a turn.
fn emit(item: &Item, side: Side, steps: &mut Vec<Step>) {
    let Reach::Times(times) = item.reach else { return };
    match &item.body {
        Body::Term(term) => emit_term(term, times, side, &item.span, steps),
        Body::Group(items) => {
            for _ in 0..times {
                items.iter().for_each(|item| emit(item, side, steps));
            }
        }
    }
}

fn emit_term(term: &Term, times: usize, side: Side, span: &Range<usize>, steps: &mut Vec<Step>) {
    for _ in 0..times {
        let mut push = |what| steps.push(Step { what, span: span.clone() });
        match term {
            Term::Work(work) => push(work.facing(side)),
            Term::Slip(yarn) => push(slipped(*yarn, side)),
            Term::BindOff(n) => {
                push(Work::BindOff(*n));
                push(Work::Stitch(Stitch::knit()).facing(side));
            }
            Term::BindOffRest => push(Work::BindOff(1)),
        }
    }
}

/// A slipped stitch has its yarn behind it as seen from the front if it is held in back on the right side, or in front on
/// the wrong side. That is what is meant where nothing is said: the strand stays out of sight.
fn slipped(yarn: Option<Yarn>, side: Side) -> Work {
    let hidden = match side {
        Side::Right => Yarn::Back,
        Side::Wrong => Yarn::Front,
    };
    match yarn.unwrap_or(hidden) {
        yarn if yarn == hidden => {
            let slip = Op { make: Make::Slip, twist: 0 };
            Work::Stitch(Stitch { ops: [slip].into_iter().collect(), ..Stitch::knit() })
        }
        Yarn::Back => Work::Special { name: "sl1 wyib".to_owned(), uses: 1, makes: 1 },
        Yarn::Front => Work::Special { name: "sl1 wyif".to_owned(), uses: 1, makes: 1 },
    }
}
