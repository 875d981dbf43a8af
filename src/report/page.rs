//! Rows as a page: a table and a plot for each component, from the JSON lines alone.

use super::plot::{Point, frontier, scatter};
use super::row::{Machine, Row};
use std::fmt::Write;

/// A file of the report.
pub struct Page {
    /// Its name: "index.md", "cubic-evaluation.svg".
    pub name: String,
    /// Its text.
    pub text: String,
}

/// The whole report: `index.md` and a plot for each component and case.
pub fn render(machine: &Machine, rows: &[Row], command: &str) -> Vec<Page> {
    let mut index = format!(
        "# Speed against error\n\nMade by `{command}` (version {}, {} mode) on {}, {}; load {:.1} at the start. Ratios are taken pair by pair against the first \
         variant of each component in one run; absolute nanoseconds are of this machine alone. The default is starred. What is missed or spurious is counted, \
         never averaged into an error. Each largest error has the input that made it, as hexadecimal floats.\n",
        machine.version, machine.mode, machine.cpu, machine.target, machine.load
    );
    let mut pages = Vec::new();
    for component in names(rows.iter().map(|r| &r.component)) {
        let _ = write!(index, "\n## {component}\n");
        let of_component: Vec<&Row> = rows.iter().filter(|r| r.component == component).collect();
        for case in names(of_component.iter().map(|r| &r.case)) {
            let of_case: Vec<&Row> = of_component.iter().copied().filter(|r| r.case == case).collect();
            section(&mut index, &mut pages, &component, &case, &of_case);
        }
    }
    pages.insert(0, Page { name: "index.md".into(), text: index });
    pages
}

/// The different names, in the order they first come.
fn names<'a>(all: impl Iterator<Item = &'a String>) -> Vec<String> {
    let mut names: Vec<String> = Vec::new();
    all.for_each(|name| {
        if !names.contains(name) {
            names.push(name.clone());
        }
    });
    names
}

fn section(index: &mut String, pages: &mut Vec<Page>, component: &str, case: &str, rows: &[&Row]) {
    let unit = rows.first().map_or("", |r| r.error_unit.as_str());
    let _ = write!(
        index,
        "\n### {case}\n\n| variant | ns | ratio (95 %) | largest error ({unit}) | 99 % | mean | missed | spurious | not finite | work | input of the largest error |\n\
         |---|---|---|---|---|---|---|---|---|---|---|\n"
    );
    for row in rows {
        let _ = writeln!(
            index,
            "| {}{} | {} ± {} | {} ({} … {}) | {} | {} | {} | {} | {} | {} | {} | `{}` |",
            row.variant,
            if row.default { " ★" } else { "" },
            short(row.ns_median),
            short(row.ns_mad),
            short(row.ratio),
            short(row.ratio_ci[0]),
            short(row.ratio_ci[1]),
            short(row.error_max),
            short(row.error_p99),
            short(row.error_mean),
            row.missed,
            row.spurious,
            row.not_finite,
            if row.work_unit.is_empty() {
                String::new()
            } else {
                format!("{} {}", short(row.work), row.work_unit)
            },
            row.worst_input,
        );
    }
    let points: Vec<Point> = rows
        .iter()
        .filter(|r| r.ns_median > 0.0)
        .map(|r| Point {
            cost: r.ns_median,
            error: r.error_max,
            label: r.variant.clone(),
            default: r.default,
        })
        .collect();
    if points.len() > 1 {
        let name = format!("{}-{}.svg", slug(component), slug(case));
        let _ = write!(index, "\n![{component}, {case}]({name})\n");
        note_default(index, &points);
        pages.push(Page {
            text: scatter(
                &format!("{component}: {case}"),
                "ns per call",
                &format!("largest error, {unit}"),
                &points,
            ),
            name,
        });
    }
}

/// A default off the frontier is said, so that the page cannot hide it.
fn note_default(index: &mut String, points: &[Point]) {
    let on = frontier(points);
    for (i, point) in points.iter().enumerate() {
        if point.default && !on.contains(&i) {
            let _ = write!(index, "\nThe default, {}, is not on the frontier of this case.\n", point.label);
        }
    }
}

/// Three significant digits.
fn short(x: f64) -> String {
    if x == 0.0 {
        "0".into()
    } else if (0.001..100_000.0).contains(&x.abs()) {
        let digits = (2 - crate::math::elementary::log10(x.abs()).floor() as i32).clamp(0, 6) as usize;
        format!("{x:.digits$}")
    } else {
        format!("{x:.2e}")
    }
}

fn slug(name: &str) -> String {
    let dashed: String =
        name.to_lowercase().chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '-' }).collect();
    dashed.split('-').filter(|part| !part.is_empty()).collect::<Vec<_>>().join("-")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(variant: &str, ns: f64, error: f64, default: bool) -> Row {
        Row {
            component: "cubic evaluation".into(),
            case: "near a triple root".into(),
            variant: variant.into(),
            ns_median: ns,
            error_max: error,
            default,
            ..Row::default()
        }
    }

    #[test]
    fn a_default_off_the_frontier_is_said() {
        let pages =
            render(&Machine::default(), &[row("fast", 1.0, 1.0, false), row("slow", 2.0, 2.0, true)], "x");
        assert!(pages[0].text.contains("slow, is not on the frontier"));
        assert_eq!(pages[1].name, "cubic-evaluation-near-a-triple-root.svg");
    }

    #[test]
    fn numbers_have_three_digits() {
        assert_eq!(
            [short(0.0), short(1236.0), short(0.012345), short(1e-9)],
            ["0", "1236", "0.0123", "1.00e-9"]
        );
    }
}
