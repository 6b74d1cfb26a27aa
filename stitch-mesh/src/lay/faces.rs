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

/// A face: its template, and how much lies in the faces before it.
#[derive(Clone, Copy, Default)]
struct Cell {
    template: u32,
    ports: u32,
    nodes: u32,
    visits: u32,
    pieces: u32,
    contacts: u32,
}

/// See the module.
pub(super) struct FaceYarn<'a> {
    stitches: &'a StitchMesh,
    templates: Vec<Template>,
    /// Every face, and at the end what lies in all of them, [face_count + 1].
    cells: Vec<Cell>,
    /// The face of every node.
    of_node: Vec<FaceId>,
}

impl<'a> FaceYarn<'a> {
    pub fn of(stitches: &'a StitchMesh) -> Self {
        let (templates, of_face) = templates(stitches);
        let mut cells = Vec::with_capacity(of_face.len() + 1);
        let mut next = Cell::default();
        for template in of_face {
            cells.push(Cell { template, ..next });
            let t = &templates[template as usize];
            next.ports += t.piece_at.len() as u32;
            next.nodes += t.nodes.len() as u32;
            next.visits += t.visits.len() as u32;
            next.pieces += t.pieces.len() as u32;
            next.contacts += t.contacts.len() as u32;
        }
        cells.push(next);
        let of_node = owners(cells.iter().map(|b| b.nodes));
        Self { stitches, templates, cells, of_node }
    }

    pub fn stitches(&self) -> &'a StitchMesh {
        self.stitches
    }

    pub fn node_count(&self) -> usize {
        self.of_node.len()
    }

    pub fn visit_count(&self) -> usize {
        self.all().visits as usize
    }

    pub fn piece_count(&self) -> usize {
        self.all().pieces as usize
    }

    /// Ports of all half-edges.
    pub fn port_count(&self) -> usize {
        self.all().ports as usize
    }

    /// What lies in all faces together.
    fn all(&self) -> Cell {
        self.cells[self.cells.len() - 1]
    }

    /// A face, with its template.
    fn cell(&self, face: FaceId) -> (Cell, &Template) {
        let cell = self.cells[face.index()];
        (cell, &self.templates[cell.template as usize])
    }

    /// The face of a port, and which of its pieces begins or ends there.
    fn at(&self, port: Port) -> (FaceId, Option<u16>) {
        let face = self.stitches.mesh().face(HalfEdgeId(port / 2));
        let (cell, template) = self.cell(face);
        (face, template.piece_at[(port - cell.ports) as usize])
    }

    /// Whether a piece begins or ends at a port of a half-edge.
    pub fn has_piece_at(&self, port: Port) -> bool {
        self.at(port).1.is_some()
    }

    /// The piece at a port of a half-edge.
    pub fn piece_at(&self, port: Port) -> Option<Piece<'_>> {
        let (face, piece) = self.at(port);
        let i = piece?;
        let (cell, template) = self.cell(face);
        let piece = &template.pieces[usize::from(i)];
        Some(Piece {
            number: cell.pieces + u32::from(i),
            from: cell.ports + Port::from(piece.from),
            to: cell.ports + Port::from(piece.to),
            first: cell.visits + u32::from(piece.visits.start),
            nodes: &template.visits[usize::from(piece.visits.start)..usize::from(piece.visits.end)],
            nodes_before: cell.nodes,
            dye: self.stitches.dyes()[face.index()],
            own: piece.own,
        })
    }

    /// Both ports of all pieces, in the order of their numbers.
    pub fn ends(&self) -> impl Iterator<Item = [Port; 2]> {
        self.stitches.mesh().faces().flat_map(|face| {
            let (cell, template) = self.cell(face);
            template.pieces.iter().map(move |p| [p.from, p.to].map(|port| cell.ports + Port::from(port)))
        })
    }

    /// A node. Its visits are numbered as in the draft.
    pub fn node(&self, node: NodeId, vertex_normals: &[DVec3]) -> Node {
        let face = self.of_node[node.index()];
        let (cell, template) = self.cell(face);
        let template = &template.nodes[(node.0 - cell.nodes) as usize];
        let (mut position, mut normal) = (DVec3::ZERO, DVec3::ZERO);
        for (v, weight) in self.stitches.mesh().face_vertices(face).zip(&template.weights) {
            position += self.stitches.mesh().position(v) * *weight;
            normal += vertex_normals[v.index()] * *weight;
        }
        let visits = template.stack.iter().map(|v| VisitId(cell.visits + u32::from(*v)));
        Node {
            position,
            normal: normal.normalize_or(DVec3::Z),
            visits: few(visits),
            face: Some(face),
            kind: template.kind,
        }
    }

    /// The way outward from a node: see [`super::draft::Draft::node`].
    pub fn outward(&self, node: NodeId) -> DVec3 {
        let face = self.of_node[node.index()];
        let (cell, template) = self.cell(face);
        let template = &template.nodes[(node.0 - cell.nodes) as usize];
        let corners = self.stitches.mesh().face_vertices(face);
        corners.zip(&template.outward).map(|(v, w)| self.stitches.mesh().position(v) * *w).sum()
    }

    /// All nodes, their visits numbered as in the draft.
    pub fn nodes(&self, vertex_normals: &[DVec3]) -> impl IndexedParallelIterator<Item = Node> {
        (0..self.node_count()).into_par_iter().map(|n| self.node(NodeId::new(n), vertex_normals))
    }

    /// All stitch contacts.
    pub fn contacts(
        &self,
        number: impl Fn(u32) -> VisitId + Sync + Send,
    ) -> impl IndexedParallelIterator<Item = StitchContact> {
        let of_contact = owners(self.cells.iter().map(|b| b.contacts));
        of_contact.into_par_iter().enumerate().map(move |(c, face)| {
            let (cell, template) = self.cell(face);
            let contact = &template.contacts[c - cell.contacts as usize];
            let wrapping = self.stitches.wrappings()[face.index()];
            contact.numbered(wrapping, |v| number(cell.visits + u32::from(v)))
        })
    }

    /// Whether two ports are of the two sides of one edge.
    pub fn lie_across(&self, port: Port, other: Port) -> bool {
        (port as usize) < self.port_count()
            && self.stitches.mesh().twin(HalfEdgeId(port / 2)) == Some(HalfEdgeId(other / 2))
    }

    /// For every port of a half-edge the one across its edge.
    pub fn joined_across_edges(&self) -> Vec<Port> {
        let mesh = self.stitches.mesh();
        let mut joined = vec![LOOSE; self.port_count()];
        joined.par_chunks_exact_mut(2).enumerate().for_each(|(h, ports)| {
            let h = HalfEdgeId::new(h);
            let Some(twin) = mesh.twin(h) else { return };
            let (cell, template) = self.cell(mesh.face(h));
            if template.ports.is_wale((h.0 - cell.ports / 2) as usize) {
                ports[0] = wale_port(twin);
            } else {
                ports.copy_from_slice(&[1, 0].map(|place| course_port(twin, place)));
            }
        });
        joined
    }
}

/// A list that most often fits in its place, without asking for each thing whether it still does.
pub(super) fn few<T: Copy + Default, const N: usize>(
    things: impl ExactSizeIterator<Item = T>,
) -> SmallVec<[T; N]> {
    let count = things.len();
    if count > N {
        return things.collect();
    }
    let mut place = [T::default(); N];
    place.iter_mut().zip(things).for_each(|(at, thing)| *at = thing);
    SmallVec::from_buf_and_len(place, count)
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
