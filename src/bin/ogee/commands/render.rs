//! `ogee render`: a scene to a picture, or to the frames of an animation.

mod bar;
mod frames;
mod name;
mod target;

use super::stats::{self, Seconds};
use crate::args::Render;
use crate::interrupt;
use crate::speech::{Ended, Exit, Failure, data, show, tell, tell_failure};
use bar::Bar;
use ogee::diag::{Diagnostic, has_errors};
use ogee::render::film::Film;
use ogee::render::output::Format;
use ogee::render::passes::{self, Passes};
use ogee::render::settings::ResolvedSettings;
use ogee::render::tiles::Picture;
use ogee::render::{Tracer, adaptive};
use ogee::scene::{RenderSettings, SamplerKind, TracerKind};
use ogee::session::Evaluated;
use ogee::session::animation::{Animation, Asked};
use ogee::session::picture::{self, Job, Prepared};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};
use std::time::Instant;
use target::{Form, Saving, Target};

/// Renders to the file that is asked for. Whatever can be known to fail is said before the work begins.
pub fn run(args: &Render) -> Ended {
    super::try_to_read(&args.file)?;
    let target = Target::new(args)?;
    interrupt::listen();
    let mut session = super::session(&args.evaluation);
    session.animate(&args.file, asked(args), Some(&interrupt::CANCEL), |animation| {
        let mut seconds = Seconds::default();
        if seconds.evaluate.measure(|| animation.failed()) {
            let first = animation.frame(0);
            first.printed.iter().for_each(tell);
            show(&first.diagnostics, animation.sources());
            return Ok(Exit::Scene);
        }
        let frames = animation.frames().map_err(Failure::usage)?;
        let target = target.for_frames(args, &frames)?;
        match target.form {
            Form::Still(format) if !target.name.is_numbered() => {
                still(args, &target, format, animation, frames.start, seconds)
            }
            Form::Still(_) | Form::Movie(_) => frames::run(args, &target, animation, frames, seconds),
        }
    })
}

fn asked(args: &Render) -> Asked {
    match (&args.frames, args.evaluation.time) {
        (Some(frames), _) => Asked::Frames(frames.clone()),
        (None, Some(_)) => Asked::Still,
        (None, None) => Asked::Whole,
    }
}

/// Renders one picture.
fn still(
    args: &Render,
    target: &Target,
    format: Format,
    animation: &mut Animation<'_>,
    frame: u32,
    mut seconds: Seconds,
) -> Ended {
    let evaluated = seconds.evaluate.measure(|| animation.frame(frame));
    evaluated.printed.iter().for_each(tell);
    let (prepared, diagnostics) = prepare(args, target, animation, evaluated, &mut seconds)?;
    show(&diagnostics, animation.sources());
    let Some(prepared) = prepared else { return Ok(Exit::Scene) };
    let path = target.name.given().to_owned();
    let saving = Arc::new(Saving::at(path, format, &prepared.settings, animation.sources())?);
    let (bar, for_rescue) = (Bar::over(1), Arc::clone(&saving));
    let film =
        seconds.render.measure(|| render(args, &prepared, &bar, move |film| rescue(&for_rescue, film)));
    bar.end();
    let Some(film) = film else {
        tell(not_begun(&saving));
        return Ok(Exit::Interrupted);
    };
    let faults = picture::faults(&film);
    show(&faults, animation.sources());
    seconds.write.measure(|| saving.save(&film))?;
    tell(stats::line(&saving.shown(), &film, &prepared.settings, &seconds));
    if args.stats.is_some() {
        data(stats::json(&args.file, &saving.shown(), None, &film, &prepared, &seconds))?;
    }
    Ok(match is_made(&film, &prepared.settings) {
        false => Exit::Interrupted,
        true if has_errors(&faults) => Exit::Scene,
        true => Exit::Done,
    })
}

/// True where all of a picture is made that was asked for.
fn is_made(film: &Film, settings: &ResolvedSettings) -> bool {
    film.is_complete() && film.denoised == settings.denoise
}

/// What is said of a picture of which there is nothing to save.
fn not_begun(saving: &Saving) -> String {
    format!("{}  not written: interrupted before its first pixel", saving.shown())
}

/// Saves a picture whose rendering does not come to an end, if it has begun.
fn rescue(saving: &Saving, film: Option<&Film>) {
    let Some(film) = film else { return tell(not_begun(saving)) };
    match saving.save(film) {
        Ok(()) => tell(format!("{}  as far as it was: a ray does not come back", saving.shown())),
        Err(failure) => tell_failure(&failure),
    }
}

/// Builds the world of a scene, where it has no errors yet; none where there is one. With all that is wrong with it.
fn prepare(
    args: &Render,
    target: &Target,
    animation: &mut Animation<'_>,
    evaluated: Evaluated,
    seconds: &mut Seconds,
) -> Result<(Option<Prepared>, Vec<Diagnostic>), Failure> {
    if evaluated.has_errors() {
        return Ok((None, evaluated.diagnostics));
    }
    let job = job(args);
    let settings = picture::settings(&evaluated.scene, &job).map_err(Failure::usage)?;
    refuse_passes(args, &settings)?;
    refuse_denoise(args, &settings)?;
    target.refuse_too_large(&settings, animation.options().limits.memory)?;
    let mut diagnostics = evaluated.diagnostics;
    let (prepared, found) = seconds.world.measure(|| animation.prepare(evaluated.scene, &job, settings));
    diagnostics.extend(found);
    Ok((prepared, diagnostics))
}

fn job(args: &Render) -> Job {
    let overrides = RenderSettings {
        size: args.size,
        tracer: args.tracer.map(Into::into),
        samples: args.samples.or(most_samples(args)),
        depth: args.depth,
        seed: args.seed,
        sampler: args.sampler.map(Into::into),
        filter: args.filter.map(Into::into),
        clamp: args.clamp,
        accelerator: args.accelerator.map(Into::into),
        exposure: args.exposure,
        ..RenderSettings::default()
    };
    Job {
        overrides,
        camera: args.camera.clone(),
        crop: args.crop,
        error: args.error,
        layers: args.layers.iter().map(|layer| (*layer).into()).collect(),
        denoise: args.denoise,
        threads: args.threads,
    }
}

/// Samples a pixel where it is not said how many, and time or an error decides.
fn most_samples(args: &Render) -> Option<u32> {
    args.error.map(|_| adaptive::MOST).or(args.budget.map(|_| u32::MAX))
}

/// Renders; `rescue` is what is done with the picture so far where a ray does not come back. There is none before all is made that
/// the tracer makes beforehand.
fn render(
    args: &Render,
    prepared: &Prepared,
    bar: &Bar,
    rescue: impl FnOnce(Option<&Film>) + Send + 'static,
) -> Option<Film> {
    let film = Arc::new(OnceLock::<Mutex<Film>>::new());
    let rescue = {
        let film = Arc::clone(&film);
        move || rescue(film.get().map(|film| film.lock().unwrap_or_else(PoisonError::into_inner)).as_deref())
    };
    interrupt::while_rendering(rescue, || {
        let mut tracer = prepared.tracer(bar, &interrupt::CANCEL)?;
        let film = film.get_or_init(|| Mutex::new(prepared.bare_film()));
        expose(args, prepared, &mut *tracer, film, bar);
        Some(())
    });
    let film = Arc::into_inner(film).expect("who would have saved it is gone").into_inner()?;
    Some(film.into_inner().unwrap_or_else(PoisonError::into_inner))
}

/// Renders onto a bare film, in passes where there is a budget.
fn expose(args: &Render, prepared: &Prepared, tracer: &mut dyn Tracer, film: &Mutex<Film>, bar: &Bar) {
    match args.budget.and_then(|seconds| Some((seconds, prepared.passes()?))) {
        Some((seconds, passes)) => {
            within(seconds, passes, prepared.picture(tracer), film, bar);
            prepared.filter(film, bar, &interrupt::CANCEL);
        }
        None => prepared.render_onto(film, tracer, bar, &interrupt::CANCEL),
    }
}

/// Takes samples for so many seconds, at most those of the settings. The first pass is made in any case; a pass that is interrupted leaves the one before.
fn within(budget: f64, mut passes: Passes<'_>, picture: Picture<'_>, film: &Mutex<Film>, bar: &Bar) {
    let start = Instant::now();
    let mut to = Some(passes::FIRST);
    while let Some(n) = to {
        let is_whole = passes.advance(picture, n, bar, &interrupt::CANCEL);
        if is_whole || n == passes::FIRST {
            *film.lock().unwrap_or_else(PoisonError::into_inner) = passes.film();
        }
        let used = start.elapsed().as_secs_f64();
        to = passes::next(n, used, budget - used, picture.settings.samples).filter(|_| is_whole);
    }
}

/// What a budget cannot be kept with.
fn refuse_passes(args: &Render, settings: &ResolvedSettings) -> Result<(), Failure> {
    let fault = match (settings.tracer, settings.sampler) {
        _ if args.budget.is_none() => return Ok(()),
        (TracerKind::Photon | TracerKind::Irradiance, _) => {
            "`--budget` goes on with more samples, and this tracer prepares for a number of them; try `--tracer path`"
        }
        (_, SamplerKind::Stratified) => {
            "`--budget` goes on with more samples, and `stratified` needs their number; try `--sampler sobol`"
        }
        _ if settings.samples < passes::FIRST => {
            "`--budget` begins with 2 samples a pixel, and `--samples 1` are the most"
        }
        _ => return Ok(()),
    };
    Err(Failure::usage(fault))
}

/// What the filter of noise cannot be used with.
fn refuse_denoise(args: &Render, settings: &ResolvedSettings) -> Result<(), Failure> {
    let fault = match (args.denoise, args.crop) {
        (false, _) => return Ok(()),
        (true, Some(_)) => {
            "`--denoise` goes by the pixels around each, which `--crop` leaves out: render the whole picture"
        }
        (true, None) if settings.samples < 2 => {
            "`--denoise` finds the noise of a pixel by its samples, and one tells nothing: write `--samples 2` or more"
        }
        (true, None) => return Ok(()),
    };
    Err(Failure::usage(fault))
}

/// Time that a part of the work took.
#[derive(Clone, Copy, Debug, Default)]
pub struct Stopwatch(pub f64);

impl Stopwatch {
    /// Does the work and adds its time.
    fn measure<T>(&mut self, work: impl FnOnce() -> T) -> T {
        let start = Instant::now();
        let result = work();
        self.0 += start.elapsed().as_secs_f64();
        result
    }
}
