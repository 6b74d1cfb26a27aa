//! Each form of the language.

use super::*;

#[test]
fn runs_and_single_stitches() {
    assert_eq!(row("K2, p1, k"), "k k p k");
    assert_eq!(row("k1 tbl, p1 tbl, k2 tbl"), "k1 p1 k1 k1");
    assert_eq!(row("yo, k1, [yo] 2 times, k1, yo x2, k1, yo twice"), "d0y k d0y d0y k d0y d0y k d0y d0y");
    assert_eq!(
        row("M1, k1, M1L, k1, M1R, k1, m1p, k1, M1Lp, k1, M1Rp"),
        "d0y1 k d0y1 k d0y-1 k d0y1 k d0y1 k d0y-1"
    );
    assert_eq!(row("inc L, k1, inc R, k1, LLI, k1, RLI"), "d0y1 k d0y-1 k d0y1 k d0y-1");
    assert_eq!(row("sl1 wyib, sl2 wyib, sl 1"), "s s s s");
    assert_eq!(row("sl1 wyif, sl2 wyif"), "<sl1 wyif> <sl1 wyif> <sl1 wyif>");
    assert_eq!(
        row("MB, k1 below, k1-b, p1 below, cluster 3"),
        "<MB> <k1 below> <k1 below> <p1 below> <cluster 3>"
    );
    assert_eq!(
        row("k1 wrapping yarn twice, p2 wrapping yarn 3 times, k1"),
        "<k1 wrapping yarn 2 times> <p1 wrapping yarn 3 times> <p1 wrapping yarn 3 times> k"
    );
}

#[test]
fn decreases_stack_as_they_are_worked() {
    assert_eq!(row("k2tog, k3tog, k9tog"), "d12k d123k d123456789k");
    assert_eq!(row("p2tog, p3tog, p4tog"), "d12p d123p d1234p");
    assert_eq!(row("k2tog tbl, p2tog tbl, k3tog-tbl"), "d21k d21p d321k");
    assert_eq!(row("ssk, skp, SKPO, sl1-k1-psso, sl 1, k1, psso"), "d21k d21k d21k d21k d21k");
    assert_eq!(row("sssk, ssp, sssp"), "d321k d21p d321p");
    assert_eq!(row("sk2p, sl1-k2tog-psso, sl 1, k2 tog, psso"), "d312k d312k d312k");
    assert_eq!(row("cdd, s2kp, sl2-k1-p2sso, cddp"), "d231k d231k d231k d312p");
}

#[test]
fn increases_stand_right_to_left() {
    assert_eq!(row("kfb, pfb, ctr dbl inc"), "pk kp ky1k");
    assert_eq!(row("(k1, p1) in next st, (k1, p1, k1) in next st, (k1, yo, k1) in next st"), "pk kpk kyk");
    assert_eq!(row("(k1, yo, p1) into next stitch, (k1, k1 tbl) in next st"), "pyk k1k");
    assert_eq!(row("1-to-3 inc, 1-to-4 inc, 1-to-3 inc p"), "kpk pkpk pkp");
    assert_eq!(row("(k1, p1, k1, p1, k1) in next st"), "kpkpk");
    assert_eq!(row("(k1, p1, k1) in next st twice"), "kpk kpk");
}

#[test]
fn groups() {
    assert_eq!(row("[k1, p1] twice, [k2tog] once, [yo, k1] 3 times"), "k p k p d12k d0y k d0y k d0y k");
    assert_eq!(row("[k1, [p1, [yo, k1] twice] twice] twice"), ["k p d0y k d0y k p d0y k d0y k"; 2].join(" "));
    assert_eq!(
        steps(&worked("Row 1 (RS): K1, *yo, k2tog, repeat from * to last st, k1. (6 sts)", 6), 0),
        "k d0y d12k d0y d12k k"
    );
    assert_eq!(steps(&worked("Row 1: *P1, k1, repeat from * to end.", 4), 0), "p k p k");
    assert_eq!(steps(&worked("Row 1: *P1, k1, repeat from * to last 2 sts, k2tog.", 6), 0), "p k p k d12k");
    let repeats = &worked("Row 1: K1, *p1, [k1] twice, repeat from *, k1.", 8).rows[0].repeats;
    assert_eq!(repeats[..], [1..4, 4..7]);
}

#[test]
fn to_the_end() {
    assert_eq!(steps(&worked("Row 1: Knit.", 3), 0), "k k k");
    assert_eq!(steps(&worked("Row 1: Purl tbl.", 3), 0), "p1 p1 p1");
    assert_eq!(steps(&worked("Row 1: Knit to last 3 sts, k2tog, k1.", 5), 0), "k k d12k k");
    assert_eq!(steps(&worked("Row 1: K2, purl to last 2 sts, k2.", 5), 0), "k k p k k");
    assert_eq!(steps(&worked("Row 1: K2, purl to last 2 sts, k2.", 4), 0), "k k k k");
    assert_eq!(
        steps(&worked("Row 1: K1, *p1, k1, repeat from * to last 4 sts, p2, knit to end.", 9), 0),
        "k p k p k p p k k"
    );
    for text in ["k", "k tbl", "k below", "k wrapping yarn twice"] {
        assert_eq!(worked(&format!("Row 1: {text}."), 3).rows[0].steps.len(), 3, "{text}");
    }
}

#[test]
fn binding_off_and_casting_on_in_a_row() {
    let bound = worked("Row 1 (RS): BO 3 sts, knit to end.\nRow 2: BO 2 sts, purl.", 10);
    assert_eq!(steps(&bound, 0), "BO3 k k k k k k k");
    assert_eq!(steps(&bound, 1), "BO2 p k k k k");
    assert_eq!(loops(&bound), [7, 5]);
    let middle = worked("Row 1: K4, BO 2 sts, k3.\nRow 2: P4, CO 2 sts, p4. (10 sts)", 10);
    assert_eq!(loops(&middle), [8, 10]);
    assert_eq!(middle.warnings, []);
    assert_eq!(steps(&worked("Row 1: CO 5 sts, knit to end.", 2), 0), "CO5 k k");
    assert_eq!(steps(&worked("Row 1: K2, BO rem sts.", 5), 0), "k k BO3");
    assert_eq!(steps(&worked("Row 1: BO all.", 5), 0), "BO5");
    assert_eq!(steps(&worked("Row 1: Knit to last 3 sts, BO 3 sts.", 5), 0), "k k BO3");
    assert_eq!(steps(&worked("Row 1: k2 bo 1 st co 1 st, k1.", 5), 0), "k k BO1 k CO1 k");
    for w in [bound, middle] {
        assert_round_trip(&w);
    }
    for text in ["K2, BO rem sts", "Knit to last 3 sts, BO 3 sts", "BO 2 sts, k1, BO 1 st, knit to end"] {
        assert_round_trip(&worked(&format!("Row 1: {text}."), 9));
    }
}

#[test]
fn short_rows_leave_stitches() {
    let text = "Row 1 (RS): K6, w&t.\nRow 2: P4, w&t.\nRow 3: Knit.\nRow 4: Purl.";
    let short = worked(text, 8);
    assert_eq!(steps(&short, 0), "k k k k k k w&t");
    assert_eq!(steps(&short, 1), "k k k k w&t");
    assert_eq!(short.rows.iter().map(|r| r.steps.len()).collect::<Vec<_>>(), [7, 5, 6, 8]);
    assert_eq!(loops(&short), [8; 4]);
    assert_round_trip(&short);
    let inside = worked(
        "Row 1: K3, turn, p2, turn, knit.\nRow 2: Knit to last 2 sts, turn.\nRow 3: Purl.\nRow 4: Knit.",
        5,
    );
    assert_eq!(steps(&inside, 0), "k k k turn k k turn k k k k");
    assert_eq!(steps(&inside, 1), "p p p turn");
    assert_round_trip(&inside);
}

#[test]
fn numbers_of_rows() {
    let text = "Rows 1, 3, and 5 (RS): Knit.\nRows 2 and 4: Purl.\nRows 6-8: K1, purl to end.";
    let numbers = as_written(text).rows.iter().map(|r| r.number).collect::<Vec<_>>();
    assert_eq!(numbers, (1..=8).collect::<Vec<_>>());
    let even = as_written("Rounds 1-7 (odd): Knit.\nRounds 2-8 (even): Purl.");
    assert!(even.in_the_round);
    assert_eq!(
        (0..8)
            .map(|i| even.rows[i].steps[0].what.clone() == Work::Stitch("k".parse().unwrap()))
            .collect::<Vec<_>>(),
        [true, false, true, false, true, false, true, false]
    );
}

#[test]
fn repeated_rows() {
    let rows = |text: &str| as_written(text).rows.iter().map(|r| r.number).collect::<Vec<_>>();
    let two = "Row 1: Knit.\nRow 2: Purl.\n";
    assert_eq!(rows(&format!("{two}Repeat rows 1-2.\nRow 3: Knit.")), [1, 2, 1, 2, 3]);
    assert_eq!(rows(&format!("{two}Repeat rows 1 and 2 twice.\nRow 3: Knit.")), [1, 2, 1, 2, 1, 2, 3]);
    assert_eq!(rows(&format!("{two}Repeat rows 1-2 3 times.")), [1, 2, 1, 2, 1, 2, 1, 2]);
    assert_eq!(rows(&format!("{two}Repeat rows 1-2 for pattern.")), [1, 2]);
    assert_eq!(rows(&format!("{two}Repeat rows 1-2 until the piece measures 10 in.")), [1, 2]);
    assert_eq!(rows(&format!("{two}Rep these 2 rows.")), [1, 2]);
    assert_eq!(rows(&format!("{two}Rep the last 2 rows once more.")), [1, 2, 1, 2]);
    assert_eq!(rows(&format!("{two}Rows 3-6: Repeat rows 1-2.")), [1, 2, 3, 4, 5, 6]);
    assert_eq!(rows(&format!("{two}Row 3: As row 1.")), [1, 2, 3]);
    assert_eq!(rows(&format!("{two}Rows 1-2.").replace("Rows 1-2.", "")), [1, 2]);
    let odd = as_written("Row 1 (RS): Knit.\nRow 2: Purl.\nRow 3: Knit.\nRepeat rows 1-3 once.");
    assert_eq!(odd.rows[3].side, super::super::Side::Wrong, "sides alternate whatever the number");
    assert_round_trip(&odd);
}

#[test]
fn counts_are_checked() {
    let warnings =
        |text: &str, n| worked(text, n).warnings.iter().map(ToString::to_string).collect::<Vec<_>>();
    assert!(warnings("Row 1: Knit. (10 sts)", 10).is_empty());
    assert_eq!(
        warnings("Row 1: Knit. (10 sts)", 9),
        ["line 1, column 14: row 1: the text says 10 stitches, but there are 9"]
    );
    assert!(warnings("Row 1: *K1, p1, repeat from *, k1 (multiple of 2 sts, plus 1).", 9).is_empty());
    assert_eq!(
        warnings("Row 1: Knit (multiple of 8 sts, plus 1).", 10),
        ["line 1, column 13: row 1: the text says a multiple of 8 stitches plus 1, but there are 10"]
    );
    assert_eq!(
        warnings("# check: cast on 4, rows 2, most stitches 5\nRow 1: Knit.", 4),
        [
            "line 1, column 1: the check line says most stitches 5, but there are 4",
            "line 1, column 1: the check line says rows 2, but there are 1"
        ]
    );
    let unread = &warnings("# Bananas\n# check: cast on 4, rows 1\nRow 1: Knit.", 4)[..];
    assert!(
        unread.len() == 1 && unread[0].starts_with("line 2, column 1: figures that nothing"),
        "{unread:?}"
    );
    assert_eq!(
        warnings("Row 1 (RS): Knit.\nRow 2 (RS): Knit.", 4),
        ["line 2, column 1: row 2 is said to be on the other side than row 1 makes it"]
    );
}
