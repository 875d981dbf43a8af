//! A ray against triangles. Alone: the distance, by Cramer's rule in double-double. As a closed mesh: a ball of 512 triangles hit from
//! inside at its very edges and corners, where every ray must be stopped; what gets out is a hole.

use super::SEED;
use super::spheres::{compare, line};
use crate::math::Dd;
use crate::math::random::Random;
use crate::report::naive::shapes::{self as naive, Line};
use crate::report::row::Row;
use crate::report::trial::{Plan, Subject, Trial, Verdict, default, variant};
use crate::world::shape::LocalRay;
use crate::world::shape::triangle::Sheared;
use glam::DVec3;

/// The sheared distance is off by u times the triangle's aspect, which is at most this.
const SLIVER: f64 = (1u64 << 20) as f64;

/// Origin, direction, then three corners.
type Alone = [f64; 15];
type Draw = fn(&mut Random) -> Alone;

/// Trials of ray and triangle.
pub fn rows(plan: &Plan) -> Vec<Row> {
    let alone: [(&str, f64, Draw); 3] =
        [("any", 64.0, any), ("slivers", SLIVER, sliver), ("at a million", 64.0, far)];
    let balls = [("aimed at edges", 0.0), ("aimed at edges, a million away", 1e6)];
    let alone = alone.into_iter().flat_map(|(case, bar, draw)| single(plan, case, bar, draw));
    alone.chain(balls.into_iter().flat_map(|(case, away)| ball(plan, case, away))).collect()
}

fn watertight(line: &Line, corners: [DVec3; 3]) -> Option<f64> {
    let (ray, scale) = LocalRay::new(line.origin, line.direction)?;
    Sheared::new(&ray).meet(corners.each_ref(), f64::INFINITY).map(|meet| meet.t / scale)
}

type Test = fn(&Line, [DVec3; 3]) -> Option<f64>;

const VARIANTS: [(&str, Test); 2] =
    [("cramer", naive::triangle_cramer), ("möller trumbore", naive::triangle_moller_trumbore)];

fn single(plan: &Plan, case: &'static str, bar: f64, draw: Draw) -> Vec<Row> {
    let mut random = Random::new(SEED);
    let inputs: Vec<Alone> = (0..plan.inputs).map(|_| draw(&mut random)).collect();
    let subject = Subject { component: "ray and triangle", case, unit: "ulp of t", work: "", bar: Some(bar) };
    let mut trial =
        Trial::new(plan, subject, inputs, |i: &Alone, t: &Option<f64>| compare(*t, Some(truth(i))))
            .in_chains(|t| t.unwrap_or(0.0));
    for (name, test) in VARIANTS {
        trial.run(variant(name), move |i| test(&line(i), corners(i)));
    }
    trial.run(default("watertight").note("the others leave holes between triangles"), |i| {
        watertight(&line(i), corners(i))
    });
    trial.finish()
}

fn corners(i: &Alone) -> [DVec3; 3] {
    [6, 9, 12].map(|k| DVec3::new(i[k], i[k + 1], i[k + 2]))
}

/// n·(a − o) / n·d in double-double.
fn truth(i: &Alone) -> f64 {
    let minus =
        |k: usize, l: usize| -> [Dd; 3] { std::array::from_fn(|x| Dd::difference(i[k + x], i[l + x])) };
    let (e, f, h) = (minus(9, 6), minus(12, 6), minus(6, 0));
    let n = [(1, 2), (2, 0), (0, 1)].map(|(x, y): (usize, usize)| e[x].times(f[y]) - e[y].times(f[x]));
    let dot = |v: [Dd; 3]| n[0].times(v[0]) + n[1].times(v[1]) + n[2].times(v[2]);
    dot(h).over(dot([i[3], i[4], i[5]].map(Dd::from))).value()
}

fn vector(r: &mut Random) -> DVec3 {
    DVec3::new(r.between(-1.0, 1.0), r.between(-1.0, 1.0), r.between(-1.0, 1.0))
}

/// A ray from `away` toward a point well inside the triangle.
fn aimed(r: &mut Random, [a, b, c]: [DVec3; 3], away: f64) -> Alone {
    let (u, v) = (r.between(0.2, 0.4), r.between(0.2, 0.4));
    let target = a + (b - a) * u + (c - a) * v;
    let n = (b - a).cross(c - a).normalize();
    let d = (n * r.sign() + vector(r) * 0.4).normalize();
    let o = target - d * away;
    [o.x, o.y, o.z, d.x, d.y, d.z, a.x, a.y, a.z, b.x, b.y, b.z, c.x, c.y, c.z]
}

fn any(r: &mut Random) -> Alone {
    let corners = [vector(r), vector(r), vector(r)];
    aimed(r, corners, 5.0)
}

/// A thousand to a million times as long as wide.
fn sliver(r: &mut Random) -> Alone {
    let (a, along) = (vector(r), vector(r).normalize());
    let thin = along.any_orthonormal_vector() * crate::math::elementary::exp2(r.between(-20.0, -10.0));
    aimed(r, [a, a + along, a + along * 0.5 + thin], 5.0)
}

fn far(r: &mut Random) -> Alone {
    let place = DVec3::new(148_376.0, 1234.0, -223_423.0) * 4.0;
    let corners = [place + vector(r), place + vector(r), place + vector(r)];
    aimed(r, corners, 5.0)
}

/// An octahedron divided three times, each corner at a distance of its own, around a point.
fn bumpy_ball(center: DVec3) -> Vec<[DVec3; 3]> {
    let axes = [DVec3::X, DVec3::Y, DVec3::Z];
    let faces = (0..8).map(|k: usize| {
        std::array::from_fn(|axis| if k >> axis & 1 == 0 { axes[axis] } else { -axes[axis] })
    });
    let mut faces: Vec<[DVec3; 3]> = faces.collect();
    for _ in 0..3 {
        let middle = |a: DVec3, b: DVec3| (a + b).normalize();
        let four = |[a, b, c]: [DVec3; 3]| {
            let (ab, bc, ca) = (middle(a, b), middle(b, c), middle(c, a));
            [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
        };
        faces = faces.into_iter().flat_map(four).collect();
    }
    // The bump is a function of the corner's place alone, so that neighbours agree on it to the bit.
    let bump = |p: DVec3| {
        center
            + p * (1.0
                + 0.25
                    * ((p.x * 37.0).abs().fract() - (p.y * 23.0).abs().fract() + (p.z * 51.0).abs().fract()))
    };
    faces.into_iter().map(|face| face.map(bump)).collect()
}

fn ball(plan: &Plan, case: &'static str, away: f64) -> Vec<Row> {
    let center = DVec3::new(0.663, 0.0055, -1.0) * away;
    let triangles = bumpy_ball(center);
    let mut random = Random::new(SEED);
    let inputs = (0..plan.inputs).map(|k| {
        let [a, b, _] = triangles[random.below(triangles.len())];
        let target = if k % 2 == 0 { a } else { a + (b - a) * random.unit() };
        let origin = center + vector(&mut random) * 0.1;
        let d = (target - origin).normalize();
        [origin.x, origin.y, origin.z, d.x, d.y, d.z]
    });
    let inputs: Vec<[f64; 6]> = inputs.collect();
    let subject = Subject { component: "ray and closed mesh", case, unit: "holes", work: "", bar: Some(0.0) };
    let judge = |_: &[f64; 6], hit: &Option<f64>| Verdict {
        missed: usize::from(hit.is_none()),
        ..Verdict::error(0.0)
    };
    let mut trial = Trial::new(plan, subject, inputs, judge);
    let triangles = &triangles;
    for (name, test) in VARIANTS {
        trial.run(variant(name), move |i| {
            triangles.iter().filter_map(|t| test(&line(i), *t)).reduce(f64::min)
        });
    }
    trial.run(default("watertight").note("the others leave holes between triangles"), move |i| {
        let line = line(i);
        let ray = Sheared::new(&LocalRay::new(line.origin, line.direction)?.0);
        triangles.iter().filter_map(|t| ray.meet(t.each_ref(), f64::INFINITY).map(|m| m.t)).reduce(f64::min)
    });
    trial.finish()
}
