//! The components that are measured, one file each: case sets, truth and variants.

mod curves;
mod enclosures;
mod fresnel;
mod implicits;
mod lengths;
mod patches;
mod planes;
mod reach;
mod roots;
mod skins;
mod spheres;
mod tapes;
mod tori;
mod triangles;

use super::row::Row;
use super::trial::Plan;

/// The seed of all case sets.
pub const SEED: u64 = 20_240_607;

/// A component's trials.
pub type Component = fn(&Plan) -> Vec<Row>;

/// All components by name, in the order of the report.
pub const COMPONENTS: [(&str, Component); 13] = [
    ("curves", curves::rows),
    ("lengths", lengths::rows),
    ("roots", roots::rows),
    ("spheres", spheres::rows),
    ("planes", planes::rows),
    ("triangles", triangles::rows),
    ("tori", tori::rows),
    ("patches", patches::rows),
    ("enclosures", enclosures::rows),
    ("implicits", implicits::rows),
    ("fresnel", fresnel::rows),
    ("reach", reach::rows),
    ("skins", skins::rows),
];

/// The spacing of f64 at x: the distance to the next number away from 0.
fn ulp(x: f64) -> f64 {
    x.abs().next_up() - x.abs()
}
