//! What stands for a value while a function is compiled.

use super::{Compiled, Compiler, MOST_TURNS, Stop};
use crate::diag::{Code, Span};
use crate::lang::coerce::shown;
use crate::lang::resolve::program::FunctionId;
use crate::lang::value::Value;
use crate::math::field::Register;
use std::rc::Rc;

/// A value, known or yet to be computed.
#[derive(Clone)]
pub(super) enum Symbol {
    /// Known when the function is made.
    Known(Value),
    /// A number.
    Number(Register),
    /// A truth value: 0 or 1.
    Bool(Register),
    /// 2 to 4 numbers.
    Vector(Vec<Register>),
    /// A list of known length.
    List(Rc<Vec<Symbol>>),
    /// Named parts: a hit.
    Record(Rc<Vec<(&'static str, Symbol)>>),
    /// A function made by the function that is compiled.
    Function(FunctionId, Rc<Vec<CapturedSymbol>>),
}

/// What a function made inside took along.
#[derive(Clone)]
pub(super) enum CapturedSymbol {
    /// A value.
    Symbol(Symbol),
    /// A variable of a frame, by the frame's place and id.
    Slot { frame: usize, id: usize, slot: u32 },
}

impl Symbol {
    /// In words: "a number", "a 3-vector".
    pub fn shown(&self) -> String {
        match self {
            Symbol::Known(value) => shown(value),
            Symbol::Number(_) => "a number".into(),
            Symbol::Bool(_) => "a truth value".into(),
            Symbol::Vector(v) => format!("a {}-vector", v.len()),
            Symbol::List(list) => format!("a list of {}", list.len()),
            Symbol::Record(_) => "a hit".into(),
            Symbol::Function(..) => "a function".into(),
        }
    }

    /// The value, where it is known. A list of known values is known.
    pub fn known(&self) -> Option<Value> {
        match self {
            Symbol::Known(value) => Some(value.clone()),
            Symbol::List(list) => list.iter().map(Symbol::known).collect::<Option<Vec<_>>>().map(Value::list),
            Symbol::Number(_)
            | Symbol::Bool(_)
            | Symbol::Vector(_)
            | Symbol::Record(_)
            | Symbol::Function(..) => None,
        }
    }

    /// How many elements a list or range has.
    pub fn len(&self) -> Option<usize> {
        match self {
            Symbol::List(list) => Some(list.len()),
            Symbol::Known(Value::List(list)) => Some(list.len()),
            Symbol::Known(Value::Range(range)) => Some(range.len),
            _ => None,
        }
    }

    /// The elements of a list or range, known or not. Asked where there are few: see [`Compiler::turns`].
    fn elements(&self) -> Option<Vec<Symbol>> {
        match self {
            Symbol::List(list) => Some((**list).clone()),
            Symbol::Known(Value::List(list)) => Some(list.iter().cloned().map(Symbol::Known).collect()),
            Symbol::Known(Value::Range(range)) => {
                Some((0..range.len).map(|i| Symbol::Known(Value::Number(range.element(i)))).collect())
            }
            _ => None,
        }
    }
}

/// What registers hold.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Shape {
    Number,
    Bool,
    Vector(usize),
}

impl Compiler<'_> {
    /// The registers of a number or vector.
    pub(super) fn components(&mut self, symbol: &Symbol) -> Option<Vec<Register>> {
        match symbol {
            Symbol::Number(register) => Some(vec![*register]),
            Symbol::Vector(registers) => Some(registers.clone()),
            Symbol::Known(Value::Number(x)) => Some(vec![self.builder.constant(*x)]),
            Symbol::Known(value) => {
                let components = crate::lang::eval::components(value);
                let registers: Vec<Register> = components.iter().map(|x| self.builder.constant(*x)).collect();
                (!registers.is_empty()).then_some(registers)
            }
            Symbol::Bool(_) | Symbol::List(_) | Symbol::Record(_) | Symbol::Function(..) => None,
        }
    }

    /// The elements of a list or range, to be gone through one by one; none of what is neither. All that are while a tape is made are
    /// counted, so that loops in loops end.
    pub(super) fn turns(&mut self, symbol: &Symbol, at: Span) -> Compiled<Option<Vec<Symbol>>> {
        self.n_turns = self.n_turns.saturating_add(symbol.len().unwrap_or(0));
        if self.n_turns > MOST_TURNS { Err(self.too_many(at)) } else { self.elements(symbol, at) }
    }

    /// The elements of a list or range; none of what is neither.
    pub(super) fn elements(&self, symbol: &Symbol, at: Span) -> Compiled<Option<Vec<Symbol>>> {
        match symbol {
            Symbol::Known(Value::Range(range)) if range.len > MOST_TURNS => Err(self.too_many(at)),
            _ => Ok(symbol.elements()),
        }
    }

    fn too_many(&self, at: Span) -> Stop {
        let message = format!("making this function takes more than {MOST_TURNS} elements one by one");
        let said = self.refuse(Code::ListLimit, at, message);
        said.hint("a `for` over the range runs while rendering instead, and needs no list").into()
    }

    /// The registers of a list of numbers, one for each.
    pub(super) fn numbers(&mut self, symbol: &Symbol) -> Option<Vec<Register>> {
        if symbol.len()? > MOST_TURNS {
            return None;
        }
        let elements = symbol.elements()?;
        let each = elements.iter().map(|element| match self.components(element)?[..] {
            [register] => Some(register),
            _ => None,
        });
        each.collect()
    }

    /// The registers of anything that registers can hold, with its shape.
    pub(super) fn held(&mut self, symbol: &Symbol) -> Option<(Shape, Vec<Register>)> {
        match symbol {
            Symbol::Bool(register) => Some((Shape::Bool, vec![*register])),
            Symbol::Known(Value::Bool(b)) => {
                Some((Shape::Bool, vec![self.builder.constant(f64::from(u8::from(*b)))]))
            }
            _ => {
                let registers = self.components(symbol)?;
                let shape = if registers.len() == 1 { Shape::Number } else { Shape::Vector(registers.len()) };
                Some((shape, registers))
            }
        }
    }
}

/// The symbol of registers of a shape.
pub(super) fn symbol_of(shape: Shape, registers: &[Register]) -> Symbol {
    match shape {
        Shape::Number => Symbol::Number(registers[0]),
        Shape::Bool => Symbol::Bool(registers[0]),
        Shape::Vector(_) => Symbol::Vector(registers.to_vec()),
    }
}
