//! The wale strut: wale edges of consecutive rows want to go on straight, so that stitches stand in columns.
//!
//! # Theory
//! Yuksel et al. eq. 4: wale edges i–j and j–k that follow each other push i and k apart with κ (1 − d/r), where
//! d = |xᵢ − xₖ| and r = max(r_wale, |xᵢ − xⱼ| + |xₖ − xⱼ|) is their distance if the wale were straight. With s = r − d ≥ 0:
//! - energy V = κ s² / 2r, zero when straight; with g = s/r, it grows as the fourth power of the angle;
//! - gradient κ (g ∇s − g²/2 ∇r);
//! - stiffness κ/r ∇s ∇sᵀ + κ (g − g²/2) ∇²r: Gauss–Newton in s, and of what remains the part that is positive
//!   semi-definite, the pull of the two wale edges across themselves, ∇²|xᵢ − xⱼ| = (I − eeᵀ)/|xᵢ − xⱼ|.
//!
//! # Differences from the paper
//! The paper's force is −κ g ∇s with r held fast: it pushes i and k apart and leaves it to the wale edges, stretched by it,
//! to pull j in. Here r moves along, and the same κ g acts on j at once: the wale is straightened as much, but is not
//! stretched for it (on a curved surface, where no wale is straight, the paper's version lengthens all of them). And it is the
//! gradient of an energy.

use glam::DVec3;

/// Lengths are held above this in denominators, in stitches.
const LEAST: f64 = 1e-6;

struct Lengths {
    /// r and whether it is the sum of the edges, which moves with them.
    straight: f64,
    moves: bool,
    /// d.
    chord: f64,
}

fn lengths([i, j, k]: [DVec3; 3], rest: f64) -> Lengths {
    let sum = i.distance(j) + k.distance(j);
    Lengths { straight: sum.max(rest), moves: sum > rest, chord: i.distance(k) }
}

/// V/κ at xᵢ, xⱼ, xₖ, with r_wale.
pub(super) fn energy(x: [DVec3; 3], rest: f64) -> f64 {
    let Lengths { straight, chord, .. } = lengths(x, rest);
    0.5 * (straight - chord).powi(2) / straight
}

/// The strut at one place, over κ.
pub(super) struct Expanded {
    /// ∇V, on i, j, k.
    pub gradient: [DVec3; 3],
    /// The stiffness ∇s ∇sᵀ `along`: 1/r.
    pub along: f64,
    /// ∇s, on i, j, k.
    pub s: [DVec3; 3],
    /// The stiffness (I − eeᵀ) `across` of the edges i–j and k–j.
    pub across: [f64; 2],
    /// Their directions e, away from j.
    pub e: [DVec3; 2],
}

/// Gradient and stiffness at xᵢ, xⱼ, xₖ, with r_wale.
pub(super) fn expand(x @ [i, j, k]: [DVec3; 3], rest: f64) -> Expanded {
    let Lengths { straight, moves, chord } = lengths(x, rest);
    let moving = if moves { 1.0 } else { 0.0 };
    let edges = [i - j, k - j];
    let e = edges.map(|edge| edge.normalize_or_zero() * moving);
    let apart = if chord > LEAST { (i - k) / chord } else { DVec3::ZERO };
    let r = [e[0], -e[0] - e[1], e[1]];
    let s = [r[0] - apart, r[1], r[2] + apart];
    let g = (straight - chord) / straight;
    let gradient = std::array::from_fn(|v| g * s[v] - 0.5 * g * g * r[v]);
    let pull = moving * (g - 0.5 * g * g).max(0.0);
    Expanded {
        gradient,
        along: 1.0 / straight,
        s,
        across: edges.map(|edge| pull / edge.length().max(LEAST)),
        e,
    }
}
