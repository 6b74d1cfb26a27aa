//! How the yarns of one stitch are wrapped around each other, where it is not as its material has it.
//!
//! A stitch contact is at rest at a signed angle ψ₀ between its yarns and turns back to it with a stiffness k_w per length
//! (Cirio et al. §4.2; `sim-core` has the energy). Both are those of the material of the yarn that forms the new loop. A
//! stitch takes m k_w in place of k_w: a factor, so that it keeps its share when its yarn becomes another. And it may
//! have an angle |ψ₀| of its own. A stitch with m = 0 does not curl.

use serde::{Deserialize, Serialize};
use std::f64::consts::PI;

/// The most that m may be: a contact a thousand times as stiff as its material hardly moves, and more makes no difference.
const MOST_MODULUS: f64 = 1e3;

/// Wrapping of one stitch.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Wrapping {
    /// m, factor on the modulus k_w of the material.
    pub modulus: f64,
    /// |ψ₀|, wrapping angle at rest [rad]; that of the material if absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub angle: Option<f64>,
}

/// Wrapping that no stitch has.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum WrappingError {
    /// A factor out of its range.
    #[error("wrapping: modulus is {0:?}, and must be at least 0 and at most {MOST_MODULUS:?}")]
    Modulus(f64),
    /// An angle out of its range [rad].
    #[error("wrapping: angle is {}°, and must be at least 0° and at most 180°", rounded_degrees(*.0))]
    Angle(f64),
}

/// Degrees without the last digits, which the way to radians and back has changed.
fn rounded_degrees(angle: f64) -> f64 {
    (angle.to_degrees() * 1e9).round() / 1e9
}

impl Wrapping {
    /// All as the material has it.
    pub const OF_MATERIAL: Self = Self { modulus: 1.0, angle: None };

    /// Whether both are finite and in their ranges.
    ///
    /// # Errors
    /// The one that is not.
    pub fn validate(&self) -> Result<(), WrappingError> {
        // NaN lies in no range.
        if !(0.0..=MOST_MODULUS).contains(&self.modulus) {
            return Err(WrappingError::Modulus(self.modulus));
        }
        match self.angle.filter(|angle| !(0.0..=PI).contains(angle)) {
            Some(angle) => Err(WrappingError::Angle(angle)),
            None => Ok(()),
        }
    }
}

impl Default for Wrapping {
    fn default() -> Self {
        Self::OF_MATERIAL
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_out_of_range_are_named() {
        let of = |modulus: f64, degrees: f64| Wrapping { modulus, angle: Some(degrees.to_radians()) };
        for (modulus, degrees) in [(0.0, 0.0), (1.0, 90.0), (MOST_MODULUS, 180.0)] {
            of(modulus, degrees).validate().unwrap();
        }
        Wrapping::OF_MATERIAL.validate().unwrap();
        let error = |modulus, degrees| of(modulus, degrees).validate().unwrap_err().to_string();
        assert_eq!(error(-1.0, 60.0), "wrapping: modulus is -1.0, and must be at least 0 and at most 1000.0");
        assert_eq!(error(1.0, 200.0), "wrapping: angle is 200°, and must be at least 0° and at most 180°");
        assert!(error(1.0, -1e-3).contains("angle is -0.001°"));
        for (modulus, degrees, says) in [
            (f64::NAN, 60.0, "modulus is NaN"),
            (f64::INFINITY, 60.0, "modulus is inf"),
            (1e4, 60.0, "modulus is 10000.0"),
            (1.0, f64::NAN, "angle is NaN°"),
            (1.0, f64::NEG_INFINITY, "angle is -inf°"),
        ] {
            assert!(error(modulus, degrees).contains(says), "{}", error(modulus, degrees));
        }
    }
}
