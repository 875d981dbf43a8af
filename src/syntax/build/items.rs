//! Pairs to items.

use pest::Parser;
use pest::iterators::{Pair, Pairs};

use super::lexer::continues_word;
use super::{Grammar, KEYWORDS, KINDS, Origin, Rule};
use crate::diag::{Code, Diagnostic, Span};
use crate::syntax::ast::{
    Block, Body, Expr, ExprKind, For, Function, Ident, If, Import, Item, ItemKind, Parameter, Property,
    While, With,
};

/// Where pest gave up, in bytes of the text it was given, and whether that was for want of stack. The place is that of
/// the character where its error detail is switched on, else that of the rule.
pub(super) struct Failure {
    pub at: usize,
    pub too_deep: bool,
}

impl Failure {
    pub fn of(error: pest::error::Error<Rule>) -> Self {
        let rule = match error.location {
            pest::error::InputLocation::Pos(at) | pest::error::InputLocation::Span((at, _)) => at,
        };
        let at = error.parse_attempts().map_or(rule, |attempts| attempts.max_position);
        let too_deep = matches!(error.variant, pest::error::ErrorVariant::CustomError { .. });
        Self { at, too_deep }
    }
}

/// Reads a text of whole items that begins at byte `base`.
pub(super) fn parse(
    text: &str,
    base: usize,
    origin: &Origin<'_>,
) -> Result<(Vec<Item>, Vec<Diagnostic>), Failure> {
    parse_struck(text, base, origin, &[])
}

/// The same, of a text in which items have been struck out.
pub(super) fn parse_struck(
    text: &str,
    base: usize,
    origin: &Origin<'_>,
    struck: &[(usize, Option<Ident>)],
) -> Result<(Vec<Item>, Vec<Diagnostic>), Failure> {
    let mut pairs = Grammar::parse(Rule::file, text).map_err(Failure::of)?;
    let file = pairs.next().expect("a parse of `file` yields the pair `file`");
    let mut builder = Builder { struck, ..Builder::new(text, base, origin) };
    let items = builder.items(file.into_inner());
    Ok((items, builder.found))
}

/// Turns pairs into the tree and collects what the grammar could not say.
pub(super) struct Builder<'a> {
    /// The text that was parsed.
    pub text: &'a str,
    base: usize,
    pub origin: &'a Origin<'a>,
    /// How many braces, brackets and operators lie around the node that is being built.
    pub depth: usize,
    pub found: Vec<Diagnostic>,
    /// What struck-out items would have named, by where they begin; sorted.
    pub struck: &'a [(usize, Option<Ident>)],
}

pub(super) type Token<'a> = Pair<'a, Rule>;

impl<'a> Builder<'a> {
    pub fn new(text: &'a str, base: usize, origin: &'a Origin<'a>) -> Self {
        Self { text, base, origin, depth: 0, found: Vec::new(), struck: &[] }
    }

    /// Where a pair stands.
    pub fn span(&self, token: &Token<'_>) -> Span {
        let span = token.as_span();
        self.span_of(span.start(), span.end())
    }

    /// Where bytes of the parsed text stand.
    pub fn span_of(&self, start: usize, end: usize) -> Span {
        self.origin.span(self.base + start, self.base + end)
    }

    /// The offset, in the whole text, of a byte of the parsed text.
    pub fn offset(&self, at: usize) -> usize {
        self.base + at
    }

    pub fn report(&mut self, diagnostic: Diagnostic) {
        self.found.push(diagnostic);
    }

    /// The items of a file or a body.
    pub fn items(&mut self, tokens: Pairs<'a, Rule>) -> Vec<Item> {
        let mut items = Vec::with_capacity(tokens.len());
        for token in tokens {
            if token.as_rule() != Rule::EOI {
                items.push(self.item(token));
            }
        }
        items
    }

    fn item(&mut self, token: Token<'a>) -> Item {
        let span = self.span(&token);
        let kind = match token.as_rule() {
            Rule::entry => self.entry(token),
            Rule::placement => self.placement(token),
            Rule::let_item => self.definition(token, ItemKind::Let),
            Rule::var_item => self.definition(token, ItemKind::Var),
            Rule::fn_item => self.function(token),
            Rule::return_item => ItemKind::Return(token.into_inner().next().map(|e| self.expression(e))),
            Rule::if_item => self.choice_of_items(token),
            Rule::for_item => self.for_loop(token),
            Rule::while_item => self.while_loop(token),
            Rule::import_item => self.import(token),
            _ => self.struck_out(&token),
        };
        Item { kind, span }
    }

    fn struck_out(&self, token: &Token<'a>) -> ItemKind {
        let at = self.struck.binary_search_by_key(&token.as_span().start(), |(start, _)| *start);
        ItemKind::Bad { defines: at.ok().and_then(|i| self.struck[i].1.clone()) }
    }

    /// The items between braces, and where the braces stand.
    pub fn body(&mut self, token: Token<'a>) -> (Vec<Item>, Span) {
        let braces = self.span(&token);
        (self.nested(braces, |builder| builder.items(token.into_inner())).unwrap_or_default(), braces)
    }

    /// Builds one level deeper; `None`, with a diagnostic, past the limit.
    pub fn nested<T>(&mut self, span: Span, build: impl FnOnce(&mut Self) -> T) -> Option<T> {
        self.nested_by(1, span, build)
    }

    /// Builds some levels deeper; `None`, with a diagnostic, past the limit.
    pub fn nested_by<T>(
        &mut self,
        levels: usize,
        span: Span,
        build: impl FnOnce(&mut Self) -> T,
    ) -> Option<T> {
        if self.depth + levels > self.origin.limits.depth {
            self.report(self.origin.too_deep(span));
            return None;
        }
        self.depth += levels;
        let built = build(self);
        self.depth -= levels;
        Some(built)
    }

    /// A name that is bound here: no reserved word.
    pub fn binding(&mut self, token: Token<'a>) -> Ident {
        let ident = self.ident(&token);
        if is_reserved(&ident.name) {
            self.report(reserved(&ident));
        }
        ident
    }

    /// A word, whatever it is.
    pub fn ident(&self, token: &Token<'a>) -> Ident {
        Ident { name: token.as_str().into(), span: self.span(token) }
    }

    fn entry(&mut self, token: Token<'a>) -> ItemKind {
        let mut tokens = token.into_inner();
        let word = tokens.next().expect("an entry begins with a word");
        match tokens.peek().map(|t| t.as_rule()) {
            Some(Rule::body | Rule::label) => self.block_item(&word, tokens),
            Some(Rule::assign) => {
                let value = self.only_expression(tokens.next().expect("just peeked"));
                ItemKind::Assign(self.binding(word), Box::new(value))
            }
            _ => self.property(&word, tokens),
        }
    }

    fn property(&mut self, word: &Token<'a>, tokens: Pairs<'a, Rule>) -> ItemKind {
        let name = self.ident(word);
        let mut values = Vec::with_capacity(tokens.len());
        for value in tokens {
            values.push(match value.as_rule() {
                Rule::expression => self.expression(value),
                _ => self.primary(value),
            });
        }
        if let [Expr { kind: ExprKind::Block(block), .. }] = values.as_slice()
            && is_kind(&name.name)
        {
            let said = format!("`{}` is the name of a kind and cannot be a label", block.kind.name);
            self.report(
                Diagnostic::new(Code::ReservedName, block.kind.span, said)
                    .hint(format!("label the {} with another word, or with none", name.name)),
            );
            return ItemKind::Bad { defines: None };
        }
        ItemKind::Property(Property { name, values })
    }

    /// `kind { … }`, `kind label { … }`, and either with calls, fields or `with` behind it.
    fn block_item(&mut self, word: &Token<'a>, mut tokens: Pairs<'a, Rule>) -> ItemKind {
        let kind = self.ident(word);
        let label = match tokens.peek().map(|t| t.as_rule()) {
            Some(Rule::label) => {
                tokens.next().and_then(|label| label.into_inner().next()).map(|word| self.binding(word))
            }
            _ => None,
        };
        let body = tokens.next().expect("a block has a body");
        let body_end = body.as_span().end();
        let n_found = self.found.len();
        let (items, braces) = self.body(body);
        if !is_kind(&kind.name) {
            if near_kind(&kind.name).is_none() {
                self.found.truncate(n_found);
            }
            self.report(unknown_kind(&kind, label.as_ref()));
            return ItemKind::Bad { defines: label };
        }
        let block = Block { kind, label, items, braces };
        if tokens.is_empty() {
            return ItemKind::Block(Box::new(block));
        }
        if let Some(label) = &block.label {
            let said = "a labelled block cannot be changed where it stands";
            self.report(
                Diagnostic::new(Code::Syntax, self.span_of(body_end, body_end).to(label.span), said).hint(
                    format!(
                        "end the block here and write `{} with {{ … }}` as an item of its own",
                        label.name
                    ),
                ),
            );
        }
        let span = self.span_of(word.as_span().start(), body_end);
        let start = Expr { kind: ExprKind::Block(Box::new(block)), span };
        let levels = tokens.len();
        let built = self.nested_by(levels, span, |builder| {
            tokens.fold(start, |base, token| builder.postfix(base, token))
        });
        built.map_or(ItemKind::Bad { defines: None }, ItemKind::Placement)
    }

    fn placement(&mut self, token: Token<'a>) -> ItemKind {
        let at = token.as_span().start();
        let value = self.only_expression(token);
        if !self.origin.limits.answers
            && let Some(what) = never_placed(&value.kind)
        {
            let said = format!("{what} stands where an item is expected");
            let line = self.text[..at].rsplit('\n').next().unwrap_or_default().trim_end();
            let hint = if self.text[at..].starts_with('(') && line.ends_with(continues_word) {
                "a call is written tight, `f(x)`; another value of a property follows a `,`"
            } else {
                "begin the item with a property's name; another value of the property before follows a `,`"
            };
            self.report(Diagnostic::new(Code::Syntax, value.span, said).hint(hint));
            return ItemKind::Bad { defines: None };
        }
        ItemKind::Placement(value)
    }

    /// The expression of a pair that holds just one.
    pub fn only_expression(&mut self, token: Token<'a>) -> Expr {
        let inner = token.into_inner().next().expect("the rule holds an expression");
        self.expression(inner)
    }

    fn definition(&mut self, token: Token<'a>, make: fn(Ident, Box<Expr>) -> ItemKind) -> ItemKind {
        let mut tokens = token.into_inner();
        let name = self.binding(tokens.next().expect("a definition has a name"));
        let value = self.expression(tokens.next().expect("a definition has a value"));
        make(name, Box::new(value))
    }

    fn function(&mut self, token: Token<'a>) -> ItemKind {
        let mut tokens = token.into_inner();
        let name = self.binding(tokens.next().expect("a function has a name"));
        let parameters = tokens.next().expect("a function has parameters").into_inner();
        let parameters = parameters.map(|p| self.parameter(p)).collect();
        let body = tokens.next().expect("a function has a body");
        let body = match body.as_rule() {
            Rule::body => Body::Items(self.body(body).0),
            _ => Body::Expr(self.expression(body)),
        };
        ItemKind::Function(Box::new(Function { name, parameters, body }))
    }

    fn parameter(&mut self, token: Token<'a>) -> Parameter {
        let mut tokens = token.into_inner();
        let name = self.binding(tokens.next().expect("a parameter has a name"));
        Parameter { name, default: tokens.next().map(|e| self.expression(e)) }
    }

    /// `if`: conditions and bodies in turn, a last body without a condition.
    fn choice_of_items(&mut self, token: Token<'a>) -> ItemKind {
        let mut arms = Vec::new();
        let mut otherwise = None;
        let mut tokens = token.into_inner();
        while let Some(token) = tokens.next() {
            if otherwise.is_some() {
                self.report(
                    Diagnostic::new(Code::Syntax, self.span(&token), "a branch follows the last `else`")
                        .hint(
                            "only one plain `else` may end an `if`; write `else if` for the ones before it",
                        ),
                );
                break;
            }
            match token.as_rule() {
                Rule::body => otherwise = Some(self.body(token).0),
                _ => {
                    let condition = self.expression(token);
                    let body = tokens.next().expect("a condition is followed by a body");
                    arms.push((condition, self.body(body).0));
                }
            }
        }
        ItemKind::If(Box::new(If { arms, otherwise }))
    }

    fn for_loop(&mut self, token: Token<'a>) -> ItemKind {
        let mut tokens = token.into_inner();
        let variable = self.binding(tokens.next().expect("a loop has a variable"));
        let list = self.expression(tokens.next().expect("a loop has a list"));
        let (items, _) = self.body(tokens.next().expect("a loop has a body"));
        ItemKind::For(Box::new(For { variable, list, items }))
    }

    fn while_loop(&mut self, token: Token<'a>) -> ItemKind {
        let mut tokens = token.into_inner();
        let condition = self.expression(tokens.next().expect("a loop has a condition"));
        let (items, _) = self.body(tokens.next().expect("a loop has a body"));
        ItemKind::While(Box::new(While { condition, items }))
    }

    fn import(&mut self, token: Token<'a>) -> ItemKind {
        let mut tokens = token.into_inner();
        let text = tokens.next().expect("an import has a path");
        let path_span = self.span(&text);
        let path = self.plain_text(text);
        let alias = tokens.next().map(|word| self.binding(word));
        match path {
            Some(path) => ItemKind::Import(Box::new(Import { path, path_span, alias })),
            None => ItemKind::Bad { defines: alias },
        }
    }

    /// A block as a value.
    pub fn block(&mut self, token: Token<'a>) -> ExprKind {
        let mut tokens = token.into_inner();
        let kind = self.ident(&tokens.next().expect("a block has a kind"));
        let (items, braces) = self.body(tokens.next().expect("a block has a body"));
        ExprKind::Block(Box::new(Block { kind, label: None, items, braces }))
    }

    /// `base with { … }`.
    pub fn with(&mut self, base: Expr, token: Token<'a>) -> ExprKind {
        let body = token.into_inner().next().expect("`with` has a body");
        let (items, braces) = self.body(body);
        ExprKind::With(Box::new(With { base, items, braces }))
    }
}

/// Whether a word is a kind of block.
pub(super) fn is_kind(word: &str) -> bool {
    KINDS.contains(&word)
}

/// Whether a word may not be a name.
pub(super) fn is_reserved(word: &str) -> bool {
    is_kind(word) || KEYWORDS.contains(&word)
}

fn reserved(ident: &Ident) -> Diagnostic {
    let what = if is_kind(&ident.name) { "the name of a kind" } else { "a word of the language" };
    Diagnostic::new(
        Code::ReservedName,
        ident.span,
        format!("`{}` is {what} and cannot be a name", ident.name),
    )
    .hint(format!("choose another, such as `my_{}`", ident.name))
}

fn unknown_kind(kind: &Ident, label: Option<&Ident>) -> Diagnostic {
    let found =
        Diagnostic::new(Code::UnknownKind, kind.span, format!("no block is of the kind `{}`", kind.name))
            .label("a word before `{` must be a kind");
    match near_kind(&kind.name).or_else(|| foreign_kind(&kind.name)) {
        Some(near) => found.hint(format!("did you mean `{near}`?")),
        None if label.is_some() => found,
        None => found.hint(format!("to change a copy of a value, write `{} with {{ … }}`", kind.name)),
    }
}

/// The kind that a word is likely meant to be.
pub(super) fn near_kind(word: &str) -> Option<&'static str> {
    crate::diag::nearest(word, KINDS.iter().copied())
}

/// The kind that does what a block of POV-Ray's does.
fn foreign_kind(word: &str) -> Option<&'static str> {
    Some(match word {
        "light_source" | "sky_sphere" => "light",
        "texture" | "pigment" | "finish" | "interior" => "material",
        "mesh2" => "mesh",
        "bicubic_patch" => "patch",
        "isosurface" => "implicit",
        "sphere_sweep" => "tube",
        "prism" => "extrude",
        "sor" => "lathe",
        "merge" => "union",
        "object" => "group",
        "global_settings" | "background" => "render",
        _ => return None,
    })
}

/// What is plainly no object, in words.
fn never_placed(kind: &ExprKind) -> Option<&'static str> {
    match kind {
        ExprKind::Number(_) => Some("a number"),
        ExprKind::Bool(_) => Some("a truth value"),
        ExprKind::Text(_) => Some("a text"),
        ExprKind::Colour(_) => Some("a colour"),
        ExprKind::Vector(_) | ExprKind::VectorLiteral { .. } => Some("a vector"),
        ExprKind::Range(_) => Some("a range"),
        ExprKind::Lambda(_) => Some("a function"),
        ExprKind::Unary(..) | ExprKind::Binary(..) => Some("a value"),
        ExprKind::Name(_)
        | ExprKind::List(_)
        | ExprKind::Comprehension(_)
        | ExprKind::Choice(_)
        | ExprKind::Call(_)
        | ExprKind::Field(..)
        | ExprKind::Index(_)
        | ExprKind::With(_)
        | ExprKind::Block(_)
        | ExprKind::Bad => None,
    }
}
