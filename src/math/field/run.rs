//! Running a tape on points.

use super::{Binary, CallN, Fault, FaultKind, Field, Held, MAX_CALL, Op, Register, Unary};
use crate::math::elementary::powf;
use std::cell::Cell;

/// Tapes of up to this many registers run on the stack; larger ones use a buffer that each thread keeps.
pub const SMALL: usize = 64;

thread_local! {
    static LARGE: Cell<Vec<f64>> = const { Cell::new(Vec::new()) };
}

pub(super) fn eval(field: &Field, inputs: &[f64], outputs: &mut [f64]) -> Result<(), Fault> {
    if let Some(straight) = &field.straight
        && straight.run(field, inputs, outputs)
    {
        return Ok(());
    }
    step_by_step(field, inputs, outputs)
}

/// As it was written, with a look for faults after each step.
fn step_by_step(field: &Field, inputs: &[f64], outputs: &mut [f64]) -> Result<(), Fault> {
    let n = field.initial.len();
    if n <= SMALL {
        let mut registers = [0.0; SMALL];
        registers[..n].copy_from_slice(&field.initial);
        return eval_in(field, &mut registers[..n], inputs, outputs);
    }
    let mut registers = LARGE.take();
    registers.clear();
    registers.extend_from_slice(&field.initial);
    let result = eval_in(field, &mut registers, inputs, outputs);
    LARGE.set(registers);
    result
}

fn eval_in(field: &Field, r: &mut [f64], inputs: &[f64], outputs: &mut [f64]) -> Result<(), Fault> {
    r[..field.n_inputs].copy_from_slice(&inputs[..field.n_inputs]);
    match steps(field, r) {
        Ok(()) => {
            for (output, register) in outputs.iter_mut().zip(field.outputs.iter()) {
                *output = r[register.index()];
            }
            Ok(())
        }
        Err((step, kind)) => Err(Fault { site: field.sites[step], kind }),
    }
}

/// Runs to the end, or to the step that has no value.
fn steps(field: &Field, r: &mut [f64]) -> Result<(), (usize, FaultKind)> {
    let (mut at, mut turns) = (0, 0);
    while let Some(&op) = field.ops.get(at) {
        let target = step(field, op, r).map_err(|kind| (at, kind))?;
        at = match target {
            None => at + 1,
            Some(target) => {
                if target as usize <= at {
                    turns += 1;
                    if turns > field.turn_limit {
                        return Err((at, FaultKind::TooManyTurns));
                    }
                }
                target as usize
            }
        };
    }
    Ok(())
}

/// One step; where it jumps to, if it jumps.
#[inline(always)]
pub(super) fn step(field: &Field, op: Op, r: &mut [f64]) -> Result<Option<u32>, FaultKind> {
    let get = |register: Register| r[register.index()];
    match op {
        Op::Unary(op, to, a) => r[to.index()] = unary(op, get(a))?,
        Op::Binary(op, to, a, b) => r[to.index()] = binary(op, get(a), get(b))?,
        Op::Select(to, condition, a, b) => {
            r[to.index()] = if get(condition) != 0.0 { get(a) } else { get(b) };
        }
        Op::Call1(f, _, to, a) => {
            let a = get(a);
            r[to.index()] = checked(f(a), a.is_finite())?;
        }
        Op::Call2(f, _, to, a, b) => {
            let (a, b) = (get(a), get(b));
            r[to.index()] = checked(f(a, b), a.is_finite() && b.is_finite())?;
        }
        Op::CallN { f, rule: _, from, n_from, to, n_to } => {
            call_n(f, r, from.index(), n_from as usize, to.index(), n_to as usize)?;
        }
        Op::CallHeld { held, from, n_from, to, n_to } => {
            let f = &*field.held[held as usize];
            call_held(f, r, from.index(), n_from as usize, to.index(), n_to as usize)?;
        }
        Op::Table(to, index, table) => {
            let table = &field.tables[table as usize];
            r[to.index()] = table[place(get(index), table.len())?];
        }
        Op::Gather { to, index, first, count } => {
            r[to.index()] = r[first.index() + place(get(index), count as usize)?];
        }
        Op::Jump(target) => return Ok(Some(target)),
        Op::JumpIfZero(condition, target) => return Ok((get(condition) == 0.0).then_some(target)),
        Op::JumpIfNotZero(condition, target) => return Ok((get(condition) != 0.0).then_some(target)),
        Op::CheckFinite(a) if get(a).is_finite() => {}
        Op::CheckFinite(a) => {
            return Err(if get(a).is_nan() { FaultKind::Undefined } else { FaultKind::NotFinite });
        }
        Op::Fault(kind) => return Err(kind),
    }
    Ok(None)
}

#[inline(always)]
fn unary(op: Unary, a: f64) -> Result<f64, FaultKind> {
    Ok(match op {
        Unary::Copy => a,
        Unary::Neg => -a,
        Unary::Not => truth(a == 0.0),
        Unary::Abs => a.abs(),
        Unary::Sqrt if a < 0.0 => return Err(FaultKind::Undefined),
        Unary::Sqrt => a.sqrt(),
        Unary::Floor => a.floor(),
        Unary::Ceil => a.ceil(),
    })
}

#[inline(always)]
fn binary(op: Binary, a: f64, b: f64) -> Result<f64, FaultKind> {
    let value = match op {
        Binary::Add => a + b,
        Binary::Sub => a - b,
        Binary::Mul => a * b,
        Binary::Div | Binary::Rem if b == 0.0 => return Err(FaultKind::DivisionByZero),
        Binary::Div => a / b,
        Binary::Rem => a % b,
        Binary::Pow => powf(a, b),
        Binary::Min => a.min(b),
        Binary::Max => a.max(b),
        Binary::Less => truth(a < b),
        Binary::LessEqual => truth(a <= b),
        Binary::Equal => truth(a == b),
        Binary::NotEqual => truth(a != b),
    };
    if value.is_finite() { Ok(value) } else { checked(value, a.is_finite() && b.is_finite()) }
}

/// A value that may be infinite only because an argument was (`inf` is a constant of the language).
#[inline(always)]
fn checked(value: f64, finite_arguments: bool) -> Result<f64, FaultKind> {
    if value.is_nan() {
        Err(FaultKind::Undefined)
    } else if value.is_infinite() && finite_arguments {
        Err(FaultKind::NotFinite)
    } else {
        Ok(value)
    }
}

fn truth(yes: bool) -> f64 {
    if yes { 1.0 } else { 0.0 }
}

/// Arguments and results pass through the stack, because both lie in one slice. A result that is not finite is a fault.
fn call_n(f: CallN, r: &mut [f64], from: usize, n: usize, to: usize, m: usize) -> Result<(), FaultKind> {
    let (mut arguments, mut results) = ([0.0; MAX_CALL], [0.0; MAX_CALL]);
    arguments[..n].copy_from_slice(&r[from..from + n]);
    f(&arguments[..n], &mut results[..m]);
    results[..m].iter().try_for_each(|&x| checked(x, true).map(drop))?;
    r[to..to + m].copy_from_slice(&results[..m]);
    Ok(())
}

/// The same for a function that the tape holds.
fn call_held(
    f: &dyn Held,
    r: &mut [f64],
    from: usize,
    n: usize,
    to: usize,
    m: usize,
) -> Result<(), FaultKind> {
    let (mut arguments, mut results) = ([0.0; MAX_CALL], [0.0; MAX_CALL]);
    arguments[..n].copy_from_slice(&r[from..from + n]);
    if !f.call(&arguments[..n], &mut results[..m]) {
        return Err(FaultKind::Undefined);
    }
    results[..m].iter().try_for_each(|&x| checked(x, true).map(drop))?;
    r[to..to + m].copy_from_slice(&results[..m]);
    Ok(())
}

/// The element that an index means in a list of `len`.
fn place(index: f64, len: usize) -> Result<usize, FaultKind> {
    let from_start = if index < 0.0 { index + len as f64 } else { index };
    let inside = from_start >= 0.0 && from_start < len as f64 && from_start == from_start.floor();
    if inside { Ok(from_start as usize) } else { Err(FaultKind::IndexOutOfRange) }
}
