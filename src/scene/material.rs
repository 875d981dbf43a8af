//! Materials and patterns as they are written.

use super::Rgb;
use super::assets::image::Picture;
use crate::diag::{SourceId, Span};
use crate::math::Affine;
use crate::math::field::{Fault, Field};
use std::path::PathBuf;
use std::sync::Arc;

/// A colour or number that may vary over a surface. A number is a grey.
#[derive(Clone, Debug)]
pub enum Texture {
    /// The same everywhere.
    Constant(Rgb),
    /// By a pattern.
    Pattern(Arc<Pattern>),
}

impl Texture {
    /// Black, or the number 0.
    pub const ZERO: Texture = Texture::Constant(Rgb::ZERO);

    /// The number as a grey.
    pub const fn number(x: f64) -> Texture {
        Texture::Constant(Rgb::splat(x))
    }

    /// True for this colour everywhere.
    pub fn is(&self, colour: Rgb) -> bool {
        matches!(self, Texture::Constant(c) if *c == colour)
    }
}

/// What a surface is made of. Most materials are only diffuse; the rest is boxed, so that a million coloured spheres stay small.
#[derive(Clone, Debug)]
pub struct Material {
    /// Albedo of the Lambertian base (BRDF ρ/π).
    pub diffuse: Texture,
    /// Everything else, where anything else is given.
    pub layers: Option<Box<Layers>>,
    /// Where it was written.
    pub span: Span,
}

impl Material {
    /// The layers, given or default.
    pub fn layers(&self) -> &Layers {
        static DEFAULT: Layers = Layers::DEFAULT;
        self.layers.as_deref().unwrap_or(&DEFAULT)
    }

    /// Whether a map turns the normal, for which the surface's tangent is needed.
    pub fn bends_normal(&self) -> bool {
        self.layers.as_deref().is_some_and(|layers| layers.normal_map.is_some() || layers.bump.is_some())
    }
}

/// What a material may have above its diffuse base. The meaning of each is in the reference, one for all tracers.
#[derive(Clone, Debug)]
pub struct Layers {
    /// Added as emitted light by raycast and whitted alone.
    pub ambient: Texture,
    /// k_s.
    pub specular: Texture,
    /// q.
    pub exponent: Texture,
    /// Which specular lobe.
    pub lobe: Lobe,
    /// Mirror share at normal incidence (or at every angle with no Fresnel).
    pub reflect: Texture,
    /// How `reflect` and `transmit` vary with the angle.
    pub fresnel: Fresnel,
    /// Share of light let through.
    pub transmit: Texture,
    /// Index of refraction inside over outside.
    pub ior: Texture,
    /// Absorption per unit length inside.
    pub absorb: Texture,
    /// Roughness of mirror, glass or metal: GGX α; 0 is smooth.
    pub roughness: Texture,
    /// Colour of a metal at normal incidence.
    pub metal: Texture,
    /// Radiance sent out along the normal's side.
    pub emit: Texture,
    /// Share of the surface that is there.
    pub opacity: Texture,
    /// Tangent-space normals in 0 … 1, linear.
    pub normal_map: Option<Texture>,
    /// Height in scene units.
    pub bump: Option<Texture>,
}

impl Layers {
    /// Nothing but a diffuse base.
    pub const DEFAULT: Layers = Layers {
        ambient: Texture::ZERO,
        specular: Texture::ZERO,
        exponent: Texture::number(1.0),
        lobe: Lobe::Blinn,
        reflect: Texture::ZERO,
        fresnel: Fresnel::None,
        transmit: Texture::ZERO,
        ior: Texture::number(1.5),
        absorb: Texture::ZERO,
        roughness: Texture::ZERO,
        metal: Texture::ZERO,
        emit: Texture::ZERO,
        opacity: Texture::number(1.0),
        normal_map: None,
        bump: None,
    };
}

/// The lobes of `specular`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Lobe {
    /// k_s (q + 2)/2π cos^q of the angle to the mirror direction.
    Phong,
    /// k_s (q + 8)/8π cos^q of the angle to the half vector.
    Blinn,
}

/// The laws of reflectance against angle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fresnel {
    /// The same share at every angle.
    None,
    /// Schlick's approximation.
    Schlick,
    /// Fresnel's equations for an unpolarised dielectric.
    Exact,
}

/// A rule that gives a colour or number at each point of a surface.
#[derive(Clone, Debug)]
pub struct Pattern {
    /// The rule.
    pub kind: PatternKind,
    /// Where the pattern stands: surface from pattern. Looked up at the inverse image of the point.
    pub transform: Option<Box<Affine>>,
    /// Where it was written.
    pub span: Span,
}

/// The rules. Solid ones (all but images and functions of (u, v)) take the point in the object's own space before its transforms.
#[derive(Clone, Debug)]
pub enum PatternKind {
    /// Unit cubes in alternation, one centred on the origin.
    Checker(Texture, Texture),
    /// Slabs one unit thick across the x axis in alternation, one centred on the origin.
    Stripes(Vec<Texture>),
    /// From the first at y = 0 to the second at y = 1, clamped.
    Gradient(Texture, Texture),
    /// Another pattern's luminance through stops (position, colour), piecewise linear, sorted.
    Ramp(Texture, Vec<(f64, Texture)>),
    /// A picture by (u, v); (0, 0) is its bottom left.
    Image(ImagePattern),
    /// Veins across the x axis.
    Marble(Texture, Texture),
    /// Rings about the y axis.
    Wood(Texture, Texture),
    /// Gradient noise in 0 … 1 as a grey, or between two textures.
    Noise(Texture, Texture),
    /// How much a skin's joint of this name moves the point, 0 … 1; 0 on what is no skin.
    Weight(Box<str>),
    /// A function of the scene, as a tape.
    Function(Arc<SampledFunction>),
}

impl PatternKind {
    /// The textures that the rule is made of, in the order in which they are written.
    pub fn parts(&self) -> Vec<&Texture> {
        match self {
            PatternKind::Checker(a, b)
            | PatternKind::Gradient(a, b)
            | PatternKind::Marble(a, b)
            | PatternKind::Wood(a, b)
            | PatternKind::Noise(a, b) => vec![a, b],
            PatternKind::Stripes(slabs) => slabs.iter().collect(),
            PatternKind::Ramp(input, stops) => {
                std::iter::once(input).chain(stops.iter().map(|(_, texture)| texture)).collect()
            }
            PatternKind::Image(_) | PatternKind::Weight(_) | PatternKind::Function(_) => Vec::new(),
        }
    }
}

/// A picture as a pattern.
#[derive(Clone, Debug, PartialEq)]
pub struct ImagePattern {
    /// Path, joined to the folder of the file that names it.
    pub path: PathBuf,
    /// Beyond 0 … 1: again, or the edge's colour, or mirrored.
    pub wrap: Wrap,
    /// Between texels.
    pub filter: Filter,
    /// True where the numbers are colours (sRGB files are decoded); false for normal maps and other data.
    pub colour: bool,
    /// The path's place.
    pub span: Span,
    /// The picture, once it was asked for; `Picture::default()` until then.
    pub picture: Picture,
}

/// How a picture goes on beyond its edges.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Wrap {
    /// Again and again.
    Repeat,
    /// The edge's texels.
    Clamp,
    /// To and fro.
    Mirror,
}

/// How texels are joined.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Filter {
    /// The nearest.
    Nearest,
    /// Linear between four.
    Bilinear,
}

/// What a function of the scene is called with while rendering.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SampleInput {
    /// `p => …`: x, y, z of the point in the object's own space.
    Point,
    /// `(u, v) => …`.
    Uv,
    /// `from_hit(h => …)`: p (3), n (3), uv (2), t (1), in that order.
    Hit,
}

/// A function of the scene that runs while rendering.
#[derive(Clone, Debug)]
pub struct SampledFunction {
    /// The tape: inputs as [`SampleInput`] says, outputs one number (a grey) or three.
    pub field: Field,
    /// What its inputs are.
    pub input: SampleInput,
    /// The function's place, for faults.
    pub span: Span,
    /// The places of its expressions, by the site of a [`crate::math::field::Fault`].
    pub sites: Vec<Span>,
}

impl SampledFunction {
    /// A function of the point that no text stands for: its faults have no place of their own.
    pub fn of_point(field: Field) -> SampledFunction {
        let span = Span { source: SourceId(0), start: 0, end: 0 };
        SampledFunction { field, input: SampleInput::Point, span, sites: Vec::new() }
    }

    /// The place of the expression that a fault names.
    pub fn place(&self, fault: Fault) -> Span {
        self.sites.get(fault.site as usize).copied().unwrap_or(self.span)
    }
}
