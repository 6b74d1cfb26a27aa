//! What stitches look like in a chart: the symbols of the Craft Yarn Council, drawn from lines and dots.
//!
//! All are as seen from the right side. A decrease leans the way its front loop does, and a dot beside it says that it is
//! purled; an increase is a fan of the loops it makes, with a dot at those that are purled. A stitch that has no symbol is
//! shown by its own name in a box.

use super::Crossing;
use super::lettering;
use super::mark::{Ink, Mark, Paint, Point, arc, rectangle};
use stitch_mesh::stitch::{Make, Op, Stitch};

/// Where the feet and the heads of symbols are, from the top of a square.
const FOOT: f32 = 0.84;
const HEAD: f32 = 0.16;

/// The marks of a stitch in a cell of one square for each loop that it makes, its upper left corner at the origin.
pub fn of(stitch: &Stitch) -> Vec<Mark> {
    let passes = stitch.ops.iter().any(|op| op.make.passes_on());
    match (&stitch.stack[..], &stitch.ops[..]) {
        (stack, []) if !stack.is_empty() => gathered(),
        ([], [op]) | ([_], [op]) => one(*op, stitch.bottoms()),
        ([_], ops) if !passes && ops.iter().all(|op| op.twist == 0) => increase(ops),
        (stack, [Op { make, twist: 0 }]) if make.pulls_through() => decrease(stack, *make == Make::Purl),
        _ => named(stitch),
    }
}

/// One loop from one loop, or from none.
fn one(op: Op, bottoms: usize) -> Vec<Mark> {
    let middle = [0.5, 0.5];
    match (op.make, op.twist) {
        (Make::Knit, 0) => Vec::new(),
        (Make::Purl, 0) => vec![Mark::dot(middle, 0.13)],
        (Make::Knit | Make::Purl, _) => {
            let mut marks = vec![twisted()];
            if op.make == Make::Purl {
                marks.push(Mark::line([[0.2, 0.92], [0.8, 0.92]]));
            }
            marks
        }
        // A loop on the cast-on is open below.
        (Make::YarnOver, _) if bottoms > 0 => {
            let legs = [[0.26, FOOT], [0.26, 0.5]].into_iter();
            vec![Mark::line(legs.chain(arc(middle, [0.24, 0.3], 0.5, 1.0)).chain([[0.74, FOOT]]))]
        }
        (Make::YarnOver, 0) => vec![Mark::line(arc(middle, [0.28; 2], 0.0, 1.0))],
        // Make one: a branch to the side that the loop leans to.
        (Make::YarnOver, twist) => {
            let side = if twist > 0 { 0.82 } else { 0.18 };
            vec![Mark::line([[0.5, FOOT], [0.5, HEAD]]), Mark::line([[0.5, 0.6], [side, HEAD]])]
        }
        (Make::Slip, _) => vec![Mark::line([[0.22, HEAD], [0.5, FOOT], [0.78, HEAD]])],
        (Make::Cross, _) => vec![
            Mark::line([[0.22, HEAD], [0.5, FOOT], [0.78, HEAD]]),
            Mark::line([[0.16, 0.42], [0.84, 0.42]]),
        ],
    }
}

/// A loop whose legs cross at its foot.
fn twisted() -> Mark {
    let around = arc([0.5, 0.38], [0.23, 0.24], 0.4, 1.1);
    Mark::line(std::iter::once([0.74, 0.8]).chain(around).chain([[0.26, 0.8]]))
}

/// Loops gathered on the yarn of the row: an arch over them.
fn gathered() -> Vec<Mark> {
    vec![Mark::line(arc([0.5, 0.66], [0.34, 0.34], 0.5, 1.0))]
}

/// A fan from one foot to all loops.
fn increase(ops: &[Op]) -> Vec<Mark> {
    let foot = [ops.len() as f32 / 2.0, FOOT];
    let mut marks = Vec::new();
    for (i, op) in ops.iter().enumerate() {
        let head = [i as f32 + 0.5, 0.24];
        marks.push(Mark::line([foot, head]));
        match op.make {
            Make::Purl => marks.push(Mark::dot(head, 0.11)),
            Make::YarnOver => {
                let ring: Vec<Point> = arc(head, [0.14; 2], 0.0, 1.0).collect();
                marks.push(Mark::area(ring.clone(), Ink::White));
                marks.push(Mark::line(ring));
            }
            _ => {}
        }
    }
    marks
}

/// The feet of a decrease run together into the line of the loop in front, which leans away from its side.
fn decrease(stack: &[u8], purled: bool) -> Vec<Mark> {
    let n = stack.len();
    let foot = |b: u8| [0.2 + 0.6 * f32::from(b) / (n - 1) as f32, FOOT];
    let front = stack[0];
    let head = match front {
        0 => [0.8, HEAD],
        b if usize::from(b) + 1 == n => [0.2, HEAD],
        _ => [0.5, HEAD],
    };
    let between = |a: Point, b: Point| [(a[0] + b[0]) / 2.0, (a[1] + b[1]) / 2.0];
    let joint = between(foot(front), head);
    let mut marks = vec![Mark::line([foot(front), head])];
    let in_turn = stack.windows(2).all(|w| w[0] < w[1]) || stack.windows(2).all(|w| w[0] > w[1]);
    if n == 3 && !in_turn && head[0] != 0.5 {
        // One loop passed over two that are knitted together: those meet before they reach it.
        let together = between(foot(stack[1]), joint);
        marks.push(Mark::line([foot(stack[1]), joint]));
        marks.push(Mark::line([foot(stack[2]), together]));
    } else if n > 2 {
        marks.extend(stack[1..].iter().map(|b| Mark::line([foot(*b), joint])));
    }
    if purled {
        let side = if head[0] > 0.4 { 0.24 } else { 0.76 };
        marks.push(Mark::dot([side, 0.26], 0.1));
    }
    marks
}

/// The stitch's own name, as large as there is room.
fn named(stitch: &Stitch) -> Vec<Mark> {
    let (name, wide) = (stitch.to_string(), stitch.tops().max(1) as f32);
    let height = 0.4f32.min(0.4 * (wide - 0.3) / lettering::width(&name, 0.4));
    let at = [(wide - lettering::width(&name, height)) / 2.0, 0.5 + height / 2.0];
    let mut marks = lettering::write(&name, at, height);
    let frame = rectangle([0.08, 0.08], [wide - 0.16, 0.84]);
    marks.push(Mark { points: frame.to_vec(), paint: Paint::Line(Ink::Grid, 0.04) });
    marks
}

/// The strands of a cable, one over the other, in the squares that it covers, their upper left corner at the origin.
pub fn of_crossing(crossing: &Crossing) -> Vec<Mark> {
    /// What a strand leaves free on both sides.
    const INSET: f32 = 0.1;
    let loops: usize = crossing.strands.iter().map(|n| usize::from(*n)).sum();
    let wide = crossing.columns.len() as f32;
    let square = wide / loops as f32;
    let size = |s: usize| f32::from(crossing.strands[s]) * square;
    let mut marks = vec![Mark::area(rectangle([0.0, 0.0], [wide, 1.0]), Ink::White)];
    for strand in crossing.front.iter().rev().map(|s| usize::from(*s)) {
        let left: f32 = (0..strand).map(size).sum();
        let before = crossing.order.iter().map(|s| usize::from(*s)).take_while(|s| *s != strand);
        let above: f32 = before.map(size).sum();
        let right = size(strand) - INSET;
        let sides =
            [[[left + INSET, 1.0], [above + INSET, 0.0]], [[left + right, 1.0], [above + right, 0.0]]];
        let area = [sides[0][0], sides[0][1], sides[1][1], sides[1][0]];
        marks.push(Mark::area(area, Ink::White));
        marks.extend(sides.map(Mark::line));
        if crossing.purled[strand] {
            // On the part that shows, at the side away from where the strand comes from.
            let covered = (0.2 * wide).min(0.6 * size(strand));
            let shift = if above > left { covered - INSET } else { INSET };
            let begin = above + 0.2 * (left - above) + shift;
            let n = crossing.strands[strand];
            let step = (size(strand) - covered) / f32::from(n);
            let dot = |i: u8| [begin + (f32::from(i) + 0.5) * step, 0.2];
            marks.extend((0..n).map(|i| Mark::dot(dot(i), 0.1)));
        }
    }
    marks
}
