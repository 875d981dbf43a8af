//! The fast path of arithmetic on vectors, beside that of numbers: both travel by value, without a place in a [`Value`]. What is neither is
//! set aside as there, and the general path goes on with it.

use super::Evaluator;
use super::operators;
use super::slots::Slot;
use crate::diag::Span;
use crate::geometry::any_curve::AnyCurve;
use crate::lang::resolve::program::{Access, Arithmetic, CallValue, Expr, ExprKind};
use crate::lang::table::Outcome;
use crate::lang::value::Value;
use glam::DVec3;

/// What arithmetic mostly works on.
#[derive(Clone, Copy, Debug)]
pub(super) enum Plain {
    Number(f64),
    Vector(DVec3),
    /// Another value, or a failure: in [`Evaluator::spilled`].
    Spilled,
}

impl<'p> Evaluator<'p> {
    /// The value of an expression that is to take the place of another: of a vector most likely another vector.
    #[inline]
    pub(super) fn plain_in_place_of(&mut self, access: Access, e: &'p Expr) -> Plain {
        match self.slot_of(access) {
            Some(Slot::Value(Value::Vector3(_))) => self.plain(e),
            _ => self.number(e).map_or(Plain::Spilled, Plain::Number),
        }
    }

    /// An expression's number or vector.
    #[inline(always)]
    pub(super) fn plain(&mut self, e: &'p Expr) -> Plain {
        if let ExprKind::Name(access) = &e.kind {
            match self.slot_of(*access) {
                Some(Slot::Value(Value::Number(x))) => return Plain::Number(*x),
                Some(Slot::Value(Value::Vector3(v))) => return Plain::Vector(*v),
                _ => {}
            }
        }
        self.plain_of_compound(e)
    }

    fn plain_of_compound(&mut self, e: &'p Expr) -> Plain {
        match &e.kind {
            ExprKind::Arithmetic(op, operands) => {
                let a = self.plain(&operands.0);
                self.plain_arithmetic(*op, a, &operands.1, e.span)
            }
            ExprKind::CallValue(call) => match self.point_of_call(call, e.span) {
                Some(point) => point,
                None => self.plain_of_other(e),
            },
            _ => self.plain_of_other(e),
        }
    }

    /// By the path of numbers.
    #[inline(never)]
    fn plain_of_other(&mut self, e: &'p Expr) -> Plain {
        let number = self.number(e);
        self.plain_of(number)
    }

    /// A number, or else what was set aside, which may be a vector.
    fn plain_of(&mut self, number: Option<f64>) -> Plain {
        match (number, &self.spilled) {
            (Some(x), _) => Plain::Number(x),
            (None, Ok(Value::Vector3(v))) => Plain::Vector(*v),
            (None, _) => Plain::Spilled,
        }
    }

    /// `a op right`.
    #[inline]
    pub(super) fn plain_arithmetic(
        &mut self,
        op: Arithmetic,
        a: Plain,
        right: &'p Expr,
        span: Span,
    ) -> Plain {
        if let Plain::Spilled = a {
            let (a, b) = (self.spilled(), self.plain(right));
            return self.plain_mixed(op, a, b, span);
        }
        let b = self.plain(right);
        if let (Plain::Vector(u), Plain::Vector(v)) = (a, b) {
            let joined = operators::vector3(op, u, v);
            if joined.is_finite() {
                return Plain::Vector(joined);
            }
        }
        let joined = joined(op, a, b);
        if joined.is_finite() {
            return joined;
        }
        let a = self.outcome_of(a);
        self.plain_mixed(op, a, b, span)
    }

    #[inline(never)]
    fn plain_mixed(&mut self, op: Arithmetic, a: Outcome, b: Plain, span: Span) -> Plain {
        let b = self.outcome_of(b);
        let joined = self.mixed(op, a, b, span);
        self.plain_of(joined)
    }

    /// As a value.
    #[inline]
    pub(super) fn outcome_of(&mut self, plain: Plain) -> Outcome {
        match plain {
            Plain::Number(x) => Ok(Value::Number(x)),
            Plain::Vector(v) => Ok(Value::Vector3(v)),
            Plain::Spilled => self.spilled(),
        }
    }

    /// A named curve called with a number: the commonest call of a value in a loop, made without a copy of the curve. None where it is
    /// another call, of which nothing was evaluated then.
    #[inline]
    pub(super) fn point_of_call(&mut self, call: &'p CallValue, span: Span) -> Option<Plain> {
        let (ExprKind::Name(access), Some(argument)) = (&call.callee.kind, call.steady_argument()) else {
            return None;
        };
        let Some(Slot::Value(Value::Curve(_))) = self.slot_of(*access) else { return None };
        let given = self.number(argument);
        // Still the same one, as the argument could not assign to it.
        let Some(Slot::Value(Value::Curve(curve))) = self.slot_of(*access) else { return None };
        let point = match (given, curve) {
            (Some(t), AnyCurve::Space(c)) => c.at_inside(t).map(Plain::Vector),
            (Some(t), AnyCurve::Numbers(c)) => c.at_inside(t).map(Plain::Number),
            (Some(_), AnyCurve::Plane(_)) | (None, _) => None,
        };
        if point.is_some() {
            return point;
        }
        let curve = curve.clone();
        Some(self.point_of_any(&curve, given, argument.span, span))
    }

    #[inline(never)]
    fn point_of_any(&mut self, curve: &AnyCurve, given: Option<f64>, place: Span, span: Span) -> Plain {
        let given = given.map_or_else(|| self.spilled(), |t| Ok(Value::Number(t)));
        let point = given.and_then(|given| self.call_curve(curve, given, place, span));
        let number = self.spill(point);
        self.plain_of(number)
    }
}

impl Plain {
    /// True of a finite number or vector.
    #[inline]
    fn is_finite(self) -> bool {
        match self {
            Plain::Number(x) => x.is_finite(),
            Plain::Vector(v) => v.is_finite(),
            Plain::Spilled => false,
        }
    }
}

/// `a op b`; a number beside a vector stands for every component.
#[inline]
fn joined(op: Arithmetic, a: Plain, b: Plain) -> Plain {
    match (a, b) {
        (Plain::Number(x), Plain::Number(y)) => Plain::Number(operators::number(op, x, y)),
        (Plain::Vector(u), Plain::Vector(v)) => Plain::Vector(operators::vector3(op, u, v)),
        (Plain::Vector(u), Plain::Number(y)) => Plain::Vector(operators::vector3(op, u, DVec3::splat(y))),
        (Plain::Number(x), Plain::Vector(v)) => Plain::Vector(operators::vector3(op, DVec3::splat(x), v)),
        (Plain::Spilled, _) | (_, Plain::Spilled) => Plain::Spilled,
    }
}
