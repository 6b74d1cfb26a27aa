//! Cables: loops that change places between two rows (Yuksel et al. §4.5, Fig. 9).
//!
//! A cable is a run of course edges on which the order of the loops is marked. The paper replaces the edges by one cable face
//! right before it generates the yarn; here they stay edges, and the yarn is laid across them from the loop below to the place
//! above that the cable gives it (see [`crate::lay`]).
//!
//! Loops cross in **strands** that keep their loops side by side: `strands` says how many loops each has, left to right below;
//! `order` which strand stands where above, left to right; `front` which lies over which, front to back. A left cross of two
//! over two (a knitter's C4F) is strands 2 2, order 1 0, front 1 0: the right strand goes to the left, in front.

use crate::ids::{HalfEdgeId, VertexId};
use crate::stitch_mesh::StitchMesh;
use serde::{Deserialize, Serialize};

/// Loops in one cable at the most: two strands of eight.
pub const MOST_LOOPS: usize = 16;

/// A cable. See the module.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Cable {
    /// Vertices along the course edges, left to right seen from the front: one more than there are loops.
    pub path: Vec<VertexId>,
    /// Loops of each strand, left to right below.
    pub strands: Vec<u8>,
    /// Strands left to right above.
    pub order: Vec<u8>,
    /// Strands front to back.
    pub front: Vec<u8>,
}

/// Why a cable cannot cross.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum CableError {
    /// The numbers of loops differ.
    #[error("the strands have {strands} loops, but the cable lies on {edges} course edges")]
    Length {
        /// Loops in the strands.
        strands: usize,
        /// Edges of the path.
        edges: usize,
    },
    /// Not a cable at all, or too large.
    #[error("a cable needs between 2 and {MOST_LOOPS} loops in at least two strands; these are {0}")]
    Size(usize),
    /// `order` or `front` is not a permutation.
    #[error("{0} has to name each of the strands 0–{1} once")]
    NotAnOrder(&'static str, usize),
    /// Nothing crosses.
    #[error("all strands stay where they are: nothing crosses")]
    NothingCrosses,
    /// Two vertices of the path are not the ends of a course edge between two rows, left to right.
    #[error(
        "{0}–{1} is not a course edge with a stitch below and one above, from left to right as seen from the front; \
         loops can only cross between two rows"
    )]
    NoCourse(VertexId, VertexId),
    /// The path has gone round a tube and comes to an edge again.
    #[error("the cable goes round the tube and comes to edge {0}–{1} again: it has more loops than the row")]
    Round(VertexId, VertexId),
    /// An edge lies in another cable.
    #[error("edge {0}–{1} is in a cable already: clear that one first")]
    Taken(VertexId, VertexId),
}

impl Cable {
    /// A cable of two strands along `path`. A left cross brings the right strand to the left in front of the other; a right
    /// cross the left strand to the right.
    pub fn cross(path: Vec<VertexId>, left: u8, right: u8, to_left: bool) -> Self {
        let front = if to_left { vec![1, 0] } else { vec![0, 1] };
        Self { path, strands: vec![left, right], order: vec![1, 0], front }
    }

    /// Number of loops.
    pub fn loops(&self) -> usize {
        self.strands.iter().map(|n| usize::from(*n)).sum()
    }

    /// For each loop below, left to right: its place above, and its depth (0 is the front).
    pub fn crossing(&self) -> Vec<(usize, usize)> {
        let place = |list: &[u8], strand: usize| list.iter().position(|s| usize::from(*s) == strand);
        let size = |s: &u8| usize::from(self.strands[usize::from(*s)]);
        let mut crossing = Vec::with_capacity(self.loops());
        for strand in 0..self.strands.len() {
            let above = place(&self.order, strand).unwrap_or(strand);
            let first: usize = self.order[..above].iter().map(size).sum();
            let depth = place(&self.front, strand).unwrap_or(strand);
            crossing.extend((0..usize::from(self.strands[strand])).map(|i| (first + i, depth)));
        }
        crossing
    }

    fn check_shape(&self) -> Result<(), CableError> {
        let (loops, edges) = (self.loops(), self.path.len().saturating_sub(1));
        if loops != edges {
            return Err(CableError::Length { strands: loops, edges });
        }
        if !(2..=MOST_LOOPS).contains(&loops) || self.strands.len() < 2 || self.strands.contains(&0) {
            return Err(CableError::Size(loops));
        }
        let all: Vec<u8> = (0..self.strands.len() as u8).collect();
        for (name, list) in [("order", &self.order), ("front", &self.front)] {
            let mut sorted = list.clone();
            sorted.sort_unstable();
            if sorted != all {
                return Err(CableError::NotAnOrder(name, all.len() - 1));
            }
        }
        if self.order == all { Err(CableError::NothingCrosses) } else { Ok(()) }
    }

    /// Whether the cable can cross on `stitches`, whatever other cables there are.
    ///
    /// # Errors
    /// Why it cannot.
    pub fn check(&self, stitches: &StitchMesh) -> Result<(), CableError> {
        self.check_shape()?;
        let mesh = stitches.mesh();
        for ends in self.path.windows(2) {
            // Tops run from right to left.
            let top = mesh.half_edge_between(ends[1], ends[0]);
            let is_course = top.is_some_and(|h| {
                let above = mesh.twin(h).is_some_and(|t| stitches.is_bottom(t));
                above && !stitches.is_bottom(h) && !stitches.is_wale(h)
            });
            if !is_course {
                return Err(CableError::NoCourse(ends[0], ends[1]));
            }
        }
        let twice = |i: usize| self.path[..i].windows(2).any(|w| *w == self.path[i - 1..=i]);
        match (2..self.path.len()).find(|i| twice(*i)) {
            Some(i) => Err(CableError::Round(self.path[i - 1], self.path[i])),
            None => Ok(()),
        }
    }

    /// Its strands as knitters count them, and of two which way the one in front goes: "2/2 left".
    pub fn name(&self) -> String {
        let strands: Vec<String> = self.strands.iter().map(u8::to_string).collect();
        let way = match (self.strands.len(), self.front.first()) {
            (2, Some(1)) => " left",
            (2, _) => " right",
            _ => "",
        };
        strands.join("/") + way
    }

    /// Whether the edge between two vertices lies in this cable.
    pub fn covers(&self, a: VertexId, b: VertexId) -> bool {
        self.path.windows(2).any(|w| *w == [a, b] || *w == [b, a])
    }
}

impl StitchMesh {
    /// The cables.
    pub fn cables(&self) -> &[Cable] {
        &self.marks().cables
    }

    /// The bottom edge into which the loop on a top edge goes: the one across, or where a cable takes it.
    pub fn loop_above(&self, top: HalfEdgeId) -> Option<HalfEdgeId> {
        let mesh = self.mesh();
        let (left, right) = (mesh.tip(top), mesh.origin(top));
        let crossed = self.cables().iter().find_map(|cable| {
            let i = cable.path.windows(2).position(|w| *w == [left, right])?;
            let (place, _) = cable.crossing()[i];
            mesh.half_edge_between(cable.path[place], cable.path[place + 1])
        });
        // Where tops meet tops the yarn goes on as that of the other loop.
        crossed.or_else(|| mesh.twin(top).filter(|t| self.is_bottom(*t)))
    }

    /// Sets a cable. All ids survive.
    ///
    /// # Errors
    /// Why it cannot cross; nothing is changed then.
    pub fn set_cable(&mut self, cable: Cable) -> Result<(), CableError> {
        cable.check(self)?;
        for ends in cable.path.windows(2) {
            if self.cables().iter().any(|c| c.covers(ends[0], ends[1])) {
                return Err(CableError::Taken(ends[0], ends[1]));
            }
        }
        self.marks_mut().cables.push(cable);
        Ok(())
    }

    /// Clears the cables that one of these edges (each given by its ends) lies in. Returns how many there were.
    pub fn clear_cables(&mut self, edges: &[[VertexId; 2]]) -> usize {
        let cables = &mut self.marks_mut().cables;
        let before = cables.len();
        cables.retain(|c| !edges.iter().any(|[a, b]| c.covers(*a, *b)));
        before - cables.len()
    }
}
