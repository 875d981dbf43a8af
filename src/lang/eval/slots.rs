//! Where values are kept while a program runs, and what closures take along.

use crate::lang::resolve::program::FunctionId;
use crate::lang::value::{Value, bury, is_container};
use std::cell::RefCell;
use std::rc::Rc;

/// A place for a value.
#[derive(Clone, Debug, Default)]
pub enum Slot {
    /// Nothing yet.
    #[default]
    Unset,
    /// The value failed, and that was reported.
    Poison,
    /// A value.
    Value(Value),
    /// A variable that closures share; never one inside another.
    Shared(Rc<RefCell<Slot>>),
}

impl Slot {
    /// The slot as a variable that closures share.
    pub fn share(&mut self) -> Slot {
        if let Slot::Shared(cell) = self {
            return Slot::Shared(cell.clone());
        }
        let cell = Rc::new(RefCell::new(std::mem::take(self)));
        *self = Slot::Shared(cell.clone());
        Slot::Shared(cell)
    }

    /// The value, or why there is none.
    pub fn read(&self) -> Result<Value, Empty> {
        match self {
            Slot::Value(value) => Ok(value.clone()),
            Slot::Unset => Err(Empty::Unset),
            Slot::Poison => Err(Empty::Poison),
            Slot::Shared(cell) => cell.borrow().read(),
        }
    }

    /// Gives a declared name its first value: a variable that a closure already shares stays shared.
    pub fn declare(&mut self, value: Slot) {
        match self {
            Slot::Shared(cell) if matches!(*cell.borrow(), Slot::Unset) => *cell.borrow_mut() = value,
            _ => *self = value,
        }
    }

    /// Gives a `var` another value.
    pub fn assign(&mut self, value: Slot) {
        match self {
            Slot::Shared(cell) => *cell.borrow_mut() = value,
            _ => *self = value,
        }
    }
}

/// Why a slot has no value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Empty {
    /// Its item did not run yet.
    Unset,
    /// Its value failed.
    Poison,
}

/// What closures took along from where they were made.
#[derive(Debug, Default)]
pub struct Captured(Vec<Slot>);

impl From<Vec<Slot>> for Captured {
    fn from(slots: Vec<Slot>) -> Self {
        Captured(slots)
    }
}

impl std::ops::Deref for Captured {
    type Target = [Slot];
    fn deref(&self) -> &[Slot] {
        &self.0
    }
}

impl Drop for Captured {
    fn drop(&mut self) {
        let nested = |slot: &Slot| matches!(slot, Slot::Value(value) if is_container(value));
        if self.0.iter().any(nested) {
            let value = |slot| if let Slot::Value(value) = slot { Some(value) } else { None };
            bury(std::mem::take(&mut self.0).into_iter().filter_map(value).collect());
        }
    }
}

/// A function value with what it captured.
#[derive(Clone, Debug)]
pub struct Closure {
    /// Its declaration.
    pub function: FunctionId,
    /// What it captured; none for functions that see only top-level names.
    pub captured: Option<Rc<Captured>>,
}
