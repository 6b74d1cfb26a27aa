//! The yarn of all faces, which no array holds: a piece, a node or a contact follows from the template of its face and from
//! how many there are in the faces before. So laying writes what goes into the net, once, and nothing else.

use super::Port;
use super::draft::{LOOSE, Piece};
use super::template::Template;
use super::{course_port, wale_port};
use crate::ids::{FaceId, HalfEdgeId, NodeId, VisitId};
use crate::stitch::Stitch;
use crate::stitch_mesh::StitchMesh;
use crate::yarn_net::{Node, StitchContact};
use glam::DVec3;
use rayon::prelude::*;
use smallvec::SmallVec;
use std::collections::HashMap;

/// Numbers of things in the faces before one.
#[derive(Clone, Copy, Default)]
struct Before {
    nodes: u32,
    visits: u32,
    pieces: u32,
    contacts: u32,
}

/// See the module.
pub(super) struct FaceYarn<'a> {
    stitches: &'a StitchMesh,
    vertex_normals: &'a [DVec3],
    templates: Vec<Template>,
    /// The template of every face.
    of_face: Vec<u32>,
    /// For every face, and at the end of all, [face_count + 1].
    before: Vec<Before>,
    /// The face of every node.
    of_node: Vec<FaceId>,
}

impl<'a> FaceYarn<'a> {
    pub fn of(stitches: &'a StitchMesh, vertex_normals: &'a [DVec3]) -> Self {
        let (templates, of_face) = templates(stitches);
        let mut before = Vec::with_capacity(of_face.len() + 1);
        let mut sum = Before::default();
        before.push(sum);
        for t in &of_face {
            let t = &templates[*t as usize];
            sum.nodes += t.nodes.len() as u32;
            sum.visits += t.visits.len() as u32;
            sum.pieces += t.pieces.len() as u32;
            sum.contacts += t.contacts.len() as u32;
            before.push(sum);
        }
        let of_node = owners(before.iter().map(|b| b.nodes));
        Self { stitches, vertex_normals, templates, of_face, before, of_node }
    }

    pub fn stitches(&self) -> &'a StitchMesh {
        self.stitches
    }

    pub fn node_count(&self) -> usize {
        self.of_node.len()
    }

    pub fn visit_count(&self) -> usize {
        self.before[self.of_face.len()].visits as usize
    }

    pub fn piece_count(&self) -> usize {
        self.before[self.of_face.len()].pieces as usize
    }

    /// Ports of all half-edges.
    pub fn port_count(&self) -> usize {
        2 * self.stitches.mesh().half_edge_count()
    }

    fn template(&self, face: FaceId) -> &Template {
        &self.templates[self.of_face[face.index()] as usize]
    }

    /// Whether a piece begins or ends at a port of a half-edge.
    pub fn has_piece_at(&self, port: Port) -> bool {
        let mesh = self.stitches.mesh();
        let face = mesh.face(HalfEdgeId(port / 2));
        let first = 2 * mesh.first_half_edge(face).0;
        self.template(face).piece_at[(port - first) as usize].is_some()
    }

    /// The piece at a port of a half-edge.
    pub fn piece_at(&self, port: Port) -> Option<Piece<'_>> {
        let mesh = self.stitches.mesh();
        let face = mesh.face(HalfEdgeId(port / 2));
        let first = 2 * mesh.first_half_edge(face).0;
        let i = self.template(face).piece_at[(port - first) as usize]?;
        Some(self.piece(face, usize::from(i)))
    }

    fn piece(&self, face: FaceId, i: usize) -> Piece<'_> {
        let template = self.template(face);
        let piece = &template.pieces[i];
        let before = self.before[face.index()];
        let port = 2 * self.stitches.mesh().first_half_edge(face).0;
        Piece {
            number: before.pieces + i as u32,
            from: port + Port::from(piece.from),
            to: port + Port::from(piece.to),
            first: before.visits + u32::from(piece.visits.start),
            nodes: &template.visits[usize::from(piece.visits.start)..usize::from(piece.visits.end)],
            nodes_before: before.nodes,
            dye: self.stitches.dyes()[face.index()],
            own: piece.own,
        }
    }

    /// Both ports of all pieces, in the order of their numbers.
    pub fn ends(&self) -> impl Iterator<Item = [Port; 2]> {
        self.of_face.iter().zip(self.stitches.mesh().faces()).flat_map(|(template, face)| {
            let first = 2 * self.stitches.mesh().first_half_edge(face).0;
            let pieces = &self.templates[*template as usize].pieces;
            pieces.iter().map(move |p| [p.from, p.to].map(|port| first + Port::from(port)))
        })
    }

    /// A node. Its visits are numbered as in the draft.
    pub fn node(&self, node: NodeId) -> Node {
        let face = self.of_node[node.index()];
        let before = self.before[face.index()];
        let template = &self.template(face).nodes[(node.0 - before.nodes) as usize];
        let (mut position, mut normal) = (DVec3::ZERO, DVec3::ZERO);
        for (v, weight) in self.stitches.mesh().face_vertices(face).zip(&template.weights) {
            position += self.stitches.mesh().position(v) * *weight;
            normal += self.vertex_normals[v.index()] * *weight;
        }
        let mut visits = SmallVec::new();
        template.stack.iter().for_each(|v| visits.push(VisitId(before.visits + u32::from(*v))));
        Node {
            position,
            normal: normal.normalize_or(DVec3::Z),
            visits,
            face: Some(face),
            kind: template.kind,
        }
    }

    /// The way outward from a node: see [`super::draft::Draft::node`].
    pub fn outward(&self, node: NodeId) -> DVec3 {
        let face = self.of_node[node.index()];
        let template = &self.template(face).nodes[(node.0 - self.before[face.index()].nodes) as usize];
        let corners = self.stitches.mesh().face_vertices(face);
        corners.zip(&template.outward).map(|(v, w)| self.stitches.mesh().position(v) * *w).sum()
    }

    /// All nodes, their visits numbered as in the draft.
    pub fn nodes(&self) -> impl IndexedParallelIterator<Item = Node> {
        (0..self.node_count()).into_par_iter().map(|n| self.node(NodeId::new(n)))
    }

    /// All stitch contacts.
    pub fn contacts(
        &self,
        number: impl Fn(u32) -> VisitId + Sync + Send,
    ) -> impl IndexedParallelIterator<Item = StitchContact> {
        let of_contact = owners(self.before.iter().map(|b| b.contacts));
        of_contact.into_par_iter().enumerate().map(move |(c, face)| {
            let before = self.before[face.index()];
            let contact = &self.template(face).contacts[c - before.contacts as usize];
            let wrapping = self.stitches.wrappings()[face.index()];
            contact.numbered(wrapping, |v| number(before.visits + u32::from(v)))
        })
    }

    /// For every port of a half-edge the one across its edge.
    pub fn joined_across_edges(&self) -> Vec<Port> {
        let mesh = self.stitches.mesh();
        let across = |port: Port| {
            let h = HalfEdgeId(port / 2);
            let Some(twin) = mesh.twin(h) else { return LOOSE };
            let face = mesh.face(h);
            let wale = self.template(face).ports.is_wale((h.0 - mesh.first_half_edge(face).0) as usize);
            match (wale, port % 2) {
                (true, 0) => wale_port(twin),
                (true, _) => LOOSE,
                (false, place) => course_port(twin, 1 - place),
            }
        };
        (0..self.port_count() as Port).into_par_iter().map(across).collect()
    }
}

/// The face of each thing, from how many there are before each face.
fn owners(before: impl Iterator<Item = u32>) -> Vec<FaceId> {
    let mut owners = Vec::new();
    for (end, face) in before.skip(1).zip(0..) {
        owners.resize(end as usize, FaceId(face));
    }
    owners
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
