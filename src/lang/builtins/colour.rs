//! Functions of colours: linear RGB triples.

use crate::lang::table::{Builtin, BuiltinBody::*, Parameter};
use crate::math::colour::{luminance as luminance_of, srgb_decode};
use glam::DVec3;

/// The family.
pub static ALL: &[Builtin] = &[
    Builtin::new(
        "srgb",
        &[Parameter::new("colour", "a 3-vector, or three numbers, as pictures encode them, from 0 to 1")],
        Numbers(|n| matches!(n, [1] | [3] | [1, 1, 1]).then(|| n.iter().sum()), srgb),
        "The linear colour of an sRGB one.",
        ("srgb(1, 0, 0)", "<1, 0, 0>"),
    )
    .variadic(),
    Builtin::new(
        "hsv",
        &[
            Parameter::new(
                "hue",
                "a number in turns: 0 red, 1/3 green, 2/3 blue; whole turns are of no account",
            ),
            Parameter::new("saturation", "a number from 0 to 1").or("1"),
            Parameter::new("value", "a number from 0 to 1").or("1"),
        ],
        Numbers(|n| (n == [1, 1, 1]).then_some(3), hsv),
        "The linear colour of hue, saturation and value, which are of sRGB.",
        ("hsv(1/3, 1, 1)", "<0, 1, 0>"),
    ),
    Builtin::new(
        "luminance",
        &[Parameter::new("colour", "a colour or a number")],
        Numbers(|n| matches!(n, [1] | [3]).then_some(1), luminance),
        "The brightness of a linear colour: 0.2126 r + 0.7152 g + 0.0722 b.",
        ("luminance(white)", "1"),
    ),
];

fn srgb(of: &[f64], to: &mut [f64]) {
    to.iter_mut().zip(of).for_each(|(to, c)| *to = srgb_decode(*c));
}

/// Smith 1978: the six sectors of the hexcone, then decoded.
fn hsv(of: &[f64], to: &mut [f64]) {
    let (sector, s, v) = ((of[0] - of[0].floor()) * 6.0, of[1], of[2]);
    let channel = |offset: f64| {
        let k = (offset + sector) % 6.0;
        srgb_decode(v - v * s * k.min(4.0 - k).clamp(0.0, 1.0))
    };
    to.copy_from_slice(&[channel(5.0), channel(3.0), channel(1.0)]);
}

fn luminance(of: &[f64], to: &mut [f64]) {
    to[0] = if of.len() == 3 { luminance_of(DVec3::from_slice(of)) } else { of[0] };
}
