//! The yarn net: yarns, contact nodes and stitch contacts (stage 5 of the flow).
//!
//! # Theory
//! Cirio et al., *Yarn-Level Cloth Simulation with Sliding Persistent Contacts*, §3.2: wherever yarns touch for good there
//! is one node with one position, and every yarn passing it has a sliding coordinate of its own, the material arc length
//! that is at the node just now.
//!
//! # Practice
//! **The visit is the primitive**: one yarn passing one node. A yarn is a run of visits, a node the stack of its visits,
//! and the sliding coordinate belongs to the visit. So one, two, three or more yarns at a node need no special case:
//!
//! | visits | node |
//! |---|---|
//! | 1 | a tail or a turn; its sliding coordinate is frozen (the node moves with its yarn) |
//! | 2 | a plain contact, or two yarns crossing, as warp and weft do; at a seam both are frozen |
//! | n + 1 | a decrease: n stacked loops and the yarn that goes through them |
//!
//! A net knows nothing of stitch symbols. It lives from the laying of the yarn to the next edit of the stitch mesh.

use crate::dye::Dye;
use crate::ids::{FaceId, HalfEdgeId, NodeId, VisitId, YarnId};
use crate::wrapping::Wrapping;
use glam::DVec3;
use smallvec::SmallVec;
use std::ops::Range;
use std::sync::Arc;

/// What happens at a node.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NodeKind {
    /// An end of a stitch contact: yarn pulled through loops, wrapped around them.
    Stitch,
    /// Yarn threaded through a loop: gathered loops, the last one of a bind-off.
    Thread,
    /// Sewing yarn that has caught a border. Neither of the two slides there.
    Seam,
    /// Yarns that cross and hold nothing: a cable, a slipped loop, the legs of a twisted one.
    Crossing,
    /// Warp and weft that cross in woven cloth.
    Woven,
    /// One yarn alone: a tail, a turn, a live loop.
    Free,
    /// One yarn alone since another one has been cut or has slipped out, or the end of a cut.
    Loose,
}

/// A contact node as it was laid.
#[derive(Clone, Debug)]
pub struct Node {
    /// Position when laid [m].
    pub position: DVec3,
    /// Unit normal of the fabric when laid, towards the front (the side that a knitter calls right).
    pub normal: DVec3,
    /// The visits of this node, **front to back**.
    pub visits: SmallVec<[VisitId; 3]>,
    /// The stitch that this node lies in; none outside of the mesh (cast-on, bind-off, tails).
    pub face: Option<FaceId>,
    /// What happens there.
    pub kind: NodeKind,
}

impl Node {
    /// Whether its yarns slide along each other.
    pub fn slides(&self) -> bool {
        self.visits.len() > 1 && self.kind != NodeKind::Seam
    }
}

/// One yarn passing one node.
#[derive(Clone, Copy, Debug)]
pub struct Visit {
    /// The node.
    pub node: NodeId,
    /// The yarn.
    pub yarn: YarnId,
    /// Sliding coordinate when laid: arc length along the unstretched yarn from its first visit [m].
    pub u: f64,
    /// Colour of the yarn from here to the next visit.
    pub dye: Dye,
}

/// One piece of yarn: a run of visits.
#[derive(Clone, Debug)]
pub struct Yarn {
    /// Its visits, in order along the yarn; indices into [`YarnNet::visits`].
    pub visits: Range<u32>,
    /// For a closed yarn the rest length of the whole ring [m]: the coordinate at which it meets its first visit again.
    pub period: Option<f64>,
}

/// The loop on a top edge.
#[derive(Clone, Debug, PartialEq)]
pub struct Loop {
    /// The top half-edge, seen from the stitch that made the loop or handed it on.
    pub top: HalfEdgeId,
    /// The visits of its head: all beyond the edge; indices into [`YarnNet::visits`].
    pub head: Range<u32>,
}

/// Yarn that is drawn tight when the simulation begins, or let out: laid longer or shorter than it is to be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TakenIn {
    /// The visit with which the segment begins.
    pub segment: VisitId,
    /// By how much its rest length becomes shorter; negative where it becomes longer [m].
    pub length: f64,
}

/// A stitch contact: the stretch on which two or more yarns are wrapped around each other, between two nodes
/// (Cirio et al. §3.2.2 and Fig. 8).
#[derive(Clone, Debug)]
pub struct StitchContact {
    /// Sense of the double helix: +1 for the left contact of a knit, −1 for its right one; a purl has both the other way.
    /// It does not depend on the direction in which a yarn runs.
    pub handedness: f64,
    /// How strongly the yarns are wrapped, and at what angle: that of the stitch.
    pub wrapping: Wrapping,
    /// The visits of the yarn that forms the new loop, at the first and second end.
    pub new: [VisitId; 2],
    /// The same of every old loop, front to back. At least one.
    pub old: SmallVec<[[VisitId; 2]; 1]>,
}

/// Two consecutive visits of one yarn and the yarn between them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Segment {
    /// Visits at both ends, along the yarn.
    pub ends: [VisitId; 2],
    /// Added to the sliding coordinate of the second end: the period where a closed yarn meets its beginning, else 0 [m].
    pub wrap: f64,
}

/// Yarns, contact nodes and stitch contacts. See the module.
#[derive(Clone, Debug, Default)]
pub struct YarnNet {
    /// Contact nodes.
    pub nodes: Vec<Node>,
    /// Visits, yarn by yarn, in order along each.
    /// Shared with the nets of edits that leave all yarns where they run.
    pub visits: Arc<Vec<Visit>>,
    /// Yarns.
    pub yarns: Vec<Yarn>,
    /// Stitch contacts.
    pub contacts: Vec<StitchContact>,
    /// The loops on all top edges, except where tops meet tops, or hand on what comes from there.
    pub loops: Vec<Loop>,
    /// Segments that are taken in.
    pub taken_in: Vec<TakenIn>,
}

impl YarnNet {
    /// The visit after `visit` on its yarn, if the yarn goes on.
    pub fn next(&self, visit: VisitId) -> Option<VisitId> {
        let yarn = &self.yarns[self.visits[visit.index()].yarn.index()];
        if visit.0 + 1 < yarn.visits.end {
            Some(VisitId(visit.0 + 1))
        } else {
            yarn.period.map(|_| VisitId(yarn.visits.start))
        }
    }

    /// The visit before `visit` on its yarn.
    pub fn prev(&self, visit: VisitId) -> Option<VisitId> {
        let yarn = &self.yarns[self.visits[visit.index()].yarn.index()];
        if visit.0 > yarn.visits.start {
            Some(VisitId(visit.0 - 1))
        } else {
            yarn.period.map(|_| VisitId(yarn.visits.end - 1))
        }
    }

    /// Segments of one yarn, in order; a closed yarn has as many as visits, an open one has one fewer.
    pub fn segments_of(&self, yarn: YarnId) -> impl Iterator<Item = Segment> + '_ {
        let Yarn { visits, period, .. } = &self.yarns[yarn.index()];
        let inner = visits.clone().skip(1).map(|v| Segment { ends: [VisitId(v - 1), VisitId(v)], wrap: 0.0 });
        let closing =
            period.map(|wrap| Segment { ends: [VisitId(visits.end - 1), VisitId(visits.start)], wrap });
        inner.chain(closing)
    }

    /// All segments, yarn by yarn.
    pub fn segments(&self) -> impl Iterator<Item = Segment> + '_ {
        (0..self.yarns.len()).flat_map(|yarn| self.segments_of(YarnId::new(yarn)))
    }

    /// Whether the sliding coordinate of `visit` is frozen: its node has no other yarn to slide along, or is sewn.
    pub fn is_frozen(&self, visit: VisitId) -> bool {
        !self.nodes[self.visits[visit.index()].node.index()].slides()
    }

    /// Adds the yarns of another net behind those of this one, as they are: each keeps to itself.
    pub fn append(&mut self, other: Self) {
        let [nodes, visits, yarns] =
            [self.nodes.len(), self.visits.len(), self.yarns.len()].map(|n| n as u32);
        let moved = |v: VisitId| VisitId(v.0 + visits);
        let range = |r: Range<u32>| r.start + visits..r.end + visits;
        self.nodes.extend(other.nodes.into_iter().map(|mut node| {
            node.visits.iter_mut().for_each(|v| *v = moved(*v));
            node
        }));
        Arc::make_mut(&mut self.visits).extend(other.visits.iter().map(|v| Visit {
            node: NodeId(v.node.0 + nodes),
            yarn: YarnId(v.yarn.0 + yarns),
            ..*v
        }));
        self.yarns.extend(other.yarns.into_iter().map(|y| Yarn { visits: range(y.visits), ..y }));
        self.contacts.extend(other.contacts.into_iter().map(|mut c| {
            c.new.iter_mut().chain(c.old.iter_mut().flatten()).for_each(|v| *v = moved(*v));
            c
        }));
        self.loops.extend(other.loops.into_iter().map(|l| Loop { head: range(l.head), ..l }));
        let taken_in = other.taken_in.into_iter();
        self.taken_in.extend(taken_in.map(|t| TakenIn { segment: moved(t.segment), ..t }));
    }

    /// The state in which the yarn was laid: at rest, nothing slid.
    pub fn laid_state(&self) -> YarnState {
        YarnState {
            position: self.nodes.iter().map(|n| n.position).collect(),
            velocity: vec![DVec3::ZERO; self.nodes.len()],
            sliding: self.visits.iter().map(|v| v.u).collect(),
            sliding_velocity: vec![0.0; self.visits.len()],
            taken_in: 0.0,
        }
    }
}

/// Where the yarn is: positions and sliding coordinates and their rates (stage 6 of the flow).
#[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct YarnState {
    /// Node positions, [node_count] [m].
    pub position: Vec<DVec3>,
    /// Node velocities, [node_count] [m/s].
    pub velocity: Vec<DVec3>,
    /// Sliding coordinates, [visit_count] [m].
    pub sliding: Vec<f64>,
    /// Their rates, [visit_count] [m/s].
    pub sliding_velocity: Vec<f64>,
    /// How much of [`YarnNet::taken_in`] has been taken in, 0 to 1.
    #[serde(default)]
    pub taken_in: f64,
}

impl YarnState {
    /// Adds the state of a net that is appended to the one that this is a state of.
    pub fn append(&mut self, other: Self) {
        self.position.extend(other.position);
        self.velocity.extend(other.velocity);
        self.sliding.extend(other.sliding);
        self.sliding_velocity.extend(other.sliding_velocity);
    }

    /// Whether every number is finite.
    pub fn is_finite(&self) -> bool {
        self.position.iter().chain(&self.velocity).all(|v| v.is_finite())
            && self.sliding.iter().chain(&self.sliding_velocity).all(|u| u.is_finite())
            && (0.0..=1.0).contains(&self.taken_in)
    }

    /// Whether this state has the shape of `net`.
    pub fn fits(&self, net: &YarnNet) -> bool {
        self.position.len() == net.nodes.len()
            && self.velocity.len() == net.nodes.len()
            && self.sliding.len() == net.visits.len()
            && self.sliding_velocity.len() == net.visits.len()
    }
}
