//! What is particular to woven cloth: crossings that shear, and yarn that climbs over other yarn.
//!
//! # Theory
//! **Shear.** Warp and weft at a crossing make four angles, each a [`Shear`] between a piece of either yarn.
//!
//! **Crimp.** The node of a crossing is its middle; a yarn that changes sides climbs c = 2R from one node to the next, and its
//! piece is that much longer than the way between them. So the length that [`crate::stretch`] reckons with is
//! l = √(|r|² + c²), and taut yarn pulls towards the back where it lies in front: Tc/l along the normal, T the tension.
//! Cirio et al. §4.3: "we offset nodes along the contact normal" to have the right normal force in planar cloth. The two
//! yarns of a crossing press each other with the mean of what they pull, which friction takes it from.
//!
//! # Practice
//! c is what the yarn was laid longer than straight, so a laid piece is at rest whatever its material.
//!
//! # Differences from the paper
//! c stays what it was: crimp is not handed over from a taut warp to the slack weft, nor pressed flat.

use crate::material::Material;
use crate::model::Stencil;
use crate::shear::Shear;
use glam::DVec3;
use smallvec::SmallVec;
use stitch_mesh::ids::VisitId;
use stitch_mesh::yarn_net::{NodeKind, YarnNet, YarnState};

/// Shear modulus over Young's modulus. With it plain cotton cloth of 1 mm yarns has a membrane shear stiffness of about 30 N/m,
/// in the middle of what the Kawabata system measures on apparel cloth (0.5 to 2 gf/cm per degree: 28 to 110 N/m).
const SHEAR_MODULUS: f64 = 5e-3;

/// The smallest distance of parallel yarns in their diameters that jamming is reckoned with.
const DENSEST: f64 = 1.02;

/// Two yarns at a crossing: the visits of a neighbour on one, both of the crossing, of a neighbour on the other.
#[derive(Clone, Debug)]
pub(crate) struct ShearTerm {
    pub stencil: Stencil<4>,
    /// Both yarns, as indices into [`crate::model::Model::dyes`].
    pub dyes: [u32; 2],
    /// φ₀ [rad].
    pub rest: f64,
    /// Length of either piece when laid [m].
    pub length: [f64; 2],
    /// c of either piece [m].
    pub climb: [f64; 2],
    /// Part that this term has in the pull of either piece: there are as many terms with it as the other yarn has pieces here.
    pub share: [f64; 2],
    /// +1 where the turn from the first piece to the second is counter-clockwise seen from the front, else −1.
    pub sense: f64,
}

impl ShearTerm {
    pub fn shear(&self, materials: &[Material]) -> Shear {
        let [a, b] = self.dyes.map(|dye| &materials[dye as usize]);
        let modulus = |m: &Material| SHEAR_MODULUS * m.young_modulus * m.radius * m.radius;
        let room = |yarn: &Material, between: f64| between / (2.0 * yarn.drawn_radius);
        let distance = room(a, self.length[1]).min(room(b, self.length[0])).max(DENSEST);
        Shear {
            stiffness: 0.5 * (modulus(a) + modulus(b)),
            // A crossing has a piece of half a length to each side of either yarn, and four angles.
            length: 0.125 * (self.length[0] + self.length[1]),
            rest: self.rest,
            jam: (1.0 / distance).acos(),
        }
    }

    /// What the pieces, being taut, pull their yarns against each other at the crossing [N].
    pub fn press(&self, materials: &[Material], state: &YarnState) -> [DVec3; 2] {
        let q: [f64; 16] = self.stencil.coordinates(state);
        let (_, n) = Shear::angle(&self.stencil.points(state));
        let pull = |piece: usize, [from, to]: [usize; 2]| {
            let stretch = materials[self.dyes[piece] as usize].stretch_stiffness();
            let r = DVec3::from_slice(&q[4 * from..]).distance(DVec3::from_slice(&q[4 * to..]));
            let l = r.hypot(self.climb[piece]);
            let yarn = (q[4 * from + 3] - q[4 * to + 3]).abs();
            let tension = stretch * (l / yarn - 1.0).max(0.0);
            self.share[piece] * tension * self.climb[piece] / l
        };
        [-self.sense * pull(0, [0, 1]) * n, self.sense * pull(1, [3, 2]) * n]
    }
}

/// c of a segment: what its yarn was laid longer than straight [m].
pub(crate) fn climb(net: &YarnNet, ends: [VisitId; 2], rest: f64) -> f64 {
    let [a, b] = ends.map(|v| &net.nodes[net.visits[v.index()].node.index()]);
    let woven = a.kind == NodeKind::Woven && b.kind == NodeKind::Woven;
    if woven { (rest * rest - a.position.distance_squared(b.position)).max(0.0).sqrt() } else { 0.0 }
}

/// The angles at all crossings of a net. `dye_of` tells the yarn of each visit.
pub(crate) fn shears(net: &YarnNet, dye_of: &[u32]) -> Vec<ShearTerm> {
    let laid = net.laid_state();
    let mut terms = Vec::new();
    for node in net.nodes.iter().filter(|n| n.kind == NodeKind::Woven) {
        let [front, behind] = node.visits[..] else { continue };
        let around = |visit: VisitId| -> SmallVec<[VisitId; 2]> {
            let woven = |v: &VisitId| net.nodes[net.visits[v.index()].node.index()].kind == NodeKind::Woven;
            [net.prev(visit), net.next(visit)].into_iter().flatten().filter(woven).collect()
        };
        let (of_front, of_behind) = (around(front), around(behind));
        for a in &of_front {
            for b in &of_behind {
                let stencil = Stencil::new(net, [*a, front, behind, *b], [0.0; 4]);
                let (rest, normal) = Shear::angle(&stencil.points(&laid));
                let u = |v: VisitId| net.visits[v.index()].u;
                let yarn = [(u(*a) - u(front)).abs(), (u(*b) - u(behind)).abs()];
                let climb = [climb(net, [*a, front], yarn[0]), climb(net, [*b, behind], yarn[1])];
                let place = |v: VisitId| net.nodes[net.visits[v.index()].node.index()].position;
                terms.push(ShearTerm {
                    stencil,
                    dyes: [front, behind].map(|v| dye_of[v.index()]),
                    rest,
                    length: [*a, *b].map(|v| place(v).distance(node.position)),
                    climb,
                    share: [1.0 / of_behind.len() as f64, 1.0 / of_front.len() as f64],
                    sense: if normal.dot(node.normal) < 0.0 { -1.0 } else { 1.0 },
                });
            }
        }
    }
    terms
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::materials::Materials;
    use crate::model::Model;
    use std::sync::Arc;
    use stitch_mesh::dye::Dye;
    use stitch_mesh::weave::Woven;

    fn cloth(draft: &str) -> (Woven, Model) {
        let piece = Woven {
            draft: draft.parse().unwrap(),
            ends: 9,
            picks: 9,
            spacing: 2e-3,
            warp: Dye::UNDYED.into(),
            weft: Dye([200, 30, 30]).into(),
            middle: DVec3::ZERO,
            flat: false,
        };
        let model = Model::new(Arc::new(piece.lay())).unwrap();
        (piece, model)
    }

    #[test]
    fn cloth_as_laid_is_at_rest() {
        for draft in ["plain", "twill", "satin"] {
            let (_, model) = cloth(draft);
            let materials = Materials::from(Material::for_loop_width(3.7e-3));
            let laid = model.net.laid_state();
            let mut stretched = laid.clone();
            stretched.position.iter_mut().for_each(|x| x.x *= 1.001);
            let energy = |state| model.energies(&materials, state).elastic();
            assert!(energy(&laid) < 1e-12 * energy(&stretched), "{draft}: {}", energy(&laid));
        }
    }

    #[test]
    fn inner_crossings_have_four_angles_and_corners_one() {
        let (_, model) = cloth("plain");
        let count = |node: u32| model.shears.iter().filter(|s| s.stencil.nodes[1].0 == node).count();
        assert_eq!([0, 1, 10, 40, 80].map(count), [1, 2, 4, 4, 1]);
    }

    #[test]
    fn taut_yarn_presses_by_its_crimp() {
        let (piece, model) = cloth("plain");
        let material = Material::for_loop_width(3.7e-3);
        let stiffness = material.stretch_stiffness();
        let mut state = model.net.laid_state();
        state.position.iter_mut().for_each(|x| *x *= 1.01);
        let climb = 2.0 * piece.radius();
        let (way, yarn) = (1.01 * piece.spacing, piece.spacing.hypot(climb));
        let length = way.hypot(climb);
        let expected = 2.0 * stiffness * (length / yarn - 1.0) * climb / length;
        let turn = glam::DQuat::from_rotation_x(1.0);
        state.position.iter_mut().for_each(|x| *x = turn * *x);
        for node in [10, 30, 40] {
            let terms = model.shears.iter().filter(|s| s.stencil.nodes[1].0 == node);
            let press = terms.map(|s| s.press(&[material.clone(), material.clone()], &state));
            let [front, behind] = press.fold([DVec3::ZERO; 2], |[a, b], [c, d]| [a + c, b + d]);
            let back = turn * DVec3::NEG_Z;
            assert!(front.distance(expected * back) < 1e-9 * expected, "{front} for {expected}");
            assert!(behind.distance(-expected * back) < 1e-9 * expected);
        }
    }

    #[test]
    fn shear_locks_where_neighbours_touch() {
        let (piece, model) = cloth("plain");
        let mut material = Material::for_loop_width(3.7e-3);
        material.drawn_radius = piece.radius();
        let shear = model.shears[0].shear(&[material.clone(), material]);
        assert!((piece.spacing * shear.jam.cos() - 2.0 * piece.radius()).abs() < 1e-12);
        assert!((shear.rest - std::f64::consts::FRAC_PI_2).abs() < 1e-12);
    }
}
