//! A material made ready for rays: what is the same at every point of it is found once.

use super::Bsdf;
use crate::scene::{Layers, Material, Rgb, Texture};
use crate::world::texture::TexturePoint;
use std::sync::Arc;

/// A material, and what it is at every point if that is the same.
#[derive(Debug)]
pub struct Coat {
    /// As it was written.
    pub material: Arc<Material>,
    /// None where a pattern or a map decides.
    pub(super) same: Option<Bsdf>,
}

impl Coat {
    /// Made ready. Pictures need not have been read.
    pub fn new(material: Arc<Material>) -> Coat {
        let same = is_same_everywhere(&material).then(|| constant(&material)).flatten();
        Coat { material, same }
    }

    /// True where it surely emits nothing and hides what is behind it.
    pub fn is_dark(&self) -> bool {
        self.same.as_ref().is_some_and(|same| same.emit == Rgb::ZERO && same.opacity == 1.0)
    }

    /// Whether a map turns the normal, for which the surface's tangent is needed.
    pub fn bends_normal(&self) -> bool {
        self.same.is_none() && self.material.bends_normal()
    }
}

fn is_same_everywhere(material: &Material) -> bool {
    let Layers { ambient, specular, exponent, lobe: _, reflect, fresnel: _, transmit, ior, .. } =
        material.layers();
    let Layers { absorb, roughness, metal, emit, opacity, normal_map, bump, .. } = material.layers();
    let base = [&material.diffuse, ambient, specular, exponent, emit, opacity];
    let beyond = [reflect, transmit, ior, absorb, roughness, metal];
    let is_constant = |texture: &Texture| matches!(texture, Texture::Constant(_));
    base.into_iter().chain(beyond).all(is_constant)
        && normal_map.is_none()
        && bump.as_ref().is_none_or(is_constant)
}

/// Wherever it is asked.
fn constant(material: &Material) -> Option<Bsdf> {
    let mut bsdf = Bsdf::BARE;
    bsdf.add(material, &TexturePoint::default()).ok()?;
    Some(bsdf.with_losses())
}
