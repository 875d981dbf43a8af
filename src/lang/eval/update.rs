//! A variable that takes another value, and the commonest way in which a vector does: itself and something more, `s = s + …`, which is
//! computed where the variable stands instead of being carried there and back.

use super::Evaluator;
use super::operators;
use super::plain::{Operand, Plain};
use super::slots::Slot;
use crate::geometry::any_curve::AnyCurve;
use crate::lang::resolve::program::{Access, Arithmetic, Expr, ExprKind};
use crate::lang::table::Outcome;
use crate::lang::value::Value;
use glam::DVec3;

impl<'p> Evaluator<'p> {
    /// Gives a variable the value of an expression; poison where that failed.
    #[inline(never)]
    pub(super) fn assign(&mut self, access: Access, value: &'p Expr) -> Outcome<()> {
        match &value.kind {
            ExprKind::Straight(straight) => match self.straight(straight) {
                Some(x) => self.assign_plain(access, Plain::Number(x)),
                None => self.assign_other(access, &straight.tree),
            },
            ExprKind::Arithmetic(op, operands) if self.add_point(access, *op, operands) => Ok(()),
            _ => self.assign_other(access, value),
        }
    }

    /// `s = s ± curve(t)`, where both are vectors; whether it was that. Nothing has been said or changed where it was not.
    #[inline(always)]
    fn add_point(&mut self, access: Access, op: Arithmetic, (left, right): &'p (Expr, Expr)) -> bool {
        if let (ExprKind::Name(name), ExprKind::CallValue(call)) = (&left.kind, &right.kind)
            && *name == access
            && let Access::Local(_) | Access::Global(_) = access
            && let Some((AnyCurve::Space(curve), t)) = self.curve_of_call(call)
            && let Some(t) = self.number_at_once(t)
            && let Some(v) = curve.at_inside(t)
            && let Slot::Value(Value::Vector3(u)) = self.slot(access)
        {
            return match op {
                Arithmetic::Add => set(u, u.x + v.x, u.y + v.y, u.z + v.z),
                Arithmetic::Subtract => set(u, u.x - v.x, u.y - v.y, u.z - v.z),
                _ => false,
            };
        }
        false
    }

    #[inline(never)]
    fn assign_other(&mut self, access: Access, value: &'p Expr) -> Outcome<()> {
        if let ExprKind::Arithmetic(op, operands) = &value.kind
            && let ExprKind::Name(left) = operands.0.kind
            && left == access
            && let Access::Local(_) | Access::Global(_) = access
            && let Some(Slot::Value(Value::Vector3(u))) = self.slot_of(access)
        {
            return self.update(access, *op, *u, &operands.1, value);
        }
        let plain = self.plain_in_place_of(access, value);
        self.assign_plain(access, plain)
    }

    /// `variable = whole`, where whole is `u op right` and u what the variable holds.
    #[inline(never)]
    fn update(
        &mut self,
        access: Access,
        op: Arithmetic,
        u: DVec3,
        right: &'p Expr,
        whole: &'p Expr,
    ) -> Outcome<()> {
        let b = self.plain(right);
        if let Plain::Vector = b {
            let joined = operators::vector3(op, u, self.vector);
            if let Slot::Value(Value::Vector3(old)) = self.slot(access)
                && set(old, joined.x, joined.y, joined.z)
            {
                return Ok(());
            }
        }
        let plain = self.plain_joined(op, Operand::Vector(u), b, whole.span);
        self.assign_plain(access, plain)
    }

    fn assign_plain(&mut self, access: Access, value: Plain) -> Outcome<()> {
        if let Access::Local(_) | Access::Global(_) = access {
            let vector = self.vector;
            match (value, self.slot(access)) {
                (Plain::Number(x), Slot::Value(Value::Number(old))) => {
                    *old = x;
                    return Ok(());
                }
                (Plain::Vector, Slot::Value(Value::Vector3(old))) => {
                    *old = vector;
                    return Ok(());
                }
                _ => {}
            }
        }
        self.assign_any(access, value)
    }

    #[inline(never)]
    fn assign_any(&mut self, access: Access, value: Plain) -> Outcome<()> {
        let value = self.outcome_of(value);
        let outcome = value.as_ref().map(|_| ()).map_err(|e| *e);
        let value = value.map_or(Slot::Poison, Slot::Value);
        match access {
            Access::Captured(slot) => {
                if let Some(Slot::Shared(cell)) = self.captured.as_ref().map(|c| &c[slot as usize]) {
                    self.standing.assign_shared(cell, value);
                }
            }
            Access::Local(_) | Access::Global(_) | Access::Sibling(_) => self.slot(access).assign(value),
        }
        outcome
    }
}

/// Gives a vector other components, where they are finite; whether they are. 0 times what is not is NaN. They go from hand to hand one by
/// one: a vector that is stored in parts and read as a whole waits until all of it has come to memory.
#[inline(always)]
fn set(old: &mut DVec3, x: f64, y: f64, z: f64) -> bool {
    let is_finite = x * 0.0 + y * 0.0 + z * 0.0 == 0.0;
    if is_finite {
        (old.x, old.y, old.z) = (x, y, z);
    }
    is_finite
}
