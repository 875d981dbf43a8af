//! Tapes with one choice that is open: the tape's value is then the greater, or the lesser, of what it would be for either choice.

use super::{Binary, Choice, Field, Op, Register, Unary, simplify};

/// A tape taken apart at a choice.
#[derive(Clone, Debug)]
pub struct Fold {
    /// The tapes of either choice.
    pub sides: [Field; 2],
    /// Whether the value is the greater of both; else the lesser.
    pub greater: bool,
}

impl Field {
    /// The tape taken apart at its one absolute value, minimum or maximum, where the first output rises or falls with that: through sums and
    /// differences alone. None for any other tape.
    pub fn folded(&self) -> Option<Fold> {
        let is_choice =
            |op: &Op| matches!(op, Op::Unary(Unary::Abs, ..) | Op::Binary(Binary::Min | Binary::Max, ..));
        let mut choices = self.ops.iter().enumerate().filter(|(_, op)| is_choice(op));
        let (at, op) = choices.next()?;
        if choices.next().is_some() || !self.is_straight() {
            return None;
        }
        let (result, is_greater) = match *op {
            Op::Unary(_, to, _) => (to, true),
            Op::Binary(op, to, ..) => (to, op == Binary::Max),
            _ => return None,
        };
        let rises = self.rises_with(result, at + 1)?;
        let side = |choice| {
            let choices: Vec<Choice> =
                (0..self.ops.len()).map(|i| if i == at { choice } else { Choice::Both }).collect();
            self.chosen(&choices)
        };
        let sides = [side(Choice::First), side(Choice::Second)];
        Some(Fold { sides, greater: is_greater == rises })
    }

    /// Whether a choice of the tape is open, one choice a step being given.
    pub fn is_open(&self, choices: &[Choice]) -> bool {
        let is_choice =
            |op: &Op| matches!(op, Op::Unary(Unary::Abs, ..) | Op::Binary(Binary::Min | Binary::Max, ..));
        self.ops.iter().zip(choices).any(|(op, choice)| is_choice(op) && *choice == Choice::Both)
    }

    /// Whether the first output rises with a register that is written before the step `from`; none where it may do either, or both.
    fn rises_with(&self, register: Register, from: usize) -> Option<bool> {
        let (mut register, mut rises) = (register, true);
        let mut passed = Vec::new();
        for op in &self.ops[from..] {
            let reads = simplify::reads(op, register);
            if passed.iter().any(|r| simplify::reads(op, *r) > 0) {
                return None;
            }
            match *op {
                _ if reads == 0 => {}
                Op::CheckFinite(_) => {}
                Op::Binary(Binary::Add, to, ..) if reads == 1 => {
                    passed.push(std::mem::replace(&mut register, to));
                }
                Op::Binary(Binary::Sub, to, a, _) if reads == 1 => {
                    rises = rises == (a == register);
                    passed.push(std::mem::replace(&mut register, to));
                }
                Op::Unary(Unary::Neg, to, _) => {
                    rises = !rises;
                    passed.push(std::mem::replace(&mut register, to));
                }
                _ => return None,
            }
        }
        (self.outputs.first() == Some(&register)).then_some(rises)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::field::FieldBuilder;

    #[test]
    fn a_sheet_is_the_greater_of_its_sides() {
        for (falls, n) in [(false, 1), (true, 1), (false, 2)] {
            let mut b = FieldBuilder::new(2);
            let sum = b.binary(Binary::Add, b.input(0), b.input(1));
            let mut fold = b.unary(Unary::Abs, sum);
            if n == 2 {
                fold = b.unary(Unary::Abs, fold);
            }
            let third = b.constant(0.3);
            let result =
                if falls { b.binary(Binary::Sub, third, fold) } else { b.binary(Binary::Sub, fold, third) };
            let field = b.finish(&[result]).unwrap();
            let Some(fold) = field.folded() else {
                assert_eq!(n, 2);
                continue;
            };
            assert!(n == 1 && fold.greater != falls);
            for i in 0..40 {
                let p = [f64::from(i) * 0.1 - 2.0, f64::from(i % 7) * 0.2];
                let of = |field: &Field| {
                    let mut out = [f64::NAN];
                    field.eval(&p, &mut out).unwrap();
                    out[0]
                };
                let [x, y] = [of(&fold.sides[0]), of(&fold.sides[1])];
                assert_eq!(of(&field), if fold.greater { x.max(y) } else { x.min(y) });
            }
        }
    }

    #[test]
    fn a_fold_that_is_used_twice_is_left_alone() {
        let mut b = FieldBuilder::new(1);
        let fold = b.unary(Unary::Abs, b.input(0));
        let one = b.constant(1.0);
        let less = b.binary(Binary::Sub, fold, one);
        let product = b.binary(Binary::Sub, less, fold);
        let field = b.finish(&[product]).unwrap();
        assert!(field.folded().is_none());
    }
}
