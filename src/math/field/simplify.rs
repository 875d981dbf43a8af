//! A tape made shorter where the choices of its steps are known: what a minimum, a maximum or an absolute value never takes is left
//! out (after Keeter, *Massively parallel rendering of complex closed-form implicit surfaces*, 2020).

use super::{Binary, Choice, Field, Op, Register, Unary};

impl Field {
    /// Whether it has no jumps, so that the choices of its steps mean something.
    pub fn is_straight(&self) -> bool {
        !self.ops.iter().any(|op| matches!(op, Op::Jump(_) | Op::JumpIfZero(..) | Op::JumpIfNotZero(..)))
    }

    /// The tape that gives the same bits where each step chooses as said, one choice a step; the registers stay. None where nothing
    /// becomes shorter.
    pub fn simplified(&self, choices: &[Choice]) -> Option<Field> {
        let is_choice =
            |op: &Op| matches!(op, Op::Unary(Unary::Abs, ..) | Op::Binary(Binary::Min | Binary::Max, ..));
        if !self.is_straight()
            || !choices.iter().zip(self.ops.iter()).any(|(c, op)| *c != Choice::Both && is_choice(op))
        {
            return None;
        }
        Some(self.chosen(choices)).filter(|field| field.ops.len() < self.ops.len())
    }

    /// The same though it may be no shorter, of a tape without jumps.
    pub(super) fn chosen(&self, choices: &[Choice]) -> Field {
        let ops: Vec<Op> = self.ops.iter().zip(choices).map(|(op, choice)| decided(*op, *choice)).collect();
        let needed = self.needed(&ops);
        let kept = |i: &usize| needed[*i];
        Field {
            ops: (0..ops.len()).filter(kept).map(|i| ops[i]).collect(),
            sites: (0..ops.len()).filter(kept).map(|i| self.sites[i]).collect(),
            ..self.clone()
        }
        .ready()
    }

    /// Which steps the outputs depend on, and those that may stop the tape on the way to them.
    fn needed(&self, ops: &[Op]) -> Vec<bool> {
        let mut live = vec![false; self.initial.len()];
        let mut needed = vec![false; ops.len()];
        self.outputs.iter().for_each(|r| live[r.index()] = true);
        for (i, op) in ops.iter().enumerate().rev() {
            let (first, count) = written(op);
            let written = first.index()..first.index() + count;
            needed[i] = count == 0 || written.clone().any(|r| live[r]);
            if needed[i] {
                // Variables are written more than once, but only by copies, which do not hide what was there before.
                if !matches!(op, Op::Unary(Unary::Copy, ..)) {
                    live[written].fill(false);
                }
                each_read(op, |r| live[r.index()] = true);
            }
        }
        needed
    }
}

fn decided(op: Op, choice: Choice) -> Op {
    match (op, choice) {
        (Op::Unary(Unary::Abs, to, a), Choice::First) => Op::Unary(Unary::Copy, to, a),
        (Op::Unary(Unary::Abs, to, a), Choice::Second) => Op::Unary(Unary::Neg, to, a),
        (Op::Binary(Binary::Min | Binary::Max, to, a, _), Choice::First) => Op::Unary(Unary::Copy, to, a),
        (Op::Binary(Binary::Min | Binary::Max, to, _, b), Choice::Second) => Op::Unary(Unary::Copy, to, b),
        _ => op,
    }
}

/// The registers that a step writes: the first, and how many.
pub(super) fn written(op: &Op) -> (Register, usize) {
    match *op {
        Op::Unary(_, to, _) | Op::Binary(_, to, ..) | Op::Select(to, ..) => (to, 1),
        Op::Call1(_, _, to, _) | Op::Call2(_, _, to, ..) | Op::Table(to, ..) | Op::Gather { to, .. } => {
            (to, 1)
        }
        Op::CallN { to, n_to, .. } | Op::CallHeld { to, n_to, .. } => (to, n_to as usize),
        Op::Jump(_) | Op::JumpIfZero(..) | Op::JumpIfNotZero(..) | Op::CheckFinite(_) | Op::Fault(_) => {
            (Register(0), 0)
        }
    }
}

/// How often a step reads a register.
pub(super) fn reads(op: &Op, register: Register) -> usize {
    let mut count = 0;
    each_read(op, |r| count += usize::from(r == register));
    count
}

/// Calls `read` with each register that a step reads.
pub(super) fn each_read(op: &Op, mut read: impl FnMut(Register)) {
    let row = |first: Register, count: usize| (0..count).map(move |i| Register(first.0 + i as u16));
    match *op {
        Op::Unary(_, _, a) | Op::Call1(_, _, _, a) | Op::CheckFinite(a) => read(a),
        Op::JumpIfZero(a, _) | Op::JumpIfNotZero(a, _) | Op::Table(_, a, _) => read(a),
        Op::Binary(_, _, a, b) | Op::Call2(_, _, _, a, b) => [a, b].into_iter().for_each(read),
        Op::Select(_, condition, a, b) => [condition, a, b].into_iter().for_each(read),
        Op::CallN { from, n_from, .. } | Op::CallHeld { from, n_from, .. } => {
            row(from, n_from as usize).for_each(read)
        }
        Op::Gather { index, first, count, .. } => {
            read(index);
            row(first, count as usize).for_each(read);
        }
        Op::Jump(_) | Op::Fault(_) => {}
    }
}
