//! The wrong side, and cables, as they are seen from the front.

use super::*;

#[test]
fn wrong_side_rows_are_turned_over() {
    assert_eq!(wrong_row("K2, p1"), "p p k");
    assert_eq!(wrong_row("p2tog, ssp, k2tog, ssk"), "d12k d21k d12p d21p");
    assert_eq!(wrong_row("p2tog tbl, p3tog, sssp, k3tog, sssk"), "d21k d123k d321k d123p d321p");
    assert_eq!(wrong_row("cddp, cdd, sk2p"), "d231k d312p d231p");
    assert_eq!(wrong_row("yo, k1, M1L, k1, M1R"), "d0y p d0y1 p d0y-1");
    assert_eq!(wrong_row("k1 tbl, p1 tbl"), "p1 k1");
    assert_eq!(wrong_row("kfb, (k1, p1) in next st, (p1, yo, k1) in next st"), "pk pk kyp");
    assert_eq!(wrong_row("(k1, p1, k1) in next st, (p1, yo, p1) in next st"), "pkp kyk");
    assert_eq!(wrong_row("sl1 wyif, sl 1, sl1 wyib"), "s s <sl1 wyib>");
}

#[test]
fn rounds_are_all_right_side() {
    let round = worked("Round 1: Knit.\nRound 2: *K2tog, yo, repeat from *.", 4);
    assert_eq!((steps(&round, 0), steps(&round, 1)), ("k k k k".to_owned(), "d12k d0y d12k d0y".to_owned()));
}

#[test]
fn sides_follow_from_the_first_that_is_named() {
    let sides = |text: &str| {
        as_written(text).rows.iter().map(|r| r.side == crate::knitspeak::Side::Right).collect::<Vec<_>>()
    };
    assert_eq!(sides("Row 1: Knit.\nRow 2: Knit."), [true, false]);
    assert_eq!(sides("Rows 1 and 3 (WS): Knit.\nRow 2: Knit."), [false, true, false]);
    assert_eq!(sides("Row 2 (RS): Knit.\nRow 1: Knit."), [false, true]);
    assert_eq!(sides("Rnd 1: Knit.\nRnd 2: Knit."), [true, true]);
}

#[test]
fn cables_cross_as_named() {
    // Strands below, order above, front to back, stitches above: all from left to right.
    assert_eq!(row("2/2 LC"), "[2, 2][1, 0][1, 0]kkkk");
    assert_eq!(row("3/2 RC"), "[3, 2][1, 0][0, 1]kkkkk");
    assert_eq!(row("3/2 LC"), "[2, 3][1, 0][1, 0]kkkkk");
    assert_eq!(row("3/2 RPC"), "[3, 2][1, 0][0, 1]ppkkk");
    assert_eq!(row("3/2 LPC"), "[2, 3][1, 0][1, 0]kkkpp");
    assert_eq!(row("3/2 RC (p1, k1)"), "[3, 2][1, 0][0, 1]kpkkk");
    assert_eq!(row("3/2 LC (k1, p1)"), "[2, 3][1, 0][1, 0]kkkpk");
    assert_eq!(row("1/1 RT, 2/1 LPT"), "[1, 1][1, 0][0, 1]k1k1 [1, 2][1, 0][1, 0]k1k1p");
    assert_eq!(row("2/1/3 RC"), "[2, 1, 3][2, 1, 0][0, 2, 1]kkkkkk");
    assert_eq!(row("2/1/2 RPC"), "[2, 1, 2][2, 1, 0][0, 2, 1]kkpkk");
    assert_eq!(row("2/1/3 LPC"), "[3, 1, 2][2, 1, 0][2, 0, 1]kkpkkk");
}

#[test]
fn a_cable_on_the_wrong_side_is_seen_from_behind() {
    assert_eq!(wrong_row("3/2 RC"), "[2, 3][1, 0][0, 1]ppppp");
    assert_eq!(wrong_row("3/2 RPC"), "[2, 3][1, 0][0, 1]pppkk");
}

#[test]
fn all_names_are_written_as_they_are_read() {
    let text = "K3, p2 tbl, k3 tbl, yo, k2tog, ssk, k3tog, sssk, sk2p, cdd, cddp, p2tog, ssp, sssp, k4tog tbl, p5tog, kfb, pfb, \
        ctr dbl inc, 1-to-5 inc, (k1, yo, k1) in next st, (k1 tbl, p1) in next st, M1L, k1, M1R, sl2 wyib, sl1 wyif, MB, \
        k1 below, cluster 3, drop st, k2 wrapping yarn twice, 3/2 RC, 3/2 LPC, 2/1/2 LPC, 1/1 RPT, 3/2 RC (p1, k1), \
        BO 2 sts, CO 3 sts, bunny ears dec, k2";
    for side in ["RS", "WS"] {
        let pattern = as_written(&format!("Row 1 ({side}): {text}."));
        assert_round_trip(&pattern);
        assert_eq!(pattern.rows[0].steps.iter().map(|s| s.what.uses()).sum::<usize>(), pattern.cast_on);
        assert_eq!(
            pattern.rows[0].steps.iter().map(|s| s.what.makes()).sum::<usize>(),
            pattern.rows[0].loops
        );
    }
}

#[test]
fn the_writer_folds_and_groups() {
    let text = "Row 1 (RS): K1, *[k2tog] 3 times, [yo, k1] 6 times, [k2tog] 3 times, repeat from * to last st, k1.\n\
        Row 2: P20.\nRow 3: Knit to last 3 sts, k2tog, k1.\nRow 4: Purl.";
    let written = "# check: cast on 20, rows 4, most stitches 20\n\
        Row 1 (RS): K1, *[k2tog] 3 times, [yo, k1] 6 times, [k2tog] 3 times, repeat from * to last st, k1.\n\
        Rows 2 and 4: Purl.\nRow 3: K17, k2tog, k1. (19 sts)\n";
    assert_eq!(write(&worked(text, 20)), written);
}
