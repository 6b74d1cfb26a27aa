//! Pieces of yarn and how they are joined, before they are yarns.

use super::Port;
use super::template::{LocalPorts, Template};
use crate::dye::Dye;
use crate::ids::{FaceId, HalfEdgeId, NodeId, VisitId};
use crate::stitch::Stitch;
use crate::stitch_mesh::StitchMesh;
use crate::yarn_net::{Node, NodeKind, StitchContact};
use glam::DVec3;
use rayon::prelude::*;
use smallvec::SmallVec;
use std::collections::HashMap;

/// No port: an end.
pub(super) const LOOSE: Port = Port::MAX;

/// No piece.
const NONE: u32 = u32::MAX;

/// A stretch of yarn inside one cell, from port to port.
#[derive(Clone, Copy)]
pub(super) struct Piece {
    pub from: Port,
    pub to: Port,
    /// Its visits in [`Draft::visits`], in order.
    pub first: u32,
    pub end: u32,
    /// The colour of its yarn, if it is of the row's own yarn; else it has the colour with which its loop was made, and this
    /// one only where nothing says which that is.
    pub dye: Dye,
    pub own: bool,
}

/// See the module. Visits in nodes and contacts are counted as in `visits` until [`super::trace`] numbers them anew.
#[derive(Default)]
pub(super) struct Draft {
    pub nodes: Vec<Node>,
    /// For every node the vector along the row out of the cell on the nearer side: where the yarn goes when it turns back or
    /// ends there [m].
    pub outward: Vec<DVec3>,
    /// The node of every visit.
    pub visits: Vec<NodeId>,
    pub pieces: Vec<Piece>,
    pub contacts: Vec<StitchContact>,
    /// For every port the one it is joined to, or [`LOOSE`].
    pub joined: Vec<Port>,
    /// Lengths to be taken in: the visit at one end of a piece's segment, in its direction, and the length [m].
    pub take_in: Vec<(u32, f64)>,
}

/// Faces whose yarn is placed by one thread at a time.
const CHUNK: usize = 2048;

impl Draft {
    /// The yarn of all faces, joined across the edges between them.
    pub fn of_faces(stitches: &StitchMesh, vertex_normals: &[DVec3]) -> Self {
        let mesh = stitches.mesh();
        let (templates, of_face) = templates(stitches);
        // Where the nodes, visits and so on of each chunk begin.
        let mut starts = vec![[0u32; 2]];
        let mut end = [0u32; 2];
        for chunk in of_face.chunks(CHUNK) {
            for t in chunk {
                let t = &templates[*t as usize];
                end = [end[0] + t.nodes.len() as u32, end[1] + t.visits.len() as u32];
            }
            starts.push(end);
        }
        let chunks: Vec<Self> = of_face
            .par_chunks(CHUNK)
            .enumerate()
            .map(|(c, chunk)| {
                let mut draft = Self::default();
                let [node, visit] = starts[c];
                for (i, t) in chunk.iter().enumerate() {
                    let face = FaceId::new(c * CHUNK + i);
                    let first = mesh.first_half_edge(face).0;
                    let corners: SmallVec<[DVec3; 8]> =
                        mesh.face_vertices(face).map(|v| mesh.position(v)).collect();
                    let normals: SmallVec<[DVec3; 8]> =
                        mesh.face_vertices(face).map(|v| vertex_normals[v.index()]).collect();
                    let cell = Cell {
                        corners: &corners,
                        normals: &normals,
                        face: Some(face),
                        dye: stitches.dyes()[face.index()],
                    };
                    draft.add(&templates[*t as usize], &cell, [node, visit], |p| 2 * first + Port::from(p));
                }
                draft
            })
            .collect();
        let mut all = Self::default();
        all.nodes.reserve_exact(end[0] as usize);
        all.visits.reserve_exact(end[1] as usize);
        for mut chunk in chunks {
            all.nodes.append(&mut chunk.nodes);
            all.outward.append(&mut chunk.outward);
            all.visits.append(&mut chunk.visits);
            all.pieces.append(&mut chunk.pieces);
            all.contacts.append(&mut chunk.contacts);
        }
        all.joined = joined_across_edges(stitches);
        all
    }

    /// Adds the yarn of one cell. `offset` is added to the numbers of nodes and visits, as the draft may be one of several.
    fn add(&mut self, template: &Template, cell: &Cell<'_>, offset: [u32; 2], port: impl Fn(u16) -> Port) {
        let node = offset[0] + self.nodes.len() as u32;
        let visit = offset[1] + self.visits.len() as u32;
        for n in &template.nodes {
            let mean = |weights: &[f64], of: &[DVec3]| of.iter().zip(weights).map(|(c, w)| *c * *w).sum();
            self.nodes.push(Node {
                position: mean(&n.weights, cell.corners),
                normal: DVec3::normalize_or(mean(&n.weights, cell.normals), DVec3::Z),
                visits: n.stack.iter().map(|v| VisitId(visit + u32::from(*v))).collect(),
                face: cell.face,
                kind: n.kind,
            });
            self.outward.push(mean(&n.outward, cell.corners));
        }
        self.visits.extend(template.visits.iter().map(|n| NodeId(node + u32::from(*n))));
        self.pieces.extend(template.pieces.iter().map(|p| Piece {
            from: port(p.from),
            to: port(p.to),
            first: visit + u32::from(p.visits.start),
            end: visit + u32::from(p.visits.end),
            dye: cell.dye,
            own: p.own,
        }));
        let id = |v: u16| VisitId(visit + u32::from(v));
        self.contacts.extend(template.contacts.iter().map(|c| StitchContact {
            handedness: c.handedness,
            new: c.new.map(id),
            old: c.old.iter().map(|o| o.map(id)).collect(),
        }));
    }

    /// Adds the yarn of a cell that lies beyond the border. Ports are given in the order of a face's.
    pub fn add_beyond(&mut self, stitch: &Stitch, cell: &Cell<'_>, ports: &[Port]) {
        debug_assert_eq!(ports.len(), LocalPorts { bottoms: stitch.bottoms(), tops: stitch.tops() }.count());
        self.add(&Template::of(stitch), cell, [0, 0], |p| ports[usize::from(p)]);
    }

    /// Adds a node that no yarn visits yet. `outward` as in [`Self::outward`].
    pub fn add_node(&mut self, position: DVec3, normal: DVec3, kind: NodeKind, outward: DVec3) -> NodeId {
        self.nodes.push(Node { position, normal, visits: SmallVec::new(), face: None, kind });
        self.outward.push(outward);
        NodeId::new(self.nodes.len() - 1)
    }

    /// Adds a piece that visits `nodes` in order, behind the yarns that are there already. Returns its first visit.
    pub fn add_piece(&mut self, [from, to]: [Port; 2], nodes: &[NodeId], dye: Dye, own: bool) -> u32 {
        let first = self.visits.len() as u32;
        for node in nodes {
            self.nodes[node.index()].visits.push(VisitId::new(self.visits.len()));
            self.visits.push(*node);
        }
        self.pieces.push(Piece { from, to, first, end: self.visits.len() as u32, dye, own });
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
}

/// The pieces by the ports at which they begin and end.
pub(super) struct PieceAt(Vec<u32>);

impl PieceAt {
    /// Of all pieces of a draft.
    pub fn of(draft: &Draft) -> Self {
        let mut at = vec![NONE; draft.joined.len()];
        for (i, piece) in draft.pieces.iter().enumerate() {
            at[piece.from as usize] = i as u32;
            at[piece.to as usize] = i as u32;
        }
        Self(at)
    }

    /// The piece at a port.
    pub fn get(&self, port: Port) -> Option<usize> {
        self.0.get(port as usize).filter(|p| **p != NONE).map(|p| *p as usize)
    }

    /// Whether yarn ends at a port: nothing goes on from there.
    pub fn is_loose(&self, draft: &Draft, port: Port) -> bool {
        draft.other_side(port).is_none_or(|other| self.get(other).is_none())
    }

    /// The port at which the yarn that enters a piece at `from` ends loose; none for a ring.
    pub fn end_of(&self, draft: &Draft, from: Port) -> Option<Port> {
        let mut entry = from;
        loop {
            let piece = &draft.pieces[self.get(entry)?];
            let exit = if entry == piece.from { piece.to } else { piece.from };
            match draft.other_side(exit).filter(|next| self.get(*next).is_some()) {
                Some(next) if next == from => return None,
                Some(next) => entry = next,
                None => return Some(exit),
            }
        }
    }
}

/// Where the yarn of a stitch is put.
pub(super) struct Cell<'a> {
    /// Corners in the order of a face: from the lower left, counter-clockwise [m].
    pub corners: &'a [DVec3],
    /// Unit normals at the corners.
    pub normals: &'a [DVec3],
    pub face: Option<FaceId>,
    pub dye: Dye,
}

/// The templates of all stitches of a mesh, and which of them each face has.
fn templates(stitches: &StitchMesh) -> (Vec<Template>, Vec<u32>) {
    let mut templates: Vec<Template> = Vec::new();
    let mut known: HashMap<&Stitch, u32> = HashMap::new();
    let mut of_face = Vec::with_capacity(stitches.stitches().len());
    let mut last: Option<(&Stitch, u32)> = None;
    for stitch in stitches.stitches() {
        let template = match last {
            Some((same, template)) if same == stitch => template,
            _ => *known.entry(stitch).or_insert_with(|| {
                templates.push(Template::of(stitch));
                (templates.len() - 1) as u32
            }),
        };
        last = Some((stitch, template));
        of_face.push(template);
    }
    (templates, of_face)
}

/// For every port of a half-edge the one across its edge.
fn joined_across_edges(stitches: &StitchMesh) -> Vec<Port> {
    let mesh = stitches.mesh();
    let across = |h: u32| {
        let h = HalfEdgeId(h);
        match mesh.twin(h) {
            None => [LOOSE, LOOSE],
            Some(twin) if stitches.is_wale(h) => [super::wale_port(twin), LOOSE],
            Some(twin) => [super::course_port(twin, 1), super::course_port(twin, 0)],
        }
    };
    (0..mesh.half_edge_count() as u32).into_par_iter().flat_map_iter(across).collect()
}
