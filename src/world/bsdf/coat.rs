//! A material made ready for rays: what is the same at every point of it is found once.

use super::Bsdf;
use crate::scene::{Layers, Material, Rgb, Texture};
use crate::world::texture::TexturePoint;
use std::sync::Arc;

/// A material, and what it is at every point if that is the same. Small, because a scene may have millions.
#[derive(Debug)]
pub struct Coat {
    /// As it was written.
    pub material: Arc<Material>,
    pub(super) same: Same,
}

/// What a material is at every point.
#[derive(Debug)]
pub(super) enum Same {
    /// A pattern or a map decides.
    No,
    /// Matt and nothing else, of this albedo.
    Matt(Rgb),
    /// This.
    All(Box<Bsdf>),
}

impl Coat {
    /// Made ready. Pictures need not have been read.
    pub fn new(material: Arc<Material>) -> Coat {
        let same = match (&material.layers, &material.diffuse) {
            (None, Texture::Constant(albedo)) => Same::Matt(*albedo),
            (None, Texture::Pattern(_)) => Same::No,
            (Some(_), _) => layered(&material).map_or(Same::No, |bsdf| Same::All(Box::new(bsdf))),
        };
        Coat { material, same }
    }

    /// True where it surely emits nothing and hides what is behind it.
    pub fn is_dark(&self) -> bool {
        match &self.same {
            Same::No => false,
            Same::Matt(_) => true,
            Same::All(same) => same.emit == Rgb::ZERO && same.opacity == 1.0,
        }
    }

    /// Whether a map turns the normal, for which the surface's tangent is needed.
    pub fn bends_normal(&self) -> bool {
        matches!(self.same, Same::No) && self.material.bends_normal()
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

/// What it is wherever it is asked. None where a pattern or a map decides.
fn layered(material: &Material) -> Option<Bsdf> {
    if !is_same_everywhere(material) {
        return None;
    }
    let mut bsdf = Bsdf::BARE;
    bsdf.add(material, &TexturePoint::default()).ok()?;
    Some(bsdf.with_losses())
}
