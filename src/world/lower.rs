//! (lower)
