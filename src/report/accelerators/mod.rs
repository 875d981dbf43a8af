//! Trees against one another on meshes: time to build, memory, rays a second, nodes and triangles a ray, wrong hits; and how all that grows
//! with the mesh and with the picture. Knows neither files nor how a mesh is read.
//!
//! All trees stand over the same triangles with the same test of each, so that they alone differ.

pub mod frames;
pub mod lines;
pub mod meshes;
pub mod page;
pub mod rays;
pub mod subject;

use crate::geometry::mesh::Mesh;
use frames::FrameRow;
use lines::{Set, anywhere, at_edges, camera, in_squares, sets};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use std::time::Instant;
use subject::{Builder, Line, Subject, Work};

/// How much is measured.
#[derive(Clone, Copy, Debug)]
pub struct Plan {
    /// Pixels along a side of the picture.
    pub side: usize,
    /// Rounds, of which the fastest counts: what else a machine does only adds to it.
    pub rounds: usize,
    /// Rays of each sort that are compared with all triangles; fewer where there are very many of those.
    pub checked: usize,
    /// Sizes of the meshes that show how cost grows, triangles.
    pub sizes: &'static [usize],
    /// Sides of the pictures that show it, pixels.
    pub sides: &'static [usize],
}

impl Plan {
    /// Within a minute.
    pub const QUICK: Plan =
        Plan { side: 64, rounds: 3, checked: 500, sizes: &[1_000, 10_000], sides: &[64, 128] };
    /// Some minutes.
    pub const USUAL: Plan = Plan {
        side: 256,
        rounds: 5,
        checked: 2000,
        sizes: &[1_000, 10_000, 100_000, 1_000_000],
        sides: &[250, 500, 1000],
    };
    /// For the record.
    pub const FULL: Plan = Plan {
        sizes: &[1_000, 10_000, 100_000, 1_000_000, 10_000_000],
        sides: &[1000, 1414, 2000, 2828, 4000],
        ..Plan::USUAL
    };

    /// So many tests of triangles at the most are spent on comparing.
    fn most_tests(&self) -> usize {
        self.checked * 400_000
    }
}

/// One sort of ray through one tree.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct RayRow {
    /// "camera", "together", "shadow" or "diffuse".
    pub name: String,
    /// How many.
    pub n: usize,
    /// Millions a second, on one thread, in the fastest round.
    pub mrays: f64,
    /// Nodes visited by a ray, on the mean.
    pub nodes: f64,
    /// Triangles tested by a ray, on the mean.
    pub tests: f64,
}

/// One tree over one mesh.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct AcceleratorRow {
    /// The mesh's name.
    pub mesh: String,
    /// What grows along rows of the same mesh: "" (nothing), "triangles" or "pixels".
    pub grows: String,
    /// What makes the tree.
    pub builder: String,
    /// How many triangles there are.
    pub triangles: usize,
    /// Pixels of the picture.
    pub pixels: usize,
    /// Seconds to build, on all threads.
    pub build: f64,
    /// Memory of nodes, of what is in the leaves, and of the mesh's own vertices and triangles, bytes.
    pub bytes: [usize; 3],
    /// How many nodes.
    pub nodes: usize,
    /// How often leaves name triangles.
    pub references: usize,
    /// By sort of ray.
    pub rays: Vec<RayRow>,
    /// Whole pictures of the mesh; of the tree that scenes use, where nothing grows.
    pub frames: Vec<FrameRow>,
    /// Rays compared with all triangles.
    pub checked: usize,
    /// Those that met something else, or were blocked otherwise.
    pub wrong: usize,
}

/// All trees over a mesh.
pub fn measure(name: &str, mesh: &Mesh, plan: &Plan) -> Vec<AcceleratorRow> {
    let made: Vec<(Subject<'_>, f64)> = Builder::TREES.iter().map(|builder| built(mesh, *builder)).collect();
    let mut sets = sets(mesh, &made[0].0, plan.side);
    sets.push(in_squares(&sets[0].lines, plan.side));
    let subjects: Vec<&Subject<'_>> = made.iter().map(|(subject, _)| subject).collect();
    let rays: Vec<Vec<RayRow>> = sets.iter().map(|set| of_set(set, &subjects, plan.rounds)).collect();
    let n = (plan.most_tests() / mesh.triangles.len().max(1)).clamp(20, plan.checked);
    let wrong = wrong(mesh, &subjects, [n, n]);
    let row = |(i, (subject, build)): (usize, &(Subject<'_>, f64))| AcceleratorRow {
        mesh: name.into(),
        builder: Builder::TREES[i].name().into(),
        build: *build,
        rays: rays.iter().map(|rows| rows[i].clone()).collect(),
        checked: 2 * n,
        wrong: wrong[i],
        ..about(mesh, subject, plan.side)
    };
    made.iter().enumerate().map(row).collect()
}

/// The trees over one mesh for pictures of several sizes; `hear` is told of each side before it is measured.
pub fn over_pixels(name: &str, mesh: &Mesh, plan: &Plan, mut hear: impl FnMut(usize)) -> Vec<AcceleratorRow> {
    let made: Vec<(Subject<'_>, f64)> = Builder::TREES.iter().map(|builder| built(mesh, *builder)).collect();
    let subjects: Vec<&Subject<'_>> = made.iter().map(|(subject, _)| subject).collect();
    let mut rows = Vec::new();
    for side in plan.sides {
        hear(*side);
        let set = Set::new("camera", camera(mesh, *side));
        let rays = of_set(&set, &subjects, plan.rounds);
        rows.extend(made.iter().zip(rays).zip(Builder::TREES).map(|(((subject, build), rays), builder)| {
            AcceleratorRow {
                mesh: name.into(),
                grows: "pixels".into(),
                builder: builder.name().into(),
                build: *build,
                rays: vec![rays],
                ..about(mesh, subject, *side)
            }
        }));
    }
    rows
}

fn about(mesh: &Mesh, subject: &Subject<'_>, side: usize) -> AcceleratorRow {
    let [nodes, leaves] = subject.bytes();
    let own = size_of_val(&*mesh.positions) + size_of_val(&*mesh.triangles);
    AcceleratorRow {
        triangles: mesh.triangles.len(),
        pixels: side * side,
        bytes: [nodes, leaves, own],
        nodes: subject.nodes(),
        references: subject.references(),
        ..AcceleratorRow::default()
    }
}

fn built(mesh: &Mesh, builder: Builder) -> (Subject<'_>, f64) {
    let started = Instant::now();
    let subject = Subject::new(mesh, builder);
    (subject, started.elapsed().as_secs_f64())
}

/// A set of rays that took so long is not asked again, in seconds: long rounds differ little.
const LONG: f64 = 10.0;
/// So many rays of a set are counted at the most, evenly chosen.
const MOST_COUNTED: usize = 1 << 18;

/// A row for each tree, timed in turn.
fn of_set(set: &Set, subjects: &[&Subject<'_>], rounds: usize) -> Vec<RayRow> {
    let n = set.lines.len();
    let mut seconds = vec![f64::INFINITY; subjects.len()];
    let begun = Instant::now();
    for round in 0..rounds.max(1) {
        if round > 0 && begun.elapsed().as_secs_f64() > LONG {
            break;
        }
        for (subject, best) in subjects.iter().zip(&mut seconds) {
            let started = Instant::now();
            std::hint::black_box(set.met(subject));
            *best = best.min(started.elapsed().as_secs_f64());
        }
    }
    let some = set.lines.iter().step_by(n.div_ceil(MOST_COUNTED).max(1));
    let counted = Set { lines: some.copied().collect(), ..*set };
    let row = |(subject, seconds): (&&Subject<'_>, &f64)| {
        let work = work(subject, &counted);
        let per_ray = |count: u64| count as f64 / counted.lines.len().max(1) as f64;
        RayRow {
            name: set.name.into(),
            n,
            mrays: n as f64 / seconds / 1e6,
            nodes: per_ray(work.nodes),
            tests: per_ray(work.tests),
        }
    };
    subjects.iter().zip(&seconds).map(row).collect()
}

/// What all rays of a set cost together.
pub fn work(subject: &Subject<'_>, set: &Set) -> Work {
    set.lines.iter().fold(Work::default(), |sum, line| {
        let own = subject.work(line, set.any);
        Work { nodes: sum.nodes + own.nodes, tests: sum.tests + own.tests }
    })
}

/// For each tree, how many of so many rays anywhere, and at edges and corners, meet something else than the list of all triangles does, or
/// are blocked otherwise.
pub fn wrong(mesh: &Mesh, subjects: &[&Subject<'_>], n: [usize; 2]) -> Vec<usize> {
    let lines: Vec<Line> = anywhere(mesh, n[0], 31).into_iter().chain(at_edges(mesh, n[1], 32)).collect();
    let list = Subject::new(mesh, Builder::List);
    let is_wrong = |line: &Line| {
        let truth = list.meet(line, false);
        let off = |subject: &&Subject<'_>| {
            usize::from(
                subject.meet(line, false) != truth || subject.meet(line, true).is_some() != truth.is_some(),
            )
        };
        subjects.iter().map(off).collect::<Vec<_>>()
    };
    let add = |a: Vec<usize>, b: Vec<usize>| a.iter().zip(b).map(|(a, b)| a + b).collect();
    lines.par_iter().map(is_wrong).reduce(|| vec![0; subjects.len()], add)
}
