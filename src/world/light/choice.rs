//! Which light a path asks, where it asks one of many: half by how much each would bring if nothing stood between, half evenly, so
//! that none is forgotten that does. Of very many, where none would, and where it is not known yet who is lit, half by power.

use super::{Light, Source};
use crate::math::colour::mean;
use glam::DVec3;
use std::f64::consts::PI;

/// As many lights are weighed at each point: more would take as long as the ray that asks one.
const FEW: usize = 32;

/// The share of choices that each light gets.
#[derive(Clone, Debug, Default)]
pub struct Choice {
    /// Sums of the shares up to each light; the last is 1.
    sums: Vec<f64>,
}

impl Choice {
    /// Over lights that shine on a scene of this radius.
    pub fn new(lights: &[Light], radius: f64) -> Choice {
        Choice::by(lights.iter().map(|light| light.power(radius)).collect())
    }

    /// By what each light sends, in any unit.
    pub fn by(power: Vec<f64>) -> Choice {
        let n = power.len() as f64;
        let total: f64 = power.iter().sum();
        let mut sum = 0.0;
        let sums = power.iter().map(|power| {
            sum += if total > 0.0 && total.is_finite() { (power / total + 1.0 / n) / 2.0 } else { 1.0 / n };
            sum
        });
        Choice { sums: sums.collect() }
    }

    /// Whether there is one light to choose at most.
    pub fn is_certain(&self) -> bool {
        self.sums.len() < 2
    }

    /// The light that u in (0, 1) falls on, and how often it is chosen. None where there is no light.
    pub fn pick(&self, u: f64) -> Option<(usize, f64)> {
        let last = self.sums.len().checked_sub(1)?;
        let i = self.sums.partition_point(|sum| *sum <= u).min(last);
        Some((i, self.share(i)))
    }

    /// How often a light is chosen.
    pub fn share(&self, i: usize) -> f64 {
        self.sums[i] - if i == 0 { 0.0 } else { self.sums[i - 1] }
    }

    /// The light that u in (0, 1) falls on for a point of a surface with a unit normal, and how often it is chosen there.
    pub fn pick_at(&self, lights: &[Light], at: DVec3, normal: DVec3, u: f64) -> Option<(usize, f64)> {
        let Some(shares) = Shares::at(lights, at, normal) else { return self.pick(u) };
        let (mut sum, mut chosen) = (0.0, None);
        for (i, share) in shares.of[..lights.len()].iter().enumerate().filter(|(_, share)| **share > 0.0) {
            chosen = Some((i, *share));
            sum += share;
            if u < sum {
                break;
            }
        }
        chosen
    }

    /// How often a light is chosen for a point of a surface with a unit normal.
    pub fn share_at(&self, lights: &[Light], i: usize, at: DVec3, normal: DVec3) -> f64 {
        Shares::at(lights, at, normal).map_or_else(|| self.share(i), |shares| shares.of[i])
    }
}

/// How often each of a few lights is chosen at a point. One that paths find as well by themselves is left to them where there
/// are others.
struct Shares {
    of: [f64; FEW],
}

impl Shares {
    /// None where there is nothing to choose, or too much, or nothing tells the lights apart.
    fn at(lights: &[Light], at: DVec3, normal: DVec3) -> Option<Shares> {
        if !(2..=FEW).contains(&lights.len()) {
            return None;
        }
        let (mut of, mut sum, mut n) = ([0.0; FEW], 0.0, 0.0);
        for (reach, light) in of.iter_mut().zip(lights).filter(|(_, light)| !light.is_found()) {
            *reach = light.reach(at, normal);
            sum += *reach;
            n += 1.0;
        }
        if !(sum > 0.0 && sum.is_finite()) {
            return None;
        }
        for (share, _) in of.iter_mut().zip(lights).filter(|(_, light)| !light.is_found()) {
            *share = (*share / sum + 1.0 / n) / 2.0;
        }
        Some(Shares { of })
    }
}

impl Light {
    /// About how much it sends into a scene of this radius, watts averaged over the colours. Patterns count as 1.
    fn power(&self, radius: f64) -> f64 {
        let disc = PI * radius * radius;
        match &self.source {
            Source::Point { intensity, .. } => 4.0 * PI * mean(*intensity),
            Source::Spot { cosines, intensity, .. } => {
                2.0 * PI * (1.0 - (cosines[0] + cosines[1]) / 2.0) * mean(*intensity)
            }
            Source::Sun { irradiance, .. } => disc * mean(*irradiance),
            Source::Sky { radiance } => PI * disc * mean(*radiance),
            Source::PictureSky(sky) => PI * disc * sky.mean(),
            Source::Area(area) => PI * area.area() * mean(area.typical()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Rgb;

    fn point(watts: f64) -> Light {
        let source = Source::Point { position: glam::DVec3::ZERO, intensity: Rgb::splat(watts) };
        Light::new(source, None, true, 1)
    }

    #[test]
    fn every_light_is_asked_and_the_strong_more_often() {
        let choice = Choice::new(&[point(1.0), point(3.0), point(0.0)], 1.0);
        for (i, share) in [(0, 1.0 / 8.0 + 1.0 / 6.0), (1, 3.0 / 8.0 + 1.0 / 6.0), (2, 1.0 / 6.0)] {
            assert!((choice.share(i) - share).abs() < 1e-15, "{i}: {}", choice.share(i));
        }
        assert_eq!(choice.pick(0.0).unwrap().0, 0);
        assert_eq!(choice.pick(0.9999).unwrap().0, 2);
        assert!(Choice::new(&[], 1.0).pick(0.5).is_none());
    }

    #[test]
    fn a_light_is_chosen_by_what_it_brings_to_the_point() {
        let at_height = |y: f64, watts| {
            let source = Source::Point { position: DVec3::Y * y, intensity: Rgb::splat(watts) };
            Light::new(source, None, true, 1)
        };
        // 1, 1/4, and from below 0.
        let lights = [at_height(1.0, 1.0), at_height(2.0, 1.0), at_height(-1.0, 9.0)];
        let choice = Choice::new(&lights, 1.0);
        let share = |i| choice.share_at(&lights, i, DVec3::ZERO, DVec3::Y);
        for (i, wanted) in [(0, 0.4 + 1.0 / 6.0), (1, 0.1 + 1.0 / 6.0), (2, 1.0 / 6.0)] {
            assert!((share(i) - wanted).abs() < 1e-15, "{i}: {}", share(i));
        }
        let n = 6000;
        let pick = |k: u32| {
            choice.pick_at(&lights, DVec3::ZERO, DVec3::Y, (f64::from(k) + 0.5) / f64::from(n)).unwrap()
        };
        for i in 0..3 {
            let often = (0..n).filter(|k| pick(*k).0 == i).count() as f64 / f64::from(n);
            assert!((often - share(i)).abs() < 2e-4, "{i}: {often}");
        }
        let outside = |shadow| {
            let sky = Light::new(Source::Sky { radiance: Rgb::ONE }, None, shadow, 1);
            [sky, at_height(1.0, 1.0)]
        };
        let share_of_sky =
            |lights: &[Light]| Choice::new(lights, 1.0).share_at(lights, 0, DVec3::ZERO, DVec3::Y);
        let lit = outside(true);
        assert_eq!(share_of_sky(&lit), 0.0, "paths find the sky by themselves");
        let picked = Choice::new(&lit, 1.0).pick_at(&lit, DVec3::ZERO, DVec3::Y, 1.0 - 1e-12);
        assert_eq!(picked, Some((1, 1.0)));
        assert!(share_of_sky(&outside(false)) > 0.0, "but not one that nothing stops");
        let unlit = choice.share_at(&lights, 0, DVec3::Y * 50.0, DVec3::Y);
        assert_eq!(unlit, choice.share(0), "where no light reaches, by power");
    }
}
