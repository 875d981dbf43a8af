//! Expressions.

use super::program::{
    Arithmetic, Comparison, Comprehension, Expr, ExprKind, FunctionBody, Range, TextPart, With,
};
use super::scope::{Declared, Owner};
use super::{Meaning, Place, Resolver, straight};
use crate::diag::{Code, Diagnostic, Span};
use crate::lang::kinds;
use crate::lang::value::{self, Value};
use crate::syntax::ast::{self, BinaryOp, UnaryOp};

impl<'a> Resolver<'a> {
    pub(super) fn expr(&mut self, e: &'a ast::Expr) -> Expr {
        let kind = match &e.kind {
            ast::ExprKind::Number(x) => ExprKind::Number(*x),
            ast::ExprKind::Bool(b) => constant(Value::Bool(*b)),
            ast::ExprKind::Text(parts) => self.text(parts),
            ast::ExprKind::Colour(srgb) => constant(Value::Vector3(value::linear_from_srgb8(*srgb))),
            ast::ExprKind::Name(name) => return self.name(name, e.span, &[]),
            ast::ExprKind::Vector(components) => self.vector(components),
            ast::ExprKind::VectorLiteral { len, v } => constant(value::vector(&v[..usize::from(*len)])),
            ast::ExprKind::List(elements) => ExprKind::List(self.exprs(elements)),
            ast::ExprKind::Comprehension(c) => self.comprehension(c),
            ast::ExprKind::Unary(op, e) => self.unary(*op, e),
            ast::ExprKind::Binary(op, operands, _) => self.binary(*op, operands),
            ast::ExprKind::Choice(parts) => {
                ExprKind::Choice(Box::new((self.expr(&parts.0), self.expr(&parts.1), self.expr(&parts.2))))
            }
            ast::ExprKind::Range(range) => ExprKind::Range(Box::new(Range {
                start: self.expr(&range.start),
                end: self.expr(&range.end),
                inclusive: range.inclusive,
                step: range.step.as_ref().map(|s| self.expr(s)),
            })),
            ast::ExprKind::Call(call) => return self.call(call, e.span),
            ast::ExprKind::Field(base, name) => return self.field(base, name, e.span),
            ast::ExprKind::Index(parts) => {
                ExprKind::Index(Box::new((self.expr(&parts.0), self.expr(&parts.1))))
            }
            ast::ExprKind::With(with) => self.with(with),
            ast::ExprKind::Lambda(lambda) => self.lambda(lambda, e.span),
            ast::ExprKind::Block(block) => match kinds::find(&block.kind.name) {
                Some(kind) => ExprKind::Block(Box::new(self.block(kind, block, e.span))),
                None => {
                    self.report_unknown_kind(&block.kind);
                    ExprKind::Poison
                }
            },
            ast::ExprKind::Bad => ExprKind::Poison,
        };
        straight::beside(Expr { kind, span: e.span })
    }

    fn exprs(&mut self, list: &'a [ast::Expr]) -> Box<[Expr]> {
        list.iter().map(|e| self.expr(e)).collect()
    }

    /// A name's value. `words` are those that would also have fitted, for the hint.
    pub(super) fn name(&mut self, name: &'a str, span: Span, words: &[&str]) -> Expr {
        let kind = match self.meaning(name) {
            Some(Meaning::Variable(access, variable)) => {
                match variable.declared {
                    Declared::Value | Declared::Var | Declared::Function(_) => ExprKind::Name(access),
                    Declared::Poison => ExprKind::Poison,
                    Declared::Module(_) => {
                        self.report(
                        Diagnostic::new(Code::TypeMismatch, span, format!("`{name}` is an imported file, not a value"))
                            .also(variable.span, "imported here")
                            .hint(format!("write `{name}.scene` for all that it places, or `{name}.…` for one of its names")),
                    );
                        ExprKind::Poison
                    }
                }
            }
            Some(Meaning::Constant(Value::Number(x))) => ExprKind::Number(x),
            Some(Meaning::Constant(value)) => constant(value),
            Some(Meaning::Builtin(builtin)) => constant(Value::Builtin(builtin)),
            None => {
                self.report_unknown(name, span, words);
                ExprKind::Poison
            }
        };
        Expr { kind, span }
    }

    fn text(&mut self, parts: &'a [ast::TextPart]) -> ExprKind {
        match parts {
            [] => constant(Value::text("")),
            [ast::TextPart::Literal(text)] => constant(Value::text(text)),
            _ => ExprKind::Text(
                parts
                    .iter()
                    .map(|part| match part {
                        ast::TextPart::Literal(text) => TextPart::Literal(text.as_str().into()),
                        ast::TextPart::Value(e) => TextPart::Value(self.expr(e)),
                    })
                    .collect(),
            ),
        }
    }

    fn vector(&mut self, components: &'a [ast::Expr]) -> ExprKind {
        let components = self.exprs(components);
        let numbers: Option<Vec<f64>> = components
            .iter()
            .map(|c| if let ExprKind::Number(x) = c.kind { Some(x) } else { None })
            .collect();
        match numbers {
            Some(numbers) => constant(value::vector(&numbers)),
            None => ExprKind::Vector(components),
        }
    }

    fn comprehension(&mut self, c: &'a ast::Comprehension) -> ExprKind {
        let list = self.expr(&c.list);
        self.scopes.open(Vec::new(), false);
        let slot = self.declare_local(&c.variable);
        let condition = c.condition.as_ref().map(|e| self.expr(e));
        let value = self.expr(&c.value);
        self.scopes.close();
        ExprKind::Comprehension(Box::new(Comprehension { value, slot, list, condition }))
    }

    fn unary(&mut self, op: UnaryOp, e: &'a ast::Expr) -> ExprKind {
        let operand = self.expr(e);
        match (op, &operand.kind) {
            (UnaryOp::Negate, ExprKind::Number(x)) => ExprKind::Number(-x),
            (UnaryOp::Negate, _) => ExprKind::Negate(Box::new(operand)),
            (UnaryOp::Not, _) => ExprKind::Not(Box::new(operand)),
        }
    }

    fn binary(&mut self, op: BinaryOp, operands: &'a (ast::Expr, ast::Expr)) -> ExprKind {
        let operands = Box::new((self.expr(&operands.0), self.expr(&operands.1)));
        match op {
            BinaryOp::Or => ExprKind::Or(operands),
            BinaryOp::And => ExprKind::And(operands),
            BinaryOp::Equal => ExprKind::Compare(Comparison::Equal, operands),
            BinaryOp::NotEqual => ExprKind::Compare(Comparison::NotEqual, operands),
            BinaryOp::Less => ExprKind::Compare(Comparison::Less, operands),
            BinaryOp::LessEqual => ExprKind::Compare(Comparison::LessEqual, operands),
            BinaryOp::Greater => ExprKind::Compare(Comparison::Greater, operands),
            BinaryOp::GreaterEqual => ExprKind::Compare(Comparison::GreaterEqual, operands),
            BinaryOp::Add => ExprKind::Arithmetic(Arithmetic::Add, operands),
            BinaryOp::Subtract => ExprKind::Arithmetic(Arithmetic::Subtract, operands),
            BinaryOp::Multiply => ExprKind::Arithmetic(Arithmetic::Multiply, operands),
            BinaryOp::Divide => ExprKind::Arithmetic(Arithmetic::Divide, operands),
            BinaryOp::Remainder => ExprKind::Arithmetic(Arithmetic::Remainder, operands),
            BinaryOp::Power => ExprKind::Arithmetic(Arithmetic::Power, operands),
        }
    }

    fn with(&mut self, with: &'a ast::With) -> ExprKind {
        let base = self.expr(&with.base);
        let returns = self.scopes.set_returns(false);
        let body = self.body(&with.items, Place::Loose);
        self.scopes.set_returns(returns);
        ExprKind::With(Box::new(With { base, body, braces: with.braces }))
    }

    fn lambda(&mut self, lambda: &'a ast::Lambda, span: Span) -> ExprKind {
        let id = self.new_function(None, &lambda.parameters, span);
        let captures = self.scopes.new_captures();
        self.function_body(id, &lambda.parameters, Owner::Lambda, captures, |resolver| {
            FunctionBody::Expr(resolver.expr(&lambda.body))
        });
        ExprKind::Lambda(id, self.scopes.take_captures(captures).into())
    }

    /// `t.name` of an import, or a component of a value.
    fn field(&mut self, base: &'a ast::Expr, name: &'a ast::Ident, span: Span) -> Expr {
        if let Some(expr) = self.imported_name(base, name, span) {
            return expr;
        }
        let base = self.expr(base);
        let kind = match component(&name.name) {
            Some(i) => ExprKind::Component(i, Box::new(base)),
            None => ExprKind::Field(Box::new((base, self.word(&name.name), name.span))),
        };
        Expr { kind, span }
    }

    /// The unit that an expression names, where it is an import's alias.
    pub(super) fn imported(&mut self, base: &ast::Expr) -> Option<super::UnitId> {
        let ast::ExprKind::Name(alias) = &base.kind else { return None };
        match self.scopes.find(alias)?.1.declared {
            Declared::Module(unit) => Some(unit),
            Declared::Value | Declared::Var | Declared::Function(_) | Declared::Poison => None,
        }
    }

    fn imported_name(&mut self, base: &'a ast::Expr, name: &'a ast::Ident, span: Span) -> Option<Expr> {
        let unit = self.imported(base)?;
        let kind = match self.export(unit, name) {
            Some((access, _)) => ExprKind::Name(access),
            None => ExprKind::Poison,
        };
        Some(Expr { kind, span })
    }

    /// A name of an imported file; none is reported, or silent.
    pub(super) fn export(
        &mut self,
        unit: super::UnitId,
        name: &ast::Ident,
    ) -> Option<(super::Access, Declared)> {
        if let Some(scene) = self.program.units[unit.0 as usize].scene.filter(|_| &*name.name == "scene") {
            return Some((super::Access::Global(scene), Declared::Value));
        }
        let exports = self.exports.get(&unit)?;
        match exports.get(&*name.name) {
            Some((_, Declared::Poison | Declared::Module(_), _)) => None,
            Some((access, declared, _)) => Some((*access, *declared)),
            None => {
                let names: Vec<&str> = exports.keys().map(|k| &**k).chain(["scene"]).collect();
                let said = Diagnostic::new(
                    Code::UnknownName,
                    name.span,
                    format!("the imported file defines no `{}`", name.name),
                )
                .did_you_mean(&name.name, names);
                self.report(said);
                None
            }
        }
    }
}

fn constant(value: Value) -> ExprKind {
    ExprKind::Constant(Box::new(value))
}

/// The component that a name of one letter means.
fn component(name: &str) -> Option<u8> {
    match name {
        "x" => Some(0),
        "y" => Some(1),
        "z" => Some(2),
        "w" => Some(3),
        _ => None,
    }
}
