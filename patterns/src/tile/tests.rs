use super::*;
use stitch_mesh::edge_counts::StitchSize;
use stitch_mesh::lay::lay;
use stitch_mesh::pieces::{from_rows, rectangle, tube};
use stitch_mesh::stitch::Stitch;
use stitch_mesh::unravel::loose_loops;

const EYELETS: &str = "Row 1 (RS): *K2, yo, k2tog, repeat from *. Row 2: Purl.";
const EDGED: &str = "Row 1 (RS): K1, *k2, yo, k2tog, repeat from *, k2. Row 2: Purl.";

fn over(fabric: &StitchMesh, text: &str, layout: Layout) -> Result<Tiled, TileError> {
    let all = fabric.mesh().faces().collect();
    let tiled = tile(fabric, &fabric.rows(), &all, &Pattern::read(text).unwrap(), layout)?;
    assert!(loose_loops(&tiled.stitches, &lay(&tiled.stitches)).is_empty());
    Ok(tiled)
}

fn row(fabric: &StitchMesh, r: usize) -> String {
    let symbols: Vec<String> = fabric.rows()[r].faces.iter().map(|f| fabric.stitch(*f).to_string()).collect();
    symbols.join(" ")
}

#[test]
fn a_round_is_tiled_without_a_seam() {
    let round = tube(12, 5, StitchSize::of_width(3e-3)).unwrap();
    let tiled = over(&round, EYELETS, Layout::Straight).unwrap();
    assert_eq!((tiled.repeats, tiled.covered, tiled.left_out.len()), (9, 60, 0), "{:?}", tiled.left_out);
    assert_eq!(row(&tiled.stitches, 0).matches("d12k").count(), 3);
    // The last row is the first one of a third band.
    assert_eq!(row(&tiled.stitches, 4).matches("d12k").count(), 3);
}

#[test]
fn what_does_not_divide_stays_plain_on_both_sides() {
    let flat = rectangle(13, 4, StitchSize::of_width(3e-3)).unwrap();
    let tiled = over(&flat, EDGED, Layout::Straight).unwrap();
    assert_eq!(row(&tiled.stitches, 0), "k k k d12k yk k d12k yk k k k");
    assert_eq!(
        tiled.left_out[0],
        "13 plain stitches side by side (2 times): 11 of them are tiled; 11 or 15 would divide"
    );
    assert_eq!(tiled.left_out[1], "8 of 52 stitches of the region stay as they were");
}

#[test]
fn shaping_is_left_alone_and_columns_go_on_above_it() {
    let line = |text: &str| text.split_whitespace().map(|s| s.parse().unwrap()).collect::<Vec<Stitch>>();
    let knit = |n: usize| vec![Stitch::knit(); n];
    let mut second = line("k d12k");
    second.extend(knit(10));
    let fabric = from_rows(&[knit(13), second, knit(12), knit(12)], StitchSize::of_width(3e-3)).unwrap();
    let tiled =
        over(&fabric, "Row 1 (RS): *P1, k3, repeat from *. Row 2: *P3, k1, repeat from *.", Layout::Straight);
    let tiled = tiled.unwrap().stitches;
    // Ten columns stand right of the decrease: two repeats, in the middle of them.
    assert_eq!(row(&tiled, 0), "k k k k k k k p k k k p k");
    // Above it there would be room for three, but not in the same columns.
    assert_eq!(row(&tiled, 2).matches('p').count(), 2);
    let column = |r: usize| row(&tiled, r).split(' ').rev().position(|s| s == "p");
    assert_eq!(column(0), column(2), "columns are counted from the right edge, which is straight");
}

#[test]
fn repeats_alternate_and_drop() {
    let flat = rectangle(8, 4, StitchSize::of_width(3e-3)).unwrap();
    let text = "Row 1 (RS): *K3, p1, repeat from *. Row 2: *P4, repeat from *.";
    let rows = |layout| {
        let tiled = over(&flat, text, layout).unwrap().stitches;
        [row(&tiled, 0), row(&tiled, 1)]
    };
    assert_eq!(rows(Layout::Straight), ["p k k k p k k k", "k k k k k k k k"]);
    assert_eq!(rows(Layout::Mirrored), ["k k k p k k k p", "k k k k k k k k"]);
    assert_eq!(rows(Layout::Alternating), ["p k k k k k k p", "k k k k k k k k"]);
    assert_eq!(rows(Layout::HalfDrop), ["p k k k k k k k", "k k k k p k k k"]);
    assert!(matches!(over(&flat, EDGED, Layout::HalfDrop), Err(TileError::Edges(3))));
}

#[test]
fn too_small_a_region_says_how_much_it_needs() {
    let flat = rectangle(5, 4, StitchSize::of_width(3e-3)).unwrap();
    let error = over(&flat, EDGED, Layout::Straight).unwrap_err().to_string();
    assert!(error.contains("needs 7 stitches side by side and 2 rows"), "{error}");
}

#[test]
fn edge_stitches_fall_away_around_a_tube() {
    let round = tube(15, 2, StitchSize::of_width(3e-3)).unwrap();
    let tiled = over(
        &round,
        "Row 1 (RS): P2, *k3, p2, repeat from *. Row 2: K2, *p3, k2, repeat from *.",
        Layout::Straight,
    );
    let tiled = tiled.unwrap();
    assert_eq!((tiled.repeats, tiled.left_out.len()), (3, 0), "{:?}", tiled.left_out);
    assert_eq!(row(&tiled.stitches, 0), "p p k k k p p k k k p p k k k");
    // A decrease over the edge cannot fall away.
    let text = "Row 1 (RS): *K3, yo, k2tog, repeat from * to last 4 sts, k2tog, yo, k2. Row 2: Purl.";
    assert!(!over(&round, text, Layout::Straight).unwrap().left_out.is_empty());
}

#[test]
fn what_belongs_to_edges_is_not_tiled() {
    let flat = rectangle(9, 4, StitchSize::of_width(3e-3)).unwrap();
    for text in ["Row 1 (RS): K2, BO 2, k3. Row 2: P4, CO 2, p2.", "Row 1 (RS): K4, w&t. Row 2: P4."] {
        let text = format!("# check: cast on 8, rows 2, most stitches 8\n{text}");
        let error = over(&flat, &text, Layout::Straight).unwrap_err().to_string();
        assert!(error.contains("but not tiled") || error.contains("cannot be repeated"), "{error}");
    }
}
