//! A row of results: one variant of one component on one set of cases.

use serde::{Deserialize, Serialize};

/// What was measured of a variant on a case set. Units stand in the names; what does not apply is left out.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Row {
    /// Its place among all rows of a run, so that files can be read in any order.
    pub order: usize,
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
    /// The first input where something was missed or spurious, as hexadecimal floats.
    #[serde(skip_serializing_if = "String::is_empty")]
    pub failed_input: String,
    /// What the variant answered, where it was asked for one input alone.
    #[serde(skip_serializing_if = "String::is_empty")]
    pub answer: String,
    /// What the default's largest error must not be above, with nothing missed, spurious or not finite.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub bar: Option<f64>,
    /// A sentence on the variant: why it is the default though others are on the frontier, or what it is known to fail.
    #[serde(skip_serializing_if = "String::is_empty")]
    pub note: String,
    /// Median nanoseconds per call.
    pub ns_median: f64,
    /// Median absolute deviation of the blocks.
    pub ns_mad: f64,
    /// Median nanoseconds of a call that waits for the answer of the one before it, where that was timed.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ns_chain: Option<f64>,
    /// Instructions per call, where a profiler counted them.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub instructions: Option<f64>,
    /// Time over that of the component's first variant, pair by pair: median and 95 % interval.
    pub ratio: f64,
    /// Lower and upper end of the ratio's interval (bootstrap).
    pub ratio_ci: [f64; 2],
    /// Evaluations, iterations or tests per call, where they are counted.
    pub work: f64,
    /// What `work` counts.
    pub work_unit: String,
}

impl Row {
    /// A row of a variant before anything is measured.
    pub(crate) fn of(subject: &super::trial::Subject, variant: &str, default: bool, note: &str) -> Row {
        Row {
            component: subject.component.into(),
            case: subject.case.into(),
            variant: variant.into(),
            default,
            note: note.into(),
            error_unit: subject.unit.into(),
            work_unit: subject.work.into(),
            bar: subject.bar.filter(|_| default),
            ..Row::default()
        }
    }

    /// False where a bar is set and passed.
    pub fn within_bar(&self) -> bool {
        let clean = self.missed + self.spurious + self.not_finite == 0;
        self.bar.is_none_or(|bar| clean && self.error_max <= bar)
    }
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
    /// The commit that was measured, where it is known.
    pub commit: String,
    /// How the program was compiled: "optimised" or "with debug assertions".
    pub build: String,
    /// The seed that every case set starts from.
    pub seed: u64,
    /// Load average over a minute when measuring began.
    pub load: f64,
    /// "quick" or "full".
    pub mode: String,
    /// What counted instructions; empty where nothing did.
    pub counter: String,
}

impl Machine {
    /// Version, commit where it is known, build, processor, target and load, as heads of pages tell them.
    pub fn told(&self) -> String {
        let Machine { cpu, target, version, commit, build, load, .. } = self;
        let commit = if commit.is_empty() { String::new() } else { format!(", commit {commit}") };
        format!("Version {version}{commit}, {build}, {cpu}, {target}; load {load:.1} at the start")
    }
}
