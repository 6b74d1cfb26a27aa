//! Relaxing the stitch mesh (stage 4 of the flow; Yuksel et al. §6.1).

mod bvh;
mod conjugate;
mod elements;
mod fold;
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
