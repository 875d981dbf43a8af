//! Where pictures go and as what: whatever can be known to fail is found here, before the work begins.

use super::name::Name;
use crate::args::Render;
use crate::place::Place;
use crate::speech::{Exit, Failure};
use ogee::diag::SourceMap;
use ogee::render::denoise;
use ogee::render::features::{Features, Layer, Source};
use ogee::render::film::Film;
use ogee::render::output::movie::{Movie, MovieFormat};
use ogee::render::output::{self, Development, Format, Metadata, Origin};
use ogee::render::settings::ResolvedSettings;
use std::io::IsTerminal;
use std::ops::Range;
use std::path::{Path, PathBuf};

/// What a name asks for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// A file a picture.
    Still(Format),
    /// A file for all frames.
    Movie(MovieFormat),
}

/// The output that is asked for.
pub struct Target {
    /// Its name.
    pub name: Name,
    /// Its form.
    pub form: Form,
    is_default: bool,
}

impl Target {
    /// Tries whether a picture can be written there, and as what.
    pub fn new(args: &Render) -> Result<Self, Failure> {
        let given = args.output.clone().unwrap_or_else(|| default_output(&args.file, "png"));
        let name = Name::read(&given).map_err(Failure::usage)?;
        let is_stdout = given == Path::new("-");
        let still = if is_stdout { Some(Format::Png) } else { Format::of(&given) };
        let form = still.map(Form::Still).or_else(|| MovieFormat::of(&given).map(Form::Movie));
        let form = form.ok_or_else(|| {
            let known = "pictures are .png, .jpg, .hdr or .exr, animations .gif or .apng";
            Failure::usage(format!("{}: {known}", given.display()))
        })?;
        if is_stdout && args.stats.is_some() {
            return Err(Failure::usage("`-o -` and `--stats` cannot both have standard output"));
        }
        if is_stdout && std::io::stdout().is_terminal() {
            return Err(Failure::usage("a picture on a terminal is noise: send it to a file or a pipe"));
        }
        if name.is_numbered() && matches!(form, Form::Movie(_)) {
            let message = format!("{}: a file for each frame is .png, .jpg, .hdr or .exr", given.display());
            return Err(Failure::usage(message));
        }
        if !args.layers.is_empty() && form != Form::Still(Format::Exr) {
            let message =
                format!("{}: only .exr pictures have layers; write `-o picture.exr`", given.display());
            return Err(Failure::usage(message));
        }
        if args.resume && !name.is_numbered() {
            let message = "`--resume` looks for a file for each frame: write `-o walk-{frame:04}.png`";
            return Err(Failure::usage(message));
        }
        Place::try_at(&name.of(0))?;
        Ok(Target { name, form, is_default: args.output.is_none() })
    }

    /// For these frames: several of them do not go into one still picture.
    pub fn for_frames(self, args: &Render, frames: &Range<u32>) -> Result<Self, Failure> {
        if frames.len() == 1 || self.name.is_numbered() || matches!(self.form, Form::Movie(_)) {
            return Ok(self);
        }
        if !self.is_default {
            return Err(Failure::usage(format!(
                "{} frames do not go into one {}\nwrite `-o {}` for a file each, a name that ends in .gif or .apng for an animation, \
                 or `--time T` for one picture",
                frames.len(),
                self.shown(),
                self.name.numbered_like(&self.extension()),
            )));
        }
        let name = Name::read(&default_output(&args.file, "gif")).map_err(Failure::usage)?;
        Place::try_at(name.given())?;
        Ok(Target { name, form: Form::Movie(MovieFormat::Gif), ..self })
    }

    fn extension(&self) -> String {
        self.name.given().extension().map_or("png".into(), |ext| ext.to_string_lossy().into_owned())
    }

    /// For messages.
    pub fn shown(&self) -> String {
        self.name.given().display().to_string()
    }

    /// Some formats count their sides in 16 bits, and a film that does not fit into memory would end the process.
    pub fn refuse_too_large(&self, settings: &ResolvedSettings, memory: u64) -> Result<(), Failure> {
        /// Three f64 of the film, its flag, and the encoder's copy in f32.
        const BYTES_A_PIXEL: u64 = 24 + 1 + 16;
        /// What is kept of a pixel for layers, and their encoder's copy.
        const BYTES_OF_LAYERS: u64 = size_of::<Features>() as u64 + 56;
        let of_layers = if settings.kept().is_empty() { 0 } else { BYTES_OF_LAYERS };
        let of_filter = if settings.denoise { denoise::BYTES_A_PIXEL } else { 0 };
        let a_pixel = BYTES_A_PIXEL + of_layers + of_filter;
        let [w, h] = settings.size;
        let pixels = u64::from(settings.crop.width) * u64::from(settings.crop.height);
        if pixels.saturating_mul(a_pixel) > memory {
            return Err(Failure {
                exit: Exit::Scene,
                message: format!(
                    "a picture of {w}×{h} pixels needs {} MiB, the guard `memory` allows {}\n\
                     raise it with `--limit memory=BYTES`, or render a part with `--crop`",
                    (pixels * a_pixel) >> 20,
                    memory >> 20
                ),
            });
        }
        let (word, most) = match self.form {
            Form::Still(Format::Jpeg) => ("JPEG", u32::from(u16::MAX)),
            Form::Still(Format::Png | Format::Hdr | Format::Exr) => return Ok(()),
            Form::Movie(MovieFormat::Gif) => ("GIF", MovieFormat::Gif.largest_side()),
            Form::Movie(MovieFormat::Apng) => ("APNG", MovieFormat::Apng.largest_side()),
        };
        match w.max(h) > most {
            true => Err(Failure::usage(format!(
                "a {word} has at most {most} pixels a side; .png and .exr have more"
            ))),
            false => Ok(()),
        }
    }
}

/// A still picture on its way to its file.
pub struct Saving {
    path: PathBuf,
    place: Place,
    format: Format,
    develop: Development,
    about: Metadata,
    /// For the objects of the layer `source`.
    sources: SourceMap,
}

impl Saving {
    /// Tries whether the picture can be written there.
    pub fn at(
        path: PathBuf,
        format: Format,
        settings: &ResolvedSettings,
        sources: &SourceMap,
    ) -> Result<Self, Failure> {
        let about = match format {
            Format::Exr => metadata(settings, sources),
            Format::Png | Format::Jpeg | Format::Hdr => Metadata::default(),
        };
        let place = Place::try_at(&path)?;
        let sources = match settings.layers.has(Layer::Source) {
            true => sources.clone(),
            false => SourceMap::default(),
        };
        Ok(Saving { path, place, format, develop: development(settings), about, sources })
    }

    /// Writes it.
    pub fn save(&self, film: &Film) -> Result<(), Failure> {
        let about = Metadata { sources: self.origins(film), ..self.about.clone() };
        let about = Metadata { samples: samples(&about, film), denoise: film.denoised, ..about };
        let bytes = output::encode(film, self.format, &self.develop, &about);
        self.place.write(&bytes.map_err(|fault| cannot_write(&self.path, fault))?)
    }

    /// Where the objects of the layer `source` stand in the scene's text.
    fn origins(&self, film: &Film) -> Vec<Origin> {
        let origin = |(number, source): (u32, &Source)| {
            let file = Path::new(self.sources.name(source.span.source)).file_name();
            Origin {
                number,
                file: file.map_or(String::new(), |name| name.to_string_lossy().into_owned()),
                line: self.sources.line_column(source.span.source, source.span.start).line,
                name: source.name.as_deref().map(str::to_owned),
            }
        };
        (1..).zip(&film.sources).map(origin).collect()
    }

    /// Its name, for messages.
    pub fn shown(&self) -> String {
        self.path.display().to_string()
    }
}

/// Writes an animation as far as it is; nothing where it has no frame.
pub fn save_movie(movie: &Movie, path: &Path) -> Result<(), Failure> {
    if movie.is_empty() {
        return Ok(());
    }
    Place::try_at(path)?.write(&movie.encode().map_err(|fault| cannot_write(path, fault))?)
}

/// What could not be encoded.
pub fn cannot_write(path: &Path, fault: impl std::fmt::Display) -> Failure {
    Failure::machine(format!("cannot write {}", path.display()), fault)
}

/// How the settings develop a film.
pub fn development(settings: &ResolvedSettings) -> Development {
    Development { exposure: settings.exposure, tonemap: settings.tonemap }
}

/// What an EXR file says of how it was made.
fn metadata(settings: &ResolvedSettings, sources: &SourceMap) -> Metadata {
    Metadata {
        version: env!("CARGO_PKG_VERSION").to_owned(),
        scene: format!("{:016x}", hash(sources)),
        tracer: settings.tracer.word().to_owned(),
        samples: settings.samples,
        depth: settings.depth,
        seed: settings.seed,
        sampler: settings.sampler.word().to_owned(),
        filter: settings.filter.word().to_owned(),
        clamp: settings.clamp,
        size: settings.size,
        error: settings.error,
        ..Metadata::default()
    }
}

/// Samples with which the picture can be made again: those that were taken, or the most where an error decided.
fn samples(about: &Metadata, film: &Film) -> u32 {
    match about.error {
        None if film.report.taken.pixels > 0 => film.report.taken.most,
        _ => about.samples,
    }
}

/// FNV-1a of all texts in the order they were read: the same on every machine and in every version.
fn hash(sources: &SourceMap) -> u64 {
    let bytes = sources.ids().flat_map(|id| sources.text(id).bytes());
    bytes.fold(0xcbf2_9ce4_8422_2325, |h, byte| (h ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3))
}

/// The scene's name with another extension, in the current folder.
fn default_output(file: &Path, extension: &str) -> PathBuf {
    match file.file_stem() {
        Some(stem) if file != Path::new("-") => PathBuf::from(stem).with_extension(extension),
        _ => PathBuf::from("scene").with_extension(extension),
    }
}
