//! The fast path of arithmetic on vectors, beside that of numbers: numbers travel in registers, a vector in a place of its own, neither in a
//! [`Value`]. What is neither is set aside as there, and the general path goes on with it.

use super::Evaluator;
use super::operators;
use super::slots::Slot;
use crate::diag::Span;
use crate::geometry::any_curve::AnyCurve;
use crate::lang::resolve::program::{Access, Argument, Arithmetic, CallValue, Expr, ExprKind};
use crate::lang::table::Outcome;
use crate::lang::value::Value;
use glam::DVec3;

/// What arithmetic mostly works on.
#[derive(Clone, Copy, Debug)]
pub(super) enum Plain {
    Number(f64),
    /// In [`Evaluator::vector`].
    Vector,
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
                Some(Slot::Value(Value::Vector3(v))) => {
                    self.vector = *v;
                    return Plain::Vector;
                }
                _ => {}
            }
        }
        self.plain_of_compound(e)
    }

    /// Leaps to what knows the expression.
    #[inline]
    fn plain_of_compound(&mut self, e: &'p Expr) -> Plain {
        match &e.kind {
            ExprKind::Arithmetic(op, operands) => self.plain_of_arithmetic(e, *op, operands),
            ExprKind::CallValue(call) => self.plain_of_call(e, call),
            ExprKind::Straight(straight) => match self.straight(straight) {
                Some(x) => Plain::Number(x),
                None => self.plain_of_compound(&straight.tree),
            },
            _ => self.plain_of_other(e),
        }
    }

    #[inline(never)]
    fn plain_of_arithmetic(&mut self, e: &'p Expr, op: Arithmetic, operands: &'p (Expr, Expr)) -> Plain {
        let a = self.plain(&operands.0);
        self.plain_arithmetic(op, a, &operands.1, e.span)
    }

    #[inline(never)]
    fn plain_of_call(&mut self, e: &'p Expr, call: &'p CallValue) -> Plain {
        match self.point_of_call(call) {
            Some(point) => self.plain_of_operand(point),
            None => self.plain_of_other(e),
        }
    }

    fn plain_of_operand(&mut self, operand: Operand) -> Plain {
        match operand {
            Operand::Number(x) => Plain::Number(x),
            Operand::Vector(v) => {
                self.vector = v;
                Plain::Vector
            }
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
            (None, Ok(Value::Vector3(v))) => {
                self.vector = *v;
                Plain::Vector
            }
            (None, _) => Plain::Spilled,
        }
    }

    /// `a op right`.
    #[inline(always)]
    fn plain_arithmetic(&mut self, op: Arithmetic, a: Plain, right: &'p Expr, span: Span) -> Plain {
        let a = match a {
            Plain::Number(x) => Operand::Number(x),
            Plain::Vector => Operand::Vector(self.vector),
            Plain::Spilled => return self.plain_after_spilled(op, right, span),
        };
        let b = self.plain(right);
        if let (Operand::Vector(u), Plain::Vector) = (a, b) {
            let joined = operators::vector3(op, u, self.vector);
            if joined.is_finite() {
                self.vector = joined;
                return Plain::Vector;
            }
        }
        self.plain_joined(op, a, b, span)
    }

    #[inline(never)]
    fn plain_after_spilled(&mut self, op: Arithmetic, right: &'p Expr, span: Span) -> Plain {
        let (a, b) = (self.spilled(), self.plain(right));
        self.plain_mixed(op, a, b, span)
    }

    /// `a op b`; a number beside a vector stands for every component.
    #[inline(never)]
    pub(super) fn plain_joined(&mut self, op: Arithmetic, a: Operand, b: Plain, span: Span) -> Plain {
        let splat = DVec3::splat;
        let joined = match (a, b) {
            (Operand::Number(x), Plain::Number(y)) => Operand::Number(operators::number(op, x, y)),
            (Operand::Vector(u), Plain::Vector) => Operand::Vector(operators::vector3(op, u, self.vector)),
            (Operand::Vector(u), Plain::Number(y)) => Operand::Vector(operators::vector3(op, u, splat(y))),
            (Operand::Number(x), Plain::Vector) => {
                Operand::Vector(operators::vector3(op, splat(x), self.vector))
            }
            (_, Plain::Spilled) => Operand::Number(f64::NAN),
        };
        match joined {
            Operand::Number(x) if x.is_finite() => Plain::Number(x),
            Operand::Vector(v) if v.is_finite() => {
                self.vector = v;
                Plain::Vector
            }
            Operand::Number(_) | Operand::Vector(_) => {
                let a = match a {
                    Operand::Number(x) => Value::Number(x),
                    Operand::Vector(u) => Value::Vector3(u),
                };
                self.plain_mixed(op, Ok(a), b, span)
            }
        }
    }

    /// `u op right`.
    #[inline(never)]
    pub(super) fn plain_beside(&mut self, op: Arithmetic, u: DVec3, right: &'p Expr, span: Span) -> Plain {
        self.vector = u;
        self.plain_arithmetic(op, Plain::Vector, right, span)
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
            Plain::Vector => Ok(Value::Vector3(self.vector)),
            Plain::Spilled => self.spilled(),
        }
    }

    /// A point of a named curve, called with a number: the commonest call of a value in a loop, made without a copy of the curve. None
    /// where it is another call, or must be made with more care; nothing has been said or changed then.
    #[inline(always)]
    pub(super) fn point_of_call(&self, call: &CallValue) -> Option<Operand> {
        match self.curve_of_call(call)? {
            (AnyCurve::Space(c), t) => c.at_inside(self.number_at_once(t)?).map(Operand::Vector),
            (AnyCurve::Numbers(c), t) => c.at_inside(self.number_at_once(t)?).map(Operand::Number),
            (AnyCurve::Plane(_), _) => None,
        }
    }

    /// A named curve, and what it is called with.
    #[inline(always)]
    pub(super) fn curve_of_call<'c>(&self, call: &'c CallValue) -> Option<(&AnyCurve, &'c Expr)> {
        let (ExprKind::Name(access), [Argument { name: None, value }]) =
            (&call.callee.kind, &call.arguments[..])
        else {
            return None;
        };
        let Some(Slot::Value(Value::Curve(curve))) = self.slot_of(*access) else { return None };
        Some((curve, value))
    }
}

/// What stands on the left while the right is computed.
#[derive(Clone, Copy, Debug)]
pub(super) enum Operand {
    Number(f64),
    Vector(DVec3),
}
