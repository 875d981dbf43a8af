//! Guards against scenes that would never end or need more than the machine has.

use super::Evaluator;
use crate::diag::{Code, Diagnostic, Span};
use crate::lang::display;
use crate::lang::limits::{Limits, exceeded};
use crate::lang::table::{Context, Outcome, Reported};
use crate::lang::value::{Value, memory};
use std::sync::atomic::Ordering;

/// What is left of each guard.
pub(super) struct Guards {
    turns: u64,
    /// Whether the scene has been told that it took all of them.
    out_of_turns: bool,
    /// Whether calls are being left because they nest too deeply.
    leaving: bool,
    /// Bytes of objects and texts made so far, estimated; lists are counted while they live.
    bytes: u64,
    /// The address below which the stack may not grow.
    floor: usize,
}

/// How often a run looks whether it is asked to end: some microseconds apart.
const TURNS_BETWEEN_LOOKS: u64 = 1 << 10;

/// Stack that is kept free below the deepest call for what one call may nest: per level of brackets.
const STACK_PER_LEVEL: usize = 8 << 10;

impl Guards {
    pub(super) fn new(limits: &Limits, stack: usize) -> Guards {
        let reserve = (limits.nesting.saturating_mul(STACK_PER_LEVEL)).clamp(256 << 10, stack / 2);
        Guards {
            turns: limits.turns,
            out_of_turns: false,
            leaving: false,
            bytes: 0,
            floor: here().saturating_sub(stack - reserve),
        }
    }
}

/// About where the stack has grown to.
#[inline(never)]
fn here() -> usize {
    let mark = 0u8;
    std::ptr::from_ref(&mark).addr()
}

impl Evaluator<'_> {
    /// Counts a turn of a loop.
    #[inline]
    pub(super) fn turn(&mut self, span: Span) -> Outcome<()> {
        if self.turn_at_once() { Ok(()) } else { self.turns(1, span) }
    }

    /// The same; false, and not counted, where something is to be said or looked at.
    #[inline]
    fn turn_at_once(&mut self) -> bool {
        match self.guards.turns.checked_sub(1) {
            Some(left) if left % TURNS_BETWEEN_LOOKS != 0 => {
                self.guards.turns = left;
                true
            }
            _ => false,
        }
    }

    /// Where somebody asks for an end, no turn is left to any loop or call.
    fn heed_cancel(&mut self) {
        if self.run.cancel.is_some_and(|asked| asked.load(Ordering::Relaxed)) {
            self.guards.turns = 0;
        }
    }

    /// Counts work that is no loop of the scene's own: each element that a function of lists goes through is a turn.
    pub(super) fn turns(&mut self, elements: usize, span: Span) -> Outcome<()> {
        match self.guards.turns.checked_sub(elements as u64) {
            Some(left) => {
                self.guards.turns = left;
                self.heed_cancel();
                Ok(())
            }
            None => Err(self.too_many_turns(span)),
        }
    }

    /// Said once: after it, everything that takes turns fails.
    #[cold]
    fn too_many_turns(&mut self, span: Span) -> Reported {
        self.guards.turns = 0;
        if std::mem::replace(&mut self.guards.out_of_turns, true) {
            return Reported;
        }
        let limit = self.run.limits.turns;
        let message = format!("loops and calls have taken {limit} turns");
        self.fail(exceeded(Code::LoopLimit, span, message, "turns", limit).label("still running here"))
    }

    /// Counts a call and its depth. Once calls nest too deeply, all fail until the outermost is left: a function that calls
    /// itself twice would else go down its other branch at each level on the way back.
    #[inline]
    pub(super) fn deeper(&mut self, span: Span) -> Outcome<()> {
        if self.guards.leaving {
            self.guards.leaving = !self.calls.is_empty();
            if self.guards.leaving {
                return Err(Reported);
            }
        }
        if self.calls.len() >= self.run.limits.calls {
            return Err(self.too_deep(span));
        }
        if self.calls.len() & 15 == 0 && here() < self.guards.floor {
            return Err(self.out_of_stack(span));
        }
        self.turn(span)
    }

    /// Counts a call that itself calls nothing; false, and not counted, where something is to be said or looked at.
    #[inline]
    pub(super) fn deeper_at_once(&mut self) -> bool {
        let is_shallow = !self.guards.leaving && self.calls.len() < self.run.limits.calls;
        is_shallow && self.turn_at_once()
    }

    #[cold]
    fn too_deep(&mut self, span: Span) -> Reported {
        self.guards.leaving = true;
        let limit = self.run.limits.calls as u64;
        let message = format!("calls are nested {limit} deep");
        self.fail(
            exceeded(Code::CallDepth, span, message, "calls", limit)
                .label("calls itself again")
                .hint("does the recursion come to an end?"),
        )
    }

    #[cold]
    fn out_of_stack(&mut self, span: Span) -> Reported {
        self.guards.leaving = true;
        let depth = self.calls.len();
        let message = format!("calls are nested {depth} deep, and the stack ends");
        self.fail(
            Diagnostic::new(Code::CallDepth, span, message)
                .hint("nest fewer blocks and choices inside the function that calls itself, or use a loop"),
        )
    }

    /// Counts bytes of objects or texts.
    #[inline]
    pub(super) fn spend(&mut self, bytes: u64, span: Span) -> Outcome<()> {
        self.guards.bytes += bytes;
        self.check_memory(0, span)
    }

    fn check_memory(&mut self, more: u64, span: Span) -> Outcome<()> {
        let lists = (memory::elements() * size_of::<Value>()) as u64;
        if self.guards.bytes.saturating_add(lists).saturating_add(more) > self.run.limits.memory {
            return Err(self.out_of_memory(span));
        }
        Ok(())
    }

    #[cold]
    fn out_of_memory(&mut self, span: Span) -> Reported {
        let limit = self.run.limits.memory;
        let message = format!("the scene's values and objects need more than {} MiB", limit >> 20);
        self.fail(exceeded(Code::MemoryLimit, span, message, "memory", limit).label("more is asked for here"))
    }

    #[cold]
    pub(super) fn list_too_long(&mut self, elements: usize, span: Span) -> Reported {
        let limit = self.run.limits.list as u64;
        let message = format!("a list grows to {elements} elements");
        self.fail(exceeded(Code::ListLimit, span, message, "list", limit))
    }

    /// Counts what a value is written of, before it is written.
    pub(super) fn check_shown(&mut self, value: &Value, span: Span) -> Outcome<()> {
        let Value::List(_) = value else { return Ok(()) };
        let pieces = display::pieces(value);
        self.reserve_text(pieces.saturating_mul(size_of::<Value>()), span)?;
        self.turns(pieces, span)
    }

    /// Counts a text of so many bytes that is about to be made: it may take as much as the longest list.
    pub(super) fn reserve_text(&mut self, bytes: usize, span: Span) -> Outcome<()> {
        let elements = bytes / size_of::<Value>();
        let limit = self.run.limits.list;
        if elements > limit {
            let message =
                format!("a text grows to about {bytes} bytes, as much as a list of {elements} elements");
            return Err(self.fail(exceeded(Code::ListLimit, span, message, "list", limit as u64)));
        }
        self.check_memory(bytes as u64, span)
    }

    /// Counts the elements of a list that is about to be made, or to grow to this length.
    pub(super) fn reserve_list(&mut self, elements: usize, span: Span) -> Outcome<()> {
        if elements > self.run.limits.list {
            return Err(self.list_too_long(elements, span));
        }
        self.check_memory(elements.saturating_mul(size_of::<Value>()) as u64, span)
    }
}
