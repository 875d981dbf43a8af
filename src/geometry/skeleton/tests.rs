//! Skeletons against closed forms, and Jacobians against dual numbers.

use super::forward::Placement;
use super::jacobian::{Rows, of_tip};
use super::{Freedom, Limits, Skeleton, Turning};
use crate::math::Affine;
use crate::math::matrix::singular;
use crate::math::random::Random;
use glam::DVec3;

/// a + a′·ε with ε² = 0.
#[derive(Clone, Copy, Debug, Default)]
struct Dual(f64, f64);

impl std::ops::Add for Dual {
    type Output = Dual;
    fn add(self, b: Dual) -> Dual {
        Dual(self.0 + b.0, self.1 + b.1)
    }
}

impl std::ops::Mul for Dual {
    type Output = Dual;
    fn mul(self, b: Dual) -> Dual {
        Dual(self.0 * b.0, self.0 * b.1 + self.1 * b.0)
    }
}

/// The rows of a 3 × 4 matrix.
type Rigid = [[Dual; 4]; 3];

fn compose(a: &Rigid, b: &Rigid) -> Rigid {
    let mut product = [[Dual::default(); 4]; 3];
    for i in 0..3 {
        for j in 0..4 {
            let sum = (0..3).fold(Dual::default(), |sum, k| sum + a[i][k] * b[k][j]);
            product[i][j] = if j == 3 { sum + a[i][3] } else { sum };
        }
    }
    product
}

fn constant(linear: impl Fn(usize, usize) -> Dual, offset: [Dual; 3]) -> Rigid {
    std::array::from_fn(|i| std::array::from_fn(|j| if j == 3 { offset[i] } else { linear(i, j) }))
}

/// One motion by a dual amount, in radians.
fn motion(turning: Turning, axis: DVec3, amount: Dual) -> Rigid {
    let identity = |i, j| Dual(f64::from(u8::from(i == j)), 0.0);
    match turning {
        Turning::Move => constant(identity, axis.to_array().map(|a| Dual(a, 0.0) * amount)),
        Turning::Turn => {
            let (s, c) = amount.0.sin_cos();
            let (sine, cosine) = (Dual(s, c * amount.1), Dual(c, -s * amount.1));
            let rest = Dual(1.0, 0.0) + cosine * Dual(-1.0, 0.0);
            let cross = [[0.0, -axis.z, axis.y], [axis.z, 0.0, -axis.x], [-axis.y, axis.x, 0.0]];
            let linear = |i: usize, j: usize| {
                identity(i, j) * cosine + Dual(cross[i][j], 0.0) * sine + Dual(axis[i] * axis[j], 0.0) * rest
            };
            constant(linear, [Dual::default(); 3])
        }
    }
}

/// The tip's rigid map where coordinate `seed` has derivative 1.
fn dual_tip(skeleton: &Skeleton, coordinates: &[f64], tip: usize, seed: usize) -> Rigid {
    let identity = |i, j| Dual(f64::from(u8::from(i == j)), 0.0);
    let shift = |v: DVec3| constant(identity, v.to_array().map(|x| Dual(x, 0.0)));
    let mut map = shift(DVec3::ZERO);
    for joint in skeleton.chain(skeleton.tips()[tip].joint) {
        let joint = &skeleton.joints()[joint];
        map = compose(&map, &shift(joint.offset));
        for m in &skeleton.motions()[joint.motions()] {
            let amount = match m.turning {
                Turning::Turn => coordinates[m.coordinate].to_radians(),
                Turning::Move => coordinates[m.coordinate],
            };
            let amount = Dual(amount, f64::from(u8::from(m.coordinate == seed)));
            map = compose(&map, &motion(m.turning, m.axis, amount));
        }
    }
    compose(&map, &shift(skeleton.tips()[tip].offset))
}

fn vector(random: &mut Random) -> DVec3 {
    DVec3::from_array(std::array::from_fn(|_| random.between(-1.0, 1.0)))
}

fn any_freedom(random: &mut Random) -> Freedom {
    match random.below(7) {
        0 => Freedom::Fixed,
        1 => Freedom::Hinge(vector(random)),
        2 => Freedom::Universal(vector(random), vector(random)),
        3 => Freedom::Ball,
        4 => Freedom::Slide(vector(random)),
        5 => Freedom::Free,
        _ => Freedom::Channels(vec![
            (Turning::Turn, DVec3::Y),
            (Turning::Move, DVec3::X),
            (Turning::Turn, DVec3::X),
            (Turning::Turn, DVec3::Z),
        ]),
    }
}

/// A tree of joints of all freedoms, with a tip on each.
fn any_skeleton(random: &mut Random, n_joints: usize) -> Skeleton {
    let mut skeleton = Skeleton::default();
    for k in 0..n_joints {
        let parent = (k > 0).then(|| k - 1 - random.below(k.min(2)));
        let freedom = any_freedom(random);
        let n = freedom.n_coordinates();
        let rest: Vec<f64> = (0..n).map(|_| random.between(-2.0, 2.0)).collect();
        skeleton.add_joint(&format!("j{k}"), parent, vector(random), freedom, &rest, &vec![Limits::NONE; n]);
        skeleton.add_tip(&format!("t{k}"), k, vector(random));
    }
    skeleton
}

fn any_coordinates(random: &mut Random, skeleton: &Skeleton) -> Vec<f64> {
    let mut coordinates = vec![0.0; skeleton.rest().len()];
    for motion in skeleton.motions() {
        let most = if motion.turning == Turning::Turn { 180.0 } else { 2.0 };
        coordinates[motion.coordinate] = random.between(-most, most);
    }
    coordinates
}

/// The arm of a textbook: T(0,6)·R(−45)·T(5,0)·R(50)·T(4,0)·R(30), with tips 0, 1 and 3 along the last link.
fn textbook_arm() -> Skeleton {
    let mut arm = Skeleton::default();
    let links = [
        ("shoulder", DVec3::Y * 6.0, -45.0),
        ("elbow", DVec3::X * 5.0, 50.0),
        ("wrist", DVec3::X * 4.0, 30.0),
    ];
    let mut parent = None;
    for (name, offset, angle) in links {
        parent =
            Some(arm.add_joint(name, parent, offset, Freedom::Hinge(DVec3::Z), &[angle], &[Limits::NONE]));
    }
    for reach in [0.0, 1.0, 3.0] {
        arm.add_tip("hand", 2, DVec3::X * reach);
    }
    arm
}

#[test]
fn the_textbook_arm_has_its_positions_jacobian_and_singular_values() {
    let arm = textbook_arm();
    let placement = Placement::new(&arm, arm.rest());
    let places = [(7.520312698, 2.813089065), (8.339464743, 3.386665501), (9.977768831, 4.533818374)];
    for (tip, (x, y)) in places.into_iter().enumerate() {
        assert!((placement.tip(&arm, tip) - DVec3::new(x, y, 0.0)).length() < 1e-9, "tip {tip}");
    }
    let jacobian = of_tip(&arm, &placement, 2, Rows::PositionAndTurn);
    let expected = [
        [1.466181626, -2.069352280, -1.720729309],
        [9.977768831, 6.442234925, 2.457456133],
        [0.0; 3],
        [0.0; 3],
        [0.0; 3],
        [1.0; 3],
    ];
    for (i, row) in expected.iter().enumerate() {
        for (j, entry) in row.iter().enumerate() {
            assert!((jacobian[(i, j)] - entry).abs() < 1e-9, "row {i}, column {j}: {}", jacobian[(i, j)]);
        }
    }
    let values = singular(&of_tip(&arm, &placement, 2, Rows::Position)).values;
    assert!((values[0] - 12.130939561).abs() < 1e-9 && (values[1] - 3.054582537).abs() < 1e-9, "{values:?}");
    assert!(values[2] < 1e-14, "{values:?}");
}

#[test]
fn jacobians_are_those_of_dual_numbers() {
    let mut random = Random::new(81);
    for case in 0..200 {
        let skeleton = any_skeleton(&mut random, 7);
        let coordinates = any_coordinates(&mut random, &skeleton);
        let placement = Placement::new(&skeleton, &coordinates);
        for tip in 0..skeleton.tips().len() {
            let jacobian = of_tip(&skeleton, &placement, tip, Rows::PositionAndTurn);
            let entries = (0..jacobian.columns()).flat_map(|j| jacobian.column(j).to_vec());
            let size = entries.fold(1.0, |size: f64, x| size.max(x.abs()));
            for seed in 0..coordinates.len() {
                let dual = dual_tip(&skeleton, &coordinates, tip, seed);
                let column = jacobian.column(seed);
                for i in 0..3 {
                    let off = (dual[i][3].1 - column[i]).abs();
                    assert!(off <= 1e-14 * size, "case {case}, tip {tip}, coordinate {seed}: off by {off:e}");
                }
                // ω from R′Rᵀ, the matrix of ω ×.
                let spin = |i: usize, j: usize| (0..3).map(|k| dual[i][k].1 * dual[j][k].0).sum::<f64>();
                let angular = [spin(2, 1), spin(0, 2), spin(1, 0)];
                for i in 0..3 {
                    assert!(
                        (angular[i] - column[3 + i]).abs() <= 1e-14 * size,
                        "case {case}, tip {tip}: {angular:?}"
                    );
                }
            }
        }
    }
}

#[test]
fn a_ball_turns_as_rotate_does_and_a_free_joint_moves_first() {
    let angles = DVec3::new(20.0, -70.0, 110.0);
    let mut skeleton = Skeleton::default();
    let limits = [Limits::NONE; 6];
    skeleton.add_joint("ball", None, DVec3::Y, Freedom::Ball, &angles.to_array(), &limits[..3]);
    let rest: Vec<f64> = [3.0, 4.0, 5.0].into_iter().chain(angles.to_array()).collect();
    skeleton.add_joint("free", None, DVec3::Y, Freedom::Free, &rest, &limits);
    let frames = Placement::new(&skeleton, skeleton.rest()).affines();
    let turn = Affine::rotate_xyz(angles);
    for p in [DVec3::X, DVec3::Y, DVec3::new(0.3, -2.0, 5.0)] {
        assert!((frames[0].point(p) - (turn.point(p) + DVec3::Y)).length() < 1e-14);
        assert!((frames[1].point(p) - (turn.point(p) + DVec3::new(3.0, 5.0, 5.0))).length() < 1e-14);
        assert!((frames[1].inverse().point(frames[1].point(p)) - p).length() < 1e-14);
    }
}

#[test]
fn a_universal_joint_carries_its_second_axis_along() {
    let mut skeleton = Skeleton::default();
    let freedom = Freedom::Universal(DVec3::Z, DVec3::Y * 2.0);
    skeleton.add_joint("u", None, DVec3::ZERO, freedom, &[90.0, 90.0], &[Limits::NONE; 2]);
    let tip = skeleton.add_tip("end", 0, DVec3::X);
    // About y first: x to −z; the turn about z leaves that alone.
    let placement = Placement::new(&skeleton, skeleton.rest());
    assert_eq!(placement.tip(&skeleton, tip), DVec3::NEG_Z);
    assert_eq!(placement.screws[1].axis, DVec3::NEG_X);
}

#[test]
fn bones_run_from_joint_to_joint_and_to_tips() {
    let arm = textbook_arm();
    let bones = Placement::new(&arm, &[0.0; 3]).bones(&arm);
    let ends: Vec<_> = bones.iter().map(|bone| (bone.joint, bone.start.x, bone.end.x)).collect();
    assert_eq!(ends, [(0, 0.0, 5.0), (1, 5.0, 9.0), (2, 9.0, 9.0), (2, 9.0, 10.0), (2, 9.0, 12.0)]);
    assert_eq!(arm.pointing(0), DVec3::X);
}
