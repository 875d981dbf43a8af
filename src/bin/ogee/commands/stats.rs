//! What is told of a picture that was made: a line for a person, an object for a program.

use super::render::Stopwatch;
use ogee::render::film::{Clamped, Film, Taken};
use ogee::render::settings::ResolvedSettings;
use ogee::session::picture::Prepared;
use std::path::Path;

/// How long each part took.
#[derive(Clone, Copy, Debug, Default)]
pub struct Seconds {
    /// Reading, parsing and evaluating the scene.
    pub evaluate: Stopwatch,
    /// Files, shapes, trees.
    pub world: Stopwatch,
    /// Rays.
    pub render: Stopwatch,
    /// Encoding and writing.
    pub write: Stopwatch,
}

impl Seconds {
    fn total(&self) -> f64 {
        self.evaluate.0 + self.world.0 + self.render.0 + self.write.0
    }

    /// Adds those of another picture.
    pub fn add(&mut self, other: &Seconds) {
        self.evaluate.0 += other.evaluate.0;
        self.world.0 += other.world.0;
        self.render.0 += other.render.0;
        self.write.0 += other.write.0;
    }
}

/// "first.png  640×480  0.41 s  4 samples a pixel  3.1 M rays".
pub fn line(name: &str, film: &Film, settings: &ResolvedSettings, seconds: &Seconds) -> String {
    let name = if name == "-" { "picture" } else { name };
    let part = match film.is_complete() {
        true => String::new(),
        false => format!("  ({:.0} % done when interrupted)", 100.0 * film.share_finished()),
    };
    let part = match (film.denoised, settings.denoise) {
        (true, _) => part + "  denoised",
        (false, true) if film.is_complete() => part + "  (interrupted before it was denoised)",
        (false, _) => part,
    };
    format!("{name}  {}{part}", made(settings, film.report.taken, film.report.rays.total(), seconds))
}

/// "640×480  0.41 s  4 samples a pixel  3.1 M rays".
pub fn made(settings: &ResolvedSettings, taken: Taken, rays: u64, seconds: &Seconds) -> String {
    let [w, h] = [settings.crop.width, settings.crop.height];
    let samples = samples(settings, taken);
    let clamped = clamped(settings, taken.clamped);
    format!("{w}×{h}  {}  {samples}  {} rays{clamped}", duration(seconds.total()), count(rays))
}

/// What `--clamp` took, where it was asked for.
fn clamped(settings: &ResolvedSettings, clamped: Clamped) -> String {
    let Some(most) = settings.clamp else { return String::new() };
    let samples = match clamped.samples {
        0 => return format!("  no sample above {most}"),
        1 => "1 sample".to_owned(),
        n => format!("{} samples", count(n)),
    };
    format!("  {samples} dimmed to {most}, {:.2} % of the light", 100.0 * clamped.share())
}

/// "4 samples a pixel"; where an error decided, "32 to 512 samples a pixel, 87.5 on average (0.3 % of the pixels want more)".
fn samples(settings: &ResolvedSettings, taken: Taken) -> String {
    if settings.error.is_some() && taken.pixels > 0 {
        let short = match taken.pixels - taken.enough {
            0 => String::new(),
            n => format!(" ({:.2} % of the pixels want more)", 100.0 * n as f64 / taken.pixels as f64),
        };
        let (least, most, mean) = (taken.least, taken.most, taken.mean());
        return format!("{least} to {most} samples a pixel, {mean:.1} on average{short}");
    }
    let n = if taken.pixels == 0 { settings.samples } else { taken.most };
    if n == 1 { "1 sample a pixel".to_owned() } else { format!("{n} samples a pixel") }
}

/// "950", "3.1 k", "12 M".
fn count(n: u64) -> String {
    let scaled = |unit: f64, word: &str| {
        let x = n as f64 / unit;
        if x < 10.0 { format!("{x:.1} {word}") } else { format!("{x:.0} {word}") }
    };
    match n {
        0..1_000 => n.to_string(),
        1_000..1_000_000 => scaled(1e3, "k"),
        1_000_000..1_000_000_000 => scaled(1e6, "M"),
        _ => scaled(1e9, "G"),
    }
}

/// "12 ms", "0.41 s", "3 min 12 s".
fn duration(seconds: f64) -> String {
    match seconds {
        s if s < 0.1 => format!("{:.0} ms", 1e3 * s),
        s if s < 10.0 => format!("{s:.2} s"),
        s if s < 120.0 => format!("{s:.0} s"),
        s => format!("{:.0} min {:.0} s", (s / 60.0).floor(), s % 60.0),
    }
}

/// One object, of a picture or of a frame by its number; its keys are described in `docs/command.md`.
pub fn json(
    scene: &Path,
    output: &str,
    frame: Option<u32>,
    film: &Film,
    prepared: &Prepared,
    seconds: &Seconds,
) -> String {
    let settings = &prepared.settings;
    let (rays, taken) = (film.report.rays, film.report.taken);
    let object = serde_json::json!({
        "schema": 1,
        "scene": scene.display().to_string(),
        "output": output,
        "frame": frame,
        "size": settings.size,
        "crop": [settings.crop.x, settings.crop.y, settings.crop.width, settings.crop.height],
        "tracer": settings.tracer.word(),
        "accelerator": settings.accelerator.word(),
        "samples": if settings.error.is_none() && taken.pixels > 0 { taken.most } else { settings.samples },
        "samples_taken": { "least": taken.least, "mean": taken.mean(), "most": taken.most },
        "error": settings.error,
        "pixels_short": if settings.error.is_some() { taken.pixels - taken.enough } else { 0 },
        "depth": settings.depth,
        "seed": settings.seed,
        "sampler": settings.sampler.word(),
        "filter": settings.filter.word(),
        "clamp": settings.clamp,
        "clamped": { "samples": taken.clamped.samples, "share": taken.clamped.share() },
        "finished": film.share_finished(),
        "denoised": film.denoised,
        "seconds": {
            "evaluate": seconds.evaluate.0,
            "world": seconds.world.0,
            "render": seconds.render.0,
            "write": seconds.write.0,
            "total": seconds.total(),
        },
        "rays": {
            "camera": rays.camera,
            "shadow": rays.shadow,
            "reflected": rays.reflected,
            "refracted": rays.refracted,
            "scattered": rays.scattered,
            "total": rays.total(),
        },
        "vectors": if ogee::session::has_avx2() { "avx2" } else { "baseline" },
        "world": prepared.world.stats(),
        "samples_left_out": film.report.non_finite,
    });
    format!("{object}\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_and_times_are_short() {
        assert_eq!([count(950), count(3_140), count(12_345_678)], ["950", "3.1 k", "12 M"]);
        assert_eq!([duration(0.012), duration(0.41), duration(192.0)], ["12 ms", "0.41 s", "3 min 12 s"]);
    }
}
