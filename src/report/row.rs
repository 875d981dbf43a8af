//! A row of results: one variant of one component on one set of cases.

use serde::{Deserialize, Serialize};

/// What was measured of a variant on a case set. Units stand in the names; what does not apply is left out.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Row {
    /// What is computed: "cubic evaluation".
    pub component: String,
    /// How: "de Casteljau".
    pub variant: String,
    /// On what: "large offset".
    pub case: String,
    /// True for the variant that the renderer uses.
    pub default: bool,
    /// How many inputs.
    pub n: usize,
    /// The unit of the errors: "ulp of max |P|", "scene units", "relative".
    pub error_unit: String,
    /// Largest error.
    pub error_max: f64,
    /// 99th percentile.
    pub error_p99: f64,
    /// Mean error.
    pub error_mean: f64,
    /// Answers that should be there and are not.
    pub missed: usize,
    /// Answers that should not be there.
    pub spurious: usize,
    /// NaN or infinite answers.
    pub not_finite: usize,
    /// The input of the largest error, as hexadecimal floats.
    pub worst_input: String,
    /// Median nanoseconds per call.
    pub ns_median: f64,
    /// Median absolute deviation of the blocks.
    pub ns_mad: f64,
    /// Time over that of the component's first variant, pair by pair: median and 95 % interval.
    pub ratio: f64,
    /// Lower and upper end of the ratio's interval (bootstrap).
    pub ratio_ci: [f64; 2],
    /// Evaluations, iterations or tests per call, where they are counted.
    pub work: f64,
    /// What `work` counts.
    pub work_unit: String,
}

/// Where and with what the rows were measured; the first line of a result file.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Machine {
    /// The processor's name.
    pub cpu: String,
    /// Target architecture and the features the build may use.
    pub target: String,
    /// Version of the project.
    pub version: String,
    /// Load average over a minute when measuring began.
    pub load: f64,
    /// "quick" or "full".
    pub mode: String,
}

/// A number as a hexadecimal float, `-0x1.8p+1`: exact, and short for round numbers.
pub fn hex(x: f64) -> String {
    if !x.is_finite() {
        return x.to_string();
    }
    let bits = x.to_bits();
    let sign = if bits >> 63 == 1 { "-" } else { "" };
    let (exponent, fraction) = ((bits >> 52 & 0x7ff) as i64, bits & ((1 << 52) - 1));
    if exponent == 0 && fraction == 0 {
        return format!("{sign}0x0p+0");
    }
    let (lead, exponent) = if exponent == 0 { (0, -1022) } else { (1, exponent - 1023) };
    let digits = format!("{fraction:013x}");
    let digits = digits.trim_end_matches('0');
    let point = if digits.is_empty() { "" } else { "." };
    format!("{sign}0x{lead}{point}{digits}p{exponent:+}")
}

/// Many numbers as hexadecimal floats, separated by blanks.
pub fn hex_list(numbers: &[f64]) -> String {
    numbers.iter().map(|&x| hex(x)).collect::<Vec<_>>().join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hexadecimal_floats_are_exact() {
        for (x, text) in [
            (1.0, "0x1p+0"),
            (-3.0, "-0x1.8p+1"),
            (0.1, "0x1.999999999999ap-4"),
            (0.0, "0x0p+0"),
            (5e-324, "0x0.0000000000001p-1022"),
        ] {
            assert_eq!(hex(x), text);
        }
    }
}
