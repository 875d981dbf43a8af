//! Formulas of space as tapes, which are bounded by intervals or by linear forms, and either along a ray for the search for zeros. Knows no
//! truth and judges nothing.

use crate::math::field::{Binary, Enclosed, Encloser, Field, FieldBuilder, Linear, Linearizer, Register};
use crate::math::interval::Interval;
use crate::math::isolate::Bounded;
use crate::report::naive::shapes::Line;
use std::cell::RefCell;

/// Whether x·x is known to be a square, or taken for a product of two numbers that know nothing of each other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Squares {
    /// It is.
    Known,
    /// It is not.
    Products,
}

/// A formula as a tape of x, y and z.
pub type Tape = fn(Squares) -> Field;

struct Maker {
    steps: FieldBuilder,
    squares: Squares,
}

impl Maker {
    fn of(squares: Squares, formula: impl Fn(&mut Maker, [Register; 3]) -> Register) -> Field {
        let mut maker = Maker { steps: FieldBuilder::new(3), squares };
        let inputs = [0, 1, 2].map(|i| maker.steps.input(i));
        let output = formula(&mut maker, inputs);
        maker.steps.finish(&[output]).expect("a tape of some steps")
    }

    fn square(&mut self, a: Register) -> Register {
        let b = if self.squares == Squares::Known { a } else { self.steps.variable(a) };
        self.steps.binary(Binary::Mul, a, b)
    }

    /// a + number.
    fn plus(&mut self, a: Register, number: f64) -> Register {
        let number = self.steps.constant(number);
        self.steps.binary(Binary::Add, a, number)
    }

    fn sum(&mut self, terms: [Register; 3]) -> Register {
        let two = self.steps.binary(Binary::Add, terms[0], terms[1]);
        self.steps.binary(Binary::Add, two, terms[2])
    }

    /// x² + y² + z² − 1.
    fn sphere(&mut self, p: [Register; 3]) -> Register {
        let squares = p.map(|x| self.square(x));
        let sum = self.sum(squares);
        self.plus(sum, -1.0)
    }
}

/// The unit sphere.
pub fn sphere(squares: Squares) -> Field {
    Maker::of(squares, Maker::sphere)
}

/// Its square, which is nowhere negative, less `off`².
pub fn shell(squares: Squares, off: f64) -> Field {
    Maker::of(squares, |m, p| {
        let sphere = m.sphere(p);
        let square = m.square(sphere);
        m.plus(square, -off * off)
    })
}

/// Σ x²(x² − 5) + 11.8.
pub fn tangle(squares: Squares) -> Field {
    Maker::of(squares, |m, p| {
        let terms = p.map(|x| {
            let square = m.square(x);
            let less = m.plus(square, -5.0);
            m.steps.binary(Binary::Mul, square, less)
        });
        let sum = m.sum(terms);
        m.plus(sum, 11.8)
    })
}

/// (x² + y² + z² + R² − r²)² − 4R²(x² + y²), R = 1 and r = 0.4, about z.
pub fn torus(squares: Squares) -> Field {
    Maker::of(squares, |m, p| {
        let [x, y, z] = p.map(|x| m.square(x));
        let sum = m.sum([x, y, z]);
        let inner = m.plus(sum, 1.0 - 0.4 * 0.4);
        let square = m.square(inner);
        let around = m.steps.binary(Binary::Add, x, y);
        let four = m.steps.constant(4.0);
        let around = m.steps.binary(Binary::Mul, four, around);
        m.steps.binary(Binary::Sub, square, around)
    })
}

/// A tape along a ray, bounded by intervals, or by linear forms over all that is wider than a point.
pub struct AlongTape<'f> {
    line: Line,
    value: fn([f64; 3]) -> f64,
    intervals: RefCell<Encloser<'f, 1>>,
    forms: Option<RefCell<Linearizer<'f, 1>>>,
}

impl<'f> AlongTape<'f> {
    /// By intervals.
    pub fn by_intervals(field: &'f Field, value: fn([f64; 3]) -> f64, line: Line) -> Self {
        AlongTape { line, value, intervals: Encloser::new(field).into(), forms: None }
    }

    /// By linear forms.
    pub fn by_forms(field: &'f Field, value: fn([f64; 3]) -> f64, line: Line) -> Self {
        let forms = Linearizer::reuse(field, Vec::new());
        AlongTape { forms: Some(forms.into()), ..Self::by_intervals(field, value, line) }
    }

    fn form(&self, t: Interval) -> Option<(Interval, Interval)> {
        let mut forms = self.forms.as_ref().filter(|_| t.lo < t.hi)?.borrow_mut();
        let middle = t.middle();
        let half = (t.hi - middle).max(middle - t.lo).next_up();
        let (o, d) = (self.line.origin, self.line.direction);
        let inputs: [Linear<1>; 3] = [0, 1, 2].map(|i| {
            let rest = ROUNDINGS * (o[i].abs() + (d[i] * middle).abs() + (d[i] * half).abs());
            Linear::new(o[i] + d[i] * middle, [d[i] * half], rest)
        });
        let form = forms.run(&inputs)?;
        let slope = Interval::point(form.slope[0]) + Interval::new(-form.bend[0], form.bend[0]);
        Some((form.range(), slope / Interval::point(half)))
    }
}

/// What the rounding of a place on a ray may be, as a share of what it is added up from.
const ROUNDINGS: f64 = 4.0 * f64::EPSILON;

impl Bounded for AlongTape<'_> {
    fn value(&self, t: f64) -> f64 {
        (self.value)((self.line.origin + self.line.direction * t).to_array())
    }

    fn bounds(&self, t: Interval) -> (Interval, Interval) {
        if let Some(bounds) = self.form(t) {
            return bounds;
        }
        let inputs: [Enclosed<1>; 3] = [0, 1, 2].map(|i| {
            let (o, d) = (Interval::point(self.line.origin[i]), Interval::point(self.line.direction[i]));
            Enclosed { value: o + d * t, slope: [d] }
        });
        let all = self.intervals.borrow_mut().run(&inputs);
        (all.value, all.slope[0])
    }
}
