//! The shape of the two tables that drive the language: kinds of block with their properties, and builtin functions.
//! The evaluator, the checks, the hints, the reference page and completion are all derived from them.

use super::value::{Given, Value};
use crate::diag::{Diagnostic, Span};
use crate::math::field::CallN;
use crate::scene::assets::Loader;
use crate::scene::assets::gltf::{Model, ModelError};
use crate::scene::{Node, Object, Rig, SampleInput, SampledFunction};
use crate::syntax::ast::Name;
use glam::{DVec2, DVec3};
use std::path::{Path, PathBuf};
use std::rc::Rc;
use std::sync::Arc;

/// Proof that an error was reported; whoever gets it stays silent.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Reported;

/// A value, or an error that was already reported.
pub type Outcome<T = Value> = Result<T, Reported>;

/// Who finds where rays meet objects. The language only asks; who holds the world answers.
pub trait Trace {
    /// Every hit of a ray with an object's true surface, nearest first; or what is wrong with the object, or with a function that makes it.
    fn trace(
        &self,
        object: &Arc<Object>,
        origin: DVec3,
        direction: DVec3,
        at: Span,
    ) -> Result<Vec<Traced>, Vec<Diagnostic>>;
}

/// Where a ray met an object.
#[derive(Clone, Copy, Debug)]
pub struct Traced {
    /// How many lengths of the direction it is away.
    pub t: f64,
    /// On the surface.
    pub point: DVec3,
    /// Unit shading normal, outward.
    pub normal: DVec3,
    /// Surface parameters.
    pub uv: DVec2,
}

/// What a function that runs while rendering is to give.
#[derive(Clone, Copy, Debug)]
pub enum Gives<'r> {
    /// A number or a vector, of one of these counts of components: `&[1, 3]` for a number or a colour.
    Components(&'r [usize]),
    /// A list of so many numbers.
    List(usize),
}

/// What builders and builtins may ask of the evaluator.
pub trait Context {
    /// Reports a diagnostic, with the calls that led here.
    fn report(&mut self, diagnostic: Diagnostic);
    /// Reports an error and gives the token that says so.
    fn fail(&mut self, diagnostic: Diagnostic) -> Reported {
        self.report(diagnostic);
        Reported
    }
    /// Calls a function value.
    fn call(&mut self, function: &Value, arguments: &[Value], at: Span) -> Outcome;
    /// How many parameters a function value has, and how many of them have no default; none if it is no function.
    fn arity(&self, function: &Value) -> Option<(usize, usize)>;
    /// A path as written at a place, joined to the folder of the file it stands in.
    fn path(&self, written: &str, at: Span) -> PathBuf;
    /// Reads files.
    fn loader(&self) -> &dyn Loader;
    /// A model file, its description read; the same file is read once.
    fn model(&mut self, path: &Path) -> Result<Arc<Model>, ModelError>;
    /// What `print` says.
    fn print(&mut self, text: String);
    /// Compiles a function value to run while rendering; reports why it cannot be.
    fn sampled(
        &mut self,
        function: &Value,
        input: SampleInput,
        gives: Gives<'_>,
        at: Span,
    ) -> Outcome<Arc<SampledFunction>>;
    /// Counts `elements` list elements (or bytes / 32) that are about to be made, or gone through, against the guards.
    fn reserve(&mut self, elements: usize, at: Span) -> Outcome<()>;
    /// Says by how much the number that is about to be given may be off, where that is more than rounding.
    fn estimated(&mut self, error: f64);
    /// Who finds where rays meet objects.
    fn tracer(&self) -> &dyn Trace;
    /// `time` and `frame` of this evaluation.
    fn time(&self) -> (f64, f64);
    /// In an animation, where a reach of the pose at this place starts that is given these coordinates; none where it is to start from
    /// these.
    fn start_of_reach(&self, pose: Span, given: &[f64]) -> Option<Vec<f64>> {
        let _ = (pose, given);
        None
    }
    /// Tells where that reach ended, for the next frame.
    fn reached(&mut self, pose: Span, given: &[f64], found: &[f64]) {
        let _ = (pose, given, found);
    }
    /// In an animation, the skeleton that was read from this file for this block in a frame before.
    fn skeleton_read(&self, path: &Path, block: Span) -> Option<Arc<Rig>> {
        let _ = (path, block);
        None
    }
    /// Keeps it for the next frame.
    fn keep_skeleton(&mut self, path: &Path, rig: &Arc<Rig>) {
        let _ = (path, rig);
    }
}

/// A kind of block.
pub struct Kind {
    /// Its word.
    pub name: &'static str,
    /// What it is, in one line.
    pub doc: &'static str,
    /// A short scene or item that shows it; checked by a test.
    pub example: &'static str,
    /// What becomes of its value.
    pub role: Role,
    /// Its own properties. Those that every object takes are added by [`Kind::properties`] where `role` is an object's.
    pub own: &'static [Property],
    /// Whether objects and lights may be placed inside it.
    pub children: bool,
    /// Whether it takes properties of any name (a pose's are its joints).
    pub open: bool,
    /// How its value is made; none for a kind that no block is of.
    pub build: Option<Build>,
}

impl Kind {
    /// Its own properties, then those that its role adds: what every object takes, and the transforms of a light.
    pub fn properties(&self) -> impl Iterator<Item = &'static Property> {
        self.own.iter().chain(super::kinds::common::of_role(self.role))
    }

    /// The property of this name.
    pub fn property(&self, name: &str) -> Option<&'static Property> {
        self.properties().find(|p| p.name == name)
    }
}

impl std::fmt::Debug for Kind {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "kind {}", self.name)
    }
}

/// Makes a block's value from what stood between its braces, all checked against the table. What it takes out of the block is its own.
pub type Build = fn(&mut dyn Context, &mut Block) -> Outcome;

/// What becomes of a block's value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// Placed where it stands, and takes transforms, material, name and hide.
    Object,
    /// Placed where it stands.
    Light,
    /// Only named, or given to the property of the same name.
    Value,
    /// Once per scene: camera, render.
    Setting,
    /// A part of another block alone: joint, tip.
    Part,
}

/// A property of a block.
pub struct Property {
    /// Its word.
    pub name: &'static str,
    /// What it takes: alternatives, each a row of types. `&[&[]]` is a flag.
    pub takes: &'static [&'static [Type]],
    /// Takes any number of values of the one type of `takes`, or one list of them.
    pub many: bool,
    /// The block cannot be without it.
    pub required: bool,
    /// May be given again and again (transforms, `reach`).
    pub repeats: bool,
    /// The default as it would be written, or "" for none.
    pub default: &'static str,
    /// What it is, in one line, with its unit.
    pub doc: &'static str,
}

impl Property {
    /// A property that may be given once, with these alternatives; see the fields.
    pub const fn new(
        name: &'static str,
        takes: &'static [&'static [Type]],
        default: &'static str,
        doc: &'static str,
    ) -> Property {
        Property { name, takes, many: false, required: false, repeats: false, default, doc }
    }

    /// The same, but the block cannot be without it.
    pub const fn required(self) -> Property {
        Property { required: true, ..self }
    }

    /// The same, but it takes any number of values, or one list of them.
    pub const fn many(self) -> Property {
        Property { many: true, ..self }
    }

    /// The same, but it may be given again and again.
    pub const fn repeats(self) -> Property {
        Property { repeats: true, ..self }
    }

    /// Whether it stands without a value: `closed`.
    pub fn is_flag(&self) -> bool {
        self.takes.iter().any(|row| row.is_empty())
    }

    /// The words that it takes at any of its places, written bare (`lobe phong`, `smooth on`).
    pub fn words(&self) -> impl Iterator<Item = &'static str> {
        self.takes.iter().flat_map(|row| row.iter()).flat_map(|kind| kind.words().iter().copied())
    }

    /// Whether it takes a name of the author's own, written bare: a joint.
    pub fn takes_label(&self) -> bool {
        self.takes.iter().any(|row| row.contains(&Type::Label))
    }
}

/// What a property or parameter takes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Type {
    /// A finite number in closed bounds.
    Number {
        /// Least.
        min: f64,
        /// Most.
        max: f64,
    },
    /// A finite number above 0.
    Positive,
    /// A whole number of at least `min`.
    Integer {
        /// Least.
        min: i64,
    },
    /// `true`, `false`, `on`, `off`.
    Bool,
    /// Text.
    Text,
    /// A 2-vector.
    Vector2,
    /// A 3-vector.
    Vector3,
    /// A 4-vector.
    Vector4,
    /// A 3-vector that is not 0.
    Direction,
    /// A number that is not 0.
    Factor,
    /// A 3-vector of which no component is 0.
    Factors,
    /// Linear RGB or a grey.
    Colour,
    /// A colour, a number, a pattern, or a function of the point, of (u, v). Channels of at least 0.
    Texture,
    /// A number in closed bounds that may vary over a surface: a number, a pattern, or a function to a number.
    NumberTexture {
        /// Least.
        min: f64,
        /// Most.
        max: f64,
    },
    /// One of these words, written bare.
    Word(&'static [&'static str]),
    /// A name of the author's own, written bare: a joint.
    Label,
    /// An object.
    Object,
    /// A material.
    Material,
    /// A transform.
    Transform,
    /// A number, a 2-vector or a 3-vector: what a curve runs through.
    Point,
    /// A curve through such points.
    Curve(CurveOf),
    /// A function.
    Function,
    /// A list of anything.
    List,
    /// A skeleton.
    Skeleton,
    /// A pose.
    Pose,
    /// A part of a skeleton, by the word of its kind.
    Part(&'static str),
    /// Anything.
    Any,
}

/// What a curve runs through.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CurveOf {
    /// Any points.
    Any,
    /// Numbers.
    Numbers,
    /// 2-vectors.
    Plane,
    /// 3-vectors.
    Space,
}

impl CurveOf {
    /// Whether a curve through points of so many numbers is one.
    pub fn holds(self, dimension: usize) -> bool {
        match self {
            CurveOf::Any => true,
            CurveOf::Numbers => dimension == 1,
            CurveOf::Plane => dimension == 2,
            CurveOf::Space => dimension == 3,
        }
    }
}

impl Type {
    /// Any finite number.
    pub const NUMBER: Type = Type::Number { min: f64::MIN, max: f64::MAX };
    /// A finite number of at least 0.
    pub const NON_NEGATIVE: Type = Type::Number { min: 0.0, max: f64::MAX };

    /// The words it takes, written bare.
    pub fn words(self) -> &'static [&'static str] {
        match self {
            Type::Word(words) => words,
            Type::Bool => &["on", "off"],
            _ => &[],
        }
    }
}

/// A block's content, given to its [`Build`].
pub struct Block {
    /// Its kind.
    pub kind: &'static Kind,
    /// From the kind to the closing brace.
    pub span: Span,
    /// The kind's word.
    pub kind_span: Span,
    /// Its label.
    pub label: Option<(Name, Span)>,
    /// Its properties in the order written, each checked against the table; bare words are [`Value::Word`].
    pub given: Vec<Given>,
    /// Objects and lights that its items placed.
    pub children: Vec<Node>,
    /// Properties that were written, but whose values failed and were reported: they are not missing, and nothing is built.
    pub poisoned: Vec<(Rc<str>, Span)>,
}

/// A builtin function.
pub struct Builtin {
    /// Its name.
    pub name: &'static str,
    /// Its parameters.
    pub parameters: &'static [Parameter],
    /// Takes any number of further arguments of the last parameter's type.
    pub variadic: bool,
    /// What it gives, in one line.
    pub doc: &'static str,
    /// Where it is defined, and a thing to try elsewhere; empty where it is defined everywhere.
    pub domain: (&'static str, &'static str),
    /// An expression that shows it and what it gives: ("sqrt(2)^2", "2.0000000000000004"); checked by a test.
    pub example: (&'static str, &'static str),
    /// How.
    pub body: BuiltinBody,
}

impl Builtin {
    /// A function that is defined everywhere, of a fixed number of arguments.
    pub const fn new(
        name: &'static str,
        parameters: &'static [Parameter],
        body: BuiltinBody,
        doc: &'static str,
        example: (&'static str, &'static str),
    ) -> Builtin {
        Builtin { name, parameters, variadic: false, doc, domain: ("", ""), example, body }
    }

    /// The same, but it takes further arguments.
    pub const fn variadic(self) -> Builtin {
        Builtin { variadic: true, ..self }
    }

    /// The same, but it is defined only where the first text says; the second is a thing to try elsewhere.
    pub const fn defined(self, domain: &'static str, hint: &'static str) -> Builtin {
        Builtin { domain: (domain, hint), ..self }
    }
}

impl Builtin {
    /// How it is called: `clamp(x, low = 0, high = 1)`, `min(a, b, …)`.
    pub fn form(&self) -> String {
        let one = |p: &Parameter| p.default.map_or(p.name.to_string(), |d| format!("{} = {d}", p.name));
        let mut parameters: Vec<String> = self.parameters.iter().map(one).collect();
        if self.variadic {
            parameters.push("…".into());
        }
        format!("{}({})", self.name, parameters.join(", "))
    }

    /// Whether a call is made for what it says and gives the empty list, always: `print`.
    pub fn gives_nothing(&self) -> bool {
        self.example.1 == "[]"
    }
}

impl std::fmt::Debug for Property {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "property {}", self.name)
    }
}

impl std::fmt::Debug for Builtin {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "builtin {}", self.name)
    }
}

/// A parameter of a builtin.
pub struct Parameter {
    /// Its name, for named arguments.
    pub name: &'static str,
    /// What it takes, in words: "number", "vector", "list", "number or vector".
    pub takes: &'static str,
    /// Its default as written; none must be given.
    pub default: Option<&'static str>,
    /// It takes a name of the author's own, which may be written bare.
    pub bare: bool,
}

/// How many components a function of numbers and vectors gives, from how many each argument has (1 to 4). None where some
/// argument has the wrong number.
pub type ShapeOf = fn(&[usize]) -> Option<usize>;

impl Parameter {
    /// A parameter that must be given.
    pub const fn new(name: &'static str, takes: &'static str) -> Parameter {
        Parameter { name, takes, default: None, bare: false }
    }

    /// One that takes a name of the author's own, written bare.
    pub const fn bare(self) -> Parameter {
        Parameter { bare: true, ..self }
    }

    /// One that need not.
    pub const fn or(self, default: &'static str) -> Parameter {
        Parameter { default: Some(default), ..self }
    }
}

/// How a builtin computes. Numeric ones are plain functions, so that loops and tapes call them without ceremony; on vectors
/// they work component by component. A NaN is an error of the call, and so is an infinity from finite arguments;
/// [`super::builtins::undefined`] words them, [`super::builtins::call`] does all of it.
pub enum BuiltinBody {
    /// A number from a number.
    Number1(fn(f64) -> f64),
    /// A number from two. A variadic one folds further arguments from the left: min(a, b, c) = min(min(a, b), c).
    Number2(fn(f64, f64) -> f64),
    /// A number from three, and the same as tapes call it.
    Number3(fn(f64, f64, f64) -> f64, CallN),
    /// A number or vector from numbers and vectors as a whole (`dot`, `noise`): the components of all arguments, one after the
    /// other, to those of the result. Tapes call it as it is. NaN says "undefined here".
    Numbers(ShapeOf, CallN),
    /// Anything else; arguments are in the order of the parameters, with defaults filled in and their places beside them.
    General(fn(&mut dyn Context, &Arguments<'_>) -> Outcome),
}

/// The arguments of a call of a builtin.
pub struct Arguments<'a> {
    /// The values.
    pub values: &'a [Value],
    /// Their places, one each (the call's for a default).
    pub spans: &'a [Span],
    /// The call.
    pub span: Span,
}
