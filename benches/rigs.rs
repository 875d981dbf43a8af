//! Skins and skeletons by criterion: a million vertices of four bones each, and a chain of twenty joints that reaches. `cargo bench --bench rigs`.
//!
//! A moved vertex reads and writes its place (48 bytes) and its normal (48), and reads four joints and weights (40) and where they end
//! (4): 140 bytes, 92 without a normal. Over what `copy` says the memory moves in a second, that is the roofline. All on one core.

use criterion::{BatchSize, Criterion, Throughput, criterion_group, criterion_main};
use glam::DVec3;
use ogee::geometry::ik::{Goal, Settings, solve};
use ogee::geometry::mesh::Mesh;
use ogee::geometry::skeleton::{Freedom, Limits, Placement, Skeleton};
use ogee::geometry::skin::{Blend, Influences, Motion, deform};
use std::hint::black_box;

const VERTICES: usize = 1_000_000;
const JOINTS: usize = 20;

/// A chain of links of length 1 along x, with a tip at its end.
fn chain() -> Skeleton {
    let mut chain = Skeleton::default();
    let mut parent = None;
    for k in 0..JOINTS {
        let offset = DVec3::X * f64::from(u8::from(k > 0));
        let hinge = Freedom::Hinge(if k % 2 == 0 { DVec3::Z } else { DVec3::Y });
        parent = Some(chain.add_joint("", parent, offset, hinge, &[0.0], &[Limits::NONE]));
    }
    chain.add_tip("", JOINTS - 1, DVec3::X);
    chain
}

fn motions() -> Vec<Motion> {
    let chain = chain();
    let (rest, bent) = ([0.0; JOINTS], [15.0; JOINTS]);
    let [rest, bent] = [rest, bent].map(|angles| Placement::new(&chain, &angles).frames);
    rest.iter().zip(&bent).map(|(rest, bent)| Motion::new(&rest.affine(), &bent.affine())).collect()
}

/// Points around the chain, in an order that does not follow it, each moved by four neighbouring joints.
fn surface(normals: bool) -> (Mesh, Influences) {
    let part = |k: usize, c: f64| (k as f64 * c).fract();
    let mut rows = Influences::default();
    let mut mesh = Mesh::default();
    for k in 0..VERTICES {
        let along = part(k, 0.618_034) * JOINTS as f64;
        mesh.positions.push(DVec3::new(along, part(k, 0.414_214) - 0.5, part(k, 0.732_051) - 0.5));
        let first = (along as usize).min(JOINTS - 4) as u16;
        rows.push([0.1, 0.4, 0.3, 0.2].into_iter().enumerate().map(|(j, w)| (first + j as u16, w)))
            .expect("all weights are above 0");
    }
    mesh.normals = if normals { vec![DVec3::new(0.6, 0.0, 0.8); VERTICES] } else { Vec::new() };
    (mesh, rows)
}

fn skins(c: &mut Criterion) {
    let one_core = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a thread can be started");
    let motions = motions();
    let mut group = c.benchmark_group("skin a million vertices of four bones");
    group.throughput(Throughput::Elements(VERTICES as u64)).sample_size(20);
    for (what, normals) in [("", false), (" and normals", true)] {
        let (mesh, rows) = surface(normals);
        for (name, blend) in [("linear", Blend::Linear), ("dual quaternions", Blend::DualQuaternion)] {
            group.bench_function(format!("{name}, points{what}"), |b| {
                let run = |mesh: &mut Mesh| one_core.install(|| deform(mesh, &rows, &motions, blend));
                b.iter_batched_ref(|| mesh.clone(), run, BatchSize::PerIteration);
            });
        }
    }
    group.finish();
}

fn memory(c: &mut Criterion) {
    let from = vec![1.0f64; 1 << 24];
    let mut to = vec![0.0f64; from.len()];
    let mut group = c.benchmark_group("memory");
    group.throughput(Throughput::Bytes(2 * size_of_val(from.as_slice()) as u64));
    group.bench_function("copy", |b| b.iter(|| black_box(&mut to).copy_from_slice(black_box(&from))));
    group.finish();
}

fn reaching(c: &mut Criterion) {
    let chain = chain();
    let start = [10.0; JOINTS];
    let mut group = c.benchmark_group("reach with twenty joints");
    for (name, point) in [
        ("near", DVec3::new(3.0, 6.0, -4.0)),
        ("far", DVec3::new(12.0, -14.0, 5.0)),
        ("too far", DVec3::new(20.0, 15.0, 10.0)),
    ] {
        let goal = [Goal { tip: 0, point, weight: 1.0, toward: None }];
        let settings = Settings::default();
        group.bench_function(name, |b| b.iter(|| solve(&chain, black_box(&goal), &start, &settings)));
    }
    group.finish();
}

criterion_group!(rigs, memory, skins, reaching);
criterion_main!(rigs);
