//! Evaluation from text to scene: reading, resolving and running, on a stack that is deep enough for recursion.

use super::trace::Tracer;
use super::{Evaluated, Options};
use crate::diag::{Code, Diagnostic, Sink, SourceMap};
use crate::lang::eval::{self, Attempts, Ran, Run, Said, Standing};
use crate::lang::limits::{Limits, exceeded};
use crate::lang::resolve::known::{Known, Names};
use crate::lang::resolve::load::{FileId, Files, Reading};
use crate::lang::resolve::{Setting, resolve};
use crate::scene::assets::Loader;
use crate::syntax::ast;
use crate::syntax::build::{ParseLimits, parse_expression};
use std::io::Read;
use std::path::Path;
use std::rc::Rc;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};

/// What is evaluated.
pub(super) enum Root<'a> {
    /// A file, by its path; `-` is standard input.
    File(&'a Path),
    /// A text, as if it stood in the file of this path.
    Text(&'a Path, &'a str),
}

/// What evaluation gives beside what every caller wants.
pub(super) struct Outcome {
    pub evaluated: Evaluated,
    pub attempts: Attempts,
}

/// A program and its values, as far as they have come.
#[derive(Default)]
pub(super) struct State {
    pub known: Known,
    pub files: Files,
    pub standing: Standing,
}

/// What evaluation works with.
pub(super) struct Means<'m> {
    pub sources: &'m mut SourceMap,
    pub options: &'m Options,
    pub loader: &'m dyn Loader,
    pub tracer: &'m Tracer<'m>,
    pub cancel: Option<&'m AtomicBool>,
    pub stack: usize,
}

impl Means<'_> {
    /// Whether somebody has asked for an end.
    pub fn is_cancelled(&self) -> bool {
        self.cancel.is_some_and(|asked| asked.load(Ordering::SeqCst))
    }
}

/// `--set`, parsed.
pub(super) type Settings = Vec<(Rc<str>, ast::Expr)>;

/// Evaluates a scene.
pub(super) fn evaluate(
    sources: &mut SourceMap,
    options: &Options,
    loader: &dyn Loader,
    root: &Root<'_>,
) -> Outcome {
    on_deep_stack(&options.limits, |stack| {
        let mut sink = Sink::default();
        let tracer = Tracer::new(loader, options.limits);
        let mut means = Means { sources, options, loader, tracer: &tracer, cancel: None, stack };
        let mut state = State::default();
        let Some(file) = state.read(&mut means, root, &mut sink) else { return empty(sink) };
        let set = settings(&mut means, &mut sink);
        state.resolve(&means, file, &set, &mut sink);
        state.files.forget_trees();
        let ran = state.run(&means, None, &mut sink);
        let evaluated =
            Evaluated { scene: ran.scene, diagnostics: sink.into_sorted(), printed: printed(ran.said) };
        Outcome { evaluated, attempts: ran.attempts }
    })
}

pub(super) fn printed(said: Vec<Said>) -> Vec<String> {
    let text = |said| if let Said::Printed(text) = said { Some(text) } else { None };
    said.into_iter().filter_map(text).collect()
}

fn empty(sink: Sink) -> Outcome {
    Outcome { evaluated: Evaluated::nothing(sink), attempts: Attempts { failed: true, setting: true } }
}

impl State {
    /// Reads a root file and its imports. None where it cannot be read, which is reported.
    pub fn read(&mut self, means: &mut Means<'_>, root: &Root<'_>, sink: &mut Sink) -> Option<FileId> {
        match root {
            Root::File(path) if *path == Path::new("-") => {
                let text = standard_input(sink)?;
                Some(self.reading(means, sink).root_text(path, &text))
            }
            Root::File(path) => self.reading(means, sink).root_file(path),
            Root::Text(path, text) => Some(self.reading(means, sink).root_text(path, text)),
        }
    }

    /// A reader into this state's files.
    pub fn reading<'r>(&'r mut self, means: &'r mut Means<'_>, sink: &'r mut Sink) -> Reading<'r> {
        Reading {
            loader: means.loader,
            sources: means.sources,
            limits: means.options.limits,
            sink,
            files: &mut self.files,
        }
    }

    /// Resolves a file that was read; gives the names that are visible after it.
    pub fn resolve(
        &mut self,
        means: &Means<'_>,
        file: FileId,
        set: &[(Rc<str>, ast::Expr)],
        sink: &mut Sink,
    ) -> Names {
        let Options { limits, time, frame, .. } = *means.options;
        let setting = Setting { limits, set, time, frame: f64::from(frame) };
        resolve(&mut self.known, &self.files, file, &setting, sink)
    }

    /// Runs what was resolved last. The values of `answers`' items that are expressions are among what is said.
    pub fn run(&mut self, means: &Means<'_>, answers: Option<FileId>, sink: &mut Sink) -> Ran {
        let source = answers.map(|file| self.files.files[file.0].source);
        let State { known, files, standing } = self;
        eval::run(&Run { answers: source, ..means.run(known, files) }, standing, sink)
    }
}

impl Means<'_> {
    /// A run of a program.
    pub fn run<'r>(&'r self, known: &'r Known, files: &'r Files) -> Run<'r> {
        Run {
            program: &known.program,
            files,
            loader: self.loader,
            tracer: self.tracer,
            limits: self.options.limits,
            time: (self.options.time, f64::from(self.options.frame)),
            stack: self.stack,
            answers: None,
            cancel: self.cancel,
        }
    }
}

fn standard_input(sink: &mut Sink) -> Option<String> {
    let mut bytes = Vec::new();
    let read = std::io::stdin().lock().read_to_end(&mut bytes).map_err(|e| e.to_string());
    let text = read.and_then(|_| String::from_utf8(bytes).map_err(|e| e.to_string()));
    let said = |error| {
        let message = format!("standard input cannot be read: {error}");
        sink.push(Diagnostic::new(Code::FileNotFound, None, message));
    };
    text.map_err(said).ok()
}

/// An expression of the command line, under a name of its own among the sources.
pub(super) fn parse(
    means: &mut Means<'_>,
    name: &str,
    text: &str,
    first_line: usize,
    sink: &mut Sink,
) -> Option<ast::Expr> {
    parse_shown(means, name, (text, text), first_line, sink)
}

/// The same of a text that diagnostics show as another one, whose bytes stand at the same offsets.
pub(super) fn parse_shown(
    means: &mut Means<'_>,
    name: &str,
    (text, shown): (&str, &str),
    first_line: usize,
    sink: &mut Sink,
) -> Option<ast::Expr> {
    let id = means.sources.add_from(format!("<{name}>"), shown, first_line);
    let limits = means.options.limits;
    if text.len() as u64 > limits.file {
        let message = format!("the {name} has {} bytes", text.len());
        sink.push(exceeded(Code::FileTooLarge, None, message, "file", limits.file));
        return None;
    }
    let (expr, faults) = parse_expression(id, text, ParseLimits::nesting(limits.nesting));
    sink.extend(faults);
    expr
}

/// What `--set` asks for.
pub(super) fn settings(means: &mut Means<'_>, sink: &mut Sink) -> Settings {
    let mut set = Vec::new();
    for (name, text) in &means.options.set {
        if let Some(expr) = parse(means, &format!("--set {name}"), text, 0, sink) {
            set.push((name.as_str().into(), expr));
        }
    }
    set
}

/// Stack for one nested call of the language, with the blocks and choices around it: what deep recursions of real scenes were
/// seen to take, doubled, in builds without optimisation. A scene that needs more is told so by the evaluator.
const STACK_PER_CALL: usize = 24 << 10;

/// Stack for one level of brackets, on the way through the parser, the resolver and the evaluator.
const STACK_PER_LEVEL: usize = 32 << 10;

/// The least and the most stack that is asked for. Only what is touched costs memory.
const STACK: [usize; 2] = [64 << 20, 64 << 30];

/// Runs a task on a thread whose stack fits the guard of call depth; tells it how large that stack is. Smaller where the
/// machine does not give as much.
pub(super) fn on_deep_stack<T: Send>(limits: &Limits, task: impl FnOnce(usize) -> T + Send) -> T {
    let waiting = Mutex::new(Some(task));
    let take = || waiting.lock().map_or(None, |mut task| task.take());
    let wanted = limits.calls.saturating_mul(STACK_PER_CALL);
    let mut size =
        wanted.saturating_add(limits.nesting.saturating_mul(STACK_PER_LEVEL)).clamp(STACK[0], STACK[1]);
    loop {
        let result = std::thread::scope(|scope| {
            let builder = std::thread::Builder::new().name("evaluation".into()).stack_size(size);
            let spawned = builder.spawn_scoped(scope, || take().map(|task| task(size)));
            spawned.map(|thread| thread.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic)))
        });
        match result {
            Ok(Some(value)) => return value,
            Ok(None) => unreachable!("the task is taken once, by the thread that runs it"),
            Err(_) if size > STACK[0] / 8 => size /= 4,
            Err(error) => {
                let Some(task) = take() else { unreachable!("no thread took the task: {error}") };
                return task(LEAST_STACK);
            }
        }
    }
}

/// What the main thread of a program may be trusted to have left.
const LEAST_STACK: usize = 1 << 20;
