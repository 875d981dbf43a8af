//! Integrals of smooth functions of one variable with an error estimate. Knows nothing of curves.
//!
//! Gauss–Kronrod 7/15 (QUADPACK's QK15), adaptively halved, worst interval first.

/// An integral and how far it may be off.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Integral {
    /// The value.
    pub value: f64,
    /// Estimated absolute error, rounding included.
    pub error: f64,
}

/// An interval with the integral over it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Leaf {
    /// Lower end.
    pub start: f64,
    /// Upper end.
    pub end: f64,
    /// The integral between them.
    pub integral: Integral,
    /// The part of its error that no halving can help.
    rounding: f64,
}

/// Abscissae of the Kronrod rule on [−1, 1], the positive half, largest first; odd places are Gauss's.
const NODES: [f64; 8] = [
    0.9914553711208126,
    0.9491079123427585,
    0.8648644233597691,
    0.7415311855993945,
    0.5860872354676911,
    0.4058451513773972,
    0.20778495500789848,
    0.0,
];
/// Weights of the Kronrod rule.
const KRONROD: [f64; 8] = [
    0.022935322010529224,
    0.06309209262997856,
    0.10479001032225019,
    0.14065325971552592,
    0.1690047266392679,
    0.19035057806478542,
    0.20443294007529889,
    0.20948214108472782,
];
/// Weights of the Gauss rule at the odd places.
const GAUSS: [f64; 4] = [0.1294849661688697, 0.27970539148927664, 0.3818300505051189, 0.4179591836734694];

/// Evaluations that one application of the rule costs.
pub const EVALUATIONS: usize = 15;

/// The rule on one interval, undivided.
pub fn rule(start: f64, end: f64, f: &mut impl FnMut(f64) -> f64) -> Integral {
    estimate(start, end, f).0
}

/// The rule, and what of its error no halving can help.
fn estimate(start: f64, end: f64, f: &mut impl FnMut(f64) -> f64) -> (Integral, f64) {
    let (center, half) = (0.5 * (start + end), 0.5 * (end - start));
    let middle = f(center);
    let (mut kronrod, mut gauss) = (middle * KRONROD[7], middle * GAUSS[3]);
    let (mut least, mut most) = (middle, middle);
    for i in 0..7 {
        let offset = half * NODES[i];
        let (below, above) = (f(center - offset), f(center + offset));
        (least, most) = (least.min(below).min(above), most.max(below).max(above));
        let pair = below + above;
        kronrod += pair * KRONROD[i];
        if i % 2 == 1 {
            gauss += pair * GAUSS[i / 2];
        }
    }
    let value = kronrod * half;
    // Sixteen roundings of a sum of positive terms would be 16 u; they rarely line up, and u each is what is seen. And each node is
    // itself rounded, which moves the sum by that times how much f varies.
    let nodes = f64::EPSILON * start.abs().max(end.abs()) * (most - least);
    let rounding = 4.0 * f64::EPSILON * value.abs() + nodes;
    (Integral { value, error: (kronrod - gauss).abs() * half + rounding }, rounding)
}

/// Leaves that together cover `[start, end]`, in order, whose errors sum to at most `tolerance`, or the best that
/// `max_evaluations` allow. Leaves whose estimate is at the level of rounding are not divided further. `f` may nearly vanish at
/// `start` or `end`, like √(x² + ε²), and not between.
pub fn adaptive(
    start: f64,
    end: f64,
    tolerance: f64,
    max_evaluations: usize,
    f: &mut impl FnMut(f64) -> f64,
) -> Vec<Leaf> {
    let ends = [(start, f(start)), (end, f(end))];
    let mut leaf = |start: f64, end: f64| {
        let (mut integral, rounding) = estimate(start, end, f);
        let at_end = |(at, value): &(f64, f64)| {
            if *at == start || *at == end { hidden(*value, end - start, integral.value) } else { 0.0 }
        };
        integral.error += ends.iter().map(at_end).sum::<f64>();
        Leaf { start, end, integral, rounding }
    };
    let mut leaves = vec![leaf(start, end)];
    let mut evaluations = EVALUATIONS + ends.len();
    let mut total = leaves[0].integral.error;
    while total > tolerance && evaluations + 2 * EVALUATIONS <= max_evaluations {
        let Some(worst) = worst_divisible(&leaves) else { break };
        let Leaf { start, end, .. } = leaves[worst];
        let middle = 0.5 * (start + end);
        leaves[worst] = leaf(start, middle);
        leaves.insert(worst + 1, leaf(middle, end));
        evaluations += 2 * EVALUATIONS;
        total = leaves.iter().map(|leaf| leaf.integral.error).sum();
    }
    leaves
}

/// A value at an end below this part of the far one is beyond the outermost node of the rule, whose distance is 1/234 of the width.
const UNSEEN: f64 = 1.0 / 200.0;

/// What both rules leave out of a function like √((ax)² + ε²) whose value at an end is ε, where neither has a node near enough to see
/// the bend: ∫ is ah²/2 + ε²/(2a) (½ + ln(2ah/ε)) to the order of ε². 0 where they see it.
fn hidden(at_end: f64, width: f64, integral: f64) -> f64 {
    let far = 2.0 * integral / width;
    if !(at_end > 0.0 && at_end < UNSEEN * far) {
        return 0.0;
    }
    at_end * at_end * width / (2.0 * far) * (0.5 + super::elementary::ln(2.0 * far / at_end))
}

/// The leaf with the largest error among those that halving can still help.
fn worst_divisible(leaves: &[Leaf]) -> Option<usize> {
    let divisible = |leaf: &Leaf| {
        let middle = 0.5 * (leaf.start + leaf.end);
        let above_rounding = leaf.integral.error > 2.0 * leaf.rounding;
        above_rounding && middle > leaf.start && middle < leaf.end
    };
    let candidates = leaves.iter().enumerate().filter(|(_, leaf)| divisible(leaf));
    candidates.max_by(|(_, a), (_, b)| a.integral.error.total_cmp(&b.integral.error)).map(|(i, _)| i)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn total(leaves: &[Leaf]) -> Integral {
        leaves.iter().fold(Integral::default(), |sum, leaf| Integral {
            value: sum.value + leaf.integral.value,
            error: sum.error + leaf.integral.error,
        })
    }

    #[test]
    fn polynomials_of_degree_22_are_exact() {
        let exact = rule(0.0, 1.0, &mut |x| crate::math::elementary::powi(x, 22));
        assert!((exact.value - 1.0 / 23.0).abs() < 1e-16);
    }

    #[test]
    fn a_bend_at_an_end_too_narrow_for_the_nodes_is_in_the_estimate() {
        for k in 0..200 {
            let width = crate::math::elementary::exp2(-f64::from(k) / 6.0);
            let mut n = 0;
            let leaves = adaptive(0.0, 1.0, 1e-14, 600, &mut |x| {
                n += 1;
                (x * x + width * width).sqrt()
            });
            let r = (1.0 + width * width).sqrt();
            let truth = 0.5 * (r + width * width * crate::math::elementary::ln((1.0 + r) / width));
            let got = total(&leaves);
            let off = (got.value - truth).abs();
            assert!(off <= got.error && off <= 1e-14 && n <= 600, "{width:e}: {off:e} {got:?} {n}");
        }
    }

    #[test]
    fn a_near_kink_is_divided_within_its_budget() {
        let mut n = 0;
        let width: f64 = 1e-6;
        let leaves = adaptive(-1.0, 1.0, 1e-13, 2000, &mut |x| {
            n += 1;
            (x * x + width * width).sqrt()
        });
        let r = (1.0 + width * width).sqrt();
        let truth = r + width * width * crate::math::elementary::ln((1.0 + r) / width);
        let got = total(&leaves);
        assert!((got.value - truth).abs() < 1e-13 && n <= 2000, "{got:?} {truth} {n}");
        assert!(leaves.windows(2).all(|w| w[0].end == w[1].start));
    }
}
