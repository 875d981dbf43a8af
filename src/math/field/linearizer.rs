//! Running a tape on linear forms: over a box its first output is a linear function and a small rest. Only tapes without jumps, and only
//! where nothing may be undefined; elsewhere [`super::Encloser`] knows more.

mod bow;

use super::enclose::{Choice, Enclosed};
use super::linear::Linear;
use super::{Binary, Call1, Call2, CallN, Field, MAX_CALL, Op, Register, Rule, Unary, rules};
use crate::math::elementary::sin_cos;
use crate::math::interval::Interval;

/// Runs a tape on linear forms, again and again.
pub struct Linearizer<'f, const N: usize> {
    field: &'f Field,
    forms: Vec<Linear<N>>,
    choices: Vec<Choice>,
    records: bool,
    waves: Waves,
}

/// Sines and cosines of late: formulas tend to have both of one argument.
struct Waves {
    known: [(f64, (f64, f64)); 4],
    next: usize,
}

impl Waves {
    #[inline(always)]
    fn of(&mut self, x: f64) -> (f64, f64) {
        if let Some((_, wave)) = self.known.iter().find(|(of, _)| of.to_bits() == x.to_bits()) {
            return *wave;
        }
        let wave = sin_cos(x);
        self.known[self.next] = (x, wave);
        self.next = (self.next + 1) % 4;
        wave
    }
}

impl<'f, const N: usize> Linearizer<'f, N> {
    /// Of a tape with at least one output, with memory that was used before.
    pub fn reuse(field: &'f Field, mut forms: Vec<Linear<N>>) -> Self {
        forms.clear();
        forms.extend(field.initial.iter().map(|&x| Linear::constant(x)));
        let known = [(0.0, (0.0, 1.0)); 4];
        Linearizer { field, forms, choices: Vec::new(), records: false, waves: Waves { known, next: 0 } }
    }

    /// The memory.
    pub fn into_memory(self) -> Vec<Linear<N>> {
        self.forms
    }

    /// Runs once, and gives the memory back.
    pub fn once(mut self, inputs: &[Linear<N>]) -> (Option<Linear<N>>, Vec<Linear<N>>) {
        (self.run(inputs), self.forms)
    }

    /// The first output for these inputs; none where it may jump or be undefined, or is not known.
    pub fn run(&mut self, inputs: &[Linear<N>]) -> Option<Linear<N>> {
        self.forms[..inputs.len()].copy_from_slice(inputs);
        for (at, &op) in self.field.ops.iter().enumerate() {
            self.step(at, op)?;
        }
        Some(self.get(self.field.outputs[0])).filter(Linear::is_finite)
    }

    /// The same, and the choice of each step.
    pub fn run_choosing(&mut self, inputs: &[Linear<N>]) -> Option<(Linear<N>, &[Choice])> {
        self.choices.clear();
        self.choices.resize(self.field.ops.len(), Choice::Both);
        self.records = true;
        let result = self.run(inputs);
        self.records = false;
        result.map(|form| (form, self.choices.as_slice()))
    }

    #[inline(always)]
    fn get(&self, register: Register) -> Linear<N> {
        self.forms[register.index()]
    }

    #[inline(always)]
    fn step(&mut self, at: usize, op: Op) -> Option<()> {
        let (to, result) = match op {
            Op::Unary(op, to, a) => (to, self.unary(at, op, self.get(a))?),
            Op::Binary(op, to, a, b) => (to, self.binary(at, op, a, b)?),
            Op::Call1(f, rule, to, a) => (to, self.call1(f, rule, self.get(a))?),
            Op::Call2(f, rule, to, a, b) => (to, call2(f, rule, self.get(a), self.get(b))?),
            Op::Select(to, condition, a, b) => {
                let chosen = if self.get(condition).sign().is_some() {
                    a
                } else {
                    self.zero(condition).then_some(b)?
                };
                (to, self.get(chosen))
            }
            Op::CallN { f, rule, from, n_from, to, n_to } => {
                return self.call_n(f, rule, (from, n_from as usize), (to, n_to as usize));
            }
            Op::CheckFinite(a) => return self.get(a).is_finite().then_some(()),
            Op::CallHeld { .. } | Op::Table(..) | Op::Gather { .. } | Op::Fault(_) => return None,
            Op::Jump(_) | Op::JumpIfZero(..) | Op::JumpIfNotZero(..) => return None,
        };
        self.forms[to.index()] = result;
        Some(())
    }

    fn zero(&self, register: Register) -> bool {
        self.get(register).middle == 0.0 && self.get(register).reach() == 0.0
    }

    #[inline(always)]
    fn chosen(&mut self, at: usize, choice: Choice) {
        if self.records {
            self.choices[at] = choice;
        }
    }

    #[inline(always)]
    fn unary(&mut self, at: usize, op: Unary, a: Linear<N>) -> Option<Linear<N>> {
        Some(match op {
            Unary::Copy => a,
            Unary::Neg => a.neg(),
            Unary::Abs => match a.sign() {
                None => a.folded(),
                Some(false) => {
                    self.chosen(at, Choice::First);
                    a
                }
                Some(true) => {
                    self.chosen(at, Choice::Second);
                    a.neg()
                }
            },
            Unary::Sqrt => a.sqrt().or_else(|| by_derivatives(&[a], |of| of[0].sqrt()))?,
            Unary::Floor => steady(a, f64::floor)?,
            Unary::Ceil => steady(a, f64::ceil)?,
            Unary::Not => Linear::constant(if a.sign().is_some() { 0.0 } else { return None }),
        })
    }

    #[inline(always)]
    fn binary(&mut self, at: usize, op: Binary, x: Register, y: Register) -> Option<Linear<N>> {
        let (a, b) = (self.get(x), self.get(y));
        Some(match op {
            Binary::Add => a.add(&b),
            Binary::Sub if x == y => Linear::constant(0.0),
            Binary::Sub => a.sub(&b),
            Binary::Mul if x == y => a.square(),
            Binary::Mul => a.mul(&b),
            Binary::Div => a.mul(&b.recip()?),
            Binary::Pow => power(a, b)?,
            Binary::Rem => by_derivatives(&[a, b], |of| rules::remainder(&of[0], &of[1]))?,
            Binary::Min | Binary::Max => self.lesser(at, op == Binary::Max, a, b),
            Binary::Less | Binary::LessEqual => truth(a.sub(&b).sign()?),
            Binary::Equal => a.sub(&b).sign().map(|_| truth(false))?,
            Binary::NotEqual => a.sub(&b).sign().map(|_| truth(true))?,
        })
    }

    /// (a + b ∓ |a − b|) / 2 where it is not known which is the lesser.
    fn lesser(&mut self, at: usize, greater: bool, a: Linear<N>, b: Linear<N>) -> Linear<N> {
        let difference = if greater { b.sub(&a) } else { a.sub(&b) };
        match difference.sign() {
            Some(true) => {
                self.chosen(at, Choice::First);
                a
            }
            Some(false) => {
                self.chosen(at, Choice::Second);
                b
            }
            None => {
                let (sum, fold) = (a.add(&b), difference.folded());
                (if greater { sum.add(&fold) } else { sum.sub(&fold) }).halved()
            }
        }
    }

    #[inline(always)]
    fn call1(&mut self, f: Call1, rule: Rule, a: Linear<N>) -> Option<Linear<N>> {
        match rule {
            Rule::Sin => Some(a.sin(self.waves.of(a.middle))),
            Rule::Cos => Some(a.cos(self.waves.of(a.middle))),
            Rule::Exp => Some(a.exp()),
            Rule::Ln => a.ln(),
            _ => by_derivatives(&[a], |of| rules::call1(f, rule, &of[0])),
        }
    }

    fn call_n(
        &mut self,
        f: CallN,
        rule: Rule,
        (from, n): (Register, usize),
        (to, m): (Register, usize),
    ) -> Option<()> {
        let arguments = &self.forms[from.index()..][..n];
        let mut results = [Linear::constant(0.0); MAX_CALL];
        match rule {
            Rule::Length | Rule::Distance => results[0] = length(f, rule, arguments)?,
            Rule::Noise | Rule::Fbm => results[0] = noise(f, rule, arguments)?,
            Rule::Cross => cross(arguments, &mut results),
            Rule::Mix => {
                let [a, b, t] = [arguments[0], arguments[1], arguments[2]];
                results[0] = a.mul(&Linear::constant(1.0).sub(&t)).add(&b.mul(&t));
            }
            _ => many(f, rule, arguments, &mut results[..m])?,
        }
        self.forms[to.index()..][..m].copy_from_slice(&results[..m]);
        Some(())
    }
}

fn truth<const N: usize>(yes: bool) -> Linear<N> {
    Linear::constant(if yes { 1.0 } else { 0.0 })
}

/// A function that is constant between jumps, where the range holds none.
fn steady<const N: usize>(a: Linear<N>, f: fn(f64) -> f64) -> Option<Linear<N>> {
    let range = a.range();
    (f(range.lo) == f(range.hi)).then(|| Linear::constant(f(range.lo)))
}

fn call2<const N: usize>(f: Call2, rule: Rule, a: Linear<N>, b: Linear<N>) -> Option<Linear<N>> {
    match rule {
        Rule::Power => power(a, b),
        _ => by_derivatives(&[a, b], |of| rules::call2(f, rule, &of[0], &of[1])),
    }
}

/// aᵇ: by products for small whole b, as it is computed.
fn power<const N: usize>(a: Linear<N>, b: Linear<N>) -> Option<Linear<N>> {
    let n = b.middle;
    if b.reach() == 0.0 && n == n.trunc() && (1.0..=64.0).contains(&n) {
        let (mut n, mut base, mut result) = (n as u32, a, None);
        while n > 0 {
            if n & 1 == 1 {
                result = Some(result.map_or(base, |r: Linear<N>| r.mul(&base)));
            }
            n >>= 1;
            if n > 0 {
                base = base.square();
            }
        }
        return result;
    }
    by_derivatives(&[a, b], |of| rules::power(&of[0], &of[1]))
}

fn length<const N: usize>(f: CallN, rule: Rule, of: &[Linear<N>]) -> Option<Linear<N>> {
    let half = of.len() / 2;
    let side = |i: usize| if rule == Rule::Distance { of[i].sub(&of[half + i]) } else { of[i] };
    let n = if rule == Rule::Distance { half } else { of.len() };
    let squares = (0..n).map(|i| side(i).square()).reduce(|a, b| a.add(&b))?;
    squares.sqrt().or_else(|| {
        let mut result = [Linear::constant(0.0)];
        many(f, rule, of, &mut result).map(|()| result[0])
    })
}

fn cross<const N: usize>(of: &[Linear<N>], to: &mut [Linear<N>]) {
    let (a, b) = of.split_at(3);
    for i in 0..3 {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        to[i] = a[j].mul(&b[k]).sub(&a[k].mul(&b[j]));
    }
}

/// Noise, or a sum of octaves of it.
fn noise<const N: usize>(f: CallN, rule: Rule, of: &[Linear<N>]) -> Option<Linear<N>> {
    let n = if rule == Rule::Fbm { of.len() - 3 } else { of.len() };
    let (p, rest) = of.split_at(n);
    if rest.iter().any(|x| x.reach() != 0.0) {
        return None;
    }
    let mut middles = [0.0; MAX_CALL];
    middles.iter_mut().zip(of).for_each(|(m, x)| *m = x.middle);
    let mut ranges = [Interval::point(0.0); 3];
    ranges.iter_mut().zip(p).for_each(|(r, x)| *r = x.range());
    let slopes = match rule {
        Rule::Fbm => rules::fbm_slopes(&ranges[..n], [0, 1, 2].map(|i| rest[i].middle))?,
        _ => rules::noise_slopes(&ranges[..n]),
    };
    let mut at = [0.0];
    f(&middles[..of.len()], &mut at);
    let around = Interval::new(at[0] - rules::NOISE_ROUNDING, at[0] + rules::NOISE_ROUNDING);
    Linear::by_derivatives(p, around, Interval::new(0.0, 1.0), &slopes[..n])
}

/// A function of which an interval rule is known: one for few arguments, one for more.
fn many<const N: usize>(f: CallN, rule: Rule, of: &[Linear<N>], to: &mut [Linear<N>]) -> Option<()> {
    match of.len() {
        0..=3 => many_of::<N, 3>(f, rule, of, to),
        4..=8 => many_of::<N, 8>(f, rule, of, to),
        _ => None,
    }
}

fn many_of<const N: usize, const M: usize>(
    f: CallN,
    rule: Rule,
    of: &[Linear<N>],
    to: &mut [Linear<N>],
) -> Option<()> {
    let (ranges, middles) = arguments::<N, M>(of);
    let (mut all, mut at) = ([Enclosed::NOTHING; MAX_CALL], [Enclosed::NOTHING; MAX_CALL]);
    rules::call_n(f, rule, &ranges[..of.len()], &mut all[..to.len()]);
    rules::call_n(f, rule, &middles[..of.len()], &mut at[..to.len()]);
    for (to, (all, at)) in to.iter_mut().zip(all.iter().zip(&at)) {
        *to = Linear::by_derivatives(of, at.value, all.value, &all.slope[..of.len()])?;
    }
    Some(())
}

/// The same for one and two arguments.
fn by_derivatives<const N: usize>(
    of: &[Linear<N>],
    f: impl Fn(&[Enclosed<2>]) -> Enclosed<2>,
) -> Option<Linear<N>> {
    let (ranges, middles) = arguments::<N, 2>(of);
    let all = f(&ranges[..of.len()]);
    Linear::by_derivatives(of, f(&middles[..of.len()]).value, all.value, &all.slope[..of.len()])
}

/// Ranges, each with the derivative 1 along itself, and middles.
fn arguments<const N: usize, const M: usize>(of: &[Linear<N>]) -> ([Enclosed<M>; M], [Enclosed<M>; M]) {
    let (mut ranges, mut middles) = ([Enclosed::NOTHING; M], [Enclosed::NOTHING; M]);
    for (i, x) in of.iter().enumerate() {
        middles[i] = Enclosed::constant(x.middle);
        ranges[i] = middles[i];
        // A number that does not change stays one: rules know more of those.
        if x.reach() != 0.0 {
            ranges[i].value = x.range();
            ranges[i].slope[i] = Interval::point(1.0);
        }
    }
    (ranges, middles)
}

#[cfg(test)]
mod tests;
