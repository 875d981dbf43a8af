//! Shapes as numbers, without spans: meshes, bases, curves; patches and skeletons to come.

pub mod basis;
pub mod curve;
pub mod mesh;
