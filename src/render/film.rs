//! (film)
