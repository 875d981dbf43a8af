//! Materials: from properties to layers, with the defaults that depend on each other, and the energy check.

use super::energy;
use crate::lang::table::{Block, Context, Kind, Outcome, Property, Role, Type};
use crate::lang::value::Value;
use crate::scene::{Fresnel, Layers, Lobe, Material, Texture};
use std::sync::Arc;

const TEXTURE: &[&[Type]] = &[&[Type::Texture]];
const NUMBER: &[&[Type]] = &[&[Type::NumberTexture { min: f64::MIN, max: f64::MAX }]];
const AT_LEAST_0: &[&[Type]] = &[&[Type::NumberTexture { min: 0.0, max: f64::MAX }]];
const SHARE: &[&[Type]] = &[&[Type::NumberTexture { min: 0.0, max: 1.0 }]];
/// Below this an index of refraction is none of any matter; a bound, so that no division meets 0.
const IOR: &[&[Type]] = &[&[Type::NumberTexture { min: 0.01, max: 100.0 }]];

/// A material.
pub static MATERIAL: Kind = Kind {
    name: "material",
    doc: "What a surface is made of. Each colour or number may vary over the surface: by a pattern, or by a function of the \
          point or of (u, v).",
    example: "material clay { diffuse <0.8, 0.4, 0.3>  specular 0.2  exponent 40 }",
    role: Role::Value,
    own: &[
        Property::new(
            "diffuse",
            TEXTURE,
            "0.8",
            "albedo of the matt base, the share of light that it scatters; 0 by default where `transmit` or `metal` is \
             given",
        ),
        Property::new(
            "ambient",
            TEXTURE,
            "0",
            "radiance added by raycast and whitted alone, in place of indirect light",
        ),
        Property::new("specular", TEXTURE, "0", "strength k_s of the highlight, the share of light in it"),
        Property::new("exponent", AT_LEAST_0, "0", "q of the highlight: the higher, the smaller and sharper"),
        Property::new(
            "lobe",
            &[&[Type::Word(&["phong", "blinn"])]],
            "blinn",
            "shape of the highlight: `phong` about the mirror direction, `blinn` about the half vector",
        ),
        Property::new("reflect", TEXTURE, "0", "mirror share r: the surface is (1 − r)·base + r·mirror"),
        Property::new(
            "fresnel",
            &[&[Type::Word(&["schlick", "exact", "none"])]],
            "none",
            "how reflection grows toward grazing angles; `exact` by default where `transmit` is given",
        ),
        Property::new("transmit", TEXTURE, "0", "share of light let through, bent by `ior`"),
        Property::new("ior", IOR, "1.5", "index of refraction inside over outside"),
        Property::new(
            "absorb",
            TEXTURE,
            "0",
            "absorption inside, per unit length: light falls by exp(−absorb·length)",
        ),
        Property::new("roughness", SHARE, "0", "GGX roughness α of mirror, glass or metal; 0 is smooth"),
        Property::new("metal", TEXTURE, "0", "colour of a metal: its reflectance at normal incidence"),
        Property::new(
            "emit",
            TEXTURE,
            "0",
            "radiance that it sends out, in W/(m² sr); the object is then an area light",
        ),
        Property::new(
            "normal_map",
            TEXTURE,
            "",
            "tangent-space normals as an image, components 0 … 1, read as linear",
        ),
        Property::new("bump", NUMBER, "", "height above the surface, in scene units"),
        Property::new("opacity", SHARE, "1", "share of the surface that is there; 0 is a hole"),
    ],
    children: false,
    open: false,
    build: Some(material),
};

fn material(ctx: &mut dyn Context, block: &mut Block) -> Outcome {
    let layers = layers(block);
    let default_diffuse = if block.has("transmit") || block.has("metal") { 0.0 } else { 0.8 };
    let diffuse = block.texture("diffuse").unwrap_or(Texture::number(default_diffuse));
    let material = Material { diffuse, layers, span: block.span };
    energy::check(ctx, &material, block);
    Ok(Value::Material(Arc::new(material)))
}

/// The layers above the base; none where only the base is given.
fn layers(block: &Block) -> Option<Box<Layers>> {
    if block.given.iter().all(|g| &*g.name == "diffuse") {
        return None;
    }
    let d = Layers::DEFAULT;
    let texture = |name: &str, default: Texture| block.texture(name).unwrap_or(default);
    Some(Box::new(Layers {
        ambient: texture("ambient", d.ambient),
        specular: texture("specular", d.specular),
        exponent: texture("exponent", Texture::ZERO),
        lobe: lobe(block),
        reflect: texture("reflect", d.reflect),
        fresnel: fresnel(block),
        transmit: texture("transmit", d.transmit),
        ior: texture("ior", d.ior),
        absorb: texture("absorb", d.absorb),
        roughness: texture("roughness", d.roughness),
        metal: texture("metal", d.metal),
        emit: texture("emit", d.emit),
        opacity: texture("opacity", d.opacity),
        normal_map: block.texture("normal_map"),
        bump: block.texture("bump"),
    }))
}

fn lobe(block: &Block) -> Lobe {
    match block.word("lobe") {
        Some("phong") => Lobe::Phong,
        _ => Lobe::Blinn,
    }
}

fn fresnel(block: &Block) -> Fresnel {
    match block.word("fresnel") {
        Some("schlick") => Fresnel::Schlick,
        Some("exact") => Fresnel::Exact,
        Some(_) => Fresnel::None,
        None if block.has("transmit") => Fresnel::Exact,
        None => Fresnel::None,
    }
}
