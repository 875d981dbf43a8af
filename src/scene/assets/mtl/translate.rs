//! What the statements of a .mtl material mean here.
//!
//! | there | here |
//! |---|---|
//! | `Kd`, `map_Kd` | `diffuse`; a picture stands in for the number, as modellers write them |
//! | `Ks`, `Ns` with `illum` 2 or none | `specular`, `exponent`, Blinn's lobe; none where `Ns` is below 1 |
//! | `illum 3`, `5`, `8` | `reflect` Ks; with Schlick's law for 5 |
//! | `illum 4`, `6`, `7`, `9` | `transmit` by `Tf` (else 1 − d, else 1), `ior` Ni |
//! | `d`, `1 − Tr`, `map_d`, the alpha of `map_Kd` | `opacity` |
//! | `Ke`, `map_Ke` | `emit` |
//! | `Pm`, `Pr`, `map_Pr` | `metal` Kd where Pm ≥ ½, else a smooth coat of 4 %; `roughness` Pr² |
//! | `norm`, `bump`, `map_bump` | `normal_map` where the picture is one, else `bump` |
//!
//! `Ka` is left out: it is the share of a light that scenes here do not have. No sum of shares exceeds 1.

use super::maps::{MapStatement, Maps, parse};
use crate::diag::Span;
use crate::math::Affine;
use crate::scene::{Fresnel, ImagePattern, Layers, Lobe, Material, Pattern, PatternKind, Rgb, Texture};
use glam::DVec3;
use std::sync::Arc;

/// Reflectance at normal incidence of a dielectric of index 1.5: what metalness 0 means in a PBR workflow.
const DIELECTRIC: f64 = 0.04;

/// The height in scene units of a bump map's full range for `-bm 1`. The format gives no unit; pictures are made for shallow
/// reliefs.
const BUMP_HEIGHT: f64 = 0.01;

/// A scene's material.
pub(super) fn material(from: &tobj::Material, maps: &mut Maps<'_, '_>, span: Span) -> Material {
    let mut made = Translation { from, maps, span, layers: Layers::DEFAULT, diffuse: Texture::number(0.8) };
    made.diffuse();
    made.reflection();
    made.opacity();
    made.emission();
    made.relief();
    Material { diffuse: made.diffuse, layers: Some(Box::new(made.layers)), span }
}

struct Translation<'a, 'm, 'c> {
    from: &'a tobj::Material,
    maps: &'a mut Maps<'m, 'c>,
    span: Span,
    layers: Layers,
    diffuse: Texture,
}

impl Translation<'_, '_, '_> {
    fn diffuse(&mut self) {
        let kd = self.from.diffuse.map_or(Rgb::splat(0.8), share);
        self.diffuse = Texture::Constant(kd);
        let Some(statement) = &self.from.diffuse_texture else { return };
        let map = parse(statement);
        if let Some((pattern, image)) = self.maps.picture(&map, self.span) {
            if image.is_transparent() && self.from.dissolve_texture.is_none() {
                self.layers.opacity = self.texture(&map, pattern.clone());
            }
            self.diffuse = self.texture(&map, pattern);
        }
    }

    fn reflection(&mut self) {
        let from = self.from;
        let ks = from.specular.map_or(Rgb::ZERO, share);
        self.layers.ior = Texture::number(from.optical_density.filter(|n| *n > 0.0).unwrap_or(1.5));
        match from.illumination_model {
            _ if self.is_pbr() => self.physically_based(),
            Some(0 | 1) => {}
            Some(model @ (3 | 5 | 8)) => {
                self.layers.reflect = Texture::Constant(ks);
                self.layers.fresnel = if model == 5 { Fresnel::Schlick } else { Fresnel::None };
            }
            Some(4 | 6 | 7 | 9) => self.glass(),
            Some(_) | None => self.glossy(ks),
        }
    }

    /// A lobe, with the diffuse share lowered so that both together return no more than they get.
    fn glossy(&mut self, ks: Rgb) {
        let exponent = self.from.shininess.unwrap_or(0.0);
        let specular = self.from.specular_texture.clone();
        if exponent < 1.0 || (ks == Rgb::ZERO && specular.is_none()) {
            return;
        }
        self.layers.exponent = Texture::number(exponent);
        self.layers.lobe = Lobe::Blinn;
        self.layers.specular = Texture::Constant(ks);
        match &mut self.diffuse {
            Texture::Constant(kd) => {
                let over = (*kd + ks).max(Rgb::ONE);
                *kd /= over;
                self.layers.specular = Texture::Constant(ks / over);
            }
            Texture::Pattern(_) => self.layers.specular = Texture::Constant(ks.min(Rgb::splat(0.5))),
        }
        if let Some(statement) = specular {
            let map = parse(&statement);
            if let Some((pattern, _)) = self.maps.picture(&map, self.span) {
                self.layers.specular = self.texture(&map, pattern);
            }
        }
    }

    /// Clear glass: what is not reflected goes through, filtered by `Tf`.
    fn glass(&mut self) {
        let through = match (self.parameter("Tf").and_then(triple), self.given_opacity()) {
            (Some(filter), _) => share(filter),
            (None, Some(opacity)) if opacity < 1.0 => Rgb::splat(1.0 - opacity),
            (None, _) => Rgb::ONE,
        };
        self.layers.transmit = Texture::Constant(through);
        self.layers.fresnel = Fresnel::Exact;
        if let Texture::Constant(kd) = &mut self.diffuse {
            *kd = kd.min(Rgb::ONE - through);
        }
    }

    fn is_pbr(&self) -> bool {
        ["Pr", "Pm", "map_pr", "map_pm"].into_iter().any(|name| self.parameter(name).is_some())
    }

    fn physically_based(&mut self) {
        let number = |name| self.parameter(name).and_then(|v| v.parse::<f64>().ok());
        let (roughness, metalness) = (number("Pr").unwrap_or(0.5), number("Pm").unwrap_or(0.0));
        let alpha = roughness.clamp(0.0, 1.0);
        self.layers.roughness = Texture::number(alpha * alpha);
        if let Some(statement) = self.parameter("map_pr").map(str::to_owned) {
            let map = parse(&statement);
            if let Some((pattern, _)) = self.maps.picture(&map, self.span) {
                self.layers.roughness = self.texture(&map, pattern);
            }
        }
        if metalness >= 0.5 {
            self.layers.metal = std::mem::replace(&mut self.diffuse, Texture::ZERO);
        } else {
            self.layers.reflect = Texture::number(DIELECTRIC);
            self.layers.fresnel = Fresnel::Schlick;
        }
    }

    fn opacity(&mut self) {
        let is_glass = !matches!(self.layers.transmit, Texture::Constant(Rgb::ZERO));
        if let Some(statement) = &self.from.dissolve_texture {
            let map = parse(statement);
            if let Some((pattern, _)) = self.maps.picture(&map, self.span) {
                self.layers.opacity = self.texture(&map, pattern);
            }
        } else if let (false, Some(opacity), Texture::Constant(_)) =
            (is_glass, self.given_opacity(), &self.layers.opacity)
        {
            self.layers.opacity = Texture::number(opacity);
        }
    }

    /// `d`, or 1 − `Tr` where no `d` is given: files that give both mean `d`.
    fn given_opacity(&self) -> Option<f64> {
        let from_tr = || self.parameter("Tr").and_then(|v| v.parse::<f64>().ok()).map(|tr| 1.0 - tr);
        self.from.dissolve.or_else(from_tr).map(|d| d.clamp(0.0, 1.0))
    }

    fn emission(&mut self) {
        let ke = self.from.emissive.map_or(Rgb::ZERO, |c| Rgb::from(c).max(Rgb::ZERO));
        self.layers.emit = Texture::Constant(ke);
        if let Some(statement) = self.parameter("map_ke").map(str::to_owned) {
            let map = parse(&statement);
            if let Some((pattern, _)) = self.maps.picture(&map, self.span) {
                self.layers.emit = self.texture(&map, pattern);
            }
        }
    }

    fn relief(&mut self) {
        let normals = self.parameter("norm").map(str::to_owned);
        let is_norm = normals.is_some();
        let Some(statement) = normals.or_else(|| self.from.normal_texture.clone()) else { return };
        let map = parse(&statement);
        let Some((pattern, image)) = self.maps.picture(&map, self.span) else { return };
        if is_norm || image.looks_like_normals() {
            self.layers.normal_map = Some(self.texture(&map, ImagePattern { colour: false, ..pattern }));
        } else {
            self.layers.bump = Some(self.heights(&map, pattern));
        }
    }

    /// Black 0, white `-bm` times the usual height.
    fn heights(&self, map: &MapStatement<'_>, pattern: ImagePattern) -> Texture {
        let picture = self.texture(map, ImagePattern { colour: false, ..pattern });
        let stops = vec![(0.0, Texture::ZERO), (1.0, Texture::number(map.bump * BUMP_HEIGHT))];
        self.pattern(PatternKind::Ramp(picture, stops), None)
    }

    /// A picture at s·(u, v) + o: the pattern stands where that is undone.
    fn texture(&self, map: &MapStatement<'_>, pattern: ImagePattern) -> Texture {
        let [su, sv] = map.scale.map(|s| if s == 0.0 { 1.0 } else { s });
        let moved = (map.offset, [su, sv]) != ([0.0; 2], [1.0; 2]);
        let transform = moved.then(|| {
            let offset = DVec3::new(-map.offset[0], -map.offset[1], 0.0);
            Affine::translate(offset).then(&Affine::scale(DVec3::new(1.0 / su, 1.0 / sv, 1.0)))
        });
        self.pattern(PatternKind::Image(pattern), transform)
    }

    fn pattern(&self, kind: PatternKind, transform: Option<Affine>) -> Texture {
        let transform = transform.map(Box::new);
        Texture::Pattern(Arc::new(Pattern { kind, transform, span: self.span }))
    }

    fn parameter(&self, name: &str) -> Option<&str> {
        self.from.unknown_param.get(name).map(String::as_str)
    }
}

/// A colour whose components are shares of light.
fn share(colour: [f64; 3]) -> Rgb {
    Rgb::from(colour).clamp(Rgb::ZERO, Rgb::ONE)
}

fn triple(text: &str) -> Option<[f64; 3]> {
    let numbers: Vec<f64> = text.split_whitespace().filter_map(|w| w.parse().ok()).collect();
    numbers.try_into().ok()
}
