//! Affine maps that carry their inverse, composed product by product, so that no matrix is ever inverted numerically.

use super::Aabb;
use super::elementary::sin_cos_degrees;
use glam::{DMat3, DVec3};

/// `p ↦ linear·p + translation`, with the inverse beside it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Affine {
    /// 3 × 3, columns are the images of x, y and z.
    pub linear: DMat3,
    /// The image of the origin.
    pub translation: DVec3,
    /// 3 × 3 linear part of the inverse.
    pub inverse_linear: DMat3,
    /// The point that maps to the origin.
    pub inverse_translation: DVec3,
}

impl Default for Affine {
    fn default() -> Self {
        Self::IDENTITY
    }
}

/// Rounds of three rotations each: convergence is quadratic, and five reach rounding.
const JACOBI_SWEEPS: usize = 6;

impl Affine {
    /// The identity.
    pub const IDENTITY: Affine = Affine {
        linear: DMat3::IDENTITY,
        translation: DVec3::ZERO,
        inverse_linear: DMat3::IDENTITY,
        inverse_translation: DVec3::ZERO,
    };

    /// By an offset.
    pub fn translate(offset: DVec3) -> Affine {
        Affine { translation: offset, inverse_translation: -offset, ..Affine::IDENTITY }
    }

    /// By factors along the axes; none may be 0.
    pub fn scale(factors: DVec3) -> Affine {
        Affine::from_linear(DMat3::from_diagonal(factors), DMat3::from_diagonal(factors.recip()))
    }

    /// About a unit axis by an angle in degrees, counterclockwise seen against the axis. Rodrigues' formula.
    pub fn rotate(axis: DVec3, degrees: f64) -> Affine {
        let (s, c) = sin_cos_degrees(degrees);
        let column = |e: DVec3| e * c + axis.cross(e) * s + axis * (axis.dot(e) * (1.0 - c));
        let linear = DMat3::from_cols(column(DVec3::X), column(DVec3::Y), column(DVec3::Z));
        Affine::from_linear(linear, linear.transpose())
    }

    /// Degrees about x, then y, then z.
    pub fn rotate_xyz(degrees: DVec3) -> Affine {
        Affine::rotate(DVec3::X, degrees.x)
            .then(&Affine::rotate(DVec3::Y, degrees.y))
            .then(&Affine::rotate(DVec3::Z, degrees.z))
    }

    /// From images of the axes and of the origin. None where the matrix is singular (its determinant is 0 or not finite).
    pub fn from_columns(linear: DMat3, translation: DVec3) -> Option<Affine> {
        let inverse = linear.inverse();
        let usable = linear.determinant() != 0.0 && inverse.is_finite() && translation.is_finite();
        usable.then(|| Affine {
            linear,
            translation,
            inverse_linear: inverse,
            inverse_translation: -(inverse * translation),
        })
    }

    fn from_linear(linear: DMat3, inverse_linear: DMat3) -> Affine {
        Affine { linear, inverse_linear, translation: DVec3::ZERO, inverse_translation: DVec3::ZERO }
    }

    /// First this, then `next`.
    #[must_use]
    pub fn then(&self, next: &Affine) -> Affine {
        Affine {
            linear: next.linear * self.linear,
            translation: next.linear * self.translation + next.translation,
            inverse_linear: self.inverse_linear * next.inverse_linear,
            inverse_translation: self.inverse_linear * next.inverse_translation + self.inverse_translation,
        }
    }

    /// The inverse: the same numbers, swapped.
    #[must_use]
    pub fn inverse(&self) -> Affine {
        Affine {
            linear: self.inverse_linear,
            translation: self.inverse_translation,
            inverse_linear: self.linear,
            inverse_translation: self.translation,
        }
    }

    /// A point's image.
    pub fn point(&self, p: DVec3) -> DVec3 {
        self.linear * p + self.translation
    }

    /// A direction's image, not normalised.
    pub fn vector(&self, v: DVec3) -> DVec3 {
        self.linear * v
    }

    /// A normal's image by the inverse transpose, not normalised. Points to the same side of the surface whatever the sign of the
    /// determinant.
    pub fn normal(&self, n: DVec3) -> DVec3 {
        self.inverse_linear.transpose() * n
    }

    /// By how much it shortens and lengthens at most: the least and greatest singular value of the linear part, by Jacobi's rotations
    /// of its Gram matrix.
    pub fn stretch(&self) -> (f64, f64) {
        let mut gram = self.linear.transpose() * self.linear;
        for (p, q) in [(0, 1), (0, 2), (1, 2)].into_iter().cycle().take(3 * JACOBI_SWEEPS) {
            let off = gram.col(p)[q];
            if off == 0.0 {
                continue;
            }
            let half = 0.5 * (gram.col(q)[q] - gram.col(p)[p]) / off;
            let tangent = half.signum() / (half.abs() + (half * half + 1.0).sqrt());
            let cosine = 1.0 / (tangent * tangent + 1.0).sqrt();
            let mut turn = DMat3::IDENTITY;
            turn.col_mut(p)[p] = cosine;
            turn.col_mut(q)[q] = cosine;
            turn.col_mut(q)[p] = tangent * cosine;
            turn.col_mut(p)[q] = -tangent * cosine;
            gram = turn.transpose() * gram * turn;
        }
        let squares = [0, 1, 2].map(|k| gram.col(k)[k].max(0.0));
        let least = squares.iter().copied().fold(f64::INFINITY, f64::min);
        (least.sqrt(), squares.iter().copied().fold(0.0, f64::max).sqrt())
    }

    /// True for a map that mirrors.
    pub fn mirrors(&self) -> bool {
        self.linear.determinant() < 0.0
    }

    /// The box around a box's image; empty stays empty.
    pub fn aabb(&self, b: Aabb) -> Aabb {
        if b.is_empty() { b } else { Aabb::of(b.corners().map(|p| self.point(p))) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::random::Random;

    fn vector(r: &mut Random) -> DVec3 {
        DVec3::new(r.between(-1.0, 1.0), r.between(-1.0, 1.0), r.between(-1.0, 1.0))
    }

    #[test]
    fn a_normal_leans_against_the_stretch_and_knows_no_translation() {
        let stretch = Affine::scale(DVec3::new(1.0, 1000.0, 1.0));
        let n = DVec3::new(1.0, 1.0, 0.0).normalize();
        let image = stretch.normal(n).normalize();
        assert!((image - DVec3::new(1.0, 1e-3, 0.0).normalize()).length() < 1e-15, "{image}");
        // The image by the matrix itself is almost perpendicular to it.
        let wrong = stretch.vector(n).normalize().dot(image).acos().to_degrees();
        assert!((wrong - 89.885).abs() < 1e-3, "{wrong}");
        assert_eq!(Affine::translate(DVec3::new(5.0, 0.0, 0.0)).normal(DVec3::X), DVec3::X);
    }

    #[test]
    fn normals_stay_across_tangents_and_outward_under_any_map() {
        let mut random = Random::new(50);
        for case in 0..2000 {
            let factor = |r: &mut Random| r.sign() * crate::math::elementary::exp2(r.between(-10.0, 10.0));
            let turn = |r: &mut Random| Affine::rotate(vector(r).normalize(), r.between(0.0, 360.0));
            let scale = DVec3::new(factor(&mut random), factor(&mut random), factor(&mut random));
            let map = turn(&mut random).then(&Affine::scale(scale)).then(&turn(&mut random));
            let n = vector(&mut random).normalize();
            let tangent = n.any_orthonormal_vector();
            let image = map.normal(n).normalize();
            // |M⁻ᵀn||Mt| is what the product's rounding is measured by.
            let size = map.normal(n).length() * map.vector(tangent).length();
            assert!(map.normal(n).dot(map.vector(tangent)).abs() <= 1e-14 * size * 1024.0, "case {case}");
            let p = map.vector(n);
            assert!(image.dot(p) > 0.0, "case {case}: inward, determinant {}", map.linear.determinant());
        }
    }

    #[test]
    fn composed_inverses_undo_maps_that_a_computed_inverse_would_not() {
        let mut random = Random::new(51);
        let mut by_elimination = 0.0f64;
        for case in 0..500 {
            let turn = Affine::rotate(vector(&mut random).normalize(), random.between(0.0, 360.0));
            let squash = Affine::scale(DVec3::new(1e-6, 1.0, 1e6));
            let map = turn.then(&squash).then(&turn.inverse());
            let p = vector(&mut random);
            let off = |inverse: DMat3| (inverse * map.point(p) - p).length() / p.length();
            // 4uκ with κ = 10¹².
            assert!(
                off(map.inverse_linear) <= 4.0 * 1.11e-16 * 1e12,
                "case {case}: {:e}",
                off(map.inverse_linear)
            );
            by_elimination = by_elimination.max(off(map.linear.inverse()));
        }
        assert!(by_elimination > 4.0 * 1.11e-16 * 1e12, "{by_elimination:e}");
    }
}
