//! Expressions to symbols.

use super::symbol::{CapturedSymbol, Symbol, symbol_of};
use super::{Captures, Compiled, Compiler, LONGEST, Stop};
use crate::diag::{Code, Span};
use crate::lang::eval::{equal, operators, place, swizzle};
use crate::lang::members;
use crate::lang::resolve::program::{Access, Arithmetic, Comparison, Comprehension, Expr, ExprKind, Range};
use crate::lang::value::{RangeValue, Value};
use crate::math::field::{Binary, Register, Rule, Unary};
use std::rc::Rc;

/// Whole powers up to this are written out as products, in the order in which the evaluator multiplies.
const WRITTEN_OUT: i32 = 16;

impl<'c> Compiler<'c> {
    pub(super) fn expr(&mut self, e: &'c Expr) -> Compiled {
        if self.builder.n_ops() > LONGEST {
            return Err(self
                .refuse(Code::NotSampled, e.span, "this function grows too long to run while rendering")
                .hint("its loops and recursions are written out; make them shorter")
                .into());
        }
        match &e.kind {
            ExprKind::Number(x) => Ok(Symbol::Known(Value::Number(*x))),
            ExprKind::Constant(value) => Ok(Symbol::Known((**value).clone())),
            ExprKind::Name(access) => self.read(*access, e.span),
            ExprKind::Vector(components) => self.vector(components),
            ExprKind::List(elements) => {
                let elements = elements.iter().map(|e| self.expr(e)).collect::<Compiled<Vec<_>>>()?;
                Ok(Symbol::List(Rc::new(elements)))
            }
            ExprKind::Comprehension(c) => self.comprehension(c),
            ExprKind::Negate(operand) => self.negate(operand, e.span),
            ExprKind::Not(operand) => match self.truth(operand)? {
                Truth::Known(b) => Ok(Symbol::Known(Value::Bool(!b))),
                Truth::Register(r) => Ok(Symbol::Bool(self.at(e.span).unary(Unary::Not, r))),
            },
            ExprKind::Straight(straight) => self.expr(&straight.tree),
            ExprKind::Arithmetic(op, operands) => {
                let (a, b) = (self.expr(&operands.0)?, self.expr(&operands.1)?);
                self.arithmetic(*op, &a, &b, e.span)
            }
            ExprKind::Compare(op, operands) => {
                let (a, b) = (self.expr(&operands.0)?, self.expr(&operands.1)?);
                self.compare(*op, &a, &b, e.span)
            }
            ExprKind::And(operands) => self.short(operands, false, e.span),
            ExprKind::Or(operands) => self.short(operands, true, e.span),
            ExprKind::Choice(parts) => self.choice(parts, e.span),
            ExprKind::Range(range) => self.range(range, e.span),
            ExprKind::CallNumber(builtin, _, argument) => {
                let value = self.expr(argument)?;
                self.builtin(builtin, vec![value], &[argument.span], e.span)
            }
            ExprKind::CallBuiltin(call) => self.call_builtin(call, e.span),
            ExprKind::CallFunction(call) => self.call_function(call, e.span),
            ExprKind::CallValue(call) => self.call_value(call, e.span),
            ExprKind::Component(i, base) => {
                let base = self.expr(base)?;
                self.field(&base, &"xyzw"[usize::from(*i)..=usize::from(*i)], e.span)
            }
            ExprKind::Field(parts) => {
                let base = self.expr(&parts.0)?;
                self.field(&base, &parts.1, parts.2)
            }
            ExprKind::Index(parts) => {
                let (list, index) = (self.expr(&parts.0)?, self.expr(&parts.1)?);
                self.index(&list, &index, &parts.1)
            }
            ExprKind::Lambda(function, captures) => self.lambda(*function, captures, e.span),
            ExprKind::Text(_) => Err(self.impossible("texts are not made", e.span)),
            ExprKind::With(_) => Err(self.impossible("`with` does not run", e.span)),
            ExprKind::Block(_) => Err(self.impossible("blocks are not built", e.span)),
            ExprKind::CallMethod(call) => self.call_method(call, e.span),
            ExprKind::Poison => Err(Stop::Silent),
        }
    }

    pub(super) fn impossible(&self, what: &str, span: Span) -> Stop {
        self.refuse(Code::NotSampled, span, format!("{what} while rendering"))
            .hint("compute it outside and let the function take it along: `let a = …`, then `p => … a …`")
            .into()
    }

    pub(super) fn mismatch(&self, message: String, span: Span) -> Stop {
        self.refuse(Code::TypeMismatch, span, message).into()
    }

    pub(super) fn read(&mut self, access: Access, span: Span) -> Compiled {
        match access {
            Access::Local(slot) => match &self.frame().slots[slot as usize] {
                Some(symbol) => Ok(symbol.clone()),
                None => Err(self.refuse(Code::UsedBeforeSet, span, "this name has no value yet").into()),
            },
            Access::Global(slot) => {
                let slot = self.host.global(slot);
                self.slot_value(&slot, span)
            }
            Access::Captured(slot) => match self.frame().captures.clone() {
                Captures::Values(Some(values)) => self.slot_value(&values[slot as usize], span),
                Captures::Values(None) => {
                    Err(self.refuse(Code::UsedBeforeSet, span, "nothing is captured").into())
                }
                Captures::Symbols(symbols) => self.read_captured(&symbols[slot as usize], span),
            },
            Access::Sibling(function) => Ok(match self.frame().captures.clone() {
                Captures::Values(captured) => {
                    Symbol::Known(Value::Function(Rc::new(crate::lang::eval::slots::Closure {
                        function,
                        captured,
                    })))
                }
                Captures::Symbols(symbols) => Symbol::Function(function, symbols),
            }),
        }
    }

    pub(super) fn read_captured(&mut self, captured: &CapturedSymbol, span: Span) -> Compiled {
        match captured {
            CapturedSymbol::Symbol(symbol) => Ok(symbol.clone()),
            CapturedSymbol::Slot { frame, id, slot } => {
                let found = self.frames.get(*frame).filter(|f| f.id == *id);
                match found.and_then(|f| f.slots[*slot as usize].clone()) {
                    Some(symbol) => Ok(symbol),
                    None => Err(self
                        .refuse(Code::NotSampled, span, "this name is not there any more while rendering")
                        .into()),
                }
            }
        }
    }

    fn vector(&mut self, components: &'c [Expr]) -> Compiled {
        let mut symbols = Vec::with_capacity(components.len());
        for e in components {
            let symbol = self.expr(e)?;
            match self.components(&symbol) {
                Some(registers) if registers.len() == 1 => symbols.push((symbol, registers[0])),
                _ => {
                    return Err(self.mismatch(
                        format!("a component is a number, and this is {}", symbol.shown()),
                        e.span,
                    ));
                }
            }
        }
        let known: Option<Vec<f64>> = symbols
            .iter()
            .map(|(s, _)| if let Symbol::Known(Value::Number(x)) = s { Some(*x) } else { None })
            .collect();
        Ok(match known {
            Some(known) => Symbol::Known(crate::lang::value::vector(&known)),
            None => Symbol::Vector(symbols.into_iter().map(|(_, r)| r).collect()),
        })
    }

    fn negate(&mut self, operand: &'c Expr, span: Span) -> Compiled {
        let symbol = self.expr(operand)?;
        if let Symbol::Known(value) = &symbol {
            return operators::negate(value, span).map(Symbol::Known).map_err(Stop::from);
        }
        match self.components(&symbol) {
            Some(registers) => {
                let negated = registers.iter().map(|r| self.at(span).unary(Unary::Neg, *r)).collect();
                Ok(number_or_vector(negated))
            }
            None => Err(self
                .mismatch(format!("`-` takes a number or a vector, and this is {}", symbol.shown()), span)),
        }
    }

    pub(super) fn arithmetic(&mut self, op: Arithmetic, a: &Symbol, b: &Symbol, span: Span) -> Compiled {
        if let (Some(x), Some(y)) = (a.known(), b.known())
            && let Ok(value) = operators::arithmetic(op, &x, &y, span)
        {
            return Ok(Symbol::Known(value));
        }
        let (Some(u), Some(v)) = (self.components(a), self.components(b)) else {
            return Err(
                self.mismatch(format!("`{}` cannot join {} and {}", op.text(), a.shown(), b.shown()), span)
            );
        };
        let n = u.len().max(v.len());
        if (u.len() != n && u.len() != 1) || (v.len() != n && v.len() != 1) {
            return Err(
                self.mismatch(format!("`{}` cannot join {} and {}", op.text(), a.shown(), b.shown()), span)
            );
        }
        let exponent = match b {
            Symbol::Known(Value::Number(x)) => Some(*x),
            _ => None,
        };
        let of = |registers: &[Register], i: usize| registers[if registers.len() == 1 { 0 } else { i }];
        let joined = (0..n).map(|i| self.operation(op, of(&u, i), of(&v, i), exponent, span)).collect();
        Ok(number_or_vector(joined))
    }

    fn operation(
        &mut self,
        op: Arithmetic,
        a: Register,
        b: Register,
        exponent: Option<f64>,
        span: Span,
    ) -> Register {
        let builder = self.at(span);
        match op {
            Arithmetic::Add => builder.binary(Binary::Add, a, b),
            Arithmetic::Subtract => builder.binary(Binary::Sub, a, b),
            Arithmetic::Multiply => builder.binary(Binary::Mul, a, b),
            Arithmetic::Divide => builder.binary(Binary::Div, a, b),
            Arithmetic::Remainder => builder.binary(Binary::Rem, a, b),
            Arithmetic::Power => match exponent {
                Some(n) if n == n.trunc() && n.abs() <= f64::from(WRITTEN_OUT) && n != 0.0 => {
                    self.whole_power(a, n as i32, span)
                }
                _ => builder.call2(operators::power, Rule::Power, a, b),
            },
        }
    }

    /// aⁿ for n ≠ 0 by repeated squaring, as [`crate::math::elementary::powi`] does it.
    fn whole_power(&mut self, a: Register, n: i32, span: Span) -> Register {
        let builder = self.at(span);
        let one = builder.constant(1.0);
        let mut base = if n < 0 { builder.binary(Binary::Div, one, a) } else { a };
        let mut n = n.unsigned_abs();
        let mut result: Option<Register> = None;
        loop {
            if n & 1 == 1 {
                result = Some(result.map_or(base, |r| builder.binary(Binary::Mul, r, base)));
            }
            n >>= 1;
            if n == 0 {
                return result.unwrap_or(one);
            }
            base = builder.binary(Binary::Mul, base, base);
        }
    }

    fn compare(&mut self, op: Comparison, a: &Symbol, b: &Symbol, span: Span) -> Compiled {
        if let (Some(x), Some(y)) = (a.known(), b.known()) {
            let holds = match op {
                Comparison::Equal => equal(&x, &y),
                Comparison::NotEqual => !equal(&x, &y),
                Comparison::Less | Comparison::LessEqual | Comparison::Greater | Comparison::GreaterEqual => {
                    operators::order(op, &x, &y, span)?
                }
            };
            return Ok(Symbol::Known(Value::Bool(holds)));
        }
        let (Some((s, u)), Some((t, v))) = (self.held(a), self.held(b)) else {
            return Err(self
                .mismatch(format!("`{}` cannot compare {} and {}", op.text(), a.shown(), b.shown()), span));
        };
        let equality = matches!(op, Comparison::Equal | Comparison::NotEqual);
        if s != t && equality {
            return Ok(Symbol::Known(Value::Bool(op == Comparison::NotEqual)));
        }
        if s != t || (!equality && u.len() != 1) {
            return Err(self
                .mismatch(format!("`{}` cannot compare {} and {}", op.text(), a.shown(), b.shown()), span));
        }
        let builder = self.at(span);
        let one = |builder: &mut crate::math::field::FieldBuilder, op: Binary| builder.binary(op, u[0], v[0]);
        Ok(Symbol::Bool(match op {
            Comparison::Less => one(builder, Binary::Less),
            Comparison::LessEqual => one(builder, Binary::LessEqual),
            Comparison::Greater => builder.binary(Binary::Less, v[0], u[0]),
            Comparison::GreaterEqual => builder.binary(Binary::LessEqual, v[0], u[0]),
            Comparison::Equal | Comparison::NotEqual => {
                let differ: Vec<Register> =
                    u.iter().zip(&v).map(|(x, y)| builder.binary(Binary::NotEqual, *x, *y)).collect();
                let any = differ[1..].iter().fold(differ[0], |any, d| builder.binary(Binary::Max, any, *d));
                if op == Comparison::Equal { builder.unary(Unary::Not, any) } else { any }
            }
        }))
    }

    /// `&&` (decided by false) and `||` (decided by true).
    fn short(&mut self, operands: &'c (Expr, Expr), decided_by: bool, span: Span) -> Compiled {
        let first = match self.truth(&operands.0)? {
            Truth::Known(b) if b == decided_by => return Ok(Symbol::Known(Value::Bool(b))),
            Truth::Known(_) => {
                return Ok(match self.truth(&operands.1)? {
                    Truth::Known(b) => Symbol::Known(Value::Bool(b)),
                    Truth::Register(r) => Symbol::Bool(r),
                });
            }
            Truth::Register(r) => r,
        };
        let builder = self.at(span);
        let result = builder.variable(first);
        let end = builder.label();
        match decided_by {
            false => builder.jump_if_zero(first, end),
            true => builder.jump_if_not_zero(first, end),
        }
        let second = match self.truth(&operands.1)? {
            Truth::Known(b) => self.builder.constant(f64::from(u8::from(b))),
            Truth::Register(r) => r,
        };
        let builder = self.at(span);
        builder.assign(result, second);
        builder.bind(end);
        Ok(Symbol::Bool(result))
    }

    pub(super) fn truth(&mut self, e: &'c Expr) -> Compiled<Truth> {
        match self.expr(e)? {
            Symbol::Known(Value::Bool(b)) => Ok(Truth::Known(b)),
            Symbol::Bool(r) => Ok(Truth::Register(r)),
            other => {
                let message = format!("a condition is true or false, and this is {}", other.shown());
                Err(self.mismatch(message, e.span))
            }
        }
    }

    fn choice(&mut self, parts: &'c (Expr, Expr, Expr), span: Span) -> Compiled {
        let condition = match self.truth(&parts.0)? {
            Truth::Known(true) => return self.expr(&parts.1),
            Truth::Known(false) => return self.expr(&parts.2),
            Truth::Register(r) => r,
        };
        let (otherwise, end) = (self.builder.label(), self.builder.label());
        self.at(span).jump_if_zero(condition, otherwise);
        let first = self.expr(&parts.1)?;
        let Some((shape, registers)) = self.held(&first) else {
            return Err(self.undecided(&first, parts.1.span));
        };
        let results: Vec<Register> = registers.iter().map(|r| self.at(span).variable(*r)).collect();
        self.builder.jump(end);
        self.builder.bind(otherwise);
        let second = self.expr(&parts.2)?;
        match self.held(&second) {
            Some((other, registers)) if other == shape => {
                results.iter().zip(&registers).for_each(|(to, from)| self.at(span).assign(*to, *from));
            }
            _ => {
                let message = format!("one branch gives {}, the other {}", first.shown(), second.shown());
                return Err(self.mismatch(message, span));
            }
        }
        self.builder.bind(end);
        Ok(symbol_of(shape, &results))
    }

    /// A value that cannot hang on what is only known at a sample.
    pub(super) fn undecided(&self, symbol: &Symbol, span: Span) -> Stop {
        let message =
            format!("{} cannot be chosen while rendering: only numbers and vectors can", symbol.shown());
        self.refuse(Code::NotSampled, span, message).into()
    }

    fn range(&mut self, range: &'c Range, span: Span) -> Compiled {
        let mut known = |e: &'c Expr| -> Compiled<f64> {
            match self.expr(e)? {
                Symbol::Known(Value::Number(x)) if x.is_finite() => Ok(x),
                Symbol::Known(other) => Err(self.mismatch(
                    format!(
                        "a range runs over finite numbers, and this is {}",
                        crate::lang::coerce::shown(&other)
                    ),
                    e.span,
                )),
                _ => Err(self
                    .refuse(
                        Code::NotSampled,
                        e.span,
                        "the ends of a range must be known when the function is made",
                    )
                    .hint("use `while` for a number of turns that only a sample decides")
                    .into()),
            }
        };
        let (start, end) = (known(&range.start)?, known(&range.end)?);
        let step = range.step.as_ref().map_or(Ok(1.0), known)?;
        match RangeValue::new(start, end, step, range.inclusive) {
            Some(range) => Ok(Symbol::Known(Value::Range(Rc::new(range)))),
            None => Err(self.mismatch("a range cannot go on in steps of 0".into(), span)),
        }
    }

    fn comprehension(&mut self, c: &'c Comprehension) -> Compiled {
        let list = self.expr(&c.list)?;
        let Some(elements) = self.turns(&list, c.list.span)? else {
            return Err(self.mismatch(
                format!("a loop runs over a range or a list, and this is {}", list.shown()),
                c.list.span,
            ));
        };
        let mut made = Vec::new();
        for element in elements {
            self.frame().slots[c.slot as usize] = Some(element);
            if let Some(condition) = &c.condition {
                match self.truth(condition)? {
                    Truth::Known(true) => {}
                    Truth::Known(false) => continue,
                    Truth::Register(_) => {
                        return Err(self
                            .refuse(
                                Code::NotSampled,
                                condition.span,
                                "which elements a list has must be known when the function is made",
                            )
                            .into());
                    }
                }
            }
            made.push(self.expr(&c.value)?);
        }
        Ok(Symbol::List(Rc::new(made)))
    }

    pub(super) fn field(&mut self, base: &Symbol, name: &str, span: Span) -> Compiled {
        let found = match base {
            Symbol::Known(value) => match swizzle(value, name) {
                Some(value) => Some(Symbol::Known(value)),
                None => match members::field(self.host, value, name, span) {
                    Some(outcome) => Some(Symbol::Known(outcome?)),
                    None => return Err(members::unknown(value, name, members::Form::Field, span).into()),
                },
            },
            Symbol::Record(parts) => parts.iter().find(|(n, _)| *n == name).map(|(_, s)| s.clone()),
            Symbol::Vector(registers) => crate::lang::eval::letters(name, registers.len())
                .map(|picked| number_or_vector(picked.iter().map(|i| registers[*i]).collect())),
            Symbol::Number(_) | Symbol::Bool(_) | Symbol::List(_) | Symbol::Function(..) => None,
        };
        found.ok_or_else(|| {
            let said = self.refuse(Code::NoSuchField, span, format!("{} has no `.{name}`", base.shown()));
            match base {
                Symbol::Record(_) => said.hint("a hit has `.p`, `.n`, `.uv` and `.t`").into(),
                _ => said.into(),
            }
        })
    }

    fn index(&mut self, list: &Symbol, index: &Symbol, at: &Expr) -> Compiled {
        let elements = match (self.elements(list, at.span)?, self.components(list)) {
            (Some(elements), _) => elements,
            (None, Some(registers)) if registers.len() > 1 => {
                registers.into_iter().map(Symbol::Number).collect()
            }
            (None, _) => {
                return Err(self.mismatch(
                    format!("only lists and vectors have elements, and this is {}", list.shown()),
                    at.span,
                ));
            }
        };
        match index {
            Symbol::Known(Value::Number(i)) => match place(*i, elements.len()) {
                Some(i) => Ok(elements[i].clone()),
                None => Err(self
                    .refuse(
                        Code::IndexOutOfRange,
                        at.span,
                        format!("index {i} is outside a list of {}", elements.len()),
                    )
                    .into()),
            },
            Symbol::Number(register) => self.gather(&elements, *register, at.span),
            _ => Err(self.mismatch(format!("an index is a number, and this is {}", index.shown()), at.span)),
        }
    }

    /// An element that only a sample decides.
    fn gather(&mut self, elements: &[Symbol], index: Register, span: Span) -> Compiled {
        let mut rows = Vec::with_capacity(elements.len());
        let mut shape = None;
        for element in elements {
            match self.held(element) {
                Some((s, registers)) if shape.is_none_or(|before| before == s) => {
                    shape = Some(s);
                    rows.push(registers);
                }
                _ => return Err(self.undecided(element, span)),
            }
        }
        let Some(shape) = shape else {
            return Err(self.refuse(Code::IndexOutOfRange, span, "an element of an empty list").into());
        };
        let known: Option<Vec<Vec<f64>>> = elements.iter().map(known_components).collect();
        let width = rows[0].len();
        let picked: Vec<Register> = (0..width)
            .map(|i| match &known {
                Some(known) => {
                    let column: Vec<f64> = known.iter().map(|row| row[i]).collect();
                    let builder = self.at(span);
                    let table = builder.add_table(column);
                    builder.table(table, index)
                }
                None => {
                    let column: Vec<Register> = rows.iter().map(|row| row[i]).collect();
                    self.at(span).gather(&column, index)
                }
            })
            .collect();
        Ok(symbol_of(shape, &picked))
    }
}

/// A condition.
pub(super) enum Truth {
    Known(bool),
    Register(Register),
}

fn known_components(symbol: &Symbol) -> Option<Vec<f64>> {
    match symbol {
        Symbol::Known(Value::Number(x)) => Some(vec![*x]),
        Symbol::Known(value) => {
            let components = crate::lang::eval::components(value);
            (!components.is_empty()).then_some(components)
        }
        _ => None,
    }
}

pub(super) fn number_or_vector(mut registers: Vec<Register>) -> Symbol {
    match registers.len() {
        1 => Symbol::Number(registers.remove(0)),
        _ => Symbol::Vector(registers),
    }
}
