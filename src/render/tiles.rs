//! (tiles)
