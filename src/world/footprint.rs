//! How large a pixel is where: what tells how finely a surface is to be cut into triangles. All that the world knows of a camera.

use crate::math::{Aabb, Affine};
use glam::DVec3;

/// The size of a pixel by the place that it shows, never too large: `constant` + `per_distance` · distance from the eye.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Footprint {
    /// Where the camera stands.
    pub eye: DVec3,
    /// Scene units for each of distance.
    pub per_distance: f64,
    /// Scene units anywhere.
    pub constant: f64,
}

impl Footprint {
    /// The size at the point of a box that is nearest to the eye.
    pub fn at(&self, bounds: Aabb) -> f64 {
        let nearest = self.eye.clamp(bounds.min, bounds.max);
        self.constant + self.per_distance * nearest.distance(self.eye)
    }

    /// The same camera seen from the space that `transform` maps from: what is as large as a pixel after it.
    pub fn through(&self, transform: &Affine) -> Footprint {
        let (least, most) = transform.stretch();
        Footprint {
            eye: transform.inverse().point(self.eye),
            per_distance: self.per_distance * (least / most),
            constant: self.constant / most,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pixel_is_measured_in_the_units_of_the_space_it_is_seen_in() {
        let view = Footprint { eye: DVec3::new(0.0, 0.0, 10.0), per_distance: 0.01, constant: 0.0 };
        let ball = Aabb { min: DVec3::splat(-1.0), max: DVec3::splat(1.0) };
        assert!((view.at(ball) - 0.09).abs() < 1e-15);
        let map = Affine::scale(DVec3::splat(2.0))
            .then(&Affine::rotate(DVec3::X, 30.0))
            .then(&Affine::translate(DVec3::new(0.0, 0.0, -10.0)));
        let inside = view.through(&map);
        let point = Aabb::of([DVec3::ZERO]);
        // The origin is 20 from the eye, where a pixel is 0.2 wide: half of it before the map doubled it.
        assert!((inside.at(point) - 0.1).abs() < 1e-12, "{}", inside.at(point));
        let squeezed = view.through(&Affine::scale(DVec3::new(4.0, 1.0, 1.0)));
        assert!(squeezed.at(point) <= 0.1 / 4.0 + 1e-12);
        let flat = Footprint { eye: DVec3::ZERO, per_distance: 0.0, constant: 0.5 };
        assert_eq!(flat.at(ball), 0.5);
    }
}
