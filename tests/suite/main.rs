//! Behaviour of the whole: one test binary, so that it links once. Each module is a topic.

#![allow(clippy::disallowed_methods, clippy::unwrap_used, clippy::print_stdout, clippy::print_stderr)]

mod accelerators;
mod agreement;
mod animation;
mod balls;
mod command;
mod denoise;
mod diagnostics;
mod endless;
mod explain;
mod fuzz;
mod golden;
mod intersection;
mod irradiance;
mod language;
mod layers;
mod meshes;
mod models;
mod outlines;
mod packets;
mod paths;
mod photons;
mod pictures;
mod planted;
mod radiometry;
mod repl;
mod report;
mod run;
mod skeletons;
mod slips;
mod stage;
mod surfaces;
mod syntax;
mod tables;
mod textures;
