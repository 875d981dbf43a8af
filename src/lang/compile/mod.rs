//! Functions of the scene to tapes ([`crate::math::field`]), so that they run while rendering on any thread.
//!
//! The function's tree is walked once with symbols in the place of values: what is known when the function is made (captured
//! values, constants, what follows from them) is computed here, the rest becomes steps of the tape. Vectors are numbers in a
//! row; choices and loops become jumps, unless what they turn on is known; calls are written out in place.

mod calls;
mod expressions;
mod items;
mod lists;
mod members;
mod symbol;

use super::eval::slots::{Captured, Empty, Slot};
use super::resolve::program::{Function, FunctionBody, FunctionId, Program};
use super::table::{Context, Gives, Reported};
use super::value::Value;
use crate::diag::{Code, Diagnostic, Frame as TraceFrame, Span};
use crate::math::field::{FieldBuilder, Register};
use crate::scene::{SampleInput, SampledFunction};
use std::collections::HashMap;
use std::rc::Rc;
use symbol::{CapturedSymbol, Symbol};

/// A function to compile, and what it is for.
pub struct Request<'r> {
    /// The function value.
    pub function: &'r Value,
    /// What its inputs are.
    pub input: SampleInput,
    /// What it is to give.
    pub gives: Gives<'r>,
    /// Where it was given.
    pub at: Span,
}

/// Where the values are that a function sees.
pub trait Host: Context {
    /// A name of a unit's top level.
    fn global(&self, slot: u32) -> Slot;
}

/// Compiles a function. Reports why it cannot be.
pub fn compile(
    host: &mut dyn Host,
    program: &Program,
    request: &Request<'_>,
) -> Result<SampledFunction, Reported> {
    let n_inputs = match request.input {
        SampleInput::Point => 3,
        SampleInput::Uv => 2,
        SampleInput::Hit => 9,
    };
    let mut compiler = Compiler {
        host,
        program,
        builder: FieldBuilder::new(n_inputs),
        sites: Vec::new(),
        site_of: HashMap::new(),
        frames: Vec::new(),
        n_frames: 0,
        n_branches: 0,
        n_turns: 0,
    };
    match compiler.whole(request) {
        Ok((registers, span)) => {
            let Compiler { builder, sites, host, .. } = compiler;
            match builder.finish(&registers) {
                Ok(field) => Ok(SampledFunction { field, input: request.input, span, sites }),
                Err(error) => Err(host.fail(Diagnostic::new(Code::NotSampled, span, error.to_string()))),
            }
        }
        Err(Stop::Silent) => Err(Reported),
        Err(Stop::Say(diagnostic)) => {
            let mut said = *diagnostic;
            let at = request.at;
            let inside = |s: Span| s.source == at.source && at.start <= s.start && s.end <= at.end;
            if !said.span.is_some_and(inside) {
                said = said.also(request.at, "a function that runs while rendering is expected here");
            }
            Err(compiler.host.fail(said))
        }
    }
}

/// Why compilation stopped.
enum Stop {
    /// To be reported.
    Say(Box<Diagnostic>),
    /// Reported already.
    Silent,
}

impl From<Box<Diagnostic>> for Stop {
    fn from(diagnostic: Box<Diagnostic>) -> Stop {
        Stop::Say(diagnostic)
    }
}

impl From<Diagnostic> for Stop {
    fn from(diagnostic: Diagnostic) -> Stop {
        Stop::Say(Box::new(diagnostic))
    }
}

impl From<Reported> for Stop {
    fn from(_: Reported) -> Stop {
        Stop::Silent
    }
}

type Compiled<T = Symbol> = Result<T, Stop>;

/// What a running function captured.
#[derive(Clone)]
enum Captures {
    Values(Option<Rc<Captured>>),
    Symbols(Rc<Vec<CapturedSymbol>>),
}

/// A function that is being written out.
struct Frame {
    /// Distinguishes it from those that stood at its place before.
    id: usize,
    function: FunctionId,
    /// The call.
    span: Span,
    slots: Vec<Option<Symbol>>,
    captures: Captures,
    /// Where `return` leads, once one stands inside a branch.
    result: Option<items::ReturnPlace>,
    /// The innermost branch that only some samples take, by its number; 0 is none.
    branch: usize,
    /// The branch that each slot was bound in.
    bound_in: Vec<usize>,
}

struct Compiler<'c> {
    host: &'c mut dyn Host,
    program: &'c Program,
    builder: FieldBuilder,
    sites: Vec<Span>,
    site_of: HashMap<Span, u32>,
    frames: Vec<Frame>,
    n_frames: usize,
    n_branches: usize,
    /// Elements of lists and ranges that were gone through so far.
    n_turns: usize,
}

/// Calls that may stand inside one another: a recursion that ends when the function is made is written out, up to here.
const DEEPEST: usize = 64;

/// Elements of lists and ranges that may be gone through while a tape is made.
const MOST_TURNS: usize = 1 << 20;

/// Steps of one tape.
const LONGEST: usize = 1 << 16;

impl<'c> Compiler<'c> {
    fn whole(&mut self, request: &Request<'_>) -> Compiled<(Vec<Register>, Span)> {
        let arguments = self.inputs(request.input);
        let (symbol, span) = match request.function {
            Value::Function(closure) => {
                let span = self.program.functions[closure.function.0 as usize].span;
                let captures = Captures::Values(closure.captured.clone());
                (self.enter(closure.function, captures, arguments, request.at)?, span)
            }
            Value::Builtin(builtin) => (self.builtin(builtin, arguments, &[], request.at)?, request.at),
            _ => {
                return Err(Diagnostic::new(
                    Code::NotSampled,
                    request.at,
                    "only a function runs while rendering",
                )
                .into());
            }
        };
        let span = self.result_span(request).unwrap_or(span);
        let (registers, fits) = match request.gives {
            Gives::Components(counts) => (self.components(&symbol), counts),
            Gives::List(count) => (self.numbers(&symbol), &[count][..]),
        };
        match registers {
            Some(registers) if fits.contains(&registers.len()) => Ok((registers, span)),
            _ => Err(self.wrong_result(request, &symbol, span)),
        }
    }

    fn inputs(&mut self, input: SampleInput) -> Vec<Symbol> {
        let number = |i: usize| self.builder.input(i);
        match input {
            SampleInput::Point => vec![Symbol::Vector((0..3).map(number).collect())],
            SampleInput::Uv => vec![Symbol::Number(number(0)), Symbol::Number(number(1))],
            SampleInput::Hit => vec![Symbol::Record(Rc::new(vec![
                ("p", Symbol::Vector((0..3).map(number).collect())),
                ("n", Symbol::Vector((3..6).map(number).collect())),
                ("uv", Symbol::Vector((6..8).map(number).collect())),
                ("t", Symbol::Number(number(8))),
            ]))],
        }
    }

    /// The place of the expression that gives the function's value.
    fn result_span(&self, request: &Request<'_>) -> Option<Span> {
        let Value::Function(closure) = request.function else { return None };
        match &self.program.functions[closure.function.0 as usize].body {
            FunctionBody::Expr(e) => Some(e.span),
            FunctionBody::Items(_) => None,
        }
    }

    fn wrong_result(&mut self, request: &Request<'_>, symbol: &Symbol, span: Span) -> Stop {
        let word = |n: &usize| match n {
            1 => "a number",
            2 => "a 2-vector",
            3 => "a colour or 3-vector",
            _ => "a 4-vector",
        };
        let wanted = match request.gives {
            Gives::Components(counts) => counts.iter().map(word).collect::<Vec<_>>().join(" or "),
            Gives::List(count) => format!("a list of {count} numbers"),
        };
        let message = format!("this function gives {}, where {wanted} is needed", symbol.shown());
        Diagnostic::new(Code::NotSampled, span, message).into()
    }

    /// The builder, with the place of the steps that follow.
    fn at(&mut self, span: Span) -> &mut FieldBuilder {
        let next = self.sites.len() as u32;
        let site = *self.site_of.entry(span).or_insert(next);
        if site == next {
            self.sites.push(span);
        }
        self.builder.site(site);
        &mut self.builder
    }

    fn frame(&mut self) -> &mut Frame {
        self.frames.last_mut().expect("expressions are compiled inside a function")
    }

    fn function(&self, id: FunctionId) -> &'c Function {
        &self.program.functions[id.0 as usize]
    }

    /// A fault that keeps a function from running while rendering, with the calls that led to it.
    fn refuse(&self, code: Code, span: Span, message: impl Into<String>) -> Diagnostic {
        let frames = self.frames.iter().rev().map(|frame| TraceFrame {
            span: frame.span,
            text: match &self.function(frame.function).name {
                Some(name) => format!("`{name}(…)`"),
                None => "`… => …`".into(),
            },
        });
        let calls = self.frames.len().saturating_sub(1);
        Diagnostic::new(code, span, message).trace(frames.take(calls.min(8)).collect())
    }

    /// What a slot of the evaluator holds.
    fn slot_value(&mut self, slot: &Slot, span: Span) -> Compiled {
        match slot.read() {
            Ok(value) => Ok(Symbol::Known(value)),
            Err(Empty::Poison) => Err(Stop::Silent),
            Err(Empty::Unset) => Err(self
                .refuse(Code::UsedBeforeSet, span, "this name has no value yet when the function is made")
                .hint("move its definition above the place where the function is used")
                .into()),
        }
    }
}
