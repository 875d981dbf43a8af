//! Functions that run while rendering: a flat tape of f64 operations over registers, made from a scene's function by the
//! language layer. The tape knows nothing of names or values of the language; it can be run by any number of threads.

/// A function of f64 inputs to f64 outputs.
#[derive(Clone, Debug, Default)]
pub struct Field {}
