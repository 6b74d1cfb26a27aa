//! Friction of yarns sliding at their nodes.
//!
//! # Theory
//! **Compression.** Cirio et al. §4.3, eq. 3–4. Neighbours i, i + 1 of a stack, front to back, press each other with λᵢ ≥ 0
//! along dᵢ, which points from i to i + 1. With Fᵢ the stretch and bend force of yarn i at the node the net force on it is
//! fᵢ = Fᵢ + λᵢ₋₁ dᵢ₋₁ − λᵢ dᵢ, and the λ are those that leave the least Σ |fᵢ|²: non-negative least squares with the
//! tridiagonal matrix (AᵀA)ᵢᵢ = 2, (AᵀA)ᵢ,ᵢ₊₁ = −dᵢ·dᵢ₊₁ and the right-hand side (Fᵢ − Fᵢ₊₁)·dᵢ.
//!
//! **Friction.** §4.4: an anchor ū for every yarn that crosses its neighbour, and a spring k_f (u − ū) limited by μλ. Yarns
//! that lie parallel in a stack, as the old loops of a decrease, slide along the same axis, so between them the spring
//! is on the difference: k_f (Δu − Δū) with Δu = uᵢ − uᵢ₊₁, limited by μλᵢ (eq. 5).
//!
//! # Differences from the paper
//! - Where yarns cross, dᵢ is the direction of their contact force itself: of the vectors Λᵢ that solve the same problem
//!   without a direction given, −Λᵢ₋₁ + 2Λᵢ − Λᵢ₊₁ = Fᵢ − Fᵢ₊₁ (two yarns: Λ = (F₀ − F₁)/2). Yarns wrapped around each other
//!   press in every direction across their axis, and with the part along a fitted normal alone rows slide into a herringbone
//!   lean. Between parallel yarns dᵢ is the fitted normal.
//! - Eq. 4 clips −Aᵀb before it multiplies by (AᵀA)⁻¹, which can leave a λ below what any admissible one would be; here the
//!   least squares are solved, by projected Gauss–Seidel.
//! - Slipping friction is not an explicit force of size μλ (with it u runs away within ten steps) but the secant spring
//!   k = min(k_f, μλ/|u − ū + h u̇|), in the force and in the matrix.
//! - μ and λ₀ are those of the two yarns that touch (`materials.rs`), so a yarn inside of a stack is held by each of its faces
//!   as that one can. λ₀ comes on top of every λ.

use glam::DVec3;
use smallvec::SmallVec;
use stitch_mesh::ids::VisitId;
use stitch_mesh::yarn_net::YarnNet;

/// Sweeps of projected Gauss–Seidel at most; five yarns need some thirty for 1e-12.
pub(crate) const SWEEPS: usize = 100;

/// One number or vector for each yarn or contact of a stack.
pub(crate) type PerYarn<T> = SmallVec<[T; 4]>;

/// The yarns at a node with at least two.
#[derive(Clone, Debug)]
pub(crate) struct Stack {
    /// Index of the node.
    pub node: usize,
    /// Its yarns, front to back.
    pub visits: PerYarn<VisitId>,
    /// Whether each yarn lies parallel to the one behind it, [visits − 1].
    pub parallel: PerYarn<bool>,
}

impl Stack {
    /// The stacks of a net.
    pub fn all(net: &YarnNet) -> Vec<Self> {
        // The contact and end at which a visit is an old loop: two with the same lie parallel.
        let mut old = vec![None; net.visits.len()];
        for (contact, c) in net.contacts.iter().enumerate() {
            for ends in &c.old {
                ends.iter().enumerate().for_each(|(end, v)| old[v.index()] = Some((contact, end)));
            }
        }
        let parallel = |a: VisitId, b: VisitId| old[a.index()].is_some() && old[a.index()] == old[b.index()];
        let stack = |(node, n): (usize, &stitch_mesh::yarn_net::Node)| Self {
            node,
            visits: n.visits.iter().copied().collect(),
            parallel: n.visits.windows(2).map(|w| parallel(w[0], w[1])).collect(),
        };
        net.nodes.iter().enumerate().filter(|(_, n)| n.slides()).map(stack).collect()
    }

    /// The parallel neighbours in it, front first.
    fn pairs(&self) -> impl Iterator<Item = [VisitId; 2]> + '_ {
        let neighbours = self.visits.windows(2).zip(&self.parallel);
        neighbours.filter(|(_, parallel)| **parallel).map(|(pair, _)| [pair[0], pair[1]])
    }

    /// λ of each contact, cohesion not included [N], from the force of each yarn at the node [N] and the direction from front
    /// to back there.
    pub fn compression(&self, pull: &[DVec3], back: DVec3) -> PerYarn<f64> {
        let whole = contact_forces(pull);
        let direction: PerYarn<DVec3> = whole
            .iter()
            .zip(&self.parallel)
            .map(|(force, parallel)| if *parallel { back } else { force.normalize_or_zero() })
            .collect();
        let mut lambda: PerYarn<f64> =
            whole.iter().zip(&direction).map(|(force, d)| force.dot(*d).max(0.0)).collect();
        if lambda.len() < 2 {
            return lambda;
        }
        for _ in 0..SWEEPS {
            let mut change = 0.0_f64;
            for i in 0..lambda.len() {
                let from = |k: usize| lambda[k] * direction[k].dot(direction[i]);
                let neighbours = if i > 0 { from(i - 1) } else { 0.0 }
                    + if i + 1 < lambda.len() { from(i + 1) } else { 0.0 };
                let best = 0.5 * ((pull[i] - pull[i + 1]).dot(direction[i]) + neighbours);
                change = change.max((best.max(0.0) - lambda[i]).abs());
                lambda[i] = best.max(0.0);
            }
            if change < 1e-12 {
                break;
            }
        }
        lambda
    }
}

/// Λ, the forces between neighbours that leave the least net force, in any direction [contacts] [N].
fn contact_forces(pull: &[DVec3]) -> PerYarn<DVec3> {
    // Thomas' algorithm for the tridiagonal system: (pivot, right-hand side) going down, solution going up.
    let mut rows: PerYarn<(f64, DVec3)> = PerYarn::new();
    for pair in pull.windows(2) {
        let rhs = pair[0] - pair[1];
        let (pivot, above) = rows.last().copied().unwrap_or((f64::INFINITY, DVec3::ZERO));
        rows.push((2.0 - 1.0 / pivot, rhs + above / pivot));
    }
    let mut forces: PerYarn<DVec3> = rows.iter().map(|(_, rhs)| *rhs).collect();
    let mut below = DVec3::ZERO;
    for (force, (pivot, rhs)) in forces.iter_mut().zip(&rows).rev() {
        below = (*rhs + below) / *pivot;
        *force = below;
    }
    forces
}

/// Where yarns stick.
#[derive(Clone, Debug, Default)]
pub(crate) struct Anchors {
    /// ū of each visit against what crosses it, [visit_count] [m].
    pub own: Vec<f64>,
    /// Δū of each visit and the parallel one behind it; without meaning where there is none, [visit_count] [m].
    pub between: Vec<f64>,
}

impl Anchors {
    /// Yarns that stick where they are.
    pub fn at(stacks: &[Stack], sliding: &[f64]) -> Self {
        let mut anchors = Self { own: sliding.to_vec(), between: vec![0.0; sliding.len()] };
        for pair in stacks.iter().flat_map(Stack::pairs) {
            anchors.between[pair[0].index()] = sliding[pair[0].index()] - sliding[pair[1].index()];
        }
        anchors
    }

    /// These anchors on a net made of this one: `was` tells which visit each one was and by how much it was moved. What is new
    /// sticks where it is, at `sliding`.
    pub fn carried(&self, stacks: &[Stack], was: &[Option<(VisitId, f64)>], sliding: &[f64]) -> Self {
        let mut anchors = Self::at(stacks, sliding);
        for (anchor, was) in anchors.own.iter_mut().zip(was) {
            if let Some((visit, shift)) = was {
                *anchor = self.own[visit.index()] + shift;
            }
        }
        anchors
    }

    /// Moves the anchors with yarn that is taken in: visit by visit by `shift` [m].
    pub fn shift(&mut self, stacks: &[Stack], shift: impl Fn(usize) -> f64) {
        self.own.iter_mut().enumerate().for_each(|(v, anchor)| *anchor += shift(v));
        for [front, behind] in stacks.iter().flat_map(Stack::pairs) {
            self.between[front.index()] += shift(front.index()) - shift(behind.index());
        }
    }

    /// Energy of the springs that stick, where `stick` is the stiffness of each visit's [J].
    pub fn energy(&self, stacks: &[Stack], sliding: &[f64], stick: impl Fn(VisitId) -> f64) -> f64 {
        let of = |stack: &Stack| {
            let crosses = |i: usize| {
                let beside = [i.checked_sub(1), Some(i)].into_iter().flatten();
                beside.filter_map(|i| stack.parallel.get(i)).any(|parallel| !parallel)
            };
            let visits = stack.visits.iter().enumerate().filter(|(i, _)| crosses(*i));
            let own = visits.map(|(_, v)| (*v, sliding[v.index()] - self.own[v.index()]));
            let between = stack
                .pairs()
                .map(|[a, b]| (a, sliding[a.index()] - sliding[b.index()] - self.between[a.index()]));
            own.chain(between).map(|(v, stretch)| 0.5 * stick(v) * stretch * stretch).sum::<f64>()
        };
        stacks.iter().map(of).sum()
    }
}

/// The spring that stands for friction during one step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct FrictionSpring {
    /// ū, moved so that the spring does not pull harder than friction [m].
    pub anchor: f64,
    /// k [N/m].
    pub stiffness: f64,
}

impl FrictionSpring {
    /// The spring for something at `u` that slides with `rate` where friction holds up to `limit`, and sticks with `stick`
    /// [N/m], in a step `h`.
    pub fn new(anchor: f64, u: f64, rate: f64, limit: f64, h: f64, stick: f64) -> Self {
        let reach = limit / stick.max(1e-12);
        let anchor = anchor.clamp(u - reach, u + reach);
        let stretch = (u - anchor + h * rate).abs();
        Self { anchor, stiffness: stick.min(limit / stretch.max(1e-12)) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn stack(parallel: &[bool]) -> Stack {
        let visits = (0..=parallel.len() as u32).map(VisitId).collect();
        Stack { node: 0, visits, parallel: parallel.iter().copied().collect() }
    }

    /// Σ |fᵢ|² for given λ.
    fn left(pull: &[DVec3], direction: &[DVec3], lambda: &[f64]) -> f64 {
        let push = |i: usize| lambda.get(i).map_or(DVec3::ZERO, |l| *l * direction[i]);
        let net = |i: usize| pull[i] - push(i) + if i > 0 { push(i - 1) } else { DVec3::ZERO };
        (0..pull.len()).map(|i| net(i).length_squared()).sum()
    }

    #[test]
    fn two_yarns_press_each_other_with_half_the_difference() {
        let pull = [DVec3::new(0.0, 1.0, -2.0), DVec3::new(0.0, 1.0, 4.0)];
        assert_eq!(stack(&[false]).compression(&pull, DVec3::Z).as_slice(), [3.0]);
        // Parallel yarns that pull each other apart do not press.
        assert_eq!(stack(&[true]).compression(&pull, DVec3::Z).as_slice(), [0.0]);
        assert_eq!(stack(&[true]).compression(&pull, DVec3::NEG_Z).as_slice(), [3.0]);
    }

    #[test]
    fn compression_leaves_the_least_net_force_that_no_sticking_allows() {
        let back = DVec3::new(0.6, 0.0, 0.8);
        let number = |i: u64| crate::noise::unit_hash(i) - 0.5;
        for case in 0..200 {
            let pull: Vec<DVec3> = (0..4)
                .map(|i| DVec3::from_array(std::array::from_fn(|k| number(12 * case + 3 * i + k as u64))))
                .collect();
            let stack = stack(&[true, true, false]);
            let lambda = stack.compression(&pull, back);
            let crossing = contact_forces(&pull)[2].normalize();
            let direction = [back, back, crossing];
            let least = left(&pull, &direction, &lambda);
            assert!(lambda.iter().all(|l| *l >= 0.0));
            // No admissible change of one or of all makes it less.
            for trial in 0..60 {
                let changed: Vec<f64> = (0..3)
                    .map(|i| (lambda[i] + 0.1 * number(7_000 + 3 * trial + i as u64)).max(0.0))
                    .collect();
                assert!(left(&pull, &direction, &changed) >= least - 1e-12);
            }
        }
    }

    #[test]
    fn friction_sticks_and_slips() {
        let stick = FrictionSpring::new(0.0, 1e-3, 0.0, 0.5, 1e-3, 100.0);
        assert_eq!(stick, FrictionSpring { anchor: 0.0, stiffness: 100.0 });
        let slip = FrictionSpring::new(0.0, 0.1, 1.0, 0.5, 1e-2, 100.0);
        assert!((slip.anchor - 0.095).abs() < 1e-15);
        assert!((slip.stiffness * (0.1 - slip.anchor + 1e-2) - 0.5).abs() < 1e-12, "pulls with μλ");
        let free = FrictionSpring::new(0.0, 0.1, 1.0, 0.0, 1e-2, 100.0);
        assert_eq!((free.anchor, free.stiffness), (0.1, 0.0));
    }
}
