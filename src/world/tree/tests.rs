//! What every tree must do, for each of them.

use super::Tree;
use crate::math::Aabb;
use crate::math::exact::power_of_two;
use crate::math::random::Random;
use crate::scene::Accelerator;
use crate::world::bvh::clip;
use glam::DVec3;

const ALL: [Accelerator; 3] = [Accelerator::Bvh, Accelerator::KdTree, Accelerator::None];

pub(in crate::world) fn vector(random: &mut Random) -> DVec3 {
    DVec3::from_array(std::array::from_fn(|_| random.between(-1.0, 1.0)))
}

/// So many boxes about a place, by a seed.
type Make = fn(usize, DVec3, u64) -> Vec<Aabb>;

/// A few are large, so that they straddle.
fn boxes(count: usize, offset: DVec3, seed: u64) -> Vec<Aabb> {
    boxes_of(count, offset, seed, |i| if i % 20 == 0 { 6.0 } else { 0.3 })
}

/// None is large.
pub(in crate::world) fn small_boxes(count: usize, offset: DVec3, seed: u64) -> Vec<Aabb> {
    boxes_of(count, offset, seed, |_| 0.3)
}

fn boxes_of(count: usize, offset: DVec3, seed: u64, size: impl Fn(usize) -> f64) -> Vec<Aabb> {
    let mut random = Random::new(seed);
    (0..count)
        .map(|i| {
            let at = offset + vector(&mut random) * 10.0;
            Aabb { min: at, max: at + vector(&mut random).abs() * size(i) }
        })
        .collect()
}

/// The items that a tree offers to a ray, sorted: the same in either order.
fn offered(tree: &Tree, origin: DVec3, direction: DVec3, t_max: f64) -> Vec<u32> {
    let (mut found, mut in_no_order) = (Vec::new(), Vec::new());
    tree.traverse(&origin, &direction, t_max, |range, t| {
        found.extend_from_slice(&tree.order()[range]);
        t
    });
    tree.traverse_any(&origin, &direction, t_max, |range| {
        in_no_order.extend_from_slice(&tree.order()[range]);
        true
    });
    found.sort_unstable();
    in_no_order.sort_unstable();
    assert_eq!(in_no_order, found, "{origin} {direction}");
    found
}

#[test]
fn every_box_that_a_ray_meets_is_offered() {
    let offsets = [DVec3::ZERO, DVec3::new(148_376.0, 1234.0, -223_423.0), DVec3::splat(1e9)];
    for (offset, boxes) in
        offsets.into_iter().flat_map(|o| [boxes, small_boxes].map(|make| (o, make(3000, o, 5))))
    {
        for accelerator in ALL {
            let tree = Tree::build(accelerator, boxes.len(), |i| boxes[i]);
            let mut random = Random::new(77);
            for i in 0..400 {
                let origin = offset + vector(&mut random) * 15.0;
                let mut direction = vector(&mut random).normalize();
                if i % 3 == 0 {
                    direction = DVec3::AXES[i % 9 / 3] * direction.x.signum();
                }
                let origin = if i % 2 == 0 { origin } else { origin - direction * 1e6 };
                let met = (0..boxes.len() as u32)
                    .filter(|&b| clip(&boxes[b as usize], origin, direction, 1e300).is_some());
                let offered = offered(&tree, origin, direction, 1e300);
                for b in met {
                    assert!(
                        offered.binary_search(&b).is_ok(),
                        "{accelerator:?} offset {offset} ray {i} box {b}"
                    );
                }
            }
        }
    }
}

#[test]
fn all_that_a_ray_may_meet_is_offered_once() {
    let boxes = boxes(2000, DVec3::ZERO, 6);
    for accelerator in ALL {
        let tree = Tree::build(accelerator, boxes.len(), |i| boxes[i]);
        let mut random = Random::new(9);
        for _ in 0..50 {
            let (origin, direction) = (vector(&mut random) * 15.0, vector(&mut random).normalize());
            let mut all = Vec::new();
            tree.traverse_all(origin, direction, |range| {
                all.extend_from_slice(&tree.order()[range]);
                true
            });
            all.sort_unstable();
            let mut once = offered(&tree, origin, direction, f64::MAX);
            once.dedup();
            assert_eq!(all, once, "{accelerator:?}");
        }
    }
}

#[test]
fn few_boxes_are_opened_also_far_from_the_origin() {
    let cases: [(Accelerator, Make, usize); 3] = [
        (Accelerator::Bvh, small_boxes, 100),
        (Accelerator::Bvh, boxes, 400),
        (Accelerator::KdTree, boxes, 400),
    ];
    for offset in [DVec3::ZERO, DVec3::splat(1e9)] {
        for (accelerator, make, most) in cases {
            let boxes = make(20_000, offset, 6);
            let tree = Tree::build(accelerator, boxes.len(), |i| boxes[i]);
            let mut random = Random::new(78);
            let mut total = 0;
            for _ in 0..200 {
                let origin = offset + vector(&mut random) * 15.0;
                total += offered(&tree, origin, vector(&mut random).normalize(), 1e300).len();
            }
            assert!(total / 200 < most, "{accelerator:?}: {} boxes a ray", total / 200);
        }
    }
}

#[test]
fn a_tree_in_a_plane_or_on_a_line_is_a_tree() {
    let mut random = Random::new(3);
    for spread in [DVec3::new(1.0, 1.0, 0.0), DVec3::X] {
        let boxes: Vec<Aabb> = (0..2000)
            .map(|_| vector(&mut random) * spread)
            .map(|at| Aabb { min: at, max: at + spread * 1e-3 })
            .collect();
        for accelerator in [Accelerator::Bvh, Accelerator::KdTree] {
            let tree = Tree::build(accelerator, boxes.len(), |i| boxes[i]);
            let total: usize = (0..100)
                .map(|i| offered(&tree, boxes[i].center() + DVec3::Z, -DVec3::Z, f64::MAX).len())
                .sum();
            assert!((100..100 * 20).contains(&total), "{accelerator:?} {spread}: {total}");
        }
    }
}

#[test]
fn rays_whose_numbers_overflow_end() {
    let tiny: Vec<Aabb> = boxes(300, DVec3::ZERO, 8)
        .iter()
        .map(|b| Aabb { min: b.min * 1e-300, max: b.max * 1e-300 })
        .collect();
    for accelerator in ALL {
        // A kd-tree names what straddles in several cells.
        let most = if accelerator == Accelerator::KdTree { 32 * tiny.len() } else { tiny.len() };
        let tree = Tree::build(accelerator, tiny.len(), |i| tiny[i]);
        for (origin, direction) in [
            (DVec3::X * 1e300, -DVec3::X),
            (DVec3::splat(1e200), -DVec3::ONE),
            (DVec3::ZERO, DVec3::new(f64::NAN, 1.0, 0.0)),
            (DVec3::NAN, DVec3::X),
            (DVec3::splat(f64::INFINITY), -DVec3::ONE),
        ] {
            let mut n_offered = 0;
            tree.traverse(&origin, &direction, f64::MAX, |range, t| {
                n_offered += range.len();
                assert!(n_offered <= most, "{accelerator:?} {origin} {direction}: it goes on");
                t
            });
            let mut n_offered = 0;
            tree.traverse_any(&origin, &direction, f64::MAX, |range| {
                n_offered += range.len();
                assert!(n_offered <= most, "{accelerator:?} {origin} {direction}: it goes on");
                true
            });
        }
    }
}

#[test]
fn empty_infinite_and_broken_boxes_neither_stop_the_builder_nor_hide_the_rest() {
    let mut boxes = boxes(100, DVec3::ZERO, 8);
    boxes[3] = Aabb::EMPTY;
    boxes[4] = Aabb { min: DVec3::NEG_INFINITY, max: DVec3::INFINITY };
    boxes[5] = Aabb { min: DVec3::NAN, max: DVec3::NAN };
    boxes[6] = Aabb { min: DVec3::splat(-1e308), max: DVec3::splat(1e308) };
    boxes[7] = Aabb { min: DVec3::ZERO, max: DVec3::ZERO };
    for accelerator in [Accelerator::Bvh, Accelerator::KdTree] {
        let tree = Tree::build(accelerator, 100, |i| boxes[i]);
        assert!(tree.is_unbounded());
        assert_eq!(tree.order().len(), 99, "{accelerator:?}");
        let offered = offered(&tree, DVec3::new(-1.0, 0.0, 0.0), DVec3::X, f64::MAX);
        assert!(
            [4, 5, 6, 7].iter().all(|i| offered.contains(i)) && !offered.contains(&3),
            "{accelerator:?}: {offered:?}"
        );
        assert!(Tree::build(accelerator, 0, |_| Aabb::EMPTY).order().is_empty());
        assert!(Tree::build(accelerator, 9, |_| Aabb::EMPTY).bounds().is_empty());
    }
}

#[test]
fn equal_boxes_and_needles_make_no_deep_tree() {
    let same = Aabb { min: DVec3::ZERO, max: DVec3::ONE };
    let needle = |i: usize| {
        let size = power_of_two(-(i as i32 % 1000));
        Aabb { min: DVec3::ZERO, max: DVec3::new(size, size, 1.0) }
    };
    for accelerator in [Accelerator::Bvh, Accelerator::KdTree] {
        let tree = Tree::build(accelerator, 20_000, |_| same);
        assert_eq!(offered(&tree, DVec3::new(-1.0, 0.5, 0.5), DVec3::X, 1e9).len(), 20_000);
        let tree = Tree::build(accelerator, 20_000, needle);
        let mut all = offered(&tree, DVec3::new(0.0, 0.0, -1.0), DVec3::Z, 1e9);
        if accelerator == Accelerator::KdTree {
            all.dedup();
        }
        assert_eq!(all.len(), 20_000);
        assert!(tree.node_count() < 100_000, "{accelerator:?}: {}", tree.node_count());
    }
}
