//! A tape without jumps made ready to run on points, several times as fast as step by step: flat steps that do not look for faults, and one
//! reduction for the sine and cosine of a number. It gives the same bits or gives up: where a number was not finite the tape is run again by
//! [`super::run`], which knows what is a fault and where.

use super::run::{self, SMALL};
use super::simplify::{each_read, written};
use super::{Binary, Field, Op, Register, Rule, Unary};
use crate::math::elementary::{cos, sin, sin_cos};

/// A tape of few registers takes less to set up.
const FEW: usize = 32;

/// The steps, for as many registers as they need.
#[derive(Clone, Debug)]
pub(super) enum Straight {
    Few(Box<Tape<FEW>>),
    Small(Box<Tape<SMALL>>),
}

/// For up to N registers, N a power of 2.
#[derive(Clone, Debug)]
pub(super) struct Tape<const N: usize> {
    initial: [f64; N],
    steps: Box<[Step]>,
    /// Registers that are finite only where all are that were computed on the way.
    telling: Box<[u8]>,
}

/// A step by its registers.
#[derive(Clone, Copy, Debug)]
struct Step {
    does: Does,
    to: u8,
    a: u8,
    b: u8,
}

/// What a step does with them.
#[derive(Clone, Copy, Debug)]
enum Does {
    Copy,
    Neg,
    Abs,
    Sqrt,
    Add,
    Sub,
    Mul,
    Div,
    Min,
    Max,
    Sin,
    Cos,
    /// Sine and, in `b`, cosine of `a`.
    Wave,
    /// Any other, of the field's step a + 256 b.
    Other,
}

impl Straight {
    /// Of a tape that has no jump, and writes no register twice.
    pub fn new(field: &Field) -> Option<Straight> {
        let mut n_writes = vec![0; field.initial.len()];
        n_writes[..field.n_inputs].fill(1);
        for op in field.ops.iter() {
            let (to, count) = written(op);
            n_writes[to.index()..to.index() + count].iter_mut().for_each(|n| *n += 1);
        }
        let is_small = field.initial.len() <= SMALL && field.ops.len() <= usize::from(u16::MAX);
        let is_plain = field.is_straight() && !field.ops.iter().any(|op| matches!(op, Op::Fault(_)));
        if !is_small || !is_plain || n_writes.iter().any(|n| *n > 1) {
            return None;
        }
        Some(if field.initial.len() <= FEW {
            Straight::Few(Box::new(Tape::new(field)))
        } else {
            Straight::Small(Box::new(Tape::new(field)))
        })
    }

    /// Whether the outputs are known now.
    #[inline]
    pub fn run(&self, field: &Field, inputs: &[f64], outputs: &mut [f64]) -> bool {
        match self {
            Straight::Few(tape) => tape.run(field, inputs, outputs),
            Straight::Small(tape) => tape.run(field, inputs, outputs),
        }
    }
}

impl<const N: usize> Tape<N> {
    fn new(field: &Field) -> Tape<N> {
        let mut initial = [0.0; N];
        initial[..field.initial.len()].copy_from_slice(&field.initial);
        Tape { initial, steps: steps(field), telling: telling(field) }
    }

    #[inline]
    fn run(&self, field: &Field, inputs: &[f64], outputs: &mut [f64]) -> bool {
        let mut r = self.initial;
        r[..field.n_inputs].copy_from_slice(&inputs[..field.n_inputs]);
        let at = |register: u8| usize::from(register) & (N - 1);
        for step in &self.steps {
            let (x, y) = (r[at(step.a)], r[at(step.b)]);
            r[at(step.to)] = match step.does {
                Does::Copy => x,
                Does::Neg => -x,
                Does::Abs => x.abs(),
                Does::Sqrt => x.sqrt(),
                Does::Add => x + y,
                Does::Sub => x - y,
                Does::Mul => x * y,
                Does::Div => x / y,
                Does::Min => x.min(y),
                Does::Max => x.max(y),
                Does::Sin => sin(x),
                Does::Cos => cos(x),
                Does::Wave => {
                    let (sine, cosine) = sin_cos(x);
                    r[at(step.b)] = cosine;
                    sine
                }
                Does::Other => {
                    let op = field.ops[usize::from(step.a) + (usize::from(step.b) << 8)];
                    if run::step(field, op, &mut r).is_err() {
                        return false;
                    }
                    continue;
                }
            };
        }
        let is_known = self.telling.iter().all(|register| r[at(*register)].is_finite());
        if is_known {
            for (output, register) in outputs.iter_mut().zip(field.outputs.iter()) {
                *output = r[register.index() & (N - 1)];
            }
        }
        is_known
    }
}

fn narrow(register: Register) -> u8 {
    register.0 as u8
}

fn steps(field: &Field) -> Box<[Step]> {
    let ops = field.ops.iter().enumerate();
    ops.filter_map(|(i, op)| match *op {
        // What it asks is asked in the end.
        Op::CheckFinite(_) => None,
        Op::Unary(op, to, a) => Some(unary(op).map_or(other(i), |does| does.step(to, a, a))),
        Op::Binary(op, to, a, b) => Some(binary(op).map_or(other(i), |does| does.step(to, a, b))),
        Op::Call1(_, rule @ (Rule::Sin | Rule::Cos), to, a) => wave(field, i, rule, to, a),
        _ => Some(other(i)),
    })
    .collect()
}

fn other(number: usize) -> Step {
    let [a, b] = (number as u16).to_le_bytes();
    Step { does: Does::Other, to: 0, a, b }
}

fn unary(op: Unary) -> Option<Does> {
    match op {
        Unary::Copy => Some(Does::Copy),
        Unary::Neg => Some(Does::Neg),
        Unary::Abs => Some(Does::Abs),
        Unary::Sqrt => Some(Does::Sqrt),
        Unary::Not | Unary::Floor | Unary::Ceil => None,
    }
}

fn binary(op: Binary) -> Option<Does> {
    match op {
        Binary::Add => Some(Does::Add),
        Binary::Sub => Some(Does::Sub),
        Binary::Mul => Some(Does::Mul),
        Binary::Div => Some(Does::Div),
        Binary::Min => Some(Does::Min),
        Binary::Max => Some(Does::Max),
        Binary::Rem | Binary::Pow => None,
        Binary::Less | Binary::LessEqual | Binary::Equal | Binary::NotEqual => None,
    }
}

/// A sine or a cosine: both with the first of the two, where both are asked for.
fn wave(field: &Field, i: usize, rule: Rule, to: Register, a: Register) -> Option<Step> {
    let find = |asked: Rule| {
        field.ops.iter().enumerate().find_map(|(i, op)| match *op {
            Op::Call1(_, rule, to, of) if rule == asked && of == a => Some((i, to)),
            _ => None,
        })
    };
    match (find(Rule::Sin), find(Rule::Cos)) {
        (Some((j, s)), Some((k, c))) if i == j.min(k) => Some(Does::Wave.step(s, a, c)),
        (Some((j, _)), Some((k, _))) if i == j.max(k) => None,
        _ if rule == Rule::Sin => Some(Does::Sin.step(to, a, a)),
        _ => Some(Does::Cos.step(to, a, a)),
    }
}

impl Does {
    fn step(self, to: Register, a: Register, b: Register) -> Step {
        Step { does: self, to: narrow(to), a: narrow(a), b: narrow(b) }
    }
}

/// Results that must be finite for all to be: others go into sums and products, which are not finite either where these are not.
fn telling(field: &Field) -> Box<[u8]> {
    let mut is_told = vec![false; field.initial.len()];
    let mut telling: Vec<u8> = Vec::new();
    for op in field.ops.iter().rev() {
        let (to, count) = written(op);
        telling.extend((to.index()..to.index() + count).filter(|r| !is_told[*r]).map(|r| r as u8));
        match *op {
            Op::Unary(Unary::Copy | Unary::Neg | Unary::Abs | Unary::Sqrt, _, a)
            | Op::Binary(Binary::Div, _, a, _)
            | Op::Call1(_, Rule::Sin | Rule::Cos, _, a) => is_told[a.index()] = true,
            Op::Binary(Binary::Add | Binary::Sub | Binary::Mul, ..) => {
                each_read(op, |r| is_told[r.index()] = true);
            }
            Op::CheckFinite(a) => telling.push(narrow(a)),
            _ => {}
        }
    }
    telling.sort_unstable();
    telling.dedup();
    telling.into()
}
