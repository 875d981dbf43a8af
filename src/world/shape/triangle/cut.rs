//! What lies of a triangle in a box: the triangle cut by the box's six planes. Knows no ray.

use crate::math::Aabb;
use crate::math::error::gamma;
use glam::DVec3;

/// Roundings of a corner cut out by six planes, each a difference, a quotient, a product and a sum, and those of the box handed in.
const ROUNDING: f64 = gamma(64);

/// Corners of a triangle cut by six planes.
const MOST: usize = 9;

/// A convex polygon.
struct Polygon {
    corners: [DVec3; MOST],
    len: usize,
}

impl Polygon {
    fn of([a, b, c]: [DVec3; 3]) -> Polygon {
        let mut polygon = Polygon { corners: [a; MOST], len: 3 };
        (polygon.corners[1], polygon.corners[2]) = (b, c);
        polygon
    }

    fn corners(&self) -> &[DVec3] {
        &self.corners[..self.len]
    }

    fn push(&mut self, p: DVec3) {
        if let Some(free) = self.corners.get_mut(self.len) {
            *free = p;
            self.len += 1;
        }
    }

    /// What lies where `sign` times the coordinate is at most `sign` times the plane's (Sutherland & Hodgman 1974).
    fn cut(&self, axis: usize, plane: f64, sign: f64) -> Polygon {
        let mut kept = Polygon { corners: [DVec3::ZERO; MOST], len: 0 };
        let beyond = |p: DVec3| sign * (p[axis] - plane);
        for (i, &p) in self.corners().iter().enumerate() {
            let q = self.corners()[(i + 1) % self.len];
            let (from, to) = (beyond(p), beyond(q));
            if from <= 0.0 {
                kept.push(p);
            }
            if (from < 0.0 && to > 0.0) || (from > 0.0 && to < 0.0) {
                let mut at = p + (q - p) * (from / (from - to));
                at[axis] = plane;
                kept.push(at);
            }
        }
        kept
    }
}

/// A box around what lies of a triangle in a box, larger by a few ulps of the coordinates of both; empty where nothing does.
pub fn cut(corners: [DVec3; 3], cell: &Aabb) -> Aabb {
    let size = |b: &Aabb| b.min.abs().max(b.max.abs()).max_element();
    let whole = Aabb::of(corners);
    let margin = DVec3::splat(ROUNDING * size(&whole).max(size(cell)));
    let cell = Aabb { min: cell.min - margin, max: cell.max + margin };
    let mut polygon = Polygon::of(corners);
    for axis in 0..3 {
        if whole.min[axis] < cell.min[axis] {
            polygon = polygon.cut(axis, cell.min[axis], -1.0);
        }
        if whole.max[axis] > cell.max[axis] {
            polygon = polygon.cut(axis, cell.max[axis], 1.0);
        }
    }
    let inside = Aabb::of(polygon.corners().iter().copied());
    Aabb { min: inside.min - margin, max: inside.max + margin }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::random::Random;

    #[test]
    fn a_triangle_is_cut_to_what_lies_in_the_box() {
        let corners = [DVec3::ZERO, DVec3::X * 4.0, DVec3::Y * 4.0];
        let cell = Aabb { min: DVec3::new(1.0, 1.0, -1.0), max: DVec3::new(9.0, 9.0, 1.0) };
        let inside = cut(corners, &cell);
        assert!((inside.min - DVec3::new(1.0, 1.0, 0.0)).abs().max_element() < 1e-12, "{inside:?}");
        assert!((inside.max - DVec3::new(3.0, 3.0, 0.0)).abs().max_element() < 1e-12, "{inside:?}");
        // Its box meets this cell, it does not.
        let corner = Aabb { min: DVec3::new(2.5, 2.5, -1.0), max: DVec3::new(9.0, 9.0, 1.0) };
        assert!(cut(corners, &corner).is_empty());
    }

    #[test]
    fn no_point_of_a_triangle_is_cut_away_from_its_cell() {
        let mut random = Random::new(7);
        let mut point =
            |size: f64| DVec3::from_array(std::array::from_fn(|_| (random.unit() * 2.0 - 1.0) * size));
        let mut inside = 0;
        for round in 0..3000 {
            let offset = if round % 2 == 0 { DVec3::ZERO } else { DVec3::new(1e5, -3.0, 1e3) };
            let thin = if round % 3 == 0 { 1e-9 } else { 1.0 };
            let (a, ab) = (offset + point(1.0), point(1.0));
            let corners = [a, a + ab, a + ab * 0.4 + point(thin)];
            let middle = offset + point(0.5);
            let half = point(0.6).abs();
            let cell = Aabb { min: middle - half, max: middle + half };
            let kept = cut(corners, &cell);
            for _ in 0..20 {
                let shares = point(0.5) + 0.5;
                let shares = shares / shares.element_sum();
                let p = corners[0] * shares.x + corners[1] * shares.y + corners[2] * shares.z;
                let holds = |b: &Aabb| p.cmpge(b.min).all() && p.cmple(b.max).all();
                if holds(&cell) {
                    inside += 1;
                    assert!(holds(&kept), "round {round}: {p} of {corners:?} in {cell:?}, {kept:?}");
                }
            }
        }
        assert!(inside > 1000, "{inside}");
    }
}
