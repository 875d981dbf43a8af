//! Functions of the scene to tapes.
