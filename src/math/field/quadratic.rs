//! Quadratic forms: c + Σ gᵢ εᵢ + ½ Σ hᵢⱼ εᵢ εⱼ ± r over a box of three sides, whose rest shrinks with the cube of the box, and bounds on how far the
//! derivatives are from those of the form. They are Taylor models of second order; what has no rule here is taken from its linear form.
//! Knows nothing of tapes.

use super::linear::Linear;

/// Values and derivatives over a box.
#[derive(Clone, Copy, Debug)]
pub struct Quadratic {
    /// c.
    pub middle: f64,
    /// gᵢ.
    pub slope: [f64; 3],
    /// hᵢⱼ: of xx, yy, zz, xy, xz, yz.
    pub curve: [f64; 6],
    /// r, not negative.
    pub rest: f64,
    /// How far the derivative along εᵢ may be from gᵢ + Σ hᵢⱼ εⱼ, not negative.
    pub bend: [f64; 3],
}

/// What the roundings of one step may add, as a part of the sizes it works with: far more than the thirty that a coefficient takes part in.
const BLUR: f64 = 32.0 * f64::EPSILON;
/// What underflow may add.
const LEAST: f64 = f64::MIN_POSITIVE;

/// Value and derivatives of a function of one number at a place, and a bound on its third derivative all around.
#[derive(Clone, Copy)]
pub(super) struct Expansion {
    pub value: f64,
    pub first: f64,
    pub second: f64,
    pub third: f64,
}

/// How large the parts of a form are.
struct Sizes {
    /// Σ |gᵢ|.
    slopes: f64,
    /// What the quadratic part and the rest can be.
    others: f64,
    /// Σⱼ |hᵢⱼ|.
    rows: [f64; 3],
    /// What the whole can be.
    most: f64,
}

impl Quadratic {
    /// A number that does not change.
    pub const fn constant(x: f64) -> Quadratic {
        Quadratic { middle: x, slope: [0.0; 3], curve: [0.0; 6], rest: 0.0, bend: [0.0; 3] }
    }

    /// The same as a linear form says.
    pub fn of(linear: &Linear<3>) -> Quadratic {
        Quadratic {
            middle: linear.middle,
            slope: linear.slope,
            curve: [0.0; 6],
            rest: linear.rest,
            bend: linear.bend,
        }
    }

    /// False where something was undefined or overflowed.
    pub fn is_finite(&self) -> bool {
        let sizes = self.sizes();
        (sizes.most + sizes.rows.iter().sum::<f64>() + self.bend.iter().sum::<f64>()).is_finite()
    }

    fn sizes(&self) -> Sizes {
        let [xx, yy, zz, xy, xz, yz] = self.curve.map(f64::abs);
        let slopes = self.slope.iter().map(|g| g.abs()).sum::<f64>() * (1.0 + BLUR);
        let others = (0.5 * (xx + yy + zz) + xy + xz + yz + self.rest) * (1.0 + BLUR);
        Sizes {
            slopes,
            others,
            rows: [xx + xy + xz, xy + yy + yz, xz + yz + zz],
            most: (self.middle.abs() + slopes + others) * (1.0 + BLUR),
        }
    }

    fn rounded(mut self, size: f64, sizes: [f64; 3]) -> Quadratic {
        self.rest += (size + self.rest) * BLUR + LEAST;
        for (bend, size) in self.bend.iter_mut().zip(sizes) {
            *bend += (size + *bend) * BLUR + LEAST;
        }
        self
    }

    pub(super) fn neg(self) -> Quadratic {
        Quadratic {
            middle: -self.middle,
            slope: self.slope.map(|g| -g),
            curve: self.curve.map(|h| -h),
            ..self
        }
    }

    pub(super) fn add(&self, b: &Quadratic) -> Quadratic {
        let (s, t) = (self.sizes(), b.sizes());
        let size = |i: usize| self.slope[i].abs() + b.slope[i].abs() + s.rows[i] + t.rows[i];
        Quadratic {
            middle: self.middle + b.middle,
            slope: std::array::from_fn(|i| self.slope[i] + b.slope[i]),
            curve: std::array::from_fn(|i| self.curve[i] + b.curve[i]),
            rest: self.rest + b.rest,
            bend: std::array::from_fn(|i| self.bend[i] + b.bend[i]),
        }
        .rounded(s.most + t.most, std::array::from_fn(size))
    }

    pub(super) fn mul(&self, b: &Quadratic) -> Quadratic {
        let (s, t) = (self.sizes(), b.sizes());
        let outer = outer(&self.slope, &b.slope);
        // (c + g + q)(c′ + g′ + q′) but for the products up to the second order, where q is what is not linear.
        let rest = s.slopes * t.others
            + s.others * t.slopes
            + s.others * t.others
            + self.rest * b.middle.abs()
            + b.rest * self.middle.abs();
        // a′b: of a′ = g + hε ± e what goes with what is not constant of b, and not of the second order.
        let of = |a: &Quadratic, s: &Sizes, t: &Sizes, i: usize| {
            a.slope[i].abs() * t.others + s.rows[i] * (t.slopes + t.others) + a.bend[i] * t.most
        };
        let size = |i: usize| {
            (self.slope[i].abs() + s.rows[i] + self.bend[i]) * t.most
                + (b.slope[i].abs() + t.rows[i] + b.bend[i]) * s.most
        };
        Quadratic {
            middle: self.middle * b.middle,
            slope: std::array::from_fn(|i| self.middle * b.slope[i] + b.middle * self.slope[i]),
            curve: std::array::from_fn(|i| self.middle * b.curve[i] + b.middle * self.curve[i] + outer[i]),
            rest,
            bend: std::array::from_fn(|i| of(self, &s, &t, i) + of(b, &t, &s, i)),
        }
        .rounded(s.most * t.most, std::array::from_fn(size))
    }

    /// How far it may be from the middle.
    pub(super) fn reach(&self) -> f64 {
        let sizes = self.sizes();
        (sizes.slopes + sizes.others) * (1.0 + BLUR)
    }

    /// A function of it; its value and derivatives may be off by an ulp or two.
    pub(super) fn expanded(&self, f: Expansion) -> Quadratic {
        let s = self.sizes();
        let reach = s.slopes + s.others;
        let (steep, second) = (f.first.abs(), f.second.abs());
        let outer = outer(&self.slope, &self.slope);
        let third = f.third * reach * reach;
        let bend = |i: usize| {
            let side = s.rows[i] + self.bend[i];
            steep * self.bend[i]
                + second * (s.others * self.slope[i].abs() + reach * side)
                + 0.5 * third * (self.slope[i].abs() + side)
        };
        let size = |i: usize| (steep + second * reach + third) * (self.slope[i].abs() + s.rows[i]);
        Quadratic {
            middle: f.value,
            slope: self.slope.map(|g| f.first * g),
            curve: std::array::from_fn(|i| f.first * self.curve[i] + 0.5 * f.second * outer[i]),
            rest: steep * self.rest
                + 0.5 * second * s.others * (2.0 * s.slopes + s.others)
                + third * reach / 6.0,
            bend: std::array::from_fn(bend),
        }
        .rounded(f.value.abs() + (steep + second * reach + third) * reach, std::array::from_fn(size))
    }
}

/// g g′ᵀ + g′ gᵀ.
fn outer(a: &[f64; 3], b: &[f64; 3]) -> [f64; 6] {
    let of = |i: usize, j: usize| a[i] * b[j] + a[j] * b[i];
    [of(0, 0), of(1, 1), of(2, 2), of(0, 1), of(0, 2), of(1, 2)]
}
