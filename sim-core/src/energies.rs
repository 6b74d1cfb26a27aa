//! The energies of a fabric, force by force: what tells which of them carries a load.

use crate::local::Element;
use crate::mass::mass;
use crate::materials::Materials;
use crate::model::{BendTerm, Model, SegmentTerm, WrapTerm};
use crate::woven::ShearTerm;
use serde::{Deserialize, Serialize};
use stitch_mesh::yarn_net::YarnState;

/// Energies of a state of the yarn, each summed over the whole fabric.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Energies {
    /// Of stretch along the yarn [J].
    pub stretch: f64,
    /// Of bending, jams included [J].
    pub bend: f64,
    /// Of stitch wrapping [J].
    pub wrap: f64,
    /// Of shear between warp and weft [J].
    pub shear: f64,
    /// Of contact lengths and of parallel contacts [J].
    pub spacing: f64,
    /// Of friction springs that have given way and not yet slipped [J]; zero where only a state is known, and no anchors.
    pub sticking: f64,
    /// Of motion [J].
    pub kinetic: f64,
}

impl Energies {
    /// Potential energy of the yarn itself [J].
    pub fn elastic(&self) -> f64 {
        self.stretch + self.bend + self.wrap + self.shear + self.spacing
    }
}

impl Model {
    /// The energies of `state`.
    pub fn energies(&self, materials: &Materials, state: &YarnState) -> Energies {
        let yarns = self.resolve(materials);
        let of = |dye: u32| &yarns[dye as usize];
        let (mut stretch, mut spacing) = (0.0, 0.0);
        for segment in &self.segments {
            let q: [f64; 8] = segment.stencil.coordinates(state);
            stretch += segment.stretch(of(segment.dye)).energy(&q);
            spacing += segment.spacing(of(segment.dye)).energy(&[q[3], q[7]]);
        }
        let bend = |b: &BendTerm| b.bend(of(b.dye)).energy(&b.stencil.coordinates(state));
        let wrap = |w: &WrapTerm| w.wrap(of(w.dye)).energy(&w.stencil.points(state));
        let shear = |s: &ShearTerm| s.shear(&yarns).energy(&s.stencil.points(state));
        Energies {
            stretch,
            bend: self.bends.iter().map(bend).sum(),
            wrap: self.wraps.iter().map(wrap).sum(),
            shear: self.shears.iter().map(shear).sum(),
            spacing,
            sticking: 0.0,
            kinetic: self.kinetic_energy(materials, state),
        }
    }

    /// Energy of motion alone [J].
    pub fn kinetic_energy(&self, materials: &Materials, state: &YarnState) -> f64 {
        let yarns = self.resolve(materials);
        let of = |s: &SegmentTerm| {
            let m = mass(yarns[s.dye as usize].density, &s.stencil.coordinates(state));
            let v: [f64; 8] = s.stencil.velocities(state);
            let momentum = |i: usize| (0..8).map(|j| m[i][j] * v[j]).sum::<f64>();
            0.5 * (0..8).map(|i| v[i] * momentum(i)).sum::<f64>()
        };
        self.segments.iter().map(of).sum()
    }

    /// Root-mean-square speed of the yarn [m/s].
    pub(crate) fn speed(&self, materials: &Materials, state: &YarnState) -> f64 {
        let mass: f64 = self.node_masses(materials).iter().sum();
        (2.0 * self.kinetic_energy(materials, state) / mass).sqrt()
    }
}
