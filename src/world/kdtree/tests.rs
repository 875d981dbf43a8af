use super::build::most_planes;
use super::cell::Cell;
use super::{Node, Tree};
use crate::math::Aabb;
use crate::world::bvh::frame::Frame;
use crate::world::shape::triangle::cut::cut;
use glam::DVec3;

/// Two cells, x below 4 and above: item 0 in both, item 1 above alone.
fn two_cells() -> Tree {
    Tree {
        frame: Frame::default(),
        bounds: Aabb { min: DVec3::new(0.0, -1.0, -1.0), max: DVec3::new(10.0, 1.0, 1.0) },
        root: Cell { lower: [0.0, -1.0, -1.0], upper: [10.0, 1.0, 1.0] },
        unbounded: false,
        nodes: vec![Node::inner(0, 4.0, 2), Node::leaf(0, 1), Node::leaf(1, 2)],
        references: vec![0, 0, 1],
        order: vec![0, 1],
        bounded: 2,
    }
}

/// The nearest hit of a ray along x from −1, and how many items were asked, where each item is hit at an x.
fn nearest(tree: &Tree, hits: [f64; 2]) -> (f64, usize) {
    let (mut best, mut asked) = (f64::MAX, 0);
    tree.traverse(-DVec3::X, DVec3::X, f64::MAX, |range, _| {
        asked += range.len();
        best = tree.order()[range].iter().map(|&i| hits[i as usize] + 1.0).fold(best, f64::min);
        best
    });
    (best - 1.0, asked)
}

#[test]
fn a_hit_beyond_its_cell_does_not_hide_a_nearer_one_in_the_next() {
    assert_eq!(nearest(&two_cells(), [8.0, 6.0]), (6.0, 3));
    assert_eq!(nearest(&two_cells(), [6.0, 8.0]).0, 6.0);
}

#[test]
fn a_hit_within_its_cell_ends_the_search() {
    assert_eq!(nearest(&two_cells(), [3.0, 6.0]), (3.0, 1));
}

#[test]
fn hits_at_the_same_place_on_either_side_of_a_plane_are_both_offered() {
    assert_eq!(nearest(&two_cells(), [4.0, 4.0]), (4.0, 3));
}

/// Ten thousand needles of triangles with one corner in common.
fn fan(count: usize) -> Vec<[DVec3; 3]> {
    let rim = |i: usize| {
        let (s, c) = crate::math::elementary::sin_cos(i as f64 / count as f64 * std::f64::consts::TAU);
        DVec3::new(c, s, 0.2 * s * c)
    };
    (0..count).map(|i| [DVec3::ZERO, rim(i), rim(i + 1)]).collect()
}

#[test]
fn a_fan_of_ten_thousand_triangles_makes_a_tree_of_bounded_size() {
    let fan = fan(10_000);
    let tree = Tree::build_clipped(fan.len(), |i| Aabb::of(fan[i]), |i, cell| cut(fan[i], cell));
    let (nodes, references) = (tree.node_count(), tree.reference_count());
    assert!(references <= super::build::MOST_PIECES * fan.len(), "{references}");
    assert!(nodes <= 4 * fan.len(), "{nodes}");
    assert!(depth(&tree, 0) <= most_planes(fan.len()));
}

fn depth(tree: &Tree, at: usize) -> u32 {
    let node = tree.nodes[at];
    if node.is_leaf() { 0 } else { 1 + depth(tree, at + 1).max(depth(tree, node.upper())) }
}

#[test]
fn triangles_cut_to_their_cells_are_named_less_often_than_their_boxes() {
    let fan = fan(300);
    let boxes = Tree::build(fan.len(), |i| Aabb::of(fan[i]));
    let cut = Tree::build_clipped(fan.len(), |i| Aabb::of(fan[i]), |i, cell| cut(fan[i], cell));
    let tests = |tree: &Tree| {
        let mut tests = 0;
        for i in 0..400 {
            let at = DVec3::new(f64::from(i % 20) / 10.0 - 0.95, f64::from(i / 20) / 10.0 - 0.95, 1.0);
            tree.traverse(at, -DVec3::Z, f64::MAX, |range, t| {
                tests += range.len();
                t
            });
        }
        tests
    };
    assert!(tests(&cut) * 2 < tests(&boxes), "{} {}", tests(&cut), tests(&boxes));
}

#[test]
fn the_tree_is_the_same_on_any_number_of_threads() {
    let fan = fan(40_000);
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
        pool.install(|| Tree::build_clipped(fan.len(), |i| Aabb::of(fan[i]), |i, cell| cut(fan[i], cell)))
    };
    let (one, three) = (on(1), on(3));
    assert!(one.nodes == three.nodes && one.references == three.references && one.order == three.order);
}
