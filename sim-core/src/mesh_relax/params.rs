//! What can be chosen about a relaxation, and the rest lengths that follow.

use glam::DVec3;
use stitch_mesh::mesh::MeshError;
use stitch_mesh::stitch_mesh::StitchMesh;

/// Parameters of a relaxation. The paper's stiffnesses, "no parameter tuning for different examples".
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RelaxParams {
    /// a: height of a stitch over its width at rest, r_wale / r_course. The paper has 1; stitches are laid 2.25 mm high and
    /// 3 mm wide here, so 0.75.
    pub aspect: f64,
    /// α, 0 … 1: how much of the surface the stitches fill at rest. Below 1 all are a little stretched (at 0.95 by 2.6 %) and
    /// lie straight. At 1 the bundled pullover comes out a little more even (3.3 % rms instead of 3.4 %), but where stitches
    /// crowd they are pressed, and buckle sideways: the worst stitch at the crown of the hat is off by 40 % instead of 25 %.
    /// At 0.8 both are less even (4.0 % and 4.1 %).
    pub fill: f64,
    /// κ_stretch, the stiffness of edges and diagonals.
    pub stretch: f64,
    /// κ_shear, the stiffness of right angles.
    pub shear: f64,
    /// κ_wale, the stiffness of wales against bending.
    pub wale: f64,
    /// κ_fold, the stiffness of corners against being folded over, on a surface only. Not in the paper; with 0 crowns of hats
    /// fold.
    pub fold: f64,
    /// The relaxation is settled when an unshortened step moves no vertex further than this [stitches].
    pub tolerance: f64,
    /// It ends after so many steps in any case.
    pub most_steps: usize,
}

impl Default for RelaxParams {
    fn default() -> Self {
        Self {
            aspect: 0.75,
            fill: 0.95,
            stretch: 2.0,
            shear: 0.2,
            wale: 2.0,
            fold: 0.2,
            tolerance: 0.02,
            most_steps: 200,
        }
    }
}

/// Why a stitch mesh cannot be relaxed.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum RelaxError {
    /// A parameter outside of its range.
    #[error("{name} is {value}; it has to be {range}")]
    Parameter {
        /// Which.
        name: &'static str,
        /// Its value.
        value: f64,
        /// What it may be.
        range: &'static str,
    },
    /// Stitches without area: there is no size that they could have at rest.
    #[error("the fabric has an area of {0} m²; stitches need one above zero")]
    Area(f64),
    /// Relaxed positions that make no mesh.
    #[error("the relaxed stitches do not make a mesh: {0}")]
    Mesh(#[from] MeshError),
}

impl RelaxParams {
    /// Whether every parameter is in its range.
    ///
    /// # Errors
    /// [`RelaxError::Parameter`].
    pub fn validate(&self) -> Result<(), RelaxError> {
        let checks = [
            ("the aspect of a stitch", self.aspect, 0.05..=20.0, "between 0.05 and 20"),
            ("the fill", self.fill, 0.01..=1.0, "above 0 (0.01) and at most 1"),
            ("the stiffness of stretch", self.stretch, 1e-6..=1e6, "between 1e-6 and 1e6"),
            ("the stiffness of shear", self.shear, 0.0..=1e6, "between 0 and 1e6"),
            ("the stiffness of wales", self.wale, 0.0..=1e6, "between 0 and 1e6"),
            ("the stiffness of folding", self.fold, 0.0..=1e6, "between 0 and 1e6"),
            ("the tolerance", self.tolerance, 1e-9..=1.0, "between 1e-9 and 1 stitch"),
        ];
        match checks.into_iter().find(|(_, value, allowed, _)| !allowed.contains(value)) {
            Some((name, value, _, range)) => Err(RelaxError::Parameter { name, value, range }),
            None => Ok(()),
        }
    }
}

/// Size of a stitch at rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RestLengths {
    /// r_course: length of a course edge [m].
    pub course: f64,
    /// r_wale: length of a wale edge [m].
    pub wale: f64,
}

impl RestLengths {
    /// Rest lengths from N r_wale r_course = αA and r_wale = a r_course (Yuksel et al. §6.1), for an area A [m²].
    ///
    /// N is not the number of faces, as in the paper, but half the number of their course edges: a stitch that makes three
    /// loops of one is as large as two plain ones. On faces with one bottom and one top it is the same.
    ///
    /// # Errors
    /// [`RelaxError::Area`] where the area is no number above zero.
    pub fn new(stitches: &StitchMesh, area: f64, aspect: f64, fill: f64) -> Result<Self, RelaxError> {
        let course_edges: usize = stitches.stitches().iter().map(|s| s.bottoms() + s.tops()).sum();
        let course = (fill * area / (aspect * 0.5 * course_edges as f64)).sqrt();
        match course.is_normal() && area > 0.0 {
            true => Ok(Self { course, wale: aspect * course }),
            false => Err(RelaxError::Area(area)),
        }
    }

    /// √(r_course r_wale): the unit of length of a relaxation [m].
    pub fn unit(&self) -> f64 {
        (self.course * self.wale).sqrt()
    }

    /// How much each face is stretched: the mean of length / rest length − 1 over its edges, [face_count]. Above zero where
    /// the stitch is larger than at rest, below where it is pressed.
    pub fn strain(&self, stitches: &StitchMesh, positions: &[DVec3]) -> Vec<f64> {
        let mesh = stitches.mesh();
        let of_face = |face| {
            let edges = mesh.face_half_edges(face);
            let count = edges.len() as f64;
            let strain = edges.map(|h| {
                let [a, b] = [mesh.origin(h), mesh.tip(h)].map(|v| positions[v.index()]);
                a.distance(b) / if stitches.is_wale(h) { self.wale } else { self.course } - 1.0
            });
            strain.sum::<f64>() / count
        };
        mesh.faces().map(of_face).collect()
    }
}
