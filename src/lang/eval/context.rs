//! What builders and builtins may ask of a run.

use super::{Evaluator, Said};
use crate::diag::{Diagnostic, Span};
use crate::lang::compile;
use crate::lang::members;
use crate::lang::table::{Context, Gives, Outcome, Trace};
use crate::lang::value::Value;
use crate::scene::assets::Loader;
use crate::scene::assets::gltf::{Model, ModelError};
use crate::scene::{Rig, SampleInput, SampledFunction};
use std::path::{Path, PathBuf};
use std::sync::Arc;

impl Context for Evaluator<'_> {
    fn report(&mut self, diagnostic: Diagnostic) {
        self.say(diagnostic);
    }

    fn call(&mut self, function: &Value, arguments: &[Value], at: Span) -> Outcome {
        self.call_with_values(function, arguments, at)
    }

    fn arity(&self, function: &Value) -> Option<(usize, usize)> {
        match function {
            Value::Function(closure) => {
                let parameters = &self.program.functions[closure.function.0 as usize].parameters;
                Some((parameters.len(), parameters.iter().filter(|p| p.default.is_none()).count()))
            }
            Value::Builtin(builtin) => {
                let needed = builtin.parameters.iter().filter(|p| p.default.is_none()).count();
                Some((builtin.parameters.len(), needed))
            }
            other => members::call_of(other).map(|member| (member.parameters.len(), member.parameters.len())),
        }
    }

    fn path(&self, written: &str, at: Span) -> PathBuf {
        self.run.files.join(written, at)
    }

    fn loader(&self) -> &dyn Loader {
        self.run.loader
    }

    fn model(&mut self, path: &Path) -> Result<Arc<Model>, ModelError> {
        if let Some(known) = self.models.get(path) {
            return known.clone();
        }
        let read = Model::read(self.run.loader, path).map(Arc::new);
        self.models.insert(path.to_owned(), read.clone());
        read
    }

    fn print(&mut self, text: String) {
        self.said.push(Said::Printed(text));
    }

    fn sampled(
        &mut self,
        function: &Value,
        input: SampleInput,
        gives: Gives<'_>,
        at: Span,
    ) -> Outcome<Arc<SampledFunction>> {
        let program = self.program;
        compile::compile(self, program, &compile::Request { function, input, gives, at }).map(Arc::new)
    }

    fn reserve(&mut self, elements: usize, at: Span) -> Outcome<()> {
        self.reserve_list(elements, at)?;
        self.turns(elements, at)
    }

    fn estimated(&mut self, error: f64) {
        self.estimate = Some(error);
    }

    fn tracer(&self) -> &dyn Trace {
        self.run.tracer
    }

    fn time(&self) -> (f64, f64) {
        self.run.time
    }

    fn start_of_reach(&self, pose: Span, given: &[f64]) -> Option<Vec<f64>> {
        self.carried_start(pose, given)
    }

    fn reached(&mut self, pose: Span, given: &[f64], found: &[f64]) {
        self.carry_reach(pose, given, found);
    }

    fn skeleton_read(&self, path: &Path, block: Span) -> Option<Arc<Rig>> {
        self.standing.carried.as_ref()?.skeleton(path, block)
    }

    fn keep_skeleton(&mut self, path: &Path, rig: &Arc<Rig>) {
        if let Some(carried) = &mut self.standing.carried {
            carried.keep_skeleton(path, rig);
        }
    }
}

impl compile::Host for Evaluator<'_> {
    fn global(&self, slot: u32) -> super::slots::Slot {
        self.standing.globals[slot as usize].clone()
    }
}
