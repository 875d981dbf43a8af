//! Running a tape on intervals: everything that its first output and the output's derivatives can be over a box of inputs.
//!
//! Values and derivatives are carried forward side by side (Moore, Kearfott & Cloud, *Introduction to Interval Analysis*, ch. 6).
//! Where a jump of the tape is not decided by the intervals both ways are run and joined, and the result says that it may jump
//! ([`Interval::gaps`]); so does whatever may be undefined.

use super::rules;
use super::{Binary, FaultKind, Field, Op, Register, Unary};
use crate::math::interval::{Gaps, Interval};

/// All values of something, and all of its derivatives along N directions.
#[derive(Clone, Copy, Debug)]
pub struct Enclosed<const N: usize> {
    /// Every value. `gaps` where it may jump or be undefined; then the derivatives are those of the parts.
    pub value: Interval,
    /// Every derivative.
    pub slope: [Interval; N],
}

const ZERO: Interval = Interval::new(0.0, 0.0);

impl<const N: usize> Enclosed<N> {
    /// A number that does not change.
    pub const fn constant(x: f64) -> Self {
        Enclosed { value: Interval::point(x), slope: [ZERO; N] }
    }

    /// Any value with any jump.
    pub const ANYTHING: Self = Enclosed {
        value: Interval { gaps: Gaps::ANY, ..Interval::WHOLE },
        slope: [Interval { gaps: Gaps::ANY, ..Interval::WHOLE }; N],
    };

    /// No value.
    pub const NOTHING: Self = Enclosed { value: Interval::EMPTY, slope: [ZERO; N] };

    /// Of one part or the other: all that both can be, with a jump between.
    pub(super) fn either(self, other: Self) -> Self {
        let value = self.value.hull(other.value).with_gaps(Gaps::JUMPS);
        Enclosed { value, slope: std::array::from_fn(|i| self.slope[i].hull(other.slope[i])) }
    }

    pub(super) fn with_gaps(self, gaps: Gaps) -> Self {
        Enclosed { value: self.value.with_gaps(gaps), ..self }
    }

    /// A value whose derivative is d times this one's.
    pub(super) fn chain(&self, value: Interval, d: Interval) -> Self {
        Enclosed { value, slope: self.slope.map(|s| times(s, d)) }
    }

    /// A value that is the same all around each point, but may jump.
    pub(super) fn flat(value: Interval) -> Self {
        Enclosed { value, slope: [ZERO; N] }
    }

    pub(super) fn neg(self) -> Self {
        Enclosed { value: -self.value, slope: self.slope.map(|s| -s) }
    }

    pub(super) fn add(&self, b: &Self) -> Self {
        Enclosed {
            value: self.value + b.value,
            slope: std::array::from_fn(|i| plus(self.slope[i], b.slope[i])),
        }
    }

    pub(super) fn sub(&self, b: &Self) -> Self {
        Enclosed {
            value: self.value - b.value,
            slope: std::array::from_fn(|i| plus(self.slope[i], -b.slope[i])),
        }
    }

    pub(super) fn mul(&self, b: &Self) -> Self {
        let slope = |i: usize| plus(times(self.slope[i], b.value), times(b.slope[i], self.value));
        Enclosed { value: self.value * b.value, slope: std::array::from_fn(slope) }
    }

    pub(super) fn square(&self) -> Self {
        let twice = self.value + self.value;
        self.chain(self.value.square(), twice)
    }

    pub(super) fn div(&self, b: &Self) -> Self {
        let value = self.value / b.value;
        let slope = |i: usize| match (is_zero(self.slope[i]), is_zero(b.slope[i])) {
            (true, true) => ZERO,
            (false, true) => self.slope[i] / b.value,
            _ => plus(self.slope[i], -times(b.slope[i], value)) / b.value,
        };
        Enclosed { value, slope: std::array::from_fn(slope) }
    }

    pub(super) fn abs(&self) -> (Self, Choice) {
        if self.value.lo >= 0.0 {
            return (*self, Choice::First);
        }
        let negative = self.neg();
        if self.value.hi <= 0.0 {
            return (negative, Choice::Second);
        }
        let slope = std::array::from_fn(|i| self.slope[i].hull(negative.slope[i]));
        (Enclosed { value: self.value.abs(), slope }, Choice::Both)
    }

    pub(super) fn min(&self, b: &Self) -> (Self, Choice) {
        if self.value.hi <= b.value.lo {
            return (*self, Choice::First);
        }
        if b.value.hi <= self.value.lo {
            return (*b, Choice::Second);
        }
        (Enclosed { value: self.value.min(b.value), ..self.hull_slopes(b) }, Choice::Both)
    }

    pub(super) fn max(&self, b: &Self) -> (Self, Choice) {
        if self.value.lo >= b.value.hi {
            return (*self, Choice::First);
        }
        if b.value.lo >= self.value.hi {
            return (*b, Choice::Second);
        }
        (Enclosed { value: self.value.max(b.value), ..self.hull_slopes(b) }, Choice::Both)
    }

    fn hull_slopes(&self, b: &Self) -> Self {
        Enclosed { value: self.value, slope: std::array::from_fn(|i| self.slope[i].hull(b.slope[i])) }
    }

    pub(super) fn sqrt(&self) -> Self {
        let value = self.value.sqrt();
        self.chain(value, over_positive(value + value))
    }

    /// The same within bounds that are known otherwise.
    pub(super) fn within(self, bounds: Interval) -> Self {
        Enclosed { value: self.value.intersect(bounds), ..self }
    }
}

fn is_zero(a: Interval) -> bool {
    a.lo == 0.0 && a.hi == 0.0
}

/// a · b, exactly 0 where a is: rounding outward would make 0 a tiny interval that grows with every step.
pub(super) fn times(a: Interval, b: Interval) -> Interval {
    if is_zero(a) { ZERO } else { a * b }
}

/// a + b, with 0 exact.
pub(super) fn plus(a: Interval, b: Interval) -> Interval {
    if is_zero(a) {
        b
    } else if is_zero(b) {
        a
    } else {
        a + b
    }
}

/// 1 / a for an a that is not negative: without bound where it may be 0.
pub(super) fn over_positive(a: Interval) -> Interval {
    let hi = if a.lo > 0.0 { (1.0 / a.lo).next_up() } else { f64::INFINITY };
    Interval { lo: (1.0 / a.hi).next_down().max(0.0), hi, gaps: a.gaps }
}

/// Which of two an operation took all over the box.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Choice {
    /// Now the one, now the other; or the operation makes no choice.
    Both,
    /// The first; of an absolute value the number itself.
    First,
    /// The second; of an absolute value its negative.
    Second,
}

/// Jumps that one run may leave undecided, and turns that its loops may take, before it gives up and says "anything".
const UNDECIDED: u32 = 24;
const TURNS: u32 = 4096;

/// Runs a tape on intervals, again and again.
pub struct Encloser<'f, const N: usize> {
    field: &'f Field,
    registers: Vec<Enclosed<N>>,
    choices: Vec<Choice>,
    records: bool,
    undecided: u32,
    turns: u32,
    /// What it gives up after.
    most_undecided: u32,
    most_turns: u32,
}

impl<'f, const N: usize> Encloser<'f, N> {
    /// Of a tape with at least one output.
    pub fn new(field: &'f Field) -> Self {
        Encloser::reuse(field, Vec::new())
    }

    /// The same with memory that was used before.
    pub fn reuse(field: &'f Field, mut registers: Vec<Enclosed<N>>) -> Self {
        registers.clear();
        registers.extend(field.initial.iter().map(|&x| Enclosed::constant(x)));
        Encloser {
            field,
            registers,
            choices: Vec::new(),
            records: false,
            undecided: 0,
            turns: 0,
            most_undecided: UNDECIDED,
            most_turns: TURNS,
        }
    }

    /// The memory.
    pub fn into_memory(self) -> Vec<Enclosed<N>> {
        self.registers
    }

    /// All that the first output can be for these inputs.
    pub fn run(&mut self, inputs: &[Enclosed<N>]) -> Enclosed<N> {
        self.registers[..inputs.len()].copy_from_slice(inputs);
        (self.undecided, self.turns) = (0, 0);
        self.run_from(0)
    }

    /// The same, noting the choice of each step.
    pub fn run_choosing(&mut self, inputs: &[Enclosed<N>]) -> Enclosed<N> {
        self.choices.clear();
        self.choices.resize(self.field.ops.len(), Choice::Both);
        self.records = true;
        let result = self.run(inputs);
        self.records = false;
        result
    }

    /// The choices that [`Encloser::run_choosing`] noted; those of a tape with jumps are not known.
    pub fn choices(&self) -> &[Choice] {
        &self.choices
    }

    /// How many turns the loops of the last run took.
    pub fn turns(&self) -> u32 {
        self.turns
    }

    /// Whether the tape, at every point of these inputs, surely runs until its guard says no: nothing can be said of parts of them either.
    pub fn is_endless(mut self, inputs: &[Enclosed<N>]) -> bool {
        (self.most_undecided, self.most_turns) = (0, TURNS.max(self.field.turn_limit));
        self.run(inputs);
        self.turns > self.most_turns
    }

    fn run_from(&mut self, mut at: usize) -> Enclosed<N> {
        while let Some(&op) = self.field.ops.get(at) {
            let target = match op {
                Op::Jump(target) => Some(target),
                Op::JumpIfZero(condition, target) => match self.truth(condition) {
                    Some(true) => None,
                    Some(false) => Some(target),
                    None => return self.both_ways(condition, at + 1, target as usize),
                },
                Op::JumpIfNotZero(condition, target) => match self.truth(condition) {
                    Some(true) => Some(target),
                    Some(false) => None,
                    None => return self.both_ways(condition, at + 1, target as usize),
                },
                Op::Fault(_) => return Enclosed::NOTHING,
                _ => {
                    if self.step(at, op).is_err() {
                        return Enclosed::NOTHING;
                    }
                    None
                }
            };
            at = match target {
                None => at + 1,
                Some(target) => {
                    self.turns += u32::from(target as usize <= at);
                    if self.turns > self.most_turns {
                        return Enclosed::ANYTHING;
                    }
                    target as usize
                }
            };
        }
        self.get(self.field.outputs[0])
    }

    /// What a condition is all over the box, if it is one thing.
    fn truth(&self, condition: Register) -> Option<bool> {
        let value = self.get(condition).value;
        if !value.contains(0.0) {
            Some(true)
        } else if value.lo == 0.0 && value.hi == 0.0 {
            Some(false)
        } else {
            None
        }
    }

    fn both_ways(&mut self, condition: Register, one: usize, other: usize) -> Enclosed<N> {
        self.undecided += 1;
        if self.undecided > self.most_undecided {
            return Enclosed::ANYTHING;
        }
        let gaps = self.gaps(condition);
        let kept = self.registers.clone();
        let first = self.run_from(one);
        self.registers = kept;
        first.either(self.run_from(other)).with_gaps(gaps)
    }

    /// Those of what decides.
    fn gaps(&self, condition: Register) -> Gaps {
        self.get(condition).value.gaps
    }

    fn get(&self, register: Register) -> Enclosed<N> {
        self.registers[register.index()]
    }

    /// One step that does not jump; an error where it has no value at all.
    fn step(&mut self, at: usize, op: Op) -> Result<(), FaultKind> {
        let (to, result) = match op {
            Op::Unary(op, to, a) => (to, self.unary(at, op, self.get(a))),
            Op::Binary(op, to, a, b) => (to, self.binary(at, op, a, b)),
            Op::Select(to, condition, a, b) => {
                let chosen = match self.truth(condition) {
                    Some(true) => self.get(a),
                    Some(false) => self.get(b),
                    None => self.get(a).either(self.get(b)).with_gaps(self.gaps(condition)),
                };
                (to, chosen)
            }
            Op::Call1(f, rule, to, a) => (to, rules::call1(f, rule, &self.get(a))),
            Op::Call2(f, rule, to, a, b) => (to, rules::call2(f, rule, &self.get(a), &self.get(b))),
            Op::CallN { f, rule, from, n_from, to, n_to } => {
                let (arguments, results) = self.split(from, n_from, to, n_to);
                rules::call_n(f, rule, arguments, results);
                return Ok(());
            }
            Op::CallHeld { held, from, n_from, to, n_to } => {
                let held = &self.field.held[held as usize];
                let (arguments, results) = self.split(from, n_from, to, n_to);
                rules::unknown(arguments, results, |from, to| held.call(from, to));
                return Ok(());
            }
            Op::Table(to, index, table) => {
                let table = &self.field.tables[table as usize];
                (to, element(self.get(index).value, table.len(), |i| Enclosed::constant(table[i])))
            }
            Op::Gather { to, index, first, count } => {
                let list = &self.registers[first.index()..][..count as usize];
                (to, element(self.get(index).value, list.len(), |i| list[i]))
            }
            Op::CheckFinite(a) => {
                return if self.get(a).value.is_empty() { Err(FaultKind::Undefined) } else { Ok(()) };
            }
            Op::Jump(_) | Op::JumpIfZero(..) | Op::JumpIfNotZero(..) | Op::Fault(_) => return Ok(()),
        };
        self.registers[to.index()] = result;
        Ok(())
    }

    /// Arguments and results of a call, which are different registers.
    fn split(&mut self, from: Register, n: u8, to: Register, m: u8) -> (&[Enclosed<N>], &mut [Enclosed<N>]) {
        let (before, after) = self.registers.split_at_mut(to.index().max(from.index()));
        if from < to {
            (&before[from.index()..][..n as usize], &mut after[..m as usize])
        } else {
            (&after[..n as usize], &mut before[to.index()..][..m as usize])
        }
    }

    fn chosen(&mut self, at: usize, (result, choice): (Enclosed<N>, Choice)) -> Enclosed<N> {
        if self.records {
            self.choices[at] = choice;
        }
        result
    }

    fn unary(&mut self, at: usize, op: Unary, a: Enclosed<N>) -> Enclosed<N> {
        match op {
            Unary::Copy => a,
            Unary::Neg => a.neg(),
            Unary::Abs => self.chosen(at, a.abs()),
            Unary::Sqrt => a.sqrt(),
            Unary::Floor => Enclosed::flat(a.value.floor()),
            Unary::Ceil => Enclosed::flat(-(-a.value).floor()),
            Unary::Not => match (a.value.contains(0.0), is_zero(a.value)) {
                (false, _) => Enclosed::constant(0.0),
                (true, true) => Enclosed::constant(1.0),
                (true, false) => undecided(a.value.gaps),
            },
        }
    }

    fn binary(&mut self, at: usize, op: Binary, x: Register, y: Register) -> Enclosed<N> {
        let (a, b) = (self.get(x), self.get(y));
        let decide = |yes: bool, no: bool| match (yes, no) {
            (true, _) => Enclosed::constant(1.0),
            (_, true) => Enclosed::constant(0.0),
            (false, false) => undecided(a.value.gaps | b.value.gaps),
        };
        let apart = a.value.hi < b.value.lo || b.value.hi < a.value.lo;
        let same = a.value.lo == a.value.hi && a.value == b.value;
        match op {
            Binary::Add => a.add(&b),
            Binary::Sub if x == y => Enclosed::constant(0.0),
            Binary::Sub => a.sub(&b),
            Binary::Mul if x == y => a.square(),
            Binary::Mul => a.mul(&b),
            Binary::Div => a.div(&b),
            Binary::Rem => rules::remainder(&a, &b),
            Binary::Pow => rules::power(&a, &b),
            Binary::Min => self.chosen(at, a.min(&b)),
            Binary::Max => self.chosen(at, a.max(&b)),
            Binary::Less => decide(a.value.hi < b.value.lo, a.value.lo >= b.value.hi),
            Binary::LessEqual => decide(a.value.hi <= b.value.lo, a.value.lo > b.value.hi),
            Binary::Equal => decide(same, apart),
            Binary::NotEqual => decide(apart, same),
        }
    }
}

/// 0 here, 1 there.
fn undecided<const N: usize>(gaps: Gaps) -> Enclosed<N> {
    Enclosed::flat(Interval { lo: 0.0, hi: 1.0, gaps: gaps | Gaps::JUMPS })
}

/// The element that an index means, or all that it can mean.
fn element<const N: usize>(index: Interval, len: usize, at: impl Fn(usize) -> Enclosed<N>) -> Enclosed<N> {
    let place = |i: f64| if i < 0.0 { i + len as f64 } else { i };
    if index.lo == index.hi {
        let i = place(index.lo);
        let inside = i >= 0.0 && i < len as f64 && i == i.floor();
        return if inside { at(i as usize) } else { Enclosed::NOTHING };
    }
    (0..len).map(at).reduce(Enclosed::either).unwrap_or(Enclosed::NOTHING)
}

#[cfg(test)]
pub(super) mod tests;
