//! The value of a material's textures at a point of a surface. A constant costs one branch; a pattern is walked as it was
//! written. Pictures are read beforehand ([`load_pictures`]) and wait inside their pattern.

mod load;
mod picture;

pub use load::{load_pictures, load_skies};

use super::Hit;
use super::shape::Uv;
use super::shape::mesh::WornPlace;
use crate::diag::Span;
use crate::math::Affine;
use crate::math::colour::luminance;
use crate::math::elementary::sin;
use crate::math::field::FaultKind;
use crate::math::noise::{fbm, gradient_noise, noise};
use crate::scene::assets::image::Reading;
use crate::scene::{ImagePattern, Pattern, PatternKind, Rgb, SampleInput, SampledFunction, Texture};
use glam::{DVec2, DVec3};
use std::f64::consts::TAU;

/// What a texture may ask of a point of a surface.
#[derive(Clone, Copy, Debug, Default)]
pub struct TexturePoint<'w> {
    /// The point in the object's own space before its transforms.
    pub local_point: DVec3,
    /// Surface parameters.
    pub uv: Uv,
    /// The point in the world.
    pub point: DVec3,
    /// Unit shading normal in the world.
    pub normal: DVec3,
    /// Distance along the ray.
    pub t: f64,
    /// The place of a skin; none on what is none.
    pub worn: Option<WornPlace<'w>>,
}

impl<'w> From<&Hit<'w>> for TexturePoint<'w> {
    fn from(hit: &Hit<'w>) -> Self {
        TexturePoint {
            worn: hit.worn,
            local_point: hit.local_point,
            uv: hit.uv,
            point: hit.point,
            normal: hit.normal,
            t: hit.t,
        }
    }
}

/// A texture that has no value at a point: its pixel is magenta.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct TextureFault {
    /// The expression of the scene that has no value.
    pub span: Span,
    /// Why.
    pub kind: FaultKind,
}

/// A texture's value, or where it has none.
pub type Sampled<T> = Result<T, TextureFault>;

/// The colour of a texture, linear RGB.
#[inline]
pub fn colour(texture: &Texture, at: &TexturePoint<'_>) -> Sampled<Rgb> {
    evaluate(texture, at, Reading::Colour)
}

/// Three numbers that are no colour: a tangent-space normal in 0 … 1.
#[inline]
pub fn data(texture: &Texture, at: &TexturePoint<'_>) -> Sampled<DVec3> {
    evaluate(texture, at, Reading::Data)
}

/// A number: the luminance of what a texture says, pictures read as plain numbers.
#[inline]
pub fn number(texture: &Texture, at: &TexturePoint<'_>) -> Sampled<f64> {
    evaluate(texture, at, Reading::Data).map(luminance)
}

/// The share of a surface that is there, 0 … 1: a picture with an alpha channel gives its alpha, anything else its number.
#[inline]
pub fn opacity(texture: &Texture, at: &TexturePoint<'_>) -> Sampled<f64> {
    let Texture::Pattern(pattern) = texture else { return number(texture, at) };
    let PatternKind::Image(image) = &pattern.kind else { return number(texture, at) };
    match image.picture.get().filter(|picture| picture.has_alpha()) {
        Some(picture) => {
            Ok(picture::sample(picture, image, moved(pattern, at).uv.get(), Reading::Data)[3].clamp(0.0, 1.0))
        }
        None => number(texture, at),
    }
    .map(|x: f64| x.clamp(0.0, 1.0))
}

#[inline]
fn evaluate(texture: &Texture, at: &TexturePoint<'_>, reading: Reading) -> Sampled<Rgb> {
    match texture {
        Texture::Constant(value) => Ok(*value),
        Texture::Pattern(pattern) => rule(pattern, &moved(pattern, at), reading),
    }
}

/// The point as a pattern sees it: moved back by the pattern's transform, in space and in (u, v) alike.
fn moved<'w>(pattern: &Pattern, at: &TexturePoint<'w>) -> TexturePoint<'w> {
    let Some(surface_from_pattern) = pattern.transform.as_deref() else { return *at };
    let pattern_from_surface = surface_from_pattern.inverse();
    TexturePoint {
        local_point: pattern_from_surface.point(at.local_point),
        uv: uv_by(&pattern_from_surface, at.uv.get()).into(),
        ..*at
    }
}

fn uv_by(map: &Affine, uv: DVec2) -> DVec2 {
    map.point(uv.extend(0.0)).truncate()
}

fn rule(pattern: &Pattern, at: &TexturePoint<'_>, reading: Reading) -> Sampled<Rgb> {
    let p = at.local_point;
    match &pattern.kind {
        PatternKind::Checker(a, b) => evaluate(if is_even_cell(p) { a } else { b }, at, reading),
        PatternKind::Stripes(slabs) => match slab(p.x, slabs.len()) {
            Some(index) => evaluate(&slabs[index], at, reading),
            None => Ok(Rgb::ZERO),
        },
        PatternKind::Gradient(a, b) => mix(a, b, p.y, at, reading),
        PatternKind::Ramp(input, stops) => ramp(number(input, at)?, stops, at, reading),
        PatternKind::Image(image) => from_picture(image, at.uv.get(), reading),
        PatternKind::Noise(a, b) => mix(a, b, noise(&p.to_array()), at, reading),
        PatternKind::Marble(a, b) => mix(a, b, veins(p), at, reading),
        PatternKind::Wood(a, b) => mix(a, b, rings(p), at, reading),
        PatternKind::Weight(joint) => Ok(Rgb::splat(at.worn.map_or(0.0, |place| place.weight(joint)))),
        PatternKind::Function(function) => call(function, at),
    }
}

/// Cells are unit cubes centred on whole numbers, so that a plane through the origin lies in the middle of its cells and
/// rounding cannot make it flicker between two.
fn is_even_cell(p: DVec3) -> bool {
    (p + 0.5).floor().element_sum().rem_euclid(2.0) == 0.0
}

/// Which of `n` slabs, each one unit thick, the first centred on 0. None for no slabs.
fn slab(x: f64, n: usize) -> Option<usize> {
    let index = (x + 0.5).floor().rem_euclid(n as f64);
    (n > 0).then(|| (index as usize).min(n - 1))
}

/// Marble: waves one unit apart along x, displaced by four octaves of noise; 0 … 1.
fn veins(p: DVec3) -> f64 {
    0.5 + 0.5 * sin(TAU * (p.x + fbm(&p.to_array(), 4, 2.0, 0.5)))
}

/// Wood: rings one unit apart about the y axis, each rising from 0 to 1, a tenth of a unit out of round.
fn rings(p: DVec3) -> f64 {
    let radius = DVec2::new(p.x, p.z).length() + 0.1 * gradient_noise(&p.to_array(), 0);
    radius - radius.floor()
}

/// (1 − t)·a + t·b, t clamped to 0 … 1.
fn mix(a: &Texture, b: &Texture, t: f64, at: &TexturePoint<'_>, reading: Reading) -> Sampled<Rgb> {
    let t = t.clamp(0.0, 1.0);
    Ok(evaluate(a, at, reading)? * (1.0 - t) + evaluate(b, at, reading)? * t)
}

/// Piecewise linear between sorted stops, constant beyond them; of stops at one place the last counts from there on.
fn ramp(x: f64, stops: &[(f64, Texture)], at: &TexturePoint<'_>, reading: Reading) -> Sampled<Rgb> {
    let above = stops.partition_point(|(position, _)| *position <= x);
    match (above.checked_sub(1).and_then(|i| stops.get(i)), stops.get(above)) {
        (None, None) => Ok(Rgb::ZERO),
        (Some((_, only)), None) | (None, Some((_, only))) => evaluate(only, at, reading),
        (Some((x0, a)), Some((x1, b))) => mix(a, b, (x - x0) / (x1 - x0), at, reading),
    }
}

fn from_picture(image: &ImagePattern, uv: DVec2, reading: Reading) -> Sampled<Rgb> {
    let missing = TextureFault { span: image.span, kind: FaultKind::Undefined };
    let reading = if image.colour { reading } else { Reading::Data };
    let texel = picture::sample(image.picture.get().ok_or(missing)?, image, uv, reading);
    Ok(Rgb::new(texel[0], texel[1], texel[2]))
}

fn call(function: &SampledFunction, at: &TexturePoint<'_>) -> Sampled<Rgb> {
    let mut out = [0.0; 3];
    let outputs = function.field.n_outputs().min(3);
    let (p, n) = (at.local_point, at.normal);
    let result = match function.input {
        SampleInput::Point => function.field.eval(&p.to_array(), &mut out[..outputs]),
        SampleInput::Uv => function.field.eval(&at.uv.get().to_array(), &mut out[..outputs]),
        SampleInput::Hit => {
            let p = at.point;
            let uv = at.uv.get();
            let hit = [p.x, p.y, p.z, n.x, n.y, n.z, uv.x, uv.y, at.t];
            function.field.eval(&hit, &mut out[..outputs])
        }
    };
    result.map_err(|fault| TextureFault { span: function.place(fault), kind: fault.kind })?;
    Ok(if outputs == 1 { Rgb::splat(out[0]) } else { Rgb::from(out) })
}

#[cfg(test)]
mod tests;
