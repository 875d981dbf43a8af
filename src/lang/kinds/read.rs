//! What builders read from a checked block. The check made every value one of its property's types, so a miss here is a
//! fault of the table and not of the scene.

use crate::diag::{Code, Diagnostic, Span};
use crate::geometry::any_curve::AnyCurve;
use crate::lang::coerce;
use crate::lang::table::{Block, Context, Reported};
use crate::lang::value::{Given, Value};
use crate::math::Affine;
use crate::scene::{Material, Object, Rgb, Texture};
use glam::{DVec2, DVec3};
use std::sync::Arc;

impl Block {
    /// The property of this name, where it was given.
    pub fn get(&self, name: &str) -> Option<&Given> {
        self.given.iter().find(|g| &*g.name == name)
    }

    /// Whether it was given.
    pub fn has(&self, name: &str) -> bool {
        self.get(name).is_some()
    }

    /// Its first value.
    pub fn value(&self, name: &str) -> Option<&Value> {
        self.get(name)?.values.first().map(|(value, _)| value)
    }

    /// The place of its values, or of its name where it has none, or of the kind's word where it was not given.
    pub fn place(&self, name: &str) -> Span {
        match self.get(name) {
            None => self.kind_span,
            Some(given) => match (given.values.first(), given.values.last()) {
                (Some((_, first)), Some((_, last))) if first.source == last.source => first.to(*last),
                _ => given.name_span,
            },
        }
    }

    /// The place of its value of this index.
    pub fn place_of(&self, name: &str, i: usize) -> Span {
        self.get(name).and_then(|g| g.values.get(i)).map_or(self.kind_span, |(_, span)| *span)
    }

    /// Its number.
    pub fn number(&self, name: &str) -> Option<f64> {
        self.value(name).map(number_of)
    }

    /// Its numbers.
    pub fn numbers(&self, name: &str) -> Option<Vec<f64>> {
        Some(self.get(name)?.values.iter().map(|(v, _)| number_of(v)).collect())
    }

    /// Its whole number.
    pub fn integer(&self, name: &str) -> Option<u64> {
        self.number(name).map(|x| x as u64)
    }

    /// Its 3-vector or colour.
    pub fn vector(&self, name: &str) -> Option<DVec3> {
        self.value(name).map(vector_of)
    }

    /// Its 3-vectors.
    pub fn vectors(&self, name: &str) -> Option<Vec<DVec3>> {
        Some(self.get(name)?.values.iter().map(|(v, _)| vector_of(v)).collect())
    }

    /// Its 2-vectors.
    pub fn vectors2(&self, name: &str) -> Option<Vec<DVec2>> {
        let of = |value: &Value| match value {
            Value::Vector2(v) => *v,
            _ => unreachable!("checked to be 2-vectors"),
        };
        Some(self.get(name)?.values.iter().map(|(v, _)| of(v)).collect())
    }

    /// Its word.
    pub fn word(&self, name: &str) -> Option<&str> {
        match self.value(name)? {
            Value::Word(word) => Some(word),
            _ => unreachable!("checked to be a word"),
        }
    }

    /// Its text.
    pub fn text(&self, name: &str) -> Option<&str> {
        match self.value(name)? {
            Value::Text(text) => Some(text),
            _ => unreachable!("checked to be a text"),
        }
    }

    /// A flag or truth value: given alone it is true.
    pub fn flag(&self, name: &str) -> Option<bool> {
        match self.get(name)?.values.first() {
            None => Some(true),
            Some((Value::Bool(b), _)) => Some(*b),
            Some(_) => unreachable!("checked to be a truth value"),
        }
    }

    /// Its texture.
    pub fn texture(&self, name: &str) -> Option<Texture> {
        self.value(name).map(|v| coerce::texture(v).expect("checked to be a texture"))
    }

    /// Its colour.
    pub fn colour(&self, name: &str) -> Option<Rgb> {
        self.vector(name)
    }

    /// Its object.
    pub fn object(&self, name: &str) -> Option<Arc<Object>> {
        match self.value(name)? {
            Value::Object(object) => Some(object.clone()),
            _ => unreachable!("checked to be an object"),
        }
    }

    /// Its curve.
    pub fn curve(&self, name: &str) -> Option<&AnyCurve> {
        match self.value(name)? {
            Value::Curve(curve) => Some(curve),
            _ => unreachable!("checked to be a curve"),
        }
    }

    /// An error about a property's values.
    pub fn fault(
        &self,
        ctx: &mut dyn Context,
        code: Code,
        name: &str,
        message: impl Into<String>,
        hint: impl Into<String>,
    ) -> Reported {
        ctx.fail(Diagnostic::new(code, self.place(name), message).hint(hint))
    }
}

/// A checked number.
pub fn number_of(value: &Value) -> f64 {
    match value {
        Value::Number(x) => *x,
        _ => unreachable!("checked to be a number"),
    }
}

/// A checked 3-vector.
pub fn vector_of(value: &Value) -> DVec3 {
    match value {
        Value::Vector3(v) => *v,
        _ => unreachable!("checked to be a 3-vector"),
    }
}

/// A checked material.
pub fn material_of(value: &Value) -> Arc<Material> {
    match value {
        Value::Material(material) => material.clone(),
        _ => unreachable!("checked to be a material"),
    }
}

/// A checked transform.
pub fn transform_of(value: &Value) -> Affine {
    match value {
        Value::Transform(affine) => **affine,
        _ => unreachable!("checked to be a transform"),
    }
}

/// A checked text.
pub fn text_of(value: &Value) -> &str {
    match value {
        Value::Text(text) => text,
        _ => unreachable!("checked to be a text"),
    }
}

/// A checked word.
pub fn word_of(value: &Value) -> &str {
    match value {
        Value::Word(word) => word,
        _ => unreachable!("checked to be a word"),
    }
}
