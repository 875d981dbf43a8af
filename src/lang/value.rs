//! The values of the language. A value is 32 bytes or less and cheap to clone: numbers and short vectors are stored in place.

use super::table::Builtin;
use crate::diag::Span;
use crate::math::Affine;
use crate::scene::{Camera, Light, Material, Object, Pattern, RenderSettings};
use glam::{DVec2, DVec3, DVec4};
use std::rc::Rc;
use std::sync::Arc;

/// Any value of the language.
#[derive(Clone, Debug)]
pub enum Value {
    /// f64.
    Number(f64),
    /// `true`, `false`.
    Bool(bool),
    /// Text.
    Text(Rc<str>),
    /// Two numbers.
    Vector2(DVec2),
    /// Three numbers; a colour is linear RGB.
    Vector3(DVec3),
    /// Four numbers.
    Vector4(Rc<DVec4>),
    /// A list. Made with [`Value::list`].
    List(Rc<List>),
    /// Integers or steps.
    Range(Rc<RangeValue>),
    /// A function of the scene: `fn`, or `p => …` with what it captured.
    Function(Rc<super::eval::Closure>),
    /// A function of the table of builtins.
    Builtin(&'static Builtin),
    /// An object.
    Object(Arc<Object>),
    /// A light.
    Light(Arc<Light>),
    /// A material.
    Material(Arc<Material>),
    /// A pattern.
    Pattern(Arc<Pattern>),
    /// A camera.
    Camera(Arc<Camera>),
    /// A render block.
    Render(Arc<RenderSettings>),
    /// An affine map.
    Transform(Rc<Affine>),
    /// Properties without a block: what a function of properties gives.
    Fragment(Rc<Fragment>),
    /// An imported file: `trees.oak`.
    Module(Rc<super::eval::Module>),
    /// A bare word where a property takes words: `lobe phong`.
    Word(Rc<str>),
}

/// The elements of a list; reads as a slice. Lists nested without bound are dropped without recursion.
#[derive(Debug, Default)]
pub struct List(Vec<Value>);

impl From<Vec<Value>> for List {
    fn from(elements: Vec<Value>) -> List {
        List(elements)
    }
}

impl std::ops::Deref for List {
    type Target = [Value];
    fn deref(&self) -> &[Value] {
        &self.0
    }
}

impl Value {
    /// A list of these elements.
    pub fn list(elements: Vec<Value>) -> Value {
        Value::List(Rc::new(List(elements)))
    }

    /// A text.
    pub fn text(text: &str) -> Value {
        Value::Text(text.into())
    }
}

/// `start..end step step`. Computed by index, so that steps do not add up their rounding: element i is start + i·step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RangeValue {
    /// First element.
    pub start: f64,
    /// End as written.
    pub end: f64,
    /// Step, not 0.
    pub step: f64,
    /// How many elements.
    pub len: usize,
}

/// Properties that wait for a block.
#[derive(Clone, Debug, Default)]
pub struct Fragment {
    /// In the order they were written.
    pub properties: Vec<Given>,
}

/// A property with its values, as an item gave it.
#[derive(Clone, Debug)]
pub struct Given {
    /// The property's name, shared by all that the item gives.
    pub name: Rc<str>,
    /// The name's place.
    pub name_span: Span,
    /// The values with their places; none for a flag.
    pub values: Vec<(Value, Span)>,
}

impl Given {
    /// From the name to the last value.
    pub fn span(&self) -> Span {
        self.values.last().map_or(self.name_span, |(_, span)| self.name_span.to(*span))
    }
}
