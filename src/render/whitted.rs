//! (whitted)
