//! Rounding-error bounds: γₙ and what is built from it. Pharr, Jakob & Humphreys, *Physically Based Rendering* §6.8.

/// Half the distance from 1 to the next f64: 2⁻⁵³.
pub const UNIT_ROUNDOFF: f64 = f64::EPSILON / 2.0;

/// γₙ = n·u / (1 − n·u): the relative error that n roundings in a row can make (Higham, *Accuracy and Stability* §3.1).
pub const fn gamma(n: u32) -> f64 {
    let nu = n as f64 * UNIT_ROUNDOFF;
    nu / (1.0 - nu)
}
