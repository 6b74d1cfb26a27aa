//! USD as text: cubic Catmull–Rom `BasisCurves`, open yarns in one prim, closed ones in another, since a prim has one wrap.
//! `pinned` makes an open curve pass its first and last points, so points map one to one. Widths are diameters.

use std::fmt::Write as _;
use stitch_mesh::yarn_curves::{YarnCurve, YarnCurves};

/// The file.
pub fn encode(curves: &YarnCurves) -> String {
    let mut text = String::from(
        "#usda 1.0\n(\n    defaultPrim = \"Yarn\"\n    metersPerUnit = 1\n    upAxis = \"Y\"\n)\n\ndef Xform \"Yarn\"\n{\n",
    );
    for (name, wrap, closed) in [("Open", "pinned", false), ("Closed", "periodic", true)] {
        let chosen: Vec<&YarnCurve> = curves.curves.iter().filter(|c| c.closed == closed).collect();
        if !chosen.is_empty() {
            prim(&mut text, name, wrap, &chosen);
        }
    }
    text.push_str("}\n");
    text
}

fn prim(text: &mut String, name: &str, wrap: &str, curves: &[&YarnCurve]) {
    let list = |items: Vec<String>| items.join(", ");
    let counts = list(curves.iter().map(|c| c.points.len().to_string()).collect());
    let tuple = |v: [f32; 3]| format!("({}, {}, {})", v[0], v[1], v[2]);
    let points = list(curves.iter().flat_map(|c| &c.points).map(|p| tuple(p.to_array())).collect());
    let colors = list(curves.iter().flat_map(|c| &c.dyes).map(|d| tuple(d.linear())).collect());
    let all = || curves.iter().flat_map(|c| c.points.iter());
    let low = all().fold(glam::Vec3::INFINITY, |a, p| a.min(*p));
    let high = all().fold(glam::Vec3::NEG_INFINITY, |a, p| a.max(*p));
    let radius = curves.iter().map(|c| c.greatest_radius()).fold(0.0, f32::max);
    let widths = list(curves.iter().flat_map(|c| &c.radii).map(|r| (2.0 * r).to_string()).collect());
    let extent = list(vec![tuple((low - radius).to_array()), tuple((high + radius).to_array())]);
    let _ = write!(
        text,
        "    def BasisCurves \"{name}\"\n    {{\n        uniform token type = \"cubic\"\n        uniform token basis = \
         \"catmullRom\"\n        uniform token wrap = \"{wrap}\"\n        int[] curveVertexCounts = [{counts}]\n        \
         point3f[] points = [{points}]\n        float3[] extent = [{extent}]\n        float[] widths = [{widths}] (\n            \
         interpolation = \"vertex\"\n        )\n        color3f[] primvars:displayColor = [{colors}] (\n            \
         interpolation = \"vertex\"\n        )\n    }}\n"
    );
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::export::sample;

    #[test]
    fn open_and_closed_yarns_have_prims_of_their_own() {
        let text = encode(&sample());
        assert!(text.contains("curveVertexCounts = [5]") && text.contains("curveVertexCounts = [4]"));
        assert!(text.contains("wrap = \"pinned\"") && text.contains("wrap = \"periodic\""));
        assert!(
            text.contains("widths = [0.004, 0.004, 0.004, 0.004]") && text.contains("(0.2, 0.04, -0.25)")
        );
        assert_eq!(text.matches('{').count(), text.matches('}').count());
    }
}
