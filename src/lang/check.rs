//! Checks of given properties against the table of kinds: arity, types, bounds, doubles, what is missing.
