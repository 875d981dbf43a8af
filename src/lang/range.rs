//! Ranges: elements are computed from their index, so that steps do not add up their rounding.

use super::value::RangeValue;
use crate::math::error::gamma;

impl RangeValue {
    /// `start..end step step`, or `start..=end`. None for a step of 0. All numbers must be finite.
    pub fn new(start: f64, end: f64, step: f64, inclusive: bool) -> Option<RangeValue> {
        (step != 0.0).then(|| RangeValue { start, end, step, len: range_len(start, end, step, inclusive) })
    }

    /// Element `i`: start + i·step.
    #[inline]
    pub fn element(&self, i: usize) -> f64 {
        self.start + i as f64 * self.step
    }
}

/// How many elements a range has: those start + i·step before `end`, or up to it where it is inclusive.
/// Start, end and step as written are each off by half a unit in their last place, and so is every operation on them: a
/// quotient that near to a whole number counts as whole, so that `0..=0.3 step 0.1` reaches 0.3.
fn range_len(start: f64, end: f64, step: f64, inclusive: bool) -> usize {
    let steps = (end - start) / step;
    let near = gamma(4) * (start.abs() + end.abs()).max((end - start).abs()) / step.abs();
    let whole = steps.round();
    let n = match ((steps - whole).abs() <= near, inclusive) {
        (true, true) => whole + 1.0,
        (true, false) => whole,
        (false, true) => steps.floor() + 1.0,
        (false, false) => steps.ceil(),
    };
    n.max(0.0) as usize
}

#[cfg(test)]
mod tests {
    use super::range_len;

    #[test]
    fn ranges_end_where_they_are_written_to_end() {
        assert_eq!(range_len(0.0, 12.0, 1.0, false), 12);
        assert_eq!(range_len(0.0, 12.0, 1.0, true), 13);
        assert_eq!(range_len(0.0, 0.3, 0.1, true), 4);
        assert_eq!(range_len(0.0, 0.3, 0.1, false), 3);
        assert_eq!(range_len(0.0, 1.0, 0.3, true), 4);
        assert_eq!(range_len(5.0, 0.0, -1.0, false), 5);
        assert_eq!(range_len(5.0, 0.0, 1.0, false), 0);
        assert_eq!(range_len(3.0, 3.0, 1.0, true), 1);
    }
}
