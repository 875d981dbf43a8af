//! The one door to the library for the command line, the tests and the REPL: a [`Session`] holds the sources, the options
//! and the loader, and turns a file into a scene with everything that is wrong with it.

pub mod inspect;
pub mod picture;
pub mod whole;

use crate::diag::{Diagnostic, SourceMap};
use crate::lang::value::Value;
use crate::scene::Scene;
use crate::scene::assets::{DiskLoader, Loader};
use std::path::Path;
use std::sync::Arc;

/// Guards; each names itself and its flag (`--limit NAME=N`) when it is met.
#[derive(Clone, Copy, Debug)]
pub struct Limits {
    /// How deeply brackets, braces and operators may nest (`nesting`).
    pub nesting: usize,
    /// How deeply calls may nest (`calls`).
    pub calls: usize,
    /// How many turns all loops of a run may take (`turns`).
    pub turns: u64,
    /// How many elements one list may have (`list`).
    pub list: usize,
    /// How many bytes a scene file may have (`file`).
    pub file: u64,
    /// How many bytes evaluation may allocate for values and objects, estimated (`memory`).
    pub memory: u64,
}

impl Default for Limits {
    fn default() -> Self {
        Limits {
            nesting: 256,
            calls: 10_000,
            turns: 1_000_000_000,
            list: 50_000_000,
            file: 1 << 30,
            memory: 8 << 30,
        }
    }
}

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
    /// True where an error was found.
    pub fn has_errors(&self) -> bool {
        self.diagnostics.iter().any(|d| d.severity == crate::diag::Severity::Error)
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
        let _ = path;
        Evaluated { scene: Scene::default(), diagnostics: Vec::new(), printed: Vec::new() }
    }

    /// Evaluates a text as if it were a file of this name (relative paths and imports start at its folder).
    pub fn evaluate_text(&mut self, name: &str, text: &str) -> Evaluated {
        let _ = (name, text);
        Evaluated { scene: Scene::default(), diagnostics: Vec::new(), printed: Vec::new() }
    }

    /// Evaluates one expression, with the names of a file in scope where one is given.
    pub fn evaluate_expression(
        &mut self,
        text: &str,
        file: Option<&Path>,
    ) -> (Option<Value>, Vec<Diagnostic>) {
        let _ = (text, file);
        (None, Vec::new())
    }
}
