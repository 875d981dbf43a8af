//! Taking back what a run has changed: values of names, files that ran, and variables that closures share.
//!
//! Everything else that a run makes is new, and goes when nothing holds it. Only cells that outlive a run need a journal:
//! those that a closure of an earlier run captured. Knows nothing of programs.

use super::Standing;
use super::slots::Slot;
use std::cell::RefCell;
use std::collections::HashMap;
use std::rc::Rc;

/// What there was when a run began.
#[derive(Default)]
pub(super) struct Undo {
    globals: Vec<Slot>,
    units_done: Vec<bool>,
    /// Shared variables that were assigned since, each with what it held first.
    cells: HashMap<*const RefCell<Slot>, (Rc<RefCell<Slot>>, Slot)>,
}

impl Standing {
    /// Remembers what there is, until [`Standing::keep`] or [`Standing::take_back`].
    pub fn begin(&mut self) {
        self.undo = Some(Undo {
            globals: self.globals.clone(),
            units_done: self.units_done.clone(),
            cells: HashMap::new(),
        });
    }

    /// Lets all changes stand.
    pub fn keep(&mut self) {
        self.undo = None;
    }

    /// Takes back every change since [`Standing::begin`].
    pub fn take_back(&mut self) {
        let Some(undo) = self.undo.take() else { return };
        self.globals = undo.globals;
        self.units_done = undo.units_done;
        for (cell, before) in undo.cells.into_values() {
            *cell.borrow_mut() = before;
        }
    }

    /// Gives a shared variable another value.
    pub(super) fn assign_shared(&mut self, cell: &Rc<RefCell<Slot>>, value: Slot) {
        let before = cell.replace(value);
        if let Some(undo) = &mut self.undo {
            undo.cells.entry(Rc::as_ptr(cell)).or_insert_with(|| (cell.clone(), before));
        }
    }
}
