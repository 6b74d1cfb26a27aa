//! A written pattern knitted: its rows become rows of a stitch mesh.
//!
//! Every stitch is a face: a decrease has several bottoms, an increase several tops. A yarn-over has no loop below it, so it
//! becomes a top of a stitch beside it, as the faces of Yuksel et al. (Table 1, Fig. 14) have it: of the stitch that is knitted
//! into one loop, of two such of the one that makes fewer loops so far, and then of the one on its right. Only where there is
//! none it goes to a decrease, which then makes two loops out of its own.
//!
//! Rows that shrink, grow, bind off, cast on and turn are worked on a [`Needle`]. What a mesh cannot hold is an error that names
//! the place in the text.

use crate::knitspeak::{Fault, KnitSpeakError, Pattern, Side, Step, Work, Worked, WorkedRow};
use stitch_mesh::cable::Cable;
use stitch_mesh::edge_counts::StitchSize;
use stitch_mesh::needle::{Item, Needle, NeedleError};
use stitch_mesh::stitch::{Make, Op, Stitch};
use stitch_mesh::stitch_mesh::StitchMesh;

/// Knits what a pattern came to, flat or in the round.
///
/// Where loops cross in the first row, or it is turned, a plain row is knitted below it: a cable needs stitches on both sides,
/// and so does the step at a turn.
///
/// # Errors
/// What the mesh cannot hold: where in the text, and why.
pub fn knit(pattern: &Pattern, worked: &Worked, size: StitchSize) -> Result<StitchMesh, KnitSpeakError> {
    knitted(worked, size).map_err(|fault| pattern.error(fault))
}

fn knitted(worked: &Worked, size: StitchSize) -> Result<StitchMesh, Fault> {
    let start = worked.rows.first().map_or(0..0, |row| row.span.clone());
    let fault = |error: NeedleError| Fault::new(start.clone(), error.to_string());
    let mut needle = Needle::cast_on(worked.cast_on, worked.in_the_round, size).map_err(fault)?;
    if needs_foundation(worked) {
        needle.work(0, &foundation(worked)).map_err(fault)?;
    }
    // Where the yarn comes from: so many loops of the needle lie on its left.
    let mut at = needle.loops();
    if worked.rows.first().is_some_and(|row| row.side == Side::Wrong) {
        at = 0;
    }
    for row in &worked.rows {
        if worked.in_the_round {
            at = needle.loops();
        }
        let mut side = row.side;
        for part in row.steps.split(|step| matches!(step.what, Work::Turn { .. })) {
            at = stretch(&mut needle, at, part, side).map_err(|fault| fault.in_row(row.number))?;
            side = side.other();
        }
    }
    needle.finish().map_err(|error| Fault::new(start, error.to_string()))
}

/// Works a stretch of a row, up to a turn or to its end. Returns where the yarn comes to.
fn stretch(needle: &mut Needle, at: usize, steps: &[Step], side: Side) -> Result<usize, Fault> {
    let Some(span) = steps.first().zip(steps.last()).map(|(a, b)| a.span.start..b.span.end) else {
        return Ok(at);
    };
    let uses: usize = steps.iter().map(|step| step.what.uses()).sum();
    let items = items(steps, side)?;
    let left = if side == Side::Right { at } else { needle.loops() - at };
    if uses > left {
        let error = NeedleError::Loops { wanted: uses, left };
        return Err(Fault::new(span, error.to_string()));
    }
    let from = if side == Side::Right { at - uses } else { at };
    let made = needle.work(from, &items).map_err(|error| Fault::new(span, error.to_string()))?;
    Ok(if side == Side::Right { from } else { from + made })
}

/// A row that is worked from one end to the other, left to right as seen from the front, with yarn-overs in the stitches that
/// hold them.
pub(crate) fn items_of_row(row: &WorkedRow) -> Result<Vec<Item>, Fault> {
    let at_edge = |step: &&Step| matches!(step.what, Work::BindOff(_) | Work::CastOn(_) | Work::Turn { .. });
    if let Some(step) = row.steps.iter().find(at_edge) {
        let message = "loops are bound off or cast on here, or the row is turned: it can be knitted as a swatch, but not tiled";
        return Err(Fault::new(step.span.clone(), message).in_row(row.number));
    }
    items(&row.steps, row.side).map_err(|fault| fault.in_row(row.number))
}

fn items(steps: &[Step], side: Side) -> Result<Vec<Item>, Fault> {
    // From right to left as seen from the front, whatever side was worked: so the same fabric comes out of both.
    let mut worked: Vec<&Step> = steps.iter().collect();
    if side == Side::Wrong {
        worked.reverse();
    }
    let mut items: Vec<Item> = worked.iter().map(|step| item(step)).collect::<Result<_, _>>()?;
    for i in 0..items.len() {
        let Some(made) = yarn_over(&items[i]) else { continue };
        let Some(parent) = parent(&items, i) else {
            return Err(Fault::new(worked[i].span.clone(), NeedleError::Alone.to_string()));
        };
        let on_left = parent < i;
        if let Some(stitch) = nearest(&mut items[parent], on_left) {
            // Beside what the stitch makes of its own; those on its right come from right to left.
            let own = stitch.ops.iter().rposition(|op| op.make != Make::YarnOver).map_or(0, |last| last + 1);
            stitch.ops.insert(if on_left { 0 } else { own }, made);
        }
    }
    items.retain(|item| yarn_over(item).is_none());
    items.reverse();
    Ok(items)
}

fn item(step: &Step) -> Result<Item, Fault> {
    Ok(match &step.what {
        Work::Stitch(stitch) => Item::Stitch(stitch.clone()),
        Work::Cross(crossing) => {
            let (strands, order, front) =
                (crossing.strands.clone(), crossing.order.clone(), crossing.front.clone());
            Item::Cross(Cable { path: Vec::new(), strands, order, front }, crossing.stitches.clone())
        }
        Work::BindOff(n) => Item::BindOff(*n),
        Work::CastOn(n) => Item::CastOn(*n),
        // Rows are split at their turns before.
        Work::Turn { .. } => return Err(Fault::new(step.span.clone(), "the row is turned here")),
        Work::Special { name, .. } => {
            let message = format!("'{name}' cannot be held by a stitch mesh, whose rows are one loop high");
            return Err(Fault::new(step.span.clone(), message));
        }
    })
}

/// What makes the loop of a yarn-over that has no stitch yet.
fn yarn_over(item: &Item) -> Option<Op> {
    match item {
        Item::Stitch(stitch) if stitch.bottoms() == 0 => stitch.ops.first().copied(),
        _ => None,
    }
}

/// The stitch of an item that lies nearest to its left, or to its right.
fn nearest(item: &mut Item, left: bool) -> Option<&mut Stitch> {
    match item {
        Item::Stitch(stitch) => Some(stitch),
        Item::Cross(_, stitches) => {
            let place = if left { 0 } else { stitches.len().saturating_sub(1) };
            stitches.get_mut(place)
        }
        Item::BindOff(_) | Item::CastOn(_) => None,
    }
}

/// The item to whose stitch a yarn-over goes, see the module.
fn parent(items: &[Item], i: usize) -> Option<usize> {
    let beside = |mut others: Box<dyn Iterator<Item = usize>>| {
        others.find(|j| yarn_over(&items[*j]).is_none()).filter(|j| burden(&items[*j]).is_some())
    };
    let right = beside(Box::new((0..i).rev()));
    let left = beside(Box::new(i + 1..items.len()));
    // Of equals the first.
    [right, left].into_iter().flatten().min_by_key(|j| burden(&items[*j]))
}

/// How unlike a plain stitch a possible parent is; none for what makes no stitch.
fn burden(item: &Item) -> Option<(bool, bool, usize)> {
    match item {
        Item::Stitch(stitch) => {
            let slipped = stitch.ops.iter().any(|op| matches!(op.make, Make::Slip | Make::Cross));
            Some((slipped, stitch.bottoms() > 1, stitch.tops()))
        }
        Item::Cross(..) => Some((false, true, 1)),
        Item::BindOff(_) | Item::CastOn(_) => None,
    }
}

/// Whether loops cross in the first row, or it is turned before its end: on the edge the fabric would hang together in a point
/// there.
fn needs_foundation(worked: &Worked) -> bool {
    let needs = |step: &Step| matches!(step.what, Work::Cross(_) | Work::Turn { .. });
    worked.rows.first().is_some_and(|row| row.steps.iter().any(needs))
}

/// A plain row below the first: as the last one, where that is plain and as wide.
fn foundation(worked: &Worked) -> Vec<Item> {
    let plain = |item: &Item| matches!(item, Item::Stitch(s) if *s == Stitch::knit() || *s == Stitch::purl());
    let last = worked.rows.last().and_then(|row| items_of_row(row).ok());
    last.filter(|items| items.len() == worked.cast_on && items.iter().all(plain))
        .unwrap_or_else(|| vec![Item::Stitch(Stitch::knit()); worked.cast_on])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::knitspeak::Width;

    fn swatch(text: &str, width: Width) -> Result<StitchMesh, KnitSpeakError> {
        let pattern = Pattern::read(text)?;
        knit(&pattern, &pattern.work(width)?, StitchSize::of_width(4e-3))
    }

    fn rows(fabric: &StitchMesh) -> Vec<String> {
        let symbols = |row: &stitch_mesh::label::Row| -> Vec<String> {
            row.faces.iter().map(|f| fabric.stitch(*f).to_string()).collect()
        };
        fabric.rows().iter().map(|row| symbols(row).join(" ")).collect()
    }

    #[test]
    fn right_and_wrong_side_rows_read_left_to_right_from_the_front() {
        let text = "Row 1 (RS): K1, p2, k2tog. Row 2: P1, ssk, k1.";
        assert_eq!(rows(&swatch(text, Width::CastOn(5)).unwrap()), ["d12k p p k", "k d21p p"]);
    }

    #[test]
    fn yarn_overs_go_to_plain_stitches() {
        let knit = |text: &str, n| rows(&swatch(text, Width::CastOn(n)).unwrap()).remove(0);
        assert_eq!(knit("Row 1: K2, yo, k2tog, k1.", 5), "k d12k yk k");
        assert_eq!(knit("Row 1: K1, k2tog, yo, k1.", 4), "ky d12k k");
        assert_eq!(knit("Row 1: K1, yo, k1, yo, k1.", 3), "k yk yk");
        assert_eq!(knit("Row 1: K2tog, yo x2, k2tog.", 4), "d12ky d12yk");
        // The same row worked from the other side.
        assert_eq!(knit("Row 1 (WS): P1, p2tog, yo, p1.", 4), "k d12k yk");
    }

    #[test]
    fn cables_cross_above_a_row() {
        let fabric = swatch("Row 1 (RS): K6. Row 2: Purl. Row 3: K1, 2/2 RC, k1.", Width::CastOn(6)).unwrap();
        let cable = &fabric.cables()[0];
        assert_eq!((cable.strands.clone(), cable.front.clone()), (vec![2, 2], vec![0, 1]));
        let first = swatch("Row 1 (RS): K1, 2/2 RC, k1. Row 2: Purl.", Width::CastOn(6)).unwrap();
        assert_eq!((first.rows().len(), first.cables().len()), (3, 1));
    }

    #[test]
    fn rounds_close_and_short_rows_turn() {
        let round = swatch("Round 1: *K2, p2, repeat from *.", Width::CastOn(12)).unwrap();
        assert!(round.rows()[0].closed);
        let text = "Row 1 (RS): K4, w&t. Row 2: P4. Row 3: K8. Row 4: Purl.";
        let short = swatch(text, Width::CastOn(8)).unwrap();
        assert_eq!(short.mesh().face_count(), 8 + 4 + 4 + 8 + 8);
    }

    #[test]
    fn buttonholes_are_bound_off_and_cast_on() {
        let text = "Row 1 (RS): Knit. Row 2: P3, BO 2 sts, p3. Row 3: K4, CO 2 sts, k3. Row 4: Purl.";
        let fabric = swatch(text, Width::CastOn(9)).unwrap();
        assert_eq!(fabric.mesh().borders().len(), 2);
        assert_eq!(fabric.mesh().face_count(), 9 + 7 + 7 + 9);
    }

    #[test]
    fn what_a_mesh_cannot_hold_is_named() {
        let error = swatch("Row 1 (RS): K1, MB, k1.", Width::CastOn(3)).unwrap_err();
        assert_eq!((error.line, error.column, error.row), (1, 17, Some(1)));
        assert!(error.message.contains("cannot be held"), "{error}");
    }
}
