//! Mean value coordinates: a point inside a polygon as a weighted mean of its corners.
//!
//! Floater, *Mean Value Coordinates* (2003): wᵢ = (tan(αᵢ₋₁/2) + tan(αᵢ/2)) / rᵢ, with rᵢ the distance to corner i and αᵢ
//! the angle under which edge i is seen. On an edge they are linear, so what is placed with them on neighbouring faces
//! meets; they need no triangulation and no convexity. Both the tessellation and the yarn of a stitch are placed this way:
//! in a flat reference polygon first, then with the same weights on the polygon in space.

use glam::DVec2;

/// Weights of the corners for `point`; they sum to one. Exact on corners and edges.
pub fn mean_value_weights(polygon: &[DVec2], point: DVec2) -> Vec<f64> {
    let n = polygon.len();
    let to: Vec<DVec2> = polygon.iter().map(|p| *p - point).collect();
    let mut weights = vec![0.0; n];
    // Closer to a corner or an edge than this fraction of the reference square, the point is on it.
    const ON: f64 = 1e-9;
    if let Some(corner) = to.iter().position(|d| d.length() < ON) {
        weights[corner] = 1.0;
        return weights;
    }
    let mut half_tangents = vec![0.0; n];
    for i in 0..n {
        let (a, b) = (to[i], to[(i + 1) % n]);
        let (cross, dot) = (a.perp_dot(b), a.dot(b));
        if cross.abs() < ON && dot < 0.0 {
            let (ra, rb) = (a.length(), b.length());
            weights[i] = rb / (ra + rb);
            weights[(i + 1) % n] = ra / (ra + rb);
            return weights;
        }
        // tan(α/2) = sin α / (1 + cos α), with sine and cosine scaled by |a||b|.
        half_tangents[i] = cross / (a.length() * b.length() + dot);
    }
    for i in 0..n {
        weights[i] = (half_tangents[(i + n - 1) % n] + half_tangents[i]) / to[i].length();
    }
    let sum: f64 = weights.iter().sum();
    weights.iter_mut().for_each(|w| *w /= sum);
    weights
}

/// The reference polygon of a face with `bottoms` and `tops` edges: the unit square, its lower side cut into the bottoms,
/// its upper side into the tops. Starts at the lower left corner and runs counter-clockwise, as faces of a stitch mesh do.
/// A side without edges is a single corner in its middle.
pub fn reference_polygon(bottoms: usize, tops: usize) -> Vec<DVec2> {
    let side = |count: usize, t: f64| {
        (0..=count).map(move |i| {
            let s = if count == 0 { 0.5 } else { i as f64 / count as f64 };
            DVec2::new(s, t)
        })
    };
    let mut polygon: Vec<DVec2> = side(bottoms, 0.0).collect();
    let upper: Vec<DVec2> = side(tops, 1.0).collect();
    polygon.extend(upper.into_iter().rev());
    polygon
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn weights_sum_to_one_and_reproduce_the_point(
            bottoms in 0usize..4, tops in 1usize..4, s in 0.2..0.8, t in 0.3..0.9,
        ) {
            let polygon = reference_polygon(bottoms, tops);
            let point = DVec2::new(0.5 + (s - 0.5) * t * 0.9, t); // inside the triangle as well
            let weights = mean_value_weights(&polygon, point);
            let back: DVec2 = polygon.iter().zip(&weights).map(|(p, w)| *p * *w).sum();
            prop_assert!((weights.iter().sum::<f64>() - 1.0).abs() < 1e-12);
            prop_assert!((back - point).length() < 1e-9);
        }

        #[test]
        fn linear_on_edges(s in 0.0..1.0) {
            let polygon = reference_polygon(1, 2);
            let weights = mean_value_weights(&polygon, DVec2::new(s, 0.0));
            prop_assert!((weights[1] - s).abs() < 1e-9 && (weights[0] - (1.0 - s)).abs() < 1e-9);
        }
    }
}
