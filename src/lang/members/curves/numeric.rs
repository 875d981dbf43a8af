//! Members of curves that take a number or a point and give numbers: the scene's evaluation and the tapes that run while rendering
//! call the same functions.

use super::{curve, faults};
use crate::geometry::any_curve::{AnyCurve, each_curve};
use crate::geometry::curve::CurveError;
use crate::lang::builtins::components;
use crate::lang::members::{Ask, Member, Sampled};
use crate::lang::table::{Context, Outcome, Parameter};
use crate::lang::value::{Record, Value, vector};
use crate::math::Point;
use crate::math::field::Held;
use std::marker::PhantomData;
use std::rc::Rc;
use std::sync::Arc;

/// A member that is computed from numbers to numbers.
pub trait Numeric: Send + Sync + 'static {
    /// Which curves have it: points of so many numbers, first and last.
    const DIMENSIONS: [usize; 2] = [1, 3];

    /// How many numbers the argument has, on a curve of points of so many.
    fn takes(_dimension: usize) -> usize {
        1
    }

    /// How many numbers it gives, by the names of the parts.
    fn gives(dimension: usize) -> Vec<(&'static str, usize)> {
        vec![("", dimension)]
    }

    /// Reads all of `from`, fills the beginning of `to`.
    fn call(curve: &AnyCurve, from: &[f64], to: &mut Numbers) -> Result<(), CurveError>;
}

/// Room for what a member gives.
pub type Numbers = [f64; 8];

/// A method that both the scene and tapes can call.
pub const fn numeric<N: Numeric>(
    name: &'static str,
    parameters: &'static [Parameter],
    doc: &'static str,
    example: (&'static str, &'static str),
) -> Member {
    Member::method(name, parameters, doc, example, body::<N>).sampled(sampled::<N>)
}

fn body<N: Numeric>(ctx: &mut dyn Context, ask: &Ask<'_>) -> Outcome {
    let curve = curve(ask);
    let n = curve.dimension();
    if !(N::DIMENSIONS[0]..=N::DIMENSIONS[1]).contains(&n) {
        return Err(faults::wrong_dimension(ctx, ask, N::DIMENSIONS[0]));
    }
    let Some((from, m)) = ask.arguments.values.first().and_then(components) else {
        return Err(ask.wrong(ctx, 0));
    };
    if m != N::takes(n) {
        return Err(ask.wrong(ctx, 0));
    }
    let mut numbers = [0.0; 8];
    match N::call(curve, &from[..m], &mut numbers) {
        Ok(()) => Ok(assembled(&N::gives(n), &numbers)),
        Err(error) => Err(faults::report(ctx, ask, &error)),
    }
}

/// A value from its parts in a row.
fn assembled(gives: &[(&'static str, usize)], numbers: &[f64]) -> Value {
    if let [("", n)] = gives {
        return vector(&numbers[..*n]);
    }
    let mut rest = numbers;
    let part = |(name, n): &(&'static str, usize)| {
        let (first, after) = rest.split_at(*n);
        rest = after;
        (*name, vector(first))
    };
    Value::Record(Rc::new(Record { name: "a place on a curve", parts: gives.iter().map(part).collect() }))
}

/// The same for tapes.
pub fn sampled<N: Numeric>(value: &Value) -> Option<Sampled> {
    let Value::Curve(curve) = value else { return None };
    let n = curve.dimension();
    (N::DIMENSIONS[0]..=N::DIMENSIONS[1]).contains(&n).then(|| Sampled {
        takes: N::takes(n),
        gives: N::gives(n),
        held: Arc::new(HeldCurve::<N> { curve: curve.clone(), member: PhantomData }),
    })
}

/// A curve in a tape.
struct HeldCurve<N> {
    curve: AnyCurve,
    member: PhantomData<fn() -> N>,
}

impl<N> std::fmt::Debug for HeldCurve<N> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "a curve over {:?}", self.curve.domain())
    }
}

impl<N: Numeric> Held for HeldCurve<N> {
    fn call(&self, from: &[f64], to: &mut [f64]) -> bool {
        let mut numbers = [0.0; 8];
        let found = N::call(&self.curve, from, &mut numbers).is_ok();
        to.copy_from_slice(&numbers[..to.len()]);
        found
    }
}

fn put<P: Point>(point: P, to: &mut [f64]) {
    for (i, x) in to.iter_mut().enumerate().take(P::DIMENSION) {
        *x = point.coordinate(i);
    }
}

/// The point at t.
pub fn at(ctx: &mut dyn Context, ask: &Ask<'_>) -> Outcome {
    let t = ask.number(ctx, 0)?;
    point_at(curve(ask), t).map_err(|error| faults::report(ctx, ask, &error))
}

/// The point at t as a value: what loops call by the million.
#[inline]
pub fn point_at(curve: &AnyCurve, t: f64) -> Result<Value, CurveError> {
    match curve {
        AnyCurve::Numbers(c) => c.at(t).map(Value::Number),
        AnyCurve::Plane(c) => c.at(t).map(Value::Vector2),
        AnyCurve::Space(c) => c.at(t).map(Value::Vector3),
    }
}

/// Members without state.
macro_rules! members {
    ($($(#[$doc:meta])* $name:ident { $($inside:tt)* })*) => {
        $($(#[$doc])* pub struct $name;
        impl Numeric for $name { $($inside)* })*
    };
}

/// A number in the place of a point.
fn number(_: usize) -> Vec<(&'static str, usize)> {
    vec![("", 1)]
}

members! {
    /// γ(t).
    At {
        fn call(curve: &AnyCurve, from: &[f64], to: &mut Numbers) -> Result<(), CurveError> {
            each_curve!(curve, c => put(c.at(from[0])?, to));
            Ok(())
        }
    }
    /// γ′(t).
    Velocity {
        fn call(curve: &AnyCurve, from: &[f64], to: &mut Numbers) -> Result<(), CurveError> {
            each_curve!(curve, c => put(c.derivatives(from[0])?[0], to));
            Ok(())
        }
    }
    /// γ″(t).
    Acceleration {
        fn call(curve: &AnyCurve, from: &[f64], to: &mut Numbers) -> Result<(), CurveError> {
            each_curve!(curve, c => put(c.derivatives(from[0])?[1], to));
            Ok(())
        }
    }
    /// The unit tangent.
    Tangent {
        const DIMENSIONS: [usize; 2] = [2, 3];
        fn call(curve: &AnyCurve, from: &[f64], to: &mut Numbers) -> Result<(), CurveError> {
            each_curve!(curve, c => put(c.tangent(from[0])?, to));
            Ok(())
        }
    }
    /// The principal normal.
    Normal {
        const DIMENSIONS: [usize; 2] = [2, 3];
        fn call(curve: &AnyCurve, from: &[f64], to: &mut Numbers) -> Result<(), CurveError> {
            each_curve!(curve, c => put(c.normal(from[0])?, to));
            Ok(())
        }
    }
    /// Tangent × normal.
    Binormal {
        const DIMENSIONS: [usize; 2] = [3, 3];
        fn call(curve: &AnyCurve, from: &[f64], to: &mut Numbers) -> Result<(), CurveError> {
            if let AnyCurve::Space(c) = curve {
                put(c.binormal(from[0])?, to);
            }
            Ok(())
        }
    }
    /// κ(t).
    Curvature {
        const DIMENSIONS: [usize; 2] = [2, 3];
        fn gives(dimension: usize) -> Vec<(&'static str, usize)> {
            number(dimension)
        }
        fn call(curve: &AnyCurve, from: &[f64], to: &mut Numbers) -> Result<(), CurveError> {
            to[0] = each_curve!(curve, c => c.curvature(from[0])?);
            Ok(())
        }
    }
    /// τ(t).
    Torsion {
        const DIMENSIONS: [usize; 2] = [3, 3];
        fn gives(dimension: usize) -> Vec<(&'static str, usize)> {
            number(dimension)
        }
        fn call(curve: &AnyCurve, from: &[f64], to: &mut Numbers) -> Result<(), CurveError> {
            if let AnyCurve::Space(c) = curve {
                to[0] = c.torsion(from[0])?;
            }
            Ok(())
        }
    }
    /// The point at a length.
    AtLength {
        fn call(curve: &AnyCurve, from: &[f64], to: &mut Numbers) -> Result<(), CurveError> {
            each_curve!(curve, c => put(c.at(c.parameter_at(from[0])?)?, to));
            Ok(())
        }
    }
    /// The parameter at a length.
    ParameterAt {
        fn gives(dimension: usize) -> Vec<(&'static str, usize)> {
            number(dimension)
        }
        fn call(curve: &AnyCurve, from: &[f64], to: &mut Numbers) -> Result<(), CurveError> {
            to[0] = each_curve!(curve, c => c.parameter_at(from[0])?);
            Ok(())
        }
    }
    /// The nearest place to a point.
    Closest {
        fn takes(dimension: usize) -> usize {
            dimension
        }
        fn gives(dimension: usize) -> Vec<(&'static str, usize)> {
            vec![("t", 1), ("point", dimension), ("distance", 1)]
        }
        fn call(curve: &AnyCurve, from: &[f64], to: &mut Numbers) -> Result<(), CurveError> {
            each_curve!(curve, c => {
                let nearest = c.closest(Point::from_coordinates(|i| from[i]));
                to[0] = nearest.t;
                put(nearest.point, &mut to[1..]);
                to[1 + curve.dimension()] = nearest.distance;
            });
            Ok(())
        }
    }
}
