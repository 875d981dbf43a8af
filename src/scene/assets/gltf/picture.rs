//! The pictures of a file, embedded or beside it, and how its textures look them up.

use super::accessor::Numbers;
use super::uri::{Source, source};
use crate::diag::Span;
use crate::math::Affine;
use crate::math::elementary::sin_cos;
use crate::scene::assets::AssetCache;
use crate::scene::assets::image::{Image, Picture};
use crate::scene::{Filter, ImagePattern, Pattern, PatternKind, Texture, Wrap};
use glam::{DMat3, DVec3};
use gltf::json::texture::{Info, MagFilter, Sampler, WrappingMode};
use gltf::json::validation::Checked;
use gltf::json::{Index, Root};
use std::cell::RefCell;
use std::collections::HashMap;
use std::path::Path;
use std::sync::Arc;

/// Finds and decodes the pictures of one file, each once.
pub(super) struct Pictures<'a, 'c> {
    pub root: &'a Root,
    pub numbers: &'a Numbers<'a>,
    pub cache: &'a AssetCache<'c>,
    /// The model's.
    pub path: &'a Path,
    pub span: Span,
    /// What cannot be had, in words.
    pub missing: RefCell<Vec<String>>,
    pub decoded: RefCell<HashMap<usize, Option<Arc<Image>>>>,
}

/// A texture of a material: which picture, which coordinates, how looked up.
pub(super) struct Look {
    pub image: Arc<Image>,
    /// Which set of texture coordinates.
    pub set: u32,
    wrap: Wrap,
    filter: Filter,
    transform: Option<Box<Affine>>,
}

/// A reference to a texture, of whatever kind.
pub(super) struct Reference<'a> {
    pub texture: Index<gltf::json::Texture>,
    pub set: u32,
    pub moved: Option<&'a gltf::json::extensions::texture::TextureTransform>,
}

impl<'a> From<&'a Info> for Reference<'a> {
    fn from(info: &'a Info) -> Self {
        let moved = info.extensions.as_ref().and_then(|e| e.texture_transform.as_ref());
        let set = moved.and_then(|m| m.tex_coord).unwrap_or(info.tex_coord);
        Reference { texture: info.index, set, moved }
    }
}

impl Pictures<'_, '_> {
    /// A texture; none where it is missing, which is noted.
    pub fn look(&self, reference: &Reference<'_>) -> Option<Look> {
        let Some(texture) = self.root.textures.get(reference.texture.value()) else {
            self.note(format!("there is no texture {}", reference.texture.value()));
            return None;
        };
        let image = self.image(texture.source.value())?;
        let sampler = texture.sampler.and_then(|s| self.root.samplers.get(s.value()));
        let (wrap, filter) = sampler.map_or((Wrap::Repeat, Filter::Bilinear), |s| (self.wrap(s), filter(s)));
        let transform = reference.moved.and_then(surface_from_pattern).map(Box::new);
        Some(Look { image, set: reference.set, wrap, filter, transform })
    }

    fn wrap(&self, sampler: &Sampler) -> Wrap {
        let of = |mode: &Checked<WrappingMode>| match mode {
            Checked::Valid(WrappingMode::ClampToEdge) => Wrap::Clamp,
            Checked::Valid(WrappingMode::MirroredRepeat) => Wrap::Mirror,
            Checked::Valid(WrappingMode::Repeat) | Checked::Invalid => Wrap::Repeat,
        };
        if of(&sampler.wrap_s) != of(&sampler.wrap_t) {
            self.note(
                "a picture goes on beyond its sides otherwise than beyond its top; both are as its sides"
                    .into(),
            );
        }
        of(&sampler.wrap_s)
    }

    fn image(&self, index: usize) -> Option<Arc<Image>> {
        if let Some(known) = self.decoded.borrow().get(&index) {
            return known.clone();
        }
        let image =
            self.read(index).map_err(|why| self.note(format!("picture {index} cannot be used: {why}"))).ok();
        self.decoded.borrow_mut().insert(index, image.clone());
        image
    }

    fn read(&self, index: usize) -> Result<Arc<Image>, String> {
        let image = self
            .root
            .images
            .get(index)
            .ok_or("it is not in the file, or of an extension that is not read")?;
        let decoded = |bytes: &[u8]| {
            let ending = image.mime_type.as_ref().and_then(|m| m.0.strip_prefix("image/")).unwrap_or("png");
            Image::decode(bytes, &Path::new("picture").with_extension(ending))
                .map(Arc::new)
                .map_err(|e| e.to_string())
        };
        match (image.buffer_view, &image.uri) {
            (Some(view), _) => decoded(self.numbers.view(view)?),
            (None, None) => Err("it is nowhere".into()),
            (None, Some(uri)) => match source(uri)? {
                Source::Bytes(bytes) => decoded(&bytes),
                Source::File(name) => {
                    let path = self.path.parent().unwrap_or(Path::new("")).join(&name);
                    self.cache.image(&path).map_err(|why| format!("`{name}`: {why}"))
                }
            },
        }
    }

    fn note(&self, what: String) {
        let mut missing = self.missing.borrow_mut();
        if !missing.contains(&what) {
            missing.push(what);
        }
    }

    /// A picture, made from that of a texture, looked up as the texture says.
    pub fn texture(&self, look: &Look, image: Arc<Image>, colour: bool) -> Texture {
        let picture = Picture::default();
        picture.set(image);
        let (wrap, filter, span) = (look.wrap, look.filter, self.span);
        let path = self.path.to_owned();
        let kind = PatternKind::Image(ImagePattern { path, wrap, filter, colour, span, picture });
        Texture::Pattern(Arc::new(Pattern { kind, transform: look.transform.clone(), span }))
    }
}

fn filter(sampler: &Sampler) -> Filter {
    match sampler.mag_filter {
        Some(Checked::Valid(MagFilter::Nearest)) => Filter::Nearest,
        _ => Filter::Bilinear,
    }
}

/// Where a picture stands on the surface: the format looks it up at T·R·S·(u, v) with v downward. None where that is no move at all, or
/// flattens the picture.
fn surface_from_pattern(moved: &gltf::json::extensions::texture::TextureTransform) -> Option<Affine> {
    let [du, dv] = moved.offset.0.map(f64::from);
    let [su, sv] = moved.scale.0.map(f64::from);
    let (sin, cos) = sin_cos(f64::from(moved.rotation.0));
    let flip = |u: DVec3| DVec3::new(u.x, 1.0 - u.y, 0.0);
    // p ↦ (c su·u + s sv·v, −s su·u + c sv·v) + offset, between two flips of v.
    let image = |p: DVec3| {
        let p = flip(p);
        let (u, v) = (su * p.x, sv * p.y);
        flip(DVec3::new(cos * u + sin * v + du, -sin * u + cos * v + dv, 0.0))
    };
    let origin = image(DVec3::ZERO);
    let linear = DMat3::from_cols(image(DVec3::X) - origin, image(DVec3::Y) - origin, DVec3::Z);
    let pattern_from_surface = Affine::from_columns(linear, origin)?;
    (pattern_from_surface != Affine::IDENTITY).then(|| pattern_from_surface.inverse())
}

#[cfg(test)]
mod tests {
    use super::*;
    use gltf::json::extensions::texture::{
        TextureTransform, TextureTransformRotation, TextureTransformScale,
    };

    #[test]
    fn a_moved_picture_is_looked_up_where_the_format_says() {
        let mut moved =
            TextureTransform { scale: TextureTransformScale([2.0, 4.0]), ..TextureTransform::default() };
        moved.offset.0 = [0.5, 0.25];
        let back = surface_from_pattern(&moved).unwrap().inverse();
        // There (0.1, 0.2) from the top is looked up at (0.7, 1.05) from the top.
        let seen = back.point(DVec3::new(0.1, 0.8, 0.0));
        assert!((seen - DVec3::new(0.7, 1.0 - 1.05, 0.0)).length() < 1e-15, "{seen}");
        moved = TextureTransform {
            rotation: TextureTransformRotation(std::f32::consts::FRAC_PI_2),
            ..TextureTransform::default()
        };
        let back = surface_from_pattern(&moved).unwrap().inverse();
        // (u, v) ↦ (v, −u) with v downward.
        let seen = back.point(DVec3::new(0.1, 0.8, 0.0));
        assert!((seen - DVec3::new(0.2, 1.1, 0.0)).length() < 1e-7, "{seen}");
        assert!(surface_from_pattern(&TextureTransform::default()).is_none());
    }
}
