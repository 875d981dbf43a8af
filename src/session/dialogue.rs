//! A scope that stays: lines are evaluated in it one after another, as the REPL wants it. A line that fails changes nothing.
//!
//! A program grows with each line: names, functions and files of earlier lines are known to later ones by their slots, and
//! no line is evaluated twice. What a failed line made is cut off again. Knows nothing of terminals.

use super::answer::Answer;
use super::run::{self, Means, Root, State, on_deep_stack};
use super::trace::Tracer;
use super::{Options, Session};
use crate::diag::{Code, Diagnostic, Sink, SourceId, SourceMap, Span};
use crate::lang;
use crate::lang::coerce;
use crate::lang::complete::{self, Visible};
use crate::lang::eval;
use crate::lang::limits::exceeded;
use crate::lang::resolve::known::{Names, Sort};
use crate::lang::resolve::load::FileId;
use crate::lang::resolve::program::Program;
use crate::lang::value::Value;
use crate::scene::Scene;
use crate::scene::assets::Loader;
use crate::syntax::ast;
use crate::syntax::build::{ParseLimits, parse_expression, parse_file};
use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;

/// Something that is said in answer to a line.
#[derive(Clone, Debug, PartialEq)]
pub enum Said {
    /// By `print`.
    Printed(String),
    /// The value of an expression.
    Answer(Answer),
    /// What the number answered last may be off by.
    Within(f64),
}

/// What becomes of a line.
#[derive(Debug, Default)]
pub struct Reply {
    /// What it said, in order; also what a line said that failed later on.
    pub said: Vec<Said>,
    /// All that is wrong with it, in source order.
    pub diagnostics: Vec<Diagnostic>,
    /// It failed, and nothing has changed.
    pub failed: bool,
    /// It was asked to end before it was done, and nothing has changed.
    pub interrupted: bool,
}

impl Reply {
    /// Adds what became of something that followed.
    pub fn join(&mut self, next: Reply) {
        self.said.extend(next.said);
        self.diagnostics.extend(next.diagnostics);
        self.failed |= next.failed;
        self.interrupted |= next.interrupted;
    }

    /// The last value that was answered.
    pub fn answer(&self) -> Option<&Answer> {
        self.said.iter().rev().find_map(|said| match said {
            Said::Answer(answer) => Some(answer),
            Said::Printed(_) | Said::Within(_) => None,
        })
    }
}

/// The name under which diagnostics show the lines of a dialogue.
const LINES: &str = "repl";

/// A scope that stays.
pub struct Dialogue<'s> {
    sources: &'s mut SourceMap,
    options: &'s Options,
    loader: &'s dyn Loader,
    cancel: Option<&'s AtomicBool>,
    stack: usize,
    state: State,
    scene: Scene,
    loaded: Vec<PathBuf>,
}

impl Session {
    /// Opens a scope that stays and works with it, on a stack that is deep enough for recursion. A line that is being
    /// evaluated ends soon after `cancel` is set.
    pub fn dialogue<T: Send>(
        &mut self,
        cancel: Option<&AtomicBool>,
        work: impl FnOnce(&mut Dialogue<'_>) -> T + Send,
    ) -> T {
        let Session { sources, options, loader } = self;
        on_deep_stack(&options.limits, |stack| {
            work(&mut Dialogue {
                sources,
                options,
                loader: &**loader,
                cancel,
                stack,
                state: State::default(),
                scene: Scene::default(),
                loaded: Vec::new(),
            })
        })
    }
}

/// What stays of a step.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Keeping {
    /// Everything, where nothing failed.
    Whole,
    /// What could be made.
    Parts,
    /// Nothing: it was only to look at.
    Nothing,
}

/// The value of an expression, while the program that made it still stands.
pub(super) struct Look<'l, 'm> {
    pub state: &'l mut State,
    pub means: &'l Means<'m>,
    pub value: &'l Value,
    /// The expression.
    pub span: Span,
    pub sink: &'l mut Sink,
}

impl Dialogue<'_> {
    /// Every text that was read, for diagnostics.
    pub fn sources(&self) -> &SourceMap {
        self.sources
    }

    /// What the lines and files have placed so far.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// The names of all earlier items, in alphabetical order.
    pub fn names(&self) -> Vec<&str> {
        self.state.known.names().into_iter().map(|(name, _)| name).collect()
    }

    /// What completion may offer beside the tables.
    pub fn visible(&self) -> Visible {
        let known = &self.state.known;
        let member = |(name, sort): (&str, Sort)| {
            let members = match sort {
                Sort::Module => known.members_of(name)?.into_iter().map(str::to_owned).collect(),
                Sort::Value(slot) | Sort::Var(slot) | Sort::Function(slot) => {
                    members(&self.state.standing.globals.get(slot as usize)?.read().ok()?)
                }
            };
            Some((name.to_owned(), members))
        };
        Visible {
            names: self.names().into_iter().map(str::to_owned).collect(),
            members: known.names().into_iter().filter_map(member).collect(),
        }
    }

    /// Evaluates a file as if its items stood here; it is read anew, and so are its imports. `-` is standard input.
    pub fn file(&mut self, path: &Path) -> Reply {
        let reply = self.load(path, Keeping::Whole);
        if !reply.failed && !self.loaded.iter().any(|loaded| loaded == path) {
            self.loaded.push(path.to_owned());
        }
        reply
    }

    /// The same, but what could be made of a faulty file stays. Uses of a name that has no value then are silent.
    pub fn part_of_file(&mut self, path: &Path) -> Reply {
        self.loaded.push(path.to_owned());
        self.load(path, Keeping::Parts)
    }

    /// Reads all files of [`Dialogue::file`] again, into an empty scope. Where one fails, nothing changes.
    pub fn reload(&mut self) -> Reply {
        let before = (std::mem::take(&mut self.state), std::mem::take(&mut self.scene));
        let mut whole = Reply::default();
        for path in self.loaded.clone() {
            whole.join(self.load(&path, Keeping::Whole));
        }
        if whole.failed {
            (self.state, self.scene) = before;
        }
        whole
    }

    /// Evaluates the items of a text, which stands after `first_line` others. Those that are expressions are answered with
    /// their values; objects and lights among these are placed too.
    pub fn line(&mut self, text: &str, first_line: usize) -> Reply {
        self.step(Keeping::Whole, |state, means, sink| {
            let id = means.sources.add_from(format!("<{LINES}>"), text, first_line);
            let limits = means.options.limits;
            if text.len() as u64 > limits.file {
                let message = format!("the line has {} bytes", text.len());
                sink.push(exceeded(Code::FileTooLarge, None, message, "file", limits.file));
                return None;
            }
            let (tree, faults) = parse_line(id, text, ParseLimits { depth: limits.nesting, answers: true });
            sink.extend(faults);
            let file = state.reading(means, sink).root_tree(Path::new(""), id, tree);
            answer(state, means, file, &run::Settings::new(), sink)
        })
    }

    /// The sort of an expression's value in words; evaluating it changes nothing.
    pub fn sort_of(&mut self, text: &str, first_line: usize) -> (Option<String>, Reply) {
        self.look((text, text), first_line, |look| Some(sort_of(look.value, &look.state.known.program)))
    }

    /// Evaluates an expression, looks at its value, and takes everything back. The second text is what diagnostics show.
    pub(super) fn look<R>(
        &mut self,
        text: (&str, &str),
        first_line: usize,
        look: impl FnOnce(&mut Look<'_, '_>) -> Option<R>,
    ) -> (Option<R>, Reply) {
        let mut seen = None;
        let reply = self.step(Keeping::Nothing, |state, means, sink| {
            let expr = run::parse_shown(means, LINES, text, first_line, sink)?;
            let span = expr.span;
            let file = state.reading(means, sink).root_tree(Path::new(""), span.source, one_placement(expr));
            let (names, mut ran) = answer(state, means, file, &run::Settings::new(), sink)?;
            let is_answer = |said: &eval::Said| matches!(said, eval::Said::Answer(_));
            if let Some(i) = ran.said.iter().rposition(is_answer)
                && let eval::Said::Answer(value) = ran.said.remove(i)
            {
                seen = look(&mut Look { state, means, value: &value, span, sink });
            }
            Some((names, ran))
        });
        (seen, reply)
    }

    /// Evaluates one expression and answers with its value.
    pub fn expression(&mut self, text: &str) -> Reply {
        let first = self.loaded.is_empty();
        self.step(Keeping::Whole, |state, means, sink| {
            let set = if first { run::settings(means, sink) } else { Vec::new() };
            let expr = run::parse(means, "expression", text, 0, sink)?;
            let (source, tree) = (expr.span.source, one_placement(expr));
            let file = state.reading(means, sink).root_tree(Path::new(""), source, tree);
            answer(state, means, file, &set, sink)
        })
    }

    fn load(&mut self, path: &Path, keeping: Keeping) -> Reply {
        self.step(keeping, |state, means, sink| {
            state.files.forget_paths();
            let file = state.read(means, &Root::File(path), sink)?;
            let set = run::settings(means, sink);
            let names = state.resolve(means, file, &set, sink);
            Some((names, state.run(means, None, sink)))
        })
    }

    /// Does one step, and takes back what it did where it failed.
    fn step(
        &mut self,
        keeping: Keeping,
        evaluate: impl FnOnce(&mut State, &mut Means<'_>, &mut Sink) -> Option<(Names, eval::Ran)>,
    ) -> Reply {
        let mut sink = Sink::default();
        let state = &mut self.state;
        let marks = (state.known.mark(), state.files.mark());
        state.standing.begin();
        let Dialogue { options, loader, cancel, stack, .. } = *self;
        let tracer = Tracer::new(loader, options.limits);
        let tracer = &tracer;
        let mut means = Means { sources: self.sources, options, loader, tracer, cancel, stack };
        let done = evaluate(state, &mut means, &mut sink);
        let interrupted = means.is_cancelled();
        let failed = sink.has_errors() || interrupted || done.is_none();
        let said = match done {
            Some((names, ran)) if keeping == Keeping::Parts || (!failed && keeping == Keeping::Whole) => {
                state.known.learn(names);
                state.standing.keep();
                place(&mut self.scene, ran.scene);
                ran.said
            }
            done => {
                state.standing.take_back();
                state.known.forget_since(marks.0);
                state.files.forget_since(marks.1);
                done.map_or(Vec::new(), |(_, ran)| ran.said)
            }
        };
        let diagnostics = if interrupted { Vec::new() } else { sink.into_sorted() };
        Reply { said: said.iter().map(Said::of).collect(), diagnostics, failed, interrupted }
    }
}

impl Said {
    fn of(said: &eval::Said) -> Said {
        match said {
            eval::Said::Printed(text) => Said::Printed(text.clone()),
            eval::Said::Answer(value) => Said::Answer(Answer::of(value)),
            eval::Said::Within(error) => Said::Within(*error),
        }
    }
}

/// Resolves and runs items; those with faults that can be told before are not run.
fn answer(
    state: &mut State,
    means: &Means<'_>,
    file: FileId,
    set: &run::Settings,
    sink: &mut Sink,
) -> Option<(Names, eval::Ran)> {
    let names = state.resolve(means, file, set, sink);
    if sink.has_errors() {
        return None;
    }
    Some((names, state.run(means, Some(file), sink)))
}

/// What stands behind a dot after a value.
fn members(value: &Value) -> Vec<String> {
    match lang::builtins::components(value) {
        Some((_, n)) if n > 1 => complete::LETTERS.into_iter().take(n).map(str::to_owned).collect(),
        _ => lang::members::names_of(value),
    }
}

/// The sort of a value in words; a function with its parameters.
fn sort_of(value: &Value, program: &Program) -> String {
    let names: Vec<String> = match value {
        Value::Function(closure) => {
            let parameters = program.functions[closure.function.0 as usize].parameters.iter();
            parameters
                .map(|p| format!("{}{}", p.name, if p.default.is_some() { " = …" } else { "" }))
                .collect()
        }
        Value::Builtin(builtin) => return format!("the function {}", builtin.form()),
        _ => return coerce::sort_of(value),
    };
    format!("a function of ({})", names.join(", "))
}

/// Adds what a step placed. A later `render` block replaces an earlier one.
fn place(scene: &mut Scene, more: Scene) {
    scene.nodes.extend(more.nodes);
    scene.cameras.extend(more.cameras);
    scene.figures.extend(more.figures);
    if more.render.span.is_some() {
        scene.render = more.render;
    }
}

/// A line's items. What would be a property or a block without a name is an expression where it can be one: `a -3`.
fn parse_line(id: SourceId, text: &str, limits: ParseLimits) -> (ast::File, Vec<Diagnostic>) {
    let (tree, faults) = parse_file(id, text, limits);
    let may_be_value = match &tree.items[..] {
        [ast::Item { kind: ast::ItemKind::Property(property), .. }] => !property.values.is_empty(),
        [ast::Item { kind: ast::ItemKind::Block(block), .. }] => block.label.is_none(),
        _ => false,
    };
    if may_be_value
        && let (Some(expr), found) = parse_expression(id, text, limits)
        && found.is_empty()
    {
        return (one_placement(expr), Vec::new());
    }
    (tree, faults)
}

fn one_placement(expr: ast::Expr) -> ast::File {
    let span = expr.span;
    ast::File { items: vec![ast::Item { kind: ast::ItemKind::Placement(expr), span }], span }
}
