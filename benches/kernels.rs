//! Kernels by criterion: the parser, the evaluator, building trees and casting rays. `cargo bench`.
//! Absolute times are of one machine; compare runs on one machine only, or take ratios.

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use glam::DVec3;
use ogee::scene::assets::DiskLoader;
use ogee::session::Session;
use ogee::syntax::build::{ParseLimits, parse_file};
use ogee::world::{Ray, RayKind, World, WorldOptions};
use std::fmt::Write;
use std::hint::black_box;

/// Literal spheres on low-discrepancy points, a line each.
fn flat_scene(n: usize) -> String {
    let mut text = String::new();
    for i in 1..=n {
        let [x, y, z] =
            [0.754_877_666, 0.569_840_291, 0.430_159_709].map(|c| (i as f64 * c).fract() * 20.0 - 10.0);
        let _ = writeln!(
            text,
            "sphere {{ center <{x:.6}, {y:.6}, {z:.6}>  radius 0.05  material {{ diffuse <0.8, 0.4, 0.3> }} }}"
        );
    }
    text
}

fn parser(c: &mut Criterion) {
    let text = flat_scene(5000);
    let mut group = c.benchmark_group("parse");
    group.throughput(Throughput::Bytes(text.len() as u64));
    group.bench_function("5,000 literal spheres", |b| {
        b.iter(|| parse_file(ogee::diag::SourceId(0), black_box(&text), ParseLimits::default()));
    });
    group.finish();
}

fn evaluator(c: &mut Criterion) {
    let mut group = c.benchmark_group("evaluate");
    let scenes = [
        (
            "100,000 turns of arithmetic",
            "var s = 0\nfor i in 1..=100000 { s = s + sin(i * 0.001) * 0.5 + sqrt(i) / (i + 1) }",
        ),
        ("100,000 calls", "fn acc(a, b) = a * 0.5 + b\nvar s = 0\nfor i in 1..=100000 { s = acc(s, i) }"),
        (
            "10,000 spheres",
            "for i in 0..10000 { sphere { center <i, 0, 0>  radius 0.5  material { diffuse <0.1, 0.2, 0.3> } } }",
        ),
    ];
    for (name, text) in scenes {
        group.bench_function(name, |b| {
            b.iter(|| Session::default().evaluate_text("bench.scene", black_box(text)))
        });
    }
    group.finish();
}

/// A world of `n` spheres in a cube, and rays from outside toward points in it.
fn world_and_rays(n: usize) -> (World, Vec<Ray>) {
    let evaluated = Session::default().evaluate_text("bench.scene", &flat_scene(n));
    let (world, _) = World::new(evaluated.scene.nodes, &WorldOptions::default(), &DiskLoader);
    let rays = (0..4096u32).map(|i| {
        let part = |c: f64| (f64::from(i) * c).fract() * 20.0 - 10.0;
        let origin = DVec3::new(part(0.618_034), part(0.414_214), 28.0);
        let target = DVec3::new(part(0.732_051), part(0.236_068), 0.0);
        Ray { origin, direction: (target - origin).normalize(), t_max: f64::INFINITY, kind: RayKind::Camera }
    });
    (world, rays.collect())
}

fn rays(c: &mut Criterion) {
    let (world, rays) = world_and_rays(100_000);
    let mut group = c.benchmark_group("rays");
    group.throughput(Throughput::Elements(rays.len() as u64));
    group.bench_function("closest of 100,000 spheres", |b| {
        b.iter(|| rays.iter().filter(|ray| world.closest(black_box(ray)).is_some()).count());
    });
    group.bench_function("occluded by 100,000 spheres", |b| {
        b.iter(|| rays.iter().filter(|ray| world.occluded(black_box(ray))).count());
    });
    group.finish();
}

fn trees(c: &mut Criterion) {
    let text = flat_scene(20_000);
    let scene = Session::default().evaluate_text("bench.scene", &text).scene;
    c.bench_function("build a world of 20,000 spheres", |b| {
        b.iter(|| World::new(black_box(scene.nodes.clone()), &WorldOptions::default(), &DiskLoader));
    });
}

criterion_group! {
    name = kernels;
    config = Criterion::default().sample_size(20);
    targets = parser, evaluator, rays, trees
}
criterion_main!(kernels);
