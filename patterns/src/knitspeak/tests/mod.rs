//! Patterns read, worked and written.

mod errors;
mod language;
mod others;
mod random;
mod shared;
mod sides;
mod widths;

use super::{Pattern, Width, Work, Worked, write};

/// Works a text with so many stitches.
fn worked(text: &str, cast_on: usize) -> Worked {
    let pattern = Pattern::read(text).unwrap_or_else(|e| panic!("{text}\n{e}"));
    pattern.work(Width::CastOn(cast_on)).unwrap_or_else(|e| panic!("{text}\n{e}"))
}

/// Works a text as it is written.
fn as_written(text: &str) -> Worked {
    let pattern = Pattern::read(text).unwrap_or_else(|e| panic!("{text}\n{e}"));
    pattern.work(Width::AsWritten).unwrap_or_else(|e| panic!("{text}\n{e}"))
}

/// What is worked in a row, in short: symbols for stitches, in the order of working.
fn steps(worked: &Worked, row: usize) -> String {
    let short = |work: &Work| match work {
        Work::Stitch(stitch) => stitch.to_string(),
        Work::Cross(c) => {
            let stitches: Vec<_> = c.stitches.iter().map(ToString::to_string).collect();
            format!("{:?}{:?}{:?}{}", c.strands, c.order, c.front, stitches.concat())
        }
        Work::BindOff(n) => format!("BO{n}"),
        Work::CastOn(n) => format!("CO{n}"),
        Work::Turn { wrapped } => if *wrapped { "w&t" } else { "turn" }.to_owned(),
        Work::Special { name, .. } => format!("<{name}>"),
    };
    worked.rows[row].steps.iter().map(|s| short(&s.what)).collect::<Vec<_>>().join(" ")
}

/// Loops after each row.
fn loops(worked: &Worked) -> Vec<usize> {
    worked.rows.iter().map(|row| row.loops).collect()
}

/// Steps of the one row of a text, worked on the right side with just enough stitches.
fn row(items: &str) -> String {
    steps(&as_written(&format!("Row 1 (RS): {items}.")), 0)
}

/// The same on the wrong side.
fn wrong_row(items: &str) -> String {
    steps(&as_written(&format!("Row 1 (WS): {items}.")), 0)
}

/// Checks that what is written reads as the same steps.
fn assert_round_trip(worked: &Worked) {
    let text = write(worked);
    let pattern = Pattern::read(&text).unwrap_or_else(|e| panic!("{text}\n{e}"));
    let again = pattern.work(Width::CastOn(worked.cast_on)).unwrap_or_else(|e| panic!("{text}\n{e}"));
    let what = |w: &Worked| -> Vec<Vec<Work>> {
        w.rows.iter().map(|row| row.steps.iter().map(|s| s.what.clone()).collect()).collect()
    };
    assert_eq!(what(worked), what(&again), "{text}");
    let sides = |w: &Worked| -> Vec<_> { w.rows.iter().map(|row| (row.side, row.loops)).collect() };
    assert_eq!(sides(worked), sides(&again), "{text}");
}
