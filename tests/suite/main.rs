//! Behaviour of the whole: one test binary, so that it links once. Each module is a topic.

mod command;
mod diagnostics;
mod intersection;
mod faults;
mod fuzz;
mod golden;
mod language;
mod layers;
mod meshes;
mod pictures;
mod radiometry;
mod run;
mod stage;
mod syntax;
mod textures;
