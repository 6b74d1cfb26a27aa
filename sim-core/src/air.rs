//! Drag of still air on a yarn.
//!
//! # Theory
//! A cylinder of diameter d that moves with v across itself through a fluid of density ρ_a feels
//! f = −½ ρ_a d C_D |v| v per length [N/m]. C_D = 1 + 10 Re^(−2/3), Re = |v| d/ν, fits the measurements from Re = 1e-4 to 2e5
//! (White, *Viscous Fluid Flow*, 2nd ed. 1991, eq. 3-225); knitting yarn that falls has an Re of 1 to 300. As v → 0 the
//! force vanishes as |v|^(4/3).
//!
//! # Practice
//! A drag c v per length on the material of a yarn is a damping by its mass at the rate c/ρ, so it goes into the mass matrix
//! along with α: implicit, and without an element of its own. c is that of the velocity of the middle of the segment when
//! the step begins.
//!
//! # Differences from the truth
//! Isotropic: along itself a smooth yarn would feel a half or less, a hairy one about as much. Yarns do not shelter each
//! other, as if the fabric were open.

/// Kinematic viscosity of air at 20 °C, ν [m²/s].
pub(crate) const VISCOSITY: f64 = 1.5e-5;

/// c, drag per length and velocity on a yarn of `diameter` [m] at `speed` [m/s] in air of `density` [kg/m³] [kg/(m s)].
pub(crate) fn drag(density: f64, diameter: f64, speed: f64) -> f64 {
    // C_D |v| with the powers of |v| multiplied out: finite at rest.
    let by_speed = speed + 10.0 * (VISCOSITY / diameter).powf(2.0 / 3.0) * speed.cbrt();
    0.5 * density * diameter * by_speed
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn drag_is_that_of_the_fitted_coefficient() {
        // Re = 100: C_D = 1 + 10/21.54.
        let (d, v) = (1e-3, 1.5);
        let expected = 0.5 * 1.2 * d * v * (1.0 + 10.0 / 100f64.powf(2.0 / 3.0));
        assert!((drag(1.2, d, v) - expected).abs() < 1e-12 * expected);
        assert_eq!((drag(1.2, d, 0.0), drag(0.0, d, v)), (0.0, 0.0));
    }
}
