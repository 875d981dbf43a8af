//! Implicit surfaces against closed forms: every root, double roots, thin shells, singular points, and what the search costs.

use super::*;
use crate::math::elementary::{cos, sin};
use crate::math::field::{Binary, FieldBuilder, Register, Rule, Unary};
use crate::world::shape::Torus;

/// Arithmetic on a tape in the making.
struct Maker(FieldBuilder);

impl Maker {
    fn c(&mut self, x: f64) -> Register {
        self.0.constant(x)
    }
    fn add(&mut self, a: Register, b: Register) -> Register {
        self.0.binary(Binary::Add, a, b)
    }
    fn sub(&mut self, a: Register, b: Register) -> Register {
        self.0.binary(Binary::Sub, a, b)
    }
    fn mul(&mut self, a: Register, b: Register) -> Register {
        self.0.binary(Binary::Mul, a, b)
    }
    fn sq(&mut self, a: Register) -> Register {
        self.mul(a, a)
    }
    fn plus(&mut self, a: Register, b: f64) -> Register {
        let b = self.c(b);
        self.add(a, b)
    }
    fn times(&mut self, a: Register, b: f64) -> Register {
        let b = self.c(b);
        self.mul(a, b)
    }
    fn sum(&mut self, all: &[Register]) -> Register {
        all[1..].iter().fold(all[0], |sum, x| self.add(sum, *x))
    }
    fn squares(&mut self, all: &[Register]) -> Register {
        let squares: Vec<Register> = all.iter().map(|x| self.sq(*x)).collect();
        self.sum(&squares)
    }
    fn sqrt(&mut self, a: Register) -> Register {
        self.0.unary(Unary::Sqrt, a)
    }
    fn abs(&mut self, a: Register) -> Register {
        self.0.unary(Unary::Abs, a)
    }
    fn sin(&mut self, a: Register) -> Register {
        self.0.call1(sin, Rule::Sin, a)
    }
    fn cos(&mut self, a: Register) -> Register {
        self.0.call1(cos, Rule::Cos, a)
    }
}

fn implicit(half: f64, f: impl FnOnce(&mut Maker, [Register; 3]) -> Register) -> Implicit {
    let mut maker = Maker(FieldBuilder::new(3));
    let p = [0, 1, 2].map(|i| maker.0.input(i));
    let result = f(&mut maker, p);
    let field = maker.0.finish(&[result]).expect("small");
    let function = SampledFunction::of_point(field);
    Implicit::new(Arc::new(function), DVec3::splat(-half), DVec3::splat(half), None)
}

fn ray(origin: DVec3, direction: DVec3) -> LocalRay {
    LocalRay::new(origin, direction).expect("a direction").0
}

fn distances(shape: &Implicit, ray: &LocalRay) -> Vec<f64> {
    let mut all = vec![];
    shape.crossings(ray, &mut all);
    all.iter().map(|m| m.t).collect()
}

fn assert_near(found: &[f64], expected: &[f64], tolerance: f64) {
    assert_eq!(found.len(), expected.len(), "{found:?} for {expected:?}");
    for (f, e) in found.iter().zip(expected) {
        assert!((f - e).abs() <= tolerance, "{found:?} for {expected:?}");
    }
}

/// Numbers in −1 … 1.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }
    fn vector(&mut self) -> DVec3 {
        DVec3::new(self.next(), self.next(), self.next())
    }
}

fn ball() -> Implicit {
    implicit(2.0, |m, p| {
        let r = m.squares(&p);
        m.plus(r, -1.0)
    })
}

#[test]
fn a_ball_is_met_where_a_sphere_is() {
    let (shape, sphere) = (ball(), crate::world::shape::Sphere { center: DVec3::ZERO, radius: 1.0 });
    let mut random = Random(1);
    for case in 0..4000 {
        let ray = ray(random.vector() * 3.0, random.vector());
        let mut exact = vec![];
        sphere.crossings(&ray, &mut exact);
        let exact: Vec<f64> = exact.iter().map(|m| m.t).collect();
        let found = distances(&shape, &ray);
        assert_near(&found, &exact, 1e-13);
        assert_eq!(shape.starts_inside(&ray), exact.len() == 1, "case {case}");
        let Some(meet) = shape.meet(&ray, f64::MAX) else { continue };
        assert_eq!(Some(meet.t), found.first().copied());
        let surface = shape.surface(&ray, &meet);
        assert!((surface.geometric_normal - surface.point.normalize()).length() < 1e-14);
        assert!(surface.error.max_element() < 1e-14 && surface.error.min_element() > 0.0, "{surface:?}");
    }
}

#[test]
fn a_double_zero_is_touched_at_each_of_its_sides() {
    let shape = implicit(2.0, |m, p| {
        let r = m.squares(&p);
        let g = m.plus(r, -1.0);
        m.sq(g)
    });
    let found = distances(&shape, &ray(DVec3::new(0.1, 0.2, -5.0), DVec3::Z));
    let half = 0.95f64.sqrt();
    assert_near(&found, &[5.0 - half, 5.0 - half, 5.0 + half, 5.0 + half], 1e-13);
    let from = ray(DVec3::new(0.1, 0.2, -5.0), DVec3::Z);
    let meet = shape.meet(&from, f64::MAX).expect("touched");
    let normal = shape.surface(&from, &meet).geometric_normal;
    assert!((normal - DVec3::new(0.1, 0.2, -half)).length() < 1e-3, "{normal}");
    let plane = implicit(2.0, |m, p| m.sq(p[2]));
    for d in [DVec3::Z, DVec3::new(0.3, 0.1, 1.0), DVec3::new(1.0, 0.0, 0.01)] {
        let at = DVec3::new(0.1, 0.2, 0.0) - d * 1.5;
        assert_near(&distances(&plane, &ray(at, d)), &[1.5, 1.5], 1e-12);
    }
}

/// Written out as a polynomial, so that rounding hides a wide place around the double zero.
#[test]
fn a_double_zero_of_a_polynomial_written_out_is_not_lost() {
    let shape = implicit(2.0, |m, p| {
        let r = m.squares(&p);
        let (fourth, twice) = (m.sq(r), m.times(r, -2.0));
        let sum = m.add(fourth, twice);
        m.plus(sum, 1.0)
    });
    let found = distances(&shape, &ray(DVec3::new(0.1, 0.2, -5.0), DVec3::Z));
    let half = 0.95f64.sqrt();
    assert!(!found.is_empty() && (found[0] - (5.0 - half)).abs() < 1e-6, "{found:?}");
    assert!((found[found.len() - 1] - (5.0 + half)).abs() < 1e-6, "{found:?}");
}

#[test]
fn a_thin_shell_has_four_sides() {
    let shape = implicit(2.0, |m, p| {
        let r = m.squares(&p);
        let g = m.plus(r, -1.0);
        let square = m.sq(g);
        m.plus(square, -1e-8)
    });
    let (inner, outer) = ((1.0f64 - 1e-4).sqrt(), (1.0f64 + 1e-4).sqrt());
    let mut random = Random(2);
    for _ in 0..300 {
        let direction = random.vector().normalize();
        let (ray, per) = LocalRay::new(-direction * 4.0, direction).expect("a direction");
        let found: Vec<f64> = distances(&shape, &ray).iter().map(|t| t / per).collect();
        assert_near(&found, &[4.0 - outer, 4.0 - inner, 4.0 + inner, 4.0 + outer], 1e-12);
    }
}

#[test]
fn the_tanglecube_has_four_roots_on_its_diagonal_and_none_along_z() {
    let shape = implicit(4.0, |m, p| {
        let terms = p.map(|x| {
            let square = m.sq(x);
            let (fourth, five) = (m.sq(square), m.times(square, -5.0));
            m.add(fourth, five)
        });
        let sum = m.sum(&terms);
        m.plus(sum, 11.8)
    });
    let diagonal = DVec3::ONE.normalize();
    let (ray_, per) = LocalRay::new(-diagonal * 6.0, diagonal).expect("a direction");
    let found: Vec<f64> = distances(&shape, &ray_).iter().map(|t| t / per - 6.0).collect();
    let exact = |sign: f64| (3.0 * (5.0 + sign * (25.0 - 4.0 * 11.8 / 3.0f64).sqrt()) / 2.0).sqrt();
    assert_near(&found, &[-exact(1.0), -exact(-1.0), exact(-1.0), exact(1.0)], 1e-12);
    assert!((exact(1.0) - 3.473640745).abs() < 1e-9 && (exact(-1.0) - 1.712839741).abs() < 1e-9);
    assert!(distances(&shape, &ray(DVec3::new(0.0, 0.0, -6.0), DVec3::Z)).is_empty());
}

#[test]
fn singular_points_have_normals() {
    let cone = implicit(2.0, |m, p| {
        let (a, b, c) = (m.sq(p[0]), m.sq(p[1]), m.sq(p[2]));
        let sum = m.add(a, b);
        m.sub(sum, c)
    });
    let steiner = implicit(1.0, |m, [x, y, z]| {
        let (a, b, c) = (m.mul(x, y), m.mul(y, z), m.mul(z, x));
        let squares = m.squares(&[a, b, c]);
        let all = m.mul(a, z);
        m.add(squares, all)
    });
    let mut random = Random(3);
    for shape in [cone, steiner] {
        for case in 0..500 {
            // Through the apex, along the double lines, and anywhere.
            let direction = match case % 5 {
                0 => DVec3::X,
                1 => DVec3::Z,
                2 => DVec3::new(1.0, 0.0, 1.0),
                _ => random.vector(),
            };
            let at = if case % 3 == 0 { DVec3::ZERO } else { random.vector() * 0.3 };
            let from = ray(at - direction * 5.0, direction);
            let mut all = vec![];
            shape.crossings(&from, &mut all);
            for meet in all {
                if meet.face >= UNDEFINED {
                    continue;
                }
                let surface = shape.surface(&from, &meet);
                assert!(surface.geometric_normal.is_normalized(), "{case}: {surface:?}");
                assert!(surface.point.is_finite() && surface.error.is_finite());
            }
        }
    }
}

fn ring() -> Implicit {
    implicit(1.5, |m, [x, y, z]| {
        let flat = m.squares(&[x, z]);
        let out = m.sqrt(flat);
        let from_ring = m.plus(out, -1.0);
        let squares = m.squares(&[from_ring, y]);
        m.plus(squares, -0.0625)
    })
}

/// Without the root: (|p|² + R² − r²)² − 4R²(x² + z²).
fn quartic_ring(square: fn(&mut Maker, Register) -> Register) -> Implicit {
    implicit(1.5, move |m, [x, y, z]| {
        let (a, b, c) = (square(m, x), square(m, y), square(m, z));
        let all = m.sum(&[a, b, c]);
        let shifted = m.plus(all, 1.0 - 0.0625);
        let first = square(m, shifted);
        let flat = m.add(a, c);
        let four = m.times(flat, 4.0);
        m.sub(first, four)
    })
}

#[test]
fn a_ring_is_met_where_a_torus_is() {
    let torus = Torus::new(crate::scene::Torus { center: DVec3::ZERO, axis: DVec3::Y, radii: [1.0, 0.25] });
    let shapes = [ring(), quartic_ring(|m, x| m.sq(x))];
    let mut random = Random(4);
    let mut hits = 0;
    for _ in 0..4000 {
        let ray = ray(random.vector() * 2.5, random.vector());
        let mut exact = vec![];
        torus.crossings(&ray, &mut exact);
        let exact: Vec<f64> = exact.iter().map(|m| m.t).collect();
        hits += exact.len();
        for shape in &shapes {
            assert_near(&distances(shape, &ray), &exact, 1e-11);
        }
    }
    assert!(hits > 400, "{hits}");
}

/// Bisects by plain intervals over the same cell: no derivatives, no squares, no octree.
fn naive_evaluations(shape: &Implicit, ray: &LocalRay) -> u64 {
    let mut encloser = Encloser::<0>::new(&shape.function.field);
    let Some((enter, leave)) = shape.within.ends(ray) else { return 0 };
    let mut rest = vec![(enter.t.max(0.0), leave.t)];
    let mut n = 0;
    while let Some((a, b)) = rest.pop() {
        n += 1;
        let at = [0, 1, 2].map(|i| {
            let s = Interval::new(a, b);
            let x = Interval::point(ray.origin[i]) + Interval::point(ray.direction[i]) * s;
            Enclosed { value: x, slope: [] }
        });
        if !encloser.run(&at).value.contains(0.0) {
            continue;
        }
        if b - a < 1e-12 {
            return n;
        }
        let middle = a / 2.0 + b / 2.0;
        rest.push((middle, b));
        rest.push((a, middle));
    }
    n
}

#[test]
fn a_first_hit_costs_less_than_half_of_naive_interval_arithmetic() {
    let (shape, naive) = (
        quartic_ring(|m, x| m.sq(x)),
        quartic_ring(|m, x| {
            let copy = m.plus(x, 0.0);
            m.mul(x, copy)
        }),
    );
    let mut random = Random(5);
    let (mut ours, mut theirs, mut rays) = (0, 0, 0);
    for _ in 0..400 {
        let origin = random.vector().normalize() * 4.0;
        let ray = ray(origin, random.vector() - origin);
        ours += u64::from(shape.meet_counting(&ray, f64::MAX).1);
        theirs += naive_evaluations(&naive, &ray);
        rays += 1;
    }
    println!(
        "{:.1} evaluations a ray, naive {:.1}",
        ours as f64 / f64::from(rays),
        theirs as f64 / f64::from(rays)
    );
    assert!(2 * ours <= theirs, "{ours} of {theirs}");
}

#[test]
fn the_box_cuts_with_a_face() {
    let slab = implicit(1.0, |m, p| m.plus(p[0], 0.5));
    let found = distances(&slab, &ray(DVec3::new(-5.0, 0.1, 0.2), DVec3::X));
    assert_eq!(found, [4.0, 4.5]);
    let from = ray(DVec3::new(-5.0, 0.1, 0.2), DVec3::X);
    let meet = slab.meet(&from, f64::MAX).expect("cut");
    assert_eq!(slab.surface(&from, &meet).geometric_normal, -DVec3::X);
    // Through the inside alone: cut on both ends.
    assert_eq!(distances(&slab, &ray(DVec3::new(-0.75, 0.1, -5.0), DVec3::Z)), [4.0, 6.0]);
    assert!(slab.starts_inside(&ray(DVec3::new(-0.75, 0.0, 0.0), DVec3::Y)));
    assert!(!slab.starts_inside(&ray(DVec3::new(-1.75, 0.0, 0.0), DVec3::Y)));
}

#[test]
fn where_the_function_is_undefined_is_met_as_such() {
    // √x − 0.5, undefined for x < 0.
    let half = implicit(1.0, |m, p| {
        let root = m.sqrt(p[0]);
        m.plus(root, -0.5)
    });
    let from_right = ray(DVec3::new(5.0, 0.1, 0.2), -DVec3::X);
    let mut all = vec![];
    half.crossings(&from_right, &mut all);
    assert_eq!(all[0].face, ON_SURFACE);
    assert!((all[0].t - 4.75).abs() < 1e-14);
    assert!(all[1..].iter().any(|m| m.face == UNDEFINED && (m.t - 5.0).abs() < 1e-9), "{all:?}");
    let from_left = ray(DVec3::new(-5.0, 0.1, 0.2), DVec3::X);
    let meet = half.meet(&from_left, f64::MAX).expect("undefined");
    assert_eq!(meet.face, UNDEFINED);
    assert!(half.fault(&from_left, &meet).is_some_and(|f| f.kind == FaultKind::Undefined));
}

#[test]
fn a_jump_between_values_of_one_sign_is_empty_space() {
    // The part of x beyond a whole number, which jumps from 1 to 0, and what keeps it from 0.
    let away_from_zero = |offset: f64| {
        implicit(4.0, |m, p| {
            let whole = m.0.unary(Unary::Floor, p[0]);
            let part = m.sub(p[0], whole);
            m.plus(part, offset)
        })
    };
    let ahead = ray(DVec3::new(-5.0, 0.1, 0.2), DVec3::X);
    let outside = away_from_zero(0.5);
    assert_eq!(outside.cells.middles(outside.bounds()).count(), 0);
    assert!(outside.meet(&ahead, f64::MAX).is_none());
    // It jumps through 0 at each of nine whole numbers, comes back between them, and is cut off by the last.
    let wall = away_from_zero(-0.25);
    assert!(wall.cells.middles(wall.bounds()).count() > 0);
    assert_eq!(distances(&wall, &ahead).len(), 9 + 8 + 1);
}

#[test]
fn the_turns_of_a_loop_hide_no_surface() {
    for n in [40.0, 1000.0] {
        let ball = implicit(2.0, |m, p| {
            let (zero, one, most) = (m.c(0.0), m.c(1.0), m.c(n));
            let (count, sum) = (m.0.variable(zero), m.0.variable(zero));
            let turn = m.0.label();
            m.0.bind(turn);
            let (squares, next) = (m.squares(&p), m.add(count, one));
            let sum_after = m.add(sum, squares);
            m.0.assign(sum, sum_after);
            m.0.assign(count, next);
            let again = m.0.binary(Binary::Less, count, most);
            m.0.jump_if_not_zero(again, turn);
            m.plus(sum, -n)
        });
        let found = distances(&ball, &ray(DVec3::new(-5.0, 0.0, 0.0), DVec3::X));
        assert_eq!(found.len(), 2, "{found:?}");
        assert!((found[0] - 4.0).abs() < 1e-11 && (found[1] - 6.0).abs() < 1e-11, "{found:?}");
    }
}

/// x + ½, after a loop without end where x is less than a limit.
fn endless_below(limit: f64) -> Implicit {
    implicit(2.0, |m, p| {
        let limit = m.c(limit);
        let again = m.0.binary(Binary::Less, p[0], limit);
        let turn = m.0.label();
        m.0.bind(turn);
        m.0.jump_if_not_zero(again, turn);
        m.plus(p[0], 0.5)
    })
}

#[test]
fn no_part_is_tried_of_a_function_without_end() {
    let endless = endless_below(3.0);
    assert_eq!(endless.cells.leaves.len(), 1);
    let ahead = ray(DVec3::new(-5.0, 0.1, 0.2), DVec3::X);
    let meet = endless.meet(&ahead, f64::MAX).expect("undefined");
    assert!(endless.fault(&ahead, &meet).is_some_and(|f| f.kind == FaultKind::TooManyTurns));
    let half = endless_below(-1.0);
    assert!(half.cells.leaves.len() > 8, "where it ends it is known");
    let found = distances(&half, &ray(DVec3::new(0.5, 0.1, 0.2), -DVec3::X));
    assert!((found[0] - 1.0).abs() < 1e-12, "{found:?}");
}

#[test]
fn a_jump_is_a_surface_and_a_pole_without_a_change_of_sign_is_none() {
    let step = implicit(2.0, |m, p| {
        let floor = m.0.unary(Unary::Floor, p[0]);
        m.plus(floor, 0.5)
    });
    let found = distances(&step, &ray(DVec3::new(-5.0, 0.1, 0.2), DVec3::X));
    assert_near(&found, &[3.0, 5.0], 1e-13);
    let pole = implicit(2.0, |m, p| {
        let (one, square) = (m.c(1.0), m.sq(p[0]));
        m.0.binary(Binary::Div, one, square)
    });
    let beside = ray(DVec3::new(-5.1, 0.1, 0.2), DVec3::new(1.0, 0.01, 0.0));
    let mut all = vec![];
    pole.crossings(&beside, &mut all);
    assert!(all.iter().all(|m| m.face != ON_SURFACE), "{all:?}");
}

fn gyroid() -> Implicit {
    implicit(2.0, |m, p| {
        let q = p.map(|x| m.times(x, 3.0));
        let (s, c) = (q.map(|x| m.sin(x)), q.map(|x| m.cos(x)));
        let terms = [m.mul(s[0], c[1]), m.mul(s[1], c[2]), m.mul(s[2], c[0])];
        let sum = m.sum(&terms);
        let thick = m.abs(sum);
        m.plus(thick, -0.3)
    })
}

#[test]
fn a_gyroid_misses_no_root_and_takes_few_evaluations() {
    let shape = gyroid();
    let mut random = Random(6);
    let (mut roots, mut n) = (0, 0);
    for case in 0..300 {
        let origin = random.vector().normalize() * 5.0;
        let ray = ray(origin, random.vector() * 2.0 - origin);
        n += shape.meet_counting(&ray, f64::MAX).1;
        let Some((enter, leave)) = shape.within.ends(&ray) else { continue };
        // Every change of sign between closely spaced samples is among the crossings.
        let mut all = vec![];
        shape.crossings(&ray, &mut all);
        let turns = all.iter().filter(|m| m.face == ON_SURFACE).map(|m| m.t);
        let turns: Vec<f64> = turns.collect();
        let steps = 20_000;
        let at = |i: usize| enter.t + (leave.t - enter.t) * (i as f64 + 0.5) / (steps as f64 + 1.0);
        let mut changes = vec![];
        for i in 0..steps {
            let (a, b) = (shape.value(ray.at(at(i))) < 0.0, shape.value(ray.at(at(i + 1))) < 0.0);
            if a != b {
                changes.push((at(i), at(i + 1)));
            }
        }
        for (a, b) in &changes {
            assert!(turns.iter().any(|t| a <= t && t <= b), "case {case}: nothing in {a} … {b} of {turns:?}");
        }
        roots += changes.len();
    }
    println!("{} roots, {:.1} evaluations a ray to the first", roots, f64::from(n) / 300.0);
    assert!(roots > 1000 && n < 300 * 16, "{roots} {n}");
}

#[test]
fn scale_and_distance_change_nothing() {
    let big = implicit(2.0 * 1048576.0, |m, p| {
        let r = m.squares(&p);
        m.plus(r, -(1048576.0f64 * 1048576.0))
    });
    let small = ball();
    let mut random = Random(7);
    for _ in 0..500 {
        let (o, d) = (random.vector() * 3.0, random.vector());
        let near = distances(&small, &ray(o, d));
        let far: Vec<f64> = distances(&big, &ray(o * 1048576.0, d)).iter().map(|t| t / 1048576.0).collect();
        assert_eq!(near, far);
    }
    let from_afar = ray(DVec3::new(0.1, 0.2, -1e9), DVec3::Z);
    assert_near(&distances(&small, &from_afar), &[1e9 - 0.95f64.sqrt(), 1e9 + 0.95f64.sqrt()], 3e-7);
}
