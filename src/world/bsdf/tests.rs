//! Tests of materials at a point.

use super::*;
use std::f64::consts::PI;

fn seen(wo: DVec3) -> Bsdf {
    Bsdf { wo: wo.normalize(), ..Bsdf::BARE }
}

#[test]
fn the_mirror_share_is_not_swapped() {
    let mut b = seen(DVec3::Z);
    b.diffuse = Rgb::splat(0.2);
    for (share, mirror) in [(0.0, None), (0.25, Some(0.25)), (1.0, Some(1.0))] {
        b.mirror = super::mirror(Rgb::ZERO, Rgb::ZERO, Rgb::splat(share), Fresnel::None);
        assert_eq!(b.mirrored(DVec2::ZERO).map(|s| s.weight.x), mirror);
        let base = b.base(DVec3::Z).x * PI;
        assert!((base - (1.0 - share) * 0.2).abs() < 1e-15);
    }
}

#[test]
fn light_from_behind_is_nothing_and_never_negative_or_nan() {
    let mut b = seen(DVec3::new(1.0, 0.0, 0.2));
    (b.diffuse, b.specular, b.exponent) = (Rgb::splat(0.5), Rgb::splat(0.5), 2.5);
    for lobe in [Lobe::Phong, Lobe::Blinn] {
        b.lobe = lobe;
        for wi in [-DVec3::Z, DVec3::new(1.0, 0.0, -0.01).normalize(), DVec3::X] {
            assert_eq!(b.base(wi), Rgb::ZERO);
        }
        assert!(b.base(DVec3::new(1.0, 0.0, 0.01).normalize()).min_element() > 0.0);
    }
}

#[test]
fn glass_divides_all_light_and_loses_none() {
    for outside in [true, false] {
        for cosine in [1.0f64, 0.9, 0.75, 0.3, 0.01] {
            let mut b = seen(DVec3::new((1.0 - cosine * cosine).sqrt(), 0.0, cosine));
            (b.transmit, b.ior, b.outside) = (Rgb::ONE, 1.5, outside);
            for law in [Fresnel::Exact, Fresnel::Schlick, Fresnel::None] {
                b.mirror = super::mirror(Rgb::ZERO, b.transmit, Rgb::ZERO, law);
                let weight = |s: Option<Scattered>| s.map_or(0.0, |s| s.weight.x);
                let total = weight(b.mirrored(DVec2::ZERO)) + weight(b.transmitted(DVec2::ZERO));
                assert!((total - 1.0).abs() < 1e-14, "{law:?} {cosine} {total}");
            }
        }
    }
}

#[test]
fn no_light_below_the_geometric_horizon_and_no_jump_at_it() {
    let mut b = seen(DVec3::Z);
    b.diffuse = Rgb::ONE;
    b.normal = DVec3::new(0.5, 0.0, 1.0).normalize();
    let at = |degrees: f64| {
        let (s, c) = crate::math::elementary::sin_cos_degrees(degrees);
        b.base(DVec3::new(s, 0.0, c)).x
    };
    assert_eq!(at(90.01), 0.0);
    assert!(at(89.9) < 0.01, "fades out");
    assert!(at(0.0) > 0.25, "and is not touched above");
    let steps: Vec<f64> = (0..=900).map(|i| at(60.0 + f64::from(i) / 30.0)).collect();
    assert!(steps.windows(2).all(|w| w[1] <= w[0] && w[0] - w[1] < 0.05));
}

#[test]
fn bent_normals_never_mirror_into_the_surface() {
    for i in 0..1000u32 {
        let r = |k: u32| f64::from(i.wrapping_mul(2_654_435_761).rotate_left(k)) / 2_147_483_648.0 - 1.0;
        let geometric = DVec3::Z;
        let wo = DVec3::new(r(3), r(11), r(17).abs() * 0.2 + 1e-6).normalize();
        let n = normal::facing(DVec3::new(r(5), r(7), r(23)).normalize(), geometric, wo);
        assert!(n.dot(wo) >= 0.0 && n.is_finite());
        let mut b = seen(wo);
        (b.normal, b.mirror) = (n, Mirror::Constant(Rgb::ONE));
        let s = b.mirrored(DVec2::splat(0.5)).unwrap();
        assert!(s.direction.z >= 0.0 && s.direction.is_normalized());
        (b.transmit, b.ior) = (Rgb::ONE, 1.5);
        let t = b.transmitted(DVec2::splat(0.5));
        assert!(t.is_none_or(|t| t.direction.z <= 0.0));
    }
}

#[test]
fn a_metal_has_its_colour_in_front_and_is_white_at_the_edge() {
    let gold = Rgb::new(1.0, 0.78, 0.34);
    let mut b = seen(DVec3::Z);
    b.mirror = super::mirror(gold, Rgb::ZERO, Rgb::ZERO, Fresnel::None);
    assert_eq!(b.mirrored(DVec2::ZERO).unwrap().weight, gold);
    let mut grazing = seen(DVec3::new(1.0, 0.0, 1e-9));
    grazing.mirror = b.mirror;
    assert!((grazing.mirrored(DVec2::ZERO).unwrap().weight - Rgb::ONE).abs().max_element() < 1e-7);
}
