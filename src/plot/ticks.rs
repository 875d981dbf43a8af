//! The numbers of an axis: round ones, a step of 1, 2 or 5 times a power of ten apart, told apart in few digits.

use crate::math::elementary::log10;

/// The round numbers of an axis.
#[derive(Debug, Default)]
pub struct Ticks {
    /// Each number with how it is written.
    pub numbers: Vec<(f64, String)>,
    /// What is to be added to what is written, with its sign: where the numbers differ in late digits only.
    pub offset: Option<String>,
}

/// More digits than these are not written: the numbers are then told by what they are off a rounder one.
const DIGITS: i32 = 6;

/// The round numbers in `low..=high`, at most `most` of them (but 2) and at least 1. Numbers as large as any and ranges as
/// narrow as the numbers allow have theirs too.
pub fn ticks(low: f64, high: f64, most: usize) -> Ticks {
    if !(high > low && low.is_finite() && high.is_finite()) {
        return Ticks { numbers: vec![(low, label(low, 0))], offset: None };
    }
    let most = most.max(2) as f64;
    // Of no step can there be fewer than the numbers themselves are apart.
    let largest = low.abs().max(high.abs());
    let apart = largest - largest.next_down();
    let width = high / most - low / most;
    let start = decade(width.max(apart));
    let steps = (start..).flat_map(|exponent| [1, 2, 5].map(|digit| (power(digit, exponent), exponent)));
    for (step, exponent) in steps.filter(|(step, _)| *step >= apart) {
        // No step is as long as the whole line of numbers.
        if !step.is_finite() {
            break;
        }
        // Slack of a millionth of a step: an end that is round but for rounding has its number.
        let (first, last) = ((low / step - 1e-6).ceil(), (high / step + 1e-6).floor());
        if last - first < most {
            return written((low, high), (first, last), step, exponent);
        }
    }
    Ticks { numbers: vec![(0.0, "0".into())], offset: None }
}

/// The numbers `first..=last` times `step`, which lie within `low..=high` but for rounding.
fn written((low, high): (f64, f64), (first, last): (f64, f64), step: f64, exponent: i32) -> Ticks {
    let many = (last - first) as usize;
    let numbers = (0..=many).map(|i| first + i as f64);
    let value = |n: f64| (n * step).clamp(f64::MIN, f64::MAX);
    let place = |n: f64| value(n).clamp(low, high);
    let digits = decade(value(first).abs().max(value(last).abs())) - exponent;
    if digits <= DIGITS {
        return Ticks {
            numbers: numbers.map(|n| (place(n), label(value(n), exponent))).collect(),
            offset: None,
        };
    }
    // A number so round that a unit of it holds them all, and a whole number of steps.
    let decade = decade((value(last) - value(first)).max(step)) + 1;
    let unit = power(1, decade);
    let units = (value(last) / unit + 1e-6).floor();
    let off = units * (unit / step).round();
    let numbers = numbers.map(|n| (place(n), label((n - off) * step, exponent))).collect();
    let offset: f64 = format!("{units}e{decade}").parse().expect("it is written as a number");
    let sign = if offset < 0.0 { '-' } else { '+' };
    Ticks { numbers, offset: Some(format!("{sign}{:e}", offset.abs())) }
}

/// The power of ten at or below a size; that of the smallest number for 0.
fn decade(size: f64) -> i32 {
    const SMALLEST: f64 = -324.0;
    log10(size).floor().max(SMALLEST) as i32
}

/// A digit times a power of ten, rounded once.
fn power(digit: i32, exponent: i32) -> f64 {
    format!("{digit}e{exponent}").parse().expect("it is written as a number")
}

/// A number to the digit of the power of ten.
fn label(x: f64, exponent: i32) -> String {
    const PLAIN: std::ops::RangeInclusive<i32> = -4..=5;
    let size = if x == 0.0 { exponent } else { decade(x.abs()) };
    if x == 0.0 && !PLAIN.contains(&exponent) {
        return "0".into();
    }
    let text = if PLAIN.contains(&size) {
        format!("{:.*}", usize::try_from(-exponent).unwrap_or(0), x)
    } else {
        format!("{:.*e}", usize::try_from(size - exponent).unwrap_or(0), x)
    };
    // What rounds to 0 has no sign.
    match text.strip_prefix('-') {
        Some(rest) if rest.chars().all(|c| matches!(c, '0' | '.')) => rest.to_owned(),
        _ => text,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn words(low: f64, high: f64, most: usize) -> Vec<String> {
        ticks(low, high, most).numbers.into_iter().map(|(_, word)| word).collect()
    }

    #[test]
    fn ticks_are_round_and_lie_within() {
        assert_eq!(words(0.0, 1.0, 6), ["0.0", "0.2", "0.4", "0.6", "0.8", "1.0"]);
        assert_eq!(words(-5.0, 5.0, 5), ["-4", "-2", "0", "2", "4"].map(str::to_owned).to_vec().as_slice());
        assert_eq!(words(0.0, 3e7, 4), ["0", "1e7", "2e7", "3e7"]);
        assert_eq!(words(0.0, 2e-6, 3), ["0", "1e-6", "2e-6"]);
    }

    /// Ranges of every size and place, the whole line of numbers and the smallest steps of it among them.
    fn ranges() -> Vec<(f64, f64)> {
        let mut ranges = vec![(0.0, 1.0), (-3.7, 12.9), (1e-300, 3e-300), (0.999, 1.001), (-1e12, 7e11)];
        ranges.extend([(f64::MIN, f64::MAX), (-1e308, 1e308), (0.0, f64::MAX), (1e308, f64::MAX)]);
        ranges.extend([(0.0, 5e-324), (-5e-324, 5e-324), (1e-323, 1e-322), (2e-308, 3e-308)]);
        for at in [1.0, -1.0, 1e15, 1e16, 123_456_789.0, 1e300, -9.99e99, f64::MAX] {
            let near = |n: usize| (0..n).fold(at, |x: f64, _| x.next_down());
            ranges.extend([1, 2, 3, 10, 1000].map(|n| (near(n), at)));
        }
        ranges
    }

    #[test]
    fn there_are_never_too_many() {
        for (low, high) in ranges() {
            for most in 2..12 {
                let found = ticks(low, high, most).numbers;
                assert!((1..=most).contains(&found.len()), "{low:e} {high:e} {most}: {found:?}");
                assert!(found.iter().all(|(x, _)| (low..=high).contains(x)), "{low:e} {high:e} {found:?}");
            }
        }
        assert_eq!(ticks(2.0, 2.0, 5).numbers.len(), 1);
    }

    #[test]
    fn different_numbers_are_written_differently_and_in_few_characters() {
        for (low, high) in ranges() {
            for most in 2..12 {
                let found = ticks(low, high, most).numbers;
                for pair in found.windows(2) {
                    assert!(pair[0].0 < pair[1].0 && pair[0].1 != pair[1].1, "{low:e} {high:e}: {found:?}");
                }
                assert!(found.iter().all(|(_, word)| word.len() <= 14), "{found:?}");
            }
        }
    }

    #[test]
    fn numbers_alike_in_their_first_digits_are_told_by_what_they_are_off_a_round_one() {
        let found = ticks(1e15, 1e15 + 1.0, 6);
        assert_eq!(found.offset.as_deref(), Some("+1e15"));
        assert_eq!(words(1e15, 1e15 + 1.0, 6), ["0.0", "0.2", "0.4", "0.6", "0.8", "1.0"]);
        let found = ticks(-1_234_567.5, -1_234_567.0, 3);
        assert_eq!(found.offset.as_deref(), Some("-1.234567e6"));
        assert_eq!(words(-1_234_567.5, -1_234_567.0, 3), ["-0.4", "-0.2", "0.0"]);
        assert_eq!(ticks(0.999, 1.001, 5).offset, None);
    }
}
