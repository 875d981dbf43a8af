//! Members of values that are known when the function is made: what only samples know becomes a step that calls the value.

use super::expressions::number_or_vector;
use super::symbol::Symbol;
use super::{Compiled, Compiler, Stop};
use crate::diag::{Code, Span};
use crate::lang::builtins::components;
use crate::lang::members::{self, Ask, Form, Member};
use crate::lang::resolve::program::{Argument, CallMethod};
use crate::lang::table::Arguments;
use crate::lang::value::Value;
use crate::math::field::{FaultKind, Register};
use std::rc::Rc;

impl<'c> Compiler<'c> {
    /// `value.name(…)`.
    pub(super) fn call_method(&mut self, call: &'c CallMethod, span: Span) -> Compiled {
        let base = self.expr(&call.base)?;
        let values = call.arguments.iter().map(|a| self.expr(&a.value)).collect::<Compiled<Vec<_>>>()?;
        let Symbol::Known(value) = &base else {
            let message = format!("{} has no method `{}`", base.shown(), call.name);
            return Err(self.refuse(Code::NoSuchField, call.name_span, message).into());
        };
        let from_name = Span { end: span.end, ..call.name_span };
        if members::find(value, &call.name, Form::Method).is_some() {
            return self.member(value, &call.name, Form::Method, (&call.arguments, values), from_name);
        }
        if let Some(field) = members::field(self.host, value, &call.name, call.name_span)
            && let field = field?
            && members::call_of(&field).is_some()
        {
            return self.member(&field, "", Form::Call, (&call.arguments, values), from_name);
        }
        Err(members::unknown(value, &call.name, Form::Method, call.name_span).into())
    }

    /// A member that is called: now, where all is known, else by the tape.
    pub(super) fn member(
        &mut self,
        value: &Value,
        name: &str,
        form: Form,
        (arguments, values): (&'c [Argument], Vec<Symbol>),
        span: Span,
    ) -> Compiled {
        let member = members::find(value, name, form).expect("the caller looked it up");
        match values.iter().map(Symbol::known).collect::<Option<Vec<Value>>>() {
            Some(known) => self.member_of_known(member, value, (arguments, known), span),
            None => self.member_of_sample(member, value, (arguments, &values), span),
        }
    }

    /// Where it has no value, the fault belongs to the samples that reach it.
    fn member_of_known(
        &mut self,
        member: &'static Member,
        value: &Value,
        (arguments, known): (&'c [Argument], Vec<Value>),
        span: Span,
    ) -> Compiled {
        if let ([only], Some(sampled)) = (&known[..], member.sampled.and_then(|sampling| sampling(value)))
            && let Some((from, n)) = components(only)
            && n == sampled.takes
        {
            let mut to = vec![0.0; sampled.gives.iter().map(|(_, n)| n).sum()];
            if !sampled.held.call(&from[..n], &mut to) {
                self.at(span).fault(FaultKind::Undefined);
                let nothing = vec![self.builder.constant(0.0); to.len()];
                return Ok(parts(&sampled.gives, &nothing));
            }
        }
        let given = arguments.iter().map(|a| (a.name.as_ref().map(|(n, _)| &**n), a.value.span)).zip(known);
        let Some((values, spans)) = members::bound(member.parameters, false, given, span) else {
            return Err(members::wrong_arguments(member, value, span).into());
        };
        let arguments = Arguments { values: &values, spans: &spans, span };
        Ok(Symbol::Known((member.body)(self.host, &Ask { member, value, arguments: &arguments })?))
    }

    fn member_of_sample(
        &mut self,
        member: &'static Member,
        value: &Value,
        (arguments, values): (&[Argument], &[Symbol]),
        span: Span,
    ) -> Compiled {
        let Some(sampled) = member.sampled.and_then(|sampling| sampling(value)) else {
            return Err(self.impossible(&format!("{} cannot be asked", member.written()), span));
        };
        let named =
            |a: &Argument| a.name.as_ref().is_none_or(|(name, _)| **name == *member.parameters[0].name);
        let ([argument], true) = (values, arguments.iter().all(named)) else {
            return Err(members::wrong_arguments(member, value, span).into());
        };
        match self.components(argument) {
            Some(registers) if registers.len() == sampled.takes => {
                let n = sampled.gives.iter().map(|(_, n)| n).sum();
                let results = self.at(span).call_held(sampled.held, &registers, n);
                Ok(parts(&sampled.gives, &results))
            }
            _ => Err(self.wrong_argument(member, argument, span)),
        }
    }

    fn wrong_argument(&self, member: &Member, argument: &Symbol, span: Span) -> Stop {
        let takes = member.parameters.first().map_or("nothing", |p| p.takes);
        self.mismatch(format!("`{}` takes {takes}, and this is {}", member.written(), argument.shown()), span)
    }
}

/// One part without a name is the value, several are a record.
fn parts(gives: &[(&'static str, usize)], results: &[Register]) -> Symbol {
    if let [("", _)] = gives {
        return number_or_vector(results.to_vec());
    }
    let mut rest = results;
    let part = |(name, n): &(&'static str, usize)| {
        let (first, after) = rest.split_at(*n);
        rest = after;
        (*name, number_or_vector(first.to_vec()))
    };
    Symbol::Record(Rc::new(gives.iter().map(part).collect()))
}
