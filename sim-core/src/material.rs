//! What the yarn is made of, and how it is damped.

use serde::{Deserialize, Serialize};
use std::f64::consts::{FRAC_PI_2, PI};

/// Parameters of the yarn and of its contacts. One material for the whole fabric.
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
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("material: {name} is {value}, and must be {range}")]
pub struct MaterialError {
    /// The field.
    pub name: &'static str,
    /// What it holds.
    pub value: f64,
    /// What it may hold.
    pub range: &'static str,
}

impl Material {
    /// A wool for loops of width `w` [m].
    ///
    /// The values for 3 mm are those with which stockinette curls and rib draws in as the real fabrics do. Other widths
    /// are the *same fabric seen larger*: Young's modulus and volume density stay, every length grows with s = w / 3 mm,
    /// forces and mass per length with s², the bending modulus with s² too (so that k_b grows as s⁴), times with s. Free of
    /// gravity such a fabric does at w just what the first one does at 3 mm, s times slower; under its weight it sags
    /// more by the factor s, as larger things do.
    pub fn for_loop_width(w: f64) -> Self {
        let s = w / 3e-3;
        Self {
            radius: 0.75e-3 * s,
            drawn_radius: 0.42e-3 * s,
            young_modulus: 1e7,
            bending_modulus: 1e-3 * s * s,
            density: 8.8e-4 * s * s,
            wrap_stiffness: 1.2e-3 * s * s,
            wrap_angle: FRAC_PI_2,
            wrap_fade: 0.2e-3 * s,
            friction: 0.3,
            cohesion: 5e-3 * s * s,
            friction_stiffness: 200.0 * s,
            length_factor: 1.0,
            parallel_stiffness: 5.3e3 * s,
            parallel_distance: 0.45e-3 * s,
            mass_damping: 3.0 / s,
            stiffness_damping: 5e-3 * s,
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

    /// Whether every parameter is finite and in its range.
    pub fn validate(&self) -> Result<(), MaterialError> {
        let positive = [
            ("radius", self.radius),
            ("drawn_radius", self.drawn_radius),
            ("young_modulus", self.young_modulus),
            ("bending_modulus", self.bending_modulus),
            ("density", self.density),
            ("wrap_fade", self.wrap_fade),
            ("length_factor", self.length_factor),
        ];
        let not_negative = [
            ("wrap_stiffness", self.wrap_stiffness),
            ("friction", self.friction),
            ("cohesion", self.cohesion),
            ("friction_stiffness", self.friction_stiffness),
            ("parallel_stiffness", self.parallel_stiffness),
            ("parallel_distance", self.parallel_distance),
            ("mass_damping", self.mass_damping),
            ("stiffness_damping", self.stiffness_damping),
        ];
        let check = |name, value: f64, sound: bool, range| {
            if sound && value.is_finite() { Ok(()) } else { Err(MaterialError { name, value, range }) }
        };
        for (name, value) in positive {
            check(name, value, value > 0.0, "positive and finite")?;
        }
        for (name, value) in not_negative {
            check(name, value, value >= 0.0, "at least 0 and finite")?;
        }
        check("wrap_angle", self.wrap_angle, (0.0..PI).contains(&self.wrap_angle), "in 0..π")
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
        let absurd = Material { density: f64::NAN, ..Material::for_loop_width(3e-3) };
        assert_eq!(absurd.validate().unwrap_err().name, "density");
        let absurd = Material { friction: -1.0, ..Material::for_loop_width(3e-3) };
        assert!(absurd.validate().unwrap_err().to_string().contains("friction is -1"));
    }

    #[test]
    fn stiffness_of_three_millimetre_loops() {
        let m = Material::for_loop_width(3e-3);
        assert!((m.stretch_stiffness() - 17.67).abs() < 0.01);
        assert!((m.bend_stiffness() - 1.767e-9).abs() < 1e-12);
    }
}
