//! `ogee render`: a scene to a picture.

use super::stats::{self, Seconds};
use crate::args::Render;
use crate::interrupt;
use crate::place::Place;
use crate::speech::{Ended, Exit, Failure, data, show, tell, tell_failure};
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use ogee::diag::SourceMap;
use ogee::render::film::Film;
use ogee::render::output::{self, Development, Format, Metadata};
use ogee::render::settings::ResolvedSettings;
use ogee::render::tiles::Progress;
use ogee::scene::RenderSettings;
use ogee::session::Session;
use ogee::session::inspect::tracer_word;
use ogee::session::picture::{self, Job, Prepared};
use std::io::IsTerminal;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex};
use std::time::Instant;

/// Renders to the file that is asked for. Whatever can be known to fail is said before the work begins.
pub fn run(args: &Render) -> Ended {
    refuse_unbuilt(args)?;
    let target = Target::new(args)?;
    interrupt::listen();
    let mut session = super::session(&args.evaluation);
    let mut seconds = Seconds::default();
    let Some(prepared) = prepare(args, &target, &mut session, &mut seconds)? else { return Ok(Exit::Scene) };
    let saving = Arc::new(Saving::new(target, &prepared.settings, &session.sources));
    let film = seconds.render.measure(|| render(&prepared, &saving));
    let faults = picture::faults(&film);
    show(&faults, &session.sources);
    seconds.write.measure(|| saving.save(&film))?;
    let target = &saving.target;
    tell(stats::line(&target.shown(), &film, &prepared.settings, &seconds));
    if args.stats.is_some() {
        data(stats::json(&args.file, &target.shown(), &film, &prepared, &seconds))?;
    }
    Ok(match film.is_complete() {
        false => Exit::Interrupted,
        true if !faults.is_empty() => Exit::Scene,
        true => Exit::Done,
    })
}

/// Evaluates the scene and builds its world; none where an error was said.
fn prepare(
    args: &Render,
    target: &Target,
    session: &mut Session,
    seconds: &mut Seconds,
) -> Result<Option<Prepared>, Failure> {
    let evaluated = seconds.evaluate.measure(|| super::evaluate(session, &args.file))?;
    if evaluated.has_errors() {
        show(&evaluated.diagnostics, &session.sources);
        return Ok(None);
    }
    let job = job(args);
    let settings = picture::settings(&evaluated.scene, &job).map_err(Failure::usage)?;
    target.refuse_too_large(&settings, session.options.limits.memory)?;
    let loader = session.loader().clone();
    let mut diagnostics = evaluated.diagnostics;
    let (prepared, found) =
        seconds.world.measure(|| picture::prepare(evaluated.scene, &job, settings, &*loader));
    diagnostics.extend(found);
    show(&diagnostics, &session.sources);
    Ok(prepared)
}

fn job(args: &Render) -> Job {
    let overrides = RenderSettings {
        size: args.size,
        tracer: args.tracer.map(Into::into),
        samples: args.samples,
        depth: args.depth,
        seed: args.seed,
        accelerator: args.accelerator.map(Into::into),
        exposure: args.exposure,
        ..RenderSettings::default()
    };
    Job { overrides, camera: args.camera.clone(), crop: args.crop, threads: args.threads }
}

fn render(prepared: &Prepared, saving: &Arc<Saving>) -> Film {
    let bar = Bar::new();
    let film = Arc::new(Mutex::new(prepared.bare_film()));
    let rescue = {
        let (film, saving) = (Arc::clone(&film), Arc::clone(saving));
        move || saving.rescue(&film.lock().unwrap_or_else(|poisoned| poisoned.into_inner()))
    };
    interrupt::while_rendering(rescue, || prepared.render_onto(&film, &bar, &interrupt::CANCEL));
    bar.0.finish_and_clear();
    let film = Arc::into_inner(film).expect("who would have saved it is gone");
    film.into_inner().unwrap_or_else(|poisoned| poisoned.into_inner())
}

/// Where a picture goes, and how.
struct Saving {
    target: Target,
    settings: ResolvedSettings,
    about: Metadata,
}

impl Saving {
    fn new(target: Target, settings: &ResolvedSettings, sources: &SourceMap) -> Self {
        let about = match target.format {
            Format::Exr => metadata(settings, sources),
            Format::Png | Format::Jpeg | Format::Hdr => Metadata::default(),
        };
        Saving { target, settings: *settings, about }
    }

    fn save(&self, film: &Film) -> Result<(), Failure> {
        let Saving { target, settings, about } = self;
        let develop = Development { exposure: settings.exposure, tonemap: settings.tonemap };
        let bytes = output::encode(film, target.format, &develop, about)
            .map_err(|fault| Failure::machine(format!("cannot write {}", target.path.display()), fault))?;
        target.place.write(&bytes)
    }

    /// Saves a picture whose rendering does not come to an end.
    fn rescue(&self, film: &Film) {
        match self.save(film) {
            Ok(()) => tell(format!("{}  as far as it was: a ray does not come back", self.target.shown())),
            Err(failure) => tell_failure(&failure),
        }
    }
}

/// A bar with the time left on a terminal; nothing anywhere else.
struct Bar(ProgressBar);

impl Bar {
    fn new() -> Self {
        let bar = ProgressBar::with_draw_target(Some(1), ProgressDrawTarget::hidden());
        if std::io::stderr().is_terminal() {
            bar.set_draw_target(ProgressDrawTarget::stderr_with_hz(10));
            let style = ProgressStyle::with_template("{bar:40} {percent:>3} %  {elapsed} gone, {eta} left");
            bar.set_style(style.expect("the template is well formed"));
        }
        Bar(bar)
    }
}

impl Progress for Bar {
    fn tiles(&self, done: usize, total: usize) {
        if !self.0.is_hidden() {
            self.0.set_length(total as u64);
            self.0.set_position(done as u64);
        }
    }
}

/// The file that is asked for.
struct Target {
    path: PathBuf,
    place: Place,
    format: Format,
}

impl Target {
    /// Tries whether the picture can be written there, and as what.
    fn new(args: &Render) -> Result<Self, Failure> {
        super::try_to_read(&args.file)?;
        let path = args.output.clone().unwrap_or_else(|| default_output(&args.file));
        let is_stdout = path == Path::new("-");
        let format = if is_stdout { Some(Format::Png) } else { Format::of(&path) };
        let format = format.ok_or_else(|| {
            Failure::usage(format!("{}: pictures are .png, .jpg, .hdr or .exr", path.display()))
        })?;
        if is_stdout && args.stats.is_some() {
            return Err(Failure::usage("`-o -` and `--stats` cannot both have standard output"));
        }
        if is_stdout && std::io::stdout().is_terminal() {
            return Err(Failure::usage("a picture on a terminal is noise: send it to a file or a pipe"));
        }
        let place = Place::try_at(&path)?;
        Ok(Target { path, place, format })
    }

    fn shown(&self) -> String {
        self.path.display().to_string()
    }

    /// Some formats count their sides in 16 bits, and a film that does not fit into memory would end the process.
    fn refuse_too_large(&self, settings: &ResolvedSettings, memory: u64) -> Result<(), Failure> {
        /// Three f64 of the film, its flag, and the encoder's copy in f32.
        const BYTES_A_PIXEL: u64 = 24 + 1 + 16;
        let [w, h] = settings.size;
        let pixels = u64::from(settings.crop.width) * u64::from(settings.crop.height);
        if pixels.saturating_mul(BYTES_A_PIXEL) > memory {
            return Err(Failure {
                exit: Exit::Scene,
                message: format!(
                    "a picture of {w}×{h} pixels needs {} MiB, the guard `memory` allows {}\n\
                     raise it with `--limit memory=BYTES`, or render a part with `--crop`",
                    (pixels * BYTES_A_PIXEL) >> 20,
                    memory >> 20
                ),
            });
        }
        if self.format == Format::Jpeg && w.max(h) > u32::from(u16::MAX) {
            return Err(Failure::usage("a JPEG has at most 65535 pixels a side; .png and .exr have more"));
        }
        Ok(())
    }
}

/// What an EXR file says of how it was made.
fn metadata(settings: &ResolvedSettings, sources: &SourceMap) -> Metadata {
    Metadata {
        version: env!("CARGO_PKG_VERSION").to_owned(),
        scene: format!("{:016x}", hash(sources)),
        tracer: tracer_word(settings.tracer).to_owned(),
        samples: settings.samples,
        seed: settings.seed,
        size: settings.size,
    }
}

/// FNV-1a of all texts in the order they were read: the same on every machine and in every version.
fn hash(sources: &SourceMap) -> u64 {
    let bytes = sources.ids().flat_map(|id| sources.text(id).bytes());
    bytes.fold(0xcbf2_9ce4_8422_2325, |h, byte| (h ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3))
}

fn refuse_unbuilt(args: &Render) -> Result<(), Failure> {
    let asked = [
        ("--frames", args.frames.is_some()),
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

/// The scene's name with `.png`, in the current folder.
fn default_output(file: &Path) -> PathBuf {
    match file.file_stem() {
        Some(stem) if file != Path::new("-") => PathBuf::from(stem).with_extension("png"),
        _ => PathBuf::from("scene.png"),
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
