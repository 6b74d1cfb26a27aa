//! OBJ: the control points as vertices, each yarn as a line; a closed one ends with its first point.

use std::fmt::Write as _;
use stitch_mesh::yarn_curves::YarnCurves;

/// The file.
pub fn encode(curves: &YarnCurves) -> String {
    let mut text = String::from("# Purlwise yarn, metres\n");
    let mut first = 1;
    for (i, curve) in curves.curves.iter().enumerate() {
        let _ = writeln!(text, "o yarn{i}");
        for p in &curve.points {
            let _ = writeln!(text, "v {} {} {}", p.x, p.y, p.z);
        }
        text.push('l');
        (first..first + curve.points.len()).for_each(|v| {
            let _ = write!(text, " {v}");
        });
        if curve.closed {
            let _ = write!(text, " {first}");
        }
        text.push('\n');
        first += curve.points.len();
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::export::sample;

    #[test]
    fn lines_name_their_vertices() {
        let text = encode(&sample());
        let lines: Vec<&str> = text.lines().filter(|l| l.starts_with('l')).collect();
        assert_eq!(lines, ["l 1 2 3 4 5", "l 6 7 8 9 6"]);
        assert_eq!(text.lines().filter(|l| l.starts_with("v ")).count(), 9);
        assert!(text.contains("v 0.2 0.04 -0.25\n"));
    }
}
