use super::*;
use crate::edge_counts::StitchSize;
use crate::pieces::{rectangle, tube};

const SLACK: Wrapping = Wrapping { modulus: 0.5, angle: Some(1.0) };

fn symbols(stitches: &StitchMesh) -> Vec<String> {
    let symbol = |f: &FaceId| stitches.stitch(*f).to_string();
    stitches.rows().iter().map(|r| r.faces.iter().map(symbol).collect::<String>()).collect()
}

/// Stitches 0–5 below 6–11 below 12–17 below 18–23, with a twisted purl and a left cross.
fn piece() -> StitchMesh {
    let mut piece = rectangle(6, 4, StitchSize::of_width(3e-3)).unwrap();
    piece.set_stitch(FaceId(0), "p1".parse().unwrap()).unwrap();
    piece.set_stitch(FaceId(6), Stitch::purl()).unwrap();
    piece.set_dye(FaceId(7), "#ff0000".parse().unwrap()).unwrap();
    piece.set_wrapping(FaceId(7), SLACK).unwrap();
    piece.set_cable(Cable::cross([7, 8, 9, 10].map(VertexId).to_vec(), 1, 2, true)).unwrap();
    piece
}

#[test]
fn a_patch_is_copied_and_pasted() {
    let source = piece();
    let patch = Patch::copy(&source, &[0, 1, 6, 7].map(FaceId)).unwrap();
    assert_eq!(patch.cables.len(), 0, "one loop of the cable lies outside");
    let patch = Patch::copy(&source, &[0, 1, 2, 3, 6, 7, 8, 9].map(FaceId)).unwrap();
    assert_eq!(patch.cables.len(), 1);
    let mut target = rectangle(6, 4, StitchSize::of_width(3e-3)).unwrap();
    patch.paste(&mut target, FaceId(14)).unwrap();
    assert_eq!(symbols(&target), ["kkkkkk", "kkkkkk", "kkp1kkk", "kkpkkk"]);
    assert_eq!(target.dyes()[21].to_string(), "#ff0000");
    assert_eq!([20, 21].map(|f| target.wrappings()[f]), [Wrapping::OF_MATERIAL, SLACK]);
    assert_eq!(target.cables(), [Cable::cross([23, 24, 25, 26].map(VertexId).to_vec(), 1, 2, true)]);
    patch.paste(&mut target, FaceId(14)).unwrap();
    assert_eq!(target.cables().len(), 1, "pasting over it replaces the cable");
}

#[test]
fn a_mirrored_patch_crosses_the_other_way() {
    let source = piece();
    let patch = Patch::copy(&source, &[0, 1, 2, 3, 6, 7, 8, 9].map(FaceId)).unwrap();
    assert_eq!(patch.mirrored().mirrored(), patch);
    let mut target = rectangle(6, 4, StitchSize::of_width(3e-3)).unwrap();
    patch.mirrored().paste(&mut target, FaceId(1)).unwrap();
    assert_eq!(symbols(&target), ["kkkkp-1k", "kkkkpk", "kkkkkk", "kkkkkk"]);
    let cable = &target.cables()[0];
    assert_eq!(cable.path, [9, 10, 11, 12].map(VertexId));
    assert_eq!((&cable.strands[..], &cable.front[..]), (&[2, 1][..], &[0, 1][..]));
    let decrease: Stitch = "d213kyp1".parse().unwrap();
    assert_eq!(decrease.mirrored().to_string(), "d231p-1yk");
}

#[test]
fn what_does_not_fit_is_named() {
    let source = piece();
    let patch = Patch::copy(&source, &[0, 1, 6, 7].map(FaceId)).unwrap();
    let mut target =
        rectangle(6, 4, StitchSize::of_width(3e-3)).unwrap().split_course([8, 9].map(VertexId)).unwrap().0;
    let before = target.clone();
    assert!(matches!(
        patch.paste(&mut target, FaceId(5)),
        Err(PatchError::Ends { face: FaceId(5), way: "to the right" })
    ));
    assert!(matches!(patch.paste(&mut target, FaceId(19)), Err(PatchError::Ends { way: "above", .. })));
    assert!(matches!(patch.paste(&mut target, FaceId(99)), Err(PatchError::NoFace(_))));
    let error = patch.paste(&mut target, FaceId(1)).unwrap_err().to_string();
    assert!(error.starts_with("stitch 1 is kp, and the patch has p1 there"), "{error}");
    assert_eq!(target, before);
    assert!(matches!(Patch::copy(&source, &[]), Err(PatchError::Empty)));
    assert!(matches!(Patch::copy(&source, &[FaceId(0), FaceId(99)]), Err(PatchError::NoFace(_))));
    let mut ring = tube(3, 4, StitchSize::of_width(3e-3)).unwrap();
    let wide = Patch::copy(&source, &[0, 1, 2, 3].map(FaceId)).unwrap();
    assert!(matches!(wide.paste(&mut ring, FaceId(0)), Err(PatchError::Laps { has: 3, needs: 4, .. })));
}

#[test]
fn a_patch_goes_round_a_tube() {
    let mut ring = tube(5, 3, StitchSize::of_width(3e-3)).unwrap();
    let patch = Patch::copy(&piece(), &[0, 1, 6, 7].map(FaceId)).unwrap();
    patch.paste(&mut ring, FaceId(4)).unwrap();
    assert_eq!(symbols(&ring), ["kkkkp1", "kkkkp", "kkkkk"]);
    let again = Patch::copy(&ring, &[4, 0, 9, 5].map(FaceId)).unwrap();
    assert_eq!(again, patch);
}
