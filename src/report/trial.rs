//! One component on one set of cases: each variant judged input by input, then all of them timed in turn.
//!
//! An input is a row of numbers, so that the one that caused the largest error can be written down exactly and given back.

use super::measure::{Errors, Timed, counted, interleaved};
use super::row::Row;
use crate::math::hex::hex_list;
use std::fmt::Debug;
use std::hint::black_box;

/// How much to do.
#[derive(Clone, Debug)]
pub struct Plan {
    /// Inputs of each random case set.
    pub inputs: usize,
    /// Timing blocks of each variant; 0 for errors alone.
    pub blocks: usize,
    /// How long a block lasts at least, nanoseconds.
    pub block_ns: f64,
    /// One variant on one input, instead of everything.
    pub only: Option<Only>,
    /// So many calls of each variant for a profiler to count, and nothing judged or timed; 0 for none.
    pub counted: usize,
}

/// What to reproduce.
#[derive(Clone, Debug)]
pub struct Only {
    /// As rows name them.
    pub component: String,
    /// As rows name them.
    pub case: String,
    /// As rows name them.
    pub variant: String,
    /// The numbers of the input.
    pub input: Vec<f64>,
}

impl Plan {
    /// Errors alone, on few inputs: for tests.
    pub fn errors() -> Plan {
        Plan { inputs: 500, blocks: 0, block_ns: 0.0, only: None, counted: 0 }
    }

    /// Within a minute.
    pub fn quick() -> Plan {
        Plan { inputs: 2000, blocks: 30, block_ns: 5e5, only: None, counted: 0 }
    }

    /// For the record: more inputs and blocks, none longer, so that most fit a time slice of a busy machine.
    pub fn full() -> Plan {
        Plan { inputs: 20_000, blocks: 150, block_ns: 5e5, only: None, counted: 0 }
    }

    /// Calls to be counted by a profiler, each variant's in its turn in [`counted`].
    pub fn counts() -> Plan {
        Plan { counted: 256, ..Plan::errors() }
    }

    /// One variant on one input.
    pub fn only(only: Only) -> Plan {
        Plan { only: Some(only), ..Plan::errors() }
    }
}

/// What is wrong with one answer.
#[derive(Clone, Copy, Debug, Default)]
pub struct Verdict {
    /// Magnitude of the error, in the trial's unit; None where there is no answer to measure. NaN and infinities are counted apart.
    pub error: Option<f64>,
    /// Answers that should be there and are not.
    pub missed: usize,
    /// Answers that should not be there.
    pub spurious: usize,
    /// Evaluations, iterations or tests that the answer took.
    pub work: f64,
}

impl Verdict {
    /// An error and nothing else.
    pub fn error(error: f64) -> Verdict {
        Verdict { error: Some(error), ..Verdict::default() }
    }
}

/// What a row says of a variant beside numbers.
#[derive(Clone, Copy, Debug, Default)]
pub struct Label {
    name: &'static str,
    default: bool,
    note: &'static str,
}

/// A variant that is there to be compared with.
pub const fn variant(name: &'static str) -> Label {
    Label { name, default: false, note: "" }
}

/// The variant that the renderer uses.
pub const fn default(name: &'static str) -> Label {
    Label { name, default: true, note: "" }
}

impl Label {
    /// A sentence: why the default is one though off the frontier, or what is known to fail.
    #[must_use]
    pub const fn note(self, note: &'static str) -> Label {
        Label { note, ..self }
    }
}

/// What the trials of a component share.
#[derive(Clone, Copy, Debug)]
pub struct Subject {
    /// What is computed.
    pub component: &'static str,
    /// On what.
    pub case: &'static str,
    /// The unit of errors.
    pub unit: &'static str,
    /// What `work` counts; empty where it does not.
    pub work: &'static str,
    /// The default's largest error must not be above this, with nothing missed, spurious or not finite.
    pub bar: Option<f64>,
}

/// Inputs between two looks at the clock: few enough that a slow variant ends its block in time. Runs go round through all inputs.
const CHUNK: usize = 64;

/// Makes a number wait for another.
#[derive(Clone, Copy, Debug)]
pub struct Link {
    /// None, but only here is that known.
    bits: u64,
}

impl Link {
    /// A link.
    pub fn new() -> Link {
        Link { bits: black_box(0) }
    }

    /// `x`, once `before` is known.
    #[inline(always)]
    pub fn after(self, before: f64, x: f64) -> f64 {
        f64::from_bits(x.to_bits() | (before.to_bits() & self.bits))
    }
}

impl Default for Link {
    fn default() -> Link {
        Link::new()
    }
}

/// Inputs by the chunk, round and round. What is left over at the end, less than a chunk, is left out.
struct Chunks<const N: usize> {
    inputs: Vec<[f64; N]>,
    calls: usize,
    next: usize,
}

impl<const N: usize> Chunks<N> {
    fn of(inputs: &[[f64; N]]) -> Self {
        Chunks { inputs: inputs.to_vec(), calls: inputs.len().clamp(1, CHUNK), next: 0 }
    }

    fn next(&mut self) -> &[[f64; N]] {
        let (start, end) = (self.next, (self.next + self.calls).min(self.inputs.len()));
        self.next = if end + self.calls <= self.inputs.len() { end } else { 0 };
        &self.inputs[start..end]
    }
}

type Judge<'a, const N: usize, O> = Box<dyn Fn(&[f64; N], &O) -> Verdict + 'a>;

/// Variants on one case set of inputs of N numbers, with answers O.
pub struct Trial<'a, const N: usize, O> {
    subject: Subject,
    inputs: Vec<[f64; N]>,
    judge: Judge<'a, N, O>,
    board: Board<'a>,
    /// What of an answer the next call of a chain waits for.
    waits_for: Option<fn(&O) -> f64>,
}

impl<'a, const N: usize, O: Debug + 'a> Trial<'a, N, O> {
    /// A trial without variants yet. Where the plan is for one input of this trial, that one takes the place of all.
    pub fn new(
        plan: &'a Plan,
        subject: Subject,
        inputs: Vec<[f64; N]>,
        judge: impl Fn(&[f64; N], &O) -> Verdict + 'a,
    ) -> Self {
        let inputs = match &plan.only {
            None => inputs,
            Some(only) if (&*only.component, &*only.case) == (subject.component, subject.case) => {
                <[f64; N]>::try_from(&*only.input).into_iter().collect()
            }
            Some(_) => Vec::new(),
        };
        Trial { subject, inputs, judge: Box::new(judge), board: Board::of(plan), waits_for: None }
    }

    /// Times every variant that is [`run`](Trial::run) once more with calls that wait for this number of the answer before: no bit of it is
    /// taken into the first number of the next input, but the processor cannot know.
    #[must_use]
    pub fn in_chains(self, waits_for: fn(&O) -> f64) -> Self {
        Trial { waits_for: Some(waits_for), ..self }
    }

    /// Judges a variant on every input, and has it timed on them later.
    pub fn run(&mut self, label: Label, solve: impl Fn(&[f64; N]) -> O + Clone + 'a) {
        let mut chunks = Chunks::of(&self.inputs);
        let (calls, timed, linked) = (chunks.calls, solve.clone(), solve.clone());
        let run = move || {
            chunks.next().iter().for_each(|input| drop(black_box(timed(black_box(input)))));
            0.0
        };
        self.run_timed(label, calls, solve, run);
        if let Some(waits_for) = self.waits_for {
            let mut chunks = Chunks::of(&self.inputs);
            let link = Link::new();
            self.chain(label, calls, move || {
                chunks.next().iter().fold(0.0, |before, input| {
                    let mut input = *input;
                    input[0] = link.after(before, input[0]);
                    waits_for(&black_box(linked(&input)))
                })
            });
        }
    }

    /// The same, timed by `work`, which makes `calls` calls: for variants that take many inputs at once.
    pub fn run_timed(
        &mut self,
        label: Label,
        calls: usize,
        solve: impl Fn(&[f64; N]) -> O,
        work: impl FnMut() -> f64 + 'a,
    ) {
        self.judged(label, &solve, Timed { name: label.name, calls, run: Box::new(work) });
    }

    /// Times a variant that ran already once more, by `work` whose `calls` calls each wait for the answer before.
    pub fn chain(&mut self, label: Label, calls: usize, work: impl FnMut() -> f64 + 'a) {
        self.board.chain(Timed { name: label.name, calls, run: Box::new(work) });
    }

    /// Only calls that are timed are compiled into what times them; these are not.
    fn judged(&mut self, label: Label, solve: &dyn Fn(&[f64; N]) -> O, timed: Timed<'a>) {
        let plan = self.board.plan;
        if plan.only.as_ref().is_some_and(|only| only.variant != label.name) || self.inputs.is_empty() {
            return;
        }
        let mut tally = Tally::of(Row::of(&self.subject, label.name, label.default, label.note));
        if plan.counted == 0 {
            for input in &self.inputs {
                let answer = solve(input);
                tally.take((self.judge)(input, &answer), input);
                if plan.only.is_some() {
                    tally.row.answer = format!("{answer:?}");
                }
            }
        }
        self.board.rows.push(tally.row());
        self.board.timed.push(timed);
    }

    /// Times the variants in turn, or has their calls counted, and gives their rows.
    pub fn finish(self) -> Vec<Row> {
        self.board.finish()
    }
}

/// A row in the making.
struct Tally {
    row: Row,
    errors: Errors,
}

impl Tally {
    fn of(row: Row) -> Tally {
        Tally { row, errors: Errors::default() }
    }

    fn take(&mut self, verdict: Verdict, input: &[f64]) {
        let row = &mut self.row;
        row.n += 1;
        row.missed += verdict.missed;
        row.spurious += verdict.spurious;
        row.work += verdict.work;
        if (verdict.missed > 0 || verdict.spurious > 0) && row.failed_input.is_empty() {
            row.failed_input = hex_list(input);
        }
        if let Some(error) = verdict.error {
            self.errors.push(error, input);
        }
    }

    fn row(self) -> Row {
        let Tally { mut row, errors } = self;
        row.work /= row.n.max(1) as f64;
        row.not_finite = errors.not_finite;
        row.worst_input = errors.worst_input().to_owned();
        [row.error_max, row.error_p99, row.error_mean] = errors.summary();
        row
    }
}

/// The rows of a trial, and what times them. Knows neither inputs nor answers.
struct Board<'a> {
    plan: &'a Plan,
    rows: Vec<Row>,
    timed: Vec<Timed<'a>>,
    /// Runs whose calls wait for one another, each with its row.
    chains: Vec<(usize, Timed<'a>)>,
}

impl<'a> Board<'a> {
    fn of(plan: &'a Plan) -> Board<'a> {
        Board { plan, rows: Vec::new(), timed: Vec::new(), chains: Vec::new() }
    }

    fn chain(&mut self, timed: Timed<'a>) {
        if let Some(row) = self.rows.iter().position(|row| row.variant == timed.name) {
            self.chains.push((row, timed));
        }
    }

    fn finish(mut self) -> Vec<Row> {
        if self.plan.counted > 0 {
            return self.count();
        }
        if self.plan.blocks > 0 {
            let timings = interleaved(&mut self.timed, self.plan.blocks, self.plan.block_ns);
            for (row, timing) in self.rows.iter_mut().zip(timings) {
                row.ns_median = timing.ns_median;
                row.ns_mad = timing.ns_mad;
                row.ratio = timing.ratio;
                row.ratio_ci = timing.ratio_ci;
            }
        }
        self.time_chains();
        self.rows
    }

    /// Rows that say of how many calls each variant's were. What is made at the first call is made before.
    fn count(mut self) -> Vec<Row> {
        for (row, timed) in self.rows.iter_mut().zip(&mut self.timed) {
            let repeats = self.plan.counted.div_ceil(timed.calls.max(1));
            (timed.run)();
            counted(&mut *timed.run, repeats);
            row.n = repeats * timed.calls;
        }
        self.rows
    }

    fn time_chains(&mut self) {
        if self.plan.blocks == 0 {
            return;
        }
        let (rows, mut timed): (Vec<usize>, Vec<Timed<'a>>) = self.chains.drain(..).unzip();
        let timings = interleaved(&mut timed, self.plan.blocks, self.plan.block_ns);
        for (row, timing) in rows.into_iter().zip(timings) {
            self.rows[row].ns_chain = Some(timing.ns_median);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SQUARE_ROOT: Subject =
        Subject { component: "root", case: "small", unit: "absolute", work: "", bar: Some(1e-15) };

    fn rows(plan: &Plan) -> Vec<Row> {
        let inputs = (0..100).map(|i| [f64::from(i) / 100.0]).collect();
        let judge = |[x]: &[f64; 1], root: &f64| Verdict::error((root * root - x).abs());
        let mut trial = Trial::new(plan, SQUARE_ROOT, inputs, judge);
        trial.run(variant("half"), |[x]| x / 2.0);
        trial.run(default("exact"), |[x]| x.sqrt());
        trial.chain(default("exact"), 100, || (0..100).fold(2.0, |x: f64, _| x.sqrt()));
        trial.finish()
    }

    #[test]
    fn variants_are_judged_alike_and_the_worst_input_reproduces_its_error() {
        let all = rows(&Plan::errors());
        assert!(all[0].error_max > 0.7 && all[1].error_max < 1e-15 && all[1].default);
        let input = crate::math::hex::parse_hex_list(&all[0].worst_input).unwrap();
        let only = Only { component: "root".into(), case: "small".into(), variant: "half".into(), input };
        let again = rows(&Plan::only(only));
        assert_eq!((again.len(), again[0].n, again[0].error_max), (1, 1, all[0].error_max));
        assert!(!again[0].answer.is_empty());
    }

    #[test]
    fn calls_to_be_counted_are_made_and_not_judged() {
        let all = rows(&Plan::counts());
        assert_eq!(all.iter().map(|row| row.n).collect::<Vec<_>>(), [256, 256]);
        assert!(all.iter().all(|row| row.error_max == 0.0 && row.ns_median == 0.0));
    }

    #[test]
    fn every_variant_is_timed_in_a_chain_where_a_trial_says_what_it_waits_for() {
        let plan = Plan { blocks: 3, block_ns: 1e3, ..Plan::errors() };
        let inputs = (0..100).map(|i| [f64::from(i) / 100.0]).collect();
        let judge = |[x]: &[f64; 1], root: &f64| Verdict::error((root * root - x).abs());
        let mut trial = Trial::new(&plan, SQUARE_ROOT, inputs, judge).in_chains(|root| *root);
        trial.run(variant("half"), |[x]| x / 2.0);
        trial.run(default("exact"), |[x]| x.sqrt());
        assert!(trial.finish().iter().all(|row| row.ns_chain.is_some_and(|ns| ns > 0.0)));
    }

    #[test]
    fn a_plan_with_blocks_has_times() {
        let timed = rows(&Plan { blocks: 3, block_ns: 1e3, ..Plan::errors() });
        assert!(timed.iter().all(|row| row.ns_median > 0.0) && timed[0].ratio == 1.0);
        assert!(timed[0].ns_chain.is_none() && timed[1].ns_chain.is_some_and(|ns| ns > 0.0));
    }
}
