//! The yarn of one stitch, as a template that goes on any face of its shape (Yuksel et al. §4: the 2.5-D representation).
//!
//! Each knit or purl of a stitch has four nodes LL, LU, RU, RL in its share of the face; every old loop passes all four, and
//! so does the new yarn, with its loop between LU and RU. A yarn-over has none. A slipped loop crosses the row's yarn with
//! both its legs on its way up. A stitch without tops gathers: its yarn threads each old loop at two nodes. A twisted loop
//! crosses its own legs in one more node.
//!
//! A node is placed by mean value coordinates of the face's corners. What the paper gives as an offset along the normal is
//! here the order of the yarns at the node, front to back; how far apart they lie is the business of whoever draws them.
//! Ports are counted as the half-edges of the face, so a template is put on a face by adding numbers.

use super::faces::few;
use crate::ids::VisitId;
use crate::mean_value::{mean_value_weights, reference_polygon};
use crate::stitch::{Make, Op, Stitch};
use crate::wrapping::Wrapping;
use crate::yarn_net::{NodeKind, StitchContact};
use glam::DVec2;
use smallvec::{SmallVec, smallvec};

/// Places of the four nodes in their share of the face: across (left to right), up (bottom to top).
const LL: DVec2 = DVec2::new(0.20, 0.10);
const LU: DVec2 = DVec2::new(0.30, 0.50);
const RU: DVec2 = DVec2::new(0.70, 0.50);
const RL: DVec2 = DVec2::new(0.80, 0.10);
/// Where the legs of a twisted loop cross.
const TWIST: DVec2 = DVec2::new(0.50, 0.75);
/// Where the legs of a slipped loop cross the row's yarn.
const SLIP: [DVec2; 2] = [DVec2::new(0.28, 0.40), DVec2::new(0.72, 0.40)];
/// Where gathered loops are threaded.
const GATHER: [DVec2; 2] = [DVec2::new(0.35, 0.35), DVec2::new(0.65, 0.35)];

/// A visit, counted within the template.
type LocalVisit = u16;

/// A port, counted within the face: see [`super::Port`].
pub(super) type LocalPort = u16;

/// A node of a template.
pub(super) struct TemplateNode {
    /// Mean value coordinates, one for each corner of the face.
    pub weights: Vec<f64>,
    /// The vector out of the cell along the row, on the nearer side, in the same coordinates (they sum to zero).
    pub outward: Vec<f64>,
    /// Visits, front to back.
    pub stack: SmallVec<[LocalVisit; 3]>,
    /// What happens there.
    pub kind: NodeKind,
}

/// A stretch of yarn from port to port; its visits follow one another.
pub(super) struct TemplatePiece {
    pub from: LocalPort,
    pub to: LocalPort,
    pub visits: std::ops::Range<LocalVisit>,
    /// Whether it is of the row's own yarn.
    pub own: bool,
}

pub(super) struct TemplateContact {
    pub handedness: f64,
    pub new: [LocalVisit; 2],
    pub old: SmallVec<[[LocalVisit; 2]; 1]>,
}

impl TemplateContact {
    /// The contact of a stitch wrapped so, its visits numbered.
    pub fn numbered(&self, wrapping: Wrapping, number: impl Fn(LocalVisit) -> VisitId) -> StitchContact {
        StitchContact {
            handedness: self.handedness,
            wrapping,
            new: self.new.map(&number),
            old: few(self.old.iter().map(|o| o.map(&number))),
        }
    }
}

/// All yarn of one stitch.
pub(super) struct Template {
    pub ports: LocalPorts,
    pub nodes: Vec<TemplateNode>,
    /// The node of every visit.
    pub visits: Vec<u32>,
    pub pieces: Vec<TemplatePiece>,
    /// For every port the piece that begins or ends there.
    pub piece_at: Vec<Option<u16>>,
    pub contacts: Vec<TemplateContact>,
}

/// The ports of a face with these numbers of bottoms and tops, in the order of its half-edges: bottoms from left to right,
/// right wale, tops from right to left, left wale. A leg on the right of a top comes first, as the top begins there.
#[derive(Clone, Copy)]
pub(super) struct LocalPorts {
    pub bottoms: usize,
    pub tops: usize,
}

impl LocalPorts {
    /// Left and right leg of an old loop.
    pub fn bottom(self, i: usize) -> [LocalPort; 2] {
        [2 * i, 2 * i + 1].map(|p| p as LocalPort)
    }

    /// Left and right leg of a new loop, counted from the left.
    pub fn top(self, i: usize) -> [LocalPort; 2] {
        let h = self.bottoms + self.tops - i;
        [2 * h + 1, 2 * h].map(|p| p as LocalPort)
    }

    /// Where the row's yarn comes in on the left.
    pub fn left(self) -> LocalPort {
        2 * (self.bottoms + 1 + self.tops) as LocalPort
    }

    /// Where it goes out on the right.
    pub fn right(self) -> LocalPort {
        2 * self.bottoms as LocalPort
    }

    /// Whether the half-edge at `i` in the face is a wale edge.
    pub fn is_wale(self, i: usize) -> bool {
        i == self.bottoms || i == self.bottoms + 1 + self.tops
    }

    /// Number of ports.
    pub fn count(self) -> usize {
        2 * (self.bottoms + self.tops + 2)
    }
}

impl Template {
    /// The yarn of `stitch`.
    pub fn of(stitch: &Stitch) -> Self {
        let ports = LocalPorts { bottoms: stitch.bottoms(), tops: stitch.tops() };
        let mut draft = Draft {
            reference: reference_polygon(ports.bottoms, ports.tops),
            nodes: Vec::new(),
            visits: Vec::new(),
            contacts: Vec::new(),
            pieces: Vec::new(),
        };
        let mut old: Vec<Strand> = (0..ports.bottoms).map(|i| Strand::from(ports.bottom(i)[0])).collect();
        let mut new = Strand::from(ports.left());
        for (i, op) in stitch.ops.iter().enumerate() {
            let share = |place: DVec2| DVec2::new((i as f64 + place.x) / ports.tops as f64, place.y);
            if op.make.passes_on() {
                slip(&mut draft, *op, share, ports.top(i), &mut old[0], &mut new);
                continue;
            }
            let four = op.make.pulls_through().then(|| {
                let nodes = [LL, LU, RU, RL].map(|p| draft.node(share(p), NodeKind::Stitch));
                draft.stitch_contacts(nodes, op.make == Make::Knit, &stitch.stack, &mut old)
            });
            new.visits.extend(four.iter().flat_map(|v| [v[0], v[1]]));
            let legs = twisted(&mut draft, *op, share(TWIST), ports.top(i));
            new.visits.extend(legs.crossing.map(|x| x[0]));
            draft.end(&mut new, legs.out, legs.back, true);
            new.visits.extend(legs.crossing.map(|x| x[1]));
            new.visits.extend(four.iter().flat_map(|v| [v[2], v[3]]));
        }
        if stitch.ops.is_empty() {
            gather(&mut draft, &mut old, &mut new);
        }
        draft.end(&mut new, ports.right(), ports.right(), true);
        // Old loops exist only where something holds them; under a yarn-over row there is nothing but the border.
        for (i, mut loop_) in old.into_iter().enumerate().filter(|_| stitch.holds()) {
            draft.end(&mut loop_, ports.bottom(i)[1], 0, false);
        }
        draft.finish(ports)
    }
}

/// A yarn while it is followed through a stitch.
struct Strand {
    from: LocalPort,
    visits: SmallVec<[LocalVisit; 8]>,
}

impl Strand {
    fn from(from: LocalPort) -> Self {
        Self { from, visits: SmallVec::new() }
    }
}

/// A template before the visits of each piece follow one another.
struct Draft {
    reference: Vec<DVec2>,
    nodes: Vec<TemplateNode>,
    visits: Vec<u16>,
    contacts: Vec<TemplateContact>,
    pieces: Vec<(Strand, LocalPort, bool)>,
}

impl Draft {
    fn node(&mut self, place: DVec2, kind: NodeKind) -> u16 {
        let across = |s: f64| mean_value_weights(&self.reference, DVec2::new(s, place.y));
        let side = if place.x > 0.5 { 0.3 } else { -0.3 };
        let outward = across(0.9).iter().zip(across(0.1)).map(|(r, l)| side * (r - l)).collect();
        let weights = mean_value_weights(&self.reference, place);
        self.nodes.push(TemplateNode { weights, outward, stack: SmallVec::new(), kind });
        (self.nodes.len() - 1) as u16
    }

    fn visit(&mut self, node: u16) -> LocalVisit {
        self.visits.push(node);
        (self.visits.len() - 1) as LocalVisit
    }

    /// Two visits at a new node, front to back.
    fn crossing(&mut self, place: DVec2, kind: NodeKind) -> [LocalVisit; 2] {
        let node = self.node(place, kind);
        let pair = [self.visit(node), self.visit(node)];
        self.nodes[usize::from(node)].stack.extend(pair);
        pair
    }

    /// The two stitch contacts of one knit or purl. Returns the visits of the new yarn.
    fn stitch_contacts(
        &mut self,
        nodes: [u16; 4],
        knit: bool,
        stack: &[u8],
        old: &mut [Strand],
    ) -> [LocalVisit; 4] {
        let new = nodes.map(|n| self.visit(n));
        let mut old_visits: SmallVec<[[LocalVisit; 4]; 3]> = SmallVec::new();
        for b in stack {
            let visits = nodes.map(|n| self.visit(n));
            old[usize::from(*b)].visits.extend(visits);
            old_visits.push(visits);
        }
        // Knit: the old loops lie in front of the new yarn at its feet and behind it above; purl the other way round.
        for (k, node) in nodes.into_iter().enumerate() {
            let old_in_front = knit == (k == 0 || k == 3);
            let stack = &mut self.nodes[usize::from(node)].stack;
            stack.extend(old_visits.iter().map(|v| v[k]));
            stack.insert(if old_in_front { stack.len() } else { 0 }, new[k]);
        }
        let left = if knit { 1.0 } else { -1.0 };
        for (handedness, p, q) in [(left, 0, 1), (-left, 2, 3)] {
            self.contacts.push(TemplateContact {
                handedness,
                new: [new[p], new[q]],
                old: old_visits.iter().map(|v| [v[p], v[q]]).collect(),
            });
        }
        new
    }

    /// Ends a piece at port `to`; the next one begins at `then`.
    fn end(&mut self, strand: &mut Strand, to: LocalPort, then: LocalPort, own: bool) {
        self.pieces.push((std::mem::replace(strand, Strand::from(then)), to, own));
    }

    /// Numbers the visits along the pieces.
    fn finish(mut self, ports: LocalPorts) -> Template {
        let mut number = vec![0; self.visits.len()];
        let mut visits = Vec::with_capacity(self.visits.len());
        let mut pieces = Vec::with_capacity(self.pieces.len());
        for (strand, to, own) in self.pieces {
            let first = visits.len() as LocalVisit;
            for v in strand.visits {
                number[usize::from(v)] = visits.len() as LocalVisit;
                visits.push(u32::from(self.visits[usize::from(v)]));
            }
            pieces.push(TemplatePiece {
                from: strand.from,
                to,
                visits: first..visits.len() as LocalVisit,
                own,
            });
        }
        let renumber = |v: &mut LocalVisit| *v = number[usize::from(*v)];
        self.nodes.iter_mut().for_each(|n| n.stack.iter_mut().for_each(renumber));
        for contact in &mut self.contacts {
            contact.new.iter_mut().for_each(renumber);
            contact.old.iter_mut().flatten().for_each(renumber);
        }
        let mut piece_at = vec![None; ports.count()];
        for (i, piece) in pieces.iter().enumerate() {
            [piece.from, piece.to].into_iter().for_each(|p| piece_at[usize::from(p)] = Some(i as u16));
        }
        Template { ports, nodes: self.nodes, visits, pieces, piece_at, contacts: self.contacts }
    }
}

/// The way of a loop up through its top and back.
struct Legs {
    out: LocalPort,
    back: LocalPort,
    /// The visits where the legs of a twisted loop cross: on the way out and back.
    crossing: Option<[LocalVisit; 2]>,
}

fn twisted(draft: &mut Draft, op: Op, place: DVec2, [left, right]: [LocalPort; 2]) -> Legs {
    if op.twist == 0 {
        return Legs { out: left, back: right, crossing: None };
    }
    let [front, behind] = draft.crossing(place, NodeKind::Crossing);
    // A loop hangs on the needle with its right leg in front. Knitted through the back, it is opened from the other side: the top
    // of the right leg turns on to the left, its foot stays, so that leg, on its way back down here, crosses in front. Seen from
    // the needle that is clockwise; seen from the back of the fabric it is the same.
    let crossing = Some(if op.twist > 0 { [behind, front] } else { [front, behind] });
    Legs { out: right, back: left, crossing }
}

/// Hands the old loop on through a top; the row's yarn passes it behind both legs, or in front of the left one.
fn slip(
    draft: &mut Draft,
    op: Op,
    share: impl Fn(DVec2) -> DVec2,
    top: [LocalPort; 2],
    loop_: &mut Strand,
    new: &mut Strand,
) {
    let [left, right] = SLIP.map(|place| draft.crossing(share(place), NodeKind::Crossing));
    let (left_leg, passes_left) = if op.make == Make::Cross { (left[1], left[0]) } else { left.into() };
    let legs = twisted(draft, op, share(TWIST), top);
    loop_.visits.push(left_leg);
    loop_.visits.extend(legs.crossing.map(|x| x[0]));
    draft.end(loop_, legs.out, legs.back, false);
    loop_.visits.extend(legs.crossing.map(|x| x[1]));
    loop_.visits.push(right[0]);
    new.visits.extend([passes_left, right[1]]);
}

/// A yarn through all old loops that makes none: in front of the left side of each, behind its right side.
fn gather(draft: &mut Draft, old: &mut [Strand], new: &mut Strand) {
    let count = old.len() as f64;
    for (b, held) in old.iter_mut().enumerate() {
        for (k, place) in GATHER.into_iter().enumerate() {
            let place = DVec2::new((b as f64 + place.x) / count, place.y);
            let [front, behind] = draft.crossing(place, NodeKind::Thread);
            let (thread, loop_) = if k == 0 { (front, behind) } else { (behind, front) };
            new.visits.push(thread);
            held.visits.push(loop_);
        }
    }
}

/// A plain knit through loops stacked in this order.
pub(super) fn knit_through(stack: SmallVec<[u8; 2]>) -> Stitch {
    Stitch { ops: smallvec![Op { make: Make::Knit, twist: 0 }], stack }
}
