//! Relaxing the stitch mesh (stage 4 of the flow; Yuksel et al., *Stitch Meshes for Modeling Knitted Clothing with Yarn-level
//! Detail*, 2012, §6.1).
//!
//! A tessellation puts stitches evenly on the edges of a coarse mesh, so they are wide where its faces are and narrow where
//! those are, and lie on flat polygons. Here their vertices become springs and slide on the smooth surface of the input
//! until all stitches are as nearly of one size as the surface allows. Only then is the yarn laid.
//!
//! # Theory
//! | | energy | source | file |
//! |---|---|---|---|
//! | stretch of edges and of diagonals of sub-quads | κ (d − ℓ − ℓ ln(d/ℓ)), κ = 2 | eq. 2, Fig. 15 | `stretch`, `elements` |
//! | shear of corners of sub-quads | κ/4 (a·b)², κ = 0.2 | eq. 3 | `shear` |
//! | wale strut | κ (r − d)² / 2r, κ = 2 | eq. 4 | `strut` |
//! | folding of corners, on a surface | κ (ln(s₀/s) + s/s₀ − 1), κ = 0.2 | not in the paper | `fold` |
//!
//! Rest lengths follow from N r_wale r_course = αA and r_wale = a r_course ([`RestLengths`]). All lengths are in units of
//! √(r_course r_wale) inside, called stitches here, so energies and forces have the unit of κ.
//!
//! # Practice
//! 1. `surface`: Catmull–Clark levels of the input until there are about as many quads as stitches, cut into triangles;
//! 2. `locate`: vertices looked up on the flat input and carried onto the smooth triangles, border vertices onto borders;
//! 3. `relaxer`: implicit steps (eq. 1), each solved by `conjugate` on the `system` of tangential unknowns and walked on the
//!    triangles by `walk`, until one moves nothing and gains nothing.
//!
//! A [`MeshRelaxation`] lives as long as somebody watches it; it holds a copy of the stitches and never changes the one that
//! it was made from. It can be looked at and dropped between any two steps; a step takes about 0.1 s for 20 000 stitches.
//!
//! # Differences from the paper
//! - All forces are gradients of one energy (eq. 3 and 4 as printed are not; see `shear`, `strut`). So a step can be judged by
//!   whether it lowers the energy: it does, or it is shortened. The paper names no step size and no end.
//! - Steps are taken in two unknowns a vertex, which comes to the same as Baraff & Witkin's filtered CG (see `system`).
//! - Corners of sub-quads resist folding over (`fold`).
//! - a = 0.75 instead of 1, as stitches are laid 2.25 mm by 3 mm here; N counts loops, not faces ([`RestLengths::new`]);
//!   α = 0.95 ([`RelaxParams::fill`]).
//! - A vertex at the corner of a border stays there; the paper does not say. Otherwise a square would turn in its frame.
//! - Without a surface vertices move in space with the same forces, less that of folding.
//!
//! # What was learnt
//! On two cores, to the end (`cargo bench --bench mesh_relax`; processor seconds, as other work ran beside it, and half of
//! that on the clock of two free cores):
//!
//! | | stitches | steps | iterations of CG | processor time [s] |
//! |---|---|---|---|---|
//! | pullover | 23 168 | 6 | 443 | 1.0 … 1.5 |
//! | the same, finer | 65 654 | 7 | 926 | 4.8 … 6.1 |
//! | tube, edges of a third to two and a half rest lengths | 21 600 | 9 | 997 | 2.0 |
//!
//! - Expected were 30 steps of 60 iterations. It is 6 to 9 steps of 100: the energy is so nearly convex that h may be
//!   ten times as large after every step, and Newton's method does the rest. What limits a bad start is how far a vertex may
//!   go in one step.
//! - An iteration takes 2.6 ms at 65 000 stitches, and all of CG about two thirds of the time. Its iterations grow with the
//!   number of stitches across the fabric, as the preconditioner sees one vertex at a time: for much larger garments a coarse
//!   level is what to add first.
//! - A tube may creep round itself for ever, at 1e-5 of its energy a step: hence [`RelaxParams::tolerance`] alone is no end.
//! - Without `fold` the crown of a hat with too few decreases came out with stitches under each other, at a *lower* energy.

mod conjugate;
mod elements;
mod fold;
mod lists;
mod locate;
mod params;
mod relaxer;
mod shear;
mod stretch;
mod strut;
mod surface;
mod system;
mod walk;

#[cfg(test)]
mod tests;

pub use params::{RelaxError, RelaxParams, RestLengths};
pub use relaxer::StepFacts;

use elements::Elements;
use glam::DVec3;
use locate::locate;
use relaxer::{Relaxer, Space};
use std::ops::ControlFlow;
use stitch_mesh::ids::FaceId;
use stitch_mesh::mesh::PolygonMesh;
use stitch_mesh::stitch_mesh::{StitchMesh, StitchMeshError};
use surface::Surface;

/// A relaxation of a stitch mesh, step by step. See the module.
pub struct MeshRelaxation {
    stitches: StitchMesh,
    rest: RestLengths,
    how: How,
}

enum How {
    OnSurface(Box<Relaxer<2, Surface>>),
    InSpace(Box<Relaxer<3, Space>>),
}

/// How a run ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RelaxEnd {
    /// The stitches have come to rest.
    Settled,
    /// The callback had enough. The stitches are where the last step brought them.
    Interrupted,
}

impl MeshRelaxation {
    /// Begins a relaxation: on the smooth surface of `input`, or in space without it.
    ///
    /// # Errors
    /// [`RelaxError`].
    pub fn new(
        stitches: &StitchMesh,
        input: Option<&PolygonMesh>,
        params: RelaxParams,
    ) -> Result<Self, RelaxError> {
        params.validate()?;
        let mesh = stitches.mesh();
        let mut surface = input.map(|input| Surface::new(input, mesh.face_count()));
        let area = match &surface {
            Some(surface) => surface.area(),
            None => mesh.faces().map(|f| mesh.face_area_vector(f).length()).sum(),
        };
        let rest = RestLengths::new(stitches, area, params.aspect, params.fill)?;
        let unit = rest.unit();
        let x: Vec<DVec3> = mesh.positions().iter().map(|p| *p / unit).collect();
        let elements = Elements::new(stitches, &rest);
        let rest_wale = rest.wale / unit;
        let how = match surface.take() {
            Some(mut surface) => {
                surface.scale(unit);
                let places = locate(&surface, mesh, &x);
                How::OnSurface(Box::new(Relaxer::new(surface, places, elements, params, rest_wale)))
            }
            None => How::InSpace(Box::new(Relaxer::new(Space, x, elements, params, rest_wale))),
        };
        Ok(Self { stitches: stitches.clone(), rest, how })
    }

    /// One step. Does nothing once settled.
    pub fn step(&mut self) -> StepFacts {
        match &mut self.how {
            How::OnSurface(relaxer) => relaxer.step(),
            How::InSpace(relaxer) => relaxer.step(),
        }
    }

    /// Whether the stitches have come to rest, or the most steps are done.
    pub fn is_settled(&self) -> bool {
        match &self.how {
            How::OnSurface(relaxer) => relaxer.settled,
            How::InSpace(relaxer) => relaxer.settled,
        }
    }

    /// Steps until settled, or until `watch`, called after every step, breaks off.
    pub fn run(&mut self, watch: &mut dyn FnMut(&Self, &StepFacts) -> ControlFlow<()>) -> RelaxEnd {
        while !self.is_settled() {
            let facts = self.step();
            if watch(self, &facts).is_break() {
                return RelaxEnd::Interrupted;
            }
        }
        RelaxEnd::Settled
    }

    /// Where the vertices of the stitch mesh are now, [vertex_count] [m].
    pub fn positions(&self) -> Vec<DVec3> {
        let x = match &self.how {
            How::OnSurface(relaxer) => &relaxer.x,
            How::InSpace(relaxer) => &relaxer.x,
        };
        let unit = self.rest.unit();
        x.iter().map(|p| *p * unit).collect()
    }

    /// The stitch mesh with its vertices where they are now.
    ///
    /// # Errors
    /// Positions that make no mesh: a face was pressed to nothing.
    pub fn stitches(&self) -> Result<StitchMesh, StitchMeshError> {
        self.stitches.moved_to(self.positions())
    }

    /// Size of a stitch at rest.
    pub fn rest(&self) -> RestLengths {
        self.rest
    }

    /// How much each face is stretched now, [face_count]: see [`RestLengths::strain`].
    pub fn strain(&self) -> Vec<f64> {
        self.rest.strain(&self.stitches, &self.positions())
    }

    /// The `count` faces furthest from rest and their strain, the furthest first.
    pub fn worst(&self, count: usize) -> Vec<(FaceId, f64)> {
        worst(&self.strain(), count)
    }
}

/// The `count` faces with the largest strain, either way, the largest first.
pub fn worst(strain: &[f64], count: usize) -> Vec<(FaceId, f64)> {
    let mut faces: Vec<(FaceId, f64)> =
        strain.iter().enumerate().map(|(f, s)| (FaceId::new(f), *s)).collect();
    faces.sort_by(|(f, a), (g, b)| b.abs().total_cmp(&a.abs()).then(f.cmp(g)));
    faces.truncate(count);
    faces
}
