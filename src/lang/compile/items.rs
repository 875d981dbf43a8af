//! The items of a function's body.

use super::expressions::Truth;
use super::symbol::{Shape, Symbol, symbol_of};
use super::{Compiled, Compiler};
use crate::diag::{Code, Span};
use crate::lang::resolve::program::{Access, Body, Expr, For, If, Item, ItemKind, While};
use crate::lang::value::Value;
use crate::math::field::{Binary, FaultKind, Label, Register};
use std::rc::Rc;

/// Loops of up to this many turns are written out, so that what hangs on their variable is known.
const WRITTEN_OUT: usize = 16;

/// Where `return` inside a branch puts its value and goes on.
pub(super) struct ReturnPlace {
    shape: Shape,
    registers: Vec<Register>,
    end: Label,
}

/// What items do to the items after them.
enum Flow {
    /// The next one follows.
    On,
    /// Nothing follows: the function has returned. The value, where it did so outside all branches.
    Returned(Option<Symbol>),
}

impl<'c> Compiler<'c> {
    pub(super) fn function_items(&mut self, body: &'c Body, span: Span) -> Compiled {
        let flow = self.items(body)?;
        if let Flow::Returned(Some(value)) = &flow
            && self.frame().result.is_none()
        {
            return Ok(value.clone());
        }
        if let Flow::Returned(Some(value)) = flow {
            self.return_into(&value, span)?;
        } else if let Flow::On = flow {
            if self.frame().result.is_none() {
                return Err(self
                    .refuse(Code::NotSampled, span, "this function gives no value while rendering")
                    .hint("end it with `return …`")
                    .into());
            }
            self.at(span).fault(FaultKind::Undefined);
        }
        let place = self.frame().result.take().expect("a value was returned");
        self.builder.bind(place.end);
        Ok(symbol_of(place.shape, &place.registers))
    }

    fn items(&mut self, body: &'c Body) -> Compiled<Flow> {
        if let Some(functions) = &body.functions {
            let span = self.frame().span;
            let captured = Rc::new(self.captured(&functions.captures, span)?);
            for (access, function) in &functions.bindings {
                if let Access::Local(slot) = access {
                    self.frame().slots[*slot as usize] = Some(Symbol::Function(*function, captured.clone()));
                }
            }
        }
        for item in &body.items {
            if let Flow::Returned(value) = self.item(item)? {
                return Ok(Flow::Returned(value));
            }
        }
        Ok(Flow::On)
    }

    fn item(&mut self, item: &'c Item) -> Compiled<Flow> {
        match &item.kind {
            ItemKind::Bind(access, value) => {
                let value = self.expr(value)?;
                if let Access::Local(slot) = access {
                    let frame = self.frame();
                    frame.slots[*slot as usize] = Some(value);
                    frame.bound_in[*slot as usize] = frame.branch;
                }
            }
            ItemKind::Assign(access, value) => self.assign(*access, value, item.span)?,
            ItemKind::Return(Some(value)) => return self.return_item(value),
            ItemKind::If(choice) => return self.choice_item(choice, item.span),
            ItemKind::For(turns) => return self.for_item(turns, item.span),
            ItemKind::While(turns) => return self.while_item(turns, item.span),
            ItemKind::Poison(_) => return Err(super::Stop::Silent),
            ItemKind::Place(value) => {
                let value = self.expr(value)?;
                let message = format!("{} has no use while rendering", value.shown());
                return Err(self
                    .refuse(Code::NotSampled, item.span, message)
                    .hint("write `return …`")
                    .into());
            }
            ItemKind::Property(_) | ItemKind::Block(_) | ItemKind::Return(None) | ItemKind::Import(..) => {
                return Err(self.impossible("nothing is built or placed", item.span));
            }
        }
        Ok(Flow::On)
    }

    fn assign(&mut self, access: Access, value: &'c Expr, span: Span) -> Compiled<()> {
        let Access::Local(slot) = access else {
            return Err(self
                .refuse(
                    Code::NotSampled,
                    span,
                    "a function that runs while rendering cannot assign outside itself",
                )
                .hint("make the `var` inside the function, and `return` what comes of it")
                .into());
        };
        let value = self.expr(value)?;
        let frame = self.frame();
        if frame.bound_in[slot as usize] == frame.branch {
            frame.slots[slot as usize] = Some(value);
            return Ok(());
        }
        let before = self.frame().slots[slot as usize].clone();
        let (Some(before), Some((shape, registers))) = (before, self.held(&value)) else {
            return Err(self.undecided(&value, span));
        };
        match self.held(&before) {
            Some((old, variables)) if old == shape => {
                variables.iter().zip(&registers).for_each(|(to, from)| self.at(span).assign(*to, *from));
                Ok(())
            }
            _ => {
                let message = format!(
                    "this `var` was {} and cannot become {} inside a branch or loop",
                    before.shown(),
                    value.shown()
                );
                Err(self.refuse(Code::NotSampled, span, message).into())
            }
        }
    }

    /// Before a branch: what it assigns gets registers of its own, which both ways write.
    fn settle(&mut self, bodies: &[&'c Body], span: Span) -> Compiled<()> {
        let mut slots = Vec::new();
        bodies.iter().for_each(|body| assigned(body, &mut slots));
        slots.sort_unstable();
        slots.dedup();
        for slot in slots {
            let Some(symbol) = self.frame().slots[slot as usize].clone() else { continue };
            if let Some((shape, registers)) = self.held(&symbol) {
                let own: Vec<Register> = registers.iter().map(|r| self.at(span).variable(*r)).collect();
                self.frame().slots[slot as usize] = Some(symbol_of(shape, &own));
            }
        }
        Ok(())
    }

    fn return_item(&mut self, value: &'c Expr) -> Compiled<Flow> {
        let symbol = self.expr(value)?;
        if self.frame().branch == 0 {
            return Ok(Flow::Returned(Some(symbol)));
        }
        self.return_into(&symbol, value.span)?;
        let end = self.frame().result.as_ref().map(|place| place.end);
        if let Some(end) = end {
            self.builder.jump(end);
        }
        Ok(Flow::Returned(None))
    }

    fn return_into(&mut self, symbol: &Symbol, span: Span) -> Compiled<()> {
        let Some((shape, registers)) = self.held(symbol) else { return Err(self.undecided(symbol, span)) };
        if self.frame().result.is_none() {
            let own = registers.iter().map(|_| self.builder.unset()).collect();
            let end = self.builder.label();
            self.frame().result = Some(ReturnPlace { shape, registers: own, end });
        }
        let place = self.frame().result.as_ref().expect("just made");
        let (wanted, own) = (place.shape, place.registers.clone());
        if wanted != shape {
            return Err(self.mismatch(
                format!("this `return` gives {}, another one something else", symbol.shown()),
                span,
            ));
        }
        own.iter().zip(&registers).for_each(|(to, from)| self.at(span).assign(*to, *from));
        Ok(())
    }

    fn choice_item(&mut self, choice: &'c If, span: Span) -> Compiled<Flow> {
        let mut bodies: Vec<&'c Body> = choice.arms.iter().map(|(_, body)| body).collect();
        bodies.extend(choice.otherwise.as_ref());
        let end = self.builder.label();
        let mut undecided = false;
        let mut all_return = true;
        for (condition, body) in &choice.arms {
            match self.truth(condition)? {
                Truth::Known(false) => {}
                Truth::Known(true) if !undecided => return self.items(body),
                Truth::Known(true) => {
                    all_return &= self.branch(body)?;
                    return self.end_choice(end, all_return);
                }
                Truth::Register(register) => {
                    if !undecided {
                        self.settle(&bodies, span)?;
                        undecided = true;
                    }
                    let next = self.builder.label();
                    self.at(condition.span).jump_if_zero(register, next);
                    all_return &= self.branch(body)?;
                    self.builder.jump(end);
                    self.builder.bind(next);
                }
            }
        }
        match &choice.otherwise {
            Some(body) if undecided => all_return &= self.branch(body)?,
            Some(body) => return self.items(body),
            None => all_return = false,
        }
        if !undecided {
            return Ok(Flow::On);
        }
        self.end_choice(end, all_return)
    }

    fn end_choice(&mut self, end: Label, all_return: bool) -> Compiled<Flow> {
        self.builder.bind(end);
        Ok(if all_return { Flow::Returned(None) } else { Flow::On })
    }

    /// Items that only some samples reach; whether they always return.
    fn branch(&mut self, body: &'c Body) -> Compiled<bool> {
        self.n_branches += 1;
        let id = self.n_branches;
        let around = std::mem::replace(&mut self.frame().branch, id);
        let flow = self.items(body)?;
        self.frame().branch = around;
        Ok(matches!(flow, Flow::Returned(_)))
    }

    fn for_item(&mut self, turns: &'c For, span: Span) -> Compiled<Flow> {
        let list = self.expr(&turns.list)?;
        if let Symbol::Known(Value::Range(range)) = &list
            && range.len > WRITTEN_OUT
        {
            return self.counted(turns, range.start, range.step, range.len, span);
        }
        let Some(elements) = self.turns(&list, turns.list.span)? else {
            let message = format!("a loop runs over a range or a list, and this is {}", list.shown());
            return Err(self.mismatch(message, turns.list.span));
        };
        for element in elements {
            self.frame().slots[turns.slot as usize] = Some(element);
            match self.items(&turns.body)? {
                Flow::On => {}
                // A `return` of one written-out turn inside a branch does not end the others.
                Flow::Returned(value) => return Ok(Flow::Returned(value)),
            }
        }
        Ok(Flow::On)
    }

    /// A loop over a long range: start + i·step for i from 0.
    fn counted(&mut self, turns: &'c For, start: f64, step: f64, len: usize, span: Span) -> Compiled<Flow> {
        self.settle(&[&turns.body], span)?;
        let builder = self.at(span);
        let (zero, one, n) = (builder.constant(0.0), builder.constant(1.0), builder.constant(len as f64));
        let (start, step) = (builder.constant(start), builder.constant(step));
        let i = builder.variable(zero);
        let (again, end) = (builder.label(), builder.label());
        builder.bind(again);
        let more = builder.binary(Binary::Less, i, n);
        builder.jump_if_zero(more, end);
        let offset = builder.binary(Binary::Mul, i, step);
        let element = builder.binary(Binary::Add, start, offset);
        self.frame().slots[turns.slot as usize] = Some(Symbol::Number(element));
        self.branch(&turns.body)?;
        let builder = self.at(span);
        let next = builder.binary(Binary::Add, i, one);
        builder.assign(i, next);
        builder.jump(again);
        builder.bind(end);
        Ok(Flow::On)
    }

    fn while_item(&mut self, turns: &'c While, span: Span) -> Compiled<Flow> {
        self.settle(&[&turns.body], span)?;
        let (again, end) = (self.builder.label(), self.builder.label());
        self.builder.bind(again);
        match self.truth(&turns.condition)? {
            Truth::Known(false) => {
                self.builder.bind(end);
                return Ok(Flow::On);
            }
            Truth::Known(true) => {}
            Truth::Register(register) => self.at(turns.condition.span).jump_if_zero(register, end),
        }
        self.branch(&turns.body)?;
        self.at(span).jump(again);
        self.builder.bind(end);
        Ok(Flow::On)
    }
}

/// The local slots that items assign, also inside their branches and loops.
fn assigned(body: &Body, slots: &mut Vec<u32>) {
    for item in &body.items {
        match &item.kind {
            ItemKind::Assign(Access::Local(slot), _) => slots.push(*slot),
            ItemKind::If(choice) => {
                choice.arms.iter().for_each(|(_, body)| assigned(body, slots));
                choice.otherwise.iter().for_each(|body| assigned(body, slots));
            }
            ItemKind::For(turns) => assigned(&turns.body, slots),
            ItemKind::While(turns) => assigned(&turns.body, slots),
            ItemKind::Assign(..)
            | ItemKind::Property(_)
            | ItemKind::Block(_)
            | ItemKind::Place(_)
            | ItemKind::Bind(..)
            | ItemKind::Return(_)
            | ItemKind::Import(..)
            | ItemKind::Poison(_) => {}
        }
    }
}
