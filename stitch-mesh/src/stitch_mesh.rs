//! The stitch mesh: one face a stitch (stages 2 to 4 of the flow; Yuksel et al. §4).
//!
//! # Invariants
//! - Every face has exactly two wale edges. Its half-edges stand in a fixed order: **bottoms left to right, right wale,
//!   tops right to left, left wale**, and its stitch has as many bottoms and tops as the face. So where an edge lies in its
//!   face says what it is, and no label can contradict it.
//! - Neighbours in a row meet right wale to left wale.
//! - Two rows meet course to course: usually tops to bottoms; tops to tops or bottoms to bottoms where the wale directions
//!   oppose each other (§4.4).
//!
//! Beside its stitch a face has the colour of its yarn, how that is wrapped and, where it was cut from a face of the input, its
//! place there.
//! Cables, seams, live edges and the spiral layout are [`Marks`] on edges, named by their vertices.
//!
//! Changing the stitch of a face keeps all ids; what changes faces builds a new mesh ([`crate::edit`]).

use crate::dye::Dye;
use crate::ids::{FaceId, HalfEdgeId};
use crate::marks::Marks;
use crate::mesh::{MeshError, PolygonMesh};
use crate::stitch::Stitch;
use crate::wrapping::{Wrapping, WrappingError};
use glam::DVec3;
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;
use std::sync::Arc;

/// A mesh of stitches. See the module.
#[derive(Clone, Debug, PartialEq)]
pub struct StitchMesh {
    /// Shared between all states of a fabric that is edited without changing its faces.
    mesh: Arc<PolygonMesh>,
    stitches: Vec<Stitch>,
    /// Colour of the yarn with which each stitch is worked. Shared, like the wrappings and places, between states in which they are the
    /// same.
    pub(crate) dyes: Arc<Vec<Dye>>,
    pub(crate) wrappings: Arc<Vec<Wrapping>>,
    pub(crate) places: Arc<Vec<Option<Place>>>,
    pub(crate) marks: Marks,
}

/// Where in the input mesh a stitch was cut from: when the input is cut again, a stitch in the same place keeps its type.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct Place {
    /// The face of the input mesh.
    pub face: FaceId,
    /// The row within it, from 0 at the bottom.
    pub row: u32,
    /// The stitch within that row, from 0 on the left.
    pub column: u32,
}

/// Why a mesh with stitches is not a stitch mesh, or a stitch cannot be set.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum StitchMeshError {
    /// The faces do not make a mesh.
    #[error(transparent)]
    Mesh(#[from] MeshError),
    /// The numbers of faces and stitches differ.
    #[error("{faces} faces, but {stitches} stitches")]
    Count {
        /// Number of faces.
        faces: usize,
        /// Number of stitches.
        stitches: usize,
    },
    /// A stitch with other numbers of bottoms and tops than its face.
    #[error("face {face} has {edges} course edges; {stitch} joins {bottoms} loops below to {tops} above")]
    Arity {
        /// The face.
        face: FaceId,
        /// Its course edges, bottoms and tops together.
        edges: usize,
        /// The stitch.
        stitch: String,
        /// Its bottoms.
        bottoms: usize,
        /// Its tops.
        tops: usize,
    },
    /// Neighbours that do not meet right wale to left wale.
    #[error(
        "the wale edge between faces {0} and {1} is not a right edge of one and a left edge of the other"
    )]
    Wales(FaceId, FaceId),
    /// A face that does not exist.
    #[error("there is no face {0}")]
    NoFace(FaceId),
    /// A stitch whose loops below would be held by nothing.
    #[error("face {face} cannot be {stitch}: the loops below it would be held by nothing")]
    HoldsNothing {
        /// The face.
        face: FaceId,
        /// The stitch.
        stitch: String,
    },
    /// Wrapping that no stitch has.
    #[error(transparent)]
    Wrapping(#[from] WrappingError),
    /// A stitch that pulls its yarn through loops, where there are none below.
    #[error("face {face} cannot be {stitch}: there is no loop below it; only yarn-overs begin from nothing")]
    NothingBelow {
        /// The face.
        face: FaceId,
        /// The stitch.
        stitch: String,
    },
}

impl StitchMesh {
    /// Puts mesh and stitches together.
    ///
    /// # Errors
    /// [`StitchMeshError`] where an invariant does not hold.
    pub fn new(mesh: PolygonMesh, stitches: Vec<Stitch>) -> Result<Self, StitchMeshError> {
        let faces = stitches.len();
        let stitch_mesh = Self {
            dyes: Arc::new(vec![Dye::UNDYED; faces]),
            wrappings: Arc::new(vec![Wrapping::OF_MATERIAL; faces]),
            places: Arc::new(vec![None; faces]),
            ..Self::unchecked(mesh, stitches)?
        };
        stitch_mesh.check(stitch_mesh.mesh.faces())?;
        Ok(stitch_mesh)
    }

    /// As [`Self::new`], where all faces but some have been beside the same ones in a stitch mesh before. Colours, wrappings and places are
    /// still to be given.
    pub(crate) fn refaced(
        mesh: PolygonMesh,
        stitches: Vec<Stitch>,
        others: impl Iterator<Item = FaceId>,
    ) -> Result<Self, StitchMeshError> {
        let stitch_mesh = Self::unchecked(mesh, stitches)?;
        let mesh = stitch_mesh.mesh();
        let beside = |f| mesh.face_half_edges(f).filter_map(|h| mesh.face_across(h)).chain([f]);
        let near: BTreeSet<FaceId> = others.flat_map(beside).collect();
        stitch_mesh.check(near.iter().copied())?;
        Ok(stitch_mesh)
    }

    /// Only as many stitches as faces, and nothing more of them.
    fn unchecked(mesh: PolygonMesh, stitches: Vec<Stitch>) -> Result<Self, StitchMeshError> {
        if stitches.len() != mesh.face_count() {
            return Err(StitchMeshError::Count { faces: mesh.face_count(), stitches: stitches.len() });
        }
        Ok(Self { mesh: Arc::new(mesh), stitches, ..Self::empty() })
    }

    /// Looks through some faces.
    fn check(&self, faces: impl Iterator<Item = FaceId> + Clone) -> Result<(), StitchMeshError> {
        faces.clone().try_for_each(|face| self.check_fit(face, self.stitch(face)))?;
        for face in faces {
            if let Some(twin) = self.mesh.twin(self.right(face)) {
                let other = self.mesh.face(twin);
                if self.left(other) != twin {
                    return Err(StitchMeshError::Wales(face, other));
                }
            }
        }
        Ok(())
    }

    /// No stitches at all: what a project of woven cloth has.
    pub fn empty() -> Self {
        Self {
            mesh: Arc::new(PolygonMesh::empty()),
            stitches: Vec::new(),
            dyes: Arc::default(),
            wrappings: Arc::default(),
            places: Arc::default(),
            marks: Marks::default(),
        }
    }

    /// Fit of a stitch in its face: as many edges, old loops to be pulled through, and nothing dropped.
    fn check_fit(&self, face: FaceId, stitch: &Stitch) -> Result<(), StitchMeshError> {
        let edges = self.mesh.face_half_edges(face).len() - 2;
        let (bottoms, tops) = (stitch.bottoms(), stitch.tops());
        if edges != bottoms + tops {
            return Err(StitchMeshError::Arity { face, edges, stitch: stitch.to_string(), bottoms, tops });
        }
        let below = self.mesh.face_half_edges(face).take(bottoms);
        if !stitch.holds() && (bottoms > 1 || below.into_iter().any(|h| self.mesh.twin(h).is_some())) {
            return Err(StitchMeshError::HoldsNothing { face, stitch: stitch.to_string() });
        }
        if bottoms == 0 && stitch.holds() {
            return Err(StitchMeshError::NothingBelow { face, stitch: stitch.to_string() });
        }
        Ok(())
    }

    /// The same stitches with the vertices at other positions [m]. All ids survive.
    ///
    /// # Errors
    /// As [`PolygonMesh::moved_to`].
    pub fn moved_to(&self, positions: Vec<DVec3>) -> Result<Self, StitchMeshError> {
        Ok(Self { mesh: Arc::new(self.mesh.moved_to(positions)?), ..self.clone() })
    }

    /// The mesh.
    pub fn mesh(&self) -> &PolygonMesh {
        &self.mesh
    }

    /// Whether the mesh is the one of `other`, every id the same.
    pub fn has_mesh_of(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.mesh, &other.mesh) || self.mesh == other.mesh
    }

    /// Whether this is a fabric that `other` was edited from, or the other way round, without changing any face: ids, rows and
    /// numbers of loops are the same.
    pub fn shares_mesh_of(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.mesh, &other.mesh)
    }

    /// Whether this is `other`, from which it was edited without changing any face.
    pub fn is_as(&self, other: &Self) -> bool {
        self.shares_mesh_of(other)
            && self.stitches == other.stitches
            && self.dyes == other.dyes
            && self.wrappings == other.wrappings
            && self.marks == other.marks
    }

    /// All stitches, [face_count].
    pub fn stitches(&self) -> &[Stitch] {
        &self.stitches
    }

    /// The stitch of a face.
    pub fn stitch(&self, face: FaceId) -> &Stitch {
        &self.stitches[face.index()]
    }

    /// Changes the stitch of a face to one with the same numbers of bottoms and tops. All ids survive.
    ///
    /// # Errors
    /// [`StitchMeshError`] where the stitch does not fit; nothing is changed then.
    pub fn set_stitch(&mut self, face: FaceId, stitch: Stitch) -> Result<(), StitchMeshError> {
        let old = self.stitches.get(face.index()).ok_or(StitchMeshError::NoFace(face))?;
        if (old.bottoms(), old.tops()) != (stitch.bottoms(), stitch.tops()) {
            let edges = old.bottoms() + old.tops();
            let (bottoms, tops) = (stitch.bottoms(), stitch.tops());
            return Err(StitchMeshError::Arity { face, edges, stitch: stitch.to_string(), bottoms, tops });
        }
        self.check_fit(face, &stitch)?;
        self.stitches[face.index()] = stitch;
        Ok(())
    }

    /// Colours of the yarn with which the stitches are worked, [face_count].
    pub fn dyes(&self) -> &[Dye] {
        &self.dyes
    }

    /// Changes the colour of the yarn with which a stitch is worked. All ids survive.
    ///
    /// # Errors
    /// There is no such face.
    pub fn set_dye(&mut self, face: FaceId, dye: Dye) -> Result<(), StitchMeshError> {
        *Arc::make_mut(&mut self.dyes).get_mut(face.index()).ok_or(StitchMeshError::NoFace(face))? = dye;
        Ok(())
    }

    /// How the yarns of the stitches are wrapped around each other, [face_count].
    pub fn wrappings(&self) -> &[Wrapping] {
        &self.wrappings
    }

    /// Changes how the yarns of a stitch are wrapped around each other. All ids survive.
    ///
    /// # Errors
    /// There is no such face, or no stitch is wrapped so; nothing is changed then.
    pub fn set_wrapping(&mut self, face: FaceId, wrapping: Wrapping) -> Result<(), StitchMeshError> {
        wrapping.validate()?;
        *Arc::make_mut(&mut self.wrappings).get_mut(face.index()).ok_or(StitchMeshError::NoFace(face))? =
            wrapping;
        Ok(())
    }

    /// Where in the input mesh the stitches were cut from, [face_count].
    pub fn places(&self) -> &[Option<Place>] {
        &self.places
    }

    /// Bottom half-edges of a face, left to right.
    pub fn bottoms(&self, face: FaceId) -> impl ExactSizeIterator<Item = HalfEdgeId> + use<> {
        self.mesh.face_half_edges(face).take(self.stitch(face).bottoms())
    }

    /// Top half-edges of a face, left to right (against the way the face runs).
    pub fn tops(&self, face: FaceId) -> impl ExactSizeIterator<Item = HalfEdgeId> + use<> {
        let stitch = self.stitch(face);
        self.mesh.face_half_edges(face).skip(stitch.bottoms() + 1).take(stitch.tops()).rev()
    }

    /// The right wale half-edge of a face, running up.
    pub fn right(&self, face: FaceId) -> HalfEdgeId {
        let first = self.mesh.first_half_edge(face).index();
        HalfEdgeId::new(first + self.stitch(face).bottoms())
    }

    /// The left wale half-edge of a face, running down.
    pub fn left(&self, face: FaceId) -> HalfEdgeId {
        let stitch = self.stitch(face);
        HalfEdgeId::new(self.right(face).index() + stitch.tops() + 1)
    }

    /// The way up across a face: from the middle of its bottom side to the middle of its top side [m].
    pub fn up(&self, face: FaceId) -> DVec3 {
        let middle = |a: HalfEdgeId, b: HalfEdgeId| {
            0.5 * (self.mesh.position(self.mesh.origin(a)) + self.mesh.position(self.mesh.tip(b)))
        };
        let (left, right) = (self.left(face), self.right(face));
        // The left wale edge runs down, the right one up.
        middle(left, right) - middle(right, left)
    }

    /// Whether a half-edge is a bottom of its face.
    pub fn is_bottom(&self, h: HalfEdgeId) -> bool {
        h < self.right(self.mesh.face(h))
    }

    /// Whether a half-edge is a wale edge.
    pub fn is_wale(&self, h: HalfEdgeId) -> bool {
        let face = self.mesh.face(h);
        h == self.right(face) || h == self.left(face)
    }

    /// The faces above a face, left to right; those it meets top to bottom only.
    pub fn above(&self, face: FaceId) -> impl Iterator<Item = FaceId> + '_ {
        self.tops(face)
            .filter_map(|h| self.mesh.twin(h))
            .filter(|t| self.is_bottom(*t))
            .map(|t| self.mesh.face(t))
    }

    /// The faces below a face, left to right; those it meets bottom to top only.
    pub fn below(&self, face: FaceId) -> impl Iterator<Item = FaceId> + '_ {
        self.bottoms(face)
            .filter_map(|h| self.mesh.twin(h))
            .filter(|t| !self.is_bottom(*t))
            .map(|t| self.mesh.face(t))
    }

    /// Number of loops: top edges of all faces.
    pub fn loop_count(&self) -> usize {
        self.stitches.iter().map(Stitch::tops).sum()
    }
}
