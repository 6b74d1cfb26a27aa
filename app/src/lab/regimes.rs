//! The straight parts of a force curve.
//!
//! A fabric that is pulled meets three resistances after one another (Cirio et al., Fig. 11), each with a stiffness several
//! times the one before. The curve is cut into three parts, each fitted by a straight line of its own, where the sum of the
//! squared *relative* errors is least: a force a hundred times smaller counts as much as the largest.

/// A straight part of a force curve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Regime {
    /// Its first and last point.
    pub first: usize,
    pub last: usize,
    /// Slope [N/m].
    pub slope: f64,
    /// Force of the line at extension zero [N].
    pub offset: f64,
}

/// Points that a part has at least.
const LEAST: usize = 4;

/// The three parts of a curve of (extension [m], force [N]); none if it has too few points.
pub(super) fn three(points: &[[f64; 2]]) -> Option<[Regime; 3]> {
    let n = points.len();
    let most = points.iter().map(|p| p[1]).fold(0.0, f64::max);
    let mut best: Option<(f64, [Regime; 3])> = None;
    // A knee belongs to both parts that meet there.
    for i in LEAST - 1..n.saturating_sub(2 * LEAST - 2) {
        for j in i + LEAST - 1..n.saturating_sub(LEAST - 1) {
            let parts = [[0, i], [i, j], [j, n - 1]].map(|[a, b]| line(points, a, b, most));
            let error = parts.iter().map(|p| p.0).sum();
            if best.as_ref().is_none_or(|b| error < b.0) {
                best = Some((error, parts.map(|p| p.1)));
            }
        }
    }
    best.map(|b| b.1)
}

/// The line through the points from `first` to `last`, and the sum of its squared relative errors.
fn line(points: &[[f64; 2]], first: usize, last: usize, most: f64) -> (f64, Regime) {
    // Forces under a thousandth of the largest are noise.
    let weight = |f: f64| f.max(1e-3 * most).powi(-2);
    let part = &points[first..=last];
    let sum = |of: &dyn Fn(f64, f64) -> f64| part.iter().map(|[x, f]| weight(*f) * of(*x, *f)).sum::<f64>();
    let total = sum(&|_, _| 1.0);
    let (x, f) = (sum(&|x, _| x) / total, sum(&|_, f| f) / total);
    let slope = sum(&|a, b| (a - x) * (b - f)) / sum(&|a, _| (a - x).powi(2)).max(1e-30);
    let offset = f - slope * x;
    (sum(&|a, b| (b - offset - slope * a).powi(2)), Regime { first, last, slope, offset })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_curve_of_three_lines_is_found_again() {
        let force = |x: f64| 0.2 * x + 3.0 * (x - 0.02).max(0.0) + 40.0 * (x - 0.03).max(0.0);
        let points: Vec<[f64; 2]> = (1..=40).map(|i| 1e-3 * f64::from(i)).map(|x| [x, force(x)]).collect();
        let slopes = three(&points).unwrap().map(|r| r.slope);
        for (found, is) in slopes.iter().zip([0.2, 3.2, 43.2]) {
            assert!((found / is - 1.0).abs() < 1e-6, "{slopes:?}");
        }
        assert_eq!(three(&points).unwrap().map(|r| r.last), [19, 29, 39]);
        assert!(three(&points[..8]).is_none());
    }
}
