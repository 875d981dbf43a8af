//! What the materials of a file mean here.
//!
//! | there | here |
//! |---|---|
//! | base colour, metalness m | `diffuse` (1 − m)·base |
//! | base colour, metalness m | `metal` m·base + (1 − m)·0.04: Schlick's law from that colour, what it leaves goes to the base |
//! | roughness | `roughness`, squared: GGX's α |
//! | emissive colour, strength | `emit` |
//! | `MASK`, `BLEND` | `opacity`: the alpha of the base colour, cut off or as it is |
//! | transmission t, index | `transmit` t·base, less `diffuse`; `ior` where the material has a volume, else 1: a thin sheet bends no light |
//! | attenuation colour c after a distance d | `absorb` −ln(c)/d, of a volume |
//! | unlit | `ambient` base, and nothing else |
//!
//! Numbers times pictures become pictures. All surfaces shade on both sides. Occlusion is left out: light is computed.

use super::picture::{Look, Pictures, Reference};
use crate::diag::Span;
use crate::math::elementary::ln;
use crate::scene::assets::image::{Image, Reading};
use crate::scene::{Fresnel, Layers, Material, Pattern, PatternKind, Rgb, Texture};
use gltf::json::extensions::material::{Transmission, Volume};
use gltf::json::material::{AlphaMode, Material as FileMaterial};
use gltf::json::validation::Checked;
use std::sync::Arc;

/// Reflectance at normal incidence of what is no metal.
const DIELECTRIC: f64 = 0.04;

/// A material of the file, and what it asks of the mesh.
#[derive(Debug)]
pub(super) struct Made {
    pub material: Arc<Material>,
    /// Which texture coordinates it uses.
    pub uv_set: u32,
    /// Whether some picture uses others.
    pub mixes_uv_sets: bool,
}

/// Translates a material.
pub(super) fn material(from: &FileMaterial, pictures: &Pictures<'_, '_>, span: Span) -> Made {
    let pbr = &from.pbr_metallic_roughness;
    let look = |info: Option<Reference<'_>>| info.and_then(|info| pictures.look(&info));
    let normals =
        from.normal_texture.as_ref().map(|n| Reference { texture: n.index, set: n.tex_coord, moved: None });
    let looks = Looks {
        base: look(pbr.base_color_texture.as_ref().map(Reference::from)),
        shine: look(pbr.metallic_roughness_texture.as_ref().map(Reference::from)),
        normals: look(normals),
        emission: look(from.emissive_texture.as_ref().map(Reference::from)),
        through: look(
            transmission_of(from).and_then(|t| t.transmission_texture.as_ref()).map(Reference::from),
        ),
    };
    let sets: Vec<u32> = looks.all().map(|look| look.set).collect();
    let uv_set = sets.first().copied().unwrap_or(0);
    let made = Translation { from, pictures, looks: &looks, layers: Layers::DEFAULT, diffuse: Texture::ZERO };
    let (diffuse, layers) = made.finish();
    Made {
        material: Arc::new(Material { diffuse, layers: Some(Box::new(layers)), span }),
        uv_set,
        mixes_uv_sets: sets.iter().any(|set| *set != uv_set),
    }
}

struct Looks {
    base: Option<Look>,
    /// Roughness in green, metalness in blue.
    shine: Option<Look>,
    normals: Option<Look>,
    emission: Option<Look>,
    /// How much goes through, in red.
    through: Option<Look>,
}

impl Looks {
    fn all(&self) -> impl Iterator<Item = &Look> {
        [&self.base, &self.shine, &self.normals, &self.emission, &self.through].into_iter().flatten()
    }
}

fn transmission_of(from: &FileMaterial) -> Option<&Transmission> {
    from.extensions.as_ref()?.transmission.as_ref()
}

fn volume_of(from: &FileMaterial) -> Option<&Volume> {
    from.extensions.as_ref()?.volume.as_ref().filter(|volume| volume.thickness_factor.0 > 0.0)
}

struct Translation<'a, 'c> {
    from: &'a FileMaterial,
    pictures: &'a Pictures<'a, 'c>,
    looks: &'a Looks,
    layers: Layers,
    diffuse: Texture,
}

impl Translation<'_, '_> {
    fn finish(mut self) -> (Texture, Layers) {
        let extensions = self.from.extensions.as_ref();
        if extensions.is_some_and(|e| e.unlit.is_some()) {
            self.layers.ambient = self.base(Rgb::ONE);
        } else {
            self.shine();
            self.transmission();
            self.emission();
            self.relief();
        }
        self.opacity();
        (self.diffuse, self.layers)
    }

    /// The base colour, multiplied.
    fn base(&self, by: Rgb) -> Texture {
        let [r, g, b, _] = self.from.pbr_metallic_roughness.base_color_factor.0.map(share);
        let factor = Rgb::new(r, g, b) * by;
        match &self.looks.base {
            None => Texture::Constant(factor),
            Some(_) if factor == Rgb::ZERO => Texture::ZERO,
            Some(look) if factor == Rgb::ONE => self.pictures.texture(look, Arc::clone(&look.image), true),
            Some(look) => self.colours(look, |c| c * factor),
        }
    }

    /// A picture's colours changed.
    fn colours(&self, look: &Look, change: impl Fn(Rgb) -> Rgb) -> Texture {
        let image = look.image.map(Reading::Colour, |[r, g, b, _]| change(Rgb::new(r, g, b)).to_array());
        self.pictures.texture(look, Arc::new(image), true)
    }

    /// A number made of a picture's texels.
    fn numbers(&self, look: &Look, change: impl Fn([f64; 4]) -> f64) -> Texture {
        let image = look.image.map(Reading::Data, |texel| [change(texel)]);
        self.pictures.texture(look, Arc::new(image), false)
    }

    fn shine(&mut self) {
        let pbr = &self.from.pbr_metallic_roughness;
        let (metalness, roughness) = (share(pbr.metallic_factor.0), share(pbr.roughness_factor.0));
        self.layers.fresnel = Fresnel::Schlick;
        let Some(shine) = &self.looks.shine else {
            self.layers.roughness = Texture::number(roughness * roughness);
            self.diffuse = self.base(Rgb::splat(1.0 - metalness));
            self.layers.metal = self.normal_incidence(metalness);
            return;
        };
        let square = |x: f64| x * x;
        self.layers.roughness = self.numbers(shine, |[_, green, ..]| square(roughness * green));
        if metalness == 0.0 {
            self.diffuse = self.base(Rgb::ONE);
            self.layers.metal = Texture::number(DIELECTRIC);
            return;
        }
        self.diffuse = self.mixed(|base, m, _| base * (1.0 - m));
        self.layers.metal = self.mixed(|base, m, _| at_normal(base, m));
    }

    /// The colour at normal incidence for one metalness.
    fn normal_incidence(&self, metalness: f64) -> Texture {
        if metalness == 0.0 {
            return Texture::number(DIELECTRIC);
        }
        match (self.base(Rgb::ONE), &self.looks.base) {
            (Texture::Constant(base), _) => Texture::Constant(at_normal(base, metalness)),
            (base, _) if metalness == 1.0 => base,
            (_, Some(look)) => {
                let [r, g, b, _] = self.from.pbr_metallic_roughness.base_color_factor.0.map(share);
                self.colours(look, |c| at_normal(c * Rgb::new(r, g, b), metalness))
            }
            (base, None) => base,
        }
    }

    /// A colour from the base colour, the metalness and the share that goes through: as finely as the finest of their pictures.
    fn mixed(&self, f: impl Fn(Rgb, f64, f64) -> Rgb) -> Texture {
        let pbr = &self.from.pbr_metallic_roughness;
        let [r, g, b, _] = pbr.base_color_factor.0.map(share);
        let (tint, metalness) = (Rgb::new(r, g, b), share(pbr.metallic_factor.0));
        let through = transmission_of(self.from).map_or(0.0, |t| share(t.transmission_factor.0));
        let Looks { base, shine, through: sheer, .. } = self.looks;
        let texel = |look: &Option<Look>, x: f64, y: f64, reading| {
            look.as_ref().map_or([1.0; 4], |look| look.image.nearest(x, y, reading))
        };
        let colour = |x: f64, y: f64| {
            let [r, g, b, _] = texel(base, x, y, Reading::Colour);
            let [_, _, m, _] = texel(shine, x, y, Reading::Data);
            let [t, ..] = texel(sheer, x, y, Reading::Data);
            f(tint * Rgb::new(r, g, b), metalness * m, through * t).to_array()
        };
        let finer = |a: &'_ Look, b: &'_ Look| b.image.width() > a.image.width();
        let looks = [base, shine, sheer].into_iter().flatten();
        let Some(look) = looks.reduce(|a, b| if finer(a, b) { b } else { a }) else {
            return Texture::Constant(f(tint, metalness, through));
        };
        let image = Image::from_texels(look.image.width(), look.image.height(), colour);
        self.pictures.texture(look, Arc::new(image), true)
    }

    fn transmission(&mut self) {
        let Some(transmission) = transmission_of(self.from) else { return };
        let metalness = share(self.from.pbr_metallic_roughness.metallic_factor.0);
        let through = share(transmission.transmission_factor.0);
        let opaque = metalness == 1.0 && self.looks.shine.is_none();
        let ior =
            self.from.extensions.as_ref().and_then(|e| e.ior.as_ref()).map_or(1.5, |i| f64::from(i.ior.0));
        if opaque || through == 0.0 || !(ior >= 1.0) {
            return;
        }
        self.layers.metal = Texture::ZERO;
        self.layers.fresnel = Fresnel::Exact;
        self.layers.ior = Texture::number(1.0);
        if let Some(volume) = volume_of(self.from) {
            self.layers.ior = Texture::number(ior);
            self.layers.absorb = Texture::Constant(absorption(volume));
        }
        let (transmit, diffuse) = (|m: f64, t: f64| t * (1.0 - m), |m: f64, t: f64| (1.0 - t) * (1.0 - m));
        if self.looks.shine.is_none() && self.looks.through.is_none() {
            self.layers.transmit = self.base(Rgb::splat(transmit(metalness, through)));
            self.diffuse = self.base(Rgb::splat(diffuse(metalness, through)));
            return;
        }
        self.layers.transmit = self.mixed(|base, m, t| base * transmit(m, t));
        self.diffuse = self.mixed(|base, m, t| base * diffuse(m, t));
    }

    fn emission(&mut self) {
        let strength = self.from.extensions.as_ref().and_then(|e| e.emissive_strength.as_ref());
        let strength = strength.map_or(1.0, |s| f64::from(s.emissive_strength.0));
        let factor = Rgb::from(self.from.emissive_factor.0.map(f64::from)) * strength;
        let factor = if factor.is_finite() { factor.max(Rgb::ZERO) } else { Rgb::ZERO };
        self.layers.emit = match &self.looks.emission {
            Some(look) if factor == Rgb::ONE => self.pictures.texture(look, Arc::clone(&look.image), true),
            Some(look) if factor != Rgb::ZERO => self.colours(look, |c| c * factor),
            _ => Texture::Constant(factor),
        };
    }

    fn relief(&mut self) {
        let Some(look) = &self.looks.normals else { return };
        let scale = self.from.normal_texture.as_ref().map_or(1.0, |n| f64::from(n.scale));
        let bent = |x: f64| 0.5 + (x - 0.5) * scale;
        let image = match scale {
            1.0 => Arc::clone(&look.image),
            _ => Arc::new(look.image.map(Reading::Data, |[r, g, b, _]| [bent(r), bent(g), b])),
        };
        self.layers.normal_map = Some(self.pictures.texture(look, image, false));
    }

    fn opacity(&mut self) {
        let factor = share(self.from.pbr_metallic_roughness.base_color_factor.0[3]);
        let cutoff = self.from.alpha_cutoff.map_or(0.5, |c| f64::from(c.0));
        let picture = self.looks.base.as_ref().filter(|look| look.image.is_transparent());
        let cut = |alpha: f64| if alpha >= cutoff { 1.0 } else { 0.0 };
        self.layers.opacity = match (&self.from.alpha_mode, picture) {
            (Checked::Valid(AlphaMode::Opaque) | Checked::Invalid, _) => return,
            (Checked::Valid(AlphaMode::Mask), None) => Texture::number(cut(factor)),
            (Checked::Valid(AlphaMode::Blend), None) => Texture::number(factor),
            (Checked::Valid(AlphaMode::Blend), Some(look)) => {
                self.numbers(look, |[.., alpha]| alpha * factor)
            }
            (Checked::Valid(AlphaMode::Mask), Some(look)) => {
                let alpha = self.numbers(look, |[.., alpha]| alpha * factor);
                let stops = vec![(cutoff, Texture::ZERO), (cutoff, Texture::number(1.0))];
                let kind = PatternKind::Ramp(alpha, stops);
                Texture::Pattern(Arc::new(Pattern { kind, transform: None, span: self.pictures.span }))
            }
        };
    }
}

/// The colour at normal incidence.
fn at_normal(base: Rgb, metalness: f64) -> Rgb {
    base * metalness + Rgb::splat(DIELECTRIC * (1.0 - metalness))
}

/// What a volume takes away per unit length: all but a colour over a distance. Black is taken for the darkest normal f32.
fn absorption(volume: &Volume) -> Rgb {
    let distance = f64::from(volume.attenuation_distance.0);
    if !(distance > 0.0 && distance.is_finite()) {
        return Rgb::ZERO;
    }
    let lost = |c: f32| -ln(share(c).max(f64::from(f32::MIN_POSITIVE))) / distance;
    Rgb::from(volume.attenuation_color.0.map(lost))
}

/// A number of 0 … 1.
fn share(x: f32) -> f64 {
    if x.is_finite() { f64::from(x).clamp(0.0, 1.0) } else { 0.0 }
}
