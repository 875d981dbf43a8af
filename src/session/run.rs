//! Evaluation from text to scene: reading, resolving and running, on a stack that is deep enough for recursion.

use super::answer::Answer;
use super::{Evaluated, Options};
use crate::diag::{Code, Diagnostic, Sink, SourceMap};
use crate::lang::eval::{self, Attempts, Run};
use crate::lang::limits::{Limits, exceeded};
use crate::lang::resolve::load::{Files, Reading};
use crate::lang::resolve::{Setting, resolve};
use crate::scene::Scene;
use crate::scene::assets::Loader;
use crate::syntax::ast;
use crate::syntax::build::{ParseLimits, parse_expression};
use std::path::Path;
use std::rc::Rc;
use std::sync::Mutex;

/// What is evaluated.
pub(super) enum Root<'a> {
    /// A file, by its path.
    File(&'a Path),
    /// A text, as if it stood in the file of this path.
    Text(&'a Path, &'a str),
    /// No scene: an expression alone.
    Nothing,
}

/// What evaluation gives beside what every caller wants.
pub(super) struct Outcome {
    pub evaluated: Evaluated,
    pub attempts: Attempts,
    pub answer: Option<Answer>,
}

/// Evaluates a scene, and a question in its scope.
pub(super) fn evaluate(
    sources: &mut SourceMap,
    options: &Options,
    loader: &dyn Loader,
    root: Root<'_>,
    question: Option<&str>,
) -> Outcome {
    on_deep_stack(&options.limits, |stack| {
        let mut sink = Sink::default();
        let mut reading = Reading::new(loader, sources, options.limits, &mut sink);
        let read = match root {
            Root::File(path) => reading.root_file(path).is_some(),
            Root::Text(path, text) => {
                reading.root_text(path, text);
                true
            }
            Root::Nothing => true,
        };
        let files = reading.files;
        if !read {
            return empty(sink);
        }
        let question = question.map(|text| parse(sources, "expression", text, options, &mut sink));
        let set = settings(sources, options, &mut sink);
        match question {
            Some(None) => empty(sink),
            question => run(options, loader, files, &set, question.flatten().as_ref(), sink, stack),
        }
    })
}

fn empty(sink: Sink) -> Outcome {
    Outcome {
        evaluated: Evaluated {
            scene: Scene::default(),
            diagnostics: sink.into_sorted(),
            printed: Vec::new(),
        },
        attempts: Attempts { failed: true, setting: true },
        answer: None,
    }
}

fn run(
    options: &Options,
    loader: &dyn Loader,
    mut files: Files,
    set: &[(Rc<str>, ast::Expr)],
    question: Option<&ast::Expr>,
    mut sink: Sink,
    stack: usize,
) -> Outcome {
    let limits = options.limits;
    let time = (options.time, f64::from(options.frame));
    let setting = Setting { limits, set, time: time.0, frame: time.1 };
    let program = resolve(&files, &setting, question, &mut sink);
    files.forget_trees();
    let files = &files;
    let run = Run { program: &program, files, loader, limits, time, stack };
    let ran = eval::run(&run, &mut sink);
    Outcome {
        evaluated: Evaluated { scene: ran.scene, diagnostics: sink.into_sorted(), printed: ran.printed },
        attempts: ran.attempts,
        answer: ran.answer.as_ref().map(Answer::of),
    }
}

/// An expression of the command line, under a name of its own among the sources.
fn parse(
    sources: &mut SourceMap,
    name: &str,
    text: &str,
    options: &Options,
    sink: &mut Sink,
) -> Option<ast::Expr> {
    let id = sources.add(format!("<{name}>"), text);
    if text.len() as u64 > options.limits.file {
        let message = format!("the {name} has {} bytes", text.len());
        sink.push(exceeded(Code::FileTooLarge, None, message, "file", options.limits.file));
        return None;
    }
    let (expr, faults) = parse_expression(id, text, ParseLimits { depth: options.limits.nesting });
    sink.extend(faults);
    expr
}

fn settings(sources: &mut SourceMap, options: &Options, sink: &mut Sink) -> Vec<(Rc<str>, ast::Expr)> {
    let mut set = Vec::new();
    for (name, text) in &options.set {
        if let Some(expr) = parse(sources, &format!("--set {name}"), text, options, sink) {
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
fn on_deep_stack<T: Send>(limits: &Limits, task: impl FnOnce(usize) -> T + Send) -> T {
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

impl From<Diagnostic> for Outcome {
    /// Nothing but a fault.
    fn from(fault: Diagnostic) -> Outcome {
        let mut sink = Sink::default();
        sink.push(fault);
        empty(sink)
    }
}
