//! One bicubic piece in Bézier form: value, partial derivatives, normal, curvature, parts. Knows nothing of grids, rays or meshes.

use crate::geometry::basis::bernstein;
use crate::geometry::curve::evaluate::{self, Local, compensated};
use crate::math::{Aabb, Dd};
use glam::DVec3;

/// 4 × 4 control points: the first index goes with u, the second with v. Over [0, 1]².
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bicubic {
    /// `points[i][j]`.
    pub points: [[DVec3; 4]; 4],
}

/// The four boundary curves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Edge {
    /// u = 0, along v.
    StartU,
    /// u = 1, along v.
    EndU,
    /// v = 0, along u.
    StartV,
    /// v = 1, along u.
    EndV,
}

/// Position and partial derivatives, per unit of u and v.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Jet {
    /// The point.
    pub point: DVec3,
    /// ∂/∂u.
    pub du: DVec3,
    /// ∂/∂v.
    pub dv: DVec3,
    /// ∂²/∂u².
    pub duu: DVec3,
    /// ∂²/∂u∂v.
    pub duv: DVec3,
    /// ∂²/∂v².
    pub dvv: DVec3,
}

/// How a surface bends at a point; signs are as seen from the side of the normal: a sphere with its normals outward has mean −1/r.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Curvature {
    /// K, per scene unit squared.
    pub gaussian: f64,
    /// H, per scene unit.
    pub mean: f64,
}

impl Curvature {
    /// The principal curvatures, the greater first.
    pub fn principal(&self) -> [f64; 2] {
        let spread = (self.mean * self.mean - self.gaussian).max(0.0).sqrt();
        [self.mean + spread, self.mean - spread]
    }
}

/// Weights of the three differences of control points in a cubic's derivative.
fn slope_weights(t: f64) -> [f64; 3] {
    let r = 1.0 - t;
    [3.0 * r * r, 6.0 * r * t, 3.0 * t * t]
}

impl Bicubic {
    /// The point at (u, v), within half an ulp and a hair of the exact one for these control points.
    pub fn at(&self, u: f64, v: f64) -> DVec3 {
        let rows = self.points.map(|row| compensated(&row.map(Dd::from), |_| Local::unit(v)));
        compensated(&rows, |_| Local::unit(u)).value()
    }

    /// The point at (u, v) in plain f64: on an edge the bits of that edge's curve by [`evaluate::bernstein`].
    #[inline]
    pub fn fast_at(&self, u: f64, v: f64) -> DVec3 {
        evaluate::bernstein(&self.points.map(|row| evaluate::bernstein(&row, v)), u)
    }

    /// Point, ∂/∂u and ∂/∂v in plain f64.
    pub fn first_order(&self, u: f64, v: f64) -> [DVec3; 3] {
        let (bu, bv) = (bernstein(u), bernstein(v));
        let (su, sv) = (slope_weights(u), slope_weights(v));
        let across = self.points.map(|row| row[0] * bv[0] + row[1] * bv[1] + row[2] * bv[2] + row[3] * bv[3]);
        let slopes = self
            .points
            .map(|row| (row[1] - row[0]) * sv[0] + (row[2] - row[1]) * sv[1] + (row[3] - row[2]) * sv[2]);
        let point = across[0] * bu[0] + across[1] * bu[1] + across[2] * bu[2] + across[3] * bu[3];
        let du = (across[1] - across[0]) * su[0]
            + (across[2] - across[1]) * su[1]
            + (across[3] - across[2]) * su[2];
        let dv = slopes[0] * bu[0] + slopes[1] * bu[1] + slopes[2] * bu[2] + slopes[3] * bu[3];
        [point, du, dv]
    }

    /// Position with first and second partial derivatives, in plain f64.
    pub fn jet(&self, u: f64, v: f64) -> Jet {
        let columns = |row: &[DVec3; 4]| along(row, v);
        let rows = self.points.map(|row| columns(&row));
        let part = |k: usize| along(&[rows[0][k], rows[1][k], rows[2][k], rows[3][k]], u);
        let [point, du, duu] = part(0);
        let [dv, duv, _] = part(1);
        let [dvv, _, _] = part(2);
        Jet { point, du, dv, duu, duv, dvv }
    }

    /// Unit normal along ∂/∂u × ∂/∂v; where that vanishes (a collapsed edge, parallel tangents) the limit from inside the piece. None
    /// where the limit takes more than third derivatives or does not exist: a piece without area.
    pub fn normal(&self, u: f64, v: f64) -> Option<DVec3> {
        self.normal_by(u, v, self.size())
    }

    /// The same where the piece's [`Bicubic::size`] is known.
    pub fn normal_by(&self, u: f64, v: f64, scale: f64) -> Option<DVec3> {
        let jet = self.jet(u, v);
        let negligible = |n: DVec3| n.length() <= FLAT * scale * scale;
        let direct = jet.du.cross(jet.dv);
        if !negligible(direct) && direct.length() > FLAT * jet.du.length() * jet.dv.length() {
            return direct.try_normalize();
        }
        // N = ∂u × ∂v along (u, v) + s·(a, b) into the piece: its first derivative in s that is not 0.
        let (a, b) = (inward(u), inward(v));
        let along_u = jet.duu * a + jet.duv * b;
        let along_v = jet.duv * a + jet.dvv * b;
        let first = along_u.cross(jet.dv) + jet.du.cross(along_v);
        if !negligible(first) {
            return first.try_normalize();
        }
        let (turn_u, turn_v) = self.third_along(u, v, a, b);
        let second = turn_u.cross(jet.dv) + along_u.cross(along_v) * 2.0 + jet.du.cross(turn_v);
        if !negligible(second) {
            return second.try_normalize();
        }
        self.normal_nearby(u, v, a, b)
    }

    /// Second derivatives of ∂/∂u and ∂/∂v along (a, b), by differences of second derivatives, which are exact for what is linear
    /// in them and close enough for a direction.
    fn third_along(&self, u: f64, v: f64, a: f64, b: f64) -> (DVec3, DVec3) {
        let here = self.jet(u, v);
        let there = self.jet(u + a * STEP, v + b * STEP);
        let along = |j: &Jet| (j.duu * a + j.duv * b, j.duv * a + j.dvv * b);
        let ((u0, v0), (u1, v1)) = (along(&here), along(&there));
        ((u1 - u0) / STEP, (v1 - v0) / STEP)
    }

    /// The normal a small step inside, growing until there is one.
    fn normal_nearby(&self, u: f64, v: f64, a: f64, b: f64) -> Option<DVec3> {
        [STEP, 16.0 * STEP, 256.0 * STEP].iter().find_map(|step| {
            let [_, du, dv] = self.first_order(u + a * step, v + b * step);
            let n = du.cross(dv);
            if n.length() > FLAT * du.length() * dv.length() { n.try_normalize() } else { None }
        })
    }

    /// Gaussian and mean curvature by the two fundamental forms. None where the partial derivatives are parallel or vanish.
    /// do Carmo, *Differential Geometry of Curves and Surfaces* §3.3.
    pub fn curvature(&self, u: f64, v: f64) -> Option<Curvature> {
        let Jet { du, dv, duu, duv, dvv, .. } = self.jet(u, v);
        let cross = du.cross(dv);
        if cross.length() <= FLAT * du.length() * dv.length() {
            return None;
        }
        let n = cross.try_normalize()?;
        let (e, f, g) = (du.dot(du), du.dot(dv), dv.dot(dv));
        let (l, m, p) = (duu.dot(n), duv.dot(n), dvv.dot(n));
        let area = cross.length_squared();
        Some(Curvature {
            gaussian: (l * p - m * m) / area,
            mean: (l * g - 2.0 * m * f + p * e) / (2.0 * area),
        })
    }

    /// Largest distance between neighbouring control points: the scale of its derivatives.
    pub fn size(&self) -> f64 {
        let p = &self.points;
        let mut squared = 0.0f64;
        for i in 0..4 {
            for j in 0..3 {
                let steps = [p[i][j + 1] - p[i][j], p[j + 1][i] - p[j][i]];
                squared = squared.max(steps[0].length_squared()).max(steps[1].length_squared());
            }
        }
        squared.sqrt()
    }

    /// The box of the control points, which holds the surface.
    pub fn bounds(&self) -> Aabb {
        Aabb::of(self.points.iter().flatten().copied())
    }

    /// Control points of a boundary curve, by ascending parameter.
    pub fn edge(&self, edge: Edge) -> [DVec3; 4] {
        match edge {
            Edge::StartU => self.points[0],
            Edge::EndU => self.points[3],
            Edge::StartV => self.points.map(|row| row[0]),
            Edge::EndV => self.points.map(|row| row[3]),
        }
    }

    /// u and v exchanged; the normal turns round.
    #[must_use]
    pub fn transposed(&self) -> Self {
        Bicubic { points: std::array::from_fn(|i| std::array::from_fn(|j| self.points[j][i])) }
    }

    /// The parts below and above u; they share their edge to the bit.
    pub fn split_u(&self, u: f64) -> [Self; 2] {
        self.transposed().split_v(u).map(|part| part.transposed())
    }

    /// The parts below and above v; they share their edge to the bit.
    pub fn split_v(&self, v: f64) -> [Self; 2] {
        let halves = self.points.map(|row| split(&row, v));
        [0, 1].map(|k| Bicubic { points: halves.map(|h| h[k]) })
    }

    /// The part over `u.0..u.1` × `v.0..v.1` of [0, 1]², with u.0 < u.1 and v.0 < v.1.
    #[must_use]
    pub fn part(&self, u: (f64, f64), v: (f64, f64)) -> Self {
        let cut = |piece: Self, (from, to): (f64, f64)| {
            let upper = if from > 0.0 { piece.split_u(from)[1] } else { piece };
            if to < 1.0 { upper.split_u((to - from) / (1.0 - from))[0] } else { upper }
        };
        cut(cut(*self, u).transposed(), v).transposed()
    }
}

/// A normal shorter than this part of what its factors could make is rounding: some 2¹² u, since a direction from less would have
/// fewer than three digits.
const FLAT: f64 = 4096.0 * f64::EPSILON;

/// A step in u or v for differences of derivatives: ∛u, where truncation meets rounding.
const STEP: f64 = 1.0 / 131_072.0;

/// Direction into [0, 1].
fn inward(t: f64) -> f64 {
    if t <= 0.5 { 1.0 } else { -1.0 }
}

/// Value, first and second derivative of a cubic.
fn along(p: &[DVec3; 4], t: f64) -> [DVec3; 3] {
    let r = 1.0 - t;
    let d = [p[1] - p[0], p[2] - p[1], p[3] - p[2]];
    let e = [d[1] - d[0], d[2] - d[1]];
    let slope = d[0] * (r * r) + d[1] * (2.0 * r * t) + d[2] * (t * t);
    [evaluate::bernstein(p, t), slope * 3.0, (e[0] * r + e[1] * t) * 6.0]
}

/// De Casteljau's two halves.
fn split(p: &[DVec3; 4], t: f64) -> [[DVec3; 4]; 2] {
    let r = 1.0 - t;
    let mix = |a: DVec3, b: DVec3| a * r + b * t;
    let (a, b, c) = (mix(p[0], p[1]), mix(p[1], p[2]), mix(p[2], p[3]));
    let (d, e) = (mix(a, b), mix(b, c));
    let m = mix(d, e);
    [[p[0], a, d, m], [m, e, c, p[3]]]
}
