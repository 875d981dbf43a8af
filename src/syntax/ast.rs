//! The syntax tree. Plain data; every node has the span it was read from. Nothing here is resolved or checked.

use crate::diag::Span;

/// A name as it was written.
#[derive(Clone, Debug, PartialEq)]
pub struct Ident {
    /// The text. Short names are stored in place.
    pub name: Name,
    /// Where.
    pub span: Span,
}

/// A short string, in place up to 15 bytes: a file of a million blocks has many million names.
pub type Name = ecow::EcoString;

/// A whole file.
#[derive(Clone, Debug, PartialEq)]
pub struct File {
    /// Top-level items in source order.
    pub items: Vec<Item>,
    /// All of the file.
    pub span: Span,
}

/// What may stand at top level and inside braces.
#[derive(Clone, Debug, PartialEq)]
pub struct Item {
    /// What it is.
    pub kind: ItemKind,
    /// From its first to its last character.
    pub span: Span,
}

/// The forms of an item.
#[derive(Clone, Debug, PartialEq)]
pub enum ItemKind {
    /// `name` · `name expr` · `name expr, expr, …`. With no values it is a flag, or the placement of a value of that
    /// name: only evaluation can tell. `name { … }` with a kind's name and no label is an [`ItemKind::Block`].
    Property(Property),
    /// `kind { items }` · `kind label { items }`.
    Block(Box<Block>),
    /// An expression whose value is placed; never a bare name (see [`ItemKind::Property`]) and never a bare block.
    Placement(Expr),
    /// `let name = expr`.
    Let(Ident, Box<Expr>),
    /// `var name = expr`.
    Var(Ident, Box<Expr>),
    /// `name = expr`.
    Assign(Ident, Box<Expr>),
    /// `fn name(parameters) …`.
    Function(Box<Function>),
    /// `return expr`; without a value, what the body has produced so far.
    Return(Option<Expr>),
    /// `if … else if … else …`.
    If(Box<If>),
    /// `for v in list { … }`.
    For(Box<For>),
    /// `while c { … }`.
    While(Box<While>),
    /// `import "file"` · `import "file" as name`.
    Import(Box<Import>),
    /// Text that could not be read, already reported. `defines` is the name that it would have bound, if that could be
    /// told (so that its uses are not reported as undefined).
    Bad {
        /// The name after `let`, `var`, `fn` or a block's kind.
        defines: Option<Ident>,
    },
}

/// `name values…`.
#[derive(Clone, Debug, PartialEq)]
pub struct Property {
    /// The property's name, which may be a kind's (`material clay`).
    pub name: Ident,
    /// Its values; none for a flag or a placement.
    pub values: Vec<Expr>,
}

/// `kind label { items }`.
#[derive(Clone, Debug, PartialEq)]
pub struct Block {
    /// The kind, one of [`super::build::KINDS`].
    pub kind: Ident,
    /// The label, which names the value in the scope around the block.
    pub label: Option<Ident>,
    /// What stands between the braces.
    pub items: Vec<Item>,
    /// From the opening to the closing brace.
    pub braces: Span,
}

/// A function item.
#[derive(Clone, Debug, PartialEq)]
pub struct Function {
    /// Its name.
    pub name: Ident,
    /// Its parameters.
    pub parameters: Vec<Parameter>,
    /// What it does.
    pub body: Body,
}

/// A parameter, with what it is where the call leaves it out.
#[derive(Clone, Debug, PartialEq)]
pub struct Parameter {
    /// Its name.
    pub name: Ident,
    /// Its default.
    pub default: Option<Expr>,
}

/// A function's body.
#[derive(Clone, Debug, PartialEq)]
pub enum Body {
    /// `= expr`, or a lambda's.
    Expr(Expr),
    /// `{ items }`.
    Items(Vec<Item>),
}

/// A choice between items.
#[derive(Clone, Debug, PartialEq)]
pub struct If {
    /// Condition and items of `if` and of each `else if`; at least one.
    pub arms: Vec<(Expr, Vec<Item>)>,
    /// The items of `else`.
    pub otherwise: Option<Vec<Item>>,
}

/// A loop over a range or list.
#[derive(Clone, Debug, PartialEq)]
pub struct For {
    /// The loop's variable.
    pub variable: Ident,
    /// What it runs over.
    pub list: Expr,
    /// The items of each turn.
    pub items: Vec<Item>,
}

/// A loop while a condition holds.
#[derive(Clone, Debug, PartialEq)]
pub struct While {
    /// The condition.
    pub condition: Expr,
    /// The items of each turn.
    pub items: Vec<Item>,
}

/// An import. The path is always a literal text, so that imports are known before evaluation.
#[derive(Clone, Debug, PartialEq)]
pub struct Import {
    /// The path as written, escapes decoded.
    pub path: String,
    /// Where the path stands.
    pub path_span: Span,
    /// The name after `as`.
    pub alias: Option<Ident>,
}

/// An expression.
#[derive(Clone, Debug, PartialEq)]
pub struct Expr {
    /// What it is.
    pub kind: ExprKind,
    /// From its first to its last character.
    pub span: Span,
}

/// The forms of an expression.
#[derive(Clone, Debug, PartialEq)]
pub enum ExprKind {
    /// `1.5e3`; decoded with correct rounding.
    Number(f64),
    /// `true`, `false`.
    Bool(bool),
    /// `"text {expr}"`: literal parts and interpolated expressions in order. A plain text has one part or none.
    Text(Vec<TextPart>),
    /// `#c31`, `#cc3311`: sRGB as written, each channel 0 … 255 (a short digit is doubled). Decoded to linear later.
    Colour([u8; 3]),
    /// `name`.
    Name(Name),
    /// `<a, b>` to `<a, b, c, d>`: 2 to 4 components.
    Vector(Vec<Expr>),
    /// `<1, 2.5, -3>`: 2 to 4 literal numbers, read as one token. Components past `len` are 0.
    VectorLiteral {
        /// How many components: 2, 3 or 4.
        len: u8,
        /// The components.
        v: Box<[f64; 4]>,
    },
    /// `[a, b]`.
    List(Vec<Expr>),
    /// `[e for v in list if c]`.
    Comprehension(Box<Comprehension>),
    /// `-e`, `!e`.
    Unary(UnaryOp, Box<Expr>),
    /// `a + b` and the like. The span of the operator itself is kept for messages.
    Binary(BinaryOp, Box<(Expr, Expr)>, Span),
    /// `c ? a : b`.
    Choice(Box<(Expr, Expr, Expr)>),
    /// `a..b` · `a..=b` · `a..b step s`.
    Range(Box<RangeExpr>),
    /// `f(a, b, key: c)`; the callee may be any postfix expression, so `v.method(a)` is a call of a [`ExprKind::Field`].
    Call(Box<Call>),
    /// `v.x`, `v.xz`, `path.length`, `trees.oak`.
    Field(Box<Expr>, Ident),
    /// `list[i]`.
    Index(Box<(Expr, Expr)>),
    /// `e with { items }`.
    With(Box<With>),
    /// `p => e`, `(u, v) => e`.
    Lambda(Box<Lambda>),
    /// A block as a value: `mesh { … }`, `surface tube { … }`.
    Block(Box<Block>),
    /// Text that could not be read, already reported.
    Bad,
}

/// A part of a text.
#[derive(Clone, Debug, PartialEq)]
pub enum TextPart {
    /// Characters, escapes decoded.
    Literal(String),
    /// `{expr}`.
    Value(Expr),
}

/// `[value for variable in list if condition]`.
#[derive(Clone, Debug, PartialEq)]
pub struct Comprehension {
    /// What each element is.
    pub value: Expr,
    /// The variable.
    pub variable: Ident,
    /// What it runs over.
    pub list: Expr,
    /// Which turns count.
    pub condition: Option<Expr>,
}

/// A range of integers or of steps.
#[derive(Clone, Debug, PartialEq)]
pub struct RangeExpr {
    /// First value.
    pub start: Expr,
    /// End.
    pub end: Expr,
    /// True for `..=`.
    pub inclusive: bool,
    /// The step; 1 where absent.
    pub step: Option<Expr>,
}

/// A call.
#[derive(Clone, Debug, PartialEq)]
pub struct Call {
    /// What is called.
    pub callee: Expr,
    /// Its arguments in the order written; named ones may follow positional ones only.
    pub arguments: Vec<Argument>,
    /// From the opening to the closing parenthesis.
    pub parentheses: Span,
}

/// `value` or `name: value`.
#[derive(Clone, Debug, PartialEq)]
pub struct Argument {
    /// The parameter's name, where it is given.
    pub name: Option<Ident>,
    /// The value.
    pub value: Expr,
}

/// `base with { items }`.
#[derive(Clone, Debug, PartialEq)]
pub struct With {
    /// What is copied.
    pub base: Expr,
    /// What is applied to the copy.
    pub items: Vec<Item>,
    /// From the opening to the closing brace.
    pub braces: Span,
}

/// A function value.
#[derive(Clone, Debug, PartialEq)]
pub struct Lambda {
    /// Its parameters (no defaults in `p => e`).
    pub parameters: Vec<Parameter>,
    /// Its value.
    pub body: Expr,
}

/// Operators before an operand.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum UnaryOp {
    /// `-`
    Negate,
    /// `!`
    Not,
}

/// Operators between operands, loosest first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum BinaryOp {
    /// `||`
    Or,
    /// `&&`
    And,
    /// `==`
    Equal,
    /// `!=`
    NotEqual,
    /// `<`
    Less,
    /// `<=`
    LessEqual,
    /// `>`
    Greater,
    /// `>=`
    GreaterEqual,
    /// `+`
    Add,
    /// `-`
    Subtract,
    /// `*`
    Multiply,
    /// `/`
    Divide,
    /// `%`
    Remainder,
    /// `^`
    Power,
}

impl BinaryOp {
    /// The operator as written.
    pub fn text(self) -> &'static str {
        match self {
            BinaryOp::Or => "||",
            BinaryOp::And => "&&",
            BinaryOp::Equal => "==",
            BinaryOp::NotEqual => "!=",
            BinaryOp::Less => "<",
            BinaryOp::LessEqual => "<=",
            BinaryOp::Greater => ">",
            BinaryOp::GreaterEqual => ">=",
            BinaryOp::Add => "+",
            BinaryOp::Subtract => "-",
            BinaryOp::Multiply => "*",
            BinaryOp::Divide => "/",
            BinaryOp::Remainder => "%",
            BinaryOp::Power => "^",
        }
    }
}
