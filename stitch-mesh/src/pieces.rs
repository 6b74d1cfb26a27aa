//! Plain pieces of fabric, stitch by stitch: the rectangle and the tube that swatches and experiments begin with.

use crate::cable::CableError;
use crate::edge_counts::StitchSize;
use crate::mesh::{MeshError, PolygonMesh};
use crate::stitch::Stitch;
use crate::stitch_mesh::{StitchMesh, StitchMeshError};
use glam::DVec3;

/// Rows that make no piece.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum PieceError {
    /// A row that leaves loops over, or wants more than there are.
    #[error("row {number} joins {joined} loops, but there are {below} below it")]
    Row {
        /// The row, from 0.
        number: usize,
        /// Loops that its stitches join.
        joined: usize,
        /// Loops below.
        below: usize,
    },
    /// The stitches make no mesh.
    #[error(transparent)]
    Mesh(#[from] MeshError),
    /// Nor a stitch mesh.
    #[error(transparent)]
    StitchMesh(#[from] StitchMeshError),
    /// A cable cannot cross.
    #[error(transparent)]
    Cable(#[from] CableError),
}

/// A flat piece of `wide` × `high` knit stitches in the plane z = 0, front to +z, wales up along +y, centred on the origin.
///
/// # Errors
/// A piece without stitches is no mesh.
pub fn rectangle(wide: usize, high: usize, size: StitchSize) -> Result<StitchMesh, StitchMeshError> {
    let place = |i: usize, j: usize| {
        DVec3::new(
            (i as f64 - wide as f64 / 2.0) * size.width,
            (j as f64 - high as f64 / 2.0) * size.height,
            0.0,
        )
    };
    quads(wide, wide + 1, high, place)
}

/// A tube of `around` × `high` knit stitches about the y axis, front outwards, wales up, centred on the origin.
///
/// # Errors
/// Fewer than three stitches around enclose nothing.
pub fn tube(around: usize, high: usize, size: StitchSize) -> Result<StitchMesh, StitchMeshError> {
    let radius = around as f64 * size.width / std::f64::consts::TAU;
    let place = |i: usize, j: usize| {
        let angle = i as f64 / around as f64 * std::f64::consts::TAU;
        DVec3::new(radius * angle.sin(), (j as f64 - high as f64 / 2.0) * size.height, radius * angle.cos())
    };
    quads(around, around, high, place)
}

/// A flat piece from its rows of stitches, the lowest first, each from left to right; it lies as [`rectangle`] does, every
/// row as wide as it has loops.
///
/// # Errors
/// No stitches; a row that does not join all loops of the row below.
pub fn from_rows(rows: &[Vec<Stitch>], size: StitchSize) -> Result<StitchMesh, PieceError> {
    let bottoms = |row: &[Stitch]| row.iter().map(Stitch::bottoms).sum::<usize>();
    let mut loops = vec![rows.first().map_or(0, |row| bottoms(row))];
    for (number, row) in rows.iter().enumerate() {
        let (joined, below) = (bottoms(row), loops[number]);
        if joined != below {
            return Err(PieceError::Row { number, joined, below });
        }
        loops.push(row.iter().map(Stitch::tops).sum());
    }
    let mut first = vec![0];
    loops.iter().for_each(|n| first.push(first[first.len() - 1] + n + 1));
    let place = |(level, count): (usize, &usize)| {
        let y = (level as f64 - rows.len() as f64 / 2.0) * size.height;
        let half = *count as f64 / 2.0;
        (0..=*count).map(move |i| DVec3::new((i as f64 - half) * size.width, y, 0.0))
    };
    let positions = loops.iter().enumerate().flat_map(place).collect();
    let mut faces: Vec<Vec<u32>> = Vec::new();
    for (level, row) in rows.iter().enumerate() {
        let (mut below, mut above) = (first[level], first[level + 1]);
        for stitch in row {
            let bottom = (0..=stitch.bottoms()).map(|i| below + i);
            let top = (0..=stitch.tops()).rev().map(|i| above + i);
            faces.push(bottom.chain(top).map(|v| v as u32).collect());
            (below, above) = (below + stitch.bottoms(), above + stitch.tops());
        }
    }
    let mesh = PolygonMesh::new(positions, &faces)?;
    Ok(StitchMesh::new(mesh, rows.iter().flatten().cloned().collect())?)
}

/// Quadrilaterals in rows of `wide` over rows of `vertices`; a row with as many vertices as faces is closed.
fn quads(
    wide: usize,
    vertices: usize,
    high: usize,
    place: impl Fn(usize, usize) -> DVec3,
) -> Result<StitchMesh, StitchMeshError> {
    let positions = (0..=high).flat_map(|j| (0..vertices).map(move |i| (i, j))).map(|(i, j)| place(i, j));
    let at = |i: usize, j: usize| (j * vertices + i % vertices) as u32;
    let faces: Vec<Vec<u32>> = (0..high)
        .flat_map(|j| (0..wide).map(move |i| (i, j)))
        .map(|(i, j)| vec![at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)])
        .collect();
    let mesh = PolygonMesh::new(positions.collect(), &faces)?;
    let stitches = vec![Stitch::knit(); mesh.face_count()];
    StitchMesh::new(mesh, stitches)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pieces_have_their_rows() {
        let size = StitchSize::of_width(3e-3);
        let flat = rectangle(5, 4, size).unwrap();
        assert!(flat.rows().iter().all(|r| r.faces.len() == 5 && !r.closed));
        let round = tube(9, 4, size).unwrap();
        assert!(round.rows().iter().all(|r| r.faces.len() == 9 && r.closed));
        assert_eq!((flat.rows().len(), round.rows().len()), (4, 4));
        let front = round.mesh().face_center(round.rows()[0].faces[0]);
        assert!(round.mesh().face_area_vector(round.rows()[0].faces[0]).dot(front.with_y(0.0)) > 0.0);
        assert!(rectangle(0, 3, size).is_err());
    }

    #[test]
    fn rows_make_a_shaped_piece() {
        let row = |text: &str| text.split_whitespace().map(|s| s.parse().unwrap()).collect::<Vec<Stitch>>();
        let size = StitchSize::of_width(3e-3);
        let piece = from_rows(&[row("k k k k"), row("k d12k k"), row("k kp k")], size).unwrap();
        let rows: Vec<usize> = piece.rows().iter().map(|r| r.faces.len()).collect();
        assert_eq!((rows, piece.loop_count()), (vec![4, 3, 3], 4 + 3 + 4));
        let error = from_rows(&[row("k k"), row("k k k")], size).unwrap_err();
        assert_eq!(error.to_string(), "row 1 joins 3 loops, but there are 2 below it");
        assert!(from_rows(&[], size).is_err());
    }

    #[test]
    fn closed_rows_begin_above_each_other() {
        let round = tube(7, 5, StitchSize::of_width(3e-3)).unwrap();
        for pair in round.rows().windows(2) {
            assert_eq!(round.above(pair[0].faces[0]).next(), Some(pair[1].faces[0]));
        }
    }
}
