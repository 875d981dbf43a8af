//! Arithmetic as a straight line of steps, beside the tree that it was written as: what loops and functions compute over and over takes no
//! call from node to node. Knows nothing of faults: where a step has no number, the tree says why.

use super::program::{Access, Arithmetic, Expr, ExprKind};
use crate::lang::table::BuiltinBody;
use std::cell::Cell;

/// Registers that the sources of a line may take: the first. Those of its steps follow.
pub const SOURCES: usize = 32;

/// Steps of a line, at most: a tree keeps the line of each of its nodes. What is longer stays a tree, of lines that are shorter.
pub const STEPS: usize = 64;

/// Arithmetic that calls nothing that the scene declares.
#[derive(Debug)]
pub struct Straight {
    /// Its steps.
    pub line: Line,
    /// How many times more the line is passed over, because it failed: names that hold vectors will mostly do so again.
    pub passes: Cell<u8>,
    /// As it was written: what is computed instead where a source holds no number, or something has no finite value.
    pub tree: Expr,
}

/// Steps in a line.
#[derive(Clone, Debug, Default)]
pub struct Line {
    /// What is read before the first step, each into the register of its place.
    pub sources: Vec<Source>,
    /// In order. Each leaves its value in a register of its own, after those of the sources; the last one's is the result.
    pub steps: Vec<Step>,
}

/// Where a number comes from.
#[derive(Clone, Copy, Debug)]
pub enum Source {
    /// It is known.
    Number(f64),
    /// A name's value.
    Name(Access),
    /// A component of a name's value, which is a 3-vector.
    Component(Access, u8),
}

/// A step, on the values of registers.
#[derive(Clone, Copy, Debug)]
pub enum Step {
    /// `a + b`
    Add(Register, Register),
    /// `a - b`
    Subtract(Register, Register),
    /// `a * b`
    Multiply(Register, Register),
    /// `a / b`
    Divide(Register, Register),
    /// `a + x`
    AddNumber(Register, f64),
    /// `a * x`
    MultiplyNumber(Register, f64),
    /// `a % b`
    Remainder(Register, Register),
    /// `a ^ b`
    Power(Register, Register),
    /// `-a`
    Negate(Register),
    /// A function of one number.
    Call(fn(f64) -> f64, Register),
    /// A function of two numbers.
    CallTwo(fn(f64, f64) -> f64, Register, Register),
}

/// The number of a register.
pub type Register = u8;

/// An expression beside its line, where it has one.
pub(super) fn beside(tree: Expr) -> Expr {
    match compound(&tree.kind).filter(Line::fits) {
        Some(line) => {
            let span = tree.span;
            Expr { kind: ExprKind::Straight(Box::new(Straight { line, passes: Cell::new(0), tree })), span }
        }
        None => tree,
    }
}

fn compound(kind: &ExprKind) -> Option<Line> {
    match kind {
        ExprKind::Arithmetic(op, operands) => arithmetic(*op, &operands.0, &operands.1),
        ExprKind::CallBuiltin(call) => match (&call.builtin.body, &call.arguments[..]) {
            (BuiltinBody::Number2(f), [(0, a), (1, b)]) => two(a, b, |a, b| Step::CallTwo(*f, a, b)),
            _ => None,
        },
        ExprKind::CallNumber(_, f, argument) => one(argument, |a| Step::Call(*f, a)),
        ExprKind::Negate(negated) => one(negated, Step::Negate),
        _ => None,
    }
}

/// A number beside something is kept in the step.
fn arithmetic(op: Arithmetic, left: &Expr, right: &Expr) -> Option<Line> {
    match (op, &left.kind, &right.kind) {
        (Arithmetic::Add, _, ExprKind::Number(x)) => one(left, |a| Step::AddNumber(a, *x)),
        (Arithmetic::Add, ExprKind::Number(x), _) => one(right, |b| Step::AddNumber(b, *x)),
        (Arithmetic::Subtract, _, ExprKind::Number(x)) => one(left, |a| Step::AddNumber(a, -x)),
        (Arithmetic::Multiply, _, ExprKind::Number(x)) => one(left, |a| Step::MultiplyNumber(a, *x)),
        (Arithmetic::Multiply, ExprKind::Number(x), _) => one(right, |b| Step::MultiplyNumber(b, *x)),
        (Arithmetic::Add, ..) => two(left, right, Step::Add),
        (Arithmetic::Subtract, ..) => two(left, right, Step::Subtract),
        (Arithmetic::Multiply, ..) => two(left, right, Step::Multiply),
        (Arithmetic::Divide, ..) => two(left, right, Step::Divide),
        (Arithmetic::Remainder, ..) => two(left, right, Step::Remainder),
        (Arithmetic::Power, ..) => two(left, right, Step::Power),
    }
}

fn one(a: &Expr, step: impl Fn(Register) -> Step) -> Option<Line> {
    let mut line = Line::default();
    let a = line.take(a)?;
    line.steps.push(step(a));
    Some(line)
}

fn two(a: &Expr, b: &Expr, step: impl Fn(Register, Register) -> Step) -> Option<Line> {
    let mut line = Line::default();
    let (a, b) = (line.take(a)?, line.take(b)?);
    line.steps.push(step(a, b));
    Some(line)
}

impl Line {
    /// Takes in what computes an operand; its register.
    fn take(&mut self, e: &Expr) -> Option<Register> {
        match &e.kind {
            ExprKind::Number(x) => Some(self.source(Source::Number(*x))),
            ExprKind::Name(access) => Some(self.source(Source::Name(*access))),
            ExprKind::Component(i @ 0..3, base) => match base.kind {
                ExprKind::Name(access) => Some(self.source(Source::Component(access, *i))),
                _ => None,
            },
            ExprKind::Straight(straight) => Some(self.append(&straight.line)),
            _ => None,
        }
    }

    /// The register of a source: names are read once.
    fn source(&mut self, source: Source) -> Register {
        let same = |known: &Source| match (known, &source) {
            (Source::Name(a), Source::Name(b)) => a == b,
            (Source::Component(a, i), Source::Component(b, j)) => a == b && i == j,
            _ => false,
        };
        let place = self.sources.iter().position(same).unwrap_or_else(|| {
            self.sources.push(source);
            self.sources.len() - 1
        });
        place as Register
    }

    /// Takes in another line; the register of its result.
    fn append(&mut self, other: &Line) -> Register {
        let before = self.steps.len();
        let places: Vec<Register> = other.sources.iter().map(|source| self.source(*source)).collect();
        let moved = |register: Register| match places.get(usize::from(register)) {
            Some(place) => *place,
            None => register + before as Register,
        };
        self.steps.extend(other.steps.iter().map(|step| step.with_registers(moved)));
        (SOURCES + self.steps.len() - 1) as Register
    }

    fn fits(&self) -> bool {
        self.sources.len() <= SOURCES && self.steps.len() <= STEPS
    }
}

impl Step {
    /// The same step on other registers.
    fn with_registers(self, other: impl Fn(Register) -> Register) -> Step {
        match self {
            Step::Add(a, b) => Step::Add(other(a), other(b)),
            Step::Subtract(a, b) => Step::Subtract(other(a), other(b)),
            Step::Multiply(a, b) => Step::Multiply(other(a), other(b)),
            Step::Divide(a, b) => Step::Divide(other(a), other(b)),
            Step::AddNumber(a, x) => Step::AddNumber(other(a), x),
            Step::MultiplyNumber(a, x) => Step::MultiplyNumber(other(a), x),
            Step::Remainder(a, b) => Step::Remainder(other(a), other(b)),
            Step::Power(a, b) => Step::Power(other(a), other(b)),
            Step::Negate(a) => Step::Negate(other(a)),
            Step::Call(f, a) => Step::Call(f, other(a)),
            Step::CallTwo(f, a, b) => Step::CallTwo(f, other(a), other(b)),
        }
    }
}
