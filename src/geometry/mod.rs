//! Shapes as numbers, without spans: meshes now; curves, patches and skeletons to come.

pub mod mesh;
