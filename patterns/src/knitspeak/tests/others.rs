//! What other writers write, and texts as they are published.

use super::*;

#[test]
fn other_words_for_the_same() {
    let same = [
        ("*k1, p1, rep from *", "*K1, p1, repeat from *"),
        ("*k1, p1; rep from * to end", "*K1, p1, repeat from *"),
        ("*k1, p1* repeat to end", "*K1, p1, repeat from *"),
        ("*k1, p1, repeat from * to the end of the row", "*K1, p1, repeat from *"),
        ("K 1, P 1 to end", "*K1, p1, repeat from *"),
        ("K2, P4 to end", "*K2, p4, repeat from *"),
        ("k1, p2, yo, k2tog to last 3 sts, k3", "k1, p2, yo, k2tog, k2tog, k2tog, k3"),
        ("[k1, p1] to end", "*K1, p1, repeat from *"),
        ("(k1, p1) rep to end", "*K1, p1, repeat from *"),
        ("(k1, p1) 6 times", "[k1, p1] 6 times"),
        ("[k1, p1] × 6", "[k1, p1] 6 times"),
        ("*k1, p1, rep from * 5 more times", "[k1, p1] 6 times"),
        ("*k1, p1, rep from * to last 2 sts, end k1, p1", "[k1, p1] 6 times"),
        ("*k1, p1, rep from * until 2 sts remain, k1, p1", "[k1, p1] 6 times"),
        ("[k1, p1] across to last 2 sts, k2", "[k1, p1] 5 times, k2"),
        ("Knit across", "Knit"),
        ("K all sts", "Knit"),
        ("K to end of row", "Knit"),
        ("K2tog twice, k8, yfwd, yrn", "k2tog, k2tog, k8, yo, yo"),
        ("C4B, C4F, k4", "2/2 RC, 2/2 LC, k4"),
        ("C6F, C6B", "3/3 LC, 3/3 RC"),
        ("T3B, T3F, T4B, k2", "2/1 RPC, 2/1 LPC, 2/2 RPC, k2"),
        ("k2 tog, k10", "k2tog, k10"),
        ("SKPO, k10", "ssk, k10"),
        ("sl 1, k2tog, psso, k9", "sk2p, k9"),
        ("“k2”, k10", "k12"),
        ("(k1, p1) in each of next 3 sts, k9", "[(k1, p1) in next st] 3 times, k9"),
        ("BO 3 sts, k1, p1 to end", "BO 3 sts, k1, purl"),
        ("BO loosely", "BO all sts"),
        ("slip 1 purlwise with yarn in back, k11", "sl1 wyib, k11"),
    ];
    for (theirs, ours) in same {
        let row = |items| steps(&worked(&format!("Row 1 (RS): {items}."), 12), 0);
        assert_eq!(row(theirs), row(ours), "{theirs}");
    }
}

#[test]
fn other_words_for_rows() {
    let ours = as_written("Row 1 (RS): *K1, p1, repeat from *.\nRow 2: Purl.\nRow 3: Knit.\nRow 4: Purl.");
    for theirs in [
        "Row 1 (RS): *K1, p1, rep from *.\nRow 3: Knit.\nAll WS rows: Purl.",
        "Row 1: *K1, p1, rep from *.\nRow 2 (WS) and all even rows: Purl.\nRow 3: K across row.",
        "Row 1: K1, p1, rep to end.\nRow 2 and every other row: (WS) Purl.\nRow 3: Knit all 4 sts.",
        "Row 1 RS: *K1, p1, rep from *.\nEvery WS row: purl.\nRow 3: Knit.",
        "ROW 1 (RIGHT SIDE): *K1, p1, rep from *\nRow 2 and all even rows: Purl\nRow 3: Knit",
        "Row 1: *K1, p1, rep from *.\nRow 2 and every following WS row: P.\nRow 3: K.",
        "Row 1 (RS): *K1, p1, rep from *.\nRows 2–4 even: Purl.\nRow 3: Knit.",
        "Row 1 (RS) (4 sts): *K1, p1, rep from *. (4 sts)\nRows 2 & 4 (WS): Purl.\nRow 3: Knit. — 4 sts",
        "# by\r hand\r\nRow 1: *K1, p1, rep from *.\r\nRow 2: Purl.\r\nRow 3: Knit.\r\nRow 4: Purl.\r\n",
        "Row 1: *K1, p1, rep from *. Row 2: Purl. Row 3: Knit. Row 4: Purl.",
        "Cast on 4 sts.\nRow 1: *K1, p1, rep from *.\nRows 2 and 4 (WS): Purl.\nRow 3: Knit.",
        "CO a multiple of 2 sts.\n\n# a note\nRow 1: *K1, p1, rep from *.\nRow 2: Purl.\nRow 3: Knit. # garter?\nRow 4: Repeat row 2.",
    ] {
        let theirs = worked(theirs, 4);
        assert_eq!(theirs.warnings, []);
        for row in 0..4 {
            assert_eq!(steps(&theirs, row), steps(&ours, row));
        }
    }
}

#[test]
fn a_cabled_stocking() {
    let text = "Rounds 1-3 and 8-10: P2, *p1, k2 tbl, p1, repeat from * to last 2 sts, p2.
        Round 4: P2, *p1, 1/1 RT, p1, repeat from * to last 2 sts, p2.
        Round 5: P2, *1/1 RPT, 1/1 LPT, repeat from * to last 2 sts, p2.
        Round 6: P2, k1 tbl, p1, *p1, 1/1 LT, p1, repeat from * to last 4 sts, p1, k1 tbl, p2.
        Round 7: P2, *1/1 LPT, 1/1 RPT, repeat from * to last 2 sts, p2.
        Repeat rounds 4-7.";
    let worked = as_written(text);
    assert_eq!((worked.cast_on, worked.rows.len()), (16, 10));
    assert_round_trip(&worked);
}

#[test]
fn a_leaf_that_grows_and_shrinks() {
    let text = "Row 1 (WS): *K5, p1, repeat from * to last 5 sts, k5.
        Row 2 (RS): *P5, [yo, k1] once, yo, repeat from * to last 5 sts, p5. (multiple of 8 sts, plus 5)
        Row 3: K5, *p3, k5, repeat from *.
        Row 4: *P5, [k1, [yo] 1 time] twice, k1, repeat from * to last 5 sts, p5.
        Rows 5 and 7: K5, *p5, k5, repeat from *.
        Row 6: *P5, ssk, k1, k2tog, repeat from * to last 5 sts, p5 (multiple of 8 sts, plus 5).
        Row 8: *P5, sk2p, repeat from * to last 5 sts, p5. (17 sts)";
    // Row 7 finds three stitches where it wants five.
    let error = Pattern::read(text).unwrap().work(Width::CastOn(17)).unwrap_err();
    assert_eq!(error.row, Some(7));
    let text =
        text.replace("Rows 5 and 7", "Row 5").replace("Row 8", "Row 7: K5, *p3, k5, repeat from *.\nRow 8");
    let leaf = as_written(&text);
    assert_eq!(leaf.warnings, []);
    assert_eq!((leaf.cast_on, loops(&leaf)), (17, vec![17, 21, 21, 25, 25, 21, 21, 17]));
    assert_round_trip(&leaf);
}

#[test]
fn the_last_stitches_bound_off() {
    let edge = worked("Row 1: K8.\nRow 2: P4, BO 4 sts.\nRow 3: BO 4 sts.\nRow 4: Knit.", 8);
    assert_eq!((steps(&edge, 1), loops(&edge)), ("k k k k BO4".to_owned(), vec![8, 4, 0, 0]));
    assert_eq!(as_written("Row 1: K8.\nRow 2: P4, BO 4 sts.\nRow 3: BO.").cast_on, 8);
    assert_round_trip(&edge);
}

#[test]
fn all_rows_of_a_side() {
    let numbers = |text: &str| as_written(text).rows.len();
    assert_eq!(numbers("Row 1 (RS): Knit.\nRow 3: Knit.\nAll WS rows: Purl."), 4);
    assert_eq!(numbers("Rows 1 and all WS rows: Purl.\nRow 2 (RS): Knit.\nRow 4: Knit."), 4);
    assert_eq!(numbers("Row 1 (WS) and all WS rows: Purl.\nRow 2: Knit."), 2);
}

#[test]
fn a_shaped_neck() {
    let text = "Row 1 (RS): BO 4 sts, k5, [k2tog, [yo, [k1, p1] twice] twice] 2 times, k to end.
        Row 2: BO 4 sts, purl to end.
        Row 3: K3, 2/2 LPC, CO 3 sts, 2/1/2 RPC, knit to last 5 sts, ssk, k3.
        Row 4: Purl to last 3 sts, BO 3 sts.";
    let neck = worked(text, 40);
    assert_eq!(loops(&neck), [38, 34, 36, 33]);
    assert_round_trip(&neck);
}
