//! Deterministic randomness; its values never change.

use crate::lang::table::{Builtin, BuiltinBody::*, Parameter};
use crate::math::noise;

/// The family.
pub static ALL: &[Builtin] = &[
    Builtin::new(
        "random",
        &[Parameter::new("seed", "a number")],
        Numbers(|n| n.iter().all(|n| *n == 1).then_some(1), |of, to| to[0] = noise::random(of)),
        "A number in [0, 1) that depends on its arguments alone, evenly spread: `random(seed, i, j)` is the number of place \
         (i, j). The same in every version.",
        ("random(1, 2) == random(1, 2)", "true"),
    )
    .variadic(),
    Builtin::new(
        "noise",
        &[Parameter::new("p", "a number, a 2-vector or a 3-vector")],
        Numbers(|n| matches!(n, [1..=3]).then_some(1), |of, to| to[0] = noise::noise(of)),
        "Gradient noise in 0 … 1 with mean 1/2, smooth to the second derivative, 1/2 at whole numbers, with features about one \
         unit across. The same in every version. Without arguments, as a texture: a pattern of greys.",
        ("noise(<1, 2, 3>)", "0.5"),
    ),
    Builtin::new(
        "fbm",
        &[
            Parameter::new("p", "a number, a 2-vector or a 3-vector"),
            Parameter::new("octaves", "a whole number").or("6"),
            Parameter::new("lacunarity", "a number").or("2"),
            Parameter::new("gain", "a number").or("0.5"),
        ],
        Numbers(|n| matches!(n, [1..=3, 1, 1, 1]).then_some(1), fbm),
        "Fractal noise in 0 … 1 with mean 1/2: octaves of noise, each `lacunarity` times finer and `gain` times weaker than the \
         one before. The same in every version.",
        ("fbm(<1, 2, 3>, 4)", "0.5"),
    )
    .defined("from 1 to 64 octaves", "8 octaves are finer than a pixel in most pictures"),
];

/// Most octaves: beyond them frequencies leave the range in which f64 has fractions.
const MOST_OCTAVES: f64 = 64.0;

fn fbm(of: &[f64], to: &mut [f64]) {
    let (p, rest) = of.split_at(of.len() - 3);
    let octaves = rest[0];
    let usable = octaves.floor() == octaves && (1.0..=MOST_OCTAVES).contains(&octaves);
    to[0] = if usable { 0.5 + 0.5 * noise::fbm(p, octaves as u32, rest[1], rest[2]) } else { f64::NAN };
}
