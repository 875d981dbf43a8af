//! Reading the pictures that materials and skies name, before the first ray.

use crate::diag::{Code, Diagnostic, Span};
use crate::scene::assets::image::Picture;
use crate::scene::assets::{AssetCache, AssetError};
use crate::scene::{ImagePattern, Light, LightSource, Material, Pattern, PatternKind, Sky, Texture};
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

/// Reads the pictures of skies, and leaves them in their lights. What cannot be read is an error at the name, and gives no light.
pub fn load_skies<'l>(
    lights: impl IntoIterator<Item = &'l Light>,
    cache: &AssetCache<'_>,
) -> Vec<Diagnostic> {
    let mut faults = Vec::new();
    for light in lights {
        if let LightSource::Sky(Sky::Image { path, span, picture, .. }) = &light.source {
            load_picture(picture, path, *span, cache, &mut faults);
        }
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
    load_picture(&image.picture, &image.path, image.span, cache, faults);
}

fn load_picture(
    picture: &Picture,
    path: &Path,
    span: Span,
    cache: &AssetCache<'_>,
    faults: &mut Vec<Diagnostic>,
) {
    if picture.get().is_some() {
        return;
    }
    match cache.image(path) {
        Ok(image) => picture.set(image),
        Err(error) => {
            let fault = picture_fault(path, &error);
            if !faults.iter().any(|f| f.span == Some(span) && f.code == fault.0) {
                faults.push(Diagnostic::new(fault.0, span, fault.1));
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
