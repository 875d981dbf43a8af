//! A point that two bones share (each as two of half the weight): the first stays, the second is stretched and turned about its own x. Input: the
//! turn, degrees; the second's weight; the point (or a normal) from the bones; where those are; the stretch; by how much the second is tilted
//! about z at rest, degrees. Truth: the share of the turn that the weight is; at rest the point itself; of one bone the product of its motions.

use super::{SEED, ulp};
use crate::geometry::skin::{Blend, Motion};
use crate::math::elementary::hypot;
use crate::math::random::Random;
use crate::math::{Affine, Point};
use crate::report::naive::skins::{Dual, by_duals, by_matrices, normal_by_duals, normal_by_matrices};
use crate::report::row::Row;
use crate::report::trial::{Label, Link, Plan, Subject, Trial, Verdict, default, variant};
use glam::DVec3;
use std::hint::black_box;
use std::sync::Arc;

type Input = [f64; 12];

/// An input by its parts.
#[derive(Clone, Copy)]
struct Case {
    turn: f64,
    weight: f64,
    subject: DVec3,
    at: DVec3,
    stretch: DVec3,
    tilt: f64,
}

struct Set {
    name: &'static str,
    unit: &'static str,
    bar: f64,
    draw: fn(&mut Random) -> Case,
    of: Of,
    error: fn(&Case, DVec3) -> f64,
}

#[derive(Clone, Copy, PartialEq)]
enum Of {
    Points,
    Normals,
}

const SETS: [Set; 6] = [
    Set {
        name: "twisted by up to half a turn",
        unit: "of the radius",
        bar: 1.0,
        draw: |r| twisted(r, 1.0, 179.9),
        of: Of::Points,
        error: off_the_twist,
    },
    Set {
        name: "twisted by more than half a turn",
        unit: "of the radius",
        bar: 2.0,
        draw: |r| twisted(r, 180.1, 359.0),
        of: Of::Points,
        error: off_the_twist,
    },
    Set {
        name: "radius of a half twist",
        unit: "of the radius",
        bar: 1.0,
        draw: |r| Case { weight: 0.5, ..twisted(r, 1.0, 179.9) },
        of: Of::Points,
        error: |case, p| (radius(p - case.at) / radius(case.subject) - 1.0).abs(),
    },
    Set {
        name: "at rest, far from the origin",
        unit: "ulp of the place",
        bar: 0.0,
        draw: at_rest,
        of: Of::Points,
        error: |case, p| Point::max_abs(p - case.place()) / ulp(Point::max_abs(case.place())),
    },
    Set {
        name: "by one bone that is stretched",
        unit: "of the distance",
        bar: 1e-13,
        draw: stretched,
        of: Of::Points,
        error: |case, p| p.distance(case.motion().point(case.place())) / case.subject.length(),
    },
    Set {
        name: "normals by one bone that is stretched",
        unit: "radians",
        bar: 1e-12,
        draw: |r| Case { subject: direction(r), ..stretched(r) },
        of: Of::Normals,
        error: |case, n| n.distance(case.outward()),
    },
];

/// Trials of skinning.
pub fn rows(plan: &Plan) -> Vec<Row> {
    SETS.iter().flat_map(|set| trial(plan, set)).collect()
}

impl Case {
    fn of(i: &Input) -> Case {
        let v = |k: usize| DVec3::new(i[k], i[k + 1], i[k + 2]);
        Case { turn: i[0], weight: i[1], subject: v(2), at: v(5), stretch: v(8), tilt: i[11] }
    }

    fn input(&self) -> Input {
        let (p, o, s) = (self.subject, self.at, self.stretch);
        [self.turn, self.weight, p.x, p.y, p.z, o.x, o.y, o.z, s.x, s.y, s.z, self.tilt]
    }

    fn place(&self) -> DVec3 {
        self.at + self.subject
    }

    fn weights(&self) -> [f64; 4] {
        let (first, second) = ((1.0 - self.weight) / 2.0, self.weight / 2.0);
        [first, second, first, second]
    }

    /// Where the second bone is at rest, and in the pose.
    fn bone(&self) -> [Affine; 2] {
        let tilted = Affine::rotate(DVec3::Z, self.tilt);
        let moved = Affine::scale(self.stretch).then(&tilted).then(&Affine::rotate(DVec3::X, self.turn));
        [tilted, moved].map(|bone| bone.then(&Affine::translate(self.at)))
    }

    fn motion(&self) -> Affine {
        let [rest, pose] = self.bone();
        rest.inverse().then(&pose)
    }

    fn matrices(&self) -> [Affine; 4] {
        [Affine::IDENTITY, self.motion(), Affine::IDENTITY, self.motion()]
    }

    fn motions(&self) -> [Motion; 4] {
        let still = Affine::translate(self.at);
        let [rest, pose] = self.bone();
        let (first, second) = (Motion::new(&still, &still), Motion::new(&rest, &pose));
        [first, second, first, second]
    }

    /// The subject as a normal, after the motion: mirrors do not turn the surface inside out.
    fn outward(&self) -> DVec3 {
        let motion = self.motion();
        motion.normal(self.subject).normalize() * motion.linear.determinant().signum()
    }
}

/// The distance from the axis of the twist.
fn radius(p: DVec3) -> f64 {
    hypot(p.y, p.z)
}

fn off_the_twist(case: &Case, p: DVec3) -> f64 {
    let truth = Affine::rotate(DVec3::X, case.turn * case.weight).point(case.subject);
    (p - case.at).distance(truth) / radius(case.subject)
}

fn direction(r: &mut Random) -> DVec3 {
    loop {
        let v = DVec3::from_array([(); 3].map(|()| r.between(-1.0, 1.0)));
        if (0.01..1.0).contains(&v.length_squared()) {
            return v.normalize();
        }
    }
}

/// One unit from the bones in some direction, but not on the axis of the twist.
fn twisted(r: &mut Random, least: f64, most: f64) -> Case {
    let around = direction(r);
    let subject = DVec3::new(r.between(-1.0, 1.0), around.y, around.z);
    let turn = r.between(least, most);
    Case { turn, weight: r.unit(), subject, at: direction(r), stretch: DVec3::ONE, tilt: 0.0 }
}

fn at_rest(r: &mut Random) -> Case {
    let at = direction(r) * r.between(1e5, 1e7);
    Case { turn: 0.0, at, tilt: r.between(-180.0, 180.0), ..twisted(r, 0.0, 0.0) }
}

/// One bone alone, stretched otherwise along each of its axes, and mirrored or not.
fn stretched(r: &mut Random) -> Case {
    let stretch = DVec3::from_array([(); 3].map(|()| r.sign() * r.between(0.2, 4.0)));
    Case { weight: 1.0, stretch, tilt: r.between(-180.0, 180.0), ..twisted(r, -150.0, 150.0) }
}

fn trial(plan: &Plan, set: &'static Set) -> Vec<Row> {
    let mut random = Random::new(SEED);
    let inputs: Vec<Input> = (0..plan.inputs).map(|_| (set.draw)(&mut random).input()).collect();
    let cases: Arc<[Case]> = inputs.iter().map(Case::of).collect();
    let subject = Subject { component: "skin", case: set.name, unit: set.unit, work: "", bar: Some(set.bar) };
    let judge = |input: &Input, moved: &DVec3| Verdict::error((set.error)(&Case::of(input), *moved));
    let mut trial = Trial::new(plan, subject, inputs, judge);
    let is_point = set.of == Of::Points;
    run(&mut trial, variant("matrices averaged"), &cases, Case::matrices, move |m, w, case| match is_point {
        true => by_matrices(m, w, case.place()),
        false => normal_by_matrices(m, w, case.subject),
    });
    let duals = |case: &Case| case.matrices().map(|motion| Dual::new(&motion));
    run(&mut trial, variant("rigid dual quaternions"), &cases, duals, move |m, w, case| match is_point {
        true => by_duals(m, w, case.place()),
        false => normal_by_duals(m, w, case.subject),
    });
    let why = "what glTF means, and the faster one; where a twist must keep its radius, ask for the other";
    for (label, blend) in [
        (default("linear").note(why), Blend::Linear),
        (variant("dual quaternions after stretch"), Blend::DualQuaternion),
    ] {
        run(&mut trial, label, &cases, Case::motions, move |m, w, case| {
            let moved = blend.apply(m, (&[0, 1, 2, 3], w), case.place());
            if is_point { moved.point } else { moved.normal(case.subject) }
        });
    }
    trial.finish()
}

/// A variant. Timed are all points by the bones of the first, which are prepared before: many vertices share them.
fn run<'a, M: Clone + 'a>(
    trial: &mut Trial<'a, 12, DVec3>,
    label: Label,
    cases: &Arc<[Case]>,
    prepare: impl Fn(&Case) -> [M; 4],
    blend: impl Fn(&[M; 4], &[f64; 4], &Case) -> DVec3 + Clone + 'a,
) {
    let Some(bones) = cases.first().map(&prepare) else { return };
    let weighted: Vec<(Case, [f64; 4])> = cases.iter().map(|case| (*case, case.weights())).collect();
    let (timed, linked, chain, link) = (blend.clone(), blend.clone(), weighted.clone(), Link::new());
    let same = bones.clone();
    let in_turn = move || {
        chain.iter().fold(0.0, |before, (case, w)| {
            let mut case = *case;
            case.subject.x = link.after(before, case.subject.x);
            linked(black_box(&same), w, &case).x
        })
    };
    let work = move || weighted.iter().map(|(case, w)| timed(black_box(&bones), w, case).x).sum();
    let solve = |input: &Input| {
        let case = Case::of(input);
        blend(&prepare(&case), &case.weights(), &case)
    };
    trial.run_timed(label, cases.len(), solve, work);
    trial.chain(label, cases.len(), in_turn);
}
