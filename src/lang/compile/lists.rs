//! The list functions that work on lists of known length whose elements only a sample decides.

use super::symbol::Symbol;
use super::{Captures, Compiled, Compiler};
use crate::diag::Span;
use crate::lang::resolve::program::Arithmetic;
use crate::lang::value::Value;
use std::rc::Rc;

impl Compiler<'_> {
    /// The value of a list function, where it is one that can be written out.
    pub(super) fn list_function(
        &mut self,
        name: &str,
        values: &[Symbol],
        span: Span,
    ) -> Compiled<Option<Symbol>> {
        let Some((list, len)) = values.iter().find_map(|v| Some((v, v.len()?))) else { return Ok(None) };
        if name == "len" && values.len() == 1 {
            return Ok(Some(Symbol::Known(Value::Number(len as f64))));
        }
        if !matches!(name, "sum" | "map" | "fold") {
            return Ok(None);
        }
        let elements = self.turns(list, span)?.unwrap_or_default();
        let function = || values.iter().find(|v| is_function(v)).cloned();
        match (name, values) {
            ("sum", [_]) => {
                let mut sum = Symbol::Known(Value::Number(0.0));
                for (i, element) in elements.iter().enumerate() {
                    sum = match i {
                        0 => element.clone(),
                        _ => self.arithmetic(Arithmetic::Add, &sum, element, span)?,
                    };
                }
                Ok(Some(sum))
            }
            ("map", [_, _]) => {
                let Some(function) = function() else { return Ok(None) };
                let mapped = elements
                    .into_iter()
                    .map(|e| self.apply(&function, vec![e], span))
                    .collect::<Compiled<Vec<_>>>()?;
                Ok(Some(Symbol::List(Rc::new(mapped))))
            }
            ("fold", [_, start, _]) => {
                let Some(function) = function() else { return Ok(None) };
                let mut so_far = start.clone();
                for element in elements {
                    so_far = self.apply(&function, vec![so_far, element], span)?;
                }
                Ok(Some(so_far))
            }
            _ => Ok(None),
        }
    }

    fn apply(&mut self, function: &Symbol, arguments: Vec<Symbol>, span: Span) -> Compiled {
        match function {
            Symbol::Known(Value::Function(closure)) => {
                self.enter(closure.function, Captures::Values(closure.captured.clone()), arguments, span)
            }
            Symbol::Function(id, captured) => {
                self.enter(*id, Captures::Symbols(captured.clone()), arguments, span)
            }
            Symbol::Known(Value::Builtin(builtin)) => self.builtin(builtin, arguments, &[], span),
            other => Err(self.mismatch(format!("a function is needed, and this is {}", other.shown()), span)),
        }
    }
}

fn is_function(symbol: &Symbol) -> bool {
    matches!(symbol, Symbol::Function(..) | Symbol::Known(Value::Function(_) | Value::Builtin(_)))
}
