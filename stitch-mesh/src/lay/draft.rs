//! Pieces of yarn and how they are joined, before they are yarns.

use super::Port;
use super::faces::FaceYarn;
use super::template::{Template, TemplateNode};
use crate::dye::Dye;
use crate::ids::{NodeId, VisitId};
use crate::stitch::Stitch;
use crate::wrapping::Wrapping;
use crate::yarn_net::{Node, NodeKind, StitchContact};
use glam::DVec3;
use smallvec::SmallVec;
use std::ops::Range;

/// No port: an end.
pub(super) const LOOSE: Port = Port::MAX;

/// A stretch of yarn inside one cell, from port to port.
pub(super) struct Piece<'a> {
    /// Counted over all pieces, those of the faces first.
    pub number: u32,
    pub from: Port,
    pub to: Port,
    /// The first of its visits; the others follow.
    pub first: u32,
    /// The nodes of its visits, less [`Self::nodes_before`].
    pub nodes: &'a [u32],
    pub nodes_before: u32,
    /// The colour of its yarn, if it is of the row's own yarn; else it has the colour with which its loop was made, and this
    /// one only where nothing says which that is.
    pub dye: Dye,
    pub own: bool,
}

/// A piece beyond the faces; its visits are a range of [`Draft::visits`].
struct PieceBeyond {
    from: Port,
    to: Port,
    visits: Range<usize>,
    dye: Dye,
    own: bool,
}

/// The yarn of the faces and what is laid beyond them: cables, borders, seams. See the module. Nodes, visits and pieces beyond
/// are numbered after those of the faces; visits in nodes and contacts are counted so until [`super::trace`] numbers them anew.
pub(super) struct Draft<'a> {
    pub faces: FaceYarn<'a>,
    /// Unit normals at the vertices of the mesh, [vertex_count].
    pub vertex_normals: &'a [DVec3],
    /// Nodes beyond the faces.
    pub nodes: Vec<Node>,
    /// For each of these the way outward: see [`Self::node`].
    outward: Vec<DVec3>,
    /// The node of every visit beyond the faces.
    visits: Vec<u32>,
    pieces: Vec<PieceBeyond>,
    /// For every port that lies on no half-edge the piece that begins or ends there.
    piece_at: Vec<Option<u32>>,
    /// Contacts beyond the faces.
    pub contacts: Vec<StitchContact>,
    /// For every port the one it is joined to, or [`LOOSE`].
    joined: Vec<Port>,
    /// Lengths to be taken in: the visit at one end of a piece's segment, in its direction, and the length [m].
    pub take_in: Vec<(u32, f64)>,
}

impl<'a> Draft<'a> {
    /// The yarn of all faces, joined across the edges between them.
    pub fn of_faces(faces: FaceYarn<'a>, vertex_normals: &'a [DVec3]) -> Self {
        Self {
            joined: faces.joined_across_edges(),
            faces,
            vertex_normals,
            nodes: Vec::new(),
            outward: Vec::new(),
            visits: Vec::new(),
            pieces: Vec::new(),
            piece_at: Vec::new(),
            contacts: Vec::new(),
            take_in: Vec::new(),
        }
    }

    /// Number of nodes.
    pub fn node_count(&self) -> usize {
        self.faces.node_count() + self.nodes.len()
    }

    /// Number of visits.
    pub fn visit_count(&self) -> usize {
        self.faces.visit_count() + self.visits.len()
    }

    /// Number of pieces.
    pub fn piece_count(&self) -> usize {
        self.faces.piece_count() + self.pieces.len()
    }

    /// Adds the yarn of a cell that lies beyond the border. Ports lie on no half-edge, and are given in the order of a face's.
    pub fn add_beyond(&mut self, stitch: &Stitch, cell: &Cell<'_>, ports: &[Port]) {
        let template = Template::of(stitch);
        debug_assert_eq!(ports.len(), template.ports.count());
        let (node, visit) = (self.node_count() as u32, self.visit_count() as u32);
        let id = |v: u16| VisitId(visit + u32::from(v));
        for n in &template.nodes {
            let (node, outward) = cell.node(n, id);
            self.nodes.push(node);
            self.outward.push(outward);
        }
        let visits = self.visits.len();
        self.visits.extend(template.visits.iter().map(|n| node + n));
        for p in &template.pieces {
            let [from, to] = [p.from, p.to].map(|p| ports[usize::from(p)]);
            let visits = visits + usize::from(p.visits.start)..visits + usize::from(p.visits.end);
            self.push_piece(PieceBeyond { from, to, visits, dye: cell.dye, own: p.own });
        }
        self.contacts.extend(template.contacts.iter().map(|c| c.numbered(cell.wrapping, id)));
    }

    fn push_piece(&mut self, piece: PieceBeyond) {
        for port in [piece.from, piece.to] {
            self.piece_at[port as usize - self.faces.port_count()] = Some(self.pieces.len() as u32);
        }
        self.pieces.push(piece);
    }

    /// Adds a node that no yarn visits yet. `outward` as in [`Self::node`].
    pub fn add_node(&mut self, position: DVec3, normal: DVec3, kind: NodeKind, outward: DVec3) -> NodeId {
        self.nodes.push(Node { position, normal, visits: SmallVec::new(), face: None, kind });
        self.outward.push(outward);
        NodeId::new(self.node_count() - 1)
    }

    /// A node, and the way outward from it: the vector along the row out of the cell on the nearer side, where the yarn goes
    /// when it turns back or ends there [m].
    pub fn node(&self, node: NodeId) -> (Node, DVec3) {
        match node.index().checked_sub(self.faces.node_count()) {
            None => (self.faces.node(node, self.vertex_normals), self.faces.outward(node)),
            Some(i) => (self.nodes[i].clone(), self.outward[i]),
        }
    }

    /// Adds a piece that visits `nodes`, all beyond the faces, in order, behind the yarns that are there already. Its ports lie
    /// on no half-edge. Returns its first visit.
    pub fn add_piece(&mut self, [from, to]: [Port; 2], nodes: &[NodeId], dye: Dye, own: bool) -> u32 {
        let (first, start) = (self.visit_count() as u32, self.visits.len());
        for node in nodes {
            let visit = VisitId::new(self.visit_count());
            self.nodes[node.index() - self.faces.node_count()].visits.push(visit);
            self.visits.push(node.0);
        }
        self.push_piece(PieceBeyond { from, to, visits: start..self.visits.len(), dye, own });
        first
    }

    /// Joins two ports by way of a node that is added to the yarn between them.
    pub fn join_through(&mut self, node: NodeId, [a, b]: [Port; 2], dye: Dye) -> u32 {
        let ends = [self.new_port(), self.new_port()];
        self.join(a, ends[0]);
        self.join(ends[1], b);
        self.add_piece(ends, &[node], dye, false)
    }

    /// A port that lies on no half-edge: at cast-on, bind-off and ends.
    pub fn new_port(&mut self) -> Port {
        self.joined.push(LOOSE);
        self.piece_at.push(None);
        (self.joined.len() - 1) as Port
    }

    /// Joins two ports, whatever they were joined to before.
    pub fn join(&mut self, a: Port, b: Port) {
        self.part(a);
        self.part(b);
        self.joined[a as usize] = b;
        self.joined[b as usize] = a;
    }

    /// Makes a port and the one it is joined to loose.
    pub fn part(&mut self, port: Port) {
        if let Some(other) = self.other_side(port) {
            self.joined[other as usize] = LOOSE;
        }
        self.joined[port as usize] = LOOSE;
    }

    /// The port that a port is joined to.
    pub fn other_side(&self, port: Port) -> Option<Port> {
        let other = self.joined[port as usize];
        (other != LOOSE).then_some(other)
    }

    /// The piece that begins or ends at a port.
    pub fn piece_at(&self, port: Port) -> Option<Piece<'_>> {
        match (port as usize).checked_sub(self.faces.port_count()) {
            None => self.faces.piece_at(port),
            Some(beyond) => self.piece_at[beyond].map(|i| self.piece_beyond(i as usize)),
        }
    }

    fn piece_beyond(&self, i: usize) -> Piece<'_> {
        let PieceBeyond { from, to, ref visits, dye, own } = self.pieces[i];
        Piece {
            number: (self.faces.piece_count() + i) as u32,
            from,
            to,
            first: (self.faces.visit_count() + visits.start) as u32,
            nodes: &self.visits[visits.clone()],
            nodes_before: 0,
            dye,
            own,
        }
    }

    /// Both ports of all pieces, in the order of their numbers.
    pub fn ends(&self) -> impl Iterator<Item = [Port; 2]> {
        self.faces.ends().chain(self.pieces.iter().map(|p| [p.from, p.to]))
    }

    fn has_piece_at(&self, port: Port) -> bool {
        match (port as usize).checked_sub(self.faces.port_count()) {
            None => self.faces.has_piece_at(port),
            Some(beyond) => self.piece_at[beyond].is_some(),
        }
    }

    /// Whether yarn ends at a port: nothing goes on from there. Across an edge of two faces something always does.
    pub fn is_loose(&self, port: Port) -> bool {
        let Some(other) = self.other_side(port) else { return true };
        !self.faces.lie_across(port, other) && !self.has_piece_at(other)
    }

    /// The port at which the yarn that enters a piece at `from` ends loose; none for a ring.
    pub fn end_of(&self, from: Port) -> Option<Port> {
        let mut entry = from;
        loop {
            let piece = self.piece_at(entry)?;
            let exit = if entry == piece.from { piece.to } else { piece.from };
            match self.other_side(exit).filter(|next| self.has_piece_at(*next)) {
                Some(next) if next == from => return None,
                Some(next) => entry = next,
                None => return Some(exit),
            }
        }
    }
}

/// Where the yarn of a stitch beyond the faces is put.
pub(super) struct Cell<'a> {
    /// Corners in the order of a face: from the lower left, counter-clockwise [m].
    pub corners: &'a [DVec3],
    /// Unit normals at the corners.
    pub normals: &'a [DVec3],
    pub dye: Dye,
    pub wrapping: Wrapping,
}

impl Cell<'_> {
    /// A node of a template put here, its visits numbered by `number`, and the way outward from it.
    fn node(&self, node: &TemplateNode, number: impl Fn(u16) -> VisitId) -> (Node, DVec3) {
        let mean = |weights: &[f64], of: &[DVec3]| of.iter().zip(weights).map(|(c, w)| *c * *w).sum();
        let placed = Node {
            position: mean(&node.weights, self.corners),
            normal: DVec3::normalize_or(mean(&node.weights, self.normals), DVec3::Z),
            visits: node.stack.iter().map(|v| number(*v)).collect(),
            face: None,
            kind: node.kind,
        };
        (placed, mean(&node.outward, self.corners))
    }
}
