//! Names of files' joints, made fit for the language.

use std::collections::HashSet;

/// Names that are taken so far.
pub struct Names<'r> {
    taken: HashSet<String>,
    reserved: &'r dyn Fn(&str) -> bool,
}

impl<'r> Names<'r> {
    /// None yet; those that are `reserved` never.
    pub fn new(reserved: &'r dyn Fn(&str) -> bool) -> Names<'r> {
        Names { taken: HashSet::new(), reserved }
    }

    /// A name that the language can write and that is not there yet: what is no letter, digit or `_` becomes `_`; a name that is reserved,
    /// or there already, gets a `_` or a number behind it.
    pub fn fit(&mut self, written: &str) -> String {
        let fit = |c: char| if c.is_alphanumeric() || c == '_' { c } else { '_' };
        let mut name: String = written.chars().map(fit).collect();
        if name.is_empty() || name.starts_with(|c: char| c.is_numeric()) {
            name.insert(0, '_');
        }
        if (self.reserved)(&name) {
            name.push('_');
        }
        let numbered = (2..).map(|n| format!("{name}_{n}"));
        let free = std::iter::once(name.clone()).chain(numbered).find(|name| !self.taken.contains(name));
        let name = free.expect("there is always a next number");
        self.taken.insert(name.clone());
        name
    }
}
