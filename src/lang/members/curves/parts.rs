//! Members of curves that give other values than numbers: frames, lengths with their error, parts, points, bases, classes.

use super::{curve, faults};
use crate::diag::{Code, Diagnostic};
use crate::geometry::any_curve::{AnyCurve, IntoCurve, each_curve};
use crate::geometry::curve::Curve;
use crate::geometry::measured::Measured;
use crate::lang::eval::place;
use crate::lang::kinds::splines::{BASES, named_basis};
use crate::lang::members::Ask;
use crate::lang::table::{Context, Outcome};
use crate::lang::value::{Value, vector};
use crate::math::Point;
use std::rc::Rc;

fn point<P: Point>(p: P) -> Value {
    let c: [f64; 3] = std::array::from_fn(|i| if i < P::DIMENSION { p.coordinate(i) } else { 0.0 });
    vector(&c[..P::DIMENSION])
}

fn numbers(of: impl IntoIterator<Item = f64>) -> Value {
    Value::list(of.into_iter().map(Value::Number).collect())
}

fn shared<P: Point, T: IntoCurve<P>>(of: T) -> Value {
    Value::Curve(of.into_curve())
}

/// What only splines have.
fn spline<'m, P: Point>(ctx: &mut dyn Context, ask: &Ask<'_>, c: &'m Measured<P>) -> Outcome<&'m Curve<P>> {
    c.spline().ok_or_else(|| faults::no_pieces(ctx, ask))
}

pub fn frame(ctx: &mut dyn Context, ask: &Ask<'_>) -> Outcome {
    let AnyCurve::Space(c) = curve(ask) else { return Err(faults::wrong_dimension(ctx, ask, 3)) };
    let (t, up) = (ask.number(ctx, 0)?, ask.vector(ctx, 1)?);
    if up.length_squared() == 0.0 {
        let said = Diagnostic::new(Code::Undefined, ask.place(1), "`up` has no direction: it is 0")
            .hint("leave it out for y, or give a vector such as z");
        return Err(ctx.fail(said));
    }
    let frame = c.frame(t, up).map_err(|error| faults::report(ctx, ask, &error))?;
    Ok(Value::Transform(Rc::new(frame.to_affine())))
}

pub fn length(ctx: &mut dyn Context, ask: &Ask<'_>) -> Outcome {
    let length = each_curve!(curve(ask), c => c.length());
    ctx.estimated(length.error);
    Ok(Value::Number(length.value))
}

pub fn length_between(ctx: &mut dyn Context, ask: &Ask<'_>) -> Outcome {
    let (a, b) = (ask.number(ctx, 0)?, ask.number(ctx, 1)?);
    let length = each_curve!(curve(ask), c => c.length_between(a, b));
    let length = length.map_err(|error| faults::report(ctx, ask, &error))?;
    ctx.estimated(length.error);
    Ok(Value::Number(length.value))
}

pub fn bounds(_: &mut dyn Context, ask: &Ask<'_>) -> Outcome {
    Ok(each_curve!(curve(ask), c => {
        let (low, high) = c.bounds();
        Value::list(vec![point(low), point(high)])
    }))
}

pub fn domain(_: &mut dyn Context, ask: &Ask<'_>) -> Outcome {
    let (start, end) = curve(ask).domain();
    Ok(numbers([start, end]))
}

pub fn closed(_: &mut dyn Context, ask: &Ask<'_>) -> Outcome {
    Ok(Value::Bool(curve(ask).closed()))
}

pub fn knots(ctx: &mut dyn Context, ask: &Ask<'_>) -> Outcome {
    Ok(numbers(each_curve!(curve(ask), c => spline(ctx, ask, c)?.knots())))
}

pub fn pieces(ctx: &mut dyn Context, ask: &Ask<'_>) -> Outcome {
    each_curve!(curve(ask), c => {
        let curve = spline(ctx, ask, c)?;
        let n = curve.pieces().len();
        ctx.reserve(n, ask.arguments.span)?;
        let piece = |i: usize| shared(curve.piece(i).expect("counted"));
        Ok(Value::list((0..n).map(piece).collect()))
    })
}

pub fn piece(ctx: &mut dyn Context, ask: &Ask<'_>) -> Outcome {
    let i = ask.whole(ctx, 0)?;
    each_curve!(curve(ask), c => {
        let curve = spline(ctx, ask, c)?;
        let n = curve.pieces().len();
        match place(i, n) {
            Some(index) => Ok(shared(curve.piece(index).expect("inside"))),
            None => {
                let message = format!("there is no piece {i}: the curve has {n}");
                let said = Diagnostic::new(Code::IndexOutOfRange, ask.place(0), message)
                    .hint(format!("pieces run from 0 to {}; -1 is the last", n - 1));
                Err(ctx.fail(said))
            }
        }
    })
}

pub fn points(ctx: &mut dyn Context, ask: &Ask<'_>) -> Outcome {
    each_curve!(curve(ask), c => {
        let points = spline(ctx, ask, c)?.points();
        ctx.reserve(points.len(), ask.arguments.span)?;
        Ok(Value::list(points.iter().map(|p| point(*p)).collect()))
    })
}

pub fn split(ctx: &mut dyn Context, ask: &Ask<'_>) -> Outcome {
    let t = ask.number(ctx, 0)?;
    each_curve!(curve(ask), c => match c.split(t) {
        Ok((before, after)) => Ok(Value::list(vec![shared(before), shared(after)])),
        Err(error) => Err(faults::report(ctx, ask, &error)),
    })
}

pub fn reverse(_: &mut dyn Context, ask: &Ask<'_>) -> Outcome {
    Ok(each_curve!(curve(ask), c => shared(c.reverse())))
}

pub fn blossom(ctx: &mut dyn Context, ask: &Ask<'_>) -> Outcome {
    let (a, b, c) = (ask.number(ctx, 0)?, ask.number(ctx, 1)?, ask.number(ctx, 2)?);
    each_curve!(curve(ask), curve => {
        let curve = spline(ctx, ask, curve)?;
        match curve.blossom(a, b, c) {
            Some(value) => Ok(point(value)),
            None => {
                let n = curve.pieces().len();
                let message = format!("a blossom is of one piece, and this curve has {n}");
                let said = Diagnostic::new(Code::Undefined, ask.arguments.span, message)
                    .hint("take one of them: `path.piece(0).blossom(…)`");
                Err(ctx.fail(said))
            }
        }
    })
}

pub fn to(ctx: &mut dyn Context, ask: &Ask<'_>) -> Outcome {
    let name = ask.text(ctx, 0)?;
    let Some(basis) = named_basis(name) else {
        let names = BASES.map(|(name, _)| name);
        let said = Diagnostic::new(Code::UnknownWord, ask.place(0), format!("no basis is called \"{name}\""))
            .did_you_mean(name, names);
        let all = names.map(|name| format!("\"{name}\""));
        let said = if said.hints.is_empty() {
            said.hint(format!("the bases are {}", crate::lang::coerce::listed(&all, "and")))
        } else {
            said
        };
        return Err(ctx.fail(said));
    };
    each_curve!(curve(ask), c => match spline(ctx, ask, c)?.to(&basis) {
        Ok(changed) => Ok(shared(changed)),
        Err(error) => Err(faults::report(ctx, ask, &error)),
    })
}

pub fn continuity(ctx: &mut dyn Context, ask: &Ask<'_>) -> Outcome {
    each_curve!(curve(ask), c => {
        let seams = spline(ctx, ask, c)?.continuity();
        ctx.reserve(seams.len(), ask.arguments.span)?;
        Ok(Value::list(seams.iter().map(|seam| Value::text(seam.name())).collect()))
    })
}
