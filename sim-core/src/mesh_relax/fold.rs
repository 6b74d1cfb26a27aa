//! Folding of a corner: sub-quads keep their front up.
//!
//! # Theory
//! Not in the paper. Where far too many stitches crowd (the crown of a hat without enough decreases), in-plane springs are
//! at rest sooner with every other face folded under its neighbour, and yarn laid over such faces runs through itself. So a
//! corner with little area left resists. With a = xᵢ − xⱼ, b = xₖ − xⱼ, the normal n of the surface at j and s = n·(b × a),
//! in units of the area of a stitch:
//! - energy V = κ (ln(s₀/s) + s/s₀ − 1) for s < s₀, else zero; without bound as s → 0;
//! - gradient κ (1/s₀ − 1/s) ∇s with ∇s = (n × b, −n × b − a × n, a × n) on (i, j, k);
//! - stiffness κ/s² ∇s ∇sᵀ: Gauss–Newton; the rest, with ∇²s, is indefinite.
//!
//! Under s = s₀/5 the energy goes on as its Taylor polynomial of second degree, so that corners that are folded to begin with
//! are unfolded. n is held fast within a step. In space there is no front, and nothing of this.

use glam::DVec3;

/// s₀: corners larger than this feel nothing; at rest they have 1.
const FREE: f64 = 0.25;
const LEAST: f64 = 0.2 * FREE;

fn area([i, j, k]: [DVec3; 3], normal: DVec3) -> f64 {
    normal.dot((k - j).cross(i - j))
}

/// V/κ and its first two derivatives by s.
fn slopes(s: f64) -> [f64; 3] {
    if s >= FREE {
        return [0.0; 3];
    }
    let at = s.max(LEAST);
    let (value, slope, curvature) =
        ((FREE / at).ln() + at / FREE - 1.0, 1.0 / FREE - 1.0 / at, 1.0 / (at * at));
    let under = s - at;
    [value + under * (slope + 0.5 * curvature * under), slope + curvature * under, curvature]
}

/// V/κ at xᵢ, xⱼ, xₖ.
pub(super) fn energy(x: [DVec3; 3], normal: DVec3) -> f64 {
    if normal == DVec3::ZERO { 0.0 } else { slopes(area(x, normal))[0] }
}

/// Slope and curvature of V/κ by s, and ∇s: the gradient over κ is slope ∇s, the stiffness curvature ∇s ∇sᵀ. None where
/// nothing is felt.
pub(super) fn expand(x @ [i, j, k]: [DVec3; 3], normal: DVec3) -> Option<(f64, f64, [DVec3; 3])> {
    let s = area(x, normal);
    if normal == DVec3::ZERO || s >= FREE {
        return None;
    }
    let [_, slope, curvature] = slopes(s);
    let (at_i, at_k) = (normal.cross(k - j), (i - j).cross(normal));
    Some((slope, curvature, [at_i, -at_i - at_k, at_k]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::local::{Element, Local, point, put};
    use crate::testing::finite_difference::check_element;

    struct Fold(DVec3);

    impl Element<9> for Fold {
        fn energy(&self, q: &[f64; 9]) -> f64 {
            energy([0, 3, 6].map(|at| point(q, at)), self.0)
        }

        fn expand(&self, q: &[f64; 9]) -> Local<9> {
            let mut local = Local { energy: self.energy(q), ..Local::zero() };
            if let Some((slope, curvature, g)) = expand([0, 3, 6].map(|at| point(q, at)), self.0) {
                let mut flat = [0.0; 9];
                (0..3).for_each(|v| put(&mut flat, 3 * v, g[v]));
                local.gradient = flat.map(|g| slope * g);
                local.add_outer(curvature, &flat);
            }
            local
        }
    }

    #[test]
    fn derivatives_free_crowded_and_folded() {
        let normal = DVec3::new(0.1, -0.2, 1.0).normalize();
        for height in [1.0, 0.2, 0.08, 0.03, -0.4] {
            check_element(&Fold(normal), &[0.1, height, 0.2, 0.0, 0.1, 0.0, 0.9, 0.05, -0.1]);
        }
        let crowded = [0.0, 0.1, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0];
        assert!(Fold(DVec3::Z).energy(&crowded) > 0.0 && Fold(DVec3::ZERO).energy(&crowded) == 0.0);
        assert!(Fold(DVec3::Z).expand(&crowded).gradient[1] < 0.0, "more area is better");
    }
}
