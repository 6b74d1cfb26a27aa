//! Texts that nobody would write: they may be refused, but nothing worse.

use super::*;
use proptest::prelude::*;
use std::time::{Duration, Instant};

const TOKENS: &[&str] = &[
    "Row 1",
    "Row 2",
    "Rows 1-3",
    "Round 1",
    "(RS)",
    "(WS)",
    ":",
    ".",
    ",",
    ";",
    "*",
    "[",
    "]",
    "(",
    ")",
    "k5",
    "p",
    "k2tog",
    "yo",
    "repeat from *",
    "Repeat rows 1-2",
    "to end",
    "to last 3 sts",
    "twice",
    "3 times",
    "99999999999999999999",
    "Knit",
    "Purl",
    "3/2 RC",
    "2/1/2 LPC",
    "in next st",
    "sl 1",
    "psso",
    "BO 3 sts",
    "BO rem sts",
    "CO 2 sts",
    "w&t",
    "turn",
    "(10 sts)",
    "(multiple of 0 sts)",
    "1-to-3 inc",
    "#",
    "\n",
    "/",
    "-",
    "×",
    "“",
    "all",
    "every WS row",
    "as row 2",
    "k0",
    "and",
    "999999",
];

/// Whatever it is, it comes back; what can be worked can be written and read.
fn try_out(text: &str) {
    let Ok(pattern) = Pattern::read(text).map_err(|e| (e.to_string(), e.report("text", text))) else {
        return;
    };
    for width in [Width::AsWritten, Width::CastOn(12), Width::Repeats(2)] {
        if let Ok(worked) = pattern.work(width) {
            assert_round_trip(&worked);
        }
    }
}

fn stitches() -> impl Strategy<Value = String> {
    let name = prop::sample::select(vec![
        "k1",
        "k3",
        "p2",
        "k2tog",
        "ssk",
        "yo",
        "sl1 wyif",
        "sl 1",
        "kfb",
        "(k1, yo, k1) in next st",
        "2/2 LC",
        "3/1 RPC",
        "cdd",
        "k2 tbl",
        "M1R",
        "MB",
        "p3tog",
        "CO 2 sts",
        "BO 2 sts",
        "p2tog tbl",
        "cluster 3",
    ]);
    let item = name.prop_map(str::to_owned).prop_recursive(3, 12, 4, |inner| {
        (prop::collection::vec(inner, 1..4), 1..4usize)
            .prop_map(|(items, n)| format!("[{}] {n} times", items.join(", ")))
    });
    prop::collection::vec(item, 1..5).prop_map(|items| items.join(", "))
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(400) })]

    #[test]
    fn any_text_is_read_or_refused(text in "\\PC{0,80}") {
        try_out(&text);
    }

    #[test]
    fn any_bytes_are_read_or_refused(bytes in prop::collection::vec(any::<u8>(), 0..80)) {
        try_out(&String::from_utf8_lossy(&bytes));
    }

    #[test]
    fn any_words_are_read_or_refused(words in prop::collection::vec(prop::sample::select(TOKENS), 0..30)) {
        try_out(&words.join(" "));
        try_out(&format!("Row 1: {}", words.join(" ")));
    }

    #[test]
    fn any_rows_are_written_and_read(before in stitches(), group in stitches(), after in stitches(), second in stitches(), ws: bool) {
        let side = if ws { "WS" } else { "RS" };
        try_out(&format!("Row 1 ({side}): {before}, *{group}, repeat from *, {after}."));
        try_out(&format!("Row 1 ({side}): {before}, *{group}, repeat from *.\nRow 2: {second}, purl to end."));
        try_out(&format!("Row 1 ({side}): {before}, turn, {after}, w&t.\nRow 2: {second}, knit."));
    }
}

#[test]
fn deep_brackets_are_refused() {
    for bracket in ["[", "(", "*", "{", "[(", "3/2 RC ("] {
        let text = format!("Row 1: {}", bracket.repeat(100_000));
        assert!(Pattern::read(&text).is_err());
    }
    let nested = format!("Row 1: {}k1{}.", "[".repeat(40), "] twice".repeat(40));
    assert!(
        Pattern::read(&nested).unwrap_err().to_string().ends_with("brackets are nested more than 32 deep")
    );
    let doubled = format!("Row 1: {}k1{}.", "[".repeat(30), "] twice".repeat(30));
    assert!(Pattern::read(&doubled).unwrap().work(Width::AsWritten).is_err());
}

#[test]
fn ten_thousand_rows() {
    let rows = (1..=10_000).map(|i| {
        format!("Row {i}: K1, *yo, k2tog, [k1, p1] twice, repeat from * to last st, k1. (20 sts)\n")
    });
    let text: String = rows.collect();
    let start = Instant::now();
    let worked = as_written(&text);
    let took = start.elapsed();
    println!("10 000 rows: {took:?}");
    assert_eq!((worked.cast_on, worked.rows.len()), (14, 10_000));
    assert_eq!(worked.warnings.len(), 10_000);
    assert!(took < Duration::from_secs(5), "{took:?}");
    assert_round_trip(&worked);
}

#[test]
fn endless_texts_end() {
    let start = Instant::now();
    for text in [
        "Rows 1-99999: k.\n".repeat(2_000),
        "Row 1: k.\nRepeat row 1 99999 times.\nRepeat row 1 99999 times.".to_owned(),
        format!("Row 1: k.\n{}", "Repeat row 1.\n".repeat(50_000)),
        "Row 1: *k99999, repeat from *.\nRepeat row 1 99999 times.".to_owned(),
        format!("Row 1: {}k1.", "k1, ".repeat(200_000)),
        format!("Rows 1-9999: {}k1.", "k1, ".repeat(2_000)),
        (1..50).map(|i| format!("Row {i}: *k{}, yo, repeat from *.\n", i + 1)).collect(),
        "Row 1: k1 ".to_owned() + &"k ".repeat(100_000),
        "Row 1: sl 1, k2tog, ".to_owned() + &"- ".repeat(100_000),
    ] {
        if let Ok(pattern) = Pattern::read(&text) {
            let _ = pattern.work(Width::AsWritten);
        }
    }
    assert!(start.elapsed() < Duration::from_secs(60), "{:?}", start.elapsed());
}
