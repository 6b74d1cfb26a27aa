//! Columns along a row, counted from one of its stitches.

use super::PatchError;
use crate::ids::FaceId;
use crate::label::Row;
use crate::stitch_mesh::StitchMesh;

/// A row with one of its stitches as the origin of its columns.
pub struct Line {
    pub row: Row,
    origin: i32,
}

impl Line {
    pub fn through(stitches: &StitchMesh, face: FaceId) -> Self {
        let row = stitches.row_of(face);
        let origin = row.faces.iter().position(|f| *f == face).unwrap_or(0) as i32;
        Self { row, origin }
    }

    /// All faces with their columns; in a closed row those on the nearer side.
    pub fn columns(&self) -> impl Iterator<Item = (i32, FaceId)> + '_ {
        let n = self.row.faces.len() as i32;
        self.row.faces.iter().zip(0..).map(move |(f, i)| {
            let column = i - self.origin;
            if !self.row.closed {
                (column, *f)
            } else {
                let around = column.rem_euclid(n);
                (if 2 * around > n { around - n } else { around }, *f)
            }
        })
    }

    pub fn at(&self, column: i32) -> Result<FaceId, PatchError> {
        let faces = &self.row.faces;
        let i = i64::from(self.origin) + i64::from(column);
        if self.row.closed {
            return Ok(faces[i.rem_euclid(faces.len() as i64) as usize]);
        }
        let inside = usize::try_from(i).ok().and_then(|i| faces.get(i)).copied();
        let (end, way) =
            if column < 0 { (faces[0], "to the left") } else { (faces[faces.len() - 1], "to the right") };
        inside.ok_or(PatchError::Ends { face: end, way })
    }
}
