//! `ogee bench tracers`: tracers against one another on scenes.

use super::{machine, make_results, write};
use crate::args::Tracers;
use crate::commands;
use crate::interrupt;
use crate::speech::{Ended, Exit, Failure, reason, show, tell};
use ogee::render::compare::Picture;
use ogee::render::film::Film;
use ogee::render::settings::ResolvedSettings;
use ogee::report::store;
use ogee::report::tracers::{Ask, Made, Plan, Reference, TracerRow, Variant, measure, page};
use ogee::scene::{RenderSettings, Rgb, SamplerKind, TracerKind};
use ogee::session::animation::Asked;
use ogee::session::picture::{self, Job, Prepared};
use std::path::Path;
use std::time::Instant;

/// The longer side of a picture where no size is asked for, pixels.
const LONGER_SIDE: u32 = 128;
/// The reference has so many times the samples of the best picture where nothing is said.
const REFERENCE: u32 = 64;
/// Seeds of the two halves of the reference; pictures count theirs from 0.
const REFERENCE_SEEDS: [u64; 2] = [1 << 40, (1 << 40) + 1];

/// Measures all scenes, then writes results, page and plots.
pub fn run(args: &Tracers) -> Ended {
    if args.reference.is_some() && args.scenes.len() > 1 {
        return Err(Failure::usage(
            "one `--reference` is of one scene\nmeasure the scenes one by one, or leave it out",
        ));
    }
    make_results(&args.out)?;
    interrupt::listen();
    let machine = machine(super::TRACERS);
    let mut rows = Vec::new();
    for scene in &args.scenes {
        match of_scene(args, scene)? {
            Ok(more) => rows.extend(more),
            Err(exit) => return Ok(exit),
        }
    }
    write(&args.out, &store::write(&machine, &rows, |row| &row.scene))?;
    write(&args.out, &page::render(&machine, &rows))?;
    tell(format!("wrote {}", args.out.join("index.md").display()));
    Ok(Exit::Done)
}

/// The rows of one scene, or how it ended.
fn of_scene(args: &Tracers, path: &Path) -> Result<Result<Vec<TracerRow>, Exit>, Failure> {
    commands::try_to_read(path)?;
    let mut session = commands::session(&args.evaluation);
    session.animate(path, Asked::Still, Some(&interrupt::CANCEL), |animation| {
        let evaluated = animation.frame(0);
        let job = job(args, evaluated.scene.render.size);
        let settings = picture::settings(&evaluated.scene, &job).map_err(Failure::usage)?;
        let (has_errors, written) = (evaluated.has_errors(), evaluated.scene.render.clone());
        let mut found = evaluated.diagnostics;
        let mut prepared = None;
        if !has_errors {
            let (ready, more) = animation.prepare(evaluated.scene, &job, settings);
            found.extend(more);
            prepared = ready;
        }
        show(&found, animation.sources());
        let Some(prepared) = prepared else { return Ok(Err(Exit::Scene)) };
        match measured(args, path, Bench { prepared, written, overrides: job.overrides })? {
            Some(rows) => Ok(Ok(rows)),
            None => Ok(Err(Exit::Interrupted)),
        }
    })
}

fn job(args: &Tracers, written: Option<[u32; 2]>) -> Job {
    let size = args.size.unwrap_or_else(|| small(written.unwrap_or(ResolvedSettings::SIZE)));
    let overrides = RenderSettings { size: Some(size), depth: args.depth, ..RenderSettings::default() };
    Job { overrides, camera: args.camera.clone(), threads: Some(args.threads.unwrap_or(1)), ..Job::default() }
}

/// A size of the same shape with no side longer than [`LONGER_SIDE`].
fn small(size: [u32; 2]) -> [u32; 2] {
    let longer = size[0].max(size[1]);
    if longer <= LONGER_SIDE {
        return size;
    }
    let scaled = |n: u32| (f64::from(n) * f64::from(LONGER_SIDE) / f64::from(longer)).round() as u32;
    size.map(|n| scaled(n).max(1))
}

/// The rows of a scene that is ready; none where the user interrupts.
fn measured(args: &Tracers, path: &Path, mut bench: Bench) -> Result<Option<Vec<TracerRow>>, Failure> {
    let name = path.file_stem().map_or_else(|| "scene".into(), |stem| stem.to_string_lossy().into_owned());
    let plan = Plan { variants: args.variants.clone(), samples: rising(&args.samples), seeds: args.seeds };
    let best = *plan.samples.last().expect("the command line asks for one number at least");
    let reference = match &args.reference {
        Some(file) => read(file, bench.settings())?,
        None => {
            let samples = args.reference_samples.unwrap_or(best.saturating_mul(REFERENCE)).max(2);
            tell(format!("{name}: the reference, {samples} samples"));
            match bench.reference(samples) {
                Ok(reference) => reference,
                Err(Interrupted) => return Ok(None),
            }
        }
    };
    let hear = |samples| tell(format!("{name}: {samples} samples"));
    let Ok(mut rows) = measure(&plan, &reference, hear, |ask| bench.render(ask)) else { return Ok(None) };
    let size = bench.settings().size;
    rows.iter_mut().for_each(|row| (row.scene, row.size) = (name.clone(), size));
    Ok(Some(rows))
}

fn rising(samples: &[u32]) -> Vec<u32> {
    let mut rising = samples.to_vec();
    rising.sort_unstable();
    rising.dedup();
    rising
}

/// A picture as the reference.
fn read(file: &Path, settings: &ResolvedSettings) -> Result<Reference, Failure> {
    let fault = |why: String| Failure { exit: Exit::Scene, message: format!("{}: {why}", file.display()) };
    let bytes = std::fs::read(file)
        .map_err(|error| Failure::machine(format!("cannot read {}", file.display()), reason(&error)))?;
    let picture = Picture::decode(&bytes).map_err(|error| fault(error.to_string()))?;
    if picture.size != settings.size {
        let ([w, h], [x, y]) = (picture.size, settings.size);
        return Err(fault(format!(
            "it has {w} × {h} pixels and the pictures {x} × {y}\nsay `--size {w}x{h}`"
        )));
    }
    let pixels = picture.pixels.iter().map(|rgb| Rgb::from_array(rgb.map(f64::from)));
    Ok(Reference { pixels: pixels.collect(), floor: 0.0, source: format!("`{}`", file.display()) })
}

/// The user pressed Ctrl-C.
struct Interrupted;

/// A scene that is rendered again and again.
struct Bench {
    prepared: Prepared,
    /// What the scene says of its picture, and what comes before that.
    written: RenderSettings,
    overrides: RenderSettings,
}

impl Bench {
    fn settings(&self) -> &ResolvedSettings {
        &self.prepared.settings
    }

    /// Renders once; its time is that of the tracer, with what it makes beforehand.
    fn render(&mut self, ask: &Ask) -> Result<Made, Interrupted> {
        let (film, seconds) = self.film(ask, self.settings().threads)?;
        Ok(Made { pixels: film.pixels, seconds, rays: film.report.rays.total() })
    }

    fn film(&mut self, ask: &Ask, threads: Option<usize>) -> Result<(Film, f64), Interrupted> {
        let asked = RenderSettings {
            tracer: Some(ask.variant.tracer),
            samples: Some(ask.samples),
            seed: Some(ask.seed),
            sampler: Some(ask.variant.sampler),
            ..self.overrides.clone()
        };
        let settings = ResolvedSettings { threads, ..ResolvedSettings::new(&self.written, &asked) };
        let before = std::mem::replace(&mut self.prepared.settings, settings);
        let started = Instant::now();
        let film = self.prepared.render(&(), &interrupt::CANCEL);
        let seconds = started.elapsed().as_secs_f64();
        self.prepared.settings = before;
        if film.is_complete() { Ok((film, seconds)) } else { Err(Interrupted) }
    }

    /// The mean of two pictures of half the samples, whose difference tells its noise.
    fn reference(&mut self, samples: u32) -> Result<Reference, Interrupted> {
        let variant = Variant { tracer: TracerKind::Path, sampler: SamplerKind::Sobol };
        let mut half = |seed| self.film(&Ask { variant, samples: samples / 2, seed }, None);
        let [a, b] = REFERENCE_SEEDS.map(&mut half);
        let (a, b) = (a?.0, b?.0);
        let halves = || a.pixels.iter().zip(&b.pixels);
        let square: f64 = halves().map(|(a, b)| ((*a - *b) * (*a - *b)).element_sum()).sum();
        let floor = (square / (3.0 * a.pixels.len() as f64)).sqrt() / 2.0;
        let pixels = halves().map(|(a, b)| (*a + *b) / 2.0).collect();
        Ok(Reference { pixels, floor, source: format!("`path` of {samples} samples, in two halves") })
    }
}
