//! Rows as a page: bars and prices first, then a table for each case set and a plot for each component, from the JSON lines alone.

use super::plot::{Panel, Point, frontier, scatter};
use super::row::{Machine, Row};
use std::fmt::Write;

/// A file of the report.
pub struct Page {
    /// Its name: "index.md", "cubic-evaluation.svg".
    pub name: String,
    /// Its text.
    pub text: String,
}

/// Another report: its title, and the path of its page from here.
pub type Link = (String, String);

/// The whole report: `index.md` and a plot for each component.
pub fn render(machine: &Machine, rows: &[Row], beside: &[Link]) -> Vec<Page> {
    let mut index = head(machine);
    if !beside.is_empty() {
        let links: Vec<_> = beside.iter().map(|(title, path)| format!("[{title}]({path})")).collect();
        let _ = write!(index, "\nOther reports: {}.\n", links.join("; "));
    }
    bars(&mut index, rows);
    prices(&mut index, rows);
    let mut pages = Vec::new();
    for component in names(rows.iter().map(|r| &r.component)) {
        let of_component: Vec<&Row> = rows.iter().filter(|r| r.component == component).collect();
        let _ = write!(index, "\n## {}\n", capital(&component));
        let cases = by_case(&of_component);
        plot(&mut index, &mut pages, &component, &cases);
        for (case, rows) in &cases {
            table(&mut index, case, rows);
            note_default(&mut index, rows);
        }
        reproduce(&mut index, &of_component);
    }
    pages.insert(0, Page { name: "index.md".into(), text: index });
    pages
}

fn head(machine: &Machine) -> String {
    format!(
        "# Speed against error\n\n\
         `ogee bench kernels --{mode}{count}` measured it, `ogee bench report` wrote this page from [results](results) alone. {told}; seed {seed}.\n\n\
         Every variant answers the same inputs. Errors are against double-double arithmetic, exact rationals or mpmath, as each component's source says; \
         what is missed or made up is counted and never averaged into an error. Times are medians of blocks taken in turn, ± the median \
         deviation; a ratio is the median of ratios taken block by block against the first variant, with its 95 % bootstrap interval. \
         Nanoseconds are of this machine under its load; ratios and counts last longer. Calls are independent of each other, as those of a picture are; where \
         a second time is given, each call waits for the answer before it (of which no bit is taken into its first number, which is in the time). {counted}\n\n\
         In the plots ★ is the default, the line joins what nothing beats in both cost and error, and a hollow mark has wrong answers, however small \
         the error of the rest.\n",
        mode = machine.mode,
        count = if machine.counter.is_empty() { "" } else { " --count" },
        told = machine.told(),
        seed = machine.seed,
        counted = counted(machine),
    )
}

/// Where the instructions come from, or why there are none.
fn counted(machine: &Machine) -> String {
    match &*machine.counter {
        "" => "Instructions were not counted, which `--count` does where valgrind is installed: their column is empty.".into(),
        counter => format!("Instructions are those of a call as {counter} counts them, the loop around it among them: the same each time, on any machine."),
    }
}

/// What the defaults promise, and where they do not keep it.
fn bars(index: &mut String, rows: &[Row]) {
    let held: Vec<&Row> = rows.iter().filter(|r| r.bar.is_some()).collect();
    let broken: Vec<&&Row> = held.iter().filter(|r| !r.within_bar()).collect();
    let _ = write!(
        index,
        "\n## Bars\n\n{} of {} bars of the defaults are kept.",
        held.len() - broken.len(),
        held.len()
    );
    index.push_str(if broken.is_empty() { " No failure is known.\n" } else { " Known failures:\n\n" });
    for row in broken {
        let _ = writeln!(
            index,
            "- {}, {}: {} {} against a bar of {}; {} missed, {} spurious, {} not finite.",
            row.component,
            row.case,
            short(row.error_max),
            row.error_unit,
            short(row.bar.unwrap_or(0.0)),
            row.missed,
            row.spurious,
            row.not_finite
        );
    }
}

/// Where the default is slower than the first variant, and by how much.
fn prices(index: &mut String, rows: &[Row]) {
    let timed: Vec<&Row> = rows.iter().filter(|r| r.default && r.ns_median > 0.0).collect();
    if timed.is_empty() {
        return;
    }
    index.push_str(
        "\n## What the defaults cost\n\nTime over that of the first variant, which is the textbook's, over all case sets; and what that one gets wrong.\n\n\
         | component | default | ratio, least … largest | the first variant's wrong answers | its largest error |\n|---|---|---|---|---|\n",
    );
    for component in names(timed.iter().map(|r| &r.component)) {
        let own: Vec<&&Row> = timed.iter().filter(|r| r.component == component).collect();
        let (least, most) =
            own.iter().fold((f64::INFINITY, 0.0f64), |(l, m), r| (l.min(r.ratio), m.max(r.ratio)));
        let firsts: Vec<&Row> = own
            .iter()
            .filter_map(|r| rows.iter().find(|f| f.component == component && f.case == r.case))
            .collect();
        let wrong: usize = firsts.iter().map(|r| wrong(r)).sum();
        let n: usize = firsts.iter().map(|r| r.n).sum();
        let worst = firsts.iter().max_by(|a, b| a.error_max.total_cmp(&b.error_max));
        let worst =
            worst.map_or(String::new(), |r| format!("{} {} ({})", short(r.error_max), r.error_unit, r.case));
        let _ = writeln!(
            index,
            "| {component} | {} | {} … {} | {wrong} of {n} | {worst} |",
            own[0].variant,
            short(least),
            short(most)
        );
    }
}

fn wrong(row: &Row) -> usize {
    row.missed + row.spurious + row.not_finite
}

/// The different names, in the order they first come.
pub(super) fn names<'a>(all: impl Iterator<Item = &'a String>) -> Vec<String> {
    let mut names: Vec<String> = Vec::new();
    all.for_each(|name| {
        if !names.contains(name) {
            names.push(name.clone());
        }
    });
    names
}

fn by_case<'a>(rows: &[&'a Row]) -> Vec<(String, Vec<&'a Row>)> {
    let cases = names(rows.iter().map(|r| &r.case)).into_iter();
    cases.map(|case| (case.clone(), rows.iter().copied().filter(|r| r.case == case).collect())).collect()
}

fn table(index: &mut String, case: &str, rows: &[&Row]) {
    let n = rows.first().map_or(0, |r| r.n);
    let unit = rows.first().map_or(String::new(), |r| r.error_unit.replace('|', "\\|"));
    let work = rows.first().map_or("", |r| r.work_unit.as_str());
    let (work_head, work_rule) =
        if work.is_empty() { (String::new(), "") } else { (format!(" {work} |"), "---|") };
    let chained = rows.iter().any(|r| r.ns_chain.is_some());
    let (chain_head, chain_rule) = if chained { (" in a chain, ns |", "---|") } else { ("", "") };
    let _ = write!(
        index,
        "\n### {}\n\n{n} inputs.\n\n| variant | ns |{chain_head} instructions | ratio (95 %) | largest error, {unit} | 99 % | mean | missed | spurious | not finite |{work_head}\n\
         |---|---|{chain_rule}---|---|---|---|---|---|---|---|{work_rule}\n",
        capital(case)
    );
    for row in rows {
        let star = if row.default { " ★" } else { "" };
        let work = if work.is_empty() { String::new() } else { format!(" {} |", short(row.work)) };
        let chain = match row.ns_chain {
            Some(ns) => format!(" {} |", short(ns)),
            None if chained => " – |".into(),
            None => String::new(),
        };
        let _ = writeln!(
            index,
            "| {}{star} | {} |{chain} {} | {} | {} | {} | {} |{work}",
            row.variant,
            pair(row.ns_median, row.ns_mad),
            row.instructions.map_or("–".into(), short),
            ratio(row),
            [row.error_max, row.error_p99, row.error_mean].map(short).join(" | "),
            [row.missed, row.spurious].map(|n| n.to_string()).join(" | "),
            row.not_finite,
        );
    }
}

fn pair(median: f64, deviation: f64) -> String {
    if median > 0.0 { format!("{} ± {}", short(median), short(deviation)) } else { "–".into() }
}

fn ratio(row: &Row) -> String {
    if row.ns_median > 0.0 {
        format!("{} ({} … {})", short(row.ratio), short(row.ratio_ci[0]), short(row.ratio_ci[1]))
    } else {
        "–".into()
    }
}

/// One plot for a component: a panel for each case set whose variants have times.
fn plot(index: &mut String, pages: &mut Vec<Page>, component: &str, cases: &[(String, Vec<&Row>)]) {
    let panels: Vec<Panel> = cases.iter().filter_map(|(case, rows)| panel(case, rows)).collect();
    if panels.is_empty() {
        return;
    }
    let name = format!("{}.svg", slug(component));
    let _ = write!(index, "\n![{component}: cost against error]({name})\n");
    pages.push(Page { text: scatter(&capital(component), &panels), name });
}

fn panel(case: &str, rows: &[&Row]) -> Option<Panel> {
    let points = points(rows);
    let unit = &rows.first()?.error_unit;
    let error_label = if counts_alone(rows) {
        "share of wrong answers".to_owned()
    } else {
        format!("largest error, {unit}")
    };
    let panel = Panel { title: capital(case), cost_label: "ns a call".into(), error_label, points };
    (panel.points.len() > 1).then_some(panel)
}

/// True where no variant has any error but wrong answers.
fn counts_alone(rows: &[&Row]) -> bool {
    rows.iter().all(|r| r.error_max == 0.0) && rows.iter().any(|r| wrong(r) > 0)
}

fn points(rows: &[&Row]) -> Vec<Point> {
    let shares = counts_alone(rows);
    // A variant whose wrong answers leave no error to show stands at the top.
    let error = |r: &Row| if wrong(r) > 0 && r.error_max == 0.0 { f64::INFINITY } else { r.error_max };
    let point = |r: &&Row| Point {
        cost: r.ns_median,
        error: if shares { wrong(r) as f64 / r.n.max(1) as f64 } else { error(r) },
        wrong: wrong(r),
        label: r.variant.clone(),
        default: r.default,
    };
    rows.iter().filter(|r| r.ns_median > 0.0).map(point).collect()
}

/// A default off the frontier is said and why it is the default, so that the page cannot hide it.
fn note_default(index: &mut String, rows: &[&Row]) {
    let points = points(rows);
    let on = frontier(&points);
    for (i, point) in points.iter().enumerate() {
        if point.default && !on.contains(&i) {
            let note = rows.iter().find(|r| r.default).map_or("", |r| r.note.as_str());
            let why =
                if note.is_empty() { String::new() } else { format!(" It is the default because {note}.") };
            let _ = write!(index, "\nThe default, {}, is not on the frontier here.{why}\n", point.label);
        }
    }
}

/// A line for each variant that gives its largest error again, and its first wrong answer.
fn reproduce(index: &mut String, rows: &[&Row]) {
    index.push_str("\n<details><summary>The inputs of the largest errors, and of the first wrong answers</summary>\n\n```sh\n");
    for row in rows {
        for input in [&row.worst_input, &row.failed_input] {
            if !input.is_empty() {
                let _ = writeln!(
                    index,
                    "ogee bench repro '{}' '{}' '{}' {input}",
                    row.component, row.case, row.variant
                );
            }
        }
    }
    index.push_str("```\n\n</details>\n");
}

/// Three significant digits.
pub fn short(x: f64) -> String {
    if x == 0.0 {
        "0".into()
    } else if (0.001..100_000.0).contains(&x.abs()) {
        let digits = (2 - crate::math::elementary::log10(x.abs()).floor() as i32).clamp(0, 6) as usize;
        format!("{x:.digits$}")
    } else {
        format!("{x:.2e}")
    }
}

fn capital(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or(String::new(), |first| first.to_uppercase().chain(letters).collect())
}

/// A name for a file.
pub fn slug(name: &str) -> String {
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
            ratio: ns,
            error_max: error,
            worst_input: "0x1p+0".into(),
            default,
            ..Row::default()
        }
    }

    #[test]
    fn a_default_off_the_frontier_is_said_with_its_reason() {
        let slow = Row { note: "it is sure".into(), ..row("slow", 2.0, 2.0, true) };
        let pages = render(&Machine::default(), &[row("fast", 1.0, 1.0, false), slow], &[]);
        assert!(
            pages[0]
                .text
                .contains("slow, is not on the frontier here. It is the default because it is sure.")
        );
        assert!(
            pages[0].text.contains("ogee bench repro 'cubic evaluation' 'near a triple root' 'fast' 0x1p+0")
        );
        assert_eq!(pages[1].name, "cubic-evaluation.svg");
    }

    #[test]
    fn a_broken_bar_is_a_known_failure_and_the_price_is_told() {
        let broken = Row { bar: Some(1.0), ..row("slow", 2.0, 2.0, true) };
        let text = &render(&Machine::default(), &[row("fast", 1.0, 1.0, false), broken], &[])[0].text;
        assert!(text.contains("0 of 1 bars") && text.contains("Known failures:"), "{text}");
        assert!(text.contains("| cubic evaluation | slow | 2.00 … 2.00 |"), "{text}");
    }

    #[test]
    fn chains_have_a_column_where_one_was_timed() {
        let chained = Row { ns_chain: Some(7.0), ..row("slow", 2.0, 2.0, true) };
        let text = &render(&Machine::default(), &[row("fast", 1.0, 1.0, false), chained], &[])[0].text;
        assert!(text.contains("| ns | in a chain, ns | instructions | ratio"), "{text}");
        assert!(text.contains("| slow ★ | 2.00 ± 0 | 7.00 | – | 2.00"), "{text}");
        assert!(text.contains("| fast | 1.00 ± 0 | – | – | 1.00"), "{text}");
    }

    #[test]
    fn the_page_says_who_counted_instructions_or_that_nobody_did() {
        let text = |machine: &Machine, instructions| {
            let one = Row { instructions, ..row("fast", 1.0, 1.0, false) };
            render(machine, &[one], &[])[0].text.clone()
        };
        assert!(text(&Machine::default(), None).contains("their column is empty"));
        let machine = Machine { counter: "valgrind-3".into(), ..Machine::default() };
        let counted = text(&machine, Some(41.5));
        assert!(counted.contains("as valgrind-3 counts them") && counted.contains("| 41.5 |"), "{counted}");
    }

    #[test]
    fn numbers_have_three_digits() {
        assert_eq!(
            [short(0.0), short(1236.0), short(0.012345), short(1e-9)],
            ["0", "1236", "0.0123", "1.00e-9"]
        );
    }
}
