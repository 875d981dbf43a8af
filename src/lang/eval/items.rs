//! Items: they bind names, produce properties and nodes, and decide what runs next.

use super::slots::{Captured, Closure, Slot};
use super::{Around, Evaluator, Flow, Produced, Said};
use crate::diag::{Code, Diagnostic, Span};
use crate::lang::coerce::shown;
use crate::lang::resolve::program::{
    Access, Body, Capture, Expr, ExprKind, For, FunctionId, Functions, If, Item, ItemKind, Property, UnitId,
    While,
};
use crate::lang::table::{Context, Outcome, Reported};
use crate::lang::value::{Given, RangeValue, Value, Values};
use crate::scene::{Node, Object, Shape};
use std::rc::Rc;
use std::sync::Arc;

/// A loop stops after this many turns with errors: each place is told once, and more of the same help nobody.
pub(super) const FAILING_TURNS: usize = 16;

/// What an object and the node that holds it take in memory, with its material's share; for the memory guard.
const OBJECT_BYTES: u64 = 256;

impl<'p> Evaluator<'p> {
    /// Runs the items of a scope. Errors are told, remembered in `out`, and end only their item.
    pub(super) fn items(&mut self, body: &'p Body, out: &mut Produced) -> Flow {
        if let Some(functions) = &body.functions {
            self.make_functions(functions);
        }
        for item in &body.items {
            let done = match &item.kind {
                // What loops are made of, kept apart from the frame that all items together need.
                ItemKind::Assign(access, value) => self.assign(*access, value).map(|()| Flow::On),
                _ => self.item(item, out),
            };
            match done {
                Ok(Flow::On) => {}
                Ok(Flow::Return) => return Flow::Return,
                Err(Reported) => out.failed = true,
            }
        }
        Flow::On
    }

    fn item(&mut self, item: &'p Item, out: &mut Produced) -> Outcome<Flow> {
        match &item.kind {
            ItemKind::Assign(access, value) => self.assign(*access, value)?,
            ItemKind::Bind(access, value) => self.bind(*access, value)?,
            ItemKind::Property(property) => self.property(property, out)?,
            ItemKind::Block(block) => self.block_item(block, out)?,
            ItemKind::Place(value) => {
                self.estimate = None;
                let placed = self.expr(value)?;
                if self.run.answers != Some(value.span.source) || self.answer(&placed, value, out) {
                    self.place(placed, value, out)?;
                }
            }
            ItemKind::If(choice) => return self.choice(choice, out),
            ItemKind::For(turns) => return self.for_item(turns, item.span, out),
            ItemKind::While(turns) => return self.while_item(turns, item.span, out),
            ItemKind::Return(value) => {
                self.returned = value.as_ref().map(|value| self.expr(value));
                return Ok(Flow::Return);
            }
            ItemKind::Import(unit, span) => self.import(*unit, *span)?,
            ItemKind::Poison(name) => {
                if let Some(name) = name {
                    out.poisoned.push((name.clone(), item.span));
                }
                return Err(Reported);
            }
        }
        Ok(Flow::On)
    }

    /// Answers an expression with its value; whether it is to be placed too.
    fn answer(&mut self, value: &Value, written: &Expr, out: &Produced) -> bool {
        if out.around != Around::Top {
            return true;
        }
        let gives_nothing = match (&written.kind, value) {
            (ExprKind::CallBuiltin(call), _) => call.builtin.gives_nothing(),
            (_, Value::Fragment(fragment)) => fragment.properties.is_empty(),
            _ => false,
        };
        if self.check_shown(value, written.span).is_err() {
            return false;
        }
        if !gives_nothing {
            self.said.push(Said::Answer(value.clone()));
            let direct = matches!(written.kind, ExprKind::Field(_) | ExprKind::CallMethod(_));
            let estimate = self.estimate.take().filter(|_| direct);
            self.said.extend(estimate.map(Said::Within));
        }
        let mut waiting = vec![value];
        while let Some(value) = waiting.pop() {
            match value {
                Value::List(list) => waiting.extend(list.iter()),
                Value::Object(_) | Value::Light(_) | Value::Camera(_) | Value::Render(_) => {}
                _ => return false,
            }
        }
        true
    }

    #[inline(always)]
    pub(super) fn slot(&mut self, access: Access) -> &mut Slot {
        match access {
            Access::Local(slot) => &mut self.stack[self.base + slot as usize],
            Access::Global(slot) => &mut self.standing.globals[slot as usize],
            Access::Captured(_) | Access::Sibling(_) => unreachable!("names are declared in their own frame"),
        }
    }

    /// Gives a new name its value; poison where that failed.
    pub(super) fn bind_value(&mut self, access: Access, value: &Outcome) {
        let slot = match value {
            Ok(value) => Slot::Value(value.clone()),
            Err(Reported) => Slot::Poison,
        };
        self.slot(access).declare(slot);
    }

    fn bind(&mut self, access: Access, value: &'p Expr) -> Outcome<()> {
        let value = self.expr(value);
        let outcome = value.as_ref().map(|_| ()).map_err(|e| *e);
        self.slot(access).declare(value.map_or(Slot::Poison, Slot::Value));
        outcome
    }

    fn make_functions(&mut self, functions: &Functions) {
        let captured = self.capture(&functions.captures);
        for (access, function) in &functions.bindings {
            let closure = Closure { function: *function, captured: captured.clone() };
            *self.slot(*access) = Slot::Value(Value::Function(Rc::new(closure)));
        }
    }

    /// What a closure takes along from here.
    pub(super) fn capture(&mut self, captures: &[Capture]) -> Option<Rc<Captured>> {
        if captures.is_empty() {
            return None;
        }
        let slots: Vec<Slot> = captures.iter().map(|c| self.capture_one(*c)).collect();
        Some(Rc::new(Captured::from(slots)))
    }

    fn capture_one(&mut self, capture: Capture) -> Slot {
        match capture {
            Capture::Value(slot) => match &self.stack[self.base + slot as usize] {
                Slot::Shared(cell) => Slot::Shared(cell.clone()),
                slot => slot.clone(),
            },
            Capture::Reference(slot) => self.stack[self.base + slot as usize].share(),
            Capture::Fresh(slot) => {
                let slot = &mut self.stack[self.base + slot as usize];
                *slot = Slot::Unset;
                slot.share()
            }
            Capture::Outer(slot) => self.captured.as_ref().map_or(Slot::Unset, |c| c[slot as usize].clone()),
            Capture::Sibling(function) => Slot::Value(self.sibling(function)),
        }
    }

    /// A function declared beside the running one, as a value.
    pub(super) fn sibling(&self, function: FunctionId) -> Value {
        Value::Function(Rc::new(Closure { function, captured: self.captured.clone() }))
    }

    fn property(&mut self, property: &'p Property, out: &mut Produced) -> Outcome<()> {
        let mut values = Values::with_capacity(property.values.len());
        let mut outcome = Ok(());
        for value in &property.values {
            match self.expr(value) {
                Ok(v) => values.push((v, value.span)),
                Err(Reported) => outcome = Err(Reported),
            }
        }
        match outcome {
            Ok(()) => out.given.push(Given {
                name: property.name.clone(),
                name_span: property.name_span,
                property: property.known,
                values,
            }),
            Err(Reported) => out.poisoned.push((property.name.clone(), property.name_span)),
        }
        outcome
    }

    fn choice(&mut self, choice: &'p If, out: &mut Produced) -> Outcome<Flow> {
        for (condition, body) in &choice.arms {
            if self.condition(condition)? {
                return Ok(self.items(body, out));
            }
        }
        Ok(choice.otherwise.as_ref().map_or(Flow::On, |body| self.items(body, out)))
    }

    /// A truth value.
    pub(super) fn condition(&mut self, condition: &'p Expr) -> Outcome<bool> {
        match self.expr(condition)? {
            Value::Bool(b) => Ok(b),
            other => Err(self.not_a_truth_value(&other, condition.span)),
        }
    }

    #[cold]
    pub(super) fn not_a_truth_value(&mut self, value: &Value, span: Span) -> Reported {
        let said = Diagnostic::new(
            Code::TypeMismatch,
            span,
            format!("a condition is true or false, and this is {}", shown(value)),
        );
        self.fail(match value {
            Value::Number(_) => said.hint("compare it: `… != 0`"),
            _ => said,
        })
    }

    /// One turn of a loop: whether it returns, and a count of turns that failed.
    fn turn_of(&mut self, body: &'p Body, out: &mut Produced, failing: &mut usize) -> Outcome<Flow> {
        let failed = std::mem::replace(&mut out.failed, false);
        let flow = self.items(body, out);
        *failing += usize::from(out.failed);
        out.failed |= failed;
        if *failing >= FAILING_TURNS { Err(Reported) } else { Ok(flow) }
    }

    fn for_item(&mut self, turns: &'p For, span: Span, out: &mut Produced) -> Outcome<Flow> {
        let list = self.expr(&turns.list)?;
        if let Value::Range(range) = &list {
            return self.for_range(turns, range, span, out);
        }
        let mut failing = 0;
        let mut n_done = 0;
        while let Some(value) = self.element_of(&list, n_done, turns.list.span)? {
            self.turn(span)?;
            n_done += 1;
            let slot = self.base + turns.slot as usize;
            self.stack[slot] = Slot::Value(value);
            if self.turn_of(&turns.body, out, &mut failing)? == Flow::Return {
                return Ok(Flow::Return);
            }
        }
        Ok(Flow::On)
    }

    fn for_range(
        &mut self,
        turns: &'p For,
        range: &RangeValue,
        span: Span,
        out: &mut Produced,
    ) -> Outcome<Flow> {
        let mut failing = 0;
        for i in 0..range.len {
            self.turn(span)?;
            let x = range.element(i);
            match &mut self.stack[self.base + turns.slot as usize] {
                Slot::Value(Value::Number(old)) => *old = x,
                slot => *slot = Slot::Value(Value::Number(x)),
            }
            if self.turn_of(&turns.body, out, &mut failing)? == Flow::Return {
                return Ok(Flow::Return);
            }
        }
        Ok(Flow::On)
    }

    /// An element of what a loop runs over; none past its end.
    #[inline]
    pub(super) fn element_of(&mut self, list: &Value, i: usize, span: Span) -> Outcome<Option<Value>> {
        match list {
            Value::Range(range) => Ok((i < range.len).then(|| Value::Number(range.element(i)))),
            Value::List(list) => Ok(list.get(i).cloned()),
            other => Err(self.not_a_list(other, span)),
        }
    }

    #[cold]
    fn not_a_list(&mut self, value: &Value, span: Span) -> Reported {
        let said = Diagnostic::new(
            Code::TypeMismatch,
            span,
            format!("a loop runs over a range or a list, and this is {}", shown(value)),
        );
        self.fail(match value {
            Value::Number(_) => said.hint("write a range: `0..n`"),
            _ => said.hint("write a range, `0..10`, or a list, `[a, b]`"),
        })
    }

    fn while_item(&mut self, turns: &'p While, span: Span, out: &mut Produced) -> Outcome<Flow> {
        let mut failing = 0;
        while self.condition(&turns.condition)? {
            self.turn(span)?;
            if self.turn_of(&turns.body, out, &mut failing)? == Flow::Return {
                return Ok(Flow::Return);
            }
        }
        Ok(Flow::On)
    }

    /// Runs an imported unit, the first time, and keeps its group for `t.scene`.
    fn import(&mut self, id: UnitId, span: Span) -> Outcome<()> {
        if self.standing.units_done[id.0 as usize] {
            return Ok(());
        }
        let (top, nodes) = self.unit(id);
        let left_out = top.cameras.first().map(|c| ("camera", c.span));
        let left_out = left_out.or(top.render.and_then(|r| r.span).map(|span| ("render", span)));
        if let Some((what, at)) = left_out {
            self.say(
                Diagnostic::new(
                    Code::ImportedRender,
                    span,
                    format!("the imported file has a `{what}` block, which is left out"),
                )
                .also(at, "this one")
                .hint("an import without `as` takes it in"),
            );
        }
        let group = Object::new(Shape::Group(nodes.into()), span);
        if let Some(slot) = self.program.units[id.0 as usize].scene {
            self.standing.globals[slot as usize] = Slot::Value(Value::Object(Arc::new(group)));
        }
        if top.attempts.failed { Err(Reported) } else { Ok(()) }
    }

    /// Places a value: objects, lights, lists of them, properties; at the top level also cameras.
    pub(super) fn place(&mut self, value: Value, written: &'p Expr, out: &mut Produced) -> Outcome<()> {
        let span = written.span;
        match value {
            Value::Object(object) => self.place_node(Node::Object(object), span, out),
            Value::Light(light) => self.place_node(Node::Light(light), span, out),
            Value::List(list) => {
                for i in 0..list.len() {
                    self.turn(span)?;
                    self.place_element(&list[i], written, out)?;
                }
                Ok(())
            }
            Value::Fragment(fragment) if out.around == Around::Braces || fragment.properties.is_empty() => {
                out.given.extend(fragment.properties.iter().cloned());
                Ok(())
            }
            Value::Camera(camera) if out.around == Around::Top => {
                self.top.attempts.setting = true;
                self.top.cameras.push((*camera).clone());
                Ok(())
            }
            Value::Render(settings) if out.around == Around::Top => self.place_render(&settings, span),
            other => Err(self.not_placeable(&other, written)),
        }
    }

    /// An element of a placed list; lists inside lists are placed too, as deep as the stack of calls may be.
    fn place_element(&mut self, value: &Value, written: &'p Expr, out: &mut Produced) -> Outcome<()> {
        let mut waiting = vec![value.clone()];
        while let Some(value) = waiting.pop() {
            match value {
                Value::List(list) => waiting.extend(list.iter().rev().cloned()),
                Value::Fragment(fragment) if !fragment.properties.is_empty() => {
                    return Err(self.not_placeable(&Value::Fragment(fragment), written));
                }
                other => self.place(other, written, out)?,
            }
        }
        Ok(())
    }

    pub(super) fn place_node(&mut self, node: Node, span: Span, out: &mut Produced) -> Outcome<()> {
        self.spend(OBJECT_BYTES, span)?;
        out.nodes.push(node);
        Ok(())
    }

    #[cold]
    fn not_placeable(&mut self, value: &Value, written: &Expr) -> Reported {
        let said = Diagnostic::new(
            Code::NotPlaceable,
            written.span,
            format!("{} cannot be placed: only objects and lights can", shown(value)),
        );
        let hint = match (value, &written.kind) {
            (Value::Fragment(_), _) => "properties stand inside the braces of a block: put the call there",
            (Value::Function(_) | Value::Builtin(_), _) => "call it: a call is written `name(…)`",
            (Value::Material(_), _) => "give it to an object: `material name` inside the object's braces",
            (Value::Pattern(_), _) => "give it to a material: `diffuse name`",
            (Value::Transform(_), _) => "give it to an object: `matrix name`",
            (Value::Bool(_), ExprKind::Compare(..)) => {
                "to check a condition, write `assert(condition, \"message\")`"
            }
            (Value::Camera(_) | Value::Render(_), _) => {
                "it stands at the top level of a file, not inside braces"
            }
            _ => "an item that is an expression places its value; to keep a value, write `let name = …`",
        };
        self.fail(said.hint(hint))
    }
}
