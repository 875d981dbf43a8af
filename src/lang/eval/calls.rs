//! Calls.

use super::slots::{Captured, Slot};
use super::{Around, Call, Evaluator, Flow, Produced};
use crate::diag::{Code, Diagnostic, Span};
use crate::lang::builtins;
use crate::lang::coerce::shown;
use crate::lang::members::{self, Ask, Form, Member, curves};
use crate::lang::resolve::program::{
    Access, Argument, Body, CallBuiltin, CallFunction, CallMethod, CallValue, Expr, FunctionBody, FunctionId,
};
use crate::lang::table::{Arguments, Builtin, BuiltinBody, Context, Outcome, Reported};
use crate::lang::value::Value;
use std::rc::Rc;

impl<'p> Evaluator<'p> {
    /// A call of a builtin with values, and the guards on what it makes.
    pub(super) fn call_table(
        &mut self,
        builtin: &'static Builtin,
        values: &[Value],
        spans: &[Span],
        span: Span,
    ) -> Outcome {
        let value = builtins::call(self, builtin, &Arguments { values, spans, span })?;
        match &value {
            Value::Text(text) => self.spend(text.len() as u64, span)?,
            Value::List(list) => self.reserve_list(list.len(), span)?,
            _ => {}
        }
        Ok(value)
    }

    pub(super) fn call_builtin(&mut self, call: &'p CallBuiltin, span: Span) -> Outcome {
        if let (BuiltinBody::Number2(f), [(0, a), (1, b)]) = (&call.builtin.body, &call.arguments[..]) {
            let number = self.number_of_two(call, *f, (a, b), span);
            return self.outcome(number);
        }
        let mut values = call.defaults.clone();
        let mut outcome = Ok(());
        for (i, argument) in &call.arguments {
            match self.expr(argument) {
                Ok(value) => values[*i as usize] = value,
                Err(reported) => outcome = Err(reported),
            }
        }
        outcome?;
        self.call_table(call.builtin, &values, &call.spans, span)
    }

    /// The number that a call of a declared function gives; none where it is another value or failed, which then is in `spilled`.
    #[inline(never)]
    pub(super) fn number_of_function(&mut self, call: &'p CallFunction, span: Span) -> Option<f64> {
        if let Some(x) = self.number_of_short_call(call) {
            return Some(x);
        }
        let captured = match self.captured_by(call.callee, span) {
            Ok(captured) => captured,
            Err(reported) => return self.spill(Err(reported)),
        };
        let base = self.open_frame(call.function);
        for (i, argument) in &call.arguments {
            if let Err(reported) = self.put(base + *i as usize, argument) {
                self.stack.truncate(base);
                return self.spill(Err(reported));
            }
        }
        self.enter(call.function, captured, base, span)
    }

    /// What a declared function captured.
    #[inline]
    fn captured_by(&mut self, callee: Access, span: Span) -> Outcome<Option<Rc<Captured>>> {
        match callee {
            Access::Global(_) => Ok(None),
            Access::Sibling(_) => Ok(self.captured.clone()),
            Access::Local(_) | Access::Captured(_) => match self.read(callee, span)? {
                Value::Function(closure) => Ok(closure.captured.clone()),
                other => Err(self.not_callable(&other, span)),
            },
        }
    }

    /// Puts an argument into its slot; a number without taking it through a [`Value`] elsewhere.
    #[inline]
    fn put(&mut self, place: usize, argument: &'p Expr) -> Outcome<()> {
        if let Some(x) = self.number_at_once(argument) {
            self.stack[place] = Slot::Value(Value::Number(x));
            return Ok(());
        }
        self.stack[place] = Slot::Value(self.expr(argument)?);
        Ok(())
    }

    /// Slots for a frame; its base.
    fn open_frame(&mut self, function: FunctionId) -> usize {
        let base = self.stack.len();
        let n_slots = self.program.functions[function.0 as usize].n_slots as usize;
        self.stack.resize_with(base + n_slots, Slot::default);
        base
    }

    /// Runs a function whose arguments stand in its frame, and takes the frame down. The number that it gives; none where it is another
    /// value or failed, which then is in `spilled`.
    fn enter(
        &mut self,
        function: FunctionId,
        captured: Option<Rc<Captured>>,
        base: usize,
        span: Span,
    ) -> Option<f64> {
        if let Err(reported) = self.deeper(span) {
            self.stack.truncate(base);
            return self.spill(Err(reported));
        }
        self.calls.push(Call { function, span, base });
        let outer_base = std::mem::replace(&mut self.base, base);
        let outer_captured = std::mem::replace(&mut self.captured, captured);
        let number = self.run_function(function, span);
        self.base = outer_base;
        self.captured = outer_captured;
        self.calls.pop();
        self.stack.truncate(base);
        number
    }

    fn run_function(&mut self, function: FunctionId, span: Span) -> Option<f64> {
        let function = &self.program.functions[function.0 as usize];
        for (i, parameter) in function.parameters.iter().enumerate() {
            let slot = self.base + i;
            if let (Some(default), Slot::Unset) = (&parameter.default, &self.stack[slot]) {
                match self.expr(default) {
                    Ok(value) => self.stack[slot] = Slot::Value(value),
                    Err(reported) => return self.spill(Err(reported)),
                }
            }
        }
        match &function.body {
            FunctionBody::Expr(value) => self.number(value),
            FunctionBody::Items(body) => {
                let value = self.run_items(body, span);
                self.spill(value)
            }
        }
    }

    fn run_items(&mut self, body: &'p Body, span: Span) -> Outcome {
        let mut out = Produced::new(Around::Braces);
        match (self.items(body, &mut out), self.returned.take()) {
            (Flow::Return, Some(value)) => value,
            (Flow::On | Flow::Return, _) => self.body_value(out, span),
        }
    }

    pub(super) fn call_value(&mut self, call: &'p CallValue, span: Span) -> Outcome {
        if let Some((curve, t)) = self.curve_of_call(call)
            && let Some(t) = self.number_at_once(t)
            && let Ok(point) = curves::point_at(curve, t)
        {
            return Ok(point);
        }
        let callee = self.expr(&call.callee);
        if let Ok(value) = &callee
            && let Some(member) = members::call_of(value)
        {
            return self.call_member(member, value, &call.arguments, span);
        }
        let arguments = self.argument_values(&call.arguments);
        let (callee, arguments) = (callee?, arguments?);
        match &callee {
            Value::Function(closure) => {
                let base = self.open_frame(closure.function);
                let bound = self.bind_arguments(closure.function, &call.arguments, arguments, base, span);
                if let Err(reported) = bound {
                    self.stack.truncate(base);
                    return Err(reported);
                }
                let number = self.enter(closure.function, closure.captured.clone(), base, span);
                self.outcome(number)
            }
            Value::Builtin(builtin) => self.call_builtin_value(builtin, &call.arguments, arguments, span),
            other => Err(self.not_callable(other, call.callee.span)),
        }
    }

    fn argument_values(&mut self, arguments: &'p [Argument]) -> Outcome<Vec<Value>> {
        let mut values = Vec::with_capacity(arguments.len());
        let mut outcome = Ok(());
        for argument in arguments {
            match self.expr(&argument.value) {
                Ok(value) => values.push(value),
                Err(reported) => outcome = Err(reported),
            }
        }
        outcome.map(|()| values)
    }

    /// Puts arguments into a frame.
    fn bind_arguments(
        &mut self,
        function: FunctionId,
        arguments: &[Argument],
        values: Vec<Value>,
        base: usize,
        span: Span,
    ) -> Outcome<()> {
        let function = &self.program.functions[function.0 as usize];
        for (position, (argument, value)) in arguments.iter().zip(values).enumerate() {
            let i = match &argument.name {
                None => position,
                Some((name, name_span)) => match function.parameters.iter().position(|p| p.name == *name) {
                    Some(i) => i,
                    None => {
                        let names = function.parameters.iter().map(|p| &*p.name);
                        let said = Diagnostic::new(
                            Code::WrongArity,
                            *name_span,
                            format!("no parameter is called `{name}`"),
                        )
                        .did_you_mean(name, names)
                        .also(function.span, "defined here");
                        return Err(self.fail(said));
                    }
                },
            };
            if i >= function.parameters.len() {
                return Err(self.wrong_count(function, arguments.len(), span));
            }
            self.stack[base + i] = Slot::Value(value);
        }
        self.check_bound(function, arguments.len(), base, span)
    }

    fn check_bound(
        &mut self,
        function: &crate::lang::resolve::program::Function,
        n: usize,
        base: usize,
        span: Span,
    ) -> Outcome<()> {
        let unset = |i: usize| matches!(self.stack[base + i], Slot::Unset);
        let lacks = function.parameters.iter().enumerate().any(|(i, p)| p.default.is_none() && unset(i));
        if lacks { Err(self.wrong_count(function, n, span)) } else { Ok(()) }
    }

    #[cold]
    fn wrong_count(
        &mut self,
        function: &crate::lang::resolve::program::Function,
        n: usize,
        span: Span,
    ) -> Reported {
        let parameters: Vec<&str> = function.parameters.iter().map(|p| &*p.name).collect();
        let message = format!(
            "this function takes {} ({}), and it is called with {n}",
            match parameters.len() {
                0 => "no arguments".to_owned(),
                1 => "1 argument".to_owned(),
                many => format!("{many} arguments"),
            },
            parameters.join(", ")
        );
        self.fail(Diagnostic::new(Code::WrongArity, span, message).also(function.span, "defined here"))
    }

    /// A builtin that was passed around as a value.
    fn call_builtin_value(
        &mut self,
        builtin: &'static Builtin,
        arguments: &[Argument],
        values: Vec<Value>,
        span: Span,
    ) -> Outcome {
        let given =
            arguments.iter().map(|a| (a.name.as_ref().map(|(name, _)| &**name), a.value.span)).zip(values);
        match members::bound(builtin.parameters, builtin.variadic, given, span) {
            Some((values, spans)) => self.call_table(builtin, &values, &spans, span),
            None => Err(self.wrong_builtin_count(builtin, span)),
        }
    }

    /// A member that is called. One argument, the common case, is passed without a list.
    fn call_member(
        &mut self,
        member: &'static Member,
        value: &Value,
        arguments: &'p [Argument],
        span: Span,
    ) -> Outcome {
        if let ([Argument { name: None, value: argument }], [_]) = (arguments, member.parameters) {
            let (given, spans) = ([self.expr(argument)?], [argument.span]);
            self.estimate = None;
            let arguments = Arguments { values: &given, spans: &spans, span };
            return (member.body)(self, &Ask { member, value, arguments: &arguments });
        }
        let values = self.argument_values(arguments)?;
        let given =
            arguments.iter().map(|a| (a.name.as_ref().map(|(name, _)| &**name), a.value.span)).zip(values);
        match members::bound(member.parameters, false, given, span) {
            Some((values, spans)) => {
                self.estimate = None;
                let arguments = Arguments { values: &values, spans: &spans, span };
                (member.body)(self, &Ask { member, value, arguments: &arguments })
            }
            None => Err(self.fail(members::wrong_arguments(member, value, span))),
        }
    }

    #[cold]
    fn wrong_builtin_count(&mut self, builtin: &Builtin, span: Span) -> Reported {
        let names: Vec<&str> = builtin.parameters.iter().map(|p| p.name).collect();
        let message = format!("`{}` takes other arguments than these", builtin.name);
        self.fail(Diagnostic::new(Code::WrongArity, span, message).hint(format!(
            "it is called `{}({})`",
            builtin.name,
            names.join(", ")
        )))
    }

    /// A call from a builtin (`map`, `fold`): surplus arguments are an error as in any call.
    pub(super) fn call_with_values(&mut self, function: &Value, arguments: &[Value], at: Span) -> Outcome {
        match function {
            Value::Function(closure) => {
                let base = self.open_frame(closure.function);
                let n = self.program.functions[closure.function.0 as usize].parameters.len();
                for (slot, value) in self.stack[base..].iter_mut().zip(arguments).take(n) {
                    *slot = Slot::Value(value.clone());
                }
                let declared = &self.program.functions[closure.function.0 as usize];
                let bound = if arguments.len() > n {
                    Err(self.wrong_count(declared, arguments.len(), at))
                } else {
                    self.check_bound(declared, arguments.len(), base, at)
                };
                if let Err(reported) = bound {
                    self.stack.truncate(base);
                    return Err(reported);
                }
                let number = self.enter(closure.function, closure.captured.clone(), base, at);
                self.outcome(number)
            }
            Value::Builtin(builtin) => {
                self.deeper(at)?;
                let mut values = arguments.to_vec();
                for parameter in builtin.parameters.iter().skip(arguments.len()) {
                    match parameter.default.and_then(builtins::default_value) {
                        Some(default) => values.push(default),
                        None => return Err(self.wrong_builtin_count(builtin, at)),
                    }
                }
                if values.len() > builtin.parameters.len() && !builtin.variadic {
                    return Err(self.wrong_builtin_count(builtin, at));
                }
                let spans = vec![at; values.len()];
                self.call_table(builtin, &values, &spans, at)
            }
            other => match members::call_of(other) {
                Some(member) if arguments.len() == member.parameters.len() => {
                    let spans = vec![at; arguments.len()];
                    let arguments = Arguments { values: arguments, spans: &spans, span: at };
                    (member.body)(self, &Ask { member, value: other, arguments: &arguments })
                }
                Some(member) => Err(self.fail(members::wrong_arguments(member, other, at))),
                None => Err(self.not_callable(other, at)),
            },
        }
    }

    #[cold]
    fn not_callable(&mut self, value: &Value, span: Span) -> Reported {
        let message = format!("only functions are called, and this is {}", shown(value));
        let said = Diagnostic::new(Code::NotCallable, span, message);
        self.fail(match value {
            Value::Number(_) => said.hint("a product is written with `*`"),
            Value::List(_) => said.hint("an element is written `list[i]`"),
            _ => said,
        })
    }

    /// `value.name(…)`: a method, or a field whose value is called.
    pub(super) fn call_method(&mut self, call: &'p CallMethod, span: Span) -> Outcome {
        let base = match self.expr(&call.base) {
            Ok(base) => base,
            Err(reported) => {
                self.argument_values(&call.arguments)?;
                return Err(reported);
            }
        };
        let from_name = Span { end: span.end, ..call.name_span };
        if let Some(member) = members::find(&base, &call.name, Form::Method) {
            return self.call_member(member, &base, &call.arguments, from_name);
        }
        if let Some(field) = members::field(self, &base, &call.name, call.name_span) {
            let field = field?;
            if let Some(member) = members::call_of(&field) {
                return self.call_member(member, &field, &call.arguments, from_name);
            }
        }
        self.argument_values(&call.arguments)?;
        let said = members::unknown(&base, &call.name, Form::Method, call.name_span);
        Err(self.fail(match builtins::find(&call.name) {
            Some(_) if said.hints.is_empty() => {
                said.hint(format!("`{0}` is a function: write `{0}(value, …)`", call.name))
            }
            _ => said,
        }))
    }
}
