//! What a yarn is made of, and how it is damped.

use serde::{Deserialize, Serialize};
use std::f64::consts::{FRAC_PI_2, PI};
use stitch_mesh::dye::Dye;

/// Parameters of a yarn and of its contacts.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Material {
    /// R, yarn radius that the stiffnesses are reckoned with [m].
    pub radius: f64,
    /// Radius at which the yarn is drawn and its overlap measured [m]. Less than R: four radii to a loop width leave the
    /// yarn no room, since it has no cross-section that gives way.
    pub drawn_radius: f64,
    /// Y, Young's modulus along the yarn [Pa].
    pub young_modulus: f64,
    /// B, bending modulus [Pa m²].
    pub bending_modulus: f64,
    /// ρ, mass of yarn per length [kg/m].
    pub density: f64,
    /// k_w, stiffness of stitch wrapping [N].
    pub wrap_stiffness: f64,
    /// |ψ₀|, wrapping angle at rest [rad].
    pub wrap_angle: f64,
    /// Distance from the axis of a contact under which its hinge fades out [m].
    pub wrap_fade: f64,
    /// μ, coefficient of friction between yarns.
    pub friction: f64,
    /// λ₀, normal force that every contact has besides the computed one [N].
    pub cohesion: f64,
    /// k_f, stiffness of sticking friction [N/m].
    pub friction_stiffness: f64,
    /// k_l/k_s, stiffness of contact length over stiffness of stretch.
    pub length_factor: f64,
    /// k_c, stiffness of the contact between neighbouring stitches along a yarn [N/m].
    pub parallel_stiffness: f64,
    /// d, distance that contacts along a yarn keep [m].
    pub parallel_distance: f64,
    /// α, damping by mass [1/s].
    pub mass_damping: f64,
    /// β, damping by stiffness, stretch excepted [s].
    pub stiffness_damping: f64,
}

/// A parameter that no yarn has.
#[derive(Clone, Debug, PartialEq)]
pub struct MaterialError {
    /// The colour of the yarn; none for the material of all others.
    pub yarn: Option<Dye>,
    /// The field.
    pub name: &'static str,
    /// What it holds.
    pub value: f64,
    /// Whether it may be zero.
    pub may_be_zero: bool,
    /// The most that it may be.
    pub most: f64,
}

impl std::error::Error for MaterialError {}

impl std::fmt::Display for MaterialError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { yarn, name, value, may_be_zero, most } = self;
        match yarn {
            Some(dye) => write!(f, "material of the yarn {dye}: ")?,
            None => write!(f, "material: ")?,
        }
        let least = if *may_be_zero { "at least 0" } else { "above 0" };
        write!(f, "{name} is {value:?}, and must be {least} and at most {most:?}")
    }
}

impl Material {
    /// A wool for loops of width `w` [m]: [`Self::scaled`] from the values for 3 mm, with which stockinette curls and rib
    /// draws in as the real fabrics do.
    pub fn for_loop_width(w: f64) -> Self {
        let of_three_millimetres = Self {
            radius: 0.75e-3,
            drawn_radius: 0.42e-3,
            young_modulus: 1e7,
            bending_modulus: 1e-3,
            density: 8.8e-4,
            wrap_stiffness: 1.2e-3,
            wrap_angle: FRAC_PI_2,
            wrap_fade: 0.2e-3,
            friction: 0.3,
            cohesion: 5e-3,
            friction_stiffness: 200.0,
            length_factor: 1.0,
            parallel_stiffness: 5.3e3,
            parallel_distance: 0.45e-3,
            mass_damping: 3.0,
            stiffness_damping: 5e-3,
        };
        of_three_millimetres.scaled(w / 3e-3)
    }

    /// The yarn of the *same fabric seen larger* by the factor s: Young's modulus and volume density stay, every length
    /// grows with s, forces and mass per length with s², the bending modulus with s² too (so that k_b grows as s⁴), times
    /// with s. Free of gravity such a fabric does just what the first one does, s times slower; under its weight it sags more
    /// by the factor s, as larger things do.
    pub fn scaled(&self, s: f64) -> Self {
        Self {
            radius: self.radius * s,
            drawn_radius: self.drawn_radius * s,
            young_modulus: self.young_modulus,
            bending_modulus: self.bending_modulus * s * s,
            density: self.density * s * s,
            wrap_stiffness: self.wrap_stiffness * s * s,
            wrap_angle: self.wrap_angle,
            wrap_fade: self.wrap_fade * s,
            friction: self.friction,
            cohesion: self.cohesion * s * s,
            friction_stiffness: self.friction_stiffness * s,
            length_factor: self.length_factor,
            parallel_stiffness: self.parallel_stiffness * s,
            parallel_distance: self.parallel_distance * s,
            mass_damping: self.mass_damping / s,
            stiffness_damping: self.stiffness_damping * s,
        }
    }

    /// k_s = YπR², stiffness of stretch [N].
    pub fn stretch_stiffness(&self) -> f64 {
        self.young_modulus * PI * self.radius * self.radius
    }

    /// k_b = BπR², stiffness of bending [N m²].
    pub fn bend_stiffness(&self) -> f64 {
        self.bending_modulus * PI * self.radius * self.radius
    }

    /// Whether every parameter is finite and in its range. The ranges hold ropes and gossamer; what lies outside has the
    /// wrong unit.
    pub fn validate(&self) -> Result<(), MaterialError> {
        // (field, value, may be zero, most)
        let fields = [
            ("radius", self.radius, false, 0.1),
            ("drawn_radius", self.drawn_radius, false, 0.1),
            ("young_modulus", self.young_modulus, false, 1e13),
            ("bending_modulus", self.bending_modulus, false, 1e6),
            ("density", self.density, false, 100.0),
            ("wrap_stiffness", self.wrap_stiffness, true, 1e6),
            ("wrap_angle", self.wrap_angle, true, 3.1),
            ("wrap_fade", self.wrap_fade, false, 1.0),
            ("friction", self.friction, true, 1e9),
            ("cohesion", self.cohesion, true, 1e6),
            ("friction_stiffness", self.friction_stiffness, true, 1e9),
            ("length_factor", self.length_factor, false, 1e6),
            ("parallel_stiffness", self.parallel_stiffness, true, 1e12),
            ("parallel_distance", self.parallel_distance, true, 1.0),
            ("mass_damping", self.mass_damping, true, 1e6),
            ("stiffness_damping", self.stiffness_damping, true, 1e3),
        ];
        for (name, value, may_be_zero, most) in fields {
            let least = if may_be_zero { 0.0 } else { f64::MIN_POSITIVE };
            // NaN lies in no range.
            if !(least..=most).contains(&value) {
                return Err(MaterialError { yarn: None, name, value, may_be_zero, most });
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn defaults_are_sound_and_absurd_values_are_named() {
        for w in [1e-3, 3e-3, 6e-3, 12e-3] {
            Material::for_loop_width(w).validate().unwrap();
        }
        let wool = Material::for_loop_width(3e-3);
        let absurd = Material { density: f64::NAN, ..wool.clone() };
        assert_eq!(absurd.validate().unwrap_err().name, "density");
        let absurd = Material { radius: 0.0, ..wool.clone() };
        let message = absurd.validate().unwrap_err().to_string();
        assert_eq!(message, "material: radius is 0.0, and must be above 0 and at most 0.1");
        let absurd = Material { friction: -1.0, ..wool.clone() };
        assert!(absurd.validate().unwrap_err().to_string().contains("friction is -1"));
        let absurd = Material { density: 880.0, ..wool };
        assert!(absurd.validate().is_err(), "grams per metre");
    }

    #[test]
    fn stiffness_of_three_millimetre_loops() {
        let m = Material::for_loop_width(3e-3);
        assert!((m.stretch_stiffness() - 17.67).abs() < 0.01);
        assert!((m.bend_stiffness() - 1.767e-9).abs() < 1e-12);
    }
}
