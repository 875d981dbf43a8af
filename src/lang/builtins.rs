//! The table of builtin functions and constants.
