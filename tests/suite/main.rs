//! Behaviour of the whole: one test binary, so that it links once. Each module is a topic.

// What the lints forbid in the library is right in tests, helpers of theirs included.
#![allow(clippy::unwrap_used, clippy::print_stdout)]

mod intersection;
mod layers;
mod meshes;
mod pictures;
mod radiometry;
mod stage;
mod textures;
