//! Functions of numbers; on vectors they work component by component.

use crate::lang::table::{Builtin, BuiltinBody::*, Parameter};
use crate::math::elementary as m;
use crate::math::exact::remainder;

const X: &[Parameter] = &[Parameter::new("x", "a number or vector")];
const ANGLE: &[Parameter] = &[Parameter::new("angle", "a number or vector")];
const TWO: &[Parameter] =
    &[Parameter::new("a", "a number or vector"), Parameter::new("b", "a number or vector")];

/// The family.
pub static ALL: &[Builtin] = &[
    Builtin::new("abs", X, Number1(f64::abs), "The magnitude |x|.", ("abs(-2.5)", "2.5")),
    Builtin::new("sign", X, Number1(sign), "1 above 0, −1 below, 0 at 0.", ("sign(-3)", "-1")),
    Builtin::new(
        "floor",
        X,
        Number1(f64::floor),
        "The greatest whole number up to x.",
        ("floor(-1.5)", "-2"),
    ),
    Builtin::new("ceil", X, Number1(f64::ceil), "The least whole number from x on.", ("ceil(-1.5)", "-1")),
    Builtin::new(
        "round",
        X,
        Number1(f64::round),
        "The nearest whole number; halves go away from 0.",
        ("round(2.5)", "3"),
    ),
    Builtin::new("min", TWO, Number2(f64::min), "The least of its arguments.", ("min(3, 1, 2)", "1"))
        .variadic(),
    Builtin::new(
        "max",
        TWO,
        Number2(f64::max),
        "The greatest of its arguments.",
        ("max(<1, 5>, 2)", "<2, 5>"),
    )
    .variadic(),
    Builtin::new(
        "clamp",
        &[
            Parameter::new("x", "a number or vector"),
            Parameter::new("low", "a number or vector").or("0"),
            Parameter::new("high", "a number or vector").or("1"),
        ],
        Number3(clamp, |of, to| to[0] = clamp(of[0], of[1], of[2])),
        "x cut to low … high.",
        ("clamp(1.5, 0, 1)", "1"),
    )
    .defined("`low` up to `high`", "swap the two bounds"),
    Builtin::new(
        "mix",
        &[
            Parameter::new("a", "a number or vector"),
            Parameter::new("b", "a number or vector"),
            Parameter::new("t", "a number or vector"),
        ],
        Number3(mix, |of, to| to[0] = mix(of[0], of[1], of[2])),
        "Linear interpolation: a at t = 0, b at t = 1, and beyond along the same line.",
        ("mix(<0, 0>, <2, 4>, 0.5)", "<1, 2>"),
    ),
    Builtin::new(
        "smoothstep",
        &[
            Parameter::new("edge0", "a number or vector"),
            Parameter::new("edge1", "a number or vector"),
            Parameter::new("x", "a number or vector"),
        ],
        Number3(smoothstep, |of, to| to[0] = smoothstep(of[0], of[1], of[2])),
        "0 up to edge0, 1 from edge1 on, and 3t² − 2t³ between.",
        ("smoothstep(0, 2, 0.5)", "0.15625"),
    )
    .defined("edges that differ", "for a hard step write `x < edge ? 0 : 1`"),
    Builtin::new(
        "mod",
        TWO,
        Number2(floored_mod),
        "The remainder a − b·floor(a / b), with the sign of b; `%` has the sign of a.",
        ("mod(-1, 3)", "2"),
    )
    .defined("a divisor `b` other than 0", "guard it: `b == 0 ? 0 : mod(a, b)`"),
    Builtin::new("sin", ANGLE, Number1(m::sin), "Sine of an angle in radians.", ("sin(pi / 2)", "1")),
    Builtin::new("cos", ANGLE, Number1(m::cos), "Cosine of an angle in radians.", ("cos(0)", "1")),
    Builtin::new("tan", ANGLE, Number1(m::tan), "Tangent of an angle in radians.", ("tan(0)", "0")),
    Builtin::new("asin", X, Number1(m::asin), "Arc sine, in radians from −π/2 to π/2.", ("asin(0)", "0"))
        .defined("−1 to 1", "write `asin(clamp(x, -1, 1))`"),
    Builtin::new("acos", X, Number1(m::acos), "Arc cosine, in radians from 0 to π.", ("acos(1)", "0"))
        .defined("−1 to 1", "write `acos(clamp(x, -1, 1))`"),
    Builtin::new("atan", X, Number1(m::atan), "Arc tangent, in radians from −π/2 to π/2.", ("atan(0)", "0")),
    Builtin::new(
        "atan2",
        &[Parameter::new("y", "a number or vector"), Parameter::new("x", "a number or vector")],
        Number2(m::atan2),
        "The angle of the point (x, y) from the x axis, in radians from −π to π; 0 at the origin.",
        ("atan2(1, 1) * 4 == pi", "true"),
    ),
    Builtin::new("sinh", X, Number1(m::sinh), "Hyperbolic sine.", ("sinh(0)", "0")),
    Builtin::new("cosh", X, Number1(m::cosh), "Hyperbolic cosine.", ("cosh(0)", "1")),
    Builtin::new("tanh", X, Number1(m::tanh), "Hyperbolic tangent.", ("tanh(0)", "0")),
    Builtin::new("sqrt", X, Number1(f64::sqrt), "The square root.", ("sqrt(2)", "1.4142135623730951"))
        .defined("0 and above", "write `sqrt(max(x, 0))`, or `sqrt(abs(x))`"),
    Builtin::new("exp", X, Number1(m::exp), "e to the power x.", ("exp(0)", "1")),
    Builtin::new("ln", X, Number1(m::ln), "The natural logarithm.", ("ln(1)", "0"))
        .defined("numbers above 0", "guard it: `x > 0 ? ln(x) : 0`"),
    Builtin::new("log10", X, Number1(m::log10), "The logarithm to base 10.", ("log10(1000)", "3"))
        .defined("numbers above 0", "guard it: `x > 0 ? log10(x) : 0`"),
    Builtin::new("log2", X, Number1(m::log2), "The logarithm to base 2.", ("log2(8)", "3"))
        .defined("numbers above 0", "guard it: `x > 0 ? log2(x) : 0`"),
    Builtin::new("pow", TWO, Number2(m::powf), "a to the power b, as `a ^ b`.", ("pow(2, 10)", "1024"))
        .defined(
            "a base from 0 on for powers that are not whole, above 0 for negative ones",
            "write `pow(abs(a), b)`",
        ),
    Builtin::new(
        "radians",
        ANGLE,
        Number1(f64::to_radians),
        "Degrees to radians.",
        ("radians(180) == pi", "true"),
    ),
    Builtin::new("degrees", ANGLE, Number1(f64::to_degrees), "Radians to degrees.", ("degrees(pi)", "180")),
];

fn sign(x: f64) -> f64 {
    if x == 0.0 || x.is_nan() { x } else { x.signum() }
}

/// NaN where the bounds are crossed.
fn clamp(x: f64, low: f64, high: f64) -> f64 {
    if low <= high { x.max(low).min(high) } else { f64::NAN }
}

/// Exact at both ends.
fn mix(a: f64, b: f64, t: f64) -> f64 {
    a * (1.0 - t) + b * t
}

/// NaN where the edges are equal.
fn smoothstep(edge0: f64, edge1: f64, x: f64) -> f64 {
    if edge0 == edge1 {
        return f64::NAN;
    }
    let t = ((x - edge0) / (edge1 - edge0)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// NaN for b = 0.
fn floored_mod(a: f64, b: f64) -> f64 {
    let r = remainder(a, b);
    if r != 0.0 && (r < 0.0) != (b < 0.0) { r + b } else { r }
}
