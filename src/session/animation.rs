//! A scene frame by frame, in one process: its text is read and parsed once, files that it names are read once, and meshes keep their trees.
//! Knows neither files to write nor terminals.
//!
//! A frame is the same picture however the animation is cut, on however many threads. What goes on from frame to frame are reaches alone
//! ([`crate::lang::eval::Standing::next_frame`]): where a scene has any, the frames before one are evaluated too, from the first, though
//! they are not rendered. That is cheap beside a picture.

use super::picture::{self, Job, Prepared};
use super::run::{self, Means, Root, Settings, State, on_deep_stack};
use super::trace::Tracer;
use super::{Evaluated, Options, Session};
use crate::diag::{Diagnostic, Severity, Sink, SourceMap, Span};
use crate::lang::eval::Standing;
use crate::lang::resolve::load::{FileId, Files};
use crate::render::settings::ResolvedSettings;
use crate::scene::assets::{AssetCache, Loader};
use crate::scene::{RenderSettings, Scene};
use crate::world::Kept;
use std::collections::HashSet;
use std::ops::Range;
use std::path::Path;
use std::sync::atomic::AtomicBool;

/// What is asked of a scene that may be an animation.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Asked {
    /// All its frames.
    Whole,
    /// One picture, at the time of the session's options.
    Still,
    /// These of its frames. Where the scene does not say how many it has, it has as many as the last of these asks for.
    Frames(Range<u32>),
}

/// A scene, open at one frame after another.
pub struct Animation<'s> {
    sources: &'s mut SourceMap,
    options: Options,
    loader: &'s dyn Loader,
    cancel: Option<&'s AtomicBool>,
    stack: usize,
    asked: Asked,
    tracer: Tracer<'s>,
    assets: AssetCache<'s>,
    kept: Kept,
    files: Files,
    /// None where the root could not be read.
    root: Option<FileId>,
    set: Settings,
    /// What was wrong with the texts; it belongs to the first evaluation.
    faults: Option<Sink>,
    standing: Standing,
    /// The frame that `standing` leads to.
    next: u32,
    /// What the first frame said of all of them.
    facts: Option<Facts>,
    /// That frame, until it is asked for.
    first: Option<Evaluated>,
    said: HashSet<(&'static str, Option<Span>)>,
}

#[derive(Clone, Copy)]
struct Facts {
    count: u32,
    fps: f64,
    failed: bool,
}

impl Session {
    /// Opens a scene file frame by frame and works with it, on a stack that is deep enough for recursion. `-` is standard input. An
    /// evaluation ends soon after `cancel` is set.
    pub fn animate<T: Send>(
        &mut self,
        path: &Path,
        asked: Asked,
        cancel: Option<&AtomicBool>,
        work: impl FnOnce(&mut Animation<'_>) -> T + Send,
    ) -> T {
        let Session { sources, options, loader } = self;
        let loader: &dyn Loader = &**loader;
        on_deep_stack(&options.limits, |stack| {
            let mut animation = Animation {
                sources,
                options: options.clone(),
                loader,
                cancel,
                stack,
                asked,
                tracer: Tracer::new(loader, options.limits),
                assets: AssetCache::new(loader),
                kept: Kept::default(),
                files: Files::default(),
                root: None,
                set: Settings::new(),
                faults: None,
                standing: Standing::animated(),
                next: 0,
                facts: None,
                first: None,
                said: HashSet::new(),
            };
            animation.read(path);
            work(&mut animation)
        })
    }
}

impl Animation<'_> {
    /// Every text that was read, for diagnostics.
    pub fn sources(&self) -> &SourceMap {
        self.sources
    }

    /// Options of all evaluations, without the time.
    pub fn options(&self) -> &Options {
        &self.options
    }

    /// Whether the first frame, or the one picture, has errors: then nothing is known of others.
    pub fn failed(&mut self) -> bool {
        self.facts().failed
    }

    /// How many frames a second it has.
    pub fn fps(&mut self) -> f64 {
        self.facts().fps
    }

    /// The first frame tells how many there are, whichever of them are wanted.
    fn facts(&mut self) -> Facts {
        if let Some(facts) = self.facts {
            return facts;
        }
        let first = self.evaluate(0);
        let asked = match &self.asked {
            Asked::Whole | Asked::Still => 1,
            Asked::Frames(frames) => frames.end,
        };
        let render = &first.scene.render;
        let facts = Facts {
            count: render.frames.unwrap_or(asked).max(1),
            fps: render.fps.unwrap_or(RenderSettings::FPS),
            failed: first.has_errors(),
        };
        (self.facts, self.first) = (Some(facts), Some(first));
        facts
    }

    /// The frames that are wanted, or why they cannot be had.
    pub fn frames(&mut self) -> Result<Range<u32>, String> {
        let n = self.facts().count;
        match &self.asked {
            Asked::Whole => Ok(0..n),
            Asked::Still => Ok(0..1),
            Asked::Frames(frames) if frames.end <= n => Ok(frames.clone()),
            Asked::Frames(frames) => Err(format!(
                "frame {} is beyond the last: the scene says `frames {n}`, and they count from 0",
                frames.end - 1
            )),
        }
    }

    /// A frame. Frames before it are evaluated where it goes on from them.
    pub fn frame(&mut self, frame: u32) -> Evaluated {
        self.facts();
        let first = self.first.take();
        if frame == 0
            && let Some(first) = first
        {
            return first;
        }
        if !self.mentions("reach") {
            return self.evaluate(frame);
        }
        if frame < self.next {
            (self.standing, self.next) = (Standing::animated(), 0);
        }
        for before in self.next..frame {
            self.evaluate(before);
        }
        self.evaluate(frame)
    }

    /// Builds the world of a frame, of meshes and pictures that are ready where frames before had them;
    /// see [`picture::prepare`].
    pub fn prepare(
        &mut self,
        scene: Scene,
        job: &Job,
        settings: ResolvedSettings,
    ) -> (Option<Prepared>, Vec<Diagnostic>) {
        picture::prepare_frame(scene, job, settings, &self.assets, &mut self.kept)
    }

    /// Those that are errors, or the first of their code and place in any frame.
    pub fn news(&mut self, mut diagnostics: Vec<Diagnostic>) -> Vec<Diagnostic> {
        diagnostics.retain(|d| self.said.insert((d.code.text(), d.span)) || d.severity == Severity::Error);
        diagnostics
    }

    fn read(&mut self, path: &Path) {
        let mut sink = Sink::default();
        let Animation { sources, options, loader, cancel, stack, tracer, .. } = self;
        let mut means = Means { sources, options, loader: *loader, tracer, cancel: *cancel, stack: *stack };
        let mut state = State::default();
        self.root = state.read(&mut means, &Root::File(path), &mut sink);
        self.set = run::settings(&mut means, &mut sink);
        self.files = state.files;
        self.faults = Some(sink);
        if self.has_frames() {
            self.kept = Kept::for_frames();
        }
    }

    /// Evaluates a frame from the standing of the one before.
    fn evaluate(&mut self, frame: u32) -> Evaluated {
        let mut sink = self.faults.take().unwrap_or_default();
        let has_frames = self.has_frames();
        let Some(root) = self.root else { return Evaluated::nothing(sink) };
        let options = match self.asked {
            Asked::Still => self.options.clone(),
            Asked::Whole | Asked::Frames(_) => {
                let count = self.facts.map_or(1, |facts| facts.count);
                Options { frame, time: f64::from(frame) / f64::from(count), ..self.options.clone() }
            }
        };
        let Animation { sources, loader, cancel, stack, tracer, .. } = self;
        let means =
            Means { sources, options: &options, loader: *loader, tracer, cancel: *cancel, stack: *stack };
        let mut state = State {
            files: std::mem::take(&mut self.files),
            standing: std::mem::take(&mut self.standing),
            ..State::default()
        };
        state.resolve(&means, root, &self.set, &mut sink);
        if !has_frames {
            state.files.forget_trees();
        }
        let ran = state.run(&means, None, &mut sink);
        (self.files, self.standing, self.next) = (state.files, state.standing.next_frame(), frame + 1);
        Evaluated { scene: ran.scene, diagnostics: sink.into_sorted(), printed: run::printed(ran.said) }
    }

    /// Whether there may be more than one frame: for one alone nothing is worth keeping.
    fn has_frames(&self) -> bool {
        match self.asked {
            Asked::Still => false,
            Asked::Whole => self.mentions("frames"),
            Asked::Frames(_) => true,
        }
    }

    /// Whether a word stands in any text: where it does not, the scene has no such property.
    fn mentions(&self, word: &str) -> bool {
        self.sources.ids().any(|id| self.sources.text(id).contains(word))
    }
}
