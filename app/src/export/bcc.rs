//! BCC, the binary curve collection of the published stitch-mesh models: little-endian, Catmull–Rom control points, Y up.
//! It holds neither radius nor unit; the unit written is the metre.
//!
//! Readers evaluate an open curve between its second and its last point but one, so both ends are padded with the
//! reflection of the neighbouring point. The spline is uniform in the format ("C0"), centripetal here: the points are the
//! same, the curve between them differs by a fraction of the yarn's radius.

use stitch_mesh::yarn_curves::YarnCurves;

/// The file.
pub fn encode(curves: &YarnCurves) -> Vec<u8> {
    let mut body = Vec::new();
    let mut total = 0u64;
    for curve in &curves.curves {
        let mut points = curve.points.clone();
        if let (false, [first, second, .., before, last]) = (curve.closed, &curve.points[..]) {
            points.insert(0, 2.0 * *first - *second);
            points.push(2.0 * *last - *before);
        }
        let count = points.len() as i32;
        total += points.len() as u64;
        body.extend((if curve.closed { -count } else { count }).to_le_bytes());
        points.iter().flat_map(|p| p.to_array()).for_each(|x| body.extend(x.to_le_bytes()));
    }
    let mut file = b"BCC\x44C0\x03\x01".to_vec();
    file.extend((curves.curves.len() as u64).to_le_bytes());
    file.extend(total.to_le_bytes());
    let mut info = [0; 40];
    let text = b"Purlwise yarn, metres";
    info[..text.len()].copy_from_slice(text);
    file.extend(info);
    file.extend(body);
    file
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::export::sample;

    #[test]
    fn parses_to_the_last_byte() {
        let (curves, file) = (sample(), encode(&sample()));
        assert_eq!(&file[..8], b"BCC\x44C0\x03\x01");
        let u64_at = |i: usize| u64::from_le_bytes(file[i..i + 8].try_into().unwrap());
        assert_eq!((u64_at(8), u64_at(16)), (2, 7 + 4));
        let f32_at = |i: usize| f32::from_le_bytes(file[i..i + 4].try_into().unwrap());
        let mut at = 64;
        for curve in &curves.curves {
            let n = i32::from_le_bytes(file[at..at + 4].try_into().unwrap());
            assert_eq!(n < 0, curve.closed);
            let pad = if curve.closed { 0 } else { 1 };
            for (i, p) in curve.points.iter().enumerate() {
                let place = at + 4 + 12 * (i + pad);
                assert_eq!([f32_at(place), f32_at(place + 4), f32_at(place + 8)], p.to_array());
            }
            at += 4 + 12 * n.unsigned_abs() as usize;
        }
        assert_eq!(at, file.len());
    }
}
