//! What is marked on the edges of a stitch mesh: cables, seams, live edges, the spiral layout.
//!
//! Edges are named by their vertices, which outlive most edits of the faces.

use crate::cable::{Cable, CableError};
use crate::dye::Dye;
use crate::ids::{FaceId, HalfEdgeId, VertexId};
use crate::seam::{Seam, SeamError, sorted};
use crate::stitch_mesh::{Place, StitchMesh};
use crate::wrapping::{Wrapping, WrappingError};
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;
use std::sync::Arc;

/// What is marked on the edges of a stitch mesh.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Marks {
    /// Loops that change places between two rows.
    pub cables: Vec<Cable>,
    /// Borders that are sewn together.
    pub seams: Vec<Seam>,
    /// Top edges on the border that are not bound off; ends with the smaller first.
    pub live: BTreeSet<[VertexId; 2]>,
    /// Whether the closed rows of tubes go on into one another as a spiral, instead of being rings of their own.
    pub spiral: bool,
}

/// A mark that does not fit its mesh.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum MarkError {
    /// A cable that cannot cross.
    #[error(transparent)]
    Cable(#[from] CableError),
    /// A seam that cannot be sewn.
    #[error(transparent)]
    Seam(#[from] SeamError),
    /// A live edge that is not a top edge on the border.
    #[error("edge {0}–{1} cannot be left live: only loops at a border above a stitch are on the needle")]
    NotLive(VertexId, VertexId),
    /// Wrapping that no stitch has.
    #[error("face {0}: {1}")]
    Wrapping(FaceId, WrappingError),
    /// Colours, wrappings or places that are not one for each face.
    #[error("{given} {what} for {faces} faces")]
    Count {
        /// Of what.
        what: &'static str,
        /// How many are given.
        given: usize,
        /// How many faces there are.
        faces: usize,
    },
}

impl StitchMesh {
    /// What is marked on edges.
    pub fn marks(&self) -> &Marks {
        &self.marks
    }

    pub(crate) fn marks_mut(&mut self) -> &mut Marks {
        &mut self.marks
    }

    /// The same mesh with other colours, wrappings, places and marks.
    ///
    /// # Errors
    /// Where one does not fit.
    pub fn with(
        mut self,
        dyes: impl Into<Arc<Vec<Dye>>>,
        wrappings: impl Into<Arc<Vec<Wrapping>>>,
        places: impl Into<Arc<Vec<Option<Place>>>>,
        marks: Marks,
    ) -> Result<Self, MarkError> {
        let (dyes, wrappings, places) = (dyes.into(), wrappings.into(), places.into());
        let faces = self.mesh().face_count();
        let counts = [("colours", dyes.len()), ("wrappings", wrappings.len()), ("places", places.len())];
        for (what, given) in counts {
            if given != faces {
                return Err(MarkError::Count { what, given, faces });
            }
        }
        for (face, wrapping) in self.mesh().faces().zip(&*wrappings) {
            wrapping.validate().map_err(|error| MarkError::Wrapping(face, error))?;
        }
        (self.dyes, self.wrappings, self.places) = (dyes, wrappings, places);
        self.marks = Marks::default();
        marks.cables.into_iter().try_for_each(|c| self.set_cable(c))?;
        marks.seams.into_iter().try_for_each(|s| self.sew(s))?;
        marks.live.into_iter().try_for_each(|e| self.set_live(e, true))?;
        self.marks.spiral = marks.spiral;
        Ok(self)
    }

    /// Leaves the loop on a top edge of the border live, as on a needle, or has it bound off. All ids survive.
    ///
    /// # Errors
    /// There is no such loop; nothing is changed then.
    pub fn set_live(&mut self, [a, b]: [VertexId; 2], live: bool) -> Result<(), MarkError> {
        let h = self.mesh().edge_between(a, b).map(|e| self.mesh().edge_sides(e));
        match h {
            Some((h, None)) if !self.is_wale(h) && !self.is_bottom(h) => {}
            _ => return Err(MarkError::NotLive(a, b)),
        }
        let edge = sorted([a, b]);
        if live {
            self.marks.live.insert(edge)
        } else {
            self.marks.live.remove(&edge)
        };
        Ok(())
    }

    /// Whether the loop on a border half-edge is left live.
    pub fn is_live(&self, h: HalfEdgeId) -> bool {
        !self.marks.live.is_empty()
            && self.marks.live.contains(&sorted([self.mesh().origin(h), self.mesh().tip(h)]))
    }

    /// Knits closed rows as a spiral, or as rings. All ids survive.
    pub fn set_spiral(&mut self, spiral: bool) {
        self.marks.spiral = spiral;
    }
}
