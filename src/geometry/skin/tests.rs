//! Skins against closed forms: twists, rest, stretches, the law of smooth weights.

use super::*;
use crate::geometry::skeleton::Bone;
use crate::math::Affine;
use crate::math::elementary::{cos, sin};
use glam::DVec3;

const BOTH: [Blend; 2] = [Blend::Linear, Blend::DualQuaternion];

fn twisted(degrees: f64) -> [Motion; 2] {
    let turned = Affine::rotate(DVec3::X, degrees);
    [Motion::new(&Affine::IDENTITY, &Affine::IDENTITY), Motion::new(&Affine::IDENTITY, &turned)]
}

#[test]
fn a_half_twist_shrinks_to_the_cosine_when_linear_and_not_at_all_by_dual_quaternions() {
    for degrees in [1.0, 37.0, 90.0, 120.0, 150.0, 170.0, 179.999] {
        let p = DVec3::new(0.3, 0.6, -0.8);
        let half: (&[u16], &[f64]) = (&[0, 1], &[0.5, 0.5]);
        let radius = |q: DVec3| q.y.hypot(q.z);
        let linear = Blend::Linear.apply(&twisted(degrees), half, p).point;
        let shrunk = cos(degrees.to_radians() / 2.0);
        assert!((radius(linear) - shrunk).abs() < 1e-12, "{degrees}: {}", radius(linear) - shrunk);
        let dual = Blend::DualQuaternion.apply(&twisted(degrees), half, p).point;
        assert!((radius(dual) - 1.0).abs() < 1e-12, "{degrees}: {}", radius(dual) - 1.0);
        let expected = Affine::rotate(DVec3::X, degrees / 2.0).point(p);
        assert!((dual - expected).length() < 1e-12);
    }
    // Beyond half a turn the shorter way is the other one.
    let dual = Blend::DualQuaternion.apply(&twisted(181.0), (&[0, 1], &[0.5, 0.5]), DVec3::Y).point;
    let expected = (-89.5_f64).to_radians();
    assert!((dual - DVec3::new(0.0, cos(expected), sin(expected))).length() < 1e-12);
}

#[test]
fn at_rest_a_skin_lies_where_it_was_made_to_the_bit() {
    let far = DVec3::new(1e6, -2e6, 3e6);
    let chain = Affine::rotate(DVec3::new(0.6, 0.0, 0.8), 33.0).then(&Affine::translate(far));
    let scaled = Affine::scale(DVec3::new(2.0, 0.5, -1.5)).then(&chain);
    let motions = [Motion::new(&chain, &chain), Motion::new(&scaled, &scaled)];
    for blend in BOTH {
        let (p, n) = (far + DVec3::new(0.1, 0.2, 0.3), DVec3::new(0.36, 0.48, 0.8));
        let moved = blend.apply(&motions, (&[0, 1], &[0.3, 0.7]), p);
        assert_eq!((moved.point, moved.normal(n)), (p, n));
    }
    // The notes leave out the bind matrix: a bone at (2, 0, 0) would carry a vertex at 2.5 to 4.5.
    let bone = Affine::translate(DVec3::X * 2.0);
    let moved = Blend::Linear.apply(&[Motion::new(&bone, &bone)], (&[0], &[1.0]), DVec3::X * 2.5);
    assert_eq!(moved.point, DVec3::X * 2.5);
}

#[test]
fn a_point_of_one_bone_moves_as_the_bone() {
    let bind = Affine::rotate(DVec3::Y, 20.0).then(&Affine::translate(DVec3::new(4.0, 5.0, 6.0)));
    for stretch in [DVec3::ONE, DVec3::new(1.0, 3.0, 0.25), DVec3::new(-1.0, 1.0, 1.0), DVec3::splat(-2.0)] {
        let pose = Affine::scale(stretch)
            .then(&Affine::rotate(DVec3::new(0.0, 0.6, 0.8), 140.0))
            .then(&Affine::translate(DVec3::new(-7.0, 0.5, 1.0)));
        let whole = bind.inverse().then(&pose);
        for blend in BOTH {
            let p = DVec3::new(0.3, -2.0, 1.0);
            let moved = blend.apply(&[Motion::new(&bind, &pose)], (&[0], &[1.0]), p);
            assert!((moved.point - whole.point(p)).length() < 1e-13 * 20.0, "{stretch} {blend:?}");
            let n = DVec3::new(0.6, 0.0, -0.8);
            let expected = whole.normal(n).normalize() * whole.linear.determinant().signum();
            assert!((moved.normal(n) - expected).length() < 1e-12, "{stretch} {blend:?}");
        }
    }
}

#[test]
fn moving_all_bones_alike_moves_the_skin_alike() {
    let bind = [Affine::IDENTITY, Affine::translate(DVec3::X * 3.0), Affine::rotate(DVec3::Z, 50.0)];
    let world =
        Affine::rotate(DVec3::new(0.48, 0.6, 0.64), 77.0).then(&Affine::translate(DVec3::new(1.0, 2.0, 3.0)));
    let motions = bind.map(|b| Motion::new(&b, &b.then(&world)));
    for blend in BOTH {
        let p = DVec3::new(-1.0, 4.0, 0.5);
        let moved = blend.apply(&motions, (&[0, 1, 2], &[0.2, 0.5, 0.3]), p);
        assert!((moved.point - world.point(p)).length() < 1e-14 * 20.0);
        assert!((moved.normal(DVec3::Y) - world.vector(DVec3::Y)).length() < 1e-15 * 20.0);
    }
}

fn chain() -> Vec<Bone> {
    let at = |k: usize| DVec3::X * k as f64;
    (0..5).map(|joint| Bone { joint, start: at(joint), end: at(joint + 1) }).collect()
}

#[test]
fn smooth_weights_add_up_and_have_no_jumps() {
    let bones = chain();
    let step = 1e-4;
    for most in [1, 2, 4, 12] {
        let points: Vec<DVec3> = (0..50_000).map(|k| DVec3::new(f64::from(k) * step, 0.3, 0.1)).collect();
        let all = Influences::smooth(&points, &bones, most);
        let row = |k: usize| {
            let mut full = [0.0; 5];
            let (joints, weights) = all.of(k);
            assert!(joints.len() <= most);
            joints.iter().zip(weights).for_each(|(j, w)| full[usize::from(*j)] = *w);
            full
        };
        for k in 1..all.len() {
            let (a, b) = (row(k - 1), row(k));
            assert!((b.iter().sum::<f64>() - 1.0).abs() <= 2.0 * f64::EPSILON);
            // One nearest bone alone must jump; with more the steepest change is of the order of 1/distance.
            let jump = a.iter().zip(b).map(|(x, y)| (x - y).abs()).fold(0.0, f64::max);
            assert!(most == 1 || jump < 20.0 * step, "{most} influences at {}: {jump}", points[k]);
        }
    }
}

#[test]
fn a_point_on_a_bone_is_moved_by_it_alone_and_one_on_a_joint_by_both() {
    let on = [DVec3::X * 1.5, DVec3::X * 2.0, DVec3::ZERO];
    let all = Influences::smooth(&on, &chain(), 4);
    assert_eq!(all.of(0), (&[1][..], &[1.0][..]));
    assert_eq!(all.of(1), (&[1, 2][..], &[0.5, 0.5][..]));
    assert_eq!(all.of(2), (&[0][..], &[1.0][..]));
    let rigid = Influences::rigid(&on, &chain());
    assert_eq!(rigid.of(1), (&[1][..], &[1.0][..]));
}

#[test]
fn listed_weights_are_made_to_add_up_and_negative_ones_refused() {
    let mut all = Influences::default();
    let sum = all.push([(0, 0.5), (3, 0.0), (2, 0.48)]).unwrap();
    assert!((sum - 0.98).abs() < 1e-15);
    let (joints, weights) = all.of(0);
    assert_eq!(joints, [0, 2]);
    assert!((weights.iter().sum::<f64>() - 1.0).abs() <= f64::EPSILON);
    assert_eq!(all.push([(0, 1.5), (1, -0.5)]), Err(WeightError::Negative(-0.5)));
    assert_eq!(all.push([(0, 0.0)]), Err(WeightError::NoWeight));
    assert!(all.push([(0, f64::NAN)]).is_err());
    assert_eq!(all.len(), 1);
    // A hundred units out, weights of 0.98 in all would pull by two.
    let far = Affine::translate(DVec3::X * 100.0);
    let motions = [Motion::new(&far, &far); 3];
    assert_eq!(Blend::Linear.apply(&motions, all.of(0), DVec3::X * 100.0).point, DVec3::X * 100.0);
}

/// Two sheets that share a border only by position, with other diagonals.
fn sheets() -> Mesh {
    let mut mesh = Mesh::default();
    for side in [0.0, 1.0] {
        let first = mesh.positions.len() as u32;
        for (x, y) in [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0)] {
            mesh.positions.push(DVec3::new(side + x, y, 0.0));
            mesh.normals.push(DVec3::Z);
        }
        mesh.triangles.extend([[0, 1, 3], [0, 3, 2]].map(|t: [u32; 3]| t.map(|k| first + k)));
    }
    mesh.material_of_triangle = vec![0, 1, 2, 3];
    mesh
}

#[test]
fn bent_triangles_are_made_finer_without_cracks() {
    let roll = |p: &DVec3| DVec3::new(sin(p.x), p.y, cos(p.x) + 0.3 * sin(3.0 * p.y));
    let images = |points: &[DVec3]| Ok::<_, ()>(points.iter().map(roll).collect());
    let tolerance = 1e-3;
    let mut mesh = sheets();
    refine(&mut mesh, tolerance, &images).unwrap();
    assert!(mesh.triangles.len() > 200 && mesh.positions.len() < 2000, "{}", mesh.triangles.len());
    assert_eq!(mesh.material_of_triangle.len(), mesh.triangles.len());
    let place = |k: u32| mesh.positions[k as usize];
    let area: f64 = mesh
        .triangles
        .iter()
        .map(|t| {
            let [a, b, c] = t.map(place);
            (b - a).cross(c - a).z * 0.5
        })
        .sum();
    assert!((area - 2.0).abs() < 1e-12, "triangles overlap or turned over: {area}");
    // Every edge inside occurs once in each direction, by the places of its ends: also across the border of the sheets.
    let bits = |k: u32| place(k).to_array().map(f64::to_bits);
    let directed: std::collections::HashSet<_> = mesh
        .triangles
        .iter()
        .flat_map(|&[a, b, c]| [(a, b), (b, c), (c, a)])
        .map(|(a, b)| (bits(a), bits(b)))
        .collect();
    for (a, b) in &directed {
        let on = |p: &[u64; 3], axis: usize, at: f64| f64::from_bits(p[axis]) == at;
        let border = [(0, 0.0), (0, 2.0), (1, 0.0), (1, 1.0)]
            .iter()
            .any(|(axis, at)| on(a, *axis, *at) && on(b, *axis, *at));
        assert!(border || directed.contains(&(*b, *a)), "a crack");
    }
    for t in &mesh.triangles {
        let [a, b, c] = t.map(place);
        for (p, q) in [(a, b), (b, c), (c, a)] {
            let off = roll(&((p + q) * 0.5)).distance((roll(&p) + roll(&q)) * 0.5);
            assert!(off <= tolerance, "{off}");
        }
    }
}

#[test]
fn an_edge_whose_image_is_an_s_is_cut_though_its_middle_is_in_place() {
    let wave = |points: &[DVec3]| {
        Ok::<_, ()>(
            points.iter().map(|p| *p + DVec3::Z * 0.1 * sin(2.0 * std::f64::consts::PI * p.x)).collect(),
        )
    };
    let positions = vec![DVec3::ZERO, DVec3::X, DVec3::Y];
    let mut mesh = Mesh { positions, triangles: vec![[0, 1, 2]], ..Mesh::default() };
    refine(&mut mesh, 0.01, &wave).unwrap();
    let is_cut = |a: DVec3| mesh.positions.contains(&a);
    assert!(is_cut(DVec3::X * 0.5) && is_cut(DVec3::X * 0.25), "{} triangles", mesh.triangles.len());
}

#[test]
fn a_motion_that_tears_is_followed_only_so_far() {
    let tear = |points: &[DVec3]| {
        Ok::<_, ()>(points.iter().map(|p| *p + DVec3::Z * f64::from(u8::from(p.x > 0.7))).collect())
    };
    let mut mesh = sheets();
    refine(&mut mesh, 1e-6, &tear).unwrap();
    assert!(mesh.triangles.len() < 100_000, "{}", mesh.triangles.len());
}

#[test]
fn normals_follow_a_twist_that_changes_along_the_surface() {
    let rate = 4.0;
    let twist = |p: &DVec3| Affine::rotate(DVec3::Y, (rate * p.y).to_degrees()).point(*p);
    let images = |points: &[DVec3]| Ok::<_, ()>(points.iter().map(twist).collect());
    let points: Vec<DVec3> = (0..50).map(|k| DVec3::new(1.0, 0.05 * f64::from(k), 0.3)).collect();
    let bent = bent_normals(&points, &vec![DVec3::X; 50], 3.0, &images).unwrap();
    for (p, n) in points.iter().zip(&bent) {
        // Tangents of the plane x = 1: along z they turn, along y they are carried round as well.
        let turn = Affine::rotate(DVec3::Y, (rate * p.y).to_degrees());
        let along = turn.vector(DVec3::Z);
        let up = DVec3::Y + rate * DVec3::Y.cross(turn.point(*p));
        let expected = up.cross(along).normalize();
        assert!((*n - expected).length() < 1e-8, "{n} {expected}");
        assert!((*n - turn.vector(DVec3::X)).length() > 0.1, "the change of the twist counts");
    }
    let still = |points: &[DVec3]| Ok::<_, ()>(points.to_vec());
    assert_eq!(bent_normals(&points, &bent, 3.0, &still).unwrap(), bent);
}

#[test]
fn lengths_beyond_any_picture_do_not_refine_without_end() {
    let far = 1e300;
    let positions =
        vec![DVec3::new(far / 3.0, 0.0, 0.0), DVec3::new(far, 0.0, 0.0), DVec3::new(far, 1.0, 0.0)];
    let mut mesh = Mesh { positions, triangles: vec![[0, 1, 2]], ..Mesh::default() };
    let turned =
        |points: &[DVec3]| Ok::<_, ()>(points.iter().map(|p| DVec3::new(p.y, 1.1 * p.x, 0.0)).collect());
    refine(&mut mesh, 1e-3, &turned).unwrap();
    assert_eq!(mesh.triangles.len(), 1, "a motion that bends nothing");
}
