//! Rays against shapes by the formulas of textbooks. Distances are in units of the direction's length; only those ahead count.

use super::roots::{Found, ferrari};
use glam::DVec3;

/// A half-line.
#[derive(Clone, Copy, Debug)]
pub struct Line {
    /// Where it starts.
    pub origin: DVec3,
    /// Where it goes, of any length.
    pub direction: DVec3,
}

/// The nearer of two distances that lies ahead.
fn ahead(near: f64, far: f64) -> Option<f64> {
    if near > 0.0 {
        Some(near)
    } else if far > 0.0 {
        Some(far)
    } else {
        None
    }
}

/// A sphere around 0 by b² − 4ac.
pub fn sphere_quadratic(line: &Line, radius: f64) -> Option<f64> {
    let (o, d) = (line.origin, line.direction);
    let (a, b, c) = (d.dot(d), 2.0 * o.dot(d), o.dot(o) - radius * radius);
    let disc = b * b - 4.0 * a * c;
    if disc < 0.0 {
        return None;
    }
    ahead((-b - disc.sqrt()) / (2.0 * a), (-b + disc.sqrt()) / (2.0 * a))
}

/// A sphere around 0 by the point nearest to the centre: the foot ± half the chord, from l² − r².
pub fn sphere_geometric(line: &Line, radius: f64) -> Option<f64> {
    let (o, d) = (line.origin, line.direction);
    let a = d.dot(d);
    let foot = -o.dot(d) / a;
    let l2 = o.dot(o) - foot * foot * a;
    let room = radius * radius - l2;
    if room < 0.0 {
        return None;
    }
    let half = (room / a).sqrt();
    ahead(foot - half, foot + half)
}

/// A sphere around 0 after Haines, Günther and Akenine-Möller: the discriminant from |f − (f·d)d|, the stable pair of roots.
pub fn sphere_haines(line: &Line, radius: f64) -> Option<f64> {
    let (f, d) = (line.origin, line.direction);
    let a = d.dot(d);
    let b = -f.dot(d);
    let l = f + d * (b / a);
    let disc = radius * radius - l.dot(l);
    if disc < 0.0 {
        return None;
    }
    let q = b + (a * disc).sqrt().copysign(b);
    let c = f.dot(f) - radius * radius;
    let (x, y) = (c / q, q / a);
    ahead(x.min(y), x.max(y))
}

/// The plane n·p = offset.
pub fn plane(line: &Line, normal: DVec3, offset: f64) -> Option<f64> {
    let t = (offset - normal.dot(line.origin)) / normal.dot(line.direction);
    (t > 0.0).then_some(t)
}

/// Cramer's rule for o + td = a + β(b − a) + γ(c − a), its determinants written out.
pub fn triangle_cramer(line: &Line, [a, b, c]: [DVec3; 3]) -> Option<f64> {
    let (e, f, g) = (a - b, a - c, line.direction);
    let h = a - line.origin;
    let det = |x: DVec3, y: DVec3, z: DVec3| x.dot(y.cross(z));
    let whole = det(e, f, g);
    let (beta, gamma, t) = (det(h, f, g) / whole, det(e, h, g) / whole, det(e, f, h) / whole);
    (beta >= 0.0 && gamma >= 0.0 && beta + gamma <= 1.0 && t > 0.0).then_some(t)
}

/// Möller and Trumbore 1997, without its epsilon.
pub fn triangle_moller_trumbore(line: &Line, [a, b, c]: [DVec3; 3]) -> Option<f64> {
    let (e, f) = (b - a, c - a);
    let p = line.direction.cross(f);
    let inverse = 1.0 / e.dot(p);
    let s = line.origin - a;
    let u = s.dot(p) * inverse;
    if !(0.0..=1.0).contains(&u) {
        return None;
    }
    let q = s.cross(e);
    let v = line.direction.dot(q) * inverse;
    let t = f.dot(q) * inverse;
    (v >= 0.0 && u + v <= 1.0 && t > 0.0).then_some(t)
}

/// Coefficients of the quartic of a torus around z at the ray's own origin.
pub fn torus_quartic(line: &Line, major: f64, minor: f64) -> [f64; 5] {
    let (o, d) = (line.origin, line.direction);
    let (a, b) = (d.dot(d), o.dot(d));
    let k = o.dot(o) + major * major - minor * minor;
    let four = 4.0 * major * major;
    [
        k * k - four * (o.x * o.x + o.y * o.y),
        4.0 * b * k - 2.0 * four * (o.x * d.x + o.y * d.y),
        4.0 * b * b + 2.0 * a * k - four * (d.x * d.x + d.y * d.y),
        4.0 * a * b,
        a * a,
    ]
}

/// The nearest meeting with that torus by Ferrari's formula.
pub fn torus_ferrari(line: &Line, major: f64, minor: f64) -> Option<f64> {
    nearest(&ferrari(&torus_quartic(line, major, minor)))
}

/// The same quartic, its roots by intervals.
pub fn torus_origin(line: &Line, major: f64, minor: f64) -> Option<f64> {
    nearest(&Found::of(&crate::math::solve::roots_of(&torus_quartic(line, major, minor))))
}

fn nearest(roots: &[f64]) -> Option<f64> {
    roots.iter().copied().find(|t| *t > 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn formulas_are_right_where_nothing_is_hard() {
        let line = Line { origin: DVec3::new(0.0, 0.0, -5.0), direction: DVec3::Z };
        for sphere in [sphere_quadratic, sphere_geometric, sphere_haines] {
            assert_eq!(sphere(&line, 1.0), Some(4.0));
            assert_eq!(sphere(&Line { direction: -DVec3::Z, ..line }, 1.0), None);
        }
        assert_eq!(plane(&line, DVec3::Z, 1.0), Some(6.0));
        let corners = [DVec3::new(-1.0, -1.0, 0.0), DVec3::new(2.0, -1.0, 0.0), DVec3::new(-1.0, 2.0, 0.0)];
        assert_eq!(triangle_cramer(&line, corners), Some(5.0));
        assert_eq!(triangle_moller_trumbore(&line, corners), Some(5.0));
        let line = Line { origin: DVec3::new(-5.0, 0.0, 0.0), direction: DVec3::X };
        for torus in [torus_ferrari, torus_origin] {
            assert!((torus(&line, 1.0, 0.25).unwrap() - 3.75).abs() < 1e-9);
        }
    }
}
