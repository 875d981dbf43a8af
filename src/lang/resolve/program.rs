//! The resolved tree: what evaluation walks. Every name is a slot, a constant or a builtin; every kind is its entry of the
//! table. Knows nothing of values beyond constants.

use super::straight::Straight;
use crate::diag::Span;
use crate::lang::table::{self, Builtin, Kind};
use crate::lang::value::Value;
use std::rc::Rc;

/// A text shared between the tree and the values that evaluation makes.
pub type Word = Rc<str>;

/// A file and all that it imports, resolved.
#[derive(Debug, Default)]
pub struct Program {
    /// Functions and lambdas, by [`FunctionId`].
    pub functions: Vec<Function>,
    /// The root file is the first; the others are imports with `as`.
    pub units: Vec<Unit>,
    /// Names of the slots of all units' top levels, by [`Access::Global`], with their places.
    pub globals: Vec<(Word, Span)>,
}

/// Index into [`Program::functions`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct FunctionId(pub u32);

/// Index into [`Program::units`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct UnitId(pub u32);

/// A file that is evaluated on its own, with its plain imports.
#[derive(Debug)]
pub struct Unit {
    /// Its items.
    pub body: Body,
    /// How many slots its frame needs.
    pub n_slots: u32,
    /// The global slot of its group: `t.scene`. None for the root.
    pub scene: Option<u32>,
}

/// Where a name's value is found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Access {
    /// A slot of the running function's frame.
    Local(u32),
    /// What the running function captured.
    Captured(u32),
    /// A name of a unit's top level.
    Global(u32),
    /// A function declared in the block of the running one, which shares its captures.
    Sibling(FunctionId),
}

/// What a closure takes along from where it is made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Capture {
    /// A local's value.
    Value(u32),
    /// A local `var` itself.
    Reference(u32),
    /// A local of the block whose functions are being made, not yet set: a new variable.
    Fresh(u32),
    /// What the maker captured itself.
    Outer(u32),
    /// A function beside the maker.
    Sibling(FunctionId),
}

/// A function or lambda.
#[derive(Debug)]
pub struct Function {
    /// Its name; none for `p => …`.
    pub name: Option<Word>,
    /// Its parameters, which are its first slots.
    pub parameters: Vec<Parameter>,
    /// How many slots its frame needs.
    pub n_slots: u32,
    /// What it does.
    pub body: FunctionBody,
    /// Its name's place, or all of a lambda.
    pub span: Span,
}

/// A parameter.
#[derive(Debug)]
pub struct Parameter {
    /// Its name.
    pub name: Word,
    /// Its value where the call leaves it out; may use the parameters before it.
    pub default: Option<Expr>,
}

/// What a function does.
#[derive(Debug)]
pub enum FunctionBody {
    /// Gives a value.
    Expr(Expr),
    /// Runs items.
    Items(Body),
}

/// The items of a scope.
#[derive(Debug, Default)]
pub struct Body {
    /// In order.
    pub items: Vec<Item>,
    /// Functions that are made when the scope is entered.
    pub functions: Option<Box<Functions>>,
}

/// The functions of one scope; they share what they capture.
#[derive(Debug)]
pub struct Functions {
    /// Each with the slot that it is bound to ([`Access::Local`] or [`Access::Global`]).
    pub bindings: Vec<(Access, FunctionId)>,
    /// What they capture.
    pub captures: Vec<Capture>,
}

/// An item.
#[derive(Debug)]
pub struct Item {
    /// What it is.
    pub kind: ItemKind,
    /// Where.
    pub span: Span,
}

/// The forms of an item.
#[derive(Debug)]
pub enum ItemKind {
    /// A property.
    Property(Box<Property>),
    /// A block that stands as an item.
    Block(Box<BlockItem>),
    /// A value to place.
    Place(Expr),
    /// `let` or `var`.
    Bind(Access, Expr),
    /// `name = expr`.
    Assign(Access, Expr),
    /// `return expr`; none gives what was produced so far.
    Return(Option<Expr>),
    /// A choice.
    If(Box<If>),
    /// A loop over a list.
    For(Box<For>),
    /// A loop while a condition holds.
    While(Box<While>),
    /// An import with `as`: evaluates the unit, once. With the path's place.
    Import(UnitId, Span),
    /// Something that was already reported; a property's name where it is known.
    Poison(Option<Word>),
}

/// `name values…`.
#[derive(Debug)]
pub struct Property {
    /// Its name.
    pub name: Word,
    /// The name's place.
    pub name_span: Span,
    /// What the table says of it, where the block around it is known.
    pub known: Option<&'static table::Property>,
    /// Its values.
    pub values: Vec<Expr>,
}

/// A block as an item.
#[derive(Debug)]
pub struct BlockItem {
    /// The block.
    pub block: Block,
    /// What becomes of it.
    pub fate: Fate,
}

/// What becomes of a block that stands as an item, apart from the name that its label gives it.
#[derive(Clone, Debug)]
pub enum Fate {
    /// It is placed.
    Placed,
    /// It is the property of its kind's name, with what the table says of that where the block around is known.
    Given(Word, Option<&'static table::Property>),
    /// It is only named.
    Named,
}

/// A block.
#[derive(Debug)]
pub struct Block {
    /// Its kind.
    pub kind: &'static Kind,
    /// The kind's word.
    pub kind_span: Span,
    /// Its label, and the slot that the label names.
    pub label: Option<(Word, Span, Option<Access>)>,
    /// What stands between its braces.
    pub body: Body,
    /// From the kind to the closing brace.
    pub span: Span,
}

/// A choice between items.
#[derive(Debug)]
pub struct If {
    /// Conditions with their items.
    pub arms: Vec<(Expr, Body)>,
    /// `else`.
    pub otherwise: Option<Body>,
}

/// A loop over a list.
#[derive(Debug)]
pub struct For {
    /// The variable's slot.
    pub slot: u32,
    /// What it runs over.
    pub list: Expr,
    /// Each turn.
    pub body: Body,
}

/// A loop while a condition holds.
#[derive(Debug)]
pub struct While {
    /// The condition.
    pub condition: Expr,
    /// Each turn.
    pub body: Body,
}

/// An expression.
#[derive(Debug)]
pub struct Expr {
    /// What it is.
    pub kind: ExprKind,
    /// Where.
    pub span: Span,
}

/// The forms of an expression.
#[derive(Debug)]
pub enum ExprKind {
    /// A number.
    Number(f64),
    /// Any other value that is known already.
    Constant(Box<Value>),
    /// A name's value.
    Name(Access),
    /// A vector's components, 2 to 4.
    Vector(Box<[Expr]>),
    /// A list's elements.
    List(Box<[Expr]>),
    /// `[e for v in list if c]`.
    Comprehension(Box<Comprehension>),
    /// A text's parts.
    Text(Box<[TextPart]>),
    /// `-e`.
    Negate(Box<Expr>),
    /// `!e`.
    Not(Box<Expr>),
    /// Arithmetic on numbers, in a row.
    Straight(Box<Straight>),
    /// `a + b` and the like.
    Arithmetic(Arithmetic, Box<(Expr, Expr)>),
    /// `a < b` and the like.
    Compare(Comparison, Box<(Expr, Expr)>),
    /// `a && b`.
    And(Box<(Expr, Expr)>),
    /// `a || b`.
    Or(Box<(Expr, Expr)>),
    /// `c ? a : b`.
    Choice(Box<(Expr, Expr, Expr)>),
    /// `a..b step s`.
    Range(Box<Range>),
    /// A call of a function of one number with one argument.
    CallNumber(&'static Builtin, fn(f64) -> f64, Box<Expr>),
    /// A call of a builtin.
    CallBuiltin(Box<CallBuiltin>),
    /// A call of a function whose declaration is known, its arguments already matched to parameters.
    CallFunction(Box<CallFunction>),
    /// A call of a value.
    CallValue(Box<CallValue>),
    /// `v.method(…)`.
    CallMethod(Box<CallMethod>),
    /// `v.name`.
    Field(Box<(Expr, Word, Span)>),
    /// One component of a vector: `v.x` is 0.
    Component(u8, Box<Expr>),
    /// `list[i]`.
    Index(Box<(Expr, Expr)>),
    /// `e with { items }`.
    With(Box<With>),
    /// `p => e`.
    Lambda(FunctionId, Box<[Capture]>),
    /// A block as a value.
    Block(Box<Block>),
    /// Something that was already reported.
    Poison,
}

/// Operators on numbers and vectors.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Arithmetic {
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

impl Arithmetic {
    /// The operator as written.
    pub fn text(self) -> &'static str {
        match self {
            Arithmetic::Add => "+",
            Arithmetic::Subtract => "-",
            Arithmetic::Multiply => "*",
            Arithmetic::Divide => "/",
            Arithmetic::Remainder => "%",
            Arithmetic::Power => "^",
        }
    }
}

/// Comparisons.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Comparison {
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
}

impl Comparison {
    /// The operator as written.
    pub fn text(self) -> &'static str {
        match self {
            Comparison::Equal => "==",
            Comparison::NotEqual => "!=",
            Comparison::Less => "<",
            Comparison::LessEqual => "<=",
            Comparison::Greater => ">",
            Comparison::GreaterEqual => ">=",
        }
    }
}

/// A part of a text.
#[derive(Debug)]
pub enum TextPart {
    /// Characters.
    Literal(Box<str>),
    /// `{expr}`.
    Value(Expr),
}

/// `[value for slot in list if condition]`.
#[derive(Debug)]
pub struct Comprehension {
    /// Each element.
    pub value: Expr,
    /// The variable's slot.
    pub slot: u32,
    /// What it runs over.
    pub list: Expr,
    /// Which turns count.
    pub condition: Option<Expr>,
}

/// `start..end step step`.
#[derive(Debug)]
pub struct Range {
    /// First value.
    pub start: Expr,
    /// End.
    pub end: Expr,
    /// `..=`.
    pub inclusive: bool,
    /// 1 where absent.
    pub step: Option<Expr>,
}

/// A call of a builtin: an expression for each argument, in the order written, with the parameter that it fills.
#[derive(Debug)]
pub struct CallBuiltin {
    /// Which.
    pub builtin: &'static Builtin,
    /// Arguments in the order written.
    pub arguments: Vec<(u32, Expr)>,
    /// A value for each argument of the call, defaults included; those of `arguments` are overwritten.
    pub defaults: Vec<Value>,
    /// Their places.
    pub spans: Box<[Span]>,
}

/// A call of a declared function.
#[derive(Debug)]
pub struct CallFunction {
    /// Where its value is found.
    pub callee: Access,
    /// Its declaration.
    pub function: FunctionId,
    /// Arguments in the order written, with the parameters that they fill.
    pub arguments: Vec<(u32, Expr)>,
}

/// A call of a value.
#[derive(Debug)]
pub struct CallValue {
    /// What is called.
    pub callee: Expr,
    /// Arguments in the order written.
    pub arguments: Vec<Argument>,
}

/// A call of a method.
#[derive(Debug)]
pub struct CallMethod {
    /// Whose.
    pub base: Expr,
    /// Which.
    pub name: Word,
    /// The name's place.
    pub name_span: Span,
    /// Arguments in the order written.
    pub arguments: Vec<Argument>,
}

/// `value` or `name: value`.
#[derive(Debug)]
pub struct Argument {
    /// The parameter's name, where it is given.
    pub name: Option<(Word, Span)>,
    /// The value.
    pub value: Expr,
}

/// `base with { items }`.
#[derive(Debug)]
pub struct With {
    /// What is copied.
    pub base: Expr,
    /// What is applied.
    pub body: Body,
    /// From `with`'s opening to its closing brace.
    pub braces: Span,
}
