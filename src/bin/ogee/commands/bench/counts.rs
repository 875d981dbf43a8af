//! Instructions per call, counted by callgrind: it runs this program again for each component, counts in one function alone, and writes a
//! total whenever that returns, which is once a variant.

use crate::speech::{Ended, Exit, Failure, data, reason, tell};
use ogee::report::components::COMPONENTS;
use ogee::report::measure;
use ogee::report::row::Row;
use ogee::report::trial::Plan;
use std::path::Path;
use std::process::Command;

/// The function that is counted in, as profilers name it.
const COUNTED: &str = "ogee::report::measure::counted";

/// What counts here: "valgrind-3.19.0"; none where it is not installed.
pub fn counter() -> Option<String> {
    let asked = Command::new("valgrind").arg("--version").output().ok()?;
    let name = String::from_utf8_lossy(&asked.stdout).trim().to_owned();
    (asked.status.success() && !name.is_empty()).then_some(name)
}

/// Makes the calls of a component and says, a line for each variant in turn, how many they were: for [`fill`].
pub fn make_calls(component: &str) -> Ended {
    for row in measure(&Plan::counts(), &[component.to_owned()], |_| ()) {
        data(format!("{}\t{}\t{}\t{}\n", row.component, row.case, row.variant, row.n))?;
    }
    Ok(Exit::Done)
}

/// Counts the components whose names are in `only`, or all where it is empty, into their rows.
pub fn fill(rows: &mut [Row], only: &[String]) -> Result<(), Failure> {
    let asked = |name: &str| only.is_empty() || only.iter().any(|wanted| wanted == name);
    for (name, _) in COMPONENTS.iter().filter(|(name, _)| asked(name)) {
        tell(format!("counting {name}"));
        for (variant, instructions) in counts_of(name)? {
            let is_it = |row: &&mut Row| [&row.component, &row.case, &row.variant] == variant.each_ref();
            if let Some(row) = rows.iter_mut().find(is_it) {
                row.instructions = Some(instructions);
            }
        }
    }
    Ok(())
}

/// Of what the default may take more than it did: other compilers count some hundredths differently.
const ALLOWED: f64 = 1.1;

/// A sentence for each case where the default takes more instructions than in rows of another run, both by those of the case's first
/// variant, so that what all variants share does not tell.
pub fn grown(rows: &[Row], before: &[Row]) -> Vec<String> {
    let defaults = rows.iter().filter(|row| row.default);
    let grown = defaults.filter_map(|row| {
        let (now, then) = (ratio(rows, row)?, ratio(before, row)?);
        let more = now > then * ALLOWED;
        more.then(|| {
            let Row { component, case, .. } = row;
            format!("{component}, {case}: {now:.3} of the first variant's instructions; it was {then:.3}")
        })
    });
    grown.collect()
}

/// Instructions of a case's default over those of its first variant, where both were counted.
fn ratio(rows: &[Row], of: &Row) -> Option<f64> {
    let mut case = rows.iter().filter(|row| (&row.component, &row.case) == (&of.component, &of.case));
    let first = case.clone().min_by_key(|row| row.order)?;
    Some(case.find(|row| row.default)?.instructions? / first.instructions?)
}

/// Component, case and variant.
type Variant = [String; 3];

fn counts_of(component: &str) -> Result<Vec<(Variant, f64)>, Failure> {
    let cannot = |error: &std::io::Error| Failure::machine("cannot count instructions", reason(error));
    let folder = tempfile::tempdir().map_err(|error| cannot(&error))?;
    let totals = folder.path().join("totals");
    let program = std::env::current_exe().map_err(|error| cannot(&error))?;
    let ran = Command::new("valgrind")
        .args([
            "--tool=callgrind",
            &format!("--toggle-collect={COUNTED}"),
            &format!("--dump-after={COUNTED}"),
        ])
        .arg(format!("--callgrind-out-file={}", totals.display()))
        .arg(program)
        .args(["bench", "count", component])
        .output()
        .map_err(|error| cannot(&error))?;
    let lines = String::from_utf8_lossy(&ran.stdout).into_owned();
    let all = lines.lines().enumerate().map(|(i, line)| {
        let total = total(&totals.with_extension((i + 1).to_string()))?;
        let mut words = line.split('\t').map(str::to_owned);
        let variant = [words.next()?, words.next()?, words.next()?];
        let calls: f64 = words.next()?.parse().ok()?;
        Some((variant, total / calls))
    });
    let all: Option<Vec<_>> = all.collect();
    all.filter(|all| ran.status.success() && !all.is_empty()).ok_or_else(|| {
        Failure::machine("cannot count instructions", "valgrind did not give a total for each variant")
    })
}

/// Instructions that a file of callgrind's sums up to.
fn total(file: &Path) -> Option<f64> {
    let text = std::fs::read_to_string(file).ok()?;
    text.lines().find_map(|line| line.strip_prefix("totals: ")).and_then(|number| number.trim().parse().ok())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(order: usize, default: bool, instructions: Option<f64>) -> Row {
        let (component, case) = ("roots".into(), "any".into());
        Row { order, component, case, default, instructions, ..Row::default() }
    }

    #[test]
    fn what_takes_more_instructions_than_it_did_is_told_by_its_first_variant() {
        let run = |first, default| [row(7, true, Some(default)), row(3, false, Some(first))];
        let before = run(200.0, 100.0);
        assert!(grown(&run(200.0, 109.0), &before).is_empty());
        // Both grew alike.
        assert!(grown(&run(400.0, 200.0), &before).is_empty());
        let told = grown(&run(200.0, 111.0), &before);
        assert_eq!(told, ["roots, any: 0.555 of the first variant's instructions; it was 0.500"]);
    }

    #[test]
    fn what_was_not_counted_in_either_run_is_not_judged() {
        let counted = [row(0, false, Some(1.0)), row(1, true, Some(9.0))];
        let bare = [row(0, false, None), row(1, true, None)];
        assert!(grown(&counted, &bare).is_empty() && grown(&bare, &counted).is_empty());
        assert!(grown(&counted, &[]).is_empty());
    }
}
