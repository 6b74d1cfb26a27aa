//! Swatches: one small flat piece for each stitch, border and cable, to look at and to test with.

use crate::cable::Cable;
use crate::edge_counts::StitchSize;
use crate::ids::VertexId;
use crate::pieces::{PieceError, from_rows};
use crate::stitch::Stitch;
use crate::stitch_mesh::StitchMesh;

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

/// A swatch of stockinette on a cast-on of seven such loops; or without one, where the knits stand on the border. Its upper
/// border is bound off.
///
/// # Errors
/// Another number of loops.
pub fn with_borders(cast_on: Option<[Stitch; 7]>, size: StitchSize) -> Result<StitchMesh, PieceError> {
    let mut rows: Vec<_> = cast_on.map(Vec::from).into_iter().collect();
    rows.extend(vec![vec![Stitch::knit(); 7]; 6]);
    from_rows(&rows, size)
}

/// Knits between purls, with cables one above the other at equal distances. Of each cable the strands, order and front
/// count; it comes with the number of knits on its left.
///
/// # Errors
/// A piece that is too small, or a cable that cannot cross.
pub fn of_cable(
    crossings: &[(usize, Cable)],
    height: usize,
    size: StitchSize,
) -> Result<StitchMesh, PieceError> {
    /// Purls on both sides.
    const BESIDE: usize = 2;
    let knits = crossings.iter().map(|(left, c)| left + c.loops()).max().unwrap_or(0);
    let mut row = vec![Stitch::purl(); knits + 2 * BESIDE];
    row[BESIDE..BESIDE + knits].fill(Stitch::knit());
    // Every row boundary of the piece has its vertices from left to right.
    let boundary = row.len() + 1;
    let mut piece = from_rows(&vec![row; height], size)?;
    let apart = height / (crossings.len() + 1);
    for (i, (left, cable)) in crossings.iter().enumerate() {
        let first = (i + 1) * apart * boundary + BESIDE + left;
        let path = (first..=first + cable.loops()).map(VertexId::new).collect();
        piece.set_cable(Cable { path, ..cable.clone() })?;
    }
    Ok(piece)
}
