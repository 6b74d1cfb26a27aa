//! The elements of a net, and the layout of its unknowns.
//!
//! # Theory
//! A node with n ≥ 2 visits has 3 + n unknowns (x, u₁, …, uₙ); a node with one visit has 3, its u is frozen, and so
//! has a node of a seam, where nothing slides. Elements:
//!
//! | element | one for each |
//! |---|---|
//! | [`SegmentTerm`] | segment: mass, stretch, gravity, and contact length or parallel contact |
//! | [`BendTerm`] | pair of consecutive segments |
//! | [`WrapTerm`] | pair of opposite outer segments at a stitch contact, between its new yarn and each old one |
//! | [`ShearTerm`] | angle between warp and weft at a crossing of woven cloth |
//!
//! Parallel old yarns of a decrease do not wrap around each other. At the end of a yarn, where an outer segment is
//! missing, its quad is left out. Between them these elements join the inside of a plain knit with at most eleven node
//! blocks a block row (Cirio et al. §5).
//!
//! # Practice
//! A model holds what follows from the net alone: who takes part, rest lengths and rest angles. Stiffnesses come from the
//! [`Material`] of the element's yarn when it is evaluated, so changing a material rebuilds nothing; a stitch may alter what its
//! material says of wrapping ([`WrapTerm::wrap`]). It lives as long as its net.

use crate::bend::Bend;
use crate::material::Material;
use crate::materials::Materials;
use crate::spacing::Spacing;
use crate::stretch::Stretch;
use crate::surgery::slip;
use crate::woven::{ShearTerm, climb, shears};
use crate::wrap::Wrap;
use glam::DVec3;
use std::collections::{HashMap, HashSet};
use std::f64::consts::FRAC_PI_2;
use std::sync::Arc;
use stitch_mesh::dye::Dye;
use stitch_mesh::ids::{NodeId, VisitId};
use stitch_mesh::wrapping::Wrapping;
use stitch_mesh::yarn_net::{NodeKind, YarnNet, YarnState};

/// Angle between a bend at rest and the onset of its jamming [rad].
const JAM_MARGIN: f64 = 0.05;

/// Marks a sliding coordinate that is no unknown.
pub(crate) const FROZEN: u32 = u32::MAX;

/// A net that can't be simulated.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum NetError {
    /// A node that no yarn passes.
    #[error("node {0} has no visit")]
    BareNode(NodeId),
    /// A position or sliding coordinate that is infinite or NaN.
    #[error("the net is not finite at node {0}")]
    NotFinite(NodeId),
    /// Two consecutive visits of a yarn without yarn between them.
    #[error("the yarn between visits {0} and {1} has the length {2} m, and must have some")]
    NoYarn(VisitId, VisitId, f64),
    /// A stitch contact whose ends do not follow each other on a yarn.
    #[error("contact {contact}: visits {} and {} are not neighbours on a yarn", .ends[0], .ends[1])]
    BrokenContact {
        /// The contact.
        contact: usize,
        /// The visits at its ends.
        ends: [VisitId; 2],
    },
}

/// Visits that an element joins.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Stencil<const K: usize> {
    /// The visits.
    pub visits: [VisitId; K],
    /// Their nodes.
    pub nodes: [NodeId; K],
    /// Added to each sliding coordinate: a period beyond the seam of a closed yarn [m].
    pub turn: [f64; K],
}

impl<const K: usize> Stencil<K> {
    pub fn new(net: &YarnNet, visits: [VisitId; K], turn: [f64; K]) -> Self {
        Self { visits, nodes: visits.map(|v| net.visits[v.index()].node), turn }
    }

    /// Local vector of (x, u) for each visit.
    #[inline(always)]
    pub fn coordinates<const N: usize>(&self, state: &YarnState) -> [f64; N] {
        self.gather(|k| {
            (state.position[self.nodes[k].index()], state.sliding[self.visits[k].index()] + self.turn[k])
        })
    }

    /// Local vector of (v, u̇) for each visit.
    #[inline(always)]
    pub fn velocities<const N: usize>(&self, state: &YarnState) -> [f64; N] {
        self.gather(|k| {
            (state.velocity[self.nodes[k].index()], state.sliding_velocity[self.visits[k].index()])
        })
    }

    /// Local vector of the positions alone.
    #[inline(always)]
    pub fn points<const N: usize>(&self, state: &YarnState) -> [f64; N] {
        let mut out = [0.0; N];
        for k in 0..K {
            out[3 * k..3 * k + 3].copy_from_slice(&state.position[self.nodes[k].index()].to_array());
        }
        out
    }

    #[inline(always)]
    fn gather<const N: usize>(&self, of: impl Fn(usize) -> (DVec3, f64)) -> [f64; N] {
        let mut out = [0.0; N];
        for k in 0..K {
            let (x, u) = of(k);
            out[4 * k..4 * k + 3].copy_from_slice(&x.to_array());
            out[4 * k + 3] = u;
        }
        out
    }
}

/// A segment.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SegmentTerm {
    pub stencil: Stencil<2>,
    /// Its yarn, as an index into [`Model::dyes`].
    pub dye: u32,
    /// Δu when laid [m].
    pub rest: f64,
    /// c, how far it climbs over or under other yarn in woven cloth [m].
    pub climb: f64,
    /// Whether it lies in a stitch contact.
    pub in_contact: bool,
    /// How close its ends may come along the yarn, over the parallel distance: half at nodes where yarns only cross, which
    /// lie closer; twice between two nodes of sewing yarn, which are as thick as it is; zero next to a loose node, up to which it
    /// slides.
    pub closeness: f64,
}

impl SegmentTerm {
    pub fn stretch(&self, material: &Material) -> Stretch {
        Stretch { stiffness: material.stretch_stiffness(), climb: self.climb }
    }

    /// The force on Δu alone: contact length inside of a stitch contact, parallel contact elsewhere.
    pub fn spacing(&self, material: &Material) -> Spacing {
        if self.in_contact {
            Spacing::contact(material, self.rest)
        } else {
            Spacing::free(material, self.closeness, self.rest)
        }
    }
}

/// Two consecutive segments.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BendTerm {
    pub stencil: Stencil<3>,
    /// Its yarn, as an index into [`Model::dyes`].
    pub dye: u32,
    /// Angle at which jamming starts [rad].
    pub jam_angle: f64,
}

impl BendTerm {
    pub fn bend(&self, material: &Material) -> Bend {
        Bend { stiffness: material.bend_stiffness(), jam_angle: self.jam_angle }
    }
}

/// Two opposite outer segments of a stitch contact: the points x₄, x₀, x₁, x₃ of `wrap.rs`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct WrapTerm {
    pub stencil: Stencil<4>,
    /// The yarn that forms the new loop, as an index into [`Model::dyes`].
    pub dye: u32,
    /// σ, the handedness of the contact.
    pub handedness: f64,
    /// What its stitch makes of stiffness and rest angle.
    pub wrapping: Wrapping,
    /// L, rest length of the contact [m].
    pub rest: f64,
}

impl WrapTerm {
    pub fn wrap(&self, material: &Material) -> Wrap {
        let Wrapping { modulus, angle } = self.wrapping;
        Wrap {
            stiffness: modulus * material.wrap_stiffness * self.rest,
            rest: self.handedness * angle.unwrap_or(material.wrap_angle),
            fade: material.wrap_fade,
        }
    }
}

/// Elements and layout of unknowns of one net.
#[derive(Clone, Debug)]
pub struct Model {
    pub(crate) net: Arc<YarnNet>,
    /// The colours of its yarns.
    pub(crate) dyes: Vec<Dye>,
    /// The yarn of each visit, as an index into them, [visit_count].
    pub(crate) dye_of: Vec<u32>,
    pub(crate) segments: Vec<SegmentTerm>,
    pub(crate) bends: Vec<BendTerm>,
    pub(crate) wraps: Vec<WrapTerm>,
    pub(crate) shears: Vec<ShearTerm>,
    /// First unknown of each node, and the number of unknowns at the end, [node_count + 1].
    pub(crate) start: Vec<u32>,
    /// Visits of the nodes before each, so place of its own when visits are sorted by node and stack, [node_count + 1].
    pub(crate) slot: Vec<u32>,
    /// Unknown of each sliding coordinate, or [`FROZEN`], [visit_count].
    pub(crate) sliding: Vec<u32>,
    /// For each node the nodes from it on (itself first, ascending) that share an element with it.
    pub(crate) neighbours: Vec<Vec<u32>>,
}

impl Model {
    /// The elements of `net`.
    pub fn new(net: Arc<YarnNet>) -> Result<Self, NetError> {
        check_nodes(&net)?;
        let (dyes, dye_of) = dyes(&net);
        let segments = segments(&net, &dye_of)?;
        let bends = bends(&net, &segments);
        let wraps = wraps(&net, &segments);
        let shears = shears(&net, &dye_of);
        let (start, sliding) = layout(&net);
        let slot = std::iter::once(0)
            .chain(net.nodes.iter().scan(0, |slot, node| {
                *slot += node.visits.len() as u32;
                Some(*slot)
            }))
            .collect();
        let mut neighbours: Vec<Vec<u32>> = (0..net.nodes.len() as u32).map(|n| vec![n]).collect();
        let mut join = |nodes: &[NodeId]| {
            for a in nodes {
                neighbours[a.index()].extend(nodes.iter().filter(|b| *b > a).map(|b| b.0));
            }
        };
        segments.iter().for_each(|s| join(&s.stencil.nodes));
        bends.iter().for_each(|b| join(&b.stencil.nodes));
        wraps.iter().for_each(|w| join(&w.stencil.nodes));
        shears.iter().for_each(|s| join(&s.stencil.nodes));
        for row in &mut neighbours {
            row.sort_unstable();
            row.dedup();
        }
        Ok(Self { net, dyes, dye_of, segments, bends, wraps, shears, start, slot, sliding, neighbours })
    }

    /// Lets the bends that are `new` to the yarn start in `state` without jamming, however sharp they are: it has not been
    /// laid so, and would fly apart.
    pub(crate) fn ease(&mut self, state: &YarnState, new: impl Fn([VisitId; 3]) -> bool) {
        for bend in self.bends.iter_mut().filter(|b| new(b.stencil.visits)) {
            let angle = Bend::angle(&bend.stencil.coordinates(state));
            bend.jam_angle = bend.jam_angle.max(angle + JAM_MARGIN);
        }
    }

    /// Number of unknowns.
    pub fn dof_count(&self) -> usize {
        self.start[self.net.nodes.len()] as usize
    }

    /// Number of non-zero node blocks in each block row of the system matrix, the diagonal included, [node_count].
    pub fn block_row_sizes(&self) -> Vec<usize> {
        let mut sizes: Vec<usize> = self.neighbours.iter().map(Vec::len).collect();
        for (a, row) in self.neighbours.iter().enumerate() {
            for b in row.iter().filter(|b| **b as usize != a) {
                sizes[*b as usize] += 1;
            }
        }
        sizes
    }

    /// The material of each colour in [`Self::dyes`].
    pub(crate) fn resolve(&self, materials: &Materials) -> Vec<Material> {
        self.dyes.iter().map(|dye| materials.of(*dye).clone()).collect()
    }

    /// Mass of the yarn around each node when laid, [node_count] [kg].
    pub fn node_masses(&self, materials: &Materials) -> Vec<f64> {
        let materials = self.resolve(materials);
        let mut masses = vec![0.0; self.net.nodes.len()];
        for segment in &self.segments {
            for node in segment.stencil.nodes {
                masses[node.index()] += 0.5 * materials[segment.dye as usize].density * segment.rest;
            }
        }
        masses
    }
}

fn check_nodes(net: &YarnNet) -> Result<(), NetError> {
    for (i, node) in net.nodes.iter().enumerate() {
        let id = NodeId::new(i);
        if node.visits.is_empty() {
            return Err(NetError::BareNode(id));
        }
        let slid = node.visits.iter().all(|v| net.visits[v.index()].u.is_finite());
        if !(node.position.is_finite() && node.normal.is_finite() && slid) {
            return Err(NetError::NotFinite(id));
        }
    }
    Ok(())
}

/// First unknown of each node, unknown of each sliding coordinate.
fn layout(net: &YarnNet) -> (Vec<u32>, Vec<u32>) {
    let mut start = vec![0];
    let mut sliding = vec![FROZEN; net.visits.len()];
    let mut next = 0;
    for node in &net.nodes {
        next += 3;
        if node.slides() {
            for visit in &node.visits {
                sliding[visit.index()] = next;
                next += 1;
            }
        }
        start.push(next);
    }
    (start, sliding)
}

/// The colours of a net, and for each visit which it has.
fn dyes(net: &YarnNet) -> (Vec<Dye>, Vec<u32>) {
    let mut dyes: Vec<Dye> = net.visits.iter().map(|v| v.dye).collect();
    dyes.sort_unstable();
    dyes.dedup();
    let place = |dye| dyes.partition_point(|d| *d < dye) as u32;
    let of = net.visits.iter().map(|v| place(v.dye)).collect();
    (dyes, of)
}

/// Segments of all yarns, each known to lie in a stitch contact or not.
fn segments(net: &YarnNet, dye_of: &[u32]) -> Result<Vec<SegmentTerm>, NetError> {
    let mut terms = Vec::with_capacity(net.visits.len());
    let unheld: HashSet<[VisitId; 2]> = slip::unheld(net).collect();
    for segment in net.segments() {
        let [a, b] = segment.ends;
        let rest = net.visits[b.index()].u + segment.wrap - net.visits[a.index()].u;
        // Negated, so that a NaN is refused too.
        if !(rest > 0.0 && rest.is_finite()) {
            return Err(NetError::NoYarn(a, b, rest));
        }
        let stencil = Stencil::new(net, segment.ends, [0.0, segment.wrap]);
        let touches = |kind| stencil.nodes.iter().any(|n| net.nodes[n.index()].kind == kind);
        let closeness = if touches(NodeKind::Loose) || unheld.contains(&segment.ends) {
            0.0
        } else if touches(NodeKind::Crossing) {
            0.5
        } else if stencil.nodes.iter().all(|n| net.nodes[n.index()].kind == NodeKind::Seam) {
            2.0
        } else {
            1.0
        };
        let dye = dye_of[a.index()];
        let climb = climb(net, segment.ends, rest);
        terms.push(SegmentTerm { stencil, dye, rest, climb, in_contact: false, closeness });
    }
    let by_ends: HashMap<[VisitId; 2], usize> =
        terms.iter().enumerate().map(|(i, t)| (t.stencil.visits, i)).collect();
    for (contact, c) in net.contacts.iter().enumerate() {
        for &ends in std::iter::once(&c.new).chain(&c.old) {
            let [p, q] = ends;
            let index = by_ends.get(&[p, q]).or_else(|| by_ends.get(&[q, p]));
            let index = *index.ok_or(NetError::BrokenContact { contact, ends })?;
            terms[index].in_contact = true;
        }
    }
    Ok(terms)
}

fn bends(net: &YarnNet, segments: &[SegmentTerm]) -> Vec<BendTerm> {
    let laid = net.laid_state();
    let after: HashMap<VisitId, &SegmentTerm> = segments.iter().map(|s| (s.stencil.visits[0], s)).collect();
    let bend = |first: &SegmentTerm| {
        let second = after.get(&first.stencil.visits[1])?;
        let [a, b] = first.stencil.visits;
        let turn = first.stencil.turn[1];
        let stencil =
            Stencil::new(net, [a, b, second.stencil.visits[1]], [0.0, turn, turn + second.stencil.turn[1]]);
        let rest_angle = Bend::angle(&stencil.coordinates(&laid));
        Some(BendTerm { stencil, dye: second.dye, jam_angle: FRAC_PI_2.max(rest_angle + JAM_MARGIN) })
    };
    segments.iter().filter_map(bend).collect()
}

fn wraps(net: &YarnNet, segments: &[SegmentTerm]) -> Vec<WrapTerm> {
    let by_ends: HashMap<[VisitId; 2], &SegmentTerm> =
        segments.iter().map(|s| (s.stencil.visits, s)).collect();
    // The neighbour of `visit` on its yarn that is not the other end of the contact.
    let outer = |visit: VisitId, other: VisitId| {
        if net.next(visit) == Some(other) { net.prev(visit) } else { net.next(visit) }
    };
    let mut terms = Vec::new();
    for contact in &net.contacts {
        let [p, q] = contact.new;
        let Some(new) = by_ends.get(&[p, q]).or_else(|| by_ends.get(&[q, p])) else { continue };
        for &[old_p, old_q] in &contact.old {
            let quads = [(outer(old_p, old_q), outer(q, p)), (outer(p, q), outer(old_q, old_p))];
            for quad in quads {
                let (Some(x4), Some(x3)) = quad else { continue };
                let stencil = Stencil::new(net, [x4, p, q, x3], [0.0; 4]);
                terms.push(WrapTerm {
                    stencil,
                    dye: new.dye,
                    handedness: contact.handedness,
                    wrapping: contact.wrapping,
                    rest: new.rest,
                });
            }
        }
    }
    terms
}
