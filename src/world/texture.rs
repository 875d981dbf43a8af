//! (texture)
