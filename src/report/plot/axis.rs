//! Logarithmic axes with few, round ticks.

use crate::math::elementary::{log10, powi};

/// Numbers to places.
pub struct Axis {
    /// log₁₀ of the ends.
    from: f64,
    to: f64,
    /// Places of the ends.
    low: f64,
    high: f64,
    /// Where 0 is drawn, if some number is 0.
    floor: Option<f64>,
    ticks: Vec<(f64, String)>,
}

/// Part of an axis that is kept for the floor.
const FLOOR: f64 = 0.09;

impl Axis {
    /// Ends and ticks at 1, 2 or 5 times a power of ten: for numbers within a few decades.
    pub fn fine(numbers: impl Iterator<Item = f64>, low: f64, high: f64) -> Axis {
        let (least, most, _) = range(numbers);
        let steps: Vec<f64> = (-12..=15).flat_map(|k| [1.0, 2.0, 5.0].map(|m| m * powi(10.0, k))).collect();
        let first = steps.iter().rposition(|s| *s < least * 0.9).unwrap_or(0);
        let last = steps.iter().position(|s| *s > most * 1.1).unwrap_or(steps.len() - 1);
        let (from, to) = (log10(steps[first]), log10(steps[last]));
        let stride = if last - first > 8 { 3 } else { 1 };
        let shown = (first..=last).filter(|i| stride == 1 || i.is_multiple_of(3)).map(|i| steps[i]);
        let ticks = shown.map(|s| (log10(s), plain(s))).collect();
        Axis { from, to, low, high, floor: None, ticks }
    }

    /// Ends and ticks at powers of ten, and a floor for 0.
    pub fn decades(numbers: impl Iterator<Item = f64>, low: f64, high: f64) -> Axis {
        let (least, most, zero) = range(numbers);
        let from = (log10(least) - 0.05).floor();
        let to = (log10(most) + 0.05).ceil().max(from + 1.0);
        let floor = zero.then_some(low + (high - low) * 0.02);
        let low = if zero { low + (high - low) * FLOOR } else { low };
        let stride = ((to - from) / 6.0).ceil().max(1.0) as i32;
        let shown = (from as i32..=to as i32).filter(|k| (k - to as i32) % stride == 0);
        let ticks = shown.map(|k| (f64::from(k), power(k))).collect();
        Axis { from, to, low, high, floor, ticks }
    }

    /// The place of a number.
    pub fn at(&self, x: f64) -> f64 {
        if let (Some(floor), true) = (self.floor, x <= 0.0) {
            return floor;
        }
        self.place(log10(x.max(f64::MIN_POSITIVE)))
    }

    fn place(&self, decades: f64) -> f64 {
        let part = ((decades - self.from) / (self.to - self.from)).clamp(0.0, 1.0);
        self.low + (self.high - self.low) * part
    }

    /// Places and names.
    pub fn ticks(&self) -> impl Iterator<Item = (f64, String)> + '_ {
        let floor = self.floor.map(|at| (at, "0".to_owned()));
        self.ticks.iter().map(|(decades, name)| (self.place(*decades), name.clone())).chain(floor)
    }
}

/// Least and largest positive number, 1 where there is none; and whether one is 0.
fn range(numbers: impl Iterator<Item = f64>) -> (f64, f64, bool) {
    let (mut least, mut most, mut zero) = (f64::INFINITY, 0.0f64, false);
    for x in numbers.filter(|x| x.is_finite()) {
        zero |= x <= 0.0;
        if x > 0.0 {
            (least, most) = (least.min(x), most.max(x));
        }
    }
    if most > 0.0 { (least, most, zero) } else { (1.0, 1.0, zero) }
}

/// Three digits at most, without the rounding of powers of ten.
fn plain(x: f64) -> String {
    let k = (log10(x) + 1e-9).floor() as i32;
    let lead = (x / powi(10.0, k)).round();
    match k {
        -3..0 => format!("{x:.*}", -k as usize),
        0..=3 => format!("{x:.0}"),
        _ if lead == 1.0 => format!("1e{k}"),
        _ => format!("{lead}e{k}"),
    }
}

/// 10ᵏ, small ones written out.
fn power(k: i32) -> String {
    match k {
        -3..=3 => plain(powi(10.0, k)),
        _ => format!("1e{k}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_and_ends_hold_every_number() {
        let axis = Axis::fine([3.1, 47.0].into_iter(), 0.0, 100.0);
        let names: Vec<String> = axis.ticks().map(|(_, name)| name).collect();
        assert_eq!(names, ["2", "5", "10", "20", "50", "100"]);
        assert_eq!(
            [0.01, 0.5, 2000.0, 1e4, 2e4, 5e-7].map(plain),
            ["0.01", "0.5", "2000", "1e4", "2e4", "5e-7"]
        );
        assert!(axis.at(3.1) > 0.0 && axis.at(47.0) < 100.0);
        let axis = Axis::decades([0.0, 1e-16, 0.3].into_iter(), 100.0, 0.0);
        assert!(axis.at(0.0) > axis.at(1e-16) && axis.at(1e-16) > axis.at(0.3));
        assert!(axis.ticks().count() <= 9 && axis.ticks().any(|(_, name)| name == "0"));
    }
}
