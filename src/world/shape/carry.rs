//! Surfaces carried through transforms, with the bound on their error.

use super::Surface;
use crate::math::Affine;
use crate::math::error::gamma;
use glam::DVec3;

/// Takes a surface through transforms, the outermost first. Its error grows by the rounding on the way up and by what comes of going
/// down the same way again, which the next ray will do: that part is measured, since composed inverses are inverses only up to the
/// condition of the map.
#[inline]
pub fn carry<'t>(surface: &mut Surface, transforms: impl Iterator<Item = &'t Affine> + Clone) {
    let mut all = transforms.clone();
    let Some(first) = all.next() else { return };
    let several = all.next().map(|second| all.fold(second.then(first), |outer, inner| inner.then(&outer)));
    let up = several.as_ref().unwrap_or(first);
    let point = up.point(surface.point);
    let mut back = point;
    let mut doubt_down = DVec3::ZERO;
    for transform in transforms {
        let terms = absolute(&transform.inverse_linear, back.abs()) + transform.inverse_translation.abs();
        doubt_down = absolute(&transform.inverse_linear, doubt_down) + terms * gamma(4);
        back = transform.inverse_linear * back + transform.inverse_translation;
    }
    let local_doubt = surface.error + (back - surface.point).abs() * 2.0 + doubt_down;
    let terms = absolute(&up.linear, surface.point.abs()) + up.translation.abs();
    let geometric_normal = normal_through(up, surface.geometric_normal);
    *surface = Surface {
        point,
        error: absolute(&up.linear, local_doubt) * (1.0 + gamma(4)) + terms * gamma(4),
        geometric_normal,
        normal: if surface.normal == surface.geometric_normal {
            geometric_normal
        } else {
            normal_through(up, surface.normal)
        },
        tangent: up.vector(surface.tangent),
        uv: surface.uv,
    };
}

/// |M|·v for a vector of magnitudes.
fn absolute(m: &glam::DMat3, v: DVec3) -> DVec3 {
    m.x_axis.abs() * v.x + m.y_axis.abs() * v.y + m.z_axis.abs() * v.z
}

/// By the inverse transpose, so that outward stays outward under mirrors too; scaled first, so that nothing overflows.
fn normal_through(up: &Affine, normal: DVec3) -> DVec3 {
    let n = up.normal(normal);
    (n / n.abs().max_element()).try_normalize().unwrap_or(normal)
}
