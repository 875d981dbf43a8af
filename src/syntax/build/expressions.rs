//! Pairs to expressions: operands and what stands tight behind them.

use pest::iterators::Pairs;

use super::Rule;
use super::items::{Builder, Token};
use super::operators::operators;
use crate::diag::{Code, Diagnostic, Span};
use crate::syntax::ast::{Argument, Call, Comprehension, Expr, ExprKind};

impl<'a> Builder<'a> {
    /// An `expression`.
    pub fn expression(&mut self, token: Token<'a>) -> Expr {
        let span = self.span(&token);
        let mut tokens = token.into_inner();
        if tokens.len() == 1 {
            let operand = tokens.next().expect("it has one pair");
            return self.primary(operand);
        }
        self.flat(tokens, span)
    }

    /// A list of operands and operators, as deep as its operators may make it.
    fn flat(&mut self, tokens: Pairs<'a, Rule>, span: Span) -> Expr {
        let levels = operators(tokens.clone());
        self.nested_by(levels, span, |builder| builder.choice(&mut tokens.peekable()))
            .unwrap_or(Expr { kind: ExprKind::Bad, span })
    }

    /// An operand without what stands behind it.
    pub fn primary(&mut self, token: Token<'a>) -> Expr {
        let span = self.span(&token);
        let kind = match token.as_rule() {
            Rule::number => self.number(&token, span),
            Rule::vector_literal => self.vector_literal(&token, span),
            Rule::name => match token.as_str() {
                "true" => ExprKind::Bool(true),
                "false" => ExprKind::Bool(false),
                name => ExprKind::Name(name.into()),
            },
            Rule::text => self.text(token),
            Rule::colour => self.colour(&token, span),
            Rule::vector | Rule::list | Rule::paren | Rule::block => return self.bracketed(token, span),
            _ => ExprKind::Bad,
        };
        Expr { kind, span }
    }

    fn bracketed(&mut self, token: Token<'a>, span: Span) -> Expr {
        self.nested(span, |builder| match token.as_rule() {
            Rule::vector => Expr { kind: builder.vector(token, span), span },
            Rule::list => Expr { kind: builder.list(token), span },
            Rule::paren => builder.paren(token, span),
            _ => Expr { kind: builder.block(token), span },
        })
        .unwrap_or(Expr { kind: ExprKind::Bad, span })
    }

    /// `(e)` is `e` with the span of the parentheses.
    fn paren(&mut self, token: Token<'a>, span: Span) -> Expr {
        let mut tokens = token.into_inner();
        if tokens.len() == 1 {
            let inner = self.expression(tokens.next().expect("it has one pair"));
            return Expr { kind: inner.kind, span };
        }
        let found = if tokens.is_empty() {
            Diagnostic::new(Code::Syntax, span, "nothing stands between these parentheses")
                .hint("a function without parameters is written `() => …`")
        } else {
            Diagnostic::new(Code::Syntax, span, "parentheses hold one value")
                .hint("a vector is written `<a, b>`, a list `[a, b]`; a call is tight, `f(a, b)`")
        };
        self.report(found);
        Expr { kind: ExprKind::Bad, span }
    }

    fn vector(&mut self, token: Token<'a>, span: Span) -> ExprKind {
        let tokens = token.into_inner();
        let n = tokens.len();
        let components: Vec<Expr> = tokens.map(|component| self.component(component)).collect();
        if !(2..=4).contains(&n) {
            let said = format!("a vector has 2 to 4 components; this one has {n}");
            self.report(
                Diagnostic::new(Code::Syntax, span, said).hint("a list of any length is written `[a, b, …]`"),
            );
            return ExprKind::Bad;
        }
        ExprKind::Vector(components)
    }

    fn component(&mut self, token: Token<'a>) -> Expr {
        let span = self.span(&token);
        let mut tokens = token.into_inner();
        if tokens.len() == 1 {
            return self.primary(tokens.next().expect("it has one pair"));
        }
        for operator in
            tokens.clone().filter(|t| matches!(t.as_rule(), Rule::arithmetic | Rule::arithmetic_next_line))
        {
            self.lopsided_sign(&operator);
        }
        self.flat(tokens, span)
    }

    /// `<1 -1, 2>`: a sign that stands like one of a component's own, and yet subtracts.
    fn lopsided_sign(&mut self, operator: &Token<'a>) {
        let at = operator.as_span();
        let blank = |b: Option<&u8>| b.is_some_and(u8::is_ascii_whitespace);
        let bytes = self.text.as_bytes();
        let before = blank(at.start().checked_sub(1).and_then(|i| bytes.get(i)));
        let sign = operator.as_str();
        if before && !blank(bytes.get(at.end())) && matches!(sign, "-" | "+") {
            let does = if sign == "-" { "subtracts" } else { "adds" };
            let span = self.span(operator);
            self.report(
                Diagnostic::new(Code::MissingComma, span, format!("a comma may be missing before this `{sign}`"))
                    .label(format!("as it stands, this {does}"))
                    .hint(format!("write `, {sign}` for a component of its own, or `{sign} ` with blanks on both sides to calculate")
                        .replace(", +`", ", `")),
            );
        }
    }

    fn list(&mut self, token: Token<'a>) -> ExprKind {
        let mut tokens = token.into_inner();
        let Some(first) = tokens.next() else { return ExprKind::List(Vec::new()) };
        let first = self.expression(first);
        if tokens.peek().is_some_and(|t| t.as_rule() == Rule::turns) {
            let turns = tokens.next().expect("just peeked");
            return self.comprehension(first, turns);
        }
        let mut elements = Vec::with_capacity(tokens.len() + 1);
        elements.push(first);
        elements.extend(tokens.map(|e| self.expression(e)));
        ExprKind::List(elements)
    }

    fn comprehension(&mut self, value: Expr, turns: Token<'a>) -> ExprKind {
        let mut tokens = turns.into_inner();
        let variable = self.binding(tokens.next().expect("a comprehension has a variable"));
        let list = self.expression(tokens.next().expect("a comprehension has a list"));
        let condition = tokens.next().map(|e| self.expression(e));
        ExprKind::Comprehension(Box::new(Comprehension { value, variable, list, condition }))
    }

    /// What stands tight behind an operand, or `with`.
    pub fn postfix(&mut self, base: Expr, token: Token<'a>) -> Expr {
        let here = self.span(&token);
        let span = base.span.to(here);
        let kind = match token.as_rule() {
            Rule::call => self.call(base, token, here),
            Rule::index => ExprKind::Index(Box::new((base, self.only_expression(token)))),
            Rule::field => {
                let word = token.into_inner().next().expect("a field has a name");
                ExprKind::Field(Box::new(base), self.ident(&word))
            }
            _ => self.with(base, token),
        };
        Expr { kind, span }
    }

    fn call(&mut self, callee: Expr, token: Token<'a>, parentheses: Span) -> ExprKind {
        let tokens = token.into_inner();
        let mut arguments = Vec::with_capacity(tokens.len());
        let mut named = false;
        for token in tokens {
            let argument = self.argument(token);
            if named && argument.name.is_none() {
                self.report(
                    Diagnostic::new(
                        Code::Syntax,
                        argument.value.span,
                        "an unnamed argument follows a named one",
                    )
                    .hint("move it to the front, or name it too"),
                );
            }
            named |= argument.name.is_some();
            arguments.push(argument);
        }
        ExprKind::Call(Box::new(Call { callee, arguments, parentheses }))
    }

    fn argument(&mut self, token: Token<'a>) -> Argument {
        let mut tokens = token.into_inner();
        let first = tokens.next().expect("an argument has a value");
        match tokens.next() {
            Some(value) => {
                let word = first.into_inner().next().expect("an argument's name is a word");
                Argument { name: Some(self.ident(&word)), value: self.expression(value) }
            }
            None => Argument { name: None, value: self.expression(first) },
        }
    }

    /// The text under a span, on one line.
    pub fn snippet(&self, span: Span) -> String {
        self.origin.snippet(span)
    }
}
