//! Functions at their edges, and the table's promises.

use super::*;
use crate::lang::mock::{Mock, n, v};
use crate::lang::table::Parameter;

#[test]
fn names_are_unique_and_documented() {
    let all: Vec<&str> = names().collect();
    for (i, name) in all.iter().enumerate() {
        assert!(!all[..i].contains(name), "{name} twice");
    }
    for builtin in super::all() {
        assert!(!builtin.doc.is_empty() && builtin.example.0.contains(builtin.name), "{}", builtin.name);
        assert!(builtin.parameters.iter().all(|p: &Parameter| !p.takes.is_empty()));
        assert_eq!(defaults(builtin).len(), builtin.parameters.len());
        let first_default = builtin.parameters.iter().position(|p| p.default.is_some());
        let all_after =
            builtin.parameters.iter().skip(first_default.unwrap_or(99)).all(|p| p.default.is_some());
        assert!(all_after, "{}: a parameter without default after one with", builtin.name);
    }
}

fn number(name: &str, values: &[Value]) -> f64 {
    match Mock::default().builtin(name, values) {
        Ok(Value::Number(x)) => x,
        other => panic!("{name}: {other:?}"),
    }
}

fn vector(name: &str, values: &[Value]) -> DVec3 {
    match Mock::default().builtin(name, values) {
        Ok(Value::Vector3(v)) => v,
        other => panic!("{name}: {other:?}"),
    }
}

fn fault(name: &str, values: &[Value]) -> (&'static str, String) {
    let mut ctx = Mock::default();
    assert!(ctx.builtin(name, values).is_err(), "{name}");
    assert_eq!(ctx.said.len(), 1);
    assert!(!ctx.said[0].hints.is_empty(), "{name} gives no hint");
    (ctx.said[0].code.text(), ctx.said[0].message.clone())
}

#[test]
fn functions_of_numbers_go_over_components() {
    assert_eq!(vector("abs", &[v(-1.0, 2.0, -3.0)]), DVec3::new(1.0, 2.0, 3.0));
    assert_eq!(vector("max", &[v(-1.0, 2.0, -3.0), n(0.0)]), DVec3::new(0.0, 2.0, 0.0));
    assert_eq!(vector("mix", &[v(0.0, 0.0, 0.0), v(2.0, 4.0, 6.0), n(0.5)]), DVec3::new(1.0, 2.0, 3.0));
    assert_eq!(number("min", &[n(3.0), n(1.0), n(2.0), n(0.5)]), 0.5);
    let (code, message) = fault("max", &[v(1.0, 2.0, 3.0), Value::Vector2(glam::DVec2::ONE)]);
    assert_eq!(
        (code, message),
        ("E0201", "`max` takes vectors of one size, and this has 2 components beside 3".into())
    );
}

#[test]
fn what_is_undefined_is_an_error_with_a_hint() {
    assert_eq!(fault("sqrt", &[n(-1.0)]), ("E0208", "`sqrt(-1)` is undefined".into()));
    for (name, values) in [
        ("ln", vec![n(0.0)]),
        ("log10", vec![n(-2.0)]),
        ("asin", vec![n(2.0)]),
        ("acos", vec![n(-1.5)]),
        ("mod", vec![n(1.0), n(0.0)]),
        ("pow", vec![n(-8.0), n(1.0 / 3.0)]),
        ("clamp", vec![n(0.5), n(1.0), n(0.0)]),
        ("smoothstep", vec![n(1.0), n(1.0), n(1.0)]),
        ("normalize", vec![v(0.0, 0.0, 0.0)]),
        ("rotate", vec![v(1.0, 0.0, 0.0), v(0.0, 0.0, 0.0), n(20.0)]),
        ("linspace", vec![n(0.0), n(1.0), n(-3.0)]),
        ("linspace", vec![n(0.0), n(1.0), n(2.5)]),
        ("fbm", vec![n(0.0), n(0.5), n(2.0), n(0.5)]),
    ] {
        assert_eq!(fault(name, &values).0, "E0208", "{name}");
    }
    assert_eq!(fault("exp", &[n(1000.0)]).0, "E0206");
    assert_eq!(
        fault("pow", &[n(2.0), n(1024.0)]),
        ("E0206", "`pow(2, 1024)` is beyond the range of numbers".into())
    );
    assert_eq!(fault("sum", &[list(&[1e308, 1e308])]).0, "E0206");
    assert_eq!(fault("sin", &[Value::text("30")]).0, "E0201");
    assert_eq!(fault("cross", &[v(1.0, 0.0, 0.0), n(2.0)]).0, "E0201");
}

#[test]
fn infinity_may_be_compared_but_is_never_made() {
    assert_eq!(number("min", &[n(f64::INFINITY), n(3.0)]), 3.0);
    assert_eq!(number("abs", &[n(f64::NEG_INFINITY)]), f64::INFINITY);
    assert_eq!(number("length", &[v(f64::INFINITY, 0.0, 0.0)]), f64::INFINITY);
    assert_eq!(number("sum", &[list(&[f64::INFINITY, 1.0])]), f64::INFINITY);
    assert_eq!(number("atan", &[n(f64::INFINITY)]), std::f64::consts::FRAC_PI_2);
}

#[test]
fn no_function_gives_nan() {
    let inf = f64::INFINITY;
    for (name, values) in [
        ("sin", vec![n(inf)]),
        ("cos", vec![v(0.0, -inf, 0.0)]),
        ("tan", vec![n(-inf)]),
        ("mod", vec![n(inf), n(3.0)]),
        ("mix", vec![n(inf), n(1.0), n(1.0)]),
        ("smoothstep", vec![n(0.0), n(inf), n(inf)]),
        ("normalize", vec![v(inf, 0.0, 0.0)]),
        ("dot", vec![v(inf, 1.0, 0.0), v(0.0, 1.0, 1.0)]),
        ("cross", vec![v(inf, 0.0, 0.0), v(inf, 0.0, 0.0)]),
        ("distance", vec![v(inf, 0.0, 0.0), v(inf, 0.0, 0.0)]),
        ("reflect", vec![v(inf, 0.0, 0.0), v(0.0, 1.0, 0.0)]),
        ("rotate", vec![v(1.0, 0.0, 0.0), v(0.0, 1.0, 0.0), n(inf)]),
        ("hsv", vec![n(inf), n(1.0), n(1.0)]),
        ("noise", vec![n(inf)]),
        ("luminance", vec![v(inf, -inf, 0.0)]),
        ("sum", vec![list(&[inf, -inf])]),
        ("linspace", vec![n(0.0), n(inf), n(3.0)]),
    ] {
        let (code, message) = fault(name, &values);
        assert_eq!((code, message.ends_with("` has no value")), ("E0206", true), "{message}");
    }
    assert_eq!(fault("sqrt", &[n(-inf)]).0, "E0208");
    assert_eq!(
        fault("roots", &[n(1.0), n(inf)]),
        ("E0206", "`roots` takes finite numbers alone, and `c0` is inf".into())
    );
}

#[test]
fn lengths_neither_overflow_nor_vanish() {
    for size in [1e-300, 1e-200, 1.0, 1e200, 1e307] {
        let length = number("length", &[v(3.0 * size, 0.0, 4.0 * size)]);
        assert!((length / (5.0 * size) - 1.0).abs() < 1e-15, "{size}: {length}");
    }
    assert_eq!(number("length", &[v(0.0, 0.0, 0.0)]), 0.0);
    assert_eq!(vector("normalize", &[v(0.0, 3e-320, 0.0)]), DVec3::Y);
}

#[test]
fn refraction_bends_toward_the_normal_and_to_the_far_side() {
    let travel = v(1.0, -1.0, 0.0);
    let bent = vector("refract", &[travel.clone(), v(0.0, 1.0, 0.0), n(1.0 / 1.5)]);
    assert!((bent - DVec3::new(0.471_404_520_791_031_7, -0.881_917_103_688_196_9, 0.0)).length() < 1e-15);
    let other_side = vector("refract", &[travel.clone(), v(0.0, -2.0, 0.0), n(1.0 / 1.5)]);
    assert_eq!(bent, other_side);
    assert_eq!(vector("refract", &[travel, v(0.0, 1.0, 0.0), n(1.5)]), DVec3::ZERO);
}

#[test]
fn reflection_takes_the_direction_of_travel() {
    assert_eq!(vector("reflect", &[v(1.0, -2.0, 0.5), v(0.0, 9.0, 0.0)]), DVec3::new(1.0, 2.0, 0.5));
}

#[test]
fn rotation_is_counterclockwise_and_in_degrees() {
    assert_eq!(vector("rotate", &[v(1.0, 0.0, 0.0), v(0.0, 0.0, 5.0), n(90.0)]), DVec3::Y);
}

#[test]
fn colours_are_decoded() {
    assert_eq!(vector("hsv", &[n(1.0 / 3.0), n(1.0), n(1.0)]), DVec3::Y);
    assert_eq!(vector("hsv", &[n(0.0), n(0.0), n(0.5)]), vector("srgb", &[n(0.5), n(0.5), n(0.5)]));
    assert_eq!(vector("hsv", &[n(-1.0 / 3.0), n(1.0), n(1.0)]).z, 1.0);
    let Some(Value::Vector3(gray)) = constant("gray") else { panic!() };
    assert!((gray.x - 0.215_860_500_113_899_3).abs() < 1e-15);
    assert_eq!(number("luminance", &[v(1.0, 1.0, 1.0)]), 1.0);
}

#[test]
fn the_remainder_of_mod_has_the_sign_of_the_divisor() {
    for (a, b, r) in [(-1.0, 3.0, 2.0), (1.0, -3.0, -2.0), (5.5, 2.0, 1.5), (-4.0, 2.0, 0.0)] {
        assert_eq!(number("mod", &[n(a), n(b)]), r);
    }
}

fn list(values: &[f64]) -> Value {
    Value::list(values.iter().map(|x| n(*x)).collect())
}

fn shown(name: &str, values: &[Value]) -> String {
    display(&Mock::default().builtin(name, values).unwrap())
}

#[test]
fn lists_are_folded_sorted_and_spaced() {
    let max = Value::Builtin(find("max").unwrap());
    assert_eq!(shown("fold", &[list(&[3.0, 9.0, 2.0]), n(0.0), max]), "9");
    assert_eq!(shown("sort", &[list(&[3.0, -1.0, 2.0]), list(&[])]), "[-1, 2, 3]");
    assert_eq!(shown("linspace", &[n(0.0), n(1.0), n(3.0)]), "[0, 0.5, 1]");
    assert_eq!(shown("linspace", &[n(2.0), n(1.0), n(1.0)]), "[2]");
    assert_eq!(shown("sum", &[list(&[])]), "0");
    assert_eq!(shown("zip", &[list(&[1.0, 2.0]), list(&[3.0, 4.0])]), "[[1, 3], [2, 4]]");
    assert_eq!(shown("len", &[Value::text("añb")]), "3");
    assert_eq!(fault("zip", &[list(&[1.0]), list(&[])]).0, "E0208");
    assert_eq!(fault("sort", &[Value::list(vec![n(1.0), Value::text("a")]), list(&[])]).0, "E0201");
    assert_eq!(fault("range", &[n(0.0), n(1.0), n(0.0)]).0, "E0208");
}

#[test]
fn assertions_and_errors_say_their_message() {
    assert_eq!(shown("assert", &[Value::Bool(true), Value::text("")]), "[]");
    let mut ctx = Mock::default();
    assert!(ctx.builtin("assert", &[Value::Bool(false), Value::text("the hand is on the target")]).is_err());
    assert!(ctx.builtin("error", &[Value::text("no")]).is_err());
    assert!(ctx.builtin("print", &[Value::text("half is"), n(0.5)]).is_ok());
    assert_eq!((ctx.codes(), ctx.printed), (vec!["E0401", "E0402"], vec!["half is 0.5".to_string()]));
    assert_eq!(ctx.said[0].message, "the hand is on the target");
}

#[test]
fn patterns_take_colours_numbers_and_patterns() {
    let mut ctx = Mock::default();
    let inner = ctx.builtin("checker", &[v(1.0, 0.0, 0.0), n(0.3)]).unwrap();
    assert!(matches!(ctx.builtin("stripes", &[inner.clone(), n(0.0), n(1.0)]), Ok(Value::Pattern(_))));
    let stop = |t: f64, c: f64| Value::list(vec![n(t), n(c)]);
    assert!(ctx.builtin("ramp", &[inner.clone(), stop(0.0, 1.0), stop(1.0, 0.0)]).is_ok());
    assert!(ctx.said.is_empty(), "{:?}", ctx.said);
    assert_eq!(fault("ramp", &[inner.clone(), stop(1.0, 1.0), stop(0.0, 0.0)]).0, "E0208");
    assert_eq!(fault("ramp", &[inner, n(1.0)]).0, "E0201");
    let picture = |wrap: &str| [Value::text("a.png"), Value::text(wrap), Value::text("bilinear")];
    assert!(ctx.builtin("image", &picture("mirror")).is_ok());
    assert_eq!(fault("image", &picture("repeats")).0, "E0309");
}
