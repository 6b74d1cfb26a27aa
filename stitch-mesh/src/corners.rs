//! The corners of all faces, vertex by vertex: from these validation and the half-edge mesh find neighbours without hashing,
//! in time linear in the number of corners.

use rayon::prelude::*;

/// Where a face passes a vertex.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Corner {
    /// The vertex before this one in its face.
    pub before: u32,
    /// The vertex after it.
    pub after: u32,
    /// The half-edge that starts here, counted face by face.
    pub half_edge: u32,
}

/// All corners, sorted by vertex.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Corners {
    /// First corner of every vertex, and the end, [vertex_count + 1].
    starts: Vec<u32>,
    corners: Vec<Corner>,
}

impl Corners {
    /// Sorts the corners of `faces`, whose vertices are all below `vertex_count`.
    pub fn new(vertex_count: usize, faces: &[impl AsRef<[u32]>]) -> Self {
        let mut starts = vec![0u32; vertex_count + 1];
        for v in faces.iter().flat_map(AsRef::as_ref) {
            starts[*v as usize + 1] += 1;
        }
        for v in 0..vertex_count {
            starts[v + 1] += starts[v];
        }
        let mut filled = starts.clone();
        let nothing = Corner { before: 0, after: 0, half_edge: 0 };
        let mut corners = vec![nothing; starts[vertex_count] as usize];
        let mut half_edge = 0;
        for vertices in faces.iter().map(AsRef::as_ref) {
            let n = vertices.len();
            for i in 0..n {
                let at = &mut filled[vertices[i] as usize];
                let (before, after) = (vertices[(i + n - 1) % n], vertices[(i + 1) % n]);
                corners[*at as usize] = Corner { before, after, half_edge };
                *at += 1;
                half_edge += 1;
            }
        }
        Self { starts, corners }
    }

    /// Corners that are given vertex by vertex, in the order of the faces: `list` adds those of a vertex.
    pub fn listed(
        vertex_count: usize,
        corner_count: usize,
        mut list: impl FnMut(u32, &mut Vec<Corner>),
    ) -> Self {
        let mut starts = Vec::with_capacity(vertex_count + 1);
        let mut corners = Vec::with_capacity(corner_count);
        for vertex in 0..vertex_count as u32 {
            starts.push(corners.len() as u32);
            list(vertex, &mut corners);
        }
        starts.push(corners.len() as u32);
        Self { starts, corners }
    }

    /// The corners at a vertex, in the order of the faces.
    pub fn at(&self, vertex: u32) -> &[Corner] {
        let v = vertex as usize;
        &self.corners[self.starts[v] as usize..self.starts[v + 1] as usize]
    }

    /// The half-edge from one vertex to another.
    pub fn half_edge(&self, from: u32, to: u32) -> Option<u32> {
        self.at(from).iter().find(|c| c.after == to).map(|c| c.half_edge)
    }

    /// Whether two half-edges lead the same way between the same vertices: then the mesh is not manifold there.
    pub fn has_doubles(&self) -> bool {
        (0..self.starts.len() as u32 - 1).into_par_iter().any(|v| self.has_double_at(v))
    }

    /// Whether two of them begin at a vertex.
    pub fn has_double_at(&self, vertex: u32) -> bool {
        let around = self.at(vertex);
        around.iter().enumerate().any(|(i, c)| around[..i].iter().any(|d| d.after == c.after))
    }
}
