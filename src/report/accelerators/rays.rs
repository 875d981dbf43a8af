//! One mesh asked about sets of rays, and another program's answers judged beside ours. Knows neither files nor the clock: whoever compares
//! programs holds it for all of them.

use super::subject::{Line, Subject};
use crate::world::packet::RAYS;
use glam::Vec3;
use std::ops::Range;

/// A ray as files hold it: from where, to where (of any length), and how far in lengths of its direction.
pub type RawRay = [f32; 7];

/// What a ray met: how far, and which triangle; none where nothing. Of any meeting the distance and triangle mean nothing.
pub type Answer = Option<(f32, u32)>;

/// Rays, and what each met when it was asked last.
pub struct RaySet {
    /// True where any meeting will do.
    pub any: bool,
    rays: Vec<Line>,
    answers: Vec<Answer>,
}

/// How another's answers differ from ours, and which of both a test of every triangle says.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Verdict {
    /// Rays that met something with us and nothing with them.
    pub lost: usize,
    /// Rays that met nothing with us.
    pub made_up: usize,
    /// Rays that met another triangle.
    pub other: usize,
    /// So many of all these were judged.
    pub judged: usize,
    /// So often we said what the test says.
    pub ours: usize,
    /// So often they did.
    pub theirs: usize,
}

impl RaySet {
    /// Rays that have not been asked.
    pub fn new(rays: &[RawRay], any: bool) -> RaySet {
        RaySet { any, answers: vec![None; rays.len()], rays: rays.iter().map(line).collect() }
    }

    /// How many rays there are.
    pub fn len(&self) -> usize {
        self.rays.len()
    }

    /// True without rays.
    pub fn is_empty(&self) -> bool {
        self.rays.is_empty()
    }

    /// By ray.
    pub fn answers(&self) -> &[Answer] {
        &self.answers
    }

    /// Asks some of them, one after another.
    pub fn ask(&mut self, subject: &Subject<'_>, some: Range<usize>) {
        for (ray, answer) in self.rays[some.clone()].iter().zip(&mut self.answers[some]) {
            *answer = subject.meet(ray, self.any).map(|(t, triangle)| (t as f32, triangle));
        }
    }

    /// Asks some of them what they meet first, as many together as a packet has.
    pub fn ask_together(&mut self, subject: &Subject<'_>, some: Range<usize>) {
        let answers = self.answers[some.clone()].chunks_mut(RAYS);
        for (rays, answers) in self.rays[some].chunks(RAYS).zip(answers) {
            subject.meet_each(rays, |i, met| answers[i] = met.map(|(t, triangle)| (t as f32, triangle)));
        }
    }

    /// How `theirs` differ. `every` is the list of all triangles, by which about so many as `most` of those that differ are judged, evenly
    /// chosen: right is who says rightly that there is something, and names a triangle that is as near as any.
    pub fn judge(&self, theirs: &[Option<u32>], every: &Subject<'_>, most: usize) -> Verdict {
        let ours = |i: usize| self.answers[i].map(|(_, triangle)| triangle);
        let differs = |i: &usize| match self.any {
            true => ours(*i).is_some() != theirs[*i].is_some(),
            false => ours(*i) != theirs[*i],
        };
        let off: Vec<usize> = (0..self.len().min(theirs.len())).filter(differs).collect();
        let mut verdict = Verdict::default();
        for &i in &off {
            match (ours(i), theirs[i]) {
                (_, None) => verdict.lost += 1,
                (None, _) => verdict.made_up += 1,
                (Some(_), Some(_)) => verdict.other += 1,
            }
        }
        for &i in off.iter().step_by(off.len().div_ceil(most.max(1)).max(1)) {
            let line = &self.rays[i];
            let truth = every.meet(line, false).map(|(t, _)| t);
            let is_right = |answer: Option<u32>| match answer {
                Some(triangle) if !self.any => truth.is_some() && every.distance_to(line, triangle) == truth,
                _ => answer.is_some() == truth.is_some(),
            };
            verdict.judged += 1;
            verdict.ours += usize::from(is_right(ours(i)));
            verdict.theirs += usize::from(is_right(theirs[i]));
        }
        verdict
    }
}

fn line(&[x, y, z, dx, dy, dz, t_max]: &RawRay) -> Line {
    Line {
        origin: Vec3::new(x, y, z).as_dvec3(),
        direction: Vec3::new(dx, dy, dz).as_dvec3(),
        t_max: t_max.into(),
    }
}

#[cfg(test)]
mod tests {
    use super::super::meshes::procedural;
    use super::super::subject::Builder;
    use super::*;

    /// Ninety rays down onto hills, and one beside them.
    fn asked(any: bool) -> RaySet {
        let mesh = procedural("hills", 200).expect("a kind");
        let ray = |i: usize| [0.013 * i as f32 - 0.61, 2.0, 0.007 * i as f32 - 0.33, 0.0, -1.0, 0.0, 9.0];
        let mut rays: Vec<RawRay> = (0..90).map(ray).collect();
        rays.push([7.0, 2.0, 0.0, 0.0, -1.0, 0.0, 9.0]);
        let mut set = RaySet::new(&rays, any);
        set.ask(&Subject::new(&mesh, Builder::Bvh), 0..91);
        set
    }

    fn verdict(set: &RaySet, spoil: impl FnOnce(&mut [Option<u32>])) -> Verdict {
        let mesh = procedural("hills", 200).expect("a kind");
        let mut theirs: Vec<_> = set.answers().iter().map(|answer| answer.map(|(_, i)| i)).collect();
        spoil(&mut theirs);
        set.judge(&theirs, &Subject::new(&mesh, Builder::List), 100)
    }

    #[test]
    fn who_says_the_same_differs_nowhere() {
        let set = asked(false);
        assert_eq!(set.answers().iter().filter(|answer| answer.is_none()).count(), 1);
        assert_eq!(verdict(&set, |_| ()), Verdict::default());
    }

    #[test]
    fn planted_faults_are_told_apart_and_judged_for_us() {
        let found = verdict(&asked(false), |theirs| {
            theirs[3] = None;
            theirs[5] = Some(theirs[40].expect("a meeting"));
            theirs[90] = Some(0);
        });
        assert_eq!(found, Verdict { lost: 1, made_up: 1, other: 1, judged: 3, ours: 3, theirs: 0 });
    }

    #[test]
    fn our_own_faults_are_judged_for_them() {
        let mut set = asked(false);
        let truth: Vec<_> = set.answers().iter().map(|answer| answer.map(|(_, i)| i)).collect();
        (set.answers[3], set.answers[90]) = (None, Some((1.0, 0)));
        let found = verdict(&set, |theirs| theirs.copy_from_slice(&truth));
        assert_eq!(found, Verdict { lost: 1, made_up: 1, other: 0, judged: 2, ours: 0, theirs: 2 });
    }

    #[test]
    fn where_any_will_do_the_triangle_does_not_matter() {
        let set = asked(true);
        assert_eq!(verdict(&set, |theirs| theirs[5] = Some(0)), Verdict::default());
        let found = verdict(&set, |theirs| theirs[5] = None);
        assert_eq!(found, Verdict { lost: 1, judged: 1, ours: 1, ..Verdict::default() });
    }
}
