//! Rows of tracers as a page: for each scene two plots, every picture's figures, slopes, and tables at equal time and at equal error.

use super::TracerRow;
use super::statistics::slope;
use crate::math::elementary::{exp, ln};
use crate::report::page::{Page, names, short, slug};
use crate::report::plot::lines::{Chart, Line, lines};
use crate::report::row::Machine;
use std::fmt::Write;

/// `index.md` and a plot for each scene.
pub fn render(machine: &Machine, rows: &[TracerRow]) -> Vec<Page> {
    let mut index = head(machine);
    let mut pages = Vec::new();
    for scene in names(rows.iter().map(|row| &row.scene)) {
        let own: Vec<&TracerRow> = rows.iter().filter(|row| row.scene == scene).collect();
        let variants = variants(&own);
        about(&mut index, &scene, own[0]);
        plots(&mut index, &mut pages, &scene, &variants);
        pictures(&mut index, &own);
        slopes(&mut index, &variants);
        equal_time(&mut index, &variants);
        equal_error(&mut index, &variants);
    }
    pages.insert(0, Page { name: "index.md".into(), text: index });
    pages
}

/// The rows of each variant, by rising samples.
type Variants<'a> = Vec<(String, Vec<&'a TracerRow>)>;

fn variants<'a>(rows: &[&'a TracerRow]) -> Variants<'a> {
    let mut variants: Variants<'a> = Vec::new();
    for row in rows {
        match variants.iter_mut().find(|(name, _)| *name == row.name()) {
            Some((_, own)) => own.push(row),
            None => variants.push((row.name(), vec![row])),
        }
    }
    variants.iter_mut().for_each(|(_, own)| own.sort_by_key(|row| row.samples));
    variants
}

fn head(machine: &Machine) -> String {
    format!(
        "# Tracers: time against error\n\n\
         `ogee bench tracers` measured it, `ogee bench report` wrote this page from [results](results) alone. {told}.\n\n\
         Each figure is over several pictures of one scene that differ in their seed alone, rendered in turn with those of the other variants. What seeds \
         disagree in is noise (root of the mean variance of a value; a value is a channel of a pixel); what their mean is off by is bias, less the part \
         of it that is noise of the mean and of the reference. RMSE is both together. The mean's difference is of the picture as a whole, with its \
         95 % interval; it is set in bold where it is more than chance at 1 % over all rows of the scene. Efficiency is 1 / (RMSE² · seconds) over \
         that of the first row. Seconds are of this machine under its load, of the tracer alone; ratios last longer.\n\n\
         In the plots a dashed line is of a variant whose mean is off by more than chance, so that more samples do not lead it to the reference.\n",
        told = machine.told(),
    )
}

fn about(index: &mut String, scene: &str, row: &TracerRow) {
    let floor = match row.floor > 0.0 {
        true => format!(", itself off by {} (RMSE, its noise)", short(row.floor)),
        false => String::new(),
    };
    let [w, h] = row.size;
    let _ = write!(
        index,
        "\n## {scene}\n\n{w} × {h} pixels, {} seeds. The reference is {}{floor}.\n",
        row.seeds, row.reference
    );
}

fn plots(index: &mut String, pages: &mut Vec<Page>, scene: &str, variants: &Variants<'_>) {
    let floor = variants[0].1[0].floor;
    let chart =
        |title: &str, cost_label: &str, error_label: &str, point: &dyn Fn(&TracerRow) -> (f64, f64)| Chart {
            title: title.into(),
            cost_label: cost_label.into(),
            error_label: error_label.into(),
            lines: variants.iter().map(|(name, rows)| line(name, rows, point)).collect(),
            guides: vec![(-0.5, "slope −½")],
            floor: 0.0,
        };
    let time = chart("Error over time", "seconds a picture", "RMSE", &|row| (row.seconds, row.rmse));
    let time = Chart { floor, ..time };
    let noise =
        chart("Noise over samples", "samples a pixel", "noise", &|row| (f64::from(row.samples), row.noise()));
    let noise = Chart { guides: vec![(-0.5, "−½"), (-0.75, "−¾"), (-1.0, "−1")], ..noise };
    let name = format!("{}.svg", slug(scene));
    let _ = write!(index, "\n![{scene}: error over time, noise over samples]({name})\n");
    pages.push(Page { text: lines(scene, &[time, noise]), name });
}

fn line(name: &str, rows: &[&TracerRow], point: &dyn Fn(&TracerRow) -> (f64, f64)) -> Line {
    let points = rows.iter().map(|row| point(row)).collect();
    Line { label: name.into(), points, dashed: rows.last().is_some_and(|row| row.biased) }
}

fn pictures(index: &mut String, rows: &[&TracerRow]) {
    index.push_str(
        "\n| variant | samples | seconds | Mrays | RMSE | relative MSE | 99.9 % of errors below | noise | bias | mean off by | efficiency |\n\
         |---|---|---|---|---|---|---|---|---|---|---|\n",
    );
    let efficiency = |row: &TracerRow| 1.0 / (row.rmse * row.rmse * row.seconds);
    for row in rows {
        let off = format!("{} ± {} %", percent(row.mean_off), percent(row.mean_off_by));
        let _ = writeln!(
            index,
            "| {} | {} | {} | {} | {} | {} | {} | {} | {} | {} | {} |",
            row.name(),
            row.samples,
            short(row.seconds),
            short(row.rays / 1e6),
            short(row.rmse),
            short(row.relative_mse),
            short(row.p999),
            short(row.noise()),
            short(row.bias2.max(0.0).sqrt()),
            if row.biased { format!("**{off}**") } else { off },
            short(efficiency(row) / efficiency(rows[0])),
        );
    }
}

fn percent(part: f64) -> String {
    format!("{:.2}", 100.0 * part)
}

fn slopes(index: &mut String, variants: &Variants<'_>) {
    index.push_str(
        "\n| variant | slope of its noise over samples | of its RMSE over seconds |\n|---|---|---|\n",
    );
    for (name, rows) in variants {
        let through = |point: &dyn Fn(&TracerRow) -> (f64, f64)| {
            let points: Vec<(f64, f64)> = rows
                .iter()
                .map(|row| point(row))
                .filter(|(x, y)| *x > 0.0 && *y > 0.0)
                .map(|(x, y)| (ln(x), ln(y)))
                .collect();
            match slope(&points) {
                Some((slope, by)) if by.is_finite() => format!("{slope:.2} ± {by:.2}"),
                Some((slope, _)) => format!("{slope:.2}"),
                None => "–".into(),
            }
        };
        let _ = writeln!(
            index,
            "| {name} | {} | {} |",
            through(&|row| (f64::from(row.samples), row.noise())),
            through(&|row| (row.seconds, row.rmse))
        );
    }
}

/// The longest time that every variant comes to.
fn equal_time(index: &mut String, variants: &Variants<'_>) {
    let most = |rows: &Vec<&TracerRow>| rows.iter().map(|row| row.seconds).fold(0.0, f64::max);
    let seconds = variants.iter().map(|(_, rows)| most(rows)).fold(f64::INFINITY, f64::min);
    let error = |rows: &[&TracerRow]| between(rows, |row| (row.seconds, row.rmse), seconds);
    let first = error(&variants[0].1);
    let _ =
        write!(index, "\n| at equal time, {} s | RMSE | over the first |\n|---|---|---|\n", short(seconds));
    for (name, rows) in variants {
        let _ = writeln!(index, "| {name} | {} |", with_ratio(error(rows), first));
    }
}

/// The least error that every variant comes to.
fn equal_error(index: &mut String, variants: &Variants<'_>) {
    let least = |rows: &Vec<&TracerRow>| rows.iter().map(|row| row.rmse).fold(f64::INFINITY, f64::min);
    let error = variants.iter().map(|(_, rows)| least(rows)).fold(0.0, f64::max);
    let seconds = |rows: &[&TracerRow]| between(rows, |row| (row.rmse, row.seconds), error);
    let first = seconds(&variants[0].1);
    let _ = write!(
        index,
        "\n| at equal error, RMSE {} | seconds | over the first |\n|---|---|---|\n",
        short(error)
    );
    for (name, rows) in variants {
        let _ = writeln!(index, "| {name} | {} |", with_ratio(seconds(rows), first));
    }
}

fn with_ratio(value: Option<f64>, first: Option<f64>) -> String {
    let text = |x: Option<f64>| x.map_or("–".to_owned(), short);
    format!("{} | {}", text(value), text(value.zip(first).map(|(a, b)| a / b)))
}

/// What is between two rows at x, on a straight line of both logarithms; none beyond all rows.
fn between(rows: &[&TracerRow], point: impl Fn(&TracerRow) -> (f64, f64), x: f64) -> Option<f64> {
    let mut points: Vec<(f64, f64)> = rows.iter().map(|row| point(row)).collect();
    points.sort_by(|a, b| a.0.total_cmp(&b.0));
    if let Some((_, y)) = points.iter().find(|(at, _)| *at == x) {
        return Some(*y);
    }
    let [a, b] = *points.windows(2).find(|pair| pair[0].0 < x && x < pair[1].0)? else { return None };
    let part = ln(x / a.0) / ln(b.0 / a.0);
    Some(a.1 * exp(part * ln(b.1 / a.1)))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(tracer: &str, samples: u32, seconds: f64, rmse: f64) -> TracerRow {
        TracerRow {
            scene: "room".into(),
            tracer: tracer.into(),
            sampler: "sobol".into(),
            samples,
            seeds: 16,
            seconds,
            rays: 2e6,
            rmse,
            variance: rmse * rmse,
            ..TracerRow::default()
        }
    }

    #[test]
    fn the_page_has_slopes_and_compares_at_equal_time_and_at_equal_error() {
        let rows = [
            row("path", 4, 1.0, 0.1),
            row("path", 16, 4.0, 0.05),
            row("path", 64, 16.0, 0.025),
            row("photon", 4, 2.0, 0.2),
            row("photon", 16, 8.0, 0.1),
        ];
        let pages = render(&Machine::default(), &rows);
        let text = &pages[0].text;
        for part in [
            "| path, sobol | -0.50 ± 0.00 | -0.50 ± 0.00 |",
            "| photon, sobol | -0.50 | -0.50 |",
            "| at equal time, 8.00 s | RMSE | over the first |",
            "| path, sobol | 0.0354 | 1.00 |\n| photon, sobol | 0.100 | 2.83 |",
            "| at equal error, RMSE 0.100 | seconds | over the first |",
            "| path, sobol | 1.00 | 1.00 |\n| photon, sobol | 8.00 | 8.00 |",
            "| photon, sobol | 4 | 2.00 | 2.00 | 0.200 |",
        ] {
            assert!(text.contains(part), "{part}\n{text}");
        }
        assert_eq!((&*pages[1].name, pages.len()), ("room.svg", 2));
    }
}
