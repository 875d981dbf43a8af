//! From an evaluated scene to a picture: the camera chosen, the world built, the tracer made, the faults worded.
//! Knows neither files to write nor terminals.

use super::whole;
use crate::diag::{Code, Diagnostic};
use crate::math::field::FaultKind;
use crate::render::camera::View;
use crate::render::denoise;
use crate::render::features::Layers;
use crate::render::film::{Fault, Film};
use crate::render::passes::{self, Passes};
use crate::render::settings::{Crop, ResolvedSettings};
use crate::render::tiles::{self, Picture, Progress, Watch};
use crate::render::{self, Tracer};
use crate::scene::assets::{AssetCache, Loader};
use crate::scene::{Camera, RenderSettings, SamplerKind, Scene, TracerKind};
use crate::world::{Kept, World, WorldOptions};
use std::sync::Mutex;
use std::sync::atomic::AtomicBool;

/// What is asked of a picture beside what the scene says.
#[derive(Clone, Debug, Default)]
pub struct Job {
    /// Settings that come before the scene's.
    pub overrides: RenderSettings,
    /// The label of the camera; none takes the first.
    pub camera: Option<String>,
    /// The part to render: x, y, width, height in pixels.
    pub crop: Option<[u32; 4]>,
    /// The estimated error, relative to its luminance, at which a pixel is finished; see [`ResolvedSettings::error`].
    pub error: Option<f64>,
    /// What of each pixel is written beside its radiance.
    pub layers: Layers,
    /// Whether noise is filtered out of the finished picture.
    pub denoise: bool,
    /// Threads; none takes as many as the machine has processors.
    pub threads: Option<usize>,
}

/// Everything that a picture needs but what its tracer makes beforehand.
pub struct Prepared {
    /// What is seen.
    pub world: World,
    /// How; may be changed between pictures, but for size, crop and tree.
    pub settings: ResolvedSettings,
    view: View,
}

/// The settings of a job for a scene, and what keeps them from being used. Cheap: nothing is built.
pub fn settings(scene: &Scene, job: &Job) -> Result<ResolvedSettings, String> {
    let mut settings = ResolvedSettings::new(&scene.render, &job.overrides);
    (settings.threads, settings.error, settings.layers) = (job.threads, job.error, job.layers);
    settings.denoise = job.denoise;
    if let Some([x, y, width, height]) = job.crop {
        let [w, h] = settings.size;
        settings.crop = Crop { x, y, width, height };
        if !settings.crop.fits(settings.size) {
            return Err(format!("the crop {x},{y},{width},{height} does not lie within the {w}×{h} picture"));
        }
    }
    Ok(settings)
}

/// Builds the world. The diagnostics tell what is wrong with the scene as a whole and
/// with the files it names; with an error among them nothing is prepared.
pub fn prepare(
    scene: Scene,
    job: &Job,
    settings: ResolvedSettings,
    loader: &dyn Loader,
) -> (Option<Prepared>, Vec<Diagnostic>) {
    prepare_frame(scene, job, settings, &AssetCache::new(loader), &mut Kept::default())
}

/// The same for a frame of an animation, with what is left of the frames before.
pub fn prepare_frame(
    scene: Scene,
    job: &Job,
    settings: ResolvedSettings,
    assets: &AssetCache<'_>,
    kept: &mut Kept,
) -> (Option<Prepared>, Vec<Diagnostic>) {
    let mut found = whole::faults(&scene, true);
    let view = match choose(&scene, job.camera.as_deref()) {
        Ok(Some(camera)) => View::new(camera, settings.size)
            .map_err(|fault| found.push(Diagnostic::new(Code::BadGeometry, camera.span, fault.to_string())))
            .ok(),
        Ok(None) => None,
        Err(diagnostic) => {
            found.push(diagnostic);
            None
        }
    };
    let Some(view) = view else { return (None, found) };
    let options = WorldOptions { accelerator: settings.accelerator, footprint: Some(view.footprint()) };
    let (world, of_world) = World::with_assets(scene.nodes, &options, assets, kept);
    found.extend(of_world);
    ((!crate::diag::has_errors(&found)).then_some(Prepared { world, settings, view }), found)
}

/// The camera with this label, or the first; none where there is none, which [`whole::faults`] tells.
fn choose<'a>(scene: &'a Scene, label: Option<&str>) -> Result<Option<&'a Camera>, Diagnostic> {
    let Some(label) = label else { return Ok(scene.cameras.first()) };
    let labels = || scene.cameras.iter().filter_map(|camera| camera.label.as_deref());
    let found = scene.cameras.iter().find(|camera| camera.label.as_deref() == Some(label));
    if found.is_some() || scene.cameras.is_empty() {
        return Ok(found);
    }
    let known = labels().collect::<Vec<_>>().join("`, `");
    let fault = Diagnostic::new(Code::UnknownCamera, None, format!("no camera is labelled `{label}`"));
    Err(match known.is_empty() {
        true => fault.hint("the scene's cameras have no labels: write `camera front { … }`"),
        false => fault.did_you_mean(label, labels()).hint(format!("the labels are `{known}`")),
    })
}

impl Prepared {
    /// Everything of the picture, by a tracer.
    pub fn picture<'a>(&'a self, tracer: &'a dyn Tracer) -> Picture<'a> {
        Picture { world: &self.world, view: &self.view, tracer, settings: &self.settings }
    }

    /// The tracer, with all that it makes beforehand: photons, records. None once `cancel` is true.
    pub fn tracer(&self, progress: &dyn Progress, cancel: &AtomicBool) -> Option<Box<dyn Tracer>> {
        let watch = Watch { progress, cancel };
        render::tracer(self.settings.tracer, &self.world, &self.view, &self.settings, watch)
    }

    /// Renders. Once `cancel` is true the film comes back as far as it is.
    pub fn render(&self, progress: &dyn Progress, cancel: &AtomicBool) -> Film {
        let film = Mutex::new(self.bare_film());
        if let Some(mut tracer) = self.tracer(progress, cancel) {
            self.render_onto(&film, &mut *tracer, progress, cancel);
        }
        film.into_inner().unwrap_or_else(|poisoned| poisoned.into_inner())
    }

    /// The picture in passes. Photons and irradiance cannot: how many there are depends on the number of samples.
    pub fn passes(&self) -> Option<Passes<'_>> {
        let goes_on = match self.settings.tracer {
            TracerKind::Raycast | TracerKind::Whitted | TracerKind::MonteCarlo | TracerKind::Path => true,
            TracerKind::Irradiance | TracerKind::Photon => false,
        };
        (goes_on && self.settings.sampler != SamplerKind::Stratified).then(|| Passes::new(&self.settings))
    }

    /// A film on which nothing is yet.
    pub fn bare_film(&self) -> Film {
        Film::new(self.settings.size, self.settings.crop)
    }

    /// Takes the noise out of a complete film, where that is asked for. Once `cancel` is true the film stays as it is.
    pub fn filter(&self, film: &Mutex<Film>, progress: &dyn Progress, cancel: &AtomicBool) {
        let held = || film.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
        if !self.settings.denoise || !held().is_complete() {
            return;
        }
        let noisy = held().clone();
        if let Some(pixels) = denoise::denoised(&noisy, self.settings.threads, progress, cancel) {
            let mut film = held();
            (film.pixels, film.denoised) = (pixels, true);
        }
    }

    /// Renders onto a bare film that others may look at meanwhile: every tile that is finished is on it, or every pass where the tracer must be
    /// renewed on the way. Noise is filtered at the end.
    pub fn render_onto(
        &self,
        film: &Mutex<Film>,
        tracer: &mut dyn Tracer,
        progress: &dyn Progress,
        cancel: &AtomicBool,
    ) {
        if tracer.lasts() < self.settings.samples {
            let scene = (&self.world, &self.view, &self.settings);
            passes::render_renewing(film, scene, tracer, Watch { progress, cancel });
        } else {
            tiles::render_onto(film, self.picture(tracer), tiles::TILE, progress, cancel);
        }
        self.filter(film, progress, cancel);
    }
}

/// What went wrong while a picture was made, one diagnostic for each expression.
pub fn faults(film: &Film) -> Vec<Diagnostic> {
    let not_finite = film.report.first_non_finite.as_ref().map(not_finite);
    film.report.undefined.iter().map(undefined).chain(not_finite).collect()
}

fn not_finite(fault: &Fault) -> Diagnostic {
    let [x, y] = fault.pixel;
    let samples =
        if fault.count == 1 { "1 sample is".to_owned() } else { format!("{} samples are", fault.count) };
    let message =
        format!("{samples} infinite or not a number, and left out; the first is of pixel ({x}, {y})");
    Diagnostic::new(Code::NonFiniteSample, fault.span, message)
        .label("here")
        .hint("look for a light or a material with a number that is far too large")
}

fn undefined(fault: &Fault) -> Diagnostic {
    let [x, y] = fault.pixel;
    let pixels = if fault.count == 1 { "1 pixel".to_owned() } else { format!("{} pixels", fault.count) };
    let what = fault.kind.map_or("a function without a value", |kind| kind.text());
    let message = format!("{what} at {pixels}; the first is ({x}, {y})");
    Diagnostic::new(Code::UndefinedSample, fault.span, message).label("no finite value there").hint(
        match fault.kind {
            Some(FaultKind::Unresolved) => {
                "these pixels are magenta; smooth the function, or make the box smaller: a jump or a pole may fill the ray"
            }
            _ => "these pixels are magenta; keep a divisor from 0, clamp a root's argument, or choose with `? :`",
        },
    )
}
