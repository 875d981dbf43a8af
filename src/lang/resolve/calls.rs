//! Calls: arguments are matched to parameters here wherever the function is known.

use super::program::{
    Argument, CallBuiltin, CallFunction, CallMethod, CallValue, Expr, ExprKind, FunctionId,
};
use super::scope::Declared;
use super::{Access, Meaning, Resolver, straight};
use crate::diag::{Code, Diagnostic, Span};
use crate::lang::builtins;
use crate::lang::members;
use crate::lang::table::{Builtin, BuiltinBody};
use crate::lang::value::Value;
use crate::syntax::ast;

/// What is called, as far as its parameters matter.
struct Callee<'c> {
    name: &'c str,
    parameters: Vec<(&'c str, bool)>,
    variadic: bool,
    /// The parameter that takes a name of the author's own, which may stand bare.
    bare: Option<usize>,
    /// Where it is declared, for a second label.
    span: Option<Span>,
}

impl<'a> Resolver<'a> {
    pub(super) fn call(&mut self, call: &'a ast::Call, span: Span) -> Expr {
        let kind = match &call.callee.kind {
            ast::ExprKind::Name(name) => self.call_name(name, call, span),
            ast::ExprKind::Field(base, method) => match self.imported(base) {
                Some(unit) => match self.export(unit, method) {
                    Some((access, Declared::Function(id))) => self.call_function(access, id, call),
                    Some((access, _)) => {
                        let callee = Expr { kind: ExprKind::Name(access), span: call.callee.span };
                        self.call_value(callee, call)
                    }
                    None => self.poisoned_call(call),
                },
                None => ExprKind::CallMethod(Box::new(CallMethod {
                    base: self.expr(base),
                    name: self.word(&method.name),
                    name_span: method.span,
                    arguments: self.method_arguments(&method.name, call),
                })),
            },
            _ => {
                let callee = self.expr(&call.callee);
                self.call_value(callee, call)
            }
        };
        straight::beside(Expr { kind, span })
    }

    fn call_name(&mut self, name: &'a str, call: &'a ast::Call, span: Span) -> ExprKind {
        match self.meaning(name) {
            Some(Meaning::Variable(access, variable)) => match variable.declared {
                Declared::Function(id) => self.call_function(access, id, call),
                Declared::Value | Declared::Var => {
                    let callee = Expr { kind: ExprKind::Name(access), span: call.callee.span };
                    self.call_value(callee, call)
                }
                Declared::Poison => self.poisoned_call(call),
                Declared::Module(_) => {
                    self.expr(&call.callee);
                    self.poisoned_call(call)
                }
            },
            Some(Meaning::Builtin(builtin)) => self.call_builtin(builtin, call, span),
            Some(Meaning::Constant(value)) => {
                let callee = Expr { kind: ExprKind::Constant(Box::new(value)), span: call.callee.span };
                self.call_value(callee, call)
            }
            None => {
                self.report_unknown(name, call.callee.span, &[]);
                self.poisoned_call(call)
            }
        }
    }

    /// The arguments of a call that cannot be made are resolved all the same: what is wrong in them is said.
    fn poisoned_call(&mut self, call: &'a ast::Call) -> ExprKind {
        self.arguments(call);
        ExprKind::Poison
    }

    fn arguments(&mut self, call: &'a ast::Call) -> Vec<Argument> {
        call.arguments
            .iter()
            .map(|a| Argument {
                name: a.name.as_ref().map(|n| (self.word(&n.name), n.span)),
                value: self.expr(&a.value),
            })
            .collect()
    }

    /// The arguments of a method: where a value's method of this name takes a name of the author's own, that stands bare.
    fn method_arguments(&mut self, method: &str, call: &'a ast::Call) -> Vec<Argument> {
        let mut arguments = Vec::with_capacity(call.arguments.len());
        for (position, a) in call.arguments.iter().enumerate() {
            let name = a.name.as_ref().map(|n| (self.word(&n.name), n.span));
            let bare = members::takes_bare(method, position, name.as_ref().map(|(name, _)| &**name));
            // Of a method that no value has, that is what must be said.
            let astray = !members::is_member(method) && self.is_unknown(&a.value);
            let value = self.word_or_expr(&a.value, bare || astray);
            arguments.push(Argument { name, value });
        }
        arguments
    }

    /// Whether this is a name that nothing has.
    fn is_unknown(&self, e: &ast::Expr) -> bool {
        matches!(&e.kind, ast::ExprKind::Name(name) if !self.in_scope(name))
    }

    /// A name as the word that it is, where it stands for itself; anything else as an expression.
    fn word_or_expr(&mut self, e: &'a ast::Expr, stands_for_itself: bool) -> Expr {
        match &e.kind {
            ast::ExprKind::Name(name) if stands_for_itself => {
                let word = Value::Word(self.word(name));
                Expr { kind: ExprKind::Constant(Box::new(word)), span: e.span }
            }
            _ => self.expr(e),
        }
    }

    fn call_value(&mut self, callee: Expr, call: &'a ast::Call) -> ExprKind {
        let arguments = self.arguments(call);
        ExprKind::CallValue(Box::new(CallValue { callee, arguments }))
    }

    fn call_function(&mut self, access: Access, id: FunctionId, call: &'a ast::Call) -> ExprKind {
        let signature = self.signatures[id.0 as usize].clone();
        let callee = Callee {
            name: &signature.name,
            parameters: signature.parameters.iter().map(|(n, default)| (&**n, *default)).collect(),
            variadic: false,
            bare: None,
            span: Some(signature.span),
        };
        match self.matched(&callee, call) {
            Some(arguments) => {
                ExprKind::CallFunction(Box::new(CallFunction { callee: access, function: id, arguments }))
            }
            None => ExprKind::Poison,
        }
    }

    fn call_builtin(&mut self, builtin: &'static Builtin, call: &'a ast::Call, span: Span) -> ExprKind {
        let callee = Callee {
            name: builtin.name,
            parameters: builtin.parameters.iter().map(|p| (p.name, p.default.is_some())).collect(),
            variadic: builtin.variadic,
            bare: builtin.parameters.iter().position(|p| p.bare),
            span: None,
        };
        let Some(mut arguments) = self.matched(&callee, call) else { return ExprKind::Poison };
        if let (BuiltinBody::Number1(f), [_]) = (&builtin.body, &arguments[..]) {
            let (_, argument) = arguments.remove(0);
            return ExprKind::CallNumber(builtin, *f, Box::new(argument));
        }
        let n = arguments.iter().map(|(i, _)| *i as usize + 1).max().unwrap_or(0);
        let default = |p: &crate::lang::table::Parameter| p.default.and_then(builtins::default_value);
        let mut defaults: Vec<Value> =
            builtin.parameters.iter().map(|p| default(p).unwrap_or(Value::Bool(false))).collect();
        let mut spans = vec![span; defaults.len().max(n)];
        defaults.resize(spans.len(), Value::Bool(false));
        for (i, argument) in &arguments {
            spans[*i as usize] = argument.span;
        }
        ExprKind::CallBuiltin(Box::new(CallBuiltin { builtin, arguments, defaults, spans: spans.into() }))
    }

    /// The arguments with the parameters that they fill; none where they do not fit, which is reported.
    fn matched(&mut self, callee: &Callee<'_>, call: &'a ast::Call) -> Option<Vec<(u32, Expr)>> {
        let mut matched: Vec<(u32, Expr)> = Vec::with_capacity(call.arguments.len());
        let mut sound = true;
        for (position, argument) in call.arguments.iter().enumerate() {
            let fills = argument
                .name
                .as_ref()
                .map_or(Some(position), |name| callee.parameters.iter().position(|(p, _)| **p == *name.name));
            // A variable may hold the name instead.
            let bare = callee.bare.is_some() && fills == callee.bare;
            let stands_for_itself = bare && self.is_unknown(&argument.value);
            let value = self.word_or_expr(&argument.value, stands_for_itself);
            let Some(name) = &argument.name else {
                matched.push((position as u32, value));
                continue;
            };
            match fills {
                Some(i) if matched.iter().any(|(filled, _)| *filled as usize == i) => {
                    sound = false;
                    self.report(Diagnostic::new(
                        Code::WrongArity,
                        name.span,
                        format!("the argument `{}` of `{}` is given twice", name.name, callee.name),
                    ));
                }
                Some(i) => matched.push((i as u32, value)),
                None => {
                    sound = false;
                    self.report_unknown_argument(callee, name);
                }
            }
        }
        let fits = sound && self.check_count(callee, call, &matched);
        fits.then_some(matched)
    }

    fn report_unknown_argument(&mut self, callee: &Callee<'_>, name: &ast::Ident) {
        let names: Vec<&str> = callee.parameters.iter().map(|(n, _)| *n).collect();
        let message = format!("`{}` has no parameter `{}`", callee.name, name.name);
        let mut said = Diagnostic::new(Code::WrongArity, name.span, message)
            .did_you_mean(&name.name, names.iter().copied());
        if said.hints.is_empty() {
            said = said.hint(format!("it is called `{}`", form(callee)));
        }
        if let Some(span) = callee.span {
            said = said.also(span, "defined here");
        }
        self.report(said);
    }

    fn check_count(&mut self, callee: &Callee<'_>, call: &ast::Call, matched: &[(u32, Expr)]) -> bool {
        let n = callee.parameters.len();
        let surplus = matched.iter().find(|(i, _)| *i as usize >= n).filter(|_| !callee.variadic);
        let is_given = |i: usize| matched.iter().any(|(filled, _)| *filled as usize == i);
        let missing: Vec<String> = callee
            .parameters
            .iter()
            .enumerate()
            .filter(|(i, (_, default))| !default && !is_given(*i))
            .map(|(_, (name, _))| format!("`{name}`"))
            .collect();
        let said = match surplus {
            Some((_, first)) => Diagnostic::new(
                Code::WrongArity,
                first.span,
                format!("`{}` takes {}, and this is one too many", callee.name, count(n, "argument")),
            ),
            None if !missing.is_empty() => Diagnostic::new(
                Code::WrongArity,
                call.parentheses,
                format!("the call of `{}` lacks {}", callee.name, missing.join(", ")),
            ),
            None => return true,
        };
        let said = said.hint(format!("it is called `{}`", form(callee)));
        self.report(match callee.span {
            Some(span) => said.also(span, "defined here"),
            None => said,
        });
        false
    }
}

/// "1 argument", "3 arguments".
fn count(n: usize, what: &str) -> String {
    match n {
        0 => format!("no {what}s"),
        1 => format!("1 {what}"),
        _ => format!("{n} {what}s"),
    }
}

/// `f(a, b = …, c…)`.
fn form(callee: &Callee<'_>) -> String {
    let last = callee.parameters.len().wrapping_sub(1);
    let parameters =
        callee.parameters.iter().enumerate().map(|(i, (name, default))| match (default, i == last) {
            (_, true) if callee.variadic => format!("{name}…"),
            (true, _) => format!("{name} = …"),
            (false, _) => (*name).to_owned(),
        });
    format!("{}({})", callee.name, parameters.collect::<Vec<_>>().join(", "))
}
