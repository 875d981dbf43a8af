//! Names to slots.
