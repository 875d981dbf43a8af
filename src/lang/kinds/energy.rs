//! Whether a material returns more light than it gets: the directional albedo of its layers against 1.
//!
//! The model is that of the reference: with mirror share r(θ), light is sent on by (1 − r)·(diffuse + specular + transmit) +
//! r·mirror. The albedo of the specular lobe is integrated over the hemisphere. Textures that vary count with each of the
//! colours they are made of, where they are made of constants; functions and pictures are not looked into.

use crate::diag::{Code, Diagnostic};
use crate::lang::display::number_to;
use crate::lang::table::{Block, Context};
use crate::math::elementary::{powf, powi, sin_cos};
use crate::scene::{Fresnel, Layers, Lobe, Material, PatternKind, Rgb, Texture};
use glam::DVec3;
use std::f64::consts::PI;

/// What passes without a warning: 1 %. Blinn's (q + 8)/8π is itself only near to conserving (its albedo reaches 1.07 for
/// exponents near 10), and less than a step of 8-bit pictures is seen of it.
const SLACK: f64 = 0.01;

/// No lobe of k_s = 1 has a greater albedo at any angle, for any exponent; `no_lobe_exceeds_its_bound` holds it.
const LOBE_BOUND: f64 = 1.08;

/// Warns where a material returns more light than it gets, and says by how much.
pub fn check(ctx: &mut dyn Context, material: &Material, block: &Block) {
    let most = most_returned(material);
    let returned = most.max_element();
    if returned <= 1.0 + SLACK {
        return;
    }
    let is_grey = most.min_element() == returned;
    let channel = ["red", "green", "blue"][most.to_array().iter().position(|x| *x == returned).unwrap_or(0)];
    let of_what = if is_grey { String::new() } else { format!(" of {channel}") };
    let shares: Vec<&str> = ["diffuse", "specular", "reflect", "transmit", "metal"]
        .into_iter()
        .filter(|n| block.has(n))
        .collect();
    let times = written(returned);
    let more = (returned < MANY).then(|| format!(": {:.0} % too much", (returned - 1.0) * 100.0));
    let message =
        format!("this material returns {times} times the light it gets{of_what}{}", more.unwrap_or_default());
    let said = Diagnostic::new(Code::EnergyGain, block.kind_span, message);
    let said = match shares[..] {
        [one] => said.hint(format!("a share is at most 1: divide `{one}` by {times}")),
        _ => said.hint(format!(
            "lower {} until their sum is at most 1",
            crate::lang::coerce::listed(&shares.iter().map(|s| format!("`{s}`")).collect::<Vec<_>>(), "and")
        )),
    };
    let said = shares.iter().fold(said, |said, name| said.also(block.place(name), "counts"));
    ctx.report(said);
}

/// From so many times the light on, only its size is of use to a person.
const MANY: f64 = 1000.0;

fn written(returned: f64) -> String {
    if returned < MANY { format!("{returned:.2}") } else { number_to(returned, 3) }
}

/// The greatest share of light that a material returns in any direction, per channel.
fn most_returned(material: &Material) -> Rgb {
    let layers = material.layers();
    let diffuse = greatest(&material.diffuse);
    let [specular, transmit, reflect] = [&layers.specular, &layers.transmit, &layers.reflect].map(greatest);
    let flat = diffuse + transmit;
    if (flat + specular * LOBE_BOUND).max_element() <= 1.0 && reflect.max_element() <= 1.0 {
        return flat;
    }
    let angles = (0..N_ANGLES).map(|i| 1.0 - f64::from(i) / f64::from(N_ANGLES));
    angles.map(|cosine| returned_at(layers, flat, specular, cosine)).fold(Rgb::ZERO, Rgb::max)
}

/// Angles from the normal at which the albedo is taken, evenly in the cosine.
const N_ANGLES: u32 = 8;

fn returned_at(layers: &Layers, flat: Rgb, specular: Rgb, cosine: f64) -> Rgb {
    let lobe = match (&layers.exponent, specular == Rgb::ZERO) {
        (Texture::Constant(q), false) => lobe_albedo(layers.lobe, q.x, cosine),
        _ => 1.0,
    };
    let r = mirror_share(layers, cosine);
    (Rgb::ONE - r) * (flat + specular * lobe) + r
}

/// r(θ), with Schlick's approximation for both laws; at normal incidence, where it is least, it is exact.
fn mirror_share(layers: &Layers, cosine: f64) -> Rgb {
    let grazing = powi(1.0 - cosine, 5);
    let schlick = |r0: Rgb| r0 + (Rgb::ONE - r0) * grazing;
    let (metal, reflect) = (greatest(&layers.metal), greatest(&layers.reflect));
    let transmits = greatest(&layers.transmit) != Rgb::ZERO;
    match layers.fresnel {
        _ if metal != Rgb::ZERO => schlick(metal),
        Fresnel::None => reflect,
        Fresnel::Schlick | Fresnel::Exact if transmits => {
            let ior = greatest(&layers.ior).x;
            let r0 = ((ior - 1.0) / (ior + 1.0)) * ((ior - 1.0) / (ior + 1.0));
            reflect + (Rgb::ONE - reflect) * schlick(Rgb::splat(r0))
        }
        Fresnel::Schlick | Fresnel::Exact if reflect == Rgb::ZERO => Rgb::ZERO,
        Fresnel::Schlick | Fresnel::Exact => schlick(reflect),
    }
}

/// The greatest of the constants that a texture is made of, per channel; 0 for what cannot be told.
fn greatest(texture: &Texture) -> Rgb {
    match texture {
        Texture::Constant(c) => *c,
        Texture::Pattern(pattern) => match &pattern.kind {
            PatternKind::Checker(a, b)
            | PatternKind::Gradient(a, b)
            | PatternKind::Noise(a, b)
            | PatternKind::Marble(a, b)
            | PatternKind::Wood(a, b) => greatest(a).max(greatest(b)),
            PatternKind::Stripes(all) => all.iter().map(greatest).fold(Rgb::ZERO, Rgb::max),
            PatternKind::Ramp(_, stops) => stops.iter().map(|(_, t)| greatest(t)).fold(Rgb::ZERO, Rgb::max),
            PatternKind::Weight(_) => Rgb::ONE,
            PatternKind::Image(_) | PatternKind::Function(_) => Rgb::ZERO,
        },
    }
}

/// ∫ f(wi) cos over the hemisphere for a lobe of k_s = 1 seen at a cosine, by the midpoint rule in coordinates about the lobe's
/// own axis (the mirror direction, or the normal for half vectors), where the power is integrated exactly in the angle.
fn lobe_albedo(lobe: Lobe, q: f64, cosine: f64) -> f64 {
    let wo = DVec3::new((1.0 - cosine * cosine).max(0.0).sqrt(), 0.0, cosine);
    match lobe {
        Lobe::Phong => phong_albedo(q, wo),
        Lobe::Blinn => blinn_albedo(q, wo),
    }
}

/// Cells of the integrals in each of the two angles.
const CELLS: u32 = 48;

/// The cells' middles: (u, sine and cosine of the azimuth).
fn cells() -> impl Iterator<Item = (f64, f64, f64)> {
    let middle = |i: u32| (f64::from(i) + 0.5) / f64::from(CELLS);
    (0..CELLS).flat_map(move |j| {
        let (s, c) = sin_cos(2.0 * PI * middle(j));
        (0..CELLS).map(move |i| (middle(i), s, c))
    })
}

/// With c = u^(1/(q+2)) the cosine to the mirror direction has density (q + 2) c^(q+1): what remains of the integrand is
/// cos θ / c.
fn phong_albedo(q: f64, wo: DVec3) -> f64 {
    let axis = DVec3::new(-wo.x, 0.0, wo.z);
    let (s, t) = (DVec3::new(axis.z, 0.0, -axis.x), DVec3::Y);
    let sum: f64 = cells()
        .map(|(u, sin, cos)| {
            let c = powf(u, 1.0 / (q + 2.0));
            let side = (1.0 - c * c).max(0.0).sqrt();
            let wi = axis * c + s * (side * cos) + t * (side * sin);
            wi.z.max(0.0) / c
        })
        .sum();
    sum / f64::from(CELLS * CELLS)
}

/// Half vectors h about the normal with c = n·h of density (q + 2) c^(q+1); dwi = 4 (wo·h) dh. What remains of
/// (q + 8)/8π c^q cos θᵢ is (q + 8)/(q + 2) (wo·h) cos θᵢ / c.
fn blinn_albedo(q: f64, wo: DVec3) -> f64 {
    let sum: f64 = cells()
        .map(|(u, sin, cos)| {
            let c = powf(u, 1.0 / (q + 2.0));
            let side = (1.0 - c * c).max(0.0).sqrt();
            let h = DVec3::new(side * cos, side * sin, c);
            let along = wo.dot(h);
            let wi = h * (2.0 * along) - wo;
            along.max(0.0) * wi.z.max(0.0) / c
        })
        .sum();
    (q + 8.0) / (q + 2.0) * sum / f64::from(CELLS * CELLS)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_phong_lobe_returns_all_at_normal_incidence_and_less_beside() {
        for q in [0.0, 1.0, 10.0, 400.0] {
            assert!((lobe_albedo(Lobe::Phong, q, 1.0) - 1.0).abs() < 2e-3, "{q}");
            assert!(lobe_albedo(Lobe::Phong, q, 0.3) < 1.0);
        }
    }

    #[test]
    fn a_blinn_lobe_has_the_closed_form_at_normal_incidence() {
        for q in [0.0f64, 2.0, 12.0, 40.0, 400.0] {
            let tail = |k: f64| (1.0 - powf(2.0, -k / 2.0)) / k;
            let expected = (q + 8.0) * (2.0 * tail(q + 4.0) - tail(q + 2.0));
            let found = lobe_albedo(Lobe::Blinn, q, 1.0);
            assert!((found - expected).abs() < 3e-3, "q = {q}: {found}, expected {expected}");
        }
    }

    #[test]
    fn no_lobe_exceeds_its_bound() {
        for lobe in [Lobe::Phong, Lobe::Blinn] {
            for i in 0..60 {
                let q = powf(1.2, f64::from(i)) - 1.0;
                for j in 1..=8 {
                    let albedo = lobe_albedo(lobe, q, f64::from(j) / 8.0);
                    assert!(albedo <= LOBE_BOUND, "{lobe:?} q = {q} cosine {}: {albedo}", f64::from(j) / 8.0);
                }
            }
        }
    }
}
