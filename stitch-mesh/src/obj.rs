//! Wavefront OBJ in: positions and polygons.
//!
//! Read here rather than by a library because the ones at hand renumber the vertices by first use, drop those that no face
//! uses, cut the mesh where a new object begins, and do not say in which line an error stands. All of that is what a person
//! with a broken mesh needs to know.

use crate::mesh::{MeshError, PolygonMesh};
use glam::DVec3;

/// The unit in which a mesh file is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Unit {
    /// Millimetre.
    Mm,
    /// Centimetre.
    Cm,
    /// Decimetre, as MakeHuman writes.
    Dm,
    /// Metre.
    M,
    /// Inch.
    In,
}

impl Unit {
    /// Length of the unit [m].
    pub fn metres(self) -> f64 {
        match self {
            Unit::Mm => 1e-3,
            Unit::Cm => 1e-2,
            Unit::Dm => 1e-1,
            Unit::M => 1.0,
            Unit::In => 25.4e-3,
        }
    }
}

/// Why an OBJ text is not a mesh.
#[derive(Debug, thiserror::Error)]
pub enum ObjError {
    /// Not text at all.
    #[error("not an OBJ file: byte {0} is not text")]
    NotText(usize),
    /// A line that does not say what its keyword promises.
    #[error("line {line}: {what}")]
    Line {
        /// Line number, from 1.
        line: usize,
        /// What is wrong with it.
        what: String,
    },
    /// The faces do not make a mesh.
    #[error(transparent)]
    Mesh(#[from] MeshError),
}

/// Reads the mesh of an OBJ file, scaled from `unit` to metres. Texture coordinates, normals, materials and groups are
/// passed over; all objects become one mesh.
///
/// # Errors
/// [`ObjError`], with the line or the face.
pub fn read_obj(bytes: &[u8], unit: Unit) -> Result<PolygonMesh, ObjError> {
    let text = std::str::from_utf8(bytes).map_err(|e| ObjError::NotText(e.valid_up_to()))?;
    if let Some(nul) = bytes.iter().position(|b| *b == 0) {
        return Err(ObjError::NotText(nul));
    }
    let mut positions = Vec::new();
    let mut faces = Vec::new();
    for (number, line) in text.lines().enumerate() {
        let fail = |what: String| ObjError::Line { line: number + 1, what };
        let mut words = line.split('#').next().unwrap_or("").split_whitespace();
        match words.next() {
            Some("v") => positions.push(unit.metres() * read_position(words).map_err(fail)?),
            Some("f") => faces.push(read_face(words, positions.len()).map_err(fail)?),
            _ => {}
        }
    }
    Ok(PolygonMesh::new(positions, &faces)?)
}

fn read_position<'a>(words: impl Iterator<Item = &'a str>) -> Result<DVec3, String> {
    let numbers = words
        .take(3)
        .map(|w| w.parse().map_err(|_| format!("'{w}' is not a number")))
        .collect::<Result<Vec<f64>, _>>()?;
    let [x, y, z] = numbers[..] else { return Err("a vertex needs three coordinates".into()) };
    let position = DVec3::new(x, y, z);
    if position.is_finite() { Ok(position) } else { Err("a coordinate is not a finite number".into()) }
}

/// Corners are `v`, `v/vt`, `v//vn` or `v/vt/vn`, from 1, or negative to count back from the last vertex so far.
fn read_face<'a>(words: impl Iterator<Item = &'a str>, vertices: usize) -> Result<Vec<u32>, String> {
    let corner = |word: &str| {
        let index: i64 = word
            .split('/')
            .next()
            .and_then(|w| w.parse().ok())
            .ok_or_else(|| format!("'{word}' is not a vertex of a face"))?;
        let from_zero = if index < 0 { vertices as i64 + index } else { index - 1 };
        if index == 0 || from_zero < 0 {
            return Err(format!("there is no vertex {index}"));
        }
        u32::try_from(from_zero).map_err(|_| format!("there is no vertex {index}"))
    };
    let corners = words.map(corner).collect::<Result<Vec<_>, String>>()?;
    if corners.len() < 3 {
        return Err(format!("a face needs three corners or more, this one has {}", corners.len()));
    }
    Ok(corners)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reads_polygons_in_any_notation() {
        let text = "# square and triangle\nv 0 0 0\nv 1 0 0\nv 1 1 0 # corner\nv 0 1 0\nv 2 0 0\no second\n\
                    f 1/1 2/2/2 3//3 4\nf -4 5 -3\n";
        let mesh = read_obj(text.as_bytes(), Unit::Cm).unwrap();
        assert_eq!(mesh.face_lists(), [vec![0, 1, 2, 3], vec![1, 4, 2]]);
        assert_eq!(mesh.positions()[4], DVec3::X * 0.02);
    }

    #[test]
    fn says_where_it_is_wrong() {
        let error = |text: &[u8]| read_obj(text, Unit::M).unwrap_err().to_string();
        assert_eq!(error(b""), "the mesh has no faces");
        assert_eq!(error(&[0x7f, b'E', 0xff]), "not an OBJ file: byte 2 is not text");
        assert_eq!(error(b"v 0 0 0\0"), "not an OBJ file: byte 7 is not text");
        assert_eq!(error(b"v 0 0\n"), "line 1: a vertex needs three coordinates");
        assert_eq!(error(b"\nv 0 nan 0\n"), "line 2: a coordinate is not a finite number");
        assert_eq!(error(b"v 0 0 0\nf 1 1\n"), "line 2: a face needs three corners or more, this one has 2");
        assert_eq!(error(b"v 0 0 0\nf 0 1 1\n"), "line 2: there is no vertex 0");
        assert!(error(b"v 0 0 0\nf 1 2 3\n").contains("names vertex 1, but there are only 1"));
    }
}
