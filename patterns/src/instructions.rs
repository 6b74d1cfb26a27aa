//! Instructions: a fabric in the words of a knitter, row by row.
//!
//! The rows are followed from the lowest up with the loops that are on the needle. Each row has to work all of them from one end
//! to the other; loops at the border that it leaves are bound off in it, and loops that it works without a stitch below them
//! are cast on at the end of what was worked before. Flat pieces begin on the right side, or where that leaves a
//! stitch without a name on the wrong one, and are turned after every row, tubes
//! are worked in rounds. A yarn-over that is part of a stitch is written beside it, as [`crate::knit`] would take it up again.
//! What repeats in a row is written once.

use crate::knitspeak::{Crossing, Side, Step, Work, Worked, WorkedRow, has_name};
use std::collections::{HashMap, HashSet};
use std::ops::Range;
use stitch_mesh::cable::Cable;
use stitch_mesh::ids::{EdgeId, FaceId};
use stitch_mesh::label::Row;
use stitch_mesh::stitch::{Make, Op, Stitch};
use stitch_mesh::stitch_mesh::StitchMesh;

/// Why a fabric cannot be knitted by hand row by row.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum InstructionsError {
    /// No rows.
    #[error("there are no stitches")]
    Empty,
    /// Rounds and flat rows.
    #[error(
        "stitch {0}: its row is closed and others are not, so the fabric is knitted neither flat nor in the round alone"
    )]
    Mixed(FaceId),
    /// Loops that wait for another row.
    #[error(
        "stitch {0}: its loop is not worked in the next row, but in one further up: the fabric divides there and has to be \
         knitted in pieces; select the rows of one of them"
    )]
    Divides(FaceId),
    /// Loops that come from somewhere else.
    #[error(
        "stitch {0}: its loop below does not come from the row before, or not in its place; the rows do not lie above each other"
    )]
    Elsewhere(FaceId),
    /// A stitch or cable without a name.
    #[error("stitch {face}: {what} has no name in written patterns, so nobody could be told to knit it")]
    Nameless {
        /// The stitch, or the first one above the cable.
        face: FaceId,
        /// Its symbol.
        what: String,
    },
}

/// A row while it is followed: what is worked, left to right, each with the face it is for.
type Line = Vec<(Work, Option<FaceId>)>;

/// What has to be worked to knit these rows of a fabric, the lowest first as in [`StitchMesh::rows`], or these parts of them. They
/// are told as a piece of their own: what lies around them does not count.
///
/// # Errors
/// [`InstructionsError`].
pub fn instructions(stitches: &StitchMesh, rows: &[Row]) -> Result<Worked, InstructionsError> {
    let first = rows.first().ok_or(InstructionsError::Empty)?;
    let in_the_round = first.closed;
    if let Some(other) = rows.iter().find(|row| row.closed != in_the_round) {
        return Err(InstructionsError::Mixed(other.faces[0]));
    }
    let inside: HashSet<FaceId> = rows.iter().flat_map(|row| row.faces.iter().copied()).collect();
    let mesh = stitches.mesh();
    let is_edge = |edge: EdgeId| {
        let (first, twin) = mesh.edge_sides(edge);
        twin.is_none_or(|twin| !inside.contains(&mesh.face(first)) || !inside.contains(&mesh.face(twin)))
    };
    let mut lines: Vec<Line> = Vec::with_capacity(rows.len());
    let mut needle: Vec<Loop> = Vec::new();
    for (r, row) in rows.iter().enumerate() {
        let last = r + 1 == rows.len();
        let mut line = follow(stitches, row, &needle, &is_edge, lines.last_mut())?;
        crossed(stitches, &mut line)?;
        needle = loops(stitches, &line);
        lines.push(line);
        if !last && needle.is_empty() {
            return Err(InstructionsError::Divides(row.faces[0]));
        }
    }
    // Some stitches have a name on one side only: flat pieces may begin on either.
    let right = told(&lines, rows, Side::Right);
    match right {
        Err(InstructionsError::Nameless { .. }) if !in_the_round => told(&lines, rows, Side::Wrong).or(right),
        right => right,
    }
}

/// Lines in the order of working, the first with this side facing.
fn told(lines: &[Line], rows: &[Row], first: Side) -> Result<Worked, InstructionsError> {
    let cast_on = lines[0].iter().map(|(work, _)| work.uses()).sum();
    let in_the_round = rows[0].closed;
    let mut before: usize = cast_on;
    let mut side = first;
    let mut worked = Worked { cast_on, in_the_round, rows: Vec::new(), warnings: Vec::new() };
    for (r, line) in lines.iter().enumerate() {
        let mut steps = Vec::with_capacity(line.len());
        for (work, face) in line {
            if !has_name(work, side) {
                let what = match work {
                    Work::Stitch(stitch) => stitch.to_string(),
                    _ => "this cable".to_owned(),
                };
                return Err(InstructionsError::Nameless { face: face.unwrap_or(rows[r].faces[0]), what });
            }
            before = before + work.makes() - work.uses();
            steps.push(Step { what: work.clone(), span: 0..0 });
        }
        if side == Side::Right {
            steps.reverse();
        }
        let repeats = repeats(&steps);
        worked.rows.push(WorkedRow { number: r + 1, side, steps, loops: before, repeats, span: 0..0 });
        side = if in_the_round { side } else { side.other() };
    }
    Ok(worked)
}

/// A loop on the needle, and the place in the last row's line that made it.
#[derive(Clone, Copy)]
struct Loop {
    edge: EdgeId,
    made_at: usize,
    by: FaceId,
}

/// What a row works, left to right. Loops it needs that nobody has made are cast on in the row before.
fn follow(
    stitches: &StitchMesh,
    row: &Row,
    needle: &[Loop],
    is_edge: &impl Fn(EdgeId) -> bool,
    mut before: Option<&mut Line>,
) -> Result<Line, InstructionsError> {
    let mesh = stitches.mesh();
    let place: HashMap<EdgeId, usize> = needle.iter().enumerate().map(|(i, l)| (l.edge, i)).collect();
    let mut line = Line::new();
    let mut at = 0;
    let mut cast_on = 0;
    // Loops that are passed over are bound off, if they wait for nobody.
    let pass = |line: &mut Line, from: usize, to: usize| -> Result<(), InstructionsError> {
        if let Some(waiting) = needle[from..to].iter().find(|l| !is_edge(l.edge)) {
            return Err(InstructionsError::Divides(waiting.by));
        }
        if to > from {
            line.push((Work::BindOff(to - from), None));
        }
        Ok(())
    };
    for face in &row.faces {
        for bottom in stitches.bottoms(*face) {
            let edge = mesh.edge(bottom);
            match (place.get(&edge), &mut before) {
                (Some(i), _) if *i >= at => {
                    pass(&mut line, at, *i)?;
                    at = i + 1;
                }
                (None, None) => {}
                (None, Some(line)) if is_edge(edge) => {
                    // After what made the loop before it, and what has been cast on since.
                    let made_at = at.checked_sub(1).map_or(0, |i| needle[i].made_at + 1);
                    line.insert(made_at + cast_on, (Work::CastOn(1), None));
                    cast_on += 1;
                }
                _ => return Err(InstructionsError::Elsewhere(*face)),
            }
        }
        line.extend(parts(stitches.stitch(*face)).into_iter().map(|work| (work, Some(*face))));
    }
    if before.is_some() && at == 0 {
        return Err(InstructionsError::Elsewhere(row.faces[0])); // nothing holds the row to what lies below
    }
    pass(&mut line, at, needle.len())?;
    if let Some(line) = before {
        gather(line);
    }
    Ok(line)
}

/// Loops cast on one after the other become one item.
fn gather(line: &mut Line) {
    line.dedup_by(|next, item| match (&next.0, &mut item.0) {
        (Work::CastOn(more), Work::CastOn(n)) => {
            *n += more;
            true
        }
        _ => false,
    });
}

/// A stitch and the yarn-overs that it holds, left to right.
fn parts(stitch: &Stitch) -> Vec<Work> {
    let is_over = |op: &Op| op.make == Make::YarnOver;
    let lead = stitch.ops.iter().take_while(|op| is_over(op)).count();
    if stitch.bottoms() == 0 || lead == stitch.ops.len() {
        return vec![Work::Stitch(stitch.clone())];
    }
    let trail = stitch.ops.iter().rev().take_while(|op| is_over(op)).count();
    let end = stitch.ops.len() - trail;
    let over = |op: &Op| Work::Stitch(Stitch { ops: [*op].into_iter().collect(), stack: Default::default() });
    let core = Stitch { ops: stitch.ops[lead..end].iter().copied().collect(), stack: stitch.stack.clone() };
    let overs = |range: Range<usize>| stitch.ops[range].iter().map(over);
    overs(0..lead).chain([Work::Stitch(core)]).chain(overs(end..stitch.ops.len())).collect()
}

/// Stitches above a cable become one item.
fn crossed(stitches: &StitchMesh, line: &mut Line) -> Result<(), InstructionsError> {
    let mesh = stitches.mesh();
    for cable in stitches.cables() {
        let edges: Vec<EdgeId> =
            cable.path.windows(2).filter_map(|w| mesh.edge_between(w[0], w[1])).collect();
        let above = |face: &FaceId| stitches.bottoms(*face).any(|h| edges.contains(&mesh.edge(h)));
        let is_above = |(_, face): &(Work, Option<FaceId>)| face.as_ref().is_some_and(above);
        let Some(first) = line.iter().position(is_above) else { continue };
        let count = line[first..].iter().take_while(|item| is_above(item)).count();
        let items = &line[first..first + count];
        let face = items[0].1;
        let works: Option<Vec<Stitch>> = items
            .iter()
            .map(|(work, _)| match work {
                Work::Stitch(stitch) if stitch.bottoms() == 1 => Some(stitch.clone()),
                _ => None,
            })
            .collect();
        let Some(works) = works.filter(|works| works.len() == edges.len()) else {
            let face = face.unwrap_or(FaceId(0));
            return Err(InstructionsError::Nameless { face, what: "a cable below shaping".to_owned() });
        };
        let Cable { strands, order, front, .. } = cable.clone();
        let crossing = Crossing { strands, order, front, stitches: works };
        line.splice(first..first + count, [(Work::Cross(crossing), face)]);
    }
    Ok(())
}

/// The loops that a row leaves on the needle.
fn loops(stitches: &StitchMesh, line: &Line) -> Vec<Loop> {
    let mesh = stitches.mesh();
    let mut loops = Vec::new();
    let mut last = None;
    for (made_at, (work, face)) in line.iter().enumerate() {
        let Some(face) = face.filter(|f| Some(*f) != last) else {
            // Of a stitch in parts the last one counts.
            if let (Some(_), Some(by)) = (face, last) {
                loops.iter_mut().filter(|l: &&mut Loop| l.by == by).for_each(|l| l.made_at = made_at);
            }
            continue;
        };
        let faces = match work {
            Work::Cross(crossing) => row_from(stitches, face, crossing.stitches.len()),
            _ => vec![face],
        };
        for by in faces {
            loops.extend(stitches.tops(by).map(|top| Loop { edge: mesh.edge(top), made_at, by }));
            last = Some(by);
        }
    }
    loops
}

/// A stitch and those on its right, so many in all.
fn row_from(stitches: &StitchMesh, face: FaceId, count: usize) -> Vec<FaceId> {
    let right = |f: &FaceId| stitches.mesh().face_across(stitches.right(*f));
    std::iter::successors(Some(face), right).take(count).collect()
}

/// The passes of what repeats in a row: the group that leaves least to be written, worked twice at least.
fn repeats(steps: &[Step]) -> Vec<Range<usize>> {
    let mut best = (0, 0..0, 1);
    for period in 2..=steps.len() / 2 {
        let same = |i: usize| steps[i].what == steps[i + period].what;
        let mut start = 0;
        while start + 2 * period <= steps.len() {
            let alike = (start..steps.len() - period).take_while(|i| same(*i)).count();
            let times = alike / period + 1;
            let plain = steps[start..start + period].windows(2).all(|w| w[0].what == w[1].what);
            let saved = (times - 1) * period;
            if times > 1 && !plain && saved > best.0 {
                best = (saved, start..start + times * period, period);
            }
            start += (alike + 1).max(1);
        }
    }
    let (_, all, period) = best;
    all.step_by(period).map(|start| start..start + period).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::knit::knit;
    use crate::knitspeak::{Pattern, Width, write};
    use stitch_mesh::edge_counts::StitchSize;
    use stitch_mesh::pieces::{rectangle, tube};

    const SIZE: StitchSize = StitchSize { width: 3e-3, height: 2.25e-3 };

    fn fabric(text: &str) -> StitchMesh {
        let pattern = Pattern::read(text).unwrap();
        knit(&pattern, &pattern.work(Width::AsWritten).unwrap(), SIZE).unwrap()
    }

    fn told(fabric: &StitchMesh) -> String {
        write(&instructions(fabric, &fabric.rows()).unwrap())
    }

    #[test]
    fn rows_are_told_with_their_repeats() {
        let text =
            told(&fabric("Row 1 (RS): K1, *yo, k2tog, repeat from * to last st, k1. Row 2: Purl. # x"));
        assert!(text.contains("Row 1 (RS): K1, *yo, k2tog, repeat from * to last st, k1."), "{text}");
        assert!(text.contains("Row 2: Purl."), "{text}");
        let rib = told(&fabric("Round 1: *K2, p2, repeat from *."));
        assert!(rib.contains("Round 1: *K2, p2, repeat from *."), "{rib}");
    }

    #[test]
    fn what_was_told_is_knitted_again() {
        for text in [
            "Row 1 (RS): K8. Row 2: Purl. Row 3: K2, 2/2 RC, k2. Row 4: P2, k4, p2.",
            "Row 1 (RS): K3, (k1, p1, k1) in next st, k3. Row 2: P3, p3tog, p3. Row 3: K1, M1L, k5, M1R, k1.",
            "# check: cast on 10, rows 2, most stitches 10\nRow 1 (RS): CO 3 sts, k10. Row 2: BO 3 sts, p9.",
        ] {
            let first = fabric(text);
            let again = told(&first);
            assert_eq!(fabric(&again), first, "{text}\n{again}");
        }
    }

    #[test]
    fn a_part_is_told_as_a_piece_of_its_own() {
        let flat = fabric(
            "# check: cast on 8, rows 4, most stitches 8\nRow 1 (RS): *K1, p1, repeat from *. Row 2: *K1, p1, repeat from *.",
        );
        let part = |row: &Row| Row { faces: row.faces[2..6].to_vec(), closed: false };
        let rows: Vec<Row> = flat.rows().iter().map(part).collect();
        let told = write(&instructions(&flat, &rows).unwrap());
        assert!(told.contains("cast on 4,") && told.contains("*K1, p1, repeat from *."), "{told}");
    }

    #[test]
    fn a_piece_may_begin_on_the_wrong_side() {
        let text = told(&fabric("Row 1 (WS): Purl. Row 2: K2, sk2p, k2. Row 3: Purl."));
        assert!(text.contains("(WS): Purl.") && text.contains("Row 2: K2, sk2p, k2."), "{text}");
    }

    #[test]
    fn what_cannot_be_knitted_in_rows_is_named() {
        let flat = rectangle(4, 4, SIZE).unwrap();
        let rows = flat.rows();
        let aside =
            [rows[0].clone(), Row { faces: rows[1].faces[..2].to_vec(), closed: false }, rows[2].clone()];
        assert!(instructions(&flat, &aside).is_ok(), "two loops are bound off, and cast on again");
        let skipping = [rows[0].clone(), rows[2].clone()];
        assert!(matches!(instructions(&flat, &skipping), Err(InstructionsError::Elsewhere(FaceId(8)))));
        let hole = fabric("Row 1 (RS): Knit. Row 2: P3, BO 2 sts, p3. Row 3: K4, CO 2 sts, k3. Row 4: Purl.");
        assert!(matches!(instructions(&hole, &hole.rows()), Err(InstructionsError::Divides(_))));
        let round = tube(5, 2, SIZE).unwrap();
        let mixed = [rows[0].clone(), round.rows()[0].clone()];
        assert!(matches!(instructions(&flat, &mixed), Err(InstructionsError::Mixed(_))));
        let mut strange = flat.clone();
        strange.set_stitch(FaceId(5), "x".parse().unwrap()).unwrap();
        let error = instructions(&strange, &strange.rows()).unwrap_err().to_string();
        assert!(error.starts_with("stitch 5: x has no name"), "{error}");
    }
}
