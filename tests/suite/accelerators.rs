//! Every tree against a test of every triangle, and the work that trees leave to a ray against a table. `OGEE_BLESS=1` writes the table;
//! `OGEE_RAYS=1000000` asks so many rays of each mesh, and a tenth as many at its edges.

use crate::run::Folder;
use ogee::diag::{SourceId, Span};
use ogee::geometry::mesh::Mesh;
use ogee::report::accelerators::lines::{Set, anywhere, at_edges, sets};
use ogee::report::accelerators::meshes::{KINDS, procedural};
use ogee::report::accelerators::subject::{Builder, Line, Subject};
use ogee::report::accelerators::{work, wrong};
use ogee::scene::assets::{AssetCache, DiskLoader};
use ogee::scene::{Accelerator, MeshSource, Node, Object, Shape};
use ogee::world::{Ray, RayKind, World, WorldOptions};
use rayon::prelude::*;
use std::fmt::Write;
use std::path::Path;
use std::sync::Arc;

/// Triangles of each kind of mesh.
const TRIANGLES: usize = 240;

fn rays() -> usize {
    std::env::var("OGEE_RAYS").ok().and_then(|n| n.parse().ok()).unwrap_or(100_000)
}

fn check(name: &str, mesh: &Mesh, n: usize) {
    let subjects = Builder::TREES.map(|builder| Subject::new(mesh, builder));
    let found = wrong(mesh, &subjects.each_ref(), [n, n.div_ceil(10)]);
    for (builder, wrong) in Builder::TREES.iter().zip(found) {
        assert_eq!(wrong, 0, "{name}, {}: of {n} rays and a tenth at edges", builder.name());
    }
}

#[test]
fn no_tree_meets_anything_else_than_a_test_of_every_triangle() {
    for kind in KINDS {
        check(kind, &procedural(kind, TRIANGLES).expect("a kind"), rays());
    }
}

#[test]
fn no_tree_meets_anything_else_on_real_models() {
    let Some(data) = std::env::var_os("OGEE_DATA") else {
        println!("skipped without OGEE_DATA");
        return;
    };
    for file in ["spot/spot_triangulated.obj", "teapot-mcguire/teapot.obj", "bunny/stanford-bunny.obj"] {
        let path = Path::new(&data).join("meshes").join(file);
        let loader = DiskLoader;
        let loaded =
            AssetCache::new(&loader).mesh(&path, None, Span::new(SourceId(0), 0, 0)).expect("a mesh");
        check(file, &loaded.mesh, rays() * 6000 / loaded.mesh.triangles.len());
    }
}

fn world_of(mesh: &Mesh, accelerator: Accelerator) -> World {
    let span = Span::new(SourceId(0), 0, 0);
    let object = Object::new(Shape::Mesh(Arc::new(MeshSource::Inline(mesh.clone()))), span);
    let options = WorldOptions { accelerator, ..WorldOptions::default() };
    World::new(vec![Node::Object(Arc::new(object))], &options, &DiskLoader).0
}

#[test]
fn a_world_meets_by_each_accelerator_what_it_meets_without() {
    for kind in KINDS {
        let mesh = procedural(kind, TRIANGLES).expect("a kind");
        let list = world_of(&mesh, Accelerator::None);
        let trees = [Accelerator::Bvh, Accelerator::KdTree].map(|tree| (tree, world_of(&mesh, tree)));
        let n = rays() / 10;
        let lines: Vec<Line> = anywhere(&mesh, n, 5).into_iter().chain(at_edges(&mesh, n / 10, 6)).collect();
        lines.par_iter().for_each(|line| {
            let Line { origin, direction, t_max } = *line;
            let ray = Ray { origin, direction, t_max, kind: RayKind::Camera };
            let met = |world: &World| world.closest(&ray).map(|hit| (hit.t.to_bits(), hit.primitive));
            let truth = met(&list);
            for (tree, world) in &trees {
                assert_eq!(met(world), truth, "{kind}, {tree:?}: {ray:?}");
                assert_eq!(world.occluded(&ray), truth.is_some(), "{kind}, {tree:?}: {ray:?}");
            }
        });
    }
}

/// Nodes and tests of every tree on fixed rays, each on a line by its name.
fn table() -> Vec<(String, [u64; 2])> {
    let mut rows = Vec::new();
    for kind in KINDS {
        let mesh = procedural(kind, 5000).expect("a kind");
        let subjects = Builder::TREES.map(|builder| Subject::new(&mesh, builder));
        for set in sets(&mesh, &subjects[0], 40) {
            for (builder, subject) in Builder::TREES.iter().zip(&subjects) {
                rows.push(row(kind, *builder, &set, subject));
            }
        }
    }
    rows
}

fn row(kind: &str, builder: Builder, set: &Set, subject: &Subject<'_>) -> (String, [u64; 2]) {
    let work = work(subject, set);
    (format!("{kind}, {}, {} {} rays", builder.name(), set.lines.len(), set.name), [work.nodes, work.tests])
}

/// The count is off by more than 2 % and one.
fn is_off(now: u64, then: u64) -> bool {
    now.abs_diff(then) > then / 50 + 1
}

#[test]
fn rays_cost_the_nodes_and_tests_of_the_table() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/accelerators.txt");
    let now = table();
    if std::env::var_os("OGEE_BLESS").is_some() {
        let mut text = String::new();
        for (name, [nodes, tests]) in &now {
            let _ = writeln!(text, "{name}: {nodes} nodes, {tests} tests");
        }
        std::fs::write(&path, text).expect("tests/ can be written");
    }
    let text = std::fs::read_to_string(&path).unwrap_or_default();
    let then: Vec<(&str, Vec<u64>)> = text
        .lines()
        .filter_map(|line| line.split_once(": "))
        .map(|(name, counts)| (name, counts.split(' ').filter_map(|word| word.parse().ok()).collect()))
        .collect();
    assert_eq!(
        now.iter().map(|(name, _)| &**name).collect::<Vec<_>>(),
        then.iter().map(|(name, _)| *name).collect::<Vec<_>>(),
        "tests/accelerators.txt is old: run `OGEE_BLESS=1 cargo test accelerators`"
    );
    let off: Vec<String> = now
        .iter()
        .zip(&then)
        .filter(|((_, now), (_, then))| then.len() != 2 || is_off(now[0], then[0]) || is_off(now[1], then[1]))
        .map(|((name, now), (_, then))| format!("{name}: nodes and tests {now:?}, were {then:?}"))
        .collect();
    assert!(off.is_empty(), "more than 2 % off:\n{}", off.join("\n"));
}

#[test]
fn rays_in_files_are_asked_answered_and_judged_order_by_order() {
    let folder = Folder::with(&[(
        "mesh.obj",
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 0 1 1\nf 1 2 3\nf 4 5 6\n",
    )]);
    let write = |name: &str, words: &[u32]| {
        let bytes: Vec<u8> = words.iter().flat_map(|word| word.to_le_bytes()).collect();
        std::fs::write(folder.path().join(name), bytes).expect("a file");
    };
    // Up through both triangles, and past them.
    let rays = [[0.2, 0.2, -1.0, 0.0, 0.0, 2.0, 9.0], [0.8, 0.8, -1.0, 0.0, 0.0, 2.0, 9.0f32]];
    write("two.rays", &rays.concat().iter().map(|number| number.to_bits()).collect::<Vec<_>>());
    write("other", &[1, u32::MAX, 0, 0]);
    let asked_by = |how: &str| {
        let orders =
            format!("build\n{how} two.rays 0 99\nanswers two.rays ours-{how}\njudge two.rays other 9\n");
        folder.ogee_fed("bench rays mesh.obj", &orders)
    };
    assert_eq!(asked_by("together").code, Some(0));
    let run = asked_by("closest");
    let said: Vec<String> = String::from_utf8_lossy(&run.stdout).lines().map(str::to_owned).collect();
    assert!(
        said.len() == 4 && said[0].parse::<usize>().is_ok_and(|bytes| bytes > 0),
        "{said:?} {}",
        run.stderr
    );
    assert_eq!(said[1..], ["done", "done", "0 0 1 1 1 0"]);
    let ours = std::fs::read(folder.path().join("ours-closest")).expect("the answers");
    assert_eq!(folder.read("ours-together"), ours);
    let words: Vec<u32> = ours.as_chunks::<4>().0.iter().map(|bytes| u32::from_le_bytes(*bytes)).collect();
    assert_eq!(words, [0, u32::MAX, 0.5f32.to_bits(), f32::INFINITY.to_bits()]);
    assert_eq!(folder.ogee_fed("bench rays mesh.obj", "sing\n").code, Some(2));
    assert_eq!(folder.ogee("bench rays mesh.obj --tree oak").code, Some(2));
}
