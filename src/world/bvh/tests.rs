use super::{Tree, clip};
use crate::math::Aabb;
use crate::math::exact::Double;
use glam::DVec3;

/// Numbers in 0 … 1 by splitmix64.
fn random(state: &mut u64) -> f64 {
    *state = state.wrapping_add(0x9E37_79B9_7F4A_7C15);
    let mut z = *state;
    z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
}

fn vector(state: &mut u64) -> DVec3 {
    DVec3::new(random(state), random(state), random(state)) * 2.0 - 1.0
}

fn boxes(count: usize, offset: DVec3, seed: u64) -> Vec<Aabb> {
    let mut state = seed;
    (0..count)
        .map(|_| {
            let at = offset + vector(&mut state) * 10.0;
            Aabb { min: at, max: at + vector(&mut state).abs() * 0.3 }
        })
        .collect()
}

/// The items that a tree offers to a ray, sorted.
fn offered(tree: &Tree, origin: DVec3, direction: DVec3, t_max: f64) -> Vec<u32> {
    let mut found = Vec::new();
    tree.traverse(origin, direction, t_max, |range, t| {
        found.extend_from_slice(&tree.order()[range]);
        t
    });
    found.sort_unstable();
    found
}

#[test]
fn every_box_that_a_ray_meets_is_offered() {
    for (k, offset) in
        [DVec3::ZERO, DVec3::new(148_376.0, 1234.0, -223_423.0), DVec3::splat(1e9)].into_iter().enumerate()
    {
        let boxes = boxes(3000, offset, 5);
        let tree = Tree::build(boxes.len(), |i| boxes[i]);
        let mut state = 77;
        for i in 0..400 {
            let origin = offset + vector(&mut state) * 15.0;
            let mut direction = vector(&mut state).normalize();
            if i % 3 == 0 {
                direction = DVec3::AXES[i % 9 / 3] * direction.x.signum();
            }
            let origin = if i % 2 == 0 { origin } else { origin - direction * 1e6 };
            let met = (0..boxes.len() as u32)
                .filter(|&b| clip(&boxes[b as usize], origin, direction, 1e300).is_some());
            let offered = offered(&tree, origin, direction, 1e300);
            for b in met {
                assert!(offered.binary_search(&b).is_ok(), "offset {k} ray {i} box {b}");
            }
        }
    }
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
    let mut state = 12;
    let (mut met, mut lost) = (0, 0);
    for offset in [DVec3::ZERO, DVec3::new(148_376.0, 1234.0, -223_423.0)] {
        for b in boxes(200, offset, 14) {
            let tree = Tree::build(1, |_| b);
            for i in 0..100 {
                // A point of an edge: two coordinates at a side, one between.
                let corner = b.corners()[i % 8];
                let mut aim = corner;
                aim[i % 3] = b.min[i % 3] + (b.max[i % 3] - b.min[i % 3]) * random(&mut state);
                let origin = offset + vector(&mut state) * 20.0;
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
fn few_boxes_are_opened_also_far_from_the_origin() {
    for offset in [DVec3::ZERO, DVec3::splat(1e9)] {
        let boxes = boxes(20_000, offset, 6);
        let tree = Tree::build(boxes.len(), |i| boxes[i]);
        let mut state = 78;
        let mut total = 0;
        for _ in 0..200 {
            let origin = offset + vector(&mut state) * 15.0;
            total += offered(&tree, origin, vector(&mut state).normalize(), 1e300).len();
        }
        assert!(total / 200 < 100, "{} boxes a ray", total / 200);
    }
}

#[test]
fn a_hit_in_the_first_box_does_not_hide_a_nearer_one_in_the_second() {
    let slab = |from: f64, to: f64| Aabb { min: DVec3::new(from, -1.0, -1.0), max: DVec3::new(to, 1.0, 1.0) };
    let boxes = [slab(1.0, 6.0), slab(2.0, 4.0), slab(7.0, 8.0)];
    let hits = [5.0, 3.0, 7.5];
    let tree = Tree::build(3, |i| boxes[i]);
    let mut best = f64::MAX;
    tree.traverse(DVec3::ZERO, DVec3::X, f64::MAX, |range, _| {
        for &i in &tree.order()[range] {
            best = best.min(hits[i as usize]);
        }
        best
    });
    assert_eq!(best, 3.0);
}

#[test]
fn rays_whose_numbers_overflow_end() {
    let tiny: Vec<Aabb> = boxes(300, DVec3::ZERO, 8)
        .iter()
        .map(|b| Aabb { min: b.min * 1e-300, max: b.max * 1e-300 })
        .collect();
    let tree = Tree::build(tiny.len(), |i| tiny[i]);
    for (origin, direction) in [
        (DVec3::X * 1e300, -DVec3::X),
        (DVec3::splat(1e200), -DVec3::ONE),
        (DVec3::ZERO, DVec3::new(f64::NAN, 1.0, 0.0)),
        (DVec3::NAN, DVec3::X),
        (DVec3::splat(f64::INFINITY), -DVec3::ONE),
    ] {
        let mut n_offered = 0;
        tree.traverse(origin, direction, f64::MAX, |range, t| {
            n_offered += range.len();
            assert!(n_offered <= tiny.len(), "{origin} {direction}: some are offered again");
            t
        });
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
    let tree = Tree::build(100, |i| boxes[i]);
    assert!(tree.is_unbounded());
    let offered = offered(&tree, DVec3::new(-1.0, 0.0, 0.0), DVec3::X, f64::MAX);
    assert!([4, 5, 6, 7].iter().all(|i| offered.contains(i)) && !offered.contains(&3), "{offered:?}");
    assert!(Tree::build(0, |_| Aabb::EMPTY).order().is_empty());
    assert!(Tree::build(9, |_| Aabb::EMPTY).bounds().is_empty());
}

#[test]
fn equal_boxes_and_needles_make_no_deep_tree() {
    let same = Aabb { min: DVec3::ZERO, max: DVec3::ONE };
    let tree = Tree::build(20_000, |_| same);
    assert_eq!(offered(&tree, DVec3::new(-1.0, 0.5, 0.5), DVec3::X, 1e9).len(), 20_000);
    let needle = |i: usize| {
        let size = crate::math::exact::power_of_two(-(i as i32 % 1000));
        Aabb { min: DVec3::ZERO, max: DVec3::new(size, size, 1.0) }
    };
    let tree = Tree::build(20_000, needle);
    assert_eq!(offered(&tree, DVec3::new(0.0, 0.0, -1.0), DVec3::Z, 1e9).len(), 20_000);
}

#[test]
fn the_tree_is_the_same_on_any_number_of_threads() {
    let boxes = boxes(40_000, DVec3::ZERO, 9);
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
        let tree = pool.install(|| Tree::build(boxes.len(), |i| boxes[i]));
        (tree.order().to_vec(), format!("{:?}", tree.nodes))
    };
    assert!(on(1) == on(3));
}

#[test]
fn areas_guide_the_splits() {
    let mut state = 4;
    let mut boxes = Vec::new();
    for i in 0..1024 {
        let size = if i < 960 { 1.0 } else { 100.0 };
        let at = vector(&mut state) * size;
        boxes.push(Aabb { min: at, max: at + DVec3::splat(0.01 * size) });
    }
    let tree = Tree::build(boxes.len(), |i| boxes[i]);
    let mut total = 0;
    for _ in 0..500 {
        let (from, to) = (vector(&mut state) * 200.0, vector(&mut state) * 100.0);
        total += offered(&tree, from, (to - from).normalize(), 1e9).len();
    }
    assert!(total < 500 * 8, "{total} boxes for 500 rays");
}
