use super::*;
use crate::lay::lay;
use crate::unravel::loose_loops;

fn row(text: &str) -> Vec<Item> {
    text.split_whitespace()
        .map(|word| match word.split_at(1) {
            ("-", n) => Item::BindOff(n.parse().unwrap()),
            ("+", n) => Item::CastOn(n.parse().unwrap()),
            _ => Item::Stitch(word.parse().unwrap()),
        })
        .collect()
}

fn knitted(count: usize, round: bool, rows: &[(usize, &str)]) -> StitchMesh {
    let mut needle = Needle::cast_on(count, round, StitchSize::of_width(3e-3)).unwrap();
    for (from, text) in rows {
        needle.work(*from, &row(text)).unwrap();
    }
    let fabric = needle.finish().unwrap();
    assert!(loose_loops(&fabric, &lay(&fabric)).is_empty());
    fabric
}

fn rows(fabric: &StitchMesh) -> Vec<usize> {
    fabric.rows().iter().map(|r| r.faces.len()).collect()
}

#[test]
fn rows_grow_and_shrink() {
    let fabric = knitted(4, false, &[(0, "k k k k"), (0, "k ky k k"), (0, "d12k k k k")]);
    assert_eq!(rows(&fabric), [4, 4, 4]);
    let [low, high] = fabric.mesh().bounds();
    assert!((high.y - low.y - 3.0 * StitchSize::of_width(3e-3).height).abs() < 1e-12);
}

#[test]
fn a_round_is_closed() {
    let fabric = knitted(6, true, &[(0, "k k k k k k"), (0, "k k ky k k k"), (0, "p d12k k k k k")]);
    assert!(fabric.rows().iter().all(|r| r.closed));
    assert_eq!(rows(&fabric), [6, 6, 6]);
    let net = lay(&fabric);
    assert!(net.yarns.iter().all(|y| y.period.is_some()));
}

#[test]
fn a_buttonhole_is_a_hole() {
    let fabric = knitted(
        8,
        false,
        &[(0, "k k k k k k k k"), (0, "k k k -2 k k k"), (0, "k k k +2 k k k"), (0, "k k k k k k k k")],
    );
    // Around the piece, and around the hole.
    assert_eq!(fabric.mesh().borders().len(), 2);
    assert_eq!(rows(&fabric), [8, 3, 3, 3, 3, 8]);
}

#[test]
fn loops_are_cast_on_and_bound_off_at_the_edges() {
    let fabric = knitted(3, false, &[(0, "k k k"), (0, "+2 k k k +1"), (0, "k k k k k k"), (0, "-2 k k -2")]);
    assert_eq!(fabric.mesh().borders().len(), 1);
    assert_eq!(fabric.mesh().face_count(), 3 + 3 + 6 + 2);
}

#[test]
fn short_rows_leave_a_slit() {
    // The right half is worked twice more, then all of it.
    let all = (0, "k k k k k k");
    let fabric = knitted(6, false, &[all, (3, "k k k"), (3, "k k k"), all, all]);
    assert_eq!(fabric.mesh().borders().len(), 2, "around the piece, and around the slit");
    let mut found = rows(&fabric);
    found.sort_unstable();
    assert_eq!(found, [3, 3, 3, 3, 6, 6]);
}

#[test]
fn what_the_mesh_cannot_hold_is_refused() {
    let mut needle = Needle::cast_on(4, false, StitchSize::of_width(3e-3)).unwrap();
    assert_eq!(needle.work(0, &row("k k k k k")), Err(NeedleError::Loops { wanted: 5, left: 4 }));
    let cross = Item::Cross(Cable::cross(Vec::new(), 1, 1, true), vec![Stitch::knit(); 2]);
    assert_eq!(needle.work(0, &[cross]), Err(NeedleError::Crossing));
    needle.work(2, &row("k k")).unwrap();
    assert_eq!(needle.work(0, &row("k d12k k")), Err(NeedleError::Apart));
    assert!(matches!(Needle::cast_on(2, true, StitchSize::of_width(3e-3)), Err(NeedleError::Round(2))));
}
