//! Reading the pictures that materials name, before the first ray.

use crate::diag::{Code, Diagnostic};
use crate::scene::assets::{AssetCache, AssetError};
use crate::scene::{ImagePattern, Material, Pattern, PatternKind, Texture};
use std::path::Path;

/// Reads every picture that the materials name, each file once, and leaves it in its pattern. What cannot be read is an error
/// at the name, and gives faults where it is looked up.
pub fn load_pictures<'m>(
    materials: impl IntoIterator<Item = &'m Material>,
    cache: &AssetCache<'_>,
) -> Vec<Diagnostic> {
    let mut faults = Vec::new();
    for material in materials {
        each_texture(material, &mut |texture| load(texture, cache, &mut faults));
    }
    faults
}

fn each_texture(material: &Material, visit: &mut dyn FnMut(&Texture)) {
    visit(&material.diffuse);
    let Some(layers) = material.layers.as_deref() else { return };
    let given = [
        &layers.ambient,
        &layers.specular,
        &layers.exponent,
        &layers.reflect,
        &layers.transmit,
        &layers.ior,
        &layers.absorb,
        &layers.roughness,
        &layers.metal,
        &layers.emit,
        &layers.opacity,
    ];
    given.into_iter().for_each(&mut *visit);
    layers.normal_map.iter().chain(&layers.bump).for_each(visit);
}

fn load(texture: &Texture, cache: &AssetCache<'_>, faults: &mut Vec<Diagnostic>) {
    match texture {
        Texture::Constant(_) => {}
        Texture::Pattern(pattern) => load_pattern(pattern, cache, faults),
    }
}

fn load_pattern(pattern: &Pattern, cache: &AssetCache<'_>, faults: &mut Vec<Diagnostic>) {
    if let PatternKind::Image(image) = &pattern.kind {
        load_image(image, cache, faults);
    }
    pattern.kind.parts().into_iter().for_each(|part| load(part, cache, faults));
}

fn load_image(image: &ImagePattern, cache: &AssetCache<'_>, faults: &mut Vec<Diagnostic>) {
    if image.picture.get().is_some() {
        return;
    }
    match cache.image(&image.path) {
        Ok(picture) => image.picture.set(picture),
        Err(error) => {
            let fault = picture_fault(&image.path, &error);
            if !faults.iter().any(|f| f.span == Some(image.span) && f.code == fault.0) {
                faults.push(Diagnostic::new(fault.0, image.span, fault.1));
            }
        }
    }
}

fn picture_fault(path: &Path, error: &AssetError) -> (Code, String) {
    let name = path.display();
    match error {
        AssetError::Unreadable(why) => {
            (Code::FileNotFound, format!("the picture `{name}` cannot be read: {why}"))
        }
        AssetError::Image(why) => (Code::BadImage, format!("the picture `{name}` cannot be used: {why}")),
    }
}
