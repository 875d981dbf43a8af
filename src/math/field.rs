//! Functions that run while rendering: a flat tape of f64 operations over registers, made from a scene's function by the
//! language layer. The tape knows nothing of names or values of the language; it can be run by any number of threads.
//!
//! A tape is data ([`Op`] is a plain enum), so that the same tape can also be run on intervals or with derivatives.
//! Evaluation never allocates for tapes of up to [`SMALL`] registers, never panics, and stops at the first operation that
//! has no finite value: the [`Fault`] names the operation's *site*, a number that the maker of the tape gave it.

mod builder;
mod enclose;
mod fold;
mod linear;
mod linearizer;
mod quadratic;
mod rules;
mod run;
mod same;
mod simplify;
mod straight;

pub use builder::{FieldBuilder, Label, TableId, TooLarge};
pub use enclose::{Choice, Enclosed, Encloser};
pub use fold::Fold;
pub use linear::Linear;
pub use linearizer::Linearizer;
pub use quadratic::Quadratic;
pub use run::SMALL;

use std::sync::Arc;
use straight::Straight;

/// A function with data of its own that tapes hold: a curve.
pub trait Held: std::fmt::Debug + Send + Sync {
    /// Reads all of `from`, fills all of `to`; false where it is undefined there.
    fn call(&self, from: &[f64], to: &mut [f64]) -> bool;
}

/// A register of a tape.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Register(pub u16);

impl Register {
    #[inline(always)]
    fn index(self) -> usize {
        self.0 as usize
    }
}

/// A number from a number.
pub type Call1 = fn(f64) -> f64;
/// A number from two.
pub type Call2 = fn(f64, f64) -> f64;
/// Numbers from numbers: reads all of the first slice, fills all of the second. NaN says "undefined here".
pub type CallN = fn(&[f64], &mut [f64]);

/// Most inputs, and most outputs, that a [`CallN`] may have.
pub const MAX_CALL: usize = 16;

/// What is known of a function that a tape calls, so that it can be bounded over intervals too. The evaluation of points reads it of sines and cosines alone.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[allow(missing_docs, reason = "each is named for its function")]
pub enum Rule {
    /// Nothing: any value, any jump.
    Opaque,
    Sin,
    Cos,
    Tan,
    Asin,
    Acos,
    Atan,
    Sinh,
    Cosh,
    Tanh,
    Exp,
    Ln,
    Log10,
    Log2,
    Cbrt,
    Sign,
    /// To the nearest whole number.
    Round,
    /// Degrees to radians.
    Radians,
    /// Radians to degrees.
    Degrees,
    /// aᵇ; by repeated products for small whole b.
    Power,
    /// Of y and x.
    Atan2,
    /// a − b·⌊a / b⌋.
    FlooredMod,
    /// a(1 − t) + bt.
    Mix,
    /// Of x, low, high.
    Clamp,
    /// Of two edges and x.
    Smoothstep,
    Cross,
    Length,
    Normalize,
    Distance,
    /// [`crate::math::noise::noise`].
    Noise,
    /// (1 + [`crate::math::noise::fbm`]) / 2, of a point, octaves, lacunarity and gain.
    Fbm,
}

/// Operations on one number.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Unary {
    /// The same.
    Copy,
    /// −a.
    Neg,
    /// 1 where a is 0, else 0.
    Not,
    /// |a|.
    Abs,
    /// √a; undefined below 0.
    Sqrt,
    /// The greatest whole number ≤ a.
    Floor,
    /// The least whole number ≥ a.
    Ceil,
}

/// Operations on two numbers. Comparisons give 1 or 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Binary {
    /// a + b.
    Add,
    /// a − b.
    Sub,
    /// a · b.
    Mul,
    /// a / b; a fault where b is 0.
    Div,
    /// Remainder with a's sign (Rust's `%`); a fault where b is 0.
    Rem,
    /// aᵇ by [`crate::math::elementary::powf`]; undefined where that is NaN.
    Pow,
    /// The lesser.
    Min,
    /// The greater.
    Max,
    /// a < b.
    Less,
    /// a ≤ b.
    LessEqual,
    /// a = b.
    Equal,
    /// a ≠ b.
    NotEqual,
}

/// A step of a tape. 16 bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[allow(
    unpredictable_function_pointer_comparisons,
    reason = "one address is one code; one code at two addresses is only taken for two"
)]
pub enum Op {
    /// to ← op a.
    Unary(Unary, Register, Register),
    /// to ← a op b, as (op, to, a, b).
    Binary(Binary, Register, Register, Register),
    /// to ← condition ≠ 0 ? a : b, as (to, condition, a, b). Both were computed already: no guard against faults.
    Select(Register, Register, Register, Register),
    /// to ← f(a).
    Call1(Call1, Rule, Register, Register),
    /// to ← f(a, b).
    Call2(Call2, Rule, Register, Register, Register),
    /// The `n_to` registers from `to` ← f(the `n_from` registers from `from`).
    CallN {
        /// What is called.
        f: CallN,
        /// What is known of it.
        rule: Rule,
        /// First of the arguments.
        from: Register,
        /// How many arguments.
        n_from: u8,
        /// First of the results.
        to: Register,
        /// How many results.
        n_to: u8,
    },
    /// The `n_to` registers from `to` ← the tape's held function of this number, of the `n_from` registers from `from`.
    CallHeld {
        /// Which.
        held: u16,
        /// First of the arguments.
        from: Register,
        /// How many arguments.
        n_from: u8,
        /// First of the results.
        to: Register,
        /// How many results.
        n_to: u8,
    },
    /// to ← table\[index\], as (to, index, table). A negative index counts from the end; outside, or not whole, is a fault.
    Table(Register, Register, u16),
    /// to ← the register `index` places after `first`, of `count`; index as in a table.
    Gather {
        /// Result.
        to: Register,
        /// Which.
        index: Register,
        /// First of the list.
        first: Register,
        /// Its length.
        count: u16,
    },
    /// Goes on at a step.
    Jump(u32),
    /// Goes on at a step where the register is 0.
    JumpIfZero(Register, u32),
    /// Goes on at a step where the register is not 0.
    JumpIfNotZero(Register, u32),
    /// A fault where the register is not finite.
    CheckFinite(Register),
    /// A fault, always: a place that must not be reached.
    Fault(FaultKind),
}

/// Why a function has no value at its arguments.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum FaultKind {
    /// Division, or remainder, by 0.
    DivisionByZero,
    /// A function outside its domain: √−1.
    Undefined,
    /// Overflow, or an infinity that is given back.
    NotFinite,
    /// An index that is outside its list or not whole.
    IndexOutOfRange,
    /// Loops that take more turns than the tape's limit.
    TooManyTurns,
    /// Zeros that could not be told apart; no tape makes it, but who looks for them does.
    Unresolved,
}

impl FaultKind {
    /// What happened, as a phrase: "a division by zero".
    pub fn text(self) -> &'static str {
        match self {
            FaultKind::DivisionByZero => "a division by zero",
            FaultKind::Undefined => "a function outside its domain",
            FaultKind::NotFinite => "a result that is not finite",
            FaultKind::IndexOutOfRange => "an index outside its list",
            FaultKind::TooManyTurns => "a loop that runs too long",
            FaultKind::Unresolved => "a surface that is too tangled to follow",
        }
    }
}

/// An operation that has no value.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Fault {
    /// The operation's site, as the tape's maker numbered it.
    pub site: u32,
    /// Why.
    pub kind: FaultKind,
}

/// A function of f64 inputs to f64 outputs. Cheap to clone. The default has no inputs and no outputs.
#[derive(Clone, Debug)]
pub struct Field {
    n_inputs: usize,
    ops: Arc<[Op]>,
    /// One site per op.
    sites: Arc<[u32]>,
    /// What registers hold at the start; inputs come first, constants are set, the rest is 0.
    initial: Arc<[f64]>,
    tables: Arc<[Box<[f64]>]>,
    held: Arc<[Arc<dyn Held>]>,
    outputs: Arc<[Register]>,
    turn_limit: u32,
    /// The same made ready for points, where that can be.
    straight: Option<Arc<Straight>>,
}

impl Default for Field {
    fn default() -> Self {
        Field {
            n_inputs: 0,
            ops: Arc::new([]),
            sites: Arc::new([]),
            initial: Arc::new([]),
            tables: Arc::new([]),
            held: Arc::new([]),
            outputs: Arc::new([]),
            turn_limit: 0,
            straight: None,
        }
    }
}

impl Field {
    /// The same, with what is made from it.
    fn ready(mut self) -> Field {
        self.straight = Straight::new(&self).map(Arc::new);
        self
    }

    /// How many numbers it takes.
    pub fn n_inputs(&self) -> usize {
        self.n_inputs
    }

    /// How many numbers it gives.
    pub fn n_outputs(&self) -> usize {
        self.outputs.len()
    }

    /// How many registers it needs.
    pub fn n_registers(&self) -> usize {
        self.initial.len()
    }

    /// Its steps.
    pub fn ops(&self) -> &[Op] {
        &self.ops
    }

    /// Computes the outputs at `inputs`. Both slices have the lengths that [`Field::n_inputs`] and [`Field::n_outputs`] say
    /// (surplus inputs are not read). Outputs are finite; they are left as they were where there is a fault.
    pub fn eval(&self, inputs: &[f64], outputs: &mut [f64]) -> Result<(), Fault> {
        run::eval(self, inputs, outputs)
    }
}

#[cfg(test)]
mod tests;
