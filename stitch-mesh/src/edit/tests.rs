use super::*;
use crate::cable::Cable;
use crate::dye::Dye;
use crate::edge_counts::StitchSize;
use crate::mesh::PolygonMesh;
use crate::pieces::{rectangle, tube};
use crate::stitch::Stitch;
use crate::wrapping::Wrapping;
use glam::DVec3;

/// Stitches 0–4 below 5–9 below 10–14; vertices 0–5, 6–11, 12–17, 18–23.
fn piece() -> StitchMesh {
    rectangle(5, 3, StitchSize::of_width(3e-3)).unwrap()
}

fn v(a: u32, b: u32) -> [VertexId; 2] {
    [VertexId(a), VertexId(b)]
}

fn symbols(stitches: &StitchMesh) -> Vec<String> {
    let symbol = |f: &FaceId| stitches.stitch(*f).to_string();
    stitches.rows().iter().map(|r| r.faces.iter().map(symbol).collect::<Vec<_>>().join(" ")).collect()
}

#[test]
fn a_split_is_taken_back_by_a_collapse() {
    let before = piece();
    let (split, survivors) = before.split_course(v(8, 9)).unwrap();
    assert_eq!(symbols(&split), ["k k kp k k", "k k d12k k k", "k k k k k"]);
    assert_eq!(split.mesh().vertex_count(), 25);
    assert!(survivors.vertices.iter().enumerate().all(|(i, v)| *v == Some(VertexId::new(i))));
    let (after, survivors) = split.collapse_course(v(9, 24)).unwrap();
    assert_eq!(symbols(&after), symbols(&before));
    assert_eq!(after.mesh().face_lists(), before.mesh().face_lists());
    assert_eq!(survivors.vertices[24], Some(VertexId(9)));
    assert!(split.collapse_course(v(8, 24)).is_ok());
}

#[test]
fn borders_split_and_stay_live() {
    let mut piece = piece();
    piece.set_live(v(19, 20), true).unwrap();
    let (split, _) = piece.split_course(v(20, 19)).unwrap();
    assert_eq!(symbols(&split)[2], "k kp k k k");
    assert_eq!(split.marks().live.iter().collect::<Vec<_>>(), [&v(19, 24), &v(20, 24)]);
    let (after, _) = split.collapse_course(v(19, 24)).unwrap();
    assert_eq!(after.marks().live.iter().collect::<Vec<_>>(), [&v(19, 20)]);
    let (cast_on, _) = piece.split_course(v(0, 1)).unwrap();
    assert_eq!(symbols(&cast_on)[0], "d12k k k k k");
}

#[test]
fn what_would_drop_a_loop_is_refused() {
    let piece = piece();
    assert!(matches!(piece.collapse_course(v(8, 9)), Err(EditError::LastTop { face: FaceId(2), .. })));
    assert!(matches!(piece.collapse_course(v(0, 1)), Err(EditError::LastBottom { face: FaceId(0), .. })));
    assert!(matches!(piece.split_course(v(8, 14)), Err(EditError::NotCourse(..))));
    assert!(matches!(piece.split_course(v(0, 14)), Err(EditError::NoEdge(..))));
    assert!(matches!(piece.remove_wale(v(8, 9)), Err(EditError::NotWale(..))));
    assert!(matches!(piece.remove_wale(v(6, 12)), Err(EditError::RowEnd(..))));
    assert!(matches!(piece.add_wale(FaceId(7), v(8, 14)), Err(EditError::NoLoops { .. })));
    assert!(matches!(piece.add_wale(FaceId(7), v(14, 9)), Err(EditError::NotAcross { .. })));
    assert!(matches!(piece.add_wale(FaceId(99), v(14, 9)), Err(EditError::NoFace(_))));
    assert!(matches!(
        piece.shift_wale(v(8, 14), End::Top, Way::Left),
        Err(EditError::NothingToGive { face: FaceId(6), side: "above" })
    ));
    let ring = tube(3, 1, StitchSize::of_width(3e-3)).unwrap();
    let pair = ring.remove_wale(v(1, 4)).unwrap().0;
    assert!(matches!(pair.remove_wale(v(2, 5)), Err(EditError::LastOfRow(_))));
}

#[test]
fn a_removed_wale_edge_works_two_stitches_together() {
    let mut before = piece();
    let red: Dye = "#ff0000".parse().unwrap();
    before.set_dye(FaceId(14), red).unwrap();
    let slack = Wrapping { modulus: 0.0, angle: None };
    [6, 14].into_iter().for_each(|f| before.set_wrapping(FaceId(f), slack).unwrap());
    let (merged, survivors) = before.remove_wale(v(14, 8)).unwrap();
    assert_eq!(symbols(&merged)[1], "k d12kk k k");
    assert_eq!(merged.mesh().face_count(), 14);
    assert_eq!(survivors.faces[7], Some(FaceId(6)));
    assert_eq!(survivors.faces[14], Some(FaceId(13)));
    assert_eq!(merged.dyes()[13], red);
    assert_eq!([6, 7, 13].map(|f| merged.wrappings()[f] == slack), [true, false, true]);
    assert_eq!(survivors.faces_before()[6..9], [6, 8, 9].map(|f| Some(FaceId(f))));
    // Now one of its two loops above can go: a k2tog, and the one above it is worked into one loop less.
    let (less, _) = merged.add_wale(FaceId(6), v(8, 14)).unwrap();
    assert_eq!(symbols(&less)[1], "k k k k k");
    assert_eq!(less.mesh().face_count(), 15);
    assert_eq!([6, 13, 14].map(|f| less.wrappings()[f]), [slack; 3]);
}

#[test]
fn a_column_can_be_shaped_away() {
    // Two columns meet above stitch 6 and 7: worked together, then one loop, then the column goes on alone.
    let (fabric, _) = piece().remove_wale(v(8, 14)).unwrap();
    let (fabric, _) = fabric.remove_wale(v(14, 20)).unwrap();
    let (fabric, survivors) = fabric.collapse_course(v(13, 14)).unwrap();
    assert_eq!(symbols(&fabric), ["k k k k k", "k d12k k k", "k kk k k"]);
    assert_eq!(survivors.vertices[14], Some(VertexId(13)));
    assert_eq!(survivors.vertices[15], Some(VertexId(14)));
}

#[test]
fn a_shifted_wale_edge_hands_a_loop_over() {
    let mut split = piece().split_course(v(14, 15)).unwrap().0;
    assert_eq!(symbols(&split), ["k k k k k", "k k kp k k", "k k d12k k k"]);
    split.set_stitch(FaceId(7), "p1y".parse().unwrap()).unwrap();
    let (left, _) = split.shift_wale(v(8, 14), End::Top, Way::Right).unwrap();
    assert_eq!(symbols(&left), ["k k k k k", "k kp1 k k k", "k k d12k k k"]);
    let (back, _) = left.shift_wale(v(8, 24), End::Top, Way::Left).unwrap();
    assert_eq!(symbols(&back)[1], "k k p1k k k", "a stitch with loops below cannot be a yarn-over alone");
    assert_eq!(back.mesh().face_lists(), split.mesh().face_lists());
    let (bottom, _) = split.shift_wale(v(15, 21), End::Bottom, Way::Left).unwrap();
    assert_eq!(symbols(&bottom)[2], "k k k d12k k");
}

#[test]
fn cables_and_seams_are_not_cut_but_come_along() {
    let mut piece = piece();
    piece.set_cable(Cable::cross([8, 9, 10].map(VertexId).to_vec(), 1, 1, true)).unwrap();
    let seam = crate::seam::Seam { a: vec![VertexId(0), VertexId(6)], b: vec![VertexId(5), VertexId(11)] };
    piece.sew(seam.clone()).unwrap();
    assert!(matches!(piece.split_course(v(8, 9)), Err(EditError::InCable(..))));
    let (after, _) = piece.remove_wale(v(1, 7)).unwrap();
    let (after, _) = after.split_course(v(6, 7)).unwrap();
    let (after, _) = after.collapse_course(v(7, 24)).unwrap();
    assert_eq!((after.cables(), after.seams()), (piece.cables(), &[seam][..]));
}

#[test]
fn a_stitch_worked_into_ten_loops_is_refused() {
    let mut fabric = piece();
    for _ in 0..MOST_BOTTOMS - 1 {
        fabric = fabric
            .split_course(v(8, 9))
            .or_else(|_| {
                let last = VertexId::new(fabric.mesh().vertex_count() - 1);
                fabric.split_course([last, VertexId(9)])
            })
            .unwrap()
            .0;
    }
    let last = VertexId::new(fabric.mesh().vertex_count() - 1);
    assert_eq!(fabric.split_course([last, VertexId(9)]).unwrap_err(), EditError::TooManyBottoms(FaceId(7)));
    assert_eq!(fabric.stitch(FaceId(7)), &Stitch::default_for(9, 1, true));
}

/// A tube of three loops above a tab: where two of its vertices become one, an edge would have three stitches.
#[test]
fn a_tube_that_would_close_is_refused() {
    let around = |i: u32, y: f64| {
        let angle = std::f64::consts::TAU * f64::from(i) / 3.0;
        DVec3::new(angle.sin(), y, angle.cos())
    };
    let tab = [0, 2].map(|i| around(i, -1.0));
    let positions = (0..3).map(|i| around(i, 0.0)).chain(tab).chain((0..3).map(|i| around(i, 1.0)));
    let faces = [vec![3, 4, 2, 1, 0], vec![0, 1, 2, 7, 6, 5], vec![2, 0, 5, 7]];
    let stitches = [(1, 2), (2, 2), (1, 1)].map(|(bottoms, tops)| Stitch::default_for(bottoms, tops, true));
    let mesh = PolygonMesh::new(positions.collect(), &faces).unwrap();
    let tube = StitchMesh::new(mesh, stitches.to_vec()).unwrap();
    let refused = tube.collapse_course(v(0, 1)).unwrap_err();
    assert!(refused.to_string().contains("3 faces share it"), "{refused}");
    assert!(tube.split_course(v(0, 1)).is_ok());
}
