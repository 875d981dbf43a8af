//! A context for tests of the tables: it keeps what is reported and printed, and every file is there.

use super::table::{Arguments, Block, Builtin, Context, Gives, Kind, Outcome, Reported, Trace, Traced};
use super::value::{Given, Value};
use crate::diag::{Diagnostic, SourceId, Span};
use crate::scene::assets::Loader;
use crate::scene::assets::gltf::{Model, ModelError};
use crate::scene::{Object, SampleInput, SampledFunction};
use glam::DVec3;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// What was said.
#[derive(Default)]
pub struct Mock {
    /// Diagnostics.
    pub said: Vec<Diagnostic>,
    /// Prints.
    pub printed: Vec<String>,
}

struct EveryFile;

impl Loader for EveryFile {
    fn read(&self, _: &Path) -> std::io::Result<Vec<u8>> {
        Ok(Vec::new())
    }

    fn exists(&self, path: &Path) -> bool {
        !path.to_string_lossy().contains("missing")
    }
}

impl Trace for Mock {
    fn trace(&self, _: &Arc<Object>, _: DVec3, _: DVec3, _: Span) -> Result<Vec<Traced>, Vec<Diagnostic>> {
        Ok(Vec::new())
    }
}

impl Context for Mock {
    fn tracer(&self) -> &dyn Trace {
        self
    }

    fn report(&mut self, diagnostic: Diagnostic) {
        self.said.push(diagnostic);
    }

    fn call(&mut self, function: &Value, arguments: &[Value], at: Span) -> Outcome {
        let Value::Builtin(builtin) = function else { return Err(Reported) };
        let spans = vec![at; arguments.len()];
        super::builtins::call(self, builtin, &Arguments { values: arguments, spans: &spans, span: at })
    }

    fn arity(&self, function: &Value) -> Option<(usize, usize)> {
        matches!(function, Value::Builtin(_)).then_some((1, 1))
    }

    fn path(&self, written: &str, _: Span) -> PathBuf {
        Path::new("scenes").join(written)
    }

    fn loader(&self) -> &dyn Loader {
        &EveryFile
    }

    fn model(&mut self, path: &Path) -> Result<Arc<Model>, ModelError> {
        Model::read(&EveryFile, path).map(Arc::new)
    }

    fn print(&mut self, text: String) {
        self.printed.push(text);
    }

    fn sampled(&mut self, _: &Value, _: SampleInput, _: Gives<'_>, _: Span) -> Outcome<Arc<SampledFunction>> {
        Err(Reported)
    }

    fn reserve(&mut self, _: usize, _: Span) -> Outcome<()> {
        Ok(())
    }

    fn estimated(&mut self, _: f64) {}

    fn time(&self) -> (f64, f64) {
        (0.0, 0.0)
    }
}

impl Mock {
    /// Codes of all that was said, in order.
    pub fn codes(&self) -> Vec<&'static str> {
        self.said.iter().map(|d| d.code.text()).collect()
    }

    /// Calls a builtin.
    pub fn builtin(&mut self, name: &str, values: &[Value]) -> Outcome {
        let builtin: &'static Builtin = super::builtins::find(name).expect("a builtin");
        let spans: Vec<Span> = (0..values.len()).map(|i| span(10 * i)).collect();
        super::builtins::call(self, builtin, &Arguments { values, spans: &spans, span: span(0) })
    }
}

/// A place.
pub fn span(start: usize) -> Span {
    Span::new(SourceId(0), start, start + 5)
}

/// Properties, each at a place of its own.
pub fn given(properties: &[(&str, &[Value])]) -> Vec<Given> {
    let each = |(i, (name, values)): (usize, &(&str, &[Value]))| Given {
        name: (*name).into(),
        name_span: span(100 * (i + 1)),
        property: None,
        values: values
            .iter()
            .enumerate()
            .map(|(j, v)| (v.clone(), span(100 * (i + 1) + 10 * (j + 1))))
            .collect(),
    };
    properties.iter().enumerate().map(each).collect()
}

/// A block of a kind.
pub fn block(name: &str, properties: &[(&str, &[Value])]) -> Block {
    let kind: &'static Kind = super::kinds::find(name).expect("a kind");
    Block {
        kind,
        span: span(0),
        kind_span: span(0),
        label: None,
        given: given(properties),
        children: Vec::new(),
        poisoned: Vec::new(),
    }
}

/// A number.
pub fn n(x: f64) -> Value {
    Value::Number(x)
}

/// A 3-vector.
pub fn v(x: f64, y: f64, z: f64) -> Value {
    Value::Vector3(glam::DVec3::new(x, y, z))
}

/// A bare word.
pub fn w(word: &str) -> Value {
    Value::Word(word.into())
}
