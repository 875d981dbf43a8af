//! The values of the language. A value is 32 bytes or less and cheap to clone: numbers and short vectors are stored in place.

use super::kinds::Part;
use super::table::{Builtin, Property};
use crate::diag::Span;
use crate::geometry::any_curve::AnyCurve;
use crate::math::Affine;
use crate::scene::{Camera, Light, Material, Object, Pattern, Pose, RenderSettings, Rig};
use glam::{DVec2, DVec3, DVec4};
use smallvec::SmallVec;
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
    Function(Rc<super::eval::slots::Closure>),
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
    /// A curve.
    Curve(AnyCurve),
    /// A skeleton.
    Skeleton(Arc<Rig>),
    /// A pose.
    Pose(Arc<Pose>),
    /// A joint or tip that waits for its skeleton.
    Part(Rc<Part>),
    /// Named parts: what a question about a shape gives.
    Record(Rc<Record>),
    /// An affine map.
    Transform(Rc<Affine>),
    /// Properties without a block: what a function of properties gives.
    Fragment(Rc<Fragment>),
    /// A bare word where a property takes words: `lobe phong`.
    Word(Rc<str>),
}

/// The elements of a list; reads as a slice.
#[derive(Debug, Default)]
pub struct List(Vec<Value>);

impl From<Vec<Value>> for List {
    fn from(elements: Vec<Value>) -> List {
        memory::hold(elements.capacity());
        List(elements)
    }
}

impl std::ops::Deref for List {
    type Target = [Value];
    fn deref(&self) -> &[Value] {
        &self.0
    }
}

impl Drop for List {
    fn drop(&mut self) {
        memory::release(self.0.capacity());
        if self.0.iter().any(is_container) {
            bury(std::mem::take(&mut self.0));
        }
    }
}

/// Whether a value may hold others of any depth.
pub(super) fn is_container(value: &Value) -> bool {
    matches!(value, Value::List(_) | Value::Function(_))
}

/// Drops values one by one instead of one inside the other: the depth of lists and closures is not bounded, the stack is.
pub(super) fn bury(values: Vec<Value>) {
    thread_local! {
        static WAITING: std::cell::RefCell<Option<Vec<Value>>> = const { std::cell::RefCell::new(None) };
    }
    let mut values = Some(values);
    let first = WAITING.try_with(|waiting| match &mut *waiting.borrow_mut() {
        Some(waiting) => {
            waiting.extend(values.take().into_iter().flatten());
            false
        }
        none => {
            *none = values.take();
            true
        }
    });
    if first != Ok(true) {
        return;
    }
    let next = || WAITING.try_with(|waiting| waiting.borrow_mut().as_mut().and_then(Vec::pop)).ok().flatten();
    while let Some(value) = next() {
        drop(value);
    }
    let _ = WAITING.try_with(|waiting| waiting.borrow_mut().take());
}

/// How much the lists of this thread hold.
pub mod memory {
    use std::cell::Cell;

    thread_local! {
        static ELEMENTS: Cell<usize> = const { Cell::new(0) };
    }

    pub(super) fn hold(elements: usize) {
        ELEMENTS.with(|held| held.set(held.get() + elements));
    }

    pub(super) fn release(elements: usize) {
        ELEMENTS.with(|held| held.set(held.get().saturating_sub(elements)));
    }

    /// Elements of all lists of this thread that are alive.
    pub fn elements() -> usize {
        ELEMENTS.with(Cell::get)
    }
}

/// A vector of 2, 3 or 4 components; a number of one.
pub fn vector(components: &[f64]) -> Value {
    match *components {
        [x, y] => Value::Vector2(DVec2::new(x, y)),
        [x, y, z] => Value::Vector3(DVec3::new(x, y, z)),
        [x, y, z, w] => Value::Vector4(Rc::new(DVec4::new(x, y, z, w))),
        [x, ..] => Value::Number(x),
        [] => Value::Number(0.0),
    }
}

/// sRGB bytes to linear RGB.
pub fn linear_from_srgb8(srgb: [u8; 3]) -> DVec3 {
    let [r, g, b] = srgb.map(|c| linear_from_srgb(f64::from(c) / 255.0));
    DVec3::new(r, g, b)
}

/// One sRGB channel in 0 … 1 to linear. IEC 61966-2-1.
pub fn linear_from_srgb(c: f64) -> f64 {
    if c <= 0.04045 { c / 12.92 } else { crate::math::elementary::powf((c + 0.055) / 1.055, 2.4) }
}

impl Value {
    /// A list of these elements.
    pub fn list(elements: Vec<Value>) -> Value {
        Value::List(Rc::new(List::from(elements)))
    }

    /// A text.
    pub fn text(text: &str) -> Value {
        Value::Text(text.into())
    }
}

/// Named parts, read by `value.name`.
#[derive(Clone, Debug)]
pub struct Record {
    /// What it is, with its article: "a place on a curve".
    pub name: &'static str,
    /// The parts in order: numbers, vectors, truth values.
    pub parts: Vec<(&'static str, Value)>,
}

impl Record {
    /// The part of this name.
    pub fn part(&self, name: &str) -> Option<&Value> {
        self.parts.iter().find(|(n, _)| *n == name).map(|(_, value)| value)
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
    /// What the table says of it, where the block is known that it stands in.
    pub property: Option<&'static Property>,
    /// The values with their places; none for a flag.
    pub values: Values,
}

/// Values with their places: nearly always one.
pub type Values = SmallVec<[(Value, Span); 1]>;

impl Given {
    /// From the name to the last value.
    pub fn span(&self) -> Span {
        self.values.last().map_or(self.name_span, |(_, span)| self.name_span.to(*span))
    }
}
