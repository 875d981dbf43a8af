//! Behaviour of the whole: one test binary, so that it links once. Each module is a topic.

mod intersection;
mod layers;
mod meshes;
mod pictures;
mod radiometry;
mod stage;
