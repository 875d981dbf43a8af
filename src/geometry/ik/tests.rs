//! Inverse kinematics against closed forms, limits against their conditions, and random chains against themselves.

use super::problem::Problem;
use super::{Goal, Method, Settings, Solution, solve};
use crate::geometry::skeleton::{Freedom, Limits, Placement, Skeleton, Turning};
use crate::math::random::Random;
use glam::DVec3;

/// Hinges about z, one after the other along x; a tip at the end.
fn planar(lengths: &[f64], limits: &[Limits]) -> Skeleton {
    let mut arm = Skeleton::default();
    let (mut parent, mut offset) = (None, 0.0);
    for (k, length) in lengths.iter().enumerate() {
        let limit = limits.get(k).copied().unwrap_or(Limits::NONE);
        let hinge = Freedom::Hinge(DVec3::Z);
        parent = Some(arm.add_joint(&format!("j{k}"), parent, DVec3::X * offset, hinge, &[0.0], &[limit]));
        offset = *length;
    }
    arm.add_tip("hand", lengths.len() - 1, DVec3::X * offset);
    arm
}

fn goal(x: f64, y: f64) -> Goal {
    Goal { tip: 0, point: DVec3::new(x, y, 0.0), weight: 1.0, toward: None }
}

fn reach(arm: &Skeleton, start: &[f64], goals: &[Goal], method: Method) -> Solution {
    let settings = Settings { method, iterations: 2000, ..Settings::default() };
    let found = solve(arm, goals, start, &settings);
    assert!(found.largest_step <= 1.0 + 1e-12, "{method:?} makes a step of {}", found.largest_step);
    let within = arm.limits().iter().zip(&found.coordinates).all(|(limits, q)| limits.hold(*q));
    assert!(within, "{method:?} passes a limit: {:?}", found.coordinates);
    found
}

const UNREACHABLE: f64 = 1.041381265149110;

#[test]
fn a_target_out_of_reach_gets_the_nearest_pose_by_every_method() {
    let arm = planar(&[1.0, 1.0], &[]);
    for method in Method::ALL {
        for start in [[20.0, 20.0], [0.0, 0.0], [-120.0, 170.0], [0.0, 179.0]] {
            let found = reach(&arm, &start, &[goal(3.0, 0.5)], method);
            assert!(
                (found.residual - UNREACHABLE).abs() < 1e-6,
                "{method:?} from {start:?}: {}",
                found.residual
            );
            let end = Placement::new(&arm, &found.coordinates).tip(&arm, 0);
            assert!((end - DVec3::new(1.972788, 0.328798, 0.0)).length() < 1e-3, "{method:?}: {end}");
            assert!(!found.converged);
        }
    }
}

#[test]
fn what_is_out_of_reach_settles_and_does_not_swing() {
    let arm = planar(&[1.0, 1.0], &[]);
    for method in Method::ALL {
        let residual = |iterations: usize| {
            let settings = Settings { method, iterations, ..Settings::default() };
            solve(&arm, &[goal(3.0, 0.5)], &[20.0, 20.0], &settings).residual
        };
        let last: Vec<f64> = (350..400).map(residual).collect();
        let spread = last.iter().fold(0.0, |most: f64, r| most.max((r - last[49]).abs()));
        assert!(spread <= 1e-9, "{method:?}: {spread:e}");
    }
}

#[test]
fn a_straight_arm_bends_to_a_target_on_its_own_line() {
    for (lengths, x) in
        [(&[1.0, 1.0][..], 1.0), (&[1.0, 1.0], 0.5), (&[2.0, 1.0, 1.0], 1.0), (&[1.0, 1.0], -1.0)]
    {
        let arm = planar(lengths, &[]);
        for method in Method::ALL {
            let found = reach(&arm, &vec![0.0; lengths.len()], &[goal(x, 0.0)], method);
            assert!(found.residual <= 1e-9, "{method:?}, {lengths:?} to {x}: {}", found.residual);
        }
    }
    // An elbow that bends one way only, and stands at that limit.
    let elbow = [Limits::NONE, Limits { low: 0.0, high: 150.0 }];
    for limits in [elbow, [elbow[0], Limits { low: -150.0, high: 0.0 }]] {
        let found =
            reach(&planar(&[1.0, 1.0], &limits), &[0.0, 0.0], &[goal(1.0, 0.0)], Method::DampedLeastSquares);
        assert!(found.residual <= 1e-9, "{found:?}");
    }
}

#[test]
fn near_singular_starts_make_no_wild_step() {
    let arm = planar(&[1.0, 1.0], &[]);
    for method in Method::ALL {
        let found = reach(&arm, &[0.0, 1e-6f64.to_degrees()], &[goal(1.9, 0.0)], method);
        assert!(found.residual <= 1e-9, "{method:?}: {found:?}");
    }
}

#[test]
fn the_boundary_of_reach_is_reached() {
    let arm = planar(&[1.0, 1.0], &[]);
    for r in [2.0, 2.0 - 1e-9, 2.0 - 1e-6] {
        for start in [[30.0, 40.0], [0.0, 0.0], [100.0, -150.0]] {
            let settings = Settings { tolerance: 1e-12, ..Settings::default() };
            let found = solve(&arm, &[goal(0.6 * r, 0.8 * r)], &start, &settings);
            assert!(found.residual <= 1e-9, "{r} from {start:?}: {found:?}");
        }
    }
}

#[test]
fn the_closed_form_of_two_links_comes_out() {
    let arm = planar(&[1.0, 1.0], &[]);
    let settings = Settings { tolerance: 1e-14, ..Settings::default() };
    for (start, expected) in [([-20.0, 40.0], [0.0, 90.0]), ([110.0, -40.0], [90.0, -90.0])] {
        let found = solve(&arm, &[goal(1.0, 1.0)], &start, &settings);
        for (q, e) in found.coordinates.iter().zip(expected) {
            assert!((q - e).abs() < 1e-9, "{found:?}");
        }
    }
}

#[test]
fn limits_hold_exactly_and_the_rest_is_as_near_as_they_allow() {
    let limits =
        [Limits { low: -0.1, high: 30.0 }, Limits { low: 0.1, high: 40.7 }, Limits { low: -5.0, high: 5.0 }];
    let arm = planar(&[1.0, 0.8, 0.6], &limits);
    for (x, y) in [(-1.0, 0.5), (0.0, -2.0), (0.3, 0.3), (3.0, 3.0), (1.0, 1.9)] {
        let found = reach(&arm, &[10.0, 10.0, 0.0], &[goal(x, y)], Method::DampedLeastSquares);
        assert!(found.slope <= 1e-8, "({x}, {y}): {found:?}");
        assert!(!found.binding.is_empty(), "({x}, {y}): {found:?}");
        for &k in &found.binding {
            let q = found.coordinates[k];
            assert!(q == limits[k].low || q == limits[k].high, "({x}, {y}): {q}");
        }
        // No pose of a fine grid is nearer.
        let grid = |k: usize| {
            (0..=40).map(move |i| limits[k].low + (limits[k].high - limits[k].low) * f64::from(i) / 40.0)
        };
        let target = DVec3::new(x, y, 0.0);
        for a in grid(0) {
            for b in grid(1) {
                for c in grid(2) {
                    let distance = (Placement::new(&arm, &[a, b, c]).tip(&arm, 0) - target).length();
                    assert!(
                        distance >= found.residual - 1e-9,
                        "({x}, {y}): {distance} at {a}, {b}, {c}, {found:?}"
                    );
                }
            }
        }
    }
}

#[test]
fn a_fixed_limit_is_a_joint_that_does_not_move() {
    let arm = planar(&[1.0, 1.0], &[Limits { low: 12.5, high: 12.5 }]);
    let found = reach(&arm, &[0.0, 10.0], &[goal(0.0, 2.0)], Method::DampedLeastSquares);
    assert_eq!(found.coordinates[0], 12.5);
    assert!(found.slope < 1e-8);
}

/// A chain in space of joints of all freedoms; a tip in the middle and one at the end.
fn spatial(random: &mut Random, n: usize) -> Skeleton {
    let mut chain = Skeleton::default();
    let axis = |random: &mut Random| DVec3::from_array(std::array::from_fn(|_| random.between(-1.0, 1.0)));
    for k in 0..n {
        let (freedom, n_freedoms) = match k % 4 {
            0 => (Freedom::Ball, 3),
            1 => (Freedom::Hinge(axis(random)), 1),
            2 => (Freedom::Universal(axis(random), axis(random)), 2),
            _ => (Freedom::Slide(axis(random)), 1),
        };
        let limits: Vec<Limits> = (0..n_freedoms)
            .map(|_| match (k % 4, random.below(2)) {
                (3, _) => Limits { low: -0.3, high: 0.3 },
                (_, 0) => Limits { low: -random.between(10.0, 90.0), high: random.between(10.0, 90.0) },
                _ => Limits::NONE,
            })
            .collect();
        let offset = if k == 0 { DVec3::ZERO } else { axis(random) };
        let parent = k.checked_sub(1);
        chain.add_joint(&format!("j{k}"), parent, offset, freedom, &vec![0.0; n_freedoms], &limits);
    }
    chain.add_tip("end", n - 1, axis(random));
    chain.add_tip("middle", n / 2, axis(random));
    chain
}

fn within(random: &mut Random, chain: &Skeleton) -> Vec<f64> {
    let mut coordinates = vec![0.0; chain.rest().len()];
    for motion in chain.motions() {
        let most = if motion.turning == Turning::Turn { 180.0 } else { 0.3 };
        let Limits { low, high } = chain.limits()[motion.coordinate];
        coordinates[motion.coordinate] = random.between(low.max(-most), high.min(most));
    }
    coordinates
}

#[test]
fn derivatives_are_those_of_differences() {
    let mut random = Random::new(93);
    for case in 0..50 {
        let chain = spatial(&mut random, 6);
        let goals = [
            Goal { tip: 0, point: DVec3::new(1.0, 2.0, -0.5), weight: 2.0, toward: Some(DVec3::X) },
            Goal { tip: 1, point: DVec3::new(-1.0, 0.0, 0.5), weight: 0.3, toward: None },
        ];
        let at = within(&mut random, &chain);
        let problem = Problem::new(&chain, &goals, &at);
        let free = problem.state(at.clone());
        let hessian = problem.hessian(&free, &problem.derivatives(&free));
        let gradient = problem.gradient(&free);
        let shifted = |k: usize, by: f64| {
            let mut coordinates = at.clone();
            coordinates[problem.variables[k].coordinate] += by * problem.variables[k].unit;
            problem.state(coordinates)
        };
        let h = 1e-5;
        for k in 0..problem.variables.len() {
            let (up, down) = (shifted(k, h), shifted(k, -h));
            let slope = (up.sum - down.sum) / (2.0 * h);
            assert!((slope - gradient[k]).abs() < 1e-8, "case {case}: {slope} for {}", gradient[k]);
            let (up, down) = (problem.gradient(&up), problem.gradient(&down));
            for j in 0..problem.variables.len() {
                let curvature = (up[j] - down[j]) / (2.0 * h);
                assert!((curvature - hessian[(k, j)]).abs() < 1e-8, "case {case}, {k}, {j}: {curvature}");
            }
        }
    }
}

#[test]
fn chains_in_space_reach_what_they_can_reach() {
    let mut random = Random::new(94);
    let mut missed = 0;
    for case in 0..300 {
        let chain = spatial(&mut random, 5 + case % 4);
        let pose = within(&mut random, &chain);
        let placement = Placement::new(&chain, &pose);
        let toward = placement.frames[chain.tips()[0].joint].turn * chain.pointing(0);
        let goals = [
            Goal { tip: 0, point: placement.tip(&chain, 0), weight: 1.0, toward: Some(toward) },
            Goal { tip: 1, point: placement.tip(&chain, 1), weight: 3.0, toward: None },
        ];
        let n_goals = 1 + case % 2;
        let start = within(&mut random, &chain);
        let found = reach(&chain, &start, &goals[..n_goals], Method::DampedLeastSquares);
        assert!(found.converged || found.slope <= 1e-8, "case {case}: {found:?}");
        missed += usize::from(!found.converged);
    }
    assert_eq!(missed, 0, "of 300 stop short");
}

#[test]
fn a_warm_start_follows_a_moving_target_without_a_jump() {
    let limits = [
        Limits { low: -120.0, high: 120.0 },
        Limits { low: 0.0, high: 150.0 },
        Limits { low: -60.0, high: 60.0 },
    ];
    let arm = planar(&[5.0, 4.0, 2.0], &limits);
    let mut pose = vec![-45.0, 50.0, 30.0];
    let mut largest: f64 = 0.0;
    for frame in 0..=2000 {
        // In reach, then out of it, and back.
        let (s, c) = (f64::from(frame) * 0.003).sin_cos();
        let found = solve(&arm, &[goal(9.0 + 3.5 * c, 2.0 * s)], &pose, &Settings::default());
        let change = found.coordinates.iter().zip(&pose).map(|(a, b)| (a - b).abs());
        let change = change.fold(0.0, f64::max);
        if frame > 0 {
            largest = largest.max(change);
        }
        pose = found.coordinates;
    }
    // A chain leaves its stretched pose as the root of the distance: some degrees for a thousandth of its length.
    assert!(largest < 7.0, "{largest}° in a frame");
}

#[test]
fn nothing_depends_on_the_unit_of_length() {
    let small = planar(&[1.0, 0.7, 0.4], &[]);
    let large = planar(&[1e6, 0.7e6, 0.4e6], &[]);
    let near = solve(&small, &[goal(0.5, 1.0)], &[10.0, 20.0, 30.0], &Settings::default());
    let settings = Settings { tolerance: 1e-3, ..Settings::default() };
    let far = solve(&large, &[goal(0.5e6, 1e6)], &[10.0, 20.0, 30.0], &settings);
    assert!(far.converged && near.iterations == far.iterations);
    for (a, b) in near.coordinates.iter().zip(&far.coordinates) {
        assert!((a - b).abs() < 1e-6, "{near:?} {far:?}");
    }
}

#[test]
fn no_goal_and_no_freedom_leave_the_pose_alone() {
    let arm = planar(&[1.0, 1.0], &[]);
    let found = solve(&arm, &[], &[3.0, 4.0], &Settings::default());
    assert!(found.converged && found.coordinates == [3.0, 4.0] && found.iterations == 0);
    let mut post = Skeleton::default();
    post.add_joint("post", None, DVec3::ZERO, Freedom::Fixed, &[], &[]);
    post.add_tip("top", 0, DVec3::Y);
    for method in Method::ALL {
        let found = reach(&post, &[], &[goal(0.0, 2.0)], method);
        assert!(!found.converged && found.residual == 1.0, "{found:?}");
    }
}

#[test]
fn a_chain_of_twenty_joints_takes_a_few_dozen_steps_wherever_its_target_is() {
    let arm = planar(&[1.0; 20], &[]);
    let start: Vec<f64> = (0..20).map(|k| 10.0 + f64::from(k)).collect();
    for (x, y, least) in
        [(5.0, 5.0, 0.0), (10.0, -14.0, 0.0), (0.5, 0.0, 0.0), (20.0, 0.0, 0.0), (40.0, 9.0, 21.0)]
    {
        let found = reach(&arm, &start, &[goal(x, y)], Method::DampedLeastSquares);
        assert!((found.residual - least).abs() <= 1e-9, "({x}, {y}): {found:?}");
        assert!(found.iterations <= 60, "({x}, {y}): {}", found.iterations);
    }
}

/// Alternate axes leave the first link in a plane, so that no bound of lengths tells that 7 is the least. (By the planes: √(19.2² + 14.4² + 10²) − 19.)
#[test]
fn an_end_that_other_starts_come_to_again_is_believed() {
    let mut chain = Skeleton::default();
    let mut parent = None;
    for k in 0..20 {
        let hinge = Freedom::Hinge(if k % 2 == 0 { DVec3::Z } else { DVec3::Y });
        let offset = DVec3::X * f64::from(u8::from(k > 0));
        parent = Some(chain.add_joint("", parent, offset, hinge, &[0.0], &[Limits::NONE]));
    }
    chain.add_tip("", 19, DVec3::X);
    let goal = Goal { tip: 0, point: DVec3::new(20.0, 15.0, 10.0), weight: 1.0, toward: None };
    let found = reach(&chain, &[10.0; 20], &[goal], Method::DampedLeastSquares);
    assert!((found.residual - 7.0).abs() <= 1e-9, "{found:?}");
    assert!(found.iterations <= 100, "{}", found.iterations);
}
