//! Shapes as numbers, without spans: meshes, bases, curves and what is measured on them, patches, surfaces along curves,
//! skeletons, skins.

pub mod any_curve;
pub mod arc_length;
pub mod balls;
pub mod basis;
pub mod boxes;
pub mod closest;
pub mod curve;
pub mod frame;
pub mod function;
pub mod ik;
pub mod measured;
pub mod mesh;
mod nearest_first;
pub mod patch;
pub mod path;
pub mod skeleton;
pub mod skin;
pub mod surface;
