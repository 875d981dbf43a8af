//! Which light a path asks, where it asks one of many: half by power, half evenly, so that a dim lamp close by is not
//! forgotten.

use super::{Light, Source};
use crate::scene::Rgb;
use std::f64::consts::PI;

/// The share of choices that each light gets.
#[derive(Clone, Debug, Default)]
pub struct Choice {
    /// Sums of the shares up to each light; the last is 1.
    sums: Vec<f64>,
}

impl Choice {
    /// Over lights that shine on a scene of this radius.
    pub fn new(lights: &[Light], radius: f64) -> Choice {
        let n = lights.len() as f64;
        let power: Vec<f64> = lights.iter().map(|light| light.power(radius)).collect();
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
}

impl Light {
    /// About how much it sends into a scene of this radius, watts averaged over the colours. Patterns count as 1.
    fn power(&self, radius: f64) -> f64 {
        let disc = PI * radius * radius;
        let mean = |c: Rgb| c.element_sum() / 3.0;
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

    fn point(watts: f64) -> Light {
        let source = Source::Point { position: glam::DVec3::ZERO, intensity: Rgb::splat(watts) };
        Light { source, falloff: None, shadow: true, samples: 1 }
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
}
