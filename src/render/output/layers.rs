//! The layers of a film as channels of an EXR file: `albedo.R`, `normal.X`, … beside `R`, `G` and `B`, which stay what any program shows.

use crate::render::features::{Features, Layer};
use crate::render::film::Film;
use exr::prelude::{AnyChannel, AnyChannels, FlatSamples};

const RGB: [&str; 3] = ["R", "G", "B"];
const XYZ: [&str; 3] = ["X", "Y", "Z"];

/// Radiance and every layer that the film is to be written with.
pub fn channels(film: &Film) -> AnyChannels<FlatSamples> {
    let radiance = (0..3).map(|i| real(RGB[i].to_owned(), film.pixels.iter().map(|c| c[i]).collect()));
    let layers = Layer::ALL.into_iter().filter(|layer| film.layers.has(*layer));
    AnyChannels::sort(radiance.chain(layers.flat_map(|layer| of(layer, film))).collect())
}

fn of(layer: Layer, film: &Film) -> Vec<AnyChannel<FlatSamples>> {
    let vector = |name: &str, axes: [&str; 3], value: fn(&Features) -> glam::DVec3| {
        let channel = |i: usize| {
            real(format!("{name}.{}", axes[i]), film.features.iter().map(|f| value(f)[i]).collect())
        };
        (0..3).map(channel).collect()
    };
    match layer {
        Layer::Albedo => vector("albedo", RGB, |f| f.albedo),
        Layer::Normal => vector("normal", XYZ, |f| f.normal),
        Layer::Position => vector("position", XYZ, |f| f.position),
        Layer::Variance => vector("variance", RGB, |f| f.variance),
        Layer::Depth => vec![real("depth.Z".to_owned(), film.features.iter().map(|f| f.depth).collect())],
        Layer::Source => {
            let numbers = film.features.iter().map(|f| f.source).collect();
            vec![AnyChannel::new("source.id", FlatSamples::U32(numbers))]
        }
    }
}

fn real(name: String, values: Vec<f64>) -> AnyChannel<FlatSamples> {
    AnyChannel::new(name.as_str(), FlatSamples::F32(values.into_iter().map(|x| x as f32).collect()))
}
