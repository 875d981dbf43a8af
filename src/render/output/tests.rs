//! Tests of pictures as bytes and files.

use super::*;
use crate::render::settings::Crop;

fn film() -> Film {
    let mut film = Film::new([7, 5], Crop::all([7, 5]));
    for (i, p) in film.pixels.iter_mut().enumerate() {
        *p = Rgb::new(i as f64 / 10.0, 1.0 / (i + 1) as f64, 1e-3 * i as f64);
    }
    film
}

fn metadata() -> Metadata {
    Metadata {
        version: "0.1.0".into(),
        scene: "abc".into(),
        tracer: "whitted".into(),
        samples: 4,
        depth: 8,
        seed: 9,
        sampler: "sobol".into(),
        filter: "box".into(),
        size: [7, 5],
        ..Metadata::default()
    }
}

fn bytes(format: Format) -> Vec<u8> {
    encode(&film(), format, &Development::default(), &metadata()).unwrap()
}

#[test]
fn the_transfer_is_srgb_and_rounds_to_the_nearest() {
    for (linear, encoded) in
        [(0.0, 0), (0.001, 3), (0.01, 25), (0.18, 118), (0.5, 188), (1.0, 255), (-1.0, 0), (9.0, 255)]
    {
        assert_eq!(to_srgb8(linear), encoded, "{linear}");
    }
    assert_eq!(to_srgb8(f64::NAN), 0);
    for i in 0..=255u8 {
        assert_eq!(to_srgb8(srgb_decode(f64::from(i) / 255.0)), i);
    }
    for i in 0..=100_000 {
        let x = f64::from(i) / 100_000.0;
        let exact = (crate::math::colour::srgb_encode(x) * 255.0).round() as u8;
        assert_eq!(to_srgb8(x), exact, "{x}");
    }
}

#[test]
fn exposure_is_in_stops_and_tone_maps_stay_below_one() {
    let stop = Development { exposure: 1.0, tonemap: ToneMap::None };
    assert_eq!(stop.pixel(Rgb::splat(0.09)), [118; 3]);
    for tonemap in [ToneMap::Reinhard, ToneMap::Aces] {
        let map = |x: f64| tone(tonemap, Rgb::splat(x)).x;
        assert!(map(0.0) == 0.0 && map(0.5) < map(2.0) && map(1e6) < 1.04);
        assert!([1e150, 1e155, f64::MAX, f64::INFINITY].iter().all(|x| (0.999..1.04).contains(&map(*x))));
    }
    for tonemap in [ToneMap::None, ToneMap::Reinhard, ToneMap::Aces] {
        for exposure in [600.0, 2000.0, f64::MAX] {
            let bright = Development { exposure, tonemap };
            assert_eq!(bright.pixel(Rgb::splat(0.09)), [255; 3], "{tonemap:?} {exposure}");
            assert_eq!(bright.pixel(Rgb::ZERO), [0; 3], "{tonemap:?} {exposure}");
        }
    }
    assert!((tone(ToneMap::Reinhard, Rgb::ONE).x - 0.5).abs() < 1e-15);
}

#[test]
fn png_and_jpeg_decode_to_what_was_developed() {
    let png = image::load_from_memory(&bytes(Format::Png)).unwrap().to_rgb8();
    assert_eq!(png.into_raw(), develop_film(&film(), &Development::default()));
    let jpeg = image::load_from_memory(&bytes(Format::Jpeg)).unwrap();
    assert_eq!((jpeg.width(), jpeg.height()), (7, 5));
}

#[test]
fn exr_keeps_every_bit_of_f32_and_says_how_it_was_made() {
    use exr::prelude::*;
    let encoded = bytes(Format::Exr);
    assert_eq!(encoded, bytes(Format::Exr), "the same bytes each time");
    let image = image::load_from_memory(&encoded).unwrap().to_rgb32f();
    for (p, c) in image.pixels().zip(&film().pixels) {
        assert_eq!(p.0, c.as_vec3().to_array());
    }
    let meta = MetaData::read_from_buffered(Cursor::new(&encoded), false).unwrap();
    let own = &meta.headers[0].own_attributes;
    assert_eq!(own.software_name.as_ref().unwrap().to_string(), "ogee 0.1.0");
    let said: serde_json::Value = serde_json::from_str(&own.comments.as_ref().unwrap().to_string()).unwrap();
    assert_eq!((said["seed"].as_u64(), said["samples"].as_u64()), (Some(9), Some(4)));
}

#[test]
fn layers_stand_beside_the_radiance_and_leave_it_as_it_is() {
    use crate::render::features::{Features, Layer};
    use exr::prelude::*;
    let mut film = film();
    film.features = (0..35)
        .map(|i| Features {
            depth: f64::from(i) + 0.5,
            source: i % 3,
            normal: glam::DVec3::Y,
            ..Default::default()
        })
        .collect();
    film.layers = [Layer::Depth, Layer::Normal, Layer::Source].into_iter().collect();
    let encoded = encode(&film, Format::Exr, &Development::default(), &metadata()).unwrap();
    let plain = image::load_from_memory(&encoded).unwrap().to_rgb32f();
    assert!(plain.pixels().zip(&film.pixels).all(|(p, c)| p.0 == c.as_vec3().to_array()));
    let reader =
        read().no_deep_data().largest_resolution_level().all_channels().first_valid_layer().all_attributes();
    let image = reader.from_buffered(Cursor::new(&encoded)).unwrap();
    let names: Vec<String> = image.layer_data.channel_data.list.iter().map(|c| c.name.to_string()).collect();
    assert_eq!(names, ["B", "G", "R", "depth.Z", "normal.X", "normal.Y", "normal.Z", "source.id"]);
    let list = &image.layer_data.channel_data.list;
    assert_eq!(list[3].sample_data, FlatSamples::F32((0..35).map(|i| i as f32 + 0.5).collect()));
    assert_eq!(list[5].sample_data, FlatSamples::F32(vec![1.0; 35]));
    assert_eq!(list[7].sample_data, FlatSamples::U32((0..35).map(|i| i % 3).collect()));
}

#[test]
fn an_exr_of_a_crop_knows_its_place_in_the_whole() {
    use exr::prelude::*;
    let film = Film::new([20, 15], crate::render::settings::Crop { x: 11, y: 7, width: 4, height: 3 });
    let encoded = encode(&film, Format::Exr, &Development::default(), &metadata()).unwrap();
    let meta = MetaData::read_from_buffered(Cursor::new(&encoded), false).unwrap();
    let header = &meta.headers[0];
    assert_eq!(header.own_attributes.layer_position, Vec2(11, 7));
    assert_eq!(header.layer_size, Vec2(4, 3));
    assert_eq!(header.shared_attributes.display_window, IntegerBounds::new((0, 0), (20, 15)));
}

#[test]
fn hdr_keeps_radiance_to_its_eight_bits() {
    let image = image::load_from_memory(&bytes(Format::Hdr)).unwrap().to_rgb32f();
    for (p, c) in image.pixels().zip(&film().pixels) {
        let largest = c.max_element() as f32;
        assert!((p.0[0] - c.x as f32).abs() <= largest / 128.0, "{:?} {c}", p.0);
    }
}

#[test]
fn formats_are_known_by_their_extensions() {
    let of = |name: &str| Format::of(Path::new(name));
    assert_eq!(
        [of("a.PNG"), of("b/c.jpeg"), of("x.exr"), of("x.hdr")],
        [Some(Format::Png), Some(Format::Jpeg), Some(Format::Exr), Some(Format::Hdr)]
    );
    assert_eq!([of("a.gif"), of("png")], [None, None]);
    assert!(Format::EXTENSIONS.iter().all(|e| of(&format!("x.{e}")).is_some()));
}

#[test]
fn a_failed_write_leaves_the_old_file_and_nothing_else() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.png");
    write_atomically(&path, b"old").unwrap();
    write_atomically(&path, b"new").unwrap();
    assert_eq!(std::fs::read(&path).unwrap(), b"new");
    assert!(write_atomically(&folder.path().join("missing/a.png"), b"x").is_err());
    assert!(write_atomically(folder.path(), b"x").is_err(), "the path is a folder");
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
}
