//! Making a tape, step by step.

use super::{Binary, Call1, Call2, CallN, FaultKind, Field, Held, MAX_CALL, Op, Register, Rule, Unary};
use std::collections::HashMap;
use std::sync::Arc;

/// Turns that all loops of one evaluation may take, unless the maker says otherwise: far above any sum or fractal, and low
/// enough that a picture of an endless loop still ends.
const TURN_LIMIT: u32 = 100_000;

/// A place to jump to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Label(usize);

/// The function needs more registers, steps or tables than a tape can number.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the function is too large to run while rendering")]
pub struct TooLarge;

/// A tape in the making. Every operation gives a fresh register; only registers made by [`FieldBuilder::variable`] are
/// written twice. Steps carry the site that was set last by [`FieldBuilder::site`].
#[derive(Debug)]
pub struct FieldBuilder {
    n_inputs: usize,
    ops: Vec<Op>,
    sites: Vec<u32>,
    site: u32,
    initial: Vec<f64>,
    constants: HashMap<u64, Register>,
    tables: Vec<Box<[f64]>>,
    held: Vec<Arc<dyn Held>>,
    /// The step of each label, once it is bound.
    labels: Vec<Option<u32>>,
    turn_limit: u32,
    too_large: bool,
}

impl FieldBuilder {
    /// A tape of so many inputs, which are its first registers.
    pub fn new(n_inputs: usize) -> Self {
        FieldBuilder {
            n_inputs,
            ops: Vec::new(),
            sites: Vec::new(),
            site: 0,
            initial: vec![0.0; n_inputs],
            constants: HashMap::new(),
            tables: Vec::new(),
            held: Vec::new(),
            labels: Vec::new(),
            turn_limit: TURN_LIMIT,
            too_large: false,
        }
    }

    /// Sets the turns that all loops of one evaluation may take.
    pub fn set_turn_limit(&mut self, turns: u32) {
        self.turn_limit = turns;
    }

    /// The site of the steps that follow.
    pub fn site(&mut self, site: u32) {
        self.site = site;
    }

    /// The register of an input, counted from 0.
    pub fn input(&self, index: usize) -> Register {
        assert!(index < self.n_inputs, "a tape has the inputs it was made with");
        Register(index as u16)
    }

    /// How many steps there are so far.
    pub fn n_ops(&self) -> usize {
        self.ops.len()
    }

    /// A constant; the same bits share a register. It costs no step.
    pub fn constant(&mut self, value: f64) -> Register {
        if let Some(&register) = self.constants.get(&value.to_bits()) {
            return register;
        }
        let register = self.fresh(1);
        self.initial[register.index()] = value;
        self.constants.insert(value.to_bits(), register);
        register
    }

    /// A register of its own that holds a copy, to be written again by [`FieldBuilder::assign`].
    pub fn variable(&mut self, value: Register) -> Register {
        self.unary(Unary::Copy, value)
    }

    /// A register of its own that nothing was written to yet.
    pub fn unset(&mut self) -> Register {
        self.fresh(1)
    }

    /// Writes a variable.
    pub fn assign(&mut self, variable: Register, value: Register) {
        self.push(Op::Unary(Unary::Copy, variable, value));
    }

    /// op a.
    pub fn unary(&mut self, op: Unary, a: Register) -> Register {
        let to = self.fresh(1);
        self.push(Op::Unary(op, to, a));
        to
    }

    /// a op b.
    pub fn binary(&mut self, op: Binary, a: Register, b: Register) -> Register {
        let to = self.fresh(1);
        self.push(Op::Binary(op, to, a, b));
        to
    }

    /// condition ≠ 0 ? a : b, both computed already.
    pub fn select(&mut self, condition: Register, a: Register, b: Register) -> Register {
        let to = self.fresh(1);
        self.push(Op::Select(to, condition, a, b));
        to
    }

    /// f(a).
    pub fn call1(&mut self, f: Call1, rule: Rule, a: Register) -> Register {
        let to = self.fresh(1);
        self.push(Op::Call1(f, rule, to, a));
        to
    }

    /// f(a, b).
    pub fn call2(&mut self, f: Call2, rule: Rule, a: Register, b: Register) -> Register {
        let to = self.fresh(1);
        self.push(Op::Call2(f, rule, to, a, b));
        to
    }

    /// f of up to [`MAX_CALL`] arguments, with up to as many results; the result registers, in order.
    pub fn call_n(
        &mut self,
        f: CallN,
        rule: Rule,
        arguments: &[Register],
        n_results: usize,
    ) -> Vec<Register> {
        if arguments.len() > MAX_CALL || n_results > MAX_CALL {
            self.too_large = true;
            return vec![Register(0); n_results];
        }
        let from = self.list(arguments);
        let to = self.fresh(n_results);
        self.push(Op::CallN { f, rule, from, n_from: arguments.len() as u8, to, n_to: n_results as u8 });
        (0..n_results).map(|i| Register(to.0.wrapping_add(i as u16))).collect()
    }

    /// A held function of up to [`MAX_CALL`] arguments, with up to as many results; the result registers, in order.
    pub fn call_held(&mut self, f: Arc<dyn Held>, arguments: &[Register], n_results: usize) -> Vec<Register> {
        let number = u16::try_from(self.held.len());
        if arguments.len() > MAX_CALL || n_results > MAX_CALL || number.is_err() {
            self.too_large = true;
            return vec![Register(0); n_results];
        }
        self.held.push(f);
        let from = self.list(arguments);
        let to = self.fresh(n_results);
        let (n_from, n_to) = (arguments.len() as u8, n_results as u8);
        self.push(Op::CallHeld { held: number.unwrap_or(0), from, n_from, to, n_to });
        (0..n_results).map(|i| Register(to.0.wrapping_add(i as u16))).collect()
    }

    /// Element `index` of constant numbers. A list of vectors is a table per component.
    pub fn table(&mut self, table: TableId, index: Register) -> Register {
        let to = self.fresh(1);
        self.push(Op::Table(to, index, table.0));
        to
    }

    /// Keeps constant numbers for [`FieldBuilder::table`].
    pub fn add_table(&mut self, values: impl Into<Box<[f64]>>) -> TableId {
        let id = u16::try_from(self.tables.len());
        self.too_large |= id.is_err();
        self.tables.push(values.into());
        TableId(id.unwrap_or(0))
    }

    /// Element `index` of a list of registers.
    pub fn gather(&mut self, list: &[Register], index: Register) -> Register {
        let count = u16::try_from(list.len());
        self.too_large |= count.is_err();
        let first = self.list(list);
        let to = self.fresh(1);
        self.push(Op::Gather { to, index, first, count: count.unwrap_or(0) });
        to
    }

    /// A new label, to be bound once.
    pub fn label(&mut self) -> Label {
        self.labels.push(None);
        Label(self.labels.len() - 1)
    }

    /// Makes a label mean the next step.
    pub fn bind(&mut self, label: Label) {
        self.labels[label.0] = Some(self.ops.len() as u32);
    }

    /// Goes on at a label.
    pub fn jump(&mut self, label: Label) {
        self.push(Op::Jump(label.0 as u32));
    }

    /// Goes on at a label where the register is 0.
    pub fn jump_if_zero(&mut self, condition: Register, label: Label) {
        self.push(Op::JumpIfZero(condition, label.0 as u32));
    }

    /// Goes on at a label where the register is not 0.
    pub fn jump_if_not_zero(&mut self, condition: Register, label: Label) {
        self.push(Op::JumpIfNotZero(condition, label.0 as u32));
    }

    /// A fault where the register is not finite.
    pub fn check_finite(&mut self, a: Register) {
        self.push(Op::CheckFinite(a));
    }

    /// A fault.
    pub fn fault(&mut self, kind: FaultKind) {
        self.push(Op::Fault(kind));
    }

    /// The tape that gives these registers. Outputs are checked to be finite, under the site that was set last.
    pub fn finish(mut self, outputs: &[Register]) -> Result<Field, TooLarge> {
        for &output in outputs {
            self.check_finite(output);
        }
        if self.too_large {
            return Err(TooLarge);
        }
        let labels = &self.labels;
        let step = |label: u32| labels[label as usize].expect("every label that is jumped to is bound");
        for op in &mut self.ops {
            match op {
                Op::Jump(to) | Op::JumpIfZero(_, to) | Op::JumpIfNotZero(_, to) => *to = step(*to),
                _ => {}
            }
        }
        Ok(Field {
            n_inputs: self.n_inputs,
            ops: self.ops.into(),
            sites: self.sites.into(),
            initial: self.initial.into(),
            tables: self.tables.into(),
            held: self.held.into(),
            outputs: outputs.into(),
            turn_limit: self.turn_limit,
            straight: None,
        }
        .ready())
    }

    fn push(&mut self, op: Op) {
        self.too_large |= self.ops.len() >= u32::MAX as usize;
        self.ops.push(op);
        self.sites.push(self.site);
    }

    /// Registers in a row; the same where they are in a row already.
    fn list(&mut self, registers: &[Register]) -> Register {
        let in_a_row = registers.windows(2).all(|w| w[0].index() + 1 == w[1].index());
        if let (true, Some(&first)) = (in_a_row, registers.first()) {
            return first;
        }
        let first = self.fresh(registers.len());
        for (i, &from) in registers.iter().enumerate() {
            self.push(Op::Unary(Unary::Copy, Register(first.0.wrapping_add(i as u16)), from));
        }
        first
    }

    fn fresh(&mut self, count: usize) -> Register {
        let first = self.initial.len();
        if first + count > u16::MAX as usize {
            self.too_large = true;
            return Register(0);
        }
        self.initial.resize(first + count, 0.0);
        Register(first as u16)
    }
}

/// Constant numbers of a tape.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TableId(u16);
