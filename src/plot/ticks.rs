//! The numbers of an axis: round ones, a step of 1, 2 or 5 times a power of ten apart.

use crate::math::elementary::{log10, powi};

/// The round numbers in `low..=high`, at most `most` of them (but 2) and at least 1, with how they are written.
pub fn ticks(low: f64, high: f64, most: usize) -> Vec<(f64, String)> {
    if !(high > low && (high - low).is_finite()) {
        return vec![(low, label(low, 0))];
    }
    let most = most.max(2) as f64;
    let mut exponent = log10((high - low) / most).floor() as i32;
    loop {
        for digit in [1.0, 2.0, 5.0] {
            let step = digit * powi(10.0, exponent);
            // Slack of a millionth of a step: an end that is round but for rounding has its number.
            let (first, last) = ((low / step - 1e-6).ceil(), (high / step + 1e-6).floor());
            if last - first < most {
                let count = (last - first) as usize;
                let numbers = (0..=count).map(|i| (first + i as f64) * step);
                return numbers.map(|x| (x, label(x, exponent))).collect();
            }
        }
        exponent += 1;
    }
}

/// A number to the digit of the power of ten.
fn label(x: f64, exponent: i32) -> String {
    const PLAIN: std::ops::RangeInclusive<i32> = -4..=5;
    let size = if x == 0.0 { exponent } else { log10(x.abs()).floor() as i32 };
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
        ticks(low, high, most).into_iter().map(|(_, word)| word).collect()
    }

    #[test]
    fn ticks_are_round_and_lie_within() {
        assert_eq!(words(0.0, 1.0, 6), ["0.0", "0.2", "0.4", "0.6", "0.8", "1.0"]);
        assert_eq!(words(-5.0, 5.0, 5), ["-4", "-2", "0", "2", "4"].map(str::to_owned).to_vec().as_slice());
        assert_eq!(words(0.0, 3e7, 4), ["0", "1e7", "2e7", "3e7"]);
        assert_eq!(words(0.0, 2e-6, 3), ["0", "1e-6", "2e-6"]);
    }

    #[test]
    fn there_are_never_too_many() {
        for (low, high) in [(0.0, 1.0), (-3.7, 12.9), (1e-300, 3e-300), (0.999, 1.001), (-1e12, 7e11)] {
            for most in 2..12 {
                let found = ticks(low, high, most);
                assert!((1..=most).contains(&found.len()), "{low} {high} {most}: {found:?}");
                let slack = (high - low) * 1e-5;
                assert!(found.iter().all(|(x, _)| *x >= low - slack && *x <= high + slack));
            }
        }
        assert_eq!(ticks(2.0, 2.0, 5).len(), 1);
    }
}
