//! What is wrong, and where: the exact lines.

use super::*;

fn error(text: &str) -> String {
    match Pattern::read(text) {
        Err(error) => error.to_string(),
        Ok(pattern) => pattern.work(Width::AsWritten).unwrap_err().to_string(),
    }
}

#[test]
fn faults_of_the_text() {
    for (text, line) in [
        ("", "line 1, column 1: the text has no rows; expected 'Row 1:' or 'Round 1:'"),
        ("Feather and fan", "line 1, column 1: found 'feather', expected 'Row', 'Round' or 'Repeat'"),
        ("Row: k1.", "line 1, column 4: found ':', expected a row's number"),
        ("Row 1 k1.", "line 1, column 7, row 1: found 'k', expected ':' after the rows' numbers"),
        ("Row 1:", "line 1, column 7, row 1: found the end of the text, expected a stitch"),
        (
            "Row 1: K1.\nRow 2: k1, k2tgo, p1.",
            "line 2, column 12, row 2: found 'k2tgo', expected a stitch, a cable, '[' or '*'",
        ),
        ("Row 1: [k1, p1.", "line 1, column 15, row 1: found '.', expected a comma or ']'"),
        (
            "Row 1: [k1, p1].",
            "line 1, column 16, row 1: found '.', expected how often the group is worked, as in 'twice' or '3 times'",
        ),
        ("Row 1: *k1, p1.", "line 1, column 15, row 1: found '.', expected a comma or 'repeat from *'"),
        ("Row 1: k1) .", "line 1, column 10, row 1: found ')', expected a comma or a full stop"),
        ("Row 1: k0.", "line 1, column 8, row 1: a stitch worked 0 times is none; expected 1 or more"),
        ("Row 1: k1.\nRow 3: k1.", "line 2, column 1, row 3: row 2 is missing before this one"),
        ("Row 1: k1.\nRow 1: k1.", "line 2, column 1, row 1: the row is given twice"),
        ("Row 1: k1.\nRound 2: k1.", "line 2, column 1: found both rows and rounds, expected one of them"),
        ("Row 1: k1.\nRepeat rows 1-3 twice.", "line 2, column 1: row 2 is not in the pattern"),
        (
            "Row 1 (RS): 3/2 RC (p1, k2).",
            "line 1, column 20, row 1: expected the 2 knits and purls of the strand that lies behind",
        ),
        ("Row 3-1: k1.", "line 1, column 5: found rows 3 to 1, expected rising numbers below 100000"),
    ] {
        assert_eq!(error(text), line, "{text}");
    }
}

#[test]
fn rows_that_do_not_fit() {
    let misfit = |text: &str, n| Pattern::read(text).unwrap().work(Width::CastOn(n)).unwrap_err().to_string();
    let text = "# lace\nRow 1: Knit.\nRow 2: Purl.\nRow 3: K1, *yo, k2tog, k4, repeat from *.";
    assert_eq!(
        misfit(text, 16),
        "line 4, column 1, row 3: the row works 19 stitches, but there are 16; its repeat needs a multiple of 6 plus 1"
    );
    assert_eq!(
        misfit("Row 1: K5, p2.", 8),
        "line 1, column 1, row 1: the row works 7 stitches, but there are 8"
    );
    assert_eq!(
        misfit("Row 1: K3, purl to last 3 sts, k3.", 5),
        "line 1, column 1, row 1: the row works 6 stitches, but there are 5; it needs 6 or more"
    );
    assert_eq!(
        error("Row 1: *K2, repeat from *.\nRow 2: *P4, repeat from *, p1."),
        "line 2, column 1, row 2: there are a multiple of 2 plus 0 stitches, but this row needs a multiple of 4 plus 1"
    );
    assert_eq!(
        error("Row 1: K5.\nRow 2: P4."),
        "line 2, column 1, row 2: there are 5 stitches, but this row works 4"
    );
}

#[test]
fn groups_that_cannot_be_worked() {
    for (text, line) in [
        (
            "Row 1: *k1, repeat from *, *p1, repeat from *.",
            "line 1, column 28, row 1: a second open group in the row: nothing says where the first one ends",
        ),
        (
            "Row 1: *k1, repeat from * to last 3 sts, k2.",
            "line 1, column 8, row 1: the row goes on to the last stitches, but what follows leaves 1 of them",
        ),
        (
            "Row 1: *k1, repeat from * to last 3 sts, k4.",
            "line 1, column 42, row 1: the stitches before leave 3, but this works 4",
        ),
        (
            "Row 1: *yo, repeat from *.",
            "line 1, column 8, row 1: the group works no stitches, so it would never end",
        ),
        (
            "Row 1: [k1, knit] twice.",
            "line 1, column 13, row 1: what goes on as long as there is room cannot stand inside another group",
        ),
        (
            "Row 1: BO all twice.",
            "line 1, column 8, row 1: all stitches can be bound off only once, and to the end",
        ),
        (
            "Row 1: k1, turn twice, k1.",
            "line 1, column 12, row 1: the work can be turned only once in one place",
        ),
        ("Row 1: [k99999] 99 times.", "line 1, column 8, row 1: the row has more than 100000 stitches"),
    ] {
        assert_eq!(error(text), line, "{text}");
    }
}

#[test]
fn a_report_shows_the_place() {
    let text = "Row 1: Knit.\nRow 2: p3, q2, p1.\n";
    let report = Pattern::read(text).unwrap_err().report("lace.ks", text);
    assert!(report.contains("Row 2: p3, q2, p1."), "{report}");
    assert!(report.contains("lace.ks:2:12"), "{report}");
    assert!(!report.contains('\u{1b}'), "{report}");
}
