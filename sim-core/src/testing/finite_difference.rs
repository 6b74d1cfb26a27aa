//! Gradients and Hessians against finite differences.

use crate::local::{Element, Local, point, put};
use crate::noise::unit_hash;
use glam::DVec3;

/// Relative error that a sound gradient stays under; a wrong sign or factor makes 0.1 and more.
const TOLERANCE: f64 = 2e-6;

/// `count` vectors of deterministic numbers in −1…1 (splitmix64 of the place).
pub(crate) fn samples<const N: usize>(count: usize) -> impl Iterator<Item = [f64; N]> {
    (0..count).map(|k| std::array::from_fn(|i| 2.0 * unit_hash((k * N + i) as u64) - 1.0))
}

/// Largest difference over the largest number.
fn relative(a: &[f64], b: &[f64]) -> f64 {
    let scale = a.iter().chain(b).fold(1e-300, |m: f64, x| m.max(x.abs()));
    a.iter().zip(b).fold(0.0, |m: f64, (x, y)| m.max((x - y).abs())) / scale
}

/// Fourth-order central difference of `f` at `q` along each place, with the step that suits the size of the element.
fn derivative<const N: usize, const M: usize>(
    q: &[f64; N],
    f: impl Fn(&[f64; N]) -> [f64; M],
) -> [[f64; N]; M] {
    let size = q.iter().fold(1e-12, |m: f64, x| m.max(x.abs()));
    let h = 3e-4 * size;
    let mut out = [[0.0; N]; M];
    for i in 0..N {
        let at = |k: f64| {
            let mut q = *q;
            q[i] += k * h;
            f(&q)
        };
        let (a, b, c, d) = (at(-2.0), at(-1.0), at(1.0), at(2.0));
        for j in 0..M {
            out[j][i] = (a[j] - 8.0 * b[j] + 8.0 * c[j] - d[j]) / (12.0 * h);
        }
    }
    out
}

/// Error of the gradient, relative to its largest part.
pub(crate) fn gradient_error<const N: usize>(element: &impl Element<N>, q: &[f64; N]) -> f64 {
    let [numeric] = derivative(q, |q| [element.energy(q)]);
    let Local { gradient: analytic, hessian, .. } = element.expand(q);
    // A gradient that happens to be zero has no scale of its own: compare with what a small step would make of it.
    let size = q.iter().fold(1e-12, |m: f64, x| m.max(x.abs()));
    let floor = 1e-3 * size * hessian.as_flattened().iter().fold(0.0, |m: f64, x| m.max(x.abs()));
    let scale = analytic.iter().fold(floor.max(1e-300), |m: f64, x| m.max(x.abs()));
    analytic.iter().zip(&numeric).fold(0.0, |m: f64, (x, y)| m.max((x - y).abs())) / scale
}

/// Gradient against the energy, energy against itself, Hessian symmetric and positive semi-definite.
#[track_caller]
pub(crate) fn check_element<const N: usize>(element: &impl Element<N>, q: &[f64; N]) {
    let local = element.expand(q);
    assert!((local.energy - element.energy(q)).abs() <= 1e-12 * local.energy.abs());
    let error = gradient_error(element, q);
    assert!(error < TOLERANCE, "gradient off by {error:.2e} at {q:?}");
    assert!(is_positive_semidefinite(&local.hessian), "indefinite at {q:?}");
}

/// The stiffness is the Hessian itself at q.
#[track_caller]
pub(crate) fn check_exact_hessian<const N: usize>(element: &impl Element<N>, q: &[f64; N]) {
    let numeric = derivative(q, |q| element.expand(q).gradient);
    let error = relative(element.expand(q).hessian.as_flattened(), numeric.as_flattened());
    assert!(error < 1e-5, "Hessian off by {error:.2e} at {q:?}");
}

/// `spin` is what the whole stiffness does to a rotation: the rest of it is blind to rotations.
#[track_caller]
pub(crate) fn check_spin<const N: usize, const K: usize>(
    element: &impl Element<N>,
    q: &[f64; N],
    omega: DVec3,
    points: [usize; K],
) {
    let mut v = [0.0; N];
    for at in points {
        put(&mut v, at, omega.cross(point(q, at)));
    }
    let hessian = element.expand(q).hessian;
    let expected = hessian.map(|row| row.iter().zip(&v).map(|(k, v)| k * v).sum::<f64>());
    let scale = hessian.as_flattened().iter().fold(0.0, |m: f64, x| m.max(x.abs()))
        * v.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
    for (a, b) in element.spin(q, omega).iter().zip(&expected) {
        assert!((a - b).abs() < 1e-9 * scale, "{a} against {b} at {q:?}");
    }
}

/// Whether a symmetric matrix has no eigenvalue under −1e-12 of its largest.
pub(crate) fn is_positive_semidefinite<const N: usize>(m: &[[f64; N]; N]) -> bool {
    let m = nalgebra::DMatrix::from_fn(N, N, |i, j| m[i][j]);
    let scale = m.amax();
    (m.clone() - m.transpose()).amax() <= 1e-12 * scale
        && m.symmetric_eigenvalues().iter().all(|e| *e >= -1e-12 * scale)
}

mod tests {
    use super::*;

    /// V = q₀² q₁ with a gradient that can be wrong.
    struct Probe {
        error: f64,
    }

    impl Element<2> for Probe {
        fn energy(&self, q: &[f64; 2]) -> f64 {
            q[0] * q[0] * q[1]
        }

        fn expand(&self, q: &[f64; 2]) -> Local<2> {
            let gradient = [2.0 * q[0] * q[1] * (1.0 + self.error), q[0] * q[0]];
            Local { energy: self.energy(q), gradient, ..Local::zero() }
        }
    }

    #[test]
    fn harness_passes_a_right_gradient_and_reports_a_wrong_one() {
        assert!(gradient_error(&Probe { error: 0.0 }, &[0.7, 1.3]) < TOLERANCE);
        assert!(gradient_error(&Probe { error: 1e-4 }, &[0.7, 1.3]) > TOLERANCE);
    }

    #[test]
    fn definiteness_is_told() {
        assert!(is_positive_semidefinite(&[[1.0, 1.0], [1.0, 1.0]]));
        assert!(!is_positive_semidefinite(&[[1.0, 2.0], [2.0, 1.0]]));
    }
}
