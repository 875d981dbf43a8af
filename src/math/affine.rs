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

    /// True for a map that mirrors.
    pub fn mirrors(&self) -> bool {
        self.linear.determinant() < 0.0
    }

    /// The box around a box's image; empty stays empty.
    pub fn aabb(&self, b: Aabb) -> Aabb {
        if b.is_empty() { b } else { Aabb::of(b.corners().map(|p| self.point(p))) }
    }
}
