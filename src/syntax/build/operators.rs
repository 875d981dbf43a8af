//! Precedence: a flat list of operands and operators to a tree. Written by hand, because the list is read once and no
//! operator needs a table look-up; the levels are those of the reference.

use std::iter::Peekable;

use pest::iterators::Pairs;

use super::Rule;
use super::items::{Builder, Token};
use crate::diag::{Code, Diagnostic, Span};
use crate::syntax::ast::{BinaryOp, Expr, ExprKind, Lambda, Parameter, RangeExpr, UnaryOp};

/// The operands and operators of one expression, in order.
pub(super) type Flat<'a> = Peekable<Pairs<'a, Rule>>;

/// How tightly an operator binds, loosest first.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Level {
    Or,
    And,
    Comparison,
    Range,
    Sum,
    Product,
    Power,
}

/// An operator between operands.
#[derive(Clone, Copy)]
enum Infix {
    Binary(BinaryOp),
    Range { inclusive: bool },
    Step,
}

impl Infix {
    fn of(token: &Token<'_>) -> Option<Infix> {
        Some(match token.as_rule() {
            Rule::range_op => Infix::Range { inclusive: token.as_str() == "..=" },
            Rule::step_op => Infix::Step,
            Rule::infix | Rule::infix_next_line | Rule::arithmetic | Rule::arithmetic_next_line => {
                Infix::Binary(binary_op(token.as_str()))
            }
            _ => return None,
        })
    }

    fn level(self) -> Level {
        match self {
            Infix::Range { .. } | Infix::Step => Level::Range,
            Infix::Binary(op) => match op {
                BinaryOp::Or => Level::Or,
                BinaryOp::And => Level::And,
                BinaryOp::Equal
                | BinaryOp::NotEqual
                | BinaryOp::Less
                | BinaryOp::LessEqual
                | BinaryOp::Greater
                | BinaryOp::GreaterEqual => Level::Comparison,
                BinaryOp::Add | BinaryOp::Subtract => Level::Sum,
                BinaryOp::Multiply | BinaryOp::Divide | BinaryOp::Remainder => Level::Product,
                BinaryOp::Power => Level::Power,
            },
        }
    }
}

fn binary_op(text: &str) -> BinaryOp {
    match text {
        "+" => BinaryOp::Add,
        "-" => BinaryOp::Subtract,
        "*" => BinaryOp::Multiply,
        "/" => BinaryOp::Divide,
        "%" => BinaryOp::Remainder,
        "^" => BinaryOp::Power,
        "==" => BinaryOp::Equal,
        "!=" => BinaryOp::NotEqual,
        "<" => BinaryOp::Less,
        "<=" => BinaryOp::LessEqual,
        ">" => BinaryOp::Greater,
        ">=" => BinaryOp::GreaterEqual,
        "&&" => BinaryOp::And,
        _ => BinaryOp::Or,
    }
}

/// The operators of a flat list: a bound on the height of its tree.
pub(super) fn operators(tokens: Pairs<'_, Rule>) -> usize {
    let is_operator = |rule| {
        !matches!(
            rule,
            Rule::number
                | Rule::vector_literal
                | Rule::vector
                | Rule::name
                | Rule::text
                | Rule::list
                | Rule::paren
                | Rule::colour
                | Rule::block
                | Rule::expression
        )
    };
    tokens.filter(|t| is_operator(t.as_rule())).count()
}

impl<'a> Builder<'a> {
    /// `c ? a : b`, `p => e`, or what binds tighter: all that is left of the list.
    pub fn choice(&mut self, tokens: &mut Flat<'a>) -> Expr {
        if let Some(lambda) = self.lambda(tokens) {
            return lambda;
        }
        let condition = self.binary(tokens, Level::Or);
        if tokens.next_if(|t| t.as_rule() == Rule::question).is_none() {
            return condition;
        }
        let then = tokens.next().expect("`?` is followed by an expression");
        let then = self.expression(then);
        let otherwise = self.choice(tokens);
        let span = condition.span.to(otherwise.span);
        Expr { kind: ExprKind::Choice(Box::new((condition, then, otherwise))), span }
    }

    /// A function value, where the list begins with parameters and `=>`.
    fn lambda(&mut self, tokens: &mut Flat<'a>) -> Option<Expr> {
        if !matches!(tokens.peek()?.as_rule(), Rule::name | Rule::paren) {
            return None;
        }
        let mut ahead = tokens.clone();
        let head = ahead.next()?;
        let body = ahead.next_if(|t| t.as_rule() == Rule::expression)?;
        *tokens = ahead;
        let start = self.span(&head);
        let parameters = self.lambda_parameters(head);
        let bad = Expr { kind: ExprKind::Bad, span: self.span(&body) };
        let body = self.nested(bad.span, |builder| builder.expression(body)).unwrap_or(bad);
        let span = start.to(body.span);
        Some(Expr { kind: ExprKind::Lambda(Box::new(Lambda { parameters, body })), span })
    }

    fn lambda_parameters(&mut self, head: Token<'a>) -> Vec<Parameter> {
        if head.as_rule() == Rule::name {
            return vec![Parameter { name: self.binding(head), default: None }];
        }
        let mut parameters = Vec::new();
        for expression in head.into_inner() {
            let span = self.span(&expression);
            let mut inner = expression.into_inner();
            match inner.next() {
                Some(name) if name.as_rule() == Rule::name && inner.is_empty() => {
                    parameters.push(Parameter { name: self.binding(name), default: None });
                }
                _ => self.report(
                    Diagnostic::new(Code::Syntax, span, "a parameter before `=>` is a plain name").hint(
                        "write `(u, v) => …`; a function with defaults is an item, `fn f(a, b = 2) = …`",
                    ),
                ),
            }
        }
        parameters
    }

    /// Operands joined by operators at `level` or tighter.
    fn binary(&mut self, tokens: &mut Flat<'a>, level: Level) -> Expr {
        let mut left = self.unary(tokens);
        let mut compared: Option<Comparison> = None;
        while let Some(op) = tokens.peek().and_then(Infix::of).filter(|op| op.level() >= level) {
            let token = tokens.next().expect("just peeked");
            let right = match op {
                Infix::Binary(BinaryOp::Power) => self.binary(tokens, Level::Power),
                _ => self.binary(tokens, tighter(op.level())),
            };
            if op.level() == Level::Comparison {
                let this = Comparison { left: left.span, op: token.as_str(), right: right.span };
                if let Some(before) = compared.take() {
                    left = self.chained(&before, &this);
                    continue;
                }
                compared = Some(this);
            } else {
                compared = None;
            }
            left = self.join(left, op, &token, right);
        }
        left
    }

    fn unary(&mut self, tokens: &mut Flat<'a>) -> Expr {
        let Some(token) = tokens.next() else {
            return Expr { kind: ExprKind::Bad, span: self.span_of(0, 0) };
        };
        if token.as_rule() == Rule::prefix {
            let op = if token.as_str() == "-" { UnaryOp::Negate } else { UnaryOp::Not };
            let operand = self.binary(tokens, Level::Power);
            let span = self.span(&token).to(operand.span);
            return Expr { kind: ExprKind::Unary(op, Box::new(operand)), span };
        }
        let mut value = self.primary(token);
        while let Some(token) = tokens
            .next_if(|t| matches!(t.as_rule(), Rule::call | Rule::index | Rule::field | Rule::with_body))
        {
            value = self.postfix(value, token);
        }
        match tokens.next_if(|t| t.as_rule() == Rule::expression) {
            Some(body) => self.misplaced_arrow(value, &body),
            None => value,
        }
    }

    /// `f(x) => e` or `-x => e`.
    fn misplaced_arrow(&mut self, before: Expr, body: &Token<'a>) -> Expr {
        self.report(
            Diagnostic::new(Code::Syntax, before.span, "a parameter before `=>` is a plain name")
                .hint("write `p => …` or `(u, v) => …`; to compare, write `>=`"),
        );
        Expr { kind: ExprKind::Bad, span: before.span.to(self.span(body)) }
    }

    fn join(&mut self, left: Expr, op: Infix, token: &Token<'a>, right: Expr) -> Expr {
        let span = left.span.to(right.span);
        let at = self.span(token);
        let kind = match (op, left.kind) {
            (Infix::Binary(op), kind) => {
                ExprKind::Binary(op, Box::new((Expr { kind, span: left.span }, right)), at)
            }
            (Infix::Range { .. }, ExprKind::Range(_)) => self.bad_range(at, "ranges do not chain"),
            (Infix::Range { inclusive }, kind) => {
                let start = Expr { kind, span: left.span };
                ExprKind::Range(Box::new(RangeExpr { start, end: right, inclusive, step: None }))
            }
            (Infix::Step, ExprKind::Range(mut range)) if range.step.is_none() => {
                range.step = Some(right);
                ExprKind::Range(range)
            }
            (Infix::Step, _) => self.bad_range(at, "`step` follows a range once"),
        };
        Expr { kind, span }
    }

    fn bad_range(&mut self, at: Span, said: &str) -> ExprKind {
        self.report(Diagnostic::new(Code::Syntax, at, said).hint("write one `a..b` or `a..b step s`"));
        ExprKind::Bad
    }

    /// E0006, with both comparisons written out.
    fn chained(&mut self, first: &Comparison<'_>, second: &Comparison<'_>) -> Expr {
        let span = first.left.to(second.right);
        let (a, b, c) = (self.snippet(first.left), self.snippet(first.right), self.snippet(second.right));
        let said = format!("`{a} {} {b}` is compared again", first.op);
        let hint = format!("write `{a} {} {b} && {b} {} {c}`", first.op, second.op);
        self.report(
            Diagnostic::new(Code::ChainedComparison, span, said).label("comparisons do not chain").hint(hint),
        );
        Expr { kind: ExprKind::Bad, span }
    }
}

/// A comparison as it was written.
struct Comparison<'t> {
    left: Span,
    op: &'t str,
    right: Span,
}

/// The level of the right operand of a left-associative operator.
fn tighter(level: Level) -> Level {
    match level {
        Level::Or => Level::And,
        Level::And => Level::Comparison,
        Level::Comparison => Level::Range,
        Level::Range => Level::Sum,
        Level::Sum => Level::Product,
        Level::Product | Level::Power => Level::Power,
    }
}
