//! `--denoise`: what is taken out of pictures of small scenes, and what the command line says of it.

use crate::run::Folder;
use crate::stage::{camera, picture, settings, white_box};
use glam::DVec3;
use ogee::render::denoise::denoised;
use ogee::render::film::Film;
use ogee::render::settings::ResolvedSettings;
use ogee::scene::{Rgb, TracerKind};
use std::sync::atomic::AtomicBool;

/// A film that keeps guides, and the same without its noise.
fn both(film: Film) -> (Film, Film) {
    let pixels = denoised(&film, None, &(), &AtomicBool::new(false)).expect("nobody cancels");
    (film.clone(), Film { pixels, ..film })
}

fn mse(film: &Film, truth: &Film) -> f64 {
    let off = film.pixels.iter().zip(&truth.pixels).map(|(a, b)| (*a - *b).length_squared());
    off.sum::<f64>() / film.pixels.len() as f64
}

#[test]
fn a_noisy_box_comes_near_one_of_many_samples_and_keeps_its_light() {
    let world = white_box(0.5);
    let eye = camera(DVec3::new(0.5, 0.5, 0.98), DVec3::new(0.5, 0.4, 0.0), 60.0);
    let base = ResolvedSettings { tracer: TracerKind::Path, denoise: true, ..settings([48, 48]) };
    let truth = picture(&world, &eye, &ResolvedSettings { samples: 1024, seed: 9, ..base });
    let (noisy, clean) = both(picture(&world, &eye, &ResolvedSettings { samples: 16, ..base }));
    let (before, after) = (mse(&noisy, &truth), mse(&clean, &truth));
    assert!(after < before / 4.0, "{before} to {after}");
    let off = (clean.mean() / noisy.mean() - Rgb::ONE).abs().max_element();
    assert!(off < 0.005, "{off}");
}

const QUIET: &str = "camera { eye <0, 2, 6>  look_at <0, 0.7, 0>  fov 40 }\nlight { sun <1, -2, -1>  irradiance 2 }\n\
    plane { normal y  material { diffuse checker(0.8, 0.3) } }\nsphere { center <0, 1, 0>  material { diffuse 0.5  reflect 0.3 } }\n\
    box { min <1.2, 0, 0>  max <2, 1.4, 1>  material { diffuse <0.8, 0.3, 0.2> } }\n";

/// How far two pictures are from one another, by `ogee compare`.
fn compared(folder: &Folder, a: &str, b: &str) -> serde_json::Value {
    let run = folder.ogee(&format!("compare {a} {b} --format json"));
    serde_json::from_str(run.out()).unwrap()
}

#[test]
fn a_picture_without_noise_stays_but_for_its_outlines() {
    let folder = Folder::with(&[("quiet.scene", QUIET)]);
    folder.ogee("render quiet.scene --size 96x72 --samples 16 -o a.exr").expect(0);
    let run = folder.ogee("render quiet.scene --size 96x72 --samples 16 -o b.exr --denoise").expect(0);
    assert!(run.stderr.contains("denoised"), "{}", run.stderr);
    let result = compared(&folder, "b.exr", "a.exr");
    assert!(result["rmse"].as_f64().unwrap() < 0.01, "{result}");
    assert!(result["ssim"].as_f64().unwrap() > 0.995, "{result}");
    let comment = |name: &str| String::from_utf8_lossy(&folder.read(name)).contains(r#""denoise":true"#);
    assert!(comment("b.exr") && !comment("a.exr"));
}

#[test]
fn what_cannot_be_denoised_is_told_before_the_work_begins() {
    let folder = Folder::with(&[("quiet.scene", QUIET)]);
    for (line, said) in [("--samples 1", "--samples 2"), ("--crop 0,0,9,9", "the whole picture")] {
        let run = folder.ogee(&format!("render quiet.scene --denoise {line}")).expect(2);
        assert!(run.stderr.contains(said), "{line}: {}", run.stderr);
    }
    assert_eq!(folder.names(), ["quiet.scene"]);
}

#[test]
fn frames_passes_and_layers_are_filtered_and_layers_stay() {
    let folder = Folder::with(&[("quiet.scene", QUIET)]);
    let small = "render quiet.scene --size 32x24 --denoise";
    folder.ogee(&format!("{small} --frames 0..2 -o f{{frame}}.png")).expect(0);
    folder.ogee(&format!("{small} --budget 1h --samples 8 -o a.exr")).expect(0);
    folder.ogee(&format!("{small} --samples 8 --threads 1 -o b.exr")).expect(0);
    assert!(folder.read("a.exr") == folder.read("b.exr"));
    folder.ogee(&format!("{small} --samples 8 --layers albedo -o c.exr")).expect(0);
    assert_eq!(compared(&folder, "c.exr", "b.exr")["largest"], 0.0);
    assert_eq!(folder.names(), ["a.exr", "b.exr", "c.exr", "f0.png", "f1.png", "quiet.scene"]);
}
