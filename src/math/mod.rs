//! Numbers: boxes, affine maps, error bounds, polynomial roots, functions as tapes. Knows nothing of scenes.
//!
//! f64 throughout. The functions of [`elementary`] are the only transcendental ones the project calls, so that a scene
//! gives the same bits on every machine.

pub mod affine;
pub mod bernstein;
pub mod bounds;
pub mod bracket;
pub mod colour;
pub mod dd;
pub mod elementary;
pub mod error;
pub mod exact;
pub mod field;
pub mod hex;
pub mod interval;
pub mod isolate;
pub mod matrix;
pub mod noise;
pub mod point;
pub mod quadrature;
pub mod random;
pub mod solve;
pub mod vectors;

pub use affine::Affine;
pub use bounds::Aabb;
pub use dd::Dd;
pub use point::Point;
