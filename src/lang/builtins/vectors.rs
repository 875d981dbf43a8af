//! Functions of vectors as a whole.

use crate::lang::coerce;
use crate::lang::table::{Builtin, BuiltinBody::*, Parameter};
use crate::math::Affine;
use glam::DVec3;

const V: &[Parameter] = &[Parameter::new("v", "a vector")];
const PAIR: &[Parameter] =
    &[Parameter::new("a", "a vector"), Parameter::new("b", "a vector of the same size")];

/// The family.
pub static ALL: &[Builtin] = &[
    Builtin::new("dot", PAIR, Numbers(two_to_number, dot), "The scalar product a·b.", ("dot(<1, 2>, <3, 4>)", "11")),
    Builtin::new(
        "cross",
        &[Parameter::new("a", "a 3-vector"), Parameter::new("b", "a 3-vector")],
        Numbers(|n| (n == [3, 3]).then_some(3), cross),
        "The vector product a × b.",
        ("cross(x, y)", "<0, 0, 1>"),
    ),
    Builtin::new("length", V, Numbers(one_to_number, length), "The length |v|.", ("length(<3, 4>)", "5")),
    Builtin::new(
        "normalize",
        V,
        Numbers(|n| (n.len() == 1).then(|| n[0]), normalize),
        "The vector of length 1 along v.",
        ("normalize(<0, 3, 4>)", "<0, 0.6, 0.8>"),
    )
    .defined("a vector other than 0", "guard it: `length(v) > 0 ? normalize(v) : y`"),
    Builtin::new(
        "distance",
        PAIR,
        Numbers(two_to_number, distance),
        "The distance |a − b| of two points.",
        ("distance(<1, 1>, <4, 5>)", "5"),
    ),
    Builtin::new(
        "reflect",
        &[Parameter::new("v", "a vector"), Parameter::new("n", "a vector of the same size")],
        Numbers(|n| (n.len() == 2 && n[0] == n[1]).then(|| n[0]), reflect),
        "The direction v mirrored at the plane across n, v − 2(v·n)n with n made of length 1; v comes in, the result goes out.",
        ("reflect(<1, -1, 0>, y)", "<1, 1, 0>"),
    )
    .defined("a normal `n` other than 0", "give the surface's normal, for example `y`"),
    Builtin::new(
        "refract",
        &[
            Parameter::new("v", "a vector"),
            Parameter::new("n", "a vector of the same size"),
            Parameter::new("ratio", "a number"),
        ],
        Numbers(|n| (n.len() == 3 && n[0] == n[1] && n[2] == 1).then(|| n[0]), refract),
        "The unit direction v bent at the plane across n, by Snell's law: `ratio` is the index on the side from which v comes \
         over that of the other; n may point to either side. The zero vector where all is reflected.",
        ("refract(<0, -1, 0>, y, 1 / 1.5)", "<0, -1, 0>"),
    )
    .defined("vectors other than 0 and a ratio above 0", "check the direction and the normal"),
    Builtin::new(
        "rotate",
        &[
            Parameter::new("v", "a 3-vector"),
            Parameter::new("axis", "a 3-vector"),
            Parameter::new("degrees", "a number"),
        ],
        Numbers(|n| (n == [3, 3, 1]).then_some(3), rotate),
        "v turned about an axis through the origin by degrees, counterclockwise seen against the axis.",
        ("rotate(x, y, 90)", "<0, 0, -1>"),
    )
    .defined("an axis other than 0", "give an axis, for example `y`"),
];

fn one_to_number(sizes: &[usize]) -> Option<usize> {
    (sizes.len() == 1).then_some(1)
}

fn two_to_number(sizes: &[usize]) -> Option<usize> {
    (sizes.len() == 2 && sizes[0] == sizes[1]).then_some(1)
}

fn halves(of: &[f64]) -> (&[f64], &[f64]) {
    of.split_at(of.len() / 2)
}

fn dot_of(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// A power of two by which components are scaled where their squares would overflow or vanish: exact, and far enough for all
/// exponents of f64, −1074 … 1023.
const FAR: f64 = f64::from_bits((1023 + 600) << 52);

fn length_of(v: &[f64]) -> f64 {
    let squares = dot_of(v, v);
    let scaled = |factor: f64| v.iter().map(|x| (x * factor) * (x * factor)).sum::<f64>().sqrt() / factor;
    if squares.is_infinite() {
        scaled(1.0 / FAR)
    } else if squares < 1.0 / FAR {
        scaled(FAR)
    } else {
        squares.sqrt()
    }
}

fn dot(of: &[f64], to: &mut [f64]) {
    let (a, b) = halves(of);
    to[0] = dot_of(a, b);
}

fn cross(of: &[f64], to: &mut [f64]) {
    let (a, b) = halves(of);
    to.copy_from_slice(&DVec3::from_slice(a).cross(DVec3::from_slice(b)).to_array());
}

fn length(of: &[f64], to: &mut [f64]) {
    to[0] = length_of(of);
}

fn normalize(of: &[f64], to: &mut [f64]) {
    let largest = of.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
    to.iter_mut().zip(of).for_each(|(to, x)| *to = x / largest);
    let length = length_of(to);
    to.iter_mut().for_each(|x| *x /= length);
}

fn distance(of: &[f64], to: &mut [f64]) {
    let (a, b) = halves(of);
    let mut d = [0.0; 4];
    d.iter_mut().zip(a.iter().zip(b)).for_each(|(d, (a, b))| *d = a - b);
    to[0] = length_of(&d[..a.len()]);
}

fn reflect(of: &[f64], to: &mut [f64]) {
    let (v, n) = halves(of);
    let mut unit = [0.0; 4];
    let unit = &mut unit[..n.len()];
    normalize(n, unit);
    let along = 2.0 * dot_of(v, unit);
    to.iter_mut().zip(v.iter().zip(&*unit)).for_each(|(to, (v, n))| *to = v - along * n);
}

/// With i of length 1 along v, n on its side, c = −n·i > 0: t = η i + (η c − √(1 − η²(1 − c²))) n.
fn refract(of: &[f64], to: &mut [f64]) {
    let (vectors, eta) = (&of[..of.len() - 1], of[of.len() - 1]);
    let (v, n) = halves(vectors);
    let (mut i, mut unit) = ([0.0; 4], [0.0; 4]);
    let (i, unit) = (&mut i[..v.len()], &mut unit[..n.len()]);
    normalize(v, i);
    normalize(n, unit);
    let along = -dot_of(i, unit);
    let (side, c) = if along < 0.0 { (-1.0, -along) } else { (1.0, along) };
    let radicand = 1.0 - eta * eta * (1.0 - c * c);
    if eta <= 0.0 {
        to.fill(f64::NAN);
    } else if radicand < 0.0 {
        to.fill(0.0);
    } else {
        let k = (eta * c - radicand.sqrt()) * side;
        to.iter_mut().zip(i.iter().zip(&*unit)).for_each(|(to, (i, n))| *to = eta * i + k * n);
    }
}

fn rotate(of: &[f64], to: &mut [f64]) {
    let (v, axis) = (DVec3::from_slice(&of[..3]), DVec3::from_slice(&of[3..6]));
    let turned = match coerce::unit(axis) {
        Some(axis) => Affine::rotate(axis, of[6]).vector(v),
        None => DVec3::NAN,
    };
    to.copy_from_slice(&turned.to_array());
}
