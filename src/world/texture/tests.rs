use super::*;
use crate::diag::SourceId;
use crate::math::field::{Binary, FieldBuilder};
use crate::scene::assets::image::{Image, Picture};
use crate::scene::{Filter, Wrap};
use std::sync::Arc;

const SPAN: Span = Span { source: SourceId(0), start: 0, end: 0 };

fn pattern(kind: PatternKind) -> Texture {
    Texture::Pattern(Arc::new(Pattern { kind, transform: None, span: SPAN }))
}

fn transformed(kind: PatternKind, by: Affine) -> Texture {
    Texture::Pattern(Arc::new(Pattern { kind, transform: Some(Box::new(by)), span: SPAN }))
}

fn black_and_white() -> (Texture, Texture) {
    (Texture::number(0.0), Texture::number(1.0))
}

fn at(p: DVec3) -> TexturePoint<'static> {
    TexturePoint { local_point: p, ..TexturePoint::default() }
}

fn at_uv(u: f64, v: f64) -> TexturePoint<'static> {
    TexturePoint { uv: DVec2::new(u, v).into(), ..TexturePoint::default() }
}

#[test]
fn a_plane_through_the_origin_does_not_flicker() {
    let (a, b) = black_and_white();
    let checker = pattern(PatternKind::Checker(a, b));
    for rounding in [-1e-16, 0.0, 1e-16] {
        assert_eq!(number(&checker, &at(DVec3::new(0.3, rounding, -0.2))), Ok(0.0));
        assert_eq!(number(&checker, &at(DVec3::new(1.3, rounding, -0.2))), Ok(1.0));
        assert_eq!(number(&checker, &at(DVec3::new(-0.7, rounding, 1.2))), Ok(0.0));
    }
}

#[test]
fn patterns_move_with_their_transforms_and_carry_those_inside() {
    let (a, b) = black_and_white();
    let fine = transformed(PatternKind::Checker(a, b), Affine::scale(DVec3::splat(0.5)));
    assert_eq!(number(&fine, &at(DVec3::new(0.6, 0.0, 0.0))), Ok(1.0));
    let coarse =
        transformed(PatternKind::Checker(fine, Texture::number(7.0)), Affine::scale(DVec3::splat(10.0)));
    assert_eq!(number(&coarse, &at(DVec3::new(4.0, 0.0, 0.0))), Ok(1.0));
    assert_eq!(number(&coarse, &at(DVec3::new(6.0, 0.0, 0.0))), Ok(7.0));
}

#[test]
fn stripes_go_round_also_below_zero() {
    let stripes = pattern(PatternKind::Stripes((0..3).map(|i| Texture::number(f64::from(i))).collect()));
    let seen: Vec<f64> = (-4..4).map(|x| number(&stripes, &at(DVec3::X * f64::from(x))).unwrap()).collect();
    assert_eq!(seen, [2.0, 0.0, 1.0, 2.0, 0.0, 1.0, 2.0, 0.0]);
}

#[test]
fn rings_of_wood_rise_outward_and_stand_a_unit_apart_but_for_a_tenth() {
    let (a, b) = black_and_white();
    let wood = pattern(PatternKind::Wood(a, b));
    let grain = |r: f64| number(&wood, &at(DVec3::new(0.6 * r, 0.37, 0.8 * r))).unwrap();
    for i in 0..900 {
        let r = 0.5 + f64::from(i) * 0.01;
        let off = (grain(r) - r).rem_euclid(1.0);
        assert!(off.min(1.0 - off) <= 0.1, "{r}: {}", grain(r));
    }
}

#[test]
fn veins_of_marble_turn_once_a_unit_on_the_whole() {
    let (a, b) = black_and_white();
    let marble = pattern(PatternKind::Marble(a, b));
    let seen: Vec<f64> = (0..20_000)
        .map(|i| number(&marble, &at(DVec3::new(f64::from(i) * 1e-3, 0.4, 0.7))).unwrap())
        .collect();
    let mean = seen.iter().sum::<f64>() / seen.len() as f64;
    // Over twenty units the wave passes the middle twice in each; noise adds some passes where it outruns x, and loses none.
    let passes = seen.windows(2).filter(|w| (w[0] < 0.5) != (w[1] < 0.5)).count();
    assert!((mean - 0.5).abs() < 0.1 && (38..120).contains(&passes), "{mean}, {passes}");
}

#[test]
fn noise_is_that_of_the_language_and_all_mixtures_stay_between() {
    type Make = fn(Texture, Texture) -> PatternKind;
    let makes: [Make; 3] = [PatternKind::Noise, PatternKind::Marble, PatternKind::Wood];
    for make in makes {
        let (a, b) = black_and_white();
        let texture = pattern(make(a, b));
        let mut seen = (1.0f64, 0.0f64);
        for i in 0..500 {
            let p = DVec3::new(0.37, 0.21, -0.73) * f64::from(i);
            let value = number(&texture, &at(p)).unwrap();
            seen = (seen.0.min(value), seen.1.max(value));
            assert!((0.0..=1.0).contains(&value));
        }
        assert!(seen.0 < 0.3 && seen.1 > 0.7, "{seen:?}");
    }
    let (a, b) = black_and_white();
    let p = DVec3::new(0.3, 1.2, -4.5);
    assert_eq!(number(&pattern(PatternKind::Noise(a, b)), &at(p)), Ok(noise(&p.to_array())));
}

#[test]
fn ramps_are_linear_between_stops_and_constant_beyond() {
    let (a, b) = black_and_white();
    let input = pattern(PatternKind::Gradient(a, b));
    let stops = [(0.25, 10.0), (0.5, 20.0), (0.5, 40.0)].map(|(x, y)| (x, Texture::number(y))).to_vec();
    let ramp = pattern(PatternKind::Ramp(input, stops));
    let value = |y: f64| number(&ramp, &at(DVec3::Y * y)).unwrap();
    assert_eq!(
        [value(0.0), value(0.25), value(0.375), value(0.5), value(9.0)],
        [10.0, 10.0, 15.0, 40.0, 40.0]
    );
}

/// 2 × 2: bottom row 0, 1; top row 2, 3.
fn four_texels(wrap: Wrap, filter: Filter) -> Texture {
    let rows_from_top = [2.0, 3.0, 0.0, 1.0f32];
    let rgb = rows_from_top.iter().flat_map(|&x| [x; 3]).collect();
    let picture = Picture::default();
    picture.set(Arc::new(Image::from_linear(2, 2, rgb)));
    pattern(PatternKind::Image(ImagePattern {
        path: "four".into(),
        wrap,
        filter,
        colour: true,
        span: SPAN,
        picture,
    }))
}

#[test]
fn the_first_texel_is_bottom_left_and_centres_lie_at_halves() {
    for filter in [Filter::Nearest, Filter::Bilinear] {
        let image = four_texels(Wrap::Clamp, filter);
        let value = |u, v| number(&image, &at_uv(u, v)).unwrap();
        assert_eq!(
            [value(0.25, 0.25), value(0.75, 0.25), value(0.25, 0.75), value(0.75, 0.75)],
            [0.0, 1.0, 2.0, 3.0]
        );
    }
    let image = four_texels(Wrap::Clamp, Filter::Bilinear);
    assert_eq!(number(&image, &at_uv(0.5, 0.5)), Ok(1.5));
    assert_eq!(number(&image, &at_uv(0.0, 0.0)), Ok(0.0));
    assert_eq!(number(&image, &at_uv(-3.0, 9.0)), Ok(2.0));
}

#[test]
fn pictures_wrap_as_asked() {
    let value = |wrap, u| number(&four_texels(wrap, Filter::Nearest), &at_uv(u, 0.1)).unwrap();
    assert_eq!([value(Wrap::Repeat, 1.25), value(Wrap::Repeat, -0.25)], [0.0, 1.0]);
    assert_eq!(
        [value(Wrap::Mirror, 1.25), value(Wrap::Mirror, -0.25), value(Wrap::Mirror, 2.75)],
        [1.0, 0.0, 1.0]
    );
    assert_eq!([value(Wrap::Clamp, 1.25), value(Wrap::Clamp, -0.25)], [1.0, 0.0]);
    let seam = number(&four_texels(Wrap::Repeat, Filter::Bilinear), &at_uv(0.0, 0.25));
    assert_eq!(seam, Ok(0.5));
    for extreme in [1e300, -1e300, 0.0, 1.0, -1e-320] {
        for wrap in [Wrap::Repeat, Wrap::Mirror, Wrap::Clamp] {
            for filter in [Filter::Nearest, Filter::Bilinear] {
                assert!(number(&four_texels(wrap, filter), &at_uv(extreme, extreme)).is_ok());
            }
        }
    }
}

#[test]
fn a_scaled_picture_repeats() {
    let Texture::Pattern(image) = four_texels(Wrap::Repeat, Filter::Nearest) else { panic!("a pattern") };
    let half = transformed(image.kind.clone(), Affine::scale(DVec3::splat(0.5)));
    assert_eq!(number(&half, &at_uv(0.375, 0.125)), Ok(1.0));
    assert_eq!(number(&half, &at_uv(0.625, 0.125)), Ok(0.0));
}

#[test]
fn a_picture_that_was_not_read_is_a_fault_at_its_name() {
    let image = ImagePattern {
        path: "none".into(),
        wrap: Wrap::Repeat,
        filter: Filter::Nearest,
        colour: true,
        span: SPAN,
        picture: Picture::default(),
    };
    assert_eq!(colour(&pattern(PatternKind::Image(image)), &at_uv(0.0, 0.0)).unwrap_err().span, SPAN);
}

#[test]
fn a_function_gives_a_grey_or_a_colour_and_names_what_is_undefined() {
    let mut b = FieldBuilder::new(3);
    let one = b.constant(1.0);
    b.site(1);
    let quotient = b.binary(Binary::Div, one, b.input(0));
    let place = Span { start: 5, end: 9, ..SPAN };
    let function = SampledFunction {
        field: b.finish(&[quotient]).unwrap(),
        input: SampleInput::Point,
        span: SPAN,
        sites: vec![SPAN, place],
    };
    let texture = pattern(PatternKind::Function(Arc::new(function)));
    assert_eq!(colour(&texture, &at(DVec3::X * 4.0)), Ok(Rgb::splat(0.25)));
    let fault = TextureFault { span: place, kind: FaultKind::DivisionByZero };
    assert_eq!(colour(&texture, &at(DVec3::ZERO)), Err(fault));
}
