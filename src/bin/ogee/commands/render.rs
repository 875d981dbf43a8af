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
use ogee::diag::Diagnostic;
use ogee::render::film::Film;
use ogee::render::output::Format;
use ogee::scene::RenderSettings;
use ogee::session::Evaluated;
use ogee::session::animation::{Animation, Asked};
use ogee::session::picture::{self, Job, Prepared};
use std::sync::{Arc, Mutex};
use std::time::Instant;
use target::{Form, Saving, Target};

/// Renders to the file that is asked for. Whatever can be known to fail is said before the work begins.
pub fn run(args: &Render) -> Ended {
    refuse_unbuilt(args)?;
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
    let film = seconds.render.measure(|| render(&prepared, &bar, move |film| rescue(&for_rescue, film)));
    bar.end();
    let faults = picture::faults(&film);
    show(&faults, animation.sources());
    seconds.write.measure(|| saving.save(&film))?;
    tell(stats::line(&saving.shown(), &film, &prepared.settings, &seconds));
    if args.stats.is_some() {
        data(stats::json(&args.file, &saving.shown(), None, &film, &prepared, &seconds))?;
    }
    Ok(match film.is_complete() {
        false => Exit::Interrupted,
        true if !faults.is_empty() => Exit::Scene,
        true => Exit::Done,
    })
}

/// Saves a picture whose rendering does not come to an end.
fn rescue(saving: &Saving, film: &Film) {
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
        samples: args.samples,
        depth: args.depth,
        seed: args.seed,
        sampler: args.sampler.map(Into::into),
        accelerator: args.accelerator.map(Into::into),
        exposure: args.exposure,
        ..RenderSettings::default()
    };
    Job { overrides, camera: args.camera.clone(), crop: args.crop, threads: args.threads }
}

/// Renders; `rescue` is what is done with the picture so far where a ray does not come back.
fn render(prepared: &Prepared, bar: &Bar, rescue: impl FnOnce(&Film) + Send + 'static) -> Film {
    let film = Arc::new(Mutex::new(prepared.bare_film()));
    let rescue = {
        let film = Arc::clone(&film);
        move || rescue(&film.lock().unwrap_or_else(|poisoned| poisoned.into_inner()))
    };
    interrupt::while_rendering(rescue, || prepared.render_onto(&film, bar, &interrupt::CANCEL));
    let film = Arc::into_inner(film).expect("who would have saved it is gone");
    film.into_inner().unwrap_or_else(|poisoned| poisoned.into_inner())
}

fn refuse_unbuilt(args: &Render) -> Result<(), Failure> {
    let asked = [
        ("--layers", args.layers.is_some()),
        ("--budget", args.budget.is_some()),
        ("--error", args.error.is_some()),
        ("--denoise", args.denoise),
    ];
    match asked.iter().find(|(_, given)| *given) {
        Some((flag, _)) => Err(Failure::not_built(&format!("`{flag}`"))),
        None => Ok(()),
    }
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
