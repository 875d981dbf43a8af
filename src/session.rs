//! The one door to the library for the command line, the tests and the REPL: a [`Session`] holds the sources, the options
//! and the loader, and turns a file into a scene with everything that is wrong with it.

pub mod animation;
mod answer;
pub mod dialogue;
pub mod inspect;
pub mod picture;
pub mod plot;
mod run;
mod trace;
pub mod whole;

use crate::diag::{Code, Diagnostic, Sink, SourceMap};
use crate::scene::Scene;
use crate::scene::assets::{DiskLoader, Loader};
use dialogue::Reply;
use run::Root;
use std::path::Path;
use std::sync::Arc;

pub use crate::lang::limits::Limits;
pub use crate::math::vectors::{has_avx2, keep_to_baseline};
pub use answer::Answer;

/// What a run is asked for.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// Guards.
    pub limits: Limits,
    /// `--set name=expression`, in order: replaces top-level `let`s.
    pub set: Vec<(String, String)>,
    /// `time`: 0 up to 1 over an animation.
    pub time: f64,
    /// `frame`.
    pub frame: u32,
}

/// Sources, options, and the way files are read.
pub struct Session {
    /// Every text that was read, for diagnostics.
    pub sources: SourceMap,
    /// Options of all evaluations.
    pub options: Options,
    loader: Arc<dyn Loader>,
}

/// What evaluation of a file gives: always a scene, whole or in part, and everything that is wrong.
pub struct Evaluated {
    /// What could be made of it.
    pub scene: Scene,
    /// In source order.
    pub diagnostics: Vec<Diagnostic>,
    /// What `print` said.
    pub printed: Vec<String>,
}

impl Evaluated {
    /// Of a file that could not be read.
    fn nothing(sink: Sink) -> Evaluated {
        Evaluated { scene: Scene::default(), diagnostics: sink.into_sorted(), printed: Vec::new() }
    }

    /// True where an error was found.
    pub fn has_errors(&self) -> bool {
        crate::diag::has_errors(&self.diagnostics)
    }
}

impl Default for Session {
    fn default() -> Self {
        Session::new(Options::default(), Arc::new(DiskLoader))
    }
}

impl Session {
    /// A session with no sources yet.
    pub fn new(options: Options, loader: Arc<dyn Loader>) -> Self {
        Session { sources: SourceMap::default(), options, loader }
    }

    /// The way files are read.
    pub fn loader(&self) -> &Arc<dyn Loader> {
        &self.loader
    }

    /// Reads and evaluates a scene file and its imports. `-` reads standard input.
    pub fn evaluate_file(&mut self, path: &Path) -> Evaluated {
        self.evaluate(&Root::File(path)).evaluated
    }

    /// Evaluates a text as if it were a file of this name (relative paths and imports start at its folder).
    pub fn evaluate_text(&mut self, name: &str, text: &str) -> Evaluated {
        self.evaluate(&Root::Text(Path::new(name), text)).evaluated
    }

    /// The same, and what the scene lacks as a whole is told too: a camera, a light, anything to see. A file that shows no
    /// sign of being meant for a picture lacks nothing.
    pub fn check_file(&mut self, path: &Path) -> Evaluated {
        let mut outcome = self.evaluate(&Root::File(path));
        let attempts = outcome.attempts;
        let sees = |d: &Diagnostic| match d.code {
            Code::NoCamera => !attempts.setting,
            _ => !attempts.failed,
        };
        let lacking = whole::faults(&outcome.evaluated.scene, false).into_iter().filter(sees);
        outcome.evaluated.diagnostics.extend(lacking);
        outcome.evaluated
    }

    /// Evaluates one expression, with the names of a file in scope where one is given, whole or in part.
    pub fn evaluate_expression(
        &mut self,
        text: &str,
        file: Option<&Path>,
    ) -> (Option<Answer>, Vec<Diagnostic>) {
        let replies = self.dialogue(None, |dialogue| {
            let file = file.map(|path| dialogue.part_of_file(path));
            file.into_iter().chain([dialogue.expression(text)]).collect::<Vec<_>>()
        });
        let nothing = |reply: &Reply| (!reply.failed).then(|| Answer::List(Vec::new()));
        let answer = replies.last().and_then(|reply| reply.answer().cloned().or_else(|| nothing(reply)));
        (answer, replies.into_iter().flat_map(|reply| reply.diagnostics).collect())
    }

    fn evaluate(&mut self, root: &Root<'_>) -> run::Outcome {
        run::evaluate(&mut self.sources, &self.options, &*self.loader, root)
    }
}
