//! Movies read back by the decoders of others.

use super::*;
use crate::render::settings::Crop;
use crate::scene::Rgb;
use std::io::Cursor;

/// A grey ramp with a bright square that moves to the right.
fn film(step: u32, [width, height]: [u32; 2]) -> Film {
    let size = [width, height];
    let mut film = Film::new(size, Crop { x: 0, y: 0, width, height });
    for (i, pixel) in film.pixels.iter_mut().enumerate() {
        let (x, y) = (i as u32 % width, i as u32 / width);
        let inside = (x.wrapping_sub(4 * step) < 6) && (4..10).contains(&y);
        *pixel = if inside { Rgb::new(0.9, 0.3, 0.1) } else { Rgb::splat(f64::from(x + y) / 80.0) };
    }
    film
}

fn movie(format: MovieFormat, fps: f64, n: u32) -> Movie {
    let mut movie = Movie::new(format, fps);
    (0..n).for_each(|step| movie.push(&film(step, [40, 24]), &Development::default()).unwrap());
    movie
}

/// Each frame as a viewer shows it.
fn shown<'a>(decoder: impl image::AnimationDecoder<'a>) -> Vec<(Vec<u8>, (u32, u32))> {
    let frames = decoder.into_frames().collect_frames().unwrap();
    let rgb = |frame: &image::Frame| {
        frame.buffer().pixels().flat_map(|p| [p.0[0], p.0[1], p.0[2]]).collect::<Vec<u8>>()
    };
    frames.iter().map(|frame| (rgb(frame), frame.delay().numer_denom_ms())).collect()
}

#[test]
fn an_apng_gives_back_every_pixel_of_every_frame_and_their_times() {
    let bytes = movie(MovieFormat::Apng, 25.0, 5).encode().unwrap();
    let decoder = image::codecs::png::PngDecoder::new(Cursor::new(&bytes)).unwrap();
    let frames = shown(decoder.apng().unwrap());
    assert_eq!(frames.len(), 5);
    for (step, (pixels, (numerator, denominator))) in frames.iter().enumerate() {
        assert!(*pixels == develop_film(&film(step as u32, [40, 24]), &Development::default()), "{step}");
        assert_eq!(numerator / denominator, 40);
    }
}

/// The frames of a GIF as a viewer shows them, and their times in hundredths of a second.
fn shown_gif(bytes: &[u8]) -> Vec<(Vec<[u8; 3]>, u16)> {
    let mut options = ::gif::DecodeOptions::new();
    options.set_color_output(::gif::ColorOutput::RGBA);
    let mut decoder = options.read_info(bytes).unwrap();
    let width = usize::from(decoder.width());
    let mut screen = vec![[0; 3]; width * usize::from(decoder.height())];
    let mut shown = Vec::new();
    while let Some(frame) = decoder.read_next_frame().unwrap() {
        for (i, p) in frame.buffer.chunks_exact(4).enumerate().filter(|(_, p)| p[3] == 255) {
            let (x, y) = (i % usize::from(frame.width), i / usize::from(frame.width));
            screen[(usize::from(frame.top) + y) * width + usize::from(frame.left) + x] = [p[0], p[1], p[2]];
        }
        shown.push((screen.clone(), frame.delay));
    }
    shown
}

#[test]
fn a_gif_of_few_colours_is_exact_and_as_long_as_the_animation() {
    let frames = shown_gif(&movie(MovieFormat::Gif, 24.0, 24).encode().unwrap());
    assert_eq!(frames.len(), 24);
    assert_eq!(frames.iter().map(|(_, delay)| u32::from(*delay)).sum::<u32>(), 100, "a second");
    for (step, (pixels, _)) in frames.iter().enumerate() {
        let exact = develop_film(&film(step as u32, [40, 24]), &Development::default());
        assert!(pixels.concat() == exact, "frame {step}");
    }
}

#[test]
fn a_gif_of_many_colours_is_near_in_every_pixel() {
    let mut many = Film::new([64, 64], Crop { x: 0, y: 0, width: 64, height: 64 });
    for (i, pixel) in many.pixels.iter_mut().enumerate() {
        *pixel = Rgb::new((i % 64) as f64 / 63.0, (i / 64) as f64 / 63.0, 0.2);
    }
    let mut movie = Movie::new(MovieFormat::Gif, 10.0);
    movie.push(&many, &Development::default()).unwrap();
    let exact = develop_film(&many, &Development::default());
    let shown = &shown_gif(&movie.encode().unwrap())[0].0;
    let off = shown.concat().iter().zip(&exact).map(|(a, b)| f64::from(a.abs_diff(*b)).powi(2)).sum::<f64>();
    let rms = (off / exact.len() as f64).sqrt();
    // 255 squares of 16 × 16 would be off by 16/√12 in two of the three channels: by 3.8 of all.
    assert!(rms < 2.0 * 3.8, "off by {rms} of 255");
}

#[test]
fn what_does_not_change_takes_no_room_and_the_same_frames_give_the_same_bytes() {
    for format in [MovieFormat::Gif, MovieFormat::Apng] {
        let mut still = Movie::new(format, 24.0);
        still.push(&film(0, [40, 24]), &Development::default()).unwrap();
        let one = still.encode().unwrap().len();
        still.push(&film(0, [40, 24]), &Development::default()).unwrap();
        let two = still.encode().unwrap().len();
        assert!(two < one + 900, "{one} bytes, and {two} with a second frame that is the same");
        assert!(movie(format, 24.0, 4).encode().unwrap() == movie(format, 24.0, 4).encode().unwrap());
    }
}

#[test]
fn frames_of_another_size_are_refused() {
    let mut movie = movie(MovieFormat::Gif, 24.0, 1);
    let fault = movie.push(&film(0, [20, 24]), &Development::default()).unwrap_err();
    assert!(fault.to_string().contains("it is 20×24, and the frames before are 40×24"), "{fault}");
    assert_eq!(movie.len(), 1);
}

#[test]
fn times_of_frames_are_exact_fractions_where_they_can_be() {
    assert_eq!(apng::delay(24.0), (1, 24));
    assert_eq!(apng::delay(29.97), (100, 2997));
    assert_eq!(apng::delay(0.5), (10, 5));
    assert_eq!(apng::delay(1e-4), (10_000, 1));
    assert_eq!(apng::delay(1e9), (0, 1));
}
