//! Yarn curves out, in the formats of the field.

pub mod bcc;
pub mod obj;
pub mod usda;

use anyhow::{Result, bail};
use std::path::Path;
use stitch_mesh::yarn_curves::YarnCurves;

/// The curves in the format that the ending of `path` names.
///
/// # Errors
/// An ending that is none of them.
pub fn encode(curves: &YarnCurves, path: &Path) -> Result<Vec<u8>> {
    match path.extension().and_then(|e| e.to_str()) {
        Some("bcc") => Ok(bcc::encode(curves)),
        Some("obj") => Ok(obj::encode(curves).into_bytes()),
        Some("usda") => Ok(usda::encode(curves).into_bytes()),
        _ => bail!("cannot export to {}: the name has to end in .bcc, .obj or .usda", path.display()),
    }
}

#[cfg(test)]
pub(crate) fn sample() -> YarnCurves {
    use glam::Vec3;
    use stitch_mesh::yarn_curves::YarnCurve;
    let points: Vec<Vec3> = (0..5).map(|i| Vec3::new(i as f32 * 0.1, (i * i) as f32 * 0.01, -0.25)).collect();
    let open = YarnCurve::new(points.clone(), false, 0.002, stitch_mesh::dye::Dye([188, 137, 255]));
    let closed = YarnCurve::new(points[..4].to_vec(), true, 0.002, stitch_mesh::dye::Dye::UNDYED);
    YarnCurves { curves: vec![open, closed] }
}
