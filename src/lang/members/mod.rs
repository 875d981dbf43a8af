//! The table of members: what values have behind a dot (`path.length`, `path.velocity(t)`), and how values that are no functions are
//! called (`path(t)`). Evaluation, hints, the reference page and completion are derived from it; none of them knows a member by name.
//!
//! A family is the members of one type of value. A new type of value with members is a room here and its line in [`FAMILIES`].

mod ask;
pub mod curves;
mod models;
mod patches;
pub mod rigs;
#[cfg(test)]
mod tests;
mod transforms;

pub use ask::Ask;

use super::builtins;
use super::table::{Arguments, Context, Outcome, Parameter};
use super::value::Value;
use crate::diag::{Code, Diagnostic, Span};
use crate::lang::coerce::{listed, shown};
use crate::math::field::Held;
use std::sync::Arc;

/// The members of one type of value.
pub struct Family {
    /// The type in a word: "curve".
    pub name: &'static str,
    /// What such a value is, in one line.
    pub doc: &'static str,
    /// Whether a value is one.
    pub holds: fn(&Value) -> bool,
    /// The items in whose scope the examples stand.
    pub scene: &'static str,
    /// The members; the call of the value itself, if it has one, is the first.
    pub members: &'static [Member],
    /// Fields by names of the author's own: a pose's joints.
    pub named: Option<&'static Named>,
}

/// Fields that a value has by names of its author's own.
pub struct Named {
    /// What has such a name, in words: "joint or tip".
    pub what: &'static str,
    /// The value under a name.
    pub find: fn(&Value, &str) -> Option<Value>,
    /// All names.
    pub names: fn(&Value) -> Vec<String>,
}

/// How a member is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// `value(…)`.
    Call,
    /// `value.name`.
    Field,
    /// `value.name(…)`.
    Method,
}

/// A member of a type of value.
pub struct Member {
    /// Its name; empty for the call of the value itself. A name may be a field and a method.
    pub name: &'static str,
    /// How it is written.
    pub form: Form,
    /// Its parameters; none for a field.
    pub parameters: &'static [Parameter],
    /// What it gives, in one line.
    pub doc: &'static str,
    /// An expression that shows it, and what it gives; checked by a test.
    pub example: (&'static str, &'static str),
    /// How.
    pub body: Body,
    /// How tapes call it; none where it cannot run while rendering.
    pub sampled: Option<Sampling>,
}

/// Computes a member. Arguments stand in the order of the parameters, defaults filled in.
pub type Body = fn(&mut dyn Context, &Ask<'_>) -> Outcome;

/// What a tape calls for a member of this value; none where this value has no such member.
pub type Sampling = fn(&Value) -> Option<Sampled>;

/// A member as tapes call it.
pub struct Sampled {
    /// How many numbers its argument has.
    pub takes: usize,
    /// How many numbers it gives, by the names of the parts; one part without a name is the value itself.
    pub gives: Vec<(&'static str, usize)>,
    /// The function.
    pub held: Arc<dyn Held>,
}

/// Every family.
pub static FAMILIES: &[&Family] =
    &[&curves::FAMILY, &patches::FAMILY, &models::FAMILY, &rigs::FAMILY, &transforms::FAMILY];

impl Member {
    /// A field.
    pub const fn field(
        name: &'static str,
        doc: &'static str,
        example: (&'static str, &'static str),
        body: Body,
    ) -> Member {
        Member { name, form: Form::Field, parameters: &[], doc, example, body, sampled: None }
    }

    /// A method.
    pub const fn method(
        name: &'static str,
        parameters: &'static [Parameter],
        doc: &'static str,
        example: (&'static str, &'static str),
        body: Body,
    ) -> Member {
        Member { name, form: Form::Method, parameters, doc, example, body, sampled: None }
    }

    /// The same, but tapes can call it.
    pub const fn sampled(self, sampling: Sampling) -> Member {
        Member { sampled: Some(sampling), ..self }
    }

    /// How it is written after a value: `.frame(t, up = y)`, `.length`, `(t)`.
    pub fn written(&self) -> String {
        let one = |p: &Parameter| p.default.map_or(p.name.to_string(), |d| format!("{} = {d}", p.name));
        let parameters: Vec<String> = self.parameters.iter().map(one).collect();
        match self.form {
            Form::Call => format!("({})", parameters.join(", ")),
            Form::Field => format!(".{}", self.name),
            Form::Method => format!(".{}({})", self.name, parameters.join(", ")),
        }
    }
}

/// The family of a value.
pub fn family(value: &Value) -> Option<&'static Family> {
    FAMILIES.iter().copied().find(|family| (family.holds)(value))
}

/// How a value that is no function is called.
#[inline]
pub fn call_of(value: &Value) -> Option<&'static Member> {
    family(value)?.members.first().filter(|member| member.form == Form::Call)
}

/// A member by its name and form.
pub fn find(value: &Value, name: &str, form: Form) -> Option<&'static Member> {
    family(value)?.members.iter().find(|member| member.name == name && member.form == form)
}

/// Whether a method of this name takes a name of the author's own, which may be written bare, for an argument at this position or of
/// this name.
pub fn takes_bare(method: &str, position: usize, named: Option<&str>) -> bool {
    let members = FAMILIES.iter().flat_map(|family| family.members);
    let mut methods = members.filter(|member| member.name == method && member.form == Form::Method);
    let is_it = |(i, p): (usize, &Parameter)| p.bare && named.map_or(i == position, |name| name == p.name);
    methods.any(|member| member.parameters.iter().enumerate().any(is_it))
}

/// Whether some value has a member of this name.
pub fn is_member(name: &str) -> bool {
    FAMILIES.iter().flat_map(|family| family.members).any(|member| member.name == name)
}

/// The value of a field; none where the value has no such one.
pub fn field(ctx: &mut dyn Context, value: &Value, name: &str, span: Span) -> Option<Outcome> {
    if let Value::Record(record) = value {
        return record.part(name).map(|part| Ok(part.clone()));
    }
    let Some(member) = find(value, name, Form::Field) else {
        return Some(Ok((family(value)?.named?.find)(value, name)?));
    };
    let arguments = Arguments { values: &[], spans: &[], span };
    Some((member.body)(ctx, &Ask { member, value, arguments: &arguments }))
}

/// Arguments, with the names and places they were given by, in the order of the parameters with defaults filled in. None where they
/// do not fit.
pub fn bound<'n>(
    parameters: &[Parameter],
    variadic: bool,
    given: impl Iterator<Item = ((Option<&'n str>, Span), Value)>,
    span: Span,
) -> Option<(Vec<Value>, Vec<Span>)> {
    let default = |p: &Parameter| Some((builtins::default_value(p.default?)?, span));
    let mut bound: Vec<Option<(Value, Span)>> = parameters.iter().map(default).collect();
    for (position, ((name, place), value)) in given.enumerate() {
        let i = name.map_or(Some(position), |name| parameters.iter().position(|p| p.name == name))?;
        match bound.get_mut(i) {
            Some(slot) => *slot = Some((value, place)),
            None if variadic => bound.push(Some((value, place))),
            None => return None,
        }
    }
    bound.into_iter().collect::<Option<Vec<_>>>().map(|bound| bound.into_iter().unzip())
}

/// What to say of a call whose arguments do not fit.
pub fn wrong_arguments(member: &Member, value: &Value, span: Span) -> Diagnostic {
    let what = if member.form == Form::Call { shown(value) } else { format!("`{}`", member.name) };
    let names: Vec<String> = member.parameters.iter().map(|p| format!("`{}`", p.name)).collect();
    let message = format!("{what} takes {}, and no other arguments", listed(&names, "and"));
    Diagnostic::new(Code::WrongArity, span, message).hint(format!("write it like `{}`", member.example.0))
}

/// The names of all members of a value: a record's parts, what its family has, and names of its author's own.
pub fn names_of(value: &Value) -> Vec<String> {
    if let Value::Record(record) = value {
        return record.parts.iter().map(|(name, _)| (*name).to_owned()).collect();
    }
    let Some(family) = family(value) else { return Vec::new() };
    let own = family.named.map_or(Vec::new(), |named| (named.names)(value));
    let tabled = family.members.iter().map(|member| member.name).filter(|name| !name.is_empty());
    own.into_iter().chain(tabled.map(str::to_owned)).collect()
}

/// What to say where a value has no such member: the other form of the name, the nearest one, or all that there are.
pub fn unknown(value: &Value, name: &str, form: Form, span: Span) -> Diagnostic {
    let named = family(value).and_then(|family| family.named);
    let (what, other) = match (form, named) {
        (Form::Method, _) => (format!("method `{name}`"), Form::Field),
        (Form::Field | Form::Call, Some(named)) => (format!("{} `{name}`", named.what), Form::Method),
        (Form::Field | Form::Call, None) => (format!("`.{name}`"), Form::Method),
    };
    let said = Diagnostic::new(Code::NoSuchField, span, format!("{} has no {what}", shown(value)));
    if let Some(member) = find(value, name, other) {
        return said.hint(format!("write `{}`: {}", member.written(), member.doc));
    }
    let names = names_of(value);
    let said = said.did_you_mean(name, names.iter().map(String::as_str));
    match family(value) {
        Some(family) if said.hints.is_empty() => {
            said.hint(format!("`ogee docs {}` lists what it has", family.name))
        }
        None if said.hints.is_empty() && !names.is_empty() => {
            let parts: Vec<String> = names.iter().map(|n| format!("`.{n}`")).collect();
            said.hint(format!("it has {}", listed(&parts, "and")))
        }
        _ => said,
    }
}
