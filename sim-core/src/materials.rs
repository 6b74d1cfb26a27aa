//! The yarns of a fabric: one material for all of it, and others for yarns of some colours.
//!
//! A colour is what an artist tells yarns apart by, so it is also what a yarn's material hangs on. Every visit knows the
//! colour of its yarn. A segment is of the yarn that runs along it, a bend of the yarn at its middle visit, a stitch contact
//! takes wrapping modulus and angle from the yarn that forms the new loop.
//!
//! Where two yarns touch, friction and cohesion are the geometric means of both: for two yarns of one material they are its
//! own, and a yarn without friction has none on any other. (No law gives the friction between unlike fibres; that of the
//! pairs measured lies between those of either with itself or under both.)

use crate::material::{Material, MaterialError};
use std::collections::BTreeMap;
use stitch_mesh::dye::Dye;

/// Materials of all yarns of a fabric.
#[derive(Clone, Debug, PartialEq)]
pub struct Materials {
    /// Of every yarn that has no material of its own.
    pub base: Material,
    /// Of the yarns of some colours.
    pub by_dye: BTreeMap<Dye, Material>,
}

impl From<Material> for Materials {
    fn from(base: Material) -> Self {
        Self { base, by_dye: BTreeMap::new() }
    }
}

impl Materials {
    /// The material of the yarn of a colour.
    pub fn of(&self, dye: Dye) -> &Material {
        self.by_dye.get(&dye).unwrap_or(&self.base)
    }

    /// Whether every parameter of every yarn is in its range.
    ///
    /// # Errors
    /// The yarn and the parameter that is not.
    pub fn validate(&self) -> Result<(), MaterialError> {
        self.base.validate()?;
        let named = |(dye, m): (&Dye, &Material)| {
            m.validate().map_err(|error| MaterialError { yarn: Some(*dye), ..error })
        };
        self.by_dye.iter().try_for_each(named)
    }

    /// Materials for loops of width `w` [m]: the usual wool, and all colours that have another as much thicker or thinner as
    /// it is now.
    pub fn refitted(&self, w: f64) -> Self {
        let base = Material::for_loop_width(w);
        let s = base.radius / self.base.radius;
        let by_dye = self.by_dye.iter().map(|(dye, m)| (*dye, m.scaled(s))).collect();
        Self { base, by_dye }
    }
}

/// What two yarns that touch have in common.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Touch {
    /// μ.
    pub friction: f64,
    /// λ₀ [N].
    pub cohesion: f64,
}

impl Touch {
    pub fn between(a: &Material, b: &Material) -> Self {
        let mean = |x: f64, y: f64| (x * y).sqrt();
        Self { friction: mean(a.friction, b.friction), cohesion: mean(a.cohesion, b.cohesion) }
    }

    /// μ(λ + λ₀), the most that friction holds under the compression `lambda` [N].
    pub fn limit(&self, lambda: f64) -> f64 {
        self.friction * (lambda + self.cohesion)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_name_yarn_and_field() {
        let wool = Material::for_loop_width(3e-3);
        let mut materials = Materials::from(wool.clone());
        let red: Dye = "#c04030".parse().unwrap();
        materials.by_dye.insert(red, Material { density: 0.0, ..wool.clone() });
        let message = materials.validate().unwrap_err().to_string();
        assert_eq!(
            message,
            "material of the yarn #c04030: density is 0.0, and must be above 0 and at most 100.0"
        );
        assert_eq!(materials.of(Dye::UNDYED), &wool);
    }

    #[test]
    fn touching_yarns_share_their_friction() {
        let rough = Material { friction: 0.9, ..Material::for_loop_width(3e-3) };
        let smooth = Material { friction: 0.1, cohesion: 0.0, ..rough.clone() };
        assert!((Touch::between(&rough, &smooth).friction - 0.3).abs() < 1e-15);
        assert!((Touch::between(&rough, &rough).friction - 0.9).abs() < 1e-15);
        assert_eq!(Touch::between(&rough, &smooth).cohesion, 0.0);
    }
}
