//! What is known of the light at a place, and how far from there it is worth something: Ward, Rubinstein & Clear, *A Ray Tracing
//! Solution for Diffuse Interreflection* (1988). Knows nothing of how it was found.

use super::hemisphere::Gathered;
use crate::math::colour::mean;
use crate::scene::Rgb;
use glam::DVec3;

/// Irradiance by light that other matt surfaces sent, at a place.
#[derive(Clone, Debug)]
pub struct Record {
    /// Where it was found, and for whom it holds.
    pub place: Place,
    gathered: Gathered,
    /// The length by which errors of place are measured, if it were not for [`Record::least`].
    radius: f64,
    /// The length that it is at least.
    least: f64,
}

/// A place on a surface.
#[derive(Clone, Copy, Debug)]
pub struct Place {
    /// Where.
    pub point: DVec3,
    /// Unit normal on the side that is lit.
    pub normal: DVec3,
    /// Segments of a path from the camera to there; the same for all paths where their number has no end.
    pub segment: u32,
}

/// A record does not tell of a place that lies off both surfaces by more than this sine, 12°: what is in front of the one is not
/// lit as the other is.
const MOST_OFF: f64 = 0.2;

impl Record {
    /// What was gathered at a place, which holds for lengths between these two. None where it is not finite.
    pub fn new(place: Place, gathered: Gathered, [least, most]: [f64; 2]) -> Option<Record> {
        let Gathered { irradiance, by_turning, by_moving, mean_distance, .. } = gathered;
        // A step of the radius shall not take away more light than there is. 0/0 says nothing, and `min` drops it.
        let radius = mean_distance.min(mean(irradiance) / by_moving.steepest()).min(most);
        let finite = irradiance.is_finite() && by_turning.is_finite() && by_moving.is_finite();
        (finite && radius >= 0.0).then_some(Record { place, gathered, radius, least })
    }

    /// The length by which errors of place are measured.
    pub fn radius(&self) -> f64 {
        self.radius.max(self.least)
    }

    /// Makes two records agree on how near other surfaces are: the nearest of one is not farther from the other than by the
    /// way between them (Křivánek et al., *Making Radiance and Irradiance Caching Practical*, 2006).
    pub fn clamp_to(&mut self, other: &Record) {
        self.radius = self.radius.min(other.radius + self.place.point.distance(other.place.point));
    }

    /// How wrong the record may be at a place, 0 at its own; infinite where it must not be asked.
    pub fn error(&self, at: &Place) -> f64 {
        let step = at.point - self.place.point;
        let distance = step.length();
        let off = step.dot(at.normal + self.place.normal) / 2.0;
        if at.segment != self.place.segment || off.abs() > MOST_OFF * distance {
            return f64::INFINITY;
        }
        distance / self.radius() + (1.0 - at.normal.dot(self.place.normal)).max(0.0).sqrt()
    }

    /// True where other surfaces stand within so many radii, so that one may stand between.
    pub fn is_tight(&self, reach: f64) -> bool {
        2.0 * reach * self.radius() > self.gathered.nearest
    }

    /// The irradiance at a place nearby.
    pub fn told(&self, at: &Place) -> Rgb {
        // Where the radius was lengthened, the slope is kept from taking more than there is.
        let kept = if self.radius < self.least { self.radius / self.least } else { 1.0 };
        let moved = self.gathered.by_moving.along(at.point - self.place.point) * kept;
        let turned = self.gathered.by_turning.along(at.normal - self.place.normal);
        (self.gathered.irradiance + moved + turned).max(Rgb::ZERO)
    }
}

#[cfg(test)]
mod tests {
    use super::super::hemisphere::Gradient;
    use super::*;
    use crate::math::elementary::log2;
    use std::f64::consts::PI;

    fn at(point: DVec3, normal: DVec3) -> Place {
        Place { point, normal: normal.normalize(), segment: 1 }
    }

    fn record(place: Place, irradiance: f64, slope: f64, radius: f64) -> Record {
        let mut by_moving = Gradient::default();
        by_moving.add(DVec3::X, Rgb::splat(slope));
        let gathered = Gathered {
            irradiance: Rgb::splat(irradiance),
            by_turning: Gradient::default(),
            by_moving,
            mean_distance: radius,
            nearest: radius,
        };
        Record::new(place, gathered, [0.0, f64::INFINITY]).expect("finite numbers")
    }

    #[test]
    fn a_record_does_not_hold_in_front_across_an_edge_or_on_the_other_side() {
        let up = record(at(DVec3::ZERO, DVec3::Z), 1.0, 0.0, 1.0);
        assert!(up.error(&at(0.1 * DVec3::X, DVec3::Z)) < 0.11);
        for (point, normal, least) in [
            (DVec3::new(0.1, 0.0, 0.05), DVec3::Z, f64::INFINITY),
            (DVec3::new(0.1, 0.0, -0.05), DVec3::Z, f64::INFINITY),
            (DVec3::ZERO, -DVec3::Z, 1.4),
            (DVec3::new(0.0, 0.0, -1e-3), -DVec3::Z, 1.4),
            (0.01 * DVec3::X, DVec3::X, 1.0),
        ] {
            assert!(up.error(&at(point, normal)) >= least, "{point} {normal}");
        }
        // All places of a ball are beside each other.
        let east = DVec3::new(0.3, 0.0, 1.0).normalize();
        let of_ball = record(at(DVec3::Z, DVec3::Z), 1.0, 0.0, 1.0);
        assert!(of_ball.error(&at(east, east)) < 0.6);
        assert_eq!(up.error(&Place { segment: 2, ..up.place }), f64::INFINITY);
    }

    #[test]
    fn neighbours_agree_on_how_near_other_surfaces_are() {
        let mut far = record(at(DVec3::ZERO, DVec3::Z), 1.0, 0.0, 5.0);
        let near = record(at(0.5 * DVec3::X, DVec3::Z), 1.0, 0.0, 0.2);
        far.clamp_to(&near);
        assert_eq!(far.radius(), 0.7);
    }

    #[test]
    fn a_slope_takes_no_more_than_there_is() {
        let steep = record(at(DVec3::ZERO, DVec3::Z), 1.0, 10.0, 1.0);
        assert!((steep.radius() - 0.1).abs() < 1e-12);
        assert_eq!(steep.told(&at(-0.2 * DVec3::X, DVec3::Z)), Rgb::ZERO);
    }

    /// The error of what is interpolated on a floor under an even sky before a wall of height 1, from records at about this distance,
    /// with their slopes or without.
    fn error(spacing: f64, slopes: f64) -> f64 {
        let length = |d: f64| (d * d + 1.0).sqrt();
        let light = |d: f64| PI * 0.5 * (1.0 + d / length(d));
        let slope = |d: f64| PI * 0.5 / (length(d) * length(d) * length(d));
        let n = (2.5 / spacing).round() as i32;
        let records: Vec<Record> = (0..n)
            // Not even: between even ones errors of first order cancel.
            .map(|i| 0.1 + spacing * (f64::from(i) + 0.8 * (0.618_034 * f64::from(i)).fract()))
            .map(|d| record(at(d * DVec3::X, DVec3::Z), light(d), slopes * slope(d), 2.0 * spacing))
            .collect();
        let off = |d: f64| {
            let place = at(d * DVec3::X, DVec3::Z);
            let weighed = |r: &Record| (1.0 - r.error(&place)).max(0.0);
            let weights: f64 = records.iter().map(weighed).sum();
            let told: f64 = records.iter().map(|r| weighed(r) * r.told(&place).x).sum();
            told / weights / light(d) - 1.0
        };
        let squares = (0..1000).map(|i| off(0.5 + f64::from(i) * 1.5e-3)).map(|e| e * e);
        (squares.sum::<f64>() / 1000.0).sqrt()
    }

    #[test]
    fn slopes_make_the_error_fall_as_the_square_of_the_spacing() {
        let falls = |slopes: f64| log2(error(0.1, slopes) / error(0.0125, slopes)) / 3.0;
        assert!(falls(0.0) > 0.9 && falls(0.0) < 1.2, "without: {}", falls(0.0));
        assert!(falls(1.0) > 1.8, "with: {}", falls(1.0));
        assert!(error(0.1, 1.0) < 2e-3 && error(0.0125, 1.0) < 0.1 * error(0.0125, 0.0));
        // The slope that points the other way is worse than none.
        assert!(error(0.1, -1.0) > 1.5 * error(0.1, 0.0));
    }
}
