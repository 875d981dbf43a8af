//! What is known of a program while more of it comes: a file is all of one, the lines that a person types grow one.

use super::load::FileId;
use super::program::{Program, UnitId};
use super::scope::Declared;
use super::{Exports, Signature};
use std::collections::HashMap;

/// A program so far, and the names that further items see.
#[derive(Default)]
pub struct Known {
    /// What is resolved. Its first unit is that of the items that came last.
    pub program: Program,
    pub(super) signatures: Vec<Signature>,
    pub(super) units: HashMap<FileId, UnitId>,
    pub(super) exports: HashMap<UnitId, Exports>,
    /// Files whose names are visible by plain imports.
    pub(super) included: Vec<FileId>,
    pub(super) names: Names,
}

/// The names that are visible to what comes next, with what they mean.
#[derive(Clone, Default)]
pub struct Names(pub(super) Exports);

/// What a visible name is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sort {
    /// A value that stays: its global slot.
    Value(u32),
    /// A `var`: its global slot.
    Var(u32),
    /// A function: its global slot.
    Function(u32),
    /// A file that was imported with `as`.
    Module,
}

/// See [`Known::mark`].
#[derive(Clone, Copy, Debug)]
pub struct KnownMark {
    n_functions: usize,
    n_units: usize,
    n_globals: usize,
    n_included: usize,
}

impl Known {
    /// How much there is, to come back to.
    pub fn mark(&self) -> KnownMark {
        KnownMark {
            n_functions: self.program.functions.len(),
            n_units: self.program.units.len(),
            n_globals: self.program.globals.len(),
            n_included: self.included.len(),
        }
    }

    /// Forgets all that was resolved since the mark was taken, but for the names, which only [`Known::learn`] changes.
    pub fn forget_since(&mut self, mark: KnownMark) {
        self.program.functions.truncate(mark.n_functions);
        self.signatures.truncate(mark.n_functions);
        self.program.units.truncate(mark.n_units);
        self.program.globals.truncate(mark.n_globals);
        self.included.truncate(mark.n_included);
        self.units.retain(|_, unit| (unit.0 as usize) < mark.n_units);
        self.exports.retain(|unit, _| (unit.0 as usize) < mark.n_units);
    }

    /// Makes names visible to what comes next.
    pub fn learn(&mut self, names: Names) {
        self.names = names;
    }

    /// Every visible name in alphabetical order.
    pub fn names(&self) -> Vec<(&str, Sort)> {
        use super::program::Access;
        let sort = |access: Access, declared: Declared| match (declared, access) {
            (Declared::Module(_), _) => Some(Sort::Module),
            (Declared::Value, Access::Global(slot)) => Some(Sort::Value(slot)),
            (Declared::Var, Access::Global(slot)) => Some(Sort::Var(slot)),
            (Declared::Function(_), Access::Global(slot)) => Some(Sort::Function(slot)),
            _ => None,
        };
        let named = self.names.0.iter();
        let mut names: Vec<(&str, Sort)> = named
            .filter_map(|(name, (access, declared, _))| Some((&**name, sort(*access, *declared)?)))
            .collect();
        names.sort_by_key(|(name, _)| *name);
        names
    }

    /// What a module exports, in alphabetical order; none where the name is no module's.
    pub fn members_of(&self, module: &str) -> Option<Vec<&str>> {
        let (_, declared, _) = self.names.0.get(module)?;
        let Declared::Module(unit) = declared else { return None };
        let mut members: Vec<&str> = self.exports.get(unit)?.keys().map(|name| &**name).collect();
        members.push("scene");
        members.sort_unstable();
        Some(members)
    }
}
