//! How many stitches a pattern is cast on with.

use super::*;

fn cast_on(text: &str, width: Width) -> usize {
    Pattern::read(text).unwrap().work(width).unwrap().cast_on
}

#[test]
fn as_written() {
    for (text, stitches) in [
        ("# check: cast on 12, rows 1, most stitches 12\nRow 1: *K1, p1, repeat from *.", 12),
        ("Cast on 10 sts.\nRow 1: *K1, p1, repeat from *.", 10),
        ("Row 1: *K1, p1, repeat from *.", 4),
        ("Row 1: K1, *p3, k1, repeat from *.\nRow 2: *P1, k5, repeat from * to last 3 sts, p3.", 21),
        ("Row 1: Knit.\nRow 2: Purl.", 8),
        ("Row 1: Knit.\nRow 2: K3, purl to last 9 sts, k9.", 12),
        ("Row 1: Knit.\nRow 2: K5, p6.", 11),
        ("Row 1: *K1, yo, repeat from *.\nRow 2: *P6, repeat from *.", 6),
        ("Row 1: *K2tog, repeat from *.\nRow 2: P7.", 14),
        ("Row 1: Knit to last st, kfb.\nRow 2: *P3, repeat from *.", 5),
        ("Row 1: K3, turn.\nRow 2: Purl.\nRow 3: *K5, repeat from *.", 10),
    ] {
        assert_eq!(cast_on(text, Width::AsWritten), stitches, "{text}");
    }
}

#[test]
fn by_repeats() {
    let text = "Row 1: Purl.\nRow 2: K1, *yo, k2tog, k4, repeat from *.\nRow 3: *P3, repeat from *, p1.";
    assert_eq!((1..4).map(|n| cast_on(text, Width::Repeats(n))).collect::<Vec<_>>(), [7, 13, 19]);
    assert_eq!(cast_on("Row 1: Knit.", Width::Repeats(5)), 5);
    assert_eq!(cast_on("Row 1: K3, p2.", Width::Repeats(5)), 5);
    let cannot = "Row 1: *K2, repeat from *.\nRow 2: *K6, repeat from *.";
    assert_eq!(cast_on(cannot, Width::Repeats(3)), 6);
    assert!(Pattern::read(cannot).unwrap().work(Width::Repeats(2)).is_err());
}

#[test]
fn every_cast_on_that_solves_works_and_is_the_smallest() {
    // Against trying them all out.
    for (u, m, rest) in [(2, 3, 1), (3, 2, 0), (5, 5, 4), (4, 6, 2), (7, 1, 3)] {
        for (u2, rest2) in [(2, 0), (3, 1), (4, 3), (6, 5)] {
            let makes = format!("[yo] {} times, k1", m);
            let text = format!(
                "Row 1: *k{}, {makes}, repeat from *{}.\nRow 2: *P{u2}, repeat from *{}.",
                u - 1,
                if rest > 0 { format!(", k{rest}") } else { String::new() },
                if rest2 > 0 { format!(", p{rest2}") } else { String::new() },
            );
            let pattern = Pattern::read(&text).unwrap();
            let tried = (1..400).find(|n| {
                let worked = pattern.work(Width::CastOn(*n));
                worked.is_ok_and(|w| w.rows.iter().all(|r| r.repeats.len() >= 2))
            });
            assert_eq!(pattern.work(Width::AsWritten).ok().map(|w| w.cast_on), tried, "{text}");
        }
    }
}
