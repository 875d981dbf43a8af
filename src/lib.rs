//! Ogee: a scene-description language and its renderer.
//!
//! ```text
//! text ──syntax──▶ ast::File ──lang──▶ Scene ──world──▶ World ──render──▶ Film ──▶ image
//! ```
//!
//! Every stage is a pure function that returns a value plus [`diag::Diagnostic`]s. The tree, from the ground up:
//!
//! | module | what it is | may use |
//! |---|---|---|
//! | [`diag`] | spans, sources, diagnostics and the table of their codes | – |
//! | [`math`] | boxes, transforms, polynomial roots, error bounds, functions as tapes | – |
//! | [`syntax`] | text to AST and back | diag |
//! | [`geometry`] | meshes, curves, surfaces: kernels without spans | math |
//! | [`scene`] | what a scene is once evaluated: plain data with spans; reading of assets | geometry, math, diag |
//! | [`lang`] | names, values, evaluation, the table of kinds and of functions | scene, geometry, math, syntax, diag |
//! | [`world`] | what rays see: shapes, trees, lights, BSDFs | scene, geometry, math, diag |
//! | [`render`] | cameras, samplers, tracers, films, pictures on disk | world, scene, math, diag |
//! | [`plot`] | figures: curves in a frame, as characters, SVG or pixels | math |
//! | [`report`] | kernels measured: speed against error | render, world, scene, geometry, math, diag |
//! | [`session`] | the one door for the command line, the tests, the REPL | all of them |
//!
//! A test holds these directions against every `use crate::` of the tree.

// Tests compare with closed forms; the platform's last bits do not matter there.
#![cfg_attr(
    test,
    allow(clippy::disallowed_methods, clippy::excessive_precision, clippy::cloned_ref_to_slice_refs)
)]

pub mod diag;
pub mod geometry;
pub mod lang;
pub mod math;
pub mod plot;
pub mod render;
pub mod report;
pub mod scene;
pub mod session;
pub mod syntax;
pub mod world;
