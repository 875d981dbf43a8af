//! Films made for the filter: what it must leave, what it must take away.

use super::*;
use crate::render::features::{Features, Halves};
use crate::render::settings::Crop;
use glam::DVec3;

const SIZE: [u32; 2] = [40, 36];

/// A film of a wall that faces the camera, by pixel: radiance of the two halves of its samples, and the variance of their mean.
fn wall(pixel: impl Fn(u32, u32) -> (Features, [Rgb; 2], f64)) -> Film {
    let mut film = Film::new(SIZE, Crop::all(SIZE));
    for y in 0..SIZE[1] {
        for x in 0..SIZE[0] {
            let (features, [first, second], variance) = pixel(x, y);
            let halves = Halves { first, share: 0.5 };
            film.pixels[(y * SIZE[0] + x) as usize] = (first + second) / 2.0;
            film.features.push(Features { halves, variance: Rgb::splat(variance), ..features });
        }
    }
    film.finished.fill(true);
    film
}

/// White, a unit away.
fn white(x: u32, y: u32) -> Features {
    let position = DVec3::new(f64::from(x), f64::from(y), 0.0) / 50.0;
    Features { albedo: Rgb::ONE, normal: DVec3::Z, depth: 1.0, position, ..Features::default() }
}

/// Seeded noise, uniform in ±√3: its variance is 1.
fn noise(x: u32, y: u32, which: u32) -> f64 {
    let u = crate::render::sampler::Sampler::new(7, x, y, which).next_2d().x;
    (2.0 * u - 1.0) * 3.0f64.sqrt()
}

fn filtered(film: &Film, threads: Option<usize>) -> Vec<Rgb> {
    denoised(film, threads, &(), &AtomicBool::new(false)).expect("nobody cancels")
}

/// Mean squared difference to what is true.
fn mse(pixels: &[Rgb], truth: impl Fn(u32, u32) -> f64) -> f64 {
    let of = |(i, c): (usize, &Rgb)| {
        (*c - Rgb::splat(truth(i as u32 % SIZE[0], i as u32 / SIZE[0]))).length_squared() / 3.0
    };
    pixels.iter().enumerate().map(of).sum::<f64>() / pixels.len() as f64
}

/// A picture whose halves have noise of standard deviation 0.2, and so their mean of 0.2/√2.
fn noisy(truth: impl Fn(u32, u32) -> f64, features: impl Fn(u32, u32) -> Features) -> Film {
    wall(|x, y| {
        let half = |which| Rgb::splat(truth(x, y) + 0.2 * noise(x, y, which));
        (features(x, y), [half(0), half(1)], 0.02)
    })
}

#[test]
fn a_picture_without_noise_stays_to_the_last_bits() {
    let film = wall(|x, y| {
        let c = Rgb::new(f64::from(x % 7), f64::from(y), f64::from(x * y % 5)) / 9.0;
        (white(x, y), [c, c], 0.0)
    });
    let off = |(a, b): (&Rgb, &Rgb)| (*a - *b).abs().max_element();
    let most = filtered(&film, None).iter().zip(&film.pixels).map(off).fold(0.0, f64::max);
    assert!(most < 1e-12, "{most}");
}

#[test]
fn a_flat_white_wall_stays_white_and_loses_no_light() {
    let film = noisy(|_, _| 1.0, white);
    let pixels = filtered(&film, None);
    let mean = pixels.iter().copied().sum::<Rgb>() / pixels.len() as f64;
    assert!((mean - film.mean()).abs().max_element() < 2e-3, "{mean} of {}", film.mean());
    let (before, after) = (mse(&film.pixels, |_, _| 1.0), mse(&pixels, |_, _| 1.0));
    assert!(after < before / 25.0, "{before} to {after}");
}

#[test]
fn steps_of_light_and_of_things_stay_where_they_are() {
    let step = |x: u32, _| if x < 20 { 0.3 } else { 1.5 };
    let shadow = noisy(step, white);
    let corner = noisy(
        |x, _| if x < 20 { 0.95 } else { 1.05 },
        |x, y| {
            let normal = if x < 20 { DVec3::Z } else { DVec3::X };
            Features { normal, ..white(x, y) }
        },
    );
    let column = |film: &Film, x: usize| {
        let pixels = filtered(film, None);
        (0..36).map(|y| pixels[y * 40 + x].x).sum::<f64>() / 36.0
    };
    for (film, [low, high]) in [(&shadow, [0.3, 1.5]), (&corner, [0.95, 1.05])] {
        let (left, right) = (column(film, 19), column(film, 20));
        assert!((left - low).abs() < 0.03 && (right - high).abs() < 0.03, "{left} beside {right}");
    }
}

#[test]
fn textures_are_kept_by_their_albedo() {
    let albedo = |x: u32, y: u32| if (x / 2 + y / 2).is_multiple_of(2) { 0.8 } else { 0.3 };
    let film = noisy(albedo, |x, y| Features { albedo: Rgb::splat(albedo(x, y)), ..white(x, y) });
    let (before, after) = (mse(&film.pixels, albedo), mse(&filtered(&film, None), albedo));
    assert!(after < before / 10.0, "{before} to {after}");
}

#[test]
fn threads_change_no_bit() {
    let film = noisy(|x, y| f64::from(x * y) / 400.0, white);
    assert!([Some(1), Some(2), Some(5)].iter().all(|n| filtered(&film, *n) == filtered(&film, None)));
}

#[test]
fn what_has_no_value_stays_magenta_and_tells_others_nothing() {
    let mut film = noisy(|_, _| 1.0, white);
    film.pixels[20 * 40 + 20] = Film::UNDEFINED;
    let pixels = filtered(&film, None);
    assert_eq!(pixels[20 * 40 + 20], Film::UNDEFINED);
    assert!((pixels[20 * 40 + 21] - Rgb::ONE).abs().max_element() < 0.1);
}

#[test]
fn who_cancels_gets_nothing() {
    let film = noisy(|_, _| 1.0, white);
    assert_eq!(denoised(&film, None, &(), &AtomicBool::new(true)), None);
}
