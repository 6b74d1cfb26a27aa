//! Yarns by name: five fibres, and the three parameter sets of Cirio et al.
//!
//! # Theory
//! **What is known of fibres.** Density and initial modulus: Morton and Hearle, *Physical Properties of Textile Fibres*
//! (4th ed. 2008), Tables 5.1 and 13.1 (wool: Botany 64s; cotton: Uppers; acrylic: Acrilan; silk: degummed), which the
//! *Handbook of Properties of Textile and Technical Fibres* (Bunsell ed., 2018, Table 1.1) confirms for wool and cotton. Elastane:
//! 0.11 cN/dtex, as stated for Lycra. Shape factors of bending (1 for a round fibre): Morton and Hearle §17.2 for wool and
//! silk. Fineness: a merino of 21 µm, an upland cotton of micronaire 4.3, a silk bave of 1.3 dtex, acrylic for hand
//! knitting of 3.3 dtex, an elastane of 78 dtex, whose filaments are fused to one.
//!
//! Friction of fibre on fibre, as reported: wool 0.11–0.25 with the scales and 0.14–0.61 against them, cotton 0.26–0.57,
//! silk 0.2–0.3 (Morton and Hearle ch. 25 and the textbooks that follow it). The value here is one within.
//!
//! **From fibre to yarn.** A yarn of a given radius is φ πR² of fibre. With E [N/tex] the modulus and T the fineness of the
//! fibre, ρ_v its density, η its shape factor, and fibres that slide freely past each other,
//! - mass per length ρ = φ πR² ρ_v;
//! - stretch: Y = φ E ρ_v (fibres along the yarn);
//! - bending: n = ρ/T fibres of stiffness η E T²/(4π ρ_v) each, so B = φ η E T/(4π).
//!
//! For wool with φ = 0.38 the first gives the 0.88 g/m of [`Material::for_loop_width`]. The others give Y = 1.1 GPa and
//! B = 0.025 Pa m², a hundred and twenty-five times what the simulation takes for wool: a spun yarn is crimped, gives way
//! long before its fibres do, and the published parameters, too, are chosen for how fabric looks. So only the *ratios* to
//! wool are taken from the fibres; wool itself stays as it was found to work.
//!
//! # Judgement
//! That the ratios hold for yarns, that φ is the same for all, that wrapping goes with bending; the friction of acrylic
//! and elastane; the shape factors of cotton and acrylic. Elastane alone is not knitted by hand: it is that of the naked filament,
//! drawn as thick as the other yarns. Nothing here was measured on a yarn.

use crate::material::Material;
use serde::{Deserialize, Serialize};

/// A yarn by name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Preset {
    /// Sheep's wool.
    Wool,
    /// Cotton.
    Cotton,
    /// Acrylic.
    Acrylic,
    /// Silk.
    Silk,
    /// Elastane (spandex).
    Elastane,
    /// The sweater of Cirio et al., Table 1.
    Sweater,
    /// The shirt of Cirio et al., Table 1.
    Shirt,
    /// The pullover of Cirio et al., Table 1.
    Pullover,
}

/// What is known of a fibre; see the module.
struct Fibre {
    /// ρ_v [g/cm³].
    density: f64,
    /// E [N/tex].
    modulus: f64,
    /// T [tex].
    fineness: f64,
    /// η.
    shape: f64,
    /// μ.
    friction: f64,
}

const WOOL: Fibre = Fibre { density: 1.31, modulus: 2.3, fineness: 0.45, shape: 0.80, friction: 0.3 };
const COTTON: Fibre = Fibre { density: 1.52, modulus: 5.0, fineness: 0.17, shape: 0.5, friction: 0.4 };
const ACRYLIC: Fibre = Fibre { density: 1.18, modulus: 6.2, fineness: 0.33, shape: 0.8, friction: 0.3 };
const SILK: Fibre = Fibre { density: 1.34, modulus: 7.3, fineness: 0.13, shape: 0.59, friction: 0.25 };
const ELASTANE: Fibre = Fibre { density: 1.2, modulus: 0.011, fineness: 7.8, shape: 1.0, friction: 0.6 };

impl Fibre {
    /// A yarn of this fibre for loops of width `w` [m].
    fn yarn(&self, w: f64) -> Material {
        let wool = Material::for_loop_width(w);
        let stretch = |f: &Self| f.modulus * f.density;
        let bend = |f: &Self| f.shape * f.modulus * f.fineness;
        let stiffer = bend(self) / bend(&WOOL);
        Material {
            density: wool.density * (self.density / WOOL.density),
            young_modulus: wool.young_modulus * (stretch(self) / stretch(&WOOL)),
            bending_modulus: wool.bending_modulus * stiffer,
            wrap_stiffness: wool.wrap_stiffness * stiffer,
            friction: self.friction,
            ..wool
        }
    }
}

/// A column of Table 1 of Cirio et al., put back in order: B in Pa m², k_w in N, (α [1/s], β [s]). Its loop width is four
/// yarn radii, as here, and the mass per length, which the table lacks, that of wool.
fn published(loop_width: f64, bending_modulus: f64, damping: [f64; 2], w: f64) -> Material {
    let [mass_damping, stiffness_damping] = damping;
    let as_published = Material {
        young_modulus: 1e7,
        bending_modulus,
        wrap_stiffness: 1e-2,
        friction: 0.3,
        mass_damping,
        stiffness_damping,
        ..Material::for_loop_width(loop_width)
    };
    as_published.scaled(w / loop_width)
}

impl Preset {
    /// All of them.
    pub const ALL: [Self; 8] = [
        Self::Wool,
        Self::Cotton,
        Self::Acrylic,
        Self::Silk,
        Self::Elastane,
        Self::Sweater,
        Self::Shirt,
        Self::Pullover,
    ];

    /// The material for loops of width `w` [m].
    pub fn material(self, w: f64) -> Material {
        match self {
            Self::Wool => WOOL.yarn(w),
            Self::Cotton => COTTON.yarn(w),
            Self::Acrylic => ACRYLIC.yarn(w),
            Self::Silk => SILK.yarn(w),
            Self::Elastane => ELASTANE.yarn(w),
            Self::Sweater => published(3e-3, 1e-3, [10.0, 0.01], w),
            Self::Shirt => published(1e-3, 3e-4, [2.0, 0.1], w),
            Self::Pullover => published(6e-3, 3e-4, [5.0, 0.01], w),
        }
    }

    /// What it is called.
    pub fn name(self) -> &'static str {
        match self {
            Self::Wool => "Wool",
            Self::Cotton => "Cotton",
            Self::Acrylic => "Acrylic",
            Self::Silk => "Silk",
            Self::Elastane => "Elastane",
            Self::Sweater => "Sweater (Cirio et al.)",
            Self::Shirt => "Shirt (Cirio et al.)",
            Self::Pullover => "Pullover (Cirio et al.)",
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn presets_are_sound_and_wool_is_the_usual_yarn() {
        for (preset, w) in Preset::ALL.iter().zip([1e-3, 3e-3, 10e-3].iter().cycle()) {
            preset.material(*w).validate().unwrap();
        }
        assert_eq!(Preset::Wool.material(3e-3), Material::for_loop_width(3e-3));
    }

    #[test]
    fn wool_weighs_what_its_fibres_do() {
        let wool = Material::for_loop_width(3e-3);
        let packed = 0.38 * std::f64::consts::PI * wool.radius.powi(2) * 1e3 * WOOL.density;
        assert!((wool.density / packed - 1.0).abs() < 1e-2);
    }

    #[test]
    fn table_one_has_its_radii_and_stiffnesses() {
        let [sweater, shirt, pullover] =
            [(Preset::Sweater, 3e-3), (Preset::Shirt, 1e-3), (Preset::Pullover, 6e-3)]
                .map(|(p, w)| p.material(w));
        assert_eq!(
            [sweater.radius, shirt.radius, pullover.radius].map(|r| (r * 1e5).round()),
            [75.0, 25.0, 150.0]
        );
        assert_eq!([&sweater, &shirt, &pullover].map(|m| m.bending_modulus), [1e-3, 3e-4, 3e-4]);
        assert_eq!([&sweater, &shirt, &pullover].map(|m| m.mass_damping), [10.0, 2.0, 5.0]);
        assert_eq!([&sweater, &shirt, &pullover].map(|m| m.stiffness_damping), [0.01, 0.1, 0.01]);
    }
}
