//! Lines on logarithmic axes, as SVG: one panel a question, one line a variant with its points marked, guides of known slopes, and a level
//! below which nothing can be told.

use super::axis::Axis;
use super::labels::{Labels, Rect};
use super::{BOTTOM, HEIGHT, LEFT, RIGHT, TOP, WIDTH, frame, grid, page, text};
use std::fmt::Write;

/// A variant's line.
#[derive(Clone, Debug, PartialEq)]
pub struct Line {
    /// What to write beside its last point.
    pub label: String,
    /// Cost and error, by rising cost.
    pub points: Vec<(f64, f64)>,
    /// Drawn dashed: its error does not go on falling.
    pub dashed: bool,
}

/// Lines that answer one question.
#[derive(Clone, Debug, PartialEq)]
pub struct Chart {
    /// The question.
    pub title: String,
    /// What the cost is.
    pub cost_label: String,
    /// What the error is.
    pub error_label: String,
    /// The variants.
    pub lines: Vec<Line>,
    /// Slopes to compare with, each with its name.
    pub guides: Vec<(f64, &'static str)>,
    /// The error of the reference itself; 0 where it is not known.
    pub floor: f64,
}

/// Colours that are told apart by all eyes (Tol, *Colour schemes*, 2021, "bright").
const COLOURS: [&str; 7] = ["#cc3311", "#4477aa", "#228833", "#aa3377", "#ccbb44", "#66ccee", "#555555"];

/// All charts as one SVG file.
pub fn lines(title: &str, charts: &[Chart]) -> String {
    page(title, charts.len(), |svg, i| draw(svg, &charts[i]))
}

fn draw(svg: &mut String, chart: &Chart) {
    let all = || chart.lines.iter().flat_map(|line| &line.points);
    let floor = Some(chart.floor).filter(|floor| *floor > 0.0);
    let x = Axis::fine(all().map(|p| p.0), LEFT, WIDTH - RIGHT);
    let y = Axis::decades(all().map(|p| p.1).chain(floor), HEIGHT - BOTTOM, TOP);
    frame(svg, &chart.title, &chart.cost_label, &chart.error_label);
    grid(svg, &x, &y);
    let place = |p: &(f64, f64)| (x.at(p.0), y.at(p.1));
    let first = all().copied().reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)));
    let last = all().map(|p| p.0).fold(0.0, f64::max);
    for (slope, name) in &chart.guides {
        first.iter().for_each(|first| guide(svg, &place, *first, last, (*slope, name)));
    }
    if let Some(floor) = floor {
        let at = y.at(floor);
        let _ = writeln!(
            svg,
            "<path d=\"M{LEFT} {at:.1}H{}\" stroke=\"#888\" stroke-dasharray=\"2 3\"/>",
            WIDTH - RIGHT
        );
        text(svg, (LEFT + 4.0, at - 3.0), "start", "fill=\"#666\" font-size=\"9\"", "noise of the reference");
    }
    let area = Rect { left: LEFT, top: TOP, right: WIDTH - 2.0, bottom: HEIGHT - BOTTOM };
    let mut labels = Labels::new(area, all().map(place), &[]);
    for (line, colour) in chart.lines.iter().zip(COLOURS.iter().cycle()) {
        one(svg, &mut labels, line, colour, &place);
    }
}

/// A grey line of a slope from the corner of all points.
fn guide(
    svg: &mut String,
    place: &impl Fn(&(f64, f64)) -> (f64, f64),
    first: (f64, f64),
    last: f64,
    (slope, name): (f64, &str),
) {
    use crate::math::elementary::powf;
    let (from, to) = (place(&first), place(&(last, first.1 * powf(last / first.0, slope))));
    // Where the line leaves the axes by the bottom it is cut there.
    let bottom = HEIGHT - BOTTOM;
    let part = if to.1 >= bottom { (bottom - from.1) / (to.1 - from.1) } else { 1.0 };
    let end = (from.0 + (to.0 - from.0) * part, from.1 + (to.1 - from.1) * part);
    let _ = writeln!(
        svg,
        "<path d=\"M{:.1} {:.1}L{:.1} {:.1}\" stroke=\"#bbb\" stroke-dasharray=\"5 3\"/>",
        from.0, from.1, end.0, end.1
    );
    text(svg, (end.0, end.1 - 4.0), "end", "fill=\"#888\" font-size=\"9\"", name);
}

fn one(
    svg: &mut String,
    labels: &mut Labels,
    line: &Line,
    colour: &str,
    place: &impl Fn(&(f64, f64)) -> (f64, f64),
) {
    let places: Vec<(f64, f64)> = line.points.iter().map(place).collect();
    let path: Vec<String> = places.iter().map(|(x, y)| format!("{x:.1},{y:.1}")).collect();
    let dash = if line.dashed { " stroke-dasharray=\"6 3\"" } else { "" };
    let _ = writeln!(
        svg,
        "<polyline points=\"{}\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"1.5\"{dash}/>",
        path.join(" ")
    );
    for (x, y) in &places {
        let _ = writeln!(svg, "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"2.6\" fill=\"{colour}\"/>");
    }
    if let Some(end) = places.last() {
        let label = labels.place(*end, &line.label);
        text(svg, (label.x, label.y), label.anchor, &format!("fill=\"{colour}\""), &line.label);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_chart_has_every_line_its_guides_and_the_floor_and_stays_in_its_frame() {
        let line = |label: &str, slope: f64| Line {
            label: label.into(),
            points: (0..4)
                .map(|i| (f64::from(4i32.pow(i)), 0.1 * f64::from(4i32.pow(i)).powf(slope)))
                .collect(),
            dashed: false,
        };
        let chart = Chart {
            title: "noise".into(),
            cost_label: "samples".into(),
            error_label: "RMSE".into(),
            lines: vec![line("path, sobol", -0.6), line("photon, sobol", -0.5)],
            guides: vec![(-0.5, "−½"), (-1.5, "−1.5")],
            floor: 1e-3,
        };
        let svg = lines("a scene", &[chart]);
        for part in [">path, sobol<", ">photon, sobol<", ">−½<", ">−1.5<", "noise of the reference"] {
            assert!(svg.contains(part), "{part}");
        }
        assert_eq!(svg.matches("<circle").count(), 8);
        assert!(!svg.contains("NaN") && !svg.contains("inf"));
        let bottom = HEIGHT - BOTTOM;
        let lowest = svg.split("cy=\"").skip(1).map(|s| s.split('"').next().unwrap().parse::<f64>().unwrap());
        assert!(lowest.into_iter().all(|y| (TOP..=bottom).contains(&y)));
    }
}
