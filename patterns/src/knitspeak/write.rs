//! Writes rows back as KnitSpeak.
//!
//! Read again and worked with as many stitches, the text gives the same steps. What a repeated group says is written once, as
//! the open group of its row or with a number of times, where that is shorter; rows that say the same share a sentence.

use super::syntax::Side;
use super::term::Work;
use super::vocabulary::name_of;
use super::{Worked, WorkedRow};
use stitch_mesh::stitch::{Make, Op, Stitch};

/// The text of a pattern. Stitches that no knitter has a name for stand in it as their symbols, which cannot be read again;
/// reading never makes any.
pub fn write(worked: &Worked) -> String {
    let (cast_on, rows, most) = (worked.cast_on, worked.rows.len(), worked.most_stitches());
    let mut text = format!("# check: cast on {cast_on}, rows {rows}, most stitches {most}\n");
    let first = worked.rows.first().map_or(1, |row| row.number);
    let mut before = cast_on;
    let mut sentences: Vec<(String, Vec<usize>)> = Vec::new();
    let mut places = std::collections::HashMap::new();
    for (number, row) in (first..).zip(&worked.rows) {
        let mut said = sentence(row);
        if row.loops != before {
            said += &format!(" ({} sts)", row.loops);
        }
        before = row.loops;
        let place = *places.entry(said.clone()).or_insert(sentences.len());
        if place == sentences.len() {
            sentences.push((said, Vec::new()));
        }
        sentences[place].1.push(number);
    }
    let name = if worked.in_the_round { "Round" } else { "Row" };
    for (i, (said, numbers)) in sentences.iter().enumerate() {
        let plural = if numbers.len() > 1 { "s" } else { "" };
        let side = match worked.rows.first().map(|row| row.side) {
            Some(Side::Right) if i == 0 && !worked.in_the_round => " (RS)",
            Some(Side::Wrong) if i == 0 && !worked.in_the_round => " (WS)",
            _ => "",
        };
        text += &format!("{name}{plural} {}{side}: {said}\n", list(numbers));
    }
    text
}

/// `2`, `1 and 3`, `2, 4, and 6`, `1-4 and 7`.
fn list(numbers: &[usize]) -> String {
    let runs: Vec<String> = numbers
        .chunk_by(|a, b| a + 1 == *b)
        .flat_map(|run| match run {
            [first, .., last] if run.len() > 2 => vec![format!("{first}-{last}")],
            few => few.iter().map(usize::to_string).collect(),
        })
        .collect();
    match &runs[..] {
        [] => String::new(),
        [one] => one.clone(),
        [one, two] => format!("{one} and {two}"),
        [most @ .., last] => format!("{}, and {last}", most.join(", ")),
    }
}

/// What is worked in a row, up to the full stop.
fn sentence(row: &WorkedRow) -> String {
    let names = names(row);
    let all = |name: &str| names.iter().all(|n| n == name);
    let mut text = match row.repeats.first().zip(row.repeats.last()) {
        _ if all("k") => "knit".to_owned(),
        _ if all("p") => "purl".to_owned(),
        // After a turn the needle holds more than the steps show.
        Some((first, last)) if !row.steps.iter().any(|s| matches!(s.what, Work::Turn { .. })) => {
            let after: usize = row.steps[last.end..].iter().map(|s| s.what.uses()).sum();
            let ends = names.len() > last.end;
            let parts = [
                (first.start > 0).then(|| folded(&names[..first.start])),
                Some(format!("*{}", folded(&names[first.clone()]))),
                Some(if after > 0 {
                    format!("repeat from * to last {}", sts(after))
                } else {
                    "repeat from *".to_owned()
                }),
                ends.then(|| folded(&names[last.end..])),
            ];
            parts.into_iter().flatten().collect::<Vec<_>>().join(", ")
        }
        _ => folded(&names),
    };
    if let Some(i) =
        text.find(|c: char| c.is_ascii_alphabetic()).filter(|i| text[..*i].chars().all(|c| "*[(".contains(c)))
    {
        text[i..=i].make_ascii_uppercase();
    }
    text + "."
}

fn sts(n: usize) -> String {
    if n == 1 { "st".to_owned() } else { format!("{n} sts") }
}

/// A name for each step; one that says what the step before it has said already is empty.
fn names(row: &WorkedRow) -> Vec<String> {
    let mut side = row.side;
    let mut names: Vec<String> = Vec::with_capacity(row.steps.len());
    let mut steps = row.steps.iter().peekable();
    while let Some(step) = steps.next() {
        let name = match step.what.facing(side) {
            Work::Stitch(stitch) => stitch_name(&stitch, side).unwrap_or_else(|| stitch.to_string()),
            Work::Cross(crossing) => crossing.name(name_of).unwrap_or_else(|| "a cable".to_owned()),
            Work::CastOn(n) => format!("CO {}", counted(n)),
            Work::Turn { wrapped } => {
                side = side.other();
                if wrapped { "w&t" } else { "turn" }.to_owned()
            }
            Work::Special { name, .. } => name,
            Work::BindOff(n) => match steps.peek() {
                Some(next) if next.what.facing(side) == Work::Stitch(Stitch::knit()) => {
                    // The stitch that is left of them.
                    steps.next();
                    names.push(format!("BO {}", counted(n)));
                    String::new()
                }
                _ => "BO rem sts".to_owned(),
            },
        };
        names.push(name);
    }
    names
}

fn counted(n: usize) -> String {
    if n == 1 { "1 st".to_owned() } else { format!("{n} sts") }
}

/// Whether a knitter can be told to work something with this side facing.
pub(crate) fn has_name(work: &Work, side: Side) -> bool {
    match work.facing(side) {
        Work::Stitch(stitch) => stitch_name(&stitch, side).is_some(),
        Work::Cross(crossing) => crossing.name(name_of).is_some(),
        _ => true,
    }
}

fn stitch_name(stitch: &Stitch, side: Side) -> Option<String> {
    if let Some(name) = name_of(stitch) {
        return Some(name);
    }
    match &stitch.ops[..] {
        [Op { make: Make::Slip, twist: 0 }] => {
            Some(if side == Side::Right { "sl1 wyib" } else { "sl1 wyif" }.to_owned())
        }
        ops if stitch.bottoms() == 1 && ops.len() > 1 => {
            let single =
                |op: &Op| name_of(&Stitch { ops: [*op].into_iter().collect(), stack: stitch.stack.clone() });
            let yarn_over = |op: &Op| (op.make == Make::YarnOver && op.twist == 0).then(|| "yo".to_owned());
            let worked: Option<Vec<_>> =
                ops.iter().rev().map(|op| yarn_over(op).or_else(|| single(op))).collect();
            let numbered = |name: String| if name.len() == 1 { name + "1" } else { name };
            let list = |names: Vec<String>| names.into_iter().map(numbered).collect::<Vec<_>>().join(", ");
            worked.map(|names| format!("({}) in next st", list(names)))
        }
        _ => None,
    }
}

/// Names with runs counted, and what repeats in brackets where that is shorter.
fn folded(names: &[String]) -> String {
    let items = runs(names);
    let mut text: Vec<String> = Vec::new();
    let mut i = 0;
    while i < items.len() {
        let best = (1..=LONGEST_GROUP.min((items.len() - i) / 2))
            .map(|period| (period, repeats(&items[i..], period)))
            .filter(|(_, times)| *times > 1)
            .map(|(period, times)| {
                let group = format!("[{}] {}", items[i..i + period].join(", "), how_often(times));
                let plain: usize = items[i..i + period * times].iter().map(|s| s.len() + 2).sum();
                (plain.saturating_sub(group.len() + 2), period * times, group)
            })
            .max_by_key(|(saved, ..)| *saved);
        match best {
            Some((1.., length, group)) => {
                text.push(group);
                i += length;
            }
            _ => {
                text.push(items[i].clone());
                i += 1;
            }
        }
    }
    text.join(", ")
}

/// Items of a group that is looked for; longer ones are hard to follow anyway.
const LONGEST_GROUP: usize = 16;

fn how_often(times: usize) -> String {
    if times == 2 { "twice".to_owned() } else { format!("{times} times") }
}

/// How often the first `period` items stand there one after the other.
fn repeats(items: &[String], period: usize) -> usize {
    let (first, rest) = items.split_at(period);
    1 + rest.chunks_exact(period).take_while(|chunk| *chunk == first).count()
}

/// Equal names counted: k5, k3 tbl, sl2 wyib. Others, which have no number, stay as they are.
fn runs(names: &[String]) -> Vec<String> {
    let mut items = Vec::new();
    for run in names.chunk_by(|a, b| a == b).filter(|run| !run[0].is_empty()) {
        let (name, n) = (&run[0], run.len());
        match name.split_once('1') {
            _ if matches!(name.as_str(), "k" | "p") => items.push(format!("{name}{n}")),
            Some((what @ ("k" | "p" | "sl"), how)) if how.starts_with(" tbl") || how.starts_with(" wy") => {
                items.push(format!("{what}{n}{how}"));
            }
            _ => items.extend(run.iter().cloned()),
        }
    }
    items
}
