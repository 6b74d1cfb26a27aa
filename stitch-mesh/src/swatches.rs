//! Swatches: one small flat piece for each stitch and cable, to look at and to test with.

use crate::cable::Cable;
use crate::edge_counts::StitchSize;
use crate::ids::{FaceId, VertexId};
use crate::pieces::{PieceError, from_rows};
use crate::stitch::Stitch;
use crate::stitch_mesh::StitchMesh;

/// The stitches of Table 1, the twisted ones, and the special faces of Fig. 4 and 5, in the order of a palette.
pub const STITCHES: [(&str, &[&str]); 6] = [
    ("Plain", &["k", "p", "d0y", "s", "x"]),
    ("Twisted", &["k1", "k-1", "p1", "p-1"]),
    ("Two from one", &["kp", "ky", "yk", "py", "yp", "k1y", "sk", "ks"]),
    ("Three from one", &["kpk", "kyk", "yky", "kpy", "ykp", "pkp", "pyp", "ypy", "pky", "ypk"]),
    ("Two together", &["d12k", "d21k", "d12p", "d21p"]),
    (
        "Three together",
        &[
            "d123k", "d132k", "d213k", "d231k", "d312k", "d321k", "d123p", "d132p", "d213p", "d231p",
            "d312p", "d321p",
        ],
    ),
];

/// A swatch of stockinette with `stitch` in its middle. What it adds or takes away is made good in the rows above and below,
/// at a distance.
///
/// # Errors
/// A stitch with more than a few loops.
pub fn of_stitch(stitch: &Stitch, size: StitchSize) -> Result<StitchMesh, PieceError> {
    let knit = |n: usize| vec![Stitch::knit(); n];
    let beside = |left: usize, middle: Stitch, right: usize| {
        let mut row = knit(left);
        row.push(middle);
        row.extend(knit(right));
        row
    };
    let (below, above) = (stitch.bottoms(), stitch.tops());
    let mut rows = vec![knit(6 + below); 3];
    rows.push(beside(3, stitch.clone(), 3));
    rows.extend(vec![knit(6 + above); 3]);
    from_rows(&rows, size)
}

/// A rib of knits between purls with a cable: strands, order and front as in [`Cable`], crossed again and again, `rows`
/// apart. Crossings take turns.
///
/// # Errors
/// A cable that cannot cross, as [`PieceError`] of its size.
pub fn of_cable(
    crossings: &[(usize, Cable)],
    height: usize,
    size: StitchSize,
) -> Result<StitchMesh, PieceError> {
    let loops = crossings.iter().map(|(left, c)| left + c.loops()).max().unwrap_or(0);
    let row: Vec<Stitch> = (0..loops + 4)
        .map(|i| if (2..loops + 2).contains(&i) { Stitch::knit() } else { Stitch::purl() })
        .collect();
    let wide = row.len();
    let mut piece = from_rows(&vec![row; height], size)?;
    let apart = height / (crossings.len() + 1);
    for (i, (left, cable)) in crossings.iter().enumerate() {
        let above = (i + 1) * apart * (wide + 1) + 2 + left;
        let path = (0..=cable.loops()).map(|k| VertexId::new(above + k)).collect();
        let cable = Cable { path, ..cable.clone() };
        // A crossing that does not fit is left out: the swatch shows the rib then.
        let _ = piece.set_cable(cable);
    }
    debug_assert_eq!(piece.mesh().face_vertices(FaceId(0)).next(), Some(VertexId(0)));
    Ok(piece)
}
