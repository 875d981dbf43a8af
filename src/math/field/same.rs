//! When two tapes are the same: they run the same steps on the same numbers, by their bits, and blame the same sites. A curve that a tape
//! holds is the same as itself alone.

use super::{Field, Held};
use std::hash::{Hash, Hasher};
use std::sync::Arc;

impl Field {
    /// All its numbers, by their bits: what registers hold, and tables with their lengths.
    fn bits(&self) -> impl Iterator<Item = u64> {
        let lengths = self.tables.iter().map(|table| table.len() as u64);
        let numbers = self.initial.iter().chain(self.tables.iter().flatten());
        lengths.chain(numbers.map(|x| x.to_bits()))
    }

    fn held_at(&self) -> impl Iterator<Item = *const ()> {
        self.held.iter().map(|held: &Arc<dyn Held>| Arc::as_ptr(held).cast())
    }
}

impl PartialEq for Field {
    fn eq(&self, other: &Field) -> bool {
        let counts = |f: &Field| (f.n_inputs, f.turn_limit, f.initial.len(), f.tables.len());
        counts(self) == counts(other)
            && (&self.ops, &self.sites, &self.outputs) == (&other.ops, &other.sites, &other.outputs)
            && self.bits().eq(other.bits())
            && self.held_at().eq(other.held_at())
    }
}

impl Eq for Field {}

impl Hash for Field {
    fn hash<H: Hasher>(&self, state: &mut H) {
        self.ops.hash(state);
        self.bits().for_each(|bits| bits.hash(state));
    }
}
