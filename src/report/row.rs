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
