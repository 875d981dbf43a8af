//! Even grids for tests: of the unit square, and of all directions.

use crate::math::elementary::sin_cos;
use glam::{DVec2, DVec3};
use std::f64::consts::TAU;

/// The middles of n × n cells of (0, 1)².
pub fn grid(n: u32) -> impl Iterator<Item = DVec2> {
    let cell = move |i| (f64::from(i) + 0.5) / f64::from(n);
    (0..n).flat_map(move |i| (0..n).map(move |j| DVec2::new(cell(i), cell(j))))
}

/// ∫ over all directions, by n × n of them that stand for equal solid angles.
pub fn over_all_directions(n: u32, f: impl Fn(DVec3) -> f64) -> f64 {
    let at = |u: DVec2| {
        let z = 2.0 * u.x - 1.0;
        let ((s, c), r) = (sin_cos(TAU * u.y), (1.0 - z * z).sqrt());
        DVec3::new(r * c, r * s, z)
    };
    grid(n).map(|u| f(at(u))).sum::<f64>() * 2.0 * TAU / f64::from(n * n)
}
