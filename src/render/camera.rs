//! (camera)
