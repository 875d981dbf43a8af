//! What is the hierarchy's own; what every tree must do is in the tests of [`crate::world::tree`].

use super::{Pricing, Tree, clip};
use crate::math::Aabb;
use crate::math::exact::Double;
use crate::math::random::Random;
use crate::world::tree::tests::{small_boxes as boxes, vector};
use glam::DVec3;

/// The items that a tree offers to a ray, sorted.
fn offered(tree: &Tree, origin: DVec3, direction: DVec3, t_max: f64) -> Vec<u32> {
    let mut found = Vec::new();
    tree.traverse(&origin, &direction, t_max, |range, t| {
        found.extend_from_slice(&tree.order()[range]);
        t
    });
    found.sort_unstable();
    found
}

/// Whether a line meets a box, in twice the working precision; none where that cannot tell.
fn meets_exactly(b: &Aabb, origin: DVec3, d: DVec3) -> Option<bool> {
    // In units of 1/(d.x d.y d.z): where the line enters and leaves each slab, over the other two components.
    let bound = |a: usize, side: f64| {
        let others = Double::product(d[(a + 1) % 3].abs(), d[(a + 2) % 3].abs());
        Double::difference(side, origin[a]) * others * Double::new(d[a].signum())
    };
    let mut clear = true;
    for a in 0..3 {
        for c in 0..3 {
            let near = if d[a] > 0.0 { b.min[a] } else { b.max[a] };
            let far_c = if d[c] > 0.0 { b.max[c] } else { b.min[c] };
            let room = (bound(c, far_c) - bound(a, near)).value();
            let size = bound(c, far_c).value().abs() + bound(a, near).value().abs();
            if room < -1e-25 * size {
                return Some(false);
            }
            clear &= room > 1e-25 * size || a == c;
        }
    }
    clear.then_some(true)
}

#[test]
fn no_ray_at_the_edge_of_a_box_is_lost_to_rounding() {
    let mut random = Random::new(12);
    let (mut met, mut lost) = (0, 0);
    for offset in [DVec3::ZERO, DVec3::new(148_376.0, 1234.0, -223_423.0)] {
        for b in boxes(200, offset, 14) {
            let tree = Tree::build(1, |_| b);
            for i in 0..100 {
                // A point of an edge: two coordinates at a side, one between.
                let corner = b.corners()[i % 8];
                let mut aim = corner;
                aim[i % 3] = b.min[i % 3] + (b.max[i % 3] - b.min[i % 3]) * random.unit();
                let origin = offset + vector(&mut random) * 20.0;
                let d = (aim - origin).normalize();
                if meets_exactly(&b, origin, d) == Some(true) {
                    met += 1;
                    lost += u32::from(clip(&b, origin, d, f64::MAX).is_none());
                    lost += u32::from(offered(&tree, origin, d, f64::MAX).is_empty());
                }
            }
        }
    }
    assert!(met > 10_000, "{met} rays meet their box");
    assert_eq!(lost, 0, "of {met}");
}

#[test]
fn a_hit_in_the_first_box_does_not_hide_a_nearer_one_in_the_second() {
    let slab = |from: f64, to: f64| Aabb { min: DVec3::new(from, -1.0, -1.0), max: DVec3::new(to, 1.0, 1.0) };
    let boxes = [slab(1.0, 6.0), slab(2.0, 4.0), slab(7.0, 8.0)];
    let hits = [5.0, 3.0, 7.5];
    let tree = Tree::build(3, |i| boxes[i]);
    let mut best = f64::MAX;
    tree.traverse(&DVec3::ZERO, &DVec3::X, f64::MAX, |range, _| {
        for &i in &tree.order()[range] {
            best = best.min(hits[i as usize]);
        }
        best
    });
    assert_eq!(best, 3.0);
}

#[test]
fn the_tree_is_the_same_on_any_number_of_threads() {
    let boxes = boxes(40_000, DVec3::ZERO, 9);
    let bounds = |i: usize| boxes[i];
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
        let made = || [Tree::build(boxes.len(), bounds), Tree::build_bottom_up(boxes.len(), bounds)];
        pool.install(made).map(|tree| (tree.order().to_vec(), format!("{:?}", tree.nodes)))
    };
    assert!(on(1) == on(3));
}

#[test]
fn leaves_of_triangles_begin_at_multiples_of_what_is_tested_together() {
    let boxes = boxes(5000, DVec3::ZERO, 3);
    for tree in [
        Tree::build_of_triangles(boxes.len(), |i| boxes[i]),
        Tree::build_bottom_up(boxes.len(), |i| boxes[i]),
    ] {
        let mut named = Vec::new();
        for node in &tree.nodes {
            for items in node.children.iter().filter_map(|child| child.items()) {
                let first = items.start;
                assert_eq!(first % Pricing::OF_TRIANGLES.at_once, 0, "a leaf begins at {first}");
                named.extend_from_slice(&tree.order()[items]);
            }
        }
        named.sort_unstable();
        assert!(named.into_iter().eq(0..boxes.len() as u32), "every item is in one leaf");
    }
}

#[test]
fn items_that_are_tested_together_cost_full_steps() {
    let by = |pricing: Pricing| [0.0, 1.0, 3.0, 4.0, 5.0, 8.0, 9.0, 1e6 + 1.0].map(|n| pricing.tests(n));
    assert_eq!(by(Pricing::OF_TRIANGLES), [0.0, 4.0, 4.0, 4.0, 8.0, 8.0, 12.0, 1e6 + 4.0]);
    assert_eq!(by(Pricing::OF_ITEMS), [0.0, 1.0, 3.0, 4.0, 5.0, 8.0, 9.0, 1e6 + 1.0]);
}

#[test]
fn areas_guide_the_splits() {
    let mut random = Random::new(4);
    let mut boxes = Vec::new();
    for i in 0..1024 {
        let size = if i < 960 { 1.0 } else { 100.0 };
        let at = vector(&mut random) * size;
        boxes.push(Aabb { min: at, max: at + DVec3::splat(0.01 * size) });
    }
    let tree = Tree::build(boxes.len(), |i| boxes[i]);
    let mut total = 0;
    for _ in 0..500 {
        let (from, to) = (vector(&mut random) * 200.0, vector(&mut random) * 100.0);
        total += offered(&tree, from, (to - from).normalize(), 1e9).len();
    }
    assert!(total < 500 * 8, "{total} boxes for 500 rays");
}
