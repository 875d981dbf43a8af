//! Calls: functions of the scene are written out in place, builtins become steps.

use super::expressions::number_or_vector;
use super::symbol::{CapturedSymbol, Symbol};
use super::{Captures, Compiled, Compiler, DEEPEST, Frame};
use crate::diag::{Code, Diagnostic, Span};
use crate::lang::builtins;
use crate::lang::eval::operators;
use crate::lang::members::{self, Form};
use crate::lang::resolve::program::{
    Access, Argument, CallBuiltin, CallFunction, CallValue, Capture, FunctionBody, FunctionId,
};
use crate::lang::table::{Arguments, Builtin, BuiltinBody};
use crate::lang::value::Value;
use crate::math::field::{Binary, MAX_CALL, Register, Rule, Unary};
use std::rc::Rc;

/// Builtins that speak to the person: while rendering nobody listens.
const SPEAKING: [&str; 3] = ["print", "assert", "error"];

/// What is known of a builtin where it is bounded over intervals.
fn rule_of(builtin: &str) -> Rule {
    match builtin {
        "sin" => Rule::Sin,
        "cos" => Rule::Cos,
        "tan" => Rule::Tan,
        "asin" => Rule::Asin,
        "acos" => Rule::Acos,
        "atan" => Rule::Atan,
        "sinh" => Rule::Sinh,
        "cosh" => Rule::Cosh,
        "tanh" => Rule::Tanh,
        "exp" => Rule::Exp,
        "ln" => Rule::Ln,
        "log10" => Rule::Log10,
        "log2" => Rule::Log2,
        "cbrt" => Rule::Cbrt,
        "sign" => Rule::Sign,
        "round" => Rule::Round,
        "radians" => Rule::Radians,
        "degrees" => Rule::Degrees,
        "atan2" => Rule::Atan2,
        "mod" => Rule::FlooredMod,
        "mix" => Rule::Mix,
        "clamp" => Rule::Clamp,
        "smoothstep" => Rule::Smoothstep,
        "cross" => Rule::Cross,
        "length" => Rule::Length,
        "normalize" => Rule::Normalize,
        "distance" => Rule::Distance,
        "noise" => Rule::Noise,
        "fbm" => Rule::Fbm,
        _ => Rule::Opaque,
    }
}

impl<'c> Compiler<'c> {
    pub(super) fn call_function(&mut self, call: &'c CallFunction, span: Span) -> Compiled {
        let captures = match call.callee {
            Access::Global(_) => Captures::Values(None),
            Access::Sibling(_) => self.frame().captures.clone(),
            Access::Local(_) | Access::Captured(_) => match self.read(call.callee, span)? {
                Symbol::Known(Value::Function(closure)) => Captures::Values(closure.captured.clone()),
                Symbol::Function(_, captured) => Captures::Symbols(captured),
                other => return Err(self.not_callable(&other, span)),
            },
        };
        let n = self.function(call.function).parameters.len();
        let mut arguments: Vec<Option<Symbol>> = vec![None; n];
        for (i, argument) in &call.arguments {
            arguments[*i as usize] = Some(self.expr(argument)?);
        }
        self.enter_with(call.function, captures, arguments, span)
    }

    fn not_callable(&self, symbol: &Symbol, span: Span) -> super::Stop {
        let message = format!("only functions are called, and this is {}", symbol.shown());
        self.refuse(Code::NotCallable, span, message).into()
    }

    pub(super) fn call_value(&mut self, call: &'c CallValue, span: Span) -> Compiled {
        let callee = self.expr(&call.callee)?;
        let mut values = Vec::with_capacity(call.arguments.len());
        for argument in &call.arguments {
            values.push(self.expr(&argument.value)?);
        }
        match callee {
            Symbol::Known(Value::Function(closure)) => {
                let arguments = self.named(closure.function, &call.arguments, values, span)?;
                self.enter_with(closure.function, Captures::Values(closure.captured.clone()), arguments, span)
            }
            Symbol::Function(function, captured) => {
                let arguments = self.named(function, &call.arguments, values, span)?;
                self.enter_with(function, Captures::Symbols(captured), arguments, span)
            }
            Symbol::Known(Value::Builtin(builtin)) => {
                let spans: Vec<Span> = call.arguments.iter().map(|a| a.value.span).collect();
                self.builtin(builtin, values, &spans, span)
            }
            Symbol::Known(value) if members::call_of(&value).is_some() => {
                self.member(&value, "", Form::Call, (&call.arguments, values), span)
            }
            other => Err(self.not_callable(&other, call.callee.span)),
        }
    }

    fn named(
        &self,
        function: FunctionId,
        arguments: &[Argument],
        values: Vec<Symbol>,
        span: Span,
    ) -> Compiled<Vec<Option<Symbol>>> {
        let parameters = &self.function(function).parameters;
        let mut bound: Vec<Option<Symbol>> = vec![None; parameters.len()];
        for (position, (argument, value)) in arguments.iter().zip(values).enumerate() {
            let i = match &argument.name {
                None => Some(position),
                Some((name, _)) => parameters.iter().position(|p| p.name == *name),
            };
            match i.and_then(|i| bound.get_mut(i)) {
                Some(place) => *place = Some(value),
                None => return Err(self.wrong_arguments(function, span)),
            }
        }
        Ok(bound)
    }

    fn wrong_arguments(&self, function: FunctionId, span: Span) -> super::Stop {
        let function = self.function(function);
        let names: Vec<&str> = function.parameters.iter().map(|p| &*p.name).collect();
        self.refuse(Code::WrongArity, span, format!("this function takes ({})", names.join(", ")))
            .also(function.span, "defined here")
            .into()
    }

    /// Writes out a call with positional arguments.
    pub(super) fn enter(
        &mut self,
        function: FunctionId,
        captures: Captures,
        arguments: Vec<Symbol>,
        span: Span,
    ) -> Compiled {
        let n = self.function(function).parameters.len();
        if arguments.len() > n {
            return Err(self.wrong_arguments(function, span));
        }
        let mut bound: Vec<Option<Symbol>> = arguments.into_iter().map(Some).collect();
        bound.resize_with(n, || None);
        self.enter_with(function, captures, bound, span)
    }

    fn enter_with(
        &mut self,
        id: FunctionId,
        captures: Captures,
        arguments: Vec<Option<Symbol>>,
        span: Span,
    ) -> Compiled {
        let function = self.function(id);
        if self.frames.len() >= DEEPEST {
            return Err(self.endless(id, span));
        }
        let mut slots: Vec<Option<Symbol>> = arguments;
        slots.resize_with(function.n_slots as usize, || None);
        self.n_frames += 1;
        let bound_in = vec![0; slots.len()];
        let frame = Frame {
            id: self.n_frames,
            function: id,
            span,
            slots,
            captures,
            result: None,
            branch: 0,
            bound_in,
        };
        self.frames.push(frame);
        let value = self.body(id, span);
        if value.is_ok() {
            self.frames.pop();
        }
        value
    }

    fn body(&mut self, id: FunctionId, span: Span) -> Compiled {
        let function = self.function(id);
        for (i, parameter) in function.parameters.iter().enumerate() {
            if self.frame().slots[i].is_some() {
                continue;
            }
            let Some(default) = &parameter.default else { return Err(self.wrong_arguments(id, span)) };
            let value = self.expr(default)?;
            self.frame().slots[i] = Some(value);
        }
        match &function.body {
            FunctionBody::Expr(value) => self.expr(value),
            FunctionBody::Items(body) => self.function_items(body, span),
        }
    }

    fn endless(&self, id: FunctionId, span: Span) -> super::Stop {
        let recursive = self.frames.iter().any(|f| f.function == id);
        let name = self.function(id).name.as_deref().unwrap_or("function").to_owned();
        let message = match recursive {
            true => {
                format!("`{name}` calls itself, and where that ends is not known when the function is made")
            }
            false => format!("calls are nested {DEEPEST} deep in a function that runs while rendering"),
        };
        let said =
            Diagnostic::new(Code::NotSampled, span, message).also(self.function(id).span, "defined here");
        said.hint(
            "while rendering calls are written out in place: use a loop, or a depth that is a plain number",
        )
        .into()
    }

    /// A function value made by the function that is compiled.
    pub(super) fn lambda(&mut self, function: FunctionId, captures: &[Capture], span: Span) -> Compiled {
        let captured = self.captured(captures, span)?;
        Ok(Symbol::Function(function, Rc::new(captured)))
    }

    pub(super) fn captured(&mut self, captures: &[Capture], span: Span) -> Compiled<Vec<CapturedSymbol>> {
        let frame = self.frames.len() - 1;
        let id = self.frame().id;
        captures
            .iter()
            .map(|capture| {
                Ok(match capture {
                    Capture::Value(slot) => CapturedSymbol::Symbol(self.read(Access::Local(*slot), span)?),
                    Capture::Reference(slot) | Capture::Fresh(slot) => {
                        CapturedSymbol::Slot { frame, id, slot: *slot }
                    }
                    Capture::Outer(slot) => match self.frame().captures.clone() {
                        Captures::Symbols(symbols) => symbols[*slot as usize].clone(),
                        Captures::Values(_) => {
                            CapturedSymbol::Symbol(self.read(Access::Captured(*slot), span)?)
                        }
                    },
                    Capture::Sibling(function) => {
                        CapturedSymbol::Symbol(self.read(Access::Sibling(*function), span)?)
                    }
                })
            })
            .collect()
    }

    pub(super) fn call_builtin(&mut self, call: &'c CallBuiltin, span: Span) -> Compiled {
        let mut values: Vec<Symbol> = call.defaults.iter().cloned().map(Symbol::Known).collect();
        for (i, argument) in &call.arguments {
            values[*i as usize] = self.expr(argument)?;
        }
        self.builtin(call.builtin, values, &call.spans, span)
    }

    /// A call of a builtin. `spans` are the places of the arguments; where there are fewer, the call's stands for them.
    pub(super) fn builtin(
        &mut self,
        builtin: &'static Builtin,
        mut values: Vec<Symbol>,
        spans: &[Span],
        span: Span,
    ) -> Compiled {
        if SPEAKING.contains(&builtin.name) {
            return Err(self
                .refuse(Code::NotSampled, span, format!("`{}` cannot run while rendering", builtin.name))
                .hint("call it outside the function, on a value of its own")
                .into());
        }
        for parameter in builtin.parameters.iter().skip(values.len()) {
            if let Some(default) = parameter.default.and_then(builtins::default_value) {
                values.push(Symbol::Known(default));
            }
        }
        if let Some(known) = values.iter().map(Symbol::known).collect::<Option<Vec<Value>>>() {
            return self.known_call(builtin, &known, spans, span);
        }
        if let Some(value) = self.list_function(builtin.name, &values, span)? {
            return Ok(value);
        }
        let components: Option<Vec<Vec<Register>>> = values.iter().map(|v| self.components(v)).collect();
        let Some(components) = components else { return Err(self.wrong_builtin(builtin, &values, span)) };
        match &builtin.body {
            BuiltinBody::Number1(f) => self.spread(builtin, &components, &values, span, |c, of| {
                c.number1(builtin.name, *f, of[0], span)
            }),
            BuiltinBody::Number2(f) => self.spread(builtin, &components, &values, span, |c, of| {
                of[1..].iter().fold(of[0], |a, b| c.number2(builtin.name, *f, a, *b, span))
            }),
            BuiltinBody::Number3(_, f) => self.spread(builtin, &components, &values, span, |c, of| {
                c.at(span).call_n(*f, rule_of(builtin.name), of, 1)[0]
            }),
            BuiltinBody::Numbers(..)
                if builtin.name == "dot" && components[0].len() == components[1].len() =>
            {
                Ok(Symbol::Number(self.dot(&components[0], &components[1], span)))
            }
            BuiltinBody::Numbers(shape, f) => {
                let sizes: Vec<usize> = components.iter().map(Vec::len).collect();
                let flat: Vec<Register> = components.concat();
                match shape(&sizes) {
                    Some(n) if flat.len() <= MAX_CALL => {
                        Ok(number_or_vector(self.at(span).call_n(*f, rule_of(builtin.name), &flat, n)))
                    }
                    _ => Err(self.wrong_builtin(builtin, &values, span)),
                }
            }
            BuiltinBody::General(_) => Err(self.wrong_builtin(builtin, &values, span)),
        }
    }

    /// A call whose arguments are all known is made now. Where it has no value, the fault belongs to the samples that
    /// reach it.
    fn known_call(
        &mut self,
        builtin: &'static Builtin,
        known: &[Value],
        spans: &[Span],
        span: Span,
    ) -> Compiled {
        let plain = match &builtin.body {
            BuiltinBody::Number1(f) => match known {
                [Value::Number(x)] => Some((f(*x), x.is_finite())),
                _ => None,
            },
            BuiltinBody::Number2(f) => match known {
                [Value::Number(x), Value::Number(y)] => Some((f(*x, *y), x.is_finite() && y.is_finite())),
                _ => None,
            },
            BuiltinBody::Number3(..) | BuiltinBody::Numbers(..) | BuiltinBody::General(_) => None,
        };
        if let Some((x, finite)) = plain
            && (x.is_nan() || (finite && x.is_infinite()))
        {
            self.at(span).fault(crate::math::field::FaultKind::Undefined);
            return Ok(Symbol::Number(self.builder.constant(0.0)));
        }
        let all: Vec<Span> = (0..known.len()).map(|i| spans.get(i).copied().unwrap_or(span)).collect();
        let arguments = Arguments { values: known, spans: &all, span };
        Ok(Symbol::Known(builtins::call(self.host, builtin, &arguments)?))
    }

    /// Component by component; numbers among vectors stand for every component.
    fn spread(
        &mut self,
        builtin: &Builtin,
        components: &[Vec<Register>],
        values: &[Symbol],
        span: Span,
        f: impl Fn(&mut Self, &[Register]) -> Register,
    ) -> Compiled {
        let n = components.iter().map(Vec::len).max().unwrap_or(1);
        if components.iter().any(|c| c.len() != 1 && c.len() != n) {
            return Err(self.wrong_builtin(builtin, values, span));
        }
        let of = |c: &Vec<Register>, i: usize| c[if c.len() == 1 { 0 } else { i }];
        let mut results = Vec::with_capacity(n);
        for i in 0..n {
            let row: Vec<Register> = components.iter().map(|c| of(c, i)).collect();
            results.push(f(self, &row));
        }
        Ok(number_or_vector(results))
    }

    /// Written out, so that a vector's product with itself is known to be of squares.
    fn dot(&mut self, a: &[Register], b: &[Register], span: Span) -> Register {
        let builder = self.at(span);
        let products: Vec<Register> =
            a.iter().zip(b).map(|(a, b)| builder.binary(Binary::Mul, *a, *b)).collect();
        let sum = products.iter().copied().reduce(|sum, p| builder.binary(Binary::Add, sum, p));
        sum.expect("vectors have components")
    }

    fn number1(&mut self, name: &str, f: fn(f64) -> f64, a: Register, span: Span) -> Register {
        let builder = self.at(span);
        match name {
            "abs" => builder.unary(Unary::Abs, a),
            "sqrt" => builder.unary(Unary::Sqrt, a),
            "floor" => builder.unary(Unary::Floor, a),
            "ceil" => builder.unary(Unary::Ceil, a),
            _ => builder.call1(f, rule_of(name), a),
        }
    }

    fn number2(
        &mut self,
        name: &str,
        f: fn(f64, f64) -> f64,
        a: Register,
        b: Register,
        span: Span,
    ) -> Register {
        let builder = self.at(span);
        match name {
            "min" => builder.binary(Binary::Min, a, b),
            "max" => builder.binary(Binary::Max, a, b),
            "pow" => builder.call2(operators::power, Rule::Power, a, b),
            _ => builder.call2(f, rule_of(name), a, b),
        }
    }

    fn wrong_builtin(&self, builtin: &Builtin, values: &[Symbol], span: Span) -> super::Stop {
        let given: Vec<String> = values.iter().map(Symbol::shown).collect();
        match &builtin.body {
            BuiltinBody::General(_) => self
                .refuse(Code::NotSampled, span, format!("`{}` cannot run while rendering", builtin.name))
                .hint("compute it outside and let the function take it along")
                .into(),
            _ => self.mismatch(
                format!("`{}` cannot take {}", builtin.name, crate::lang::coerce::listed(&given, "and")),
                span,
            ),
        }
    }
}
