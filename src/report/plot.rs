//! Scatters of cost against error on logarithmic axes, as SVG: one panel a case set, every variant a labelled point, the Pareto frontier
//! joined, the default starred, a variant with wrong answers hollow and off the frontier.

mod axis;
mod labels;
pub mod lines;

use axis::Axis;
use labels::{Labels, Rect};
use std::fmt::Write;

/// A variant on a panel.
#[derive(Clone, Debug, PartialEq)]
pub struct Point {
    /// Cost, > 0; left is better.
    pub cost: f64,
    /// Error, ≥ 0; low is better. 0 is drawn on a floor of its own, infinity at the top.
    pub error: f64,
    /// Answers missed, spurious or not finite.
    pub wrong: usize,
    /// What to write beside it.
    pub label: String,
    /// Starred.
    pub default: bool,
}

/// The variants on one case set.
#[derive(Clone, Debug, PartialEq)]
pub struct Panel {
    /// The case set.
    pub title: String,
    /// What the cost is.
    pub cost_label: String,
    /// What the error is.
    pub error_label: String,
    /// The variants.
    pub points: Vec<Point>,
}

/// The points that no other beats in both cost and error, by rising cost; those with wrong answers are none of them.
pub fn frontier(points: &[Point]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..points.len()).filter(|&i| points[i].wrong == 0).collect();
    order.sort_by(|&a, &b| {
        let (p, q) = (&points[a], &points[b]);
        p.cost.total_cmp(&q.cost).then(p.error.total_cmp(&q.error)).then(a.cmp(&b))
    });
    let mut least = f64::INFINITY;
    order.retain(|&i| {
        let better = points[i].error < least;
        least = least.min(points[i].error);
        better
    });
    order
}

const WIDTH: f64 = 430.0;
const HEIGHT: f64 = 300.0;
const COLUMNS: usize = 2;
/// Room around a panel's axes.
const LEFT: f64 = 66.0;
const RIGHT: f64 = 16.0;
const TOP: f64 = 30.0;
const BOTTOM: f64 = 46.0;

/// All panels of a component as one SVG file.
pub fn scatter(title: &str, panels: &[Panel]) -> String {
    page(title, panels.len(), |svg, i| draw(svg, &panels[i]))
}

/// So many panels, each drawn by its number, as one SVG file.
fn page(title: &str, n: usize, mut draw: impl FnMut(&mut String, usize)) -> String {
    let columns = n.clamp(1, COLUMNS);
    let rows = n.div_ceil(columns);
    let (width, height) = (WIDTH * columns as f64, HEIGHT * rows as f64 + 34.0);
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" viewBox=\"0 0 {width} {height}\" \
         font-family=\"sans-serif\" font-size=\"11\">\n<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n"
    );
    text(&mut svg, (14.0, 22.0), "start", "font-size=\"15\" font-weight=\"bold\"", title);
    for i in 0..n {
        let (x, y) = (WIDTH * (i % columns) as f64, 34.0 + HEIGHT * (i / columns) as f64);
        let _ = writeln!(svg, "<g transform=\"translate({x} {y})\">");
        draw(&mut svg, i);
        svg.push_str("</g>\n");
    }
    svg.push_str("</svg>\n");
    svg
}

fn draw(svg: &mut String, panel: &Panel) {
    let points = &panel.points;
    let x = Axis::fine(points.iter().map(|p| p.cost), LEFT, WIDTH - RIGHT);
    let y = Axis::decades(points.iter().map(|p| p.error), HEIGHT - BOTTOM, TOP);
    frame(svg, &panel.title, &panel.cost_label, &panel.error_label);
    grid(svg, &x, &y);
    let place = |p: &Point| (x.at(p.cost), y.at(p.error));
    let line: Vec<(f64, f64)> = frontier(points).iter().map(|&i| place(&points[i])).collect();
    let path: Vec<String> = line.iter().map(|(x, y)| format!("{x:.1},{y:.1}")).collect();
    let path = path.join(" ");
    let _ =
        writeln!(svg, "<polyline points=\"{path}\" fill=\"none\" stroke=\"#4477aa\" stroke-width=\"1.5\"/>");
    let area = Rect { left: LEFT, top: TOP, right: WIDTH - 2.0, bottom: HEIGHT - BOTTOM };
    let mut labels = Labels::new(area, points.iter().map(place), &line);
    for point in points {
        mark(svg, &mut labels, place(point), point);
    }
}

/// A panel's title and the names of its axes.
fn frame(svg: &mut String, title: &str, cost: &str, error: &str) {
    text(svg, (LEFT, TOP - 10.0), "start", "font-size=\"12\" font-weight=\"bold\"", title);
    text(svg, ((LEFT + WIDTH - RIGHT) / 2.0, HEIGHT - 10.0), "middle", "", cost);
    let middle = (TOP + HEIGHT - BOTTOM) / 2.0;
    let turned = format!("transform=\"rotate(-90 14 {middle:.1})\"");
    text(svg, (14.0, middle), "middle", &turned, error);
}

fn grid(svg: &mut String, x: &Axis, y: &Axis) {
    let (bottom, right) = (HEIGHT - BOTTOM, WIDTH - RIGHT);
    for (at, name) in x.ticks() {
        let _ = writeln!(svg, "<path d=\"M{at:.1} {TOP}V{bottom}\" stroke=\"#e4e4e4\"/>");
        text(svg, (at, bottom + 15.0), "middle", "", &name);
    }
    for (at, name) in y.ticks() {
        let _ = writeln!(svg, "<path d=\"M{LEFT} {at:.1}H{right}\" stroke=\"#e4e4e4\"/>");
        text(svg, (LEFT - 5.0, at + 4.0), "end", "", &name);
    }
    let _ = writeln!(svg, "<path d=\"M{LEFT} {TOP}V{bottom}H{right}\" fill=\"none\" stroke=\"#888\"/>");
}

/// A point with its label, and a line to it where the label had to step aside.
fn mark(svg: &mut String, labels: &mut Labels, (x, y): (f64, f64), point: &Point) {
    let colour = if point.default { "#cc3311" } else { "#222222" };
    let fill = if point.wrong > 0 { "white" } else { colour };
    let shape = format!("fill=\"{fill}\" stroke=\"{colour}\" stroke-width=\"1.4\"");
    if point.default {
        let _ = writeln!(svg, "<polygon points=\"{}\" {shape}/>", star(x, y));
    } else {
        let _ = writeln!(svg, "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"3.6\" {shape}/>");
    }
    let name = match point.wrong {
        0 => point.label.clone(),
        n => format!("{}: {n} wrong", point.label),
    };
    let label = labels.place((x, y), &name);
    if label.aside {
        let (end, level) = (label.x, label.y - 4.0);
        let _ = writeln!(
            svg,
            "<path d=\"M{x:.1} {y:.1}L{end:.1} {level:.1}\" stroke=\"#bbb\" stroke-width=\"0.8\"/>"
        );
    }
    text(svg, (label.x, label.y), label.anchor, &format!("fill=\"{colour}\""), &name);
}

/// Corners of a five-pointed star.
fn star(x: f64, y: f64) -> String {
    let corner = |k: i32| {
        let radius = if k % 2 == 0 { 7.5 } else { 3.2 };
        let (s, c) = crate::math::elementary::sin_cos(std::f64::consts::PI * (f64::from(k) / 5.0 - 0.5));
        format!("{:.1},{:.1}", x + radius * c, y + radius * s)
    };
    (0..10).map(corner).collect::<Vec<_>>().join(" ")
}

fn text(svg: &mut String, (x, y): (f64, f64), anchor: &str, more: &str, what: &str) {
    let _ = writeln!(
        svg,
        "<text x=\"{x:.1}\" y=\"{y:.1}\" text-anchor=\"{anchor}\" {more}>{}</text>",
        escaped(what)
    );
}

fn escaped(what: &str) -> String {
    what.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn point(cost: f64, error: f64) -> Point {
        Point { cost, error, wrong: 0, label: format!("{cost}"), default: false }
    }

    fn panel(points: Vec<Point>) -> Panel {
        let label = || "ns".to_owned();
        Panel { title: "a < b".into(), cost_label: label(), error_label: label(), points }
    }

    #[test]
    fn what_is_beaten_in_both_or_answers_wrongly_is_off_the_frontier() {
        let mut points =
            vec![point(1.0, 1.0), point(2.0, 0.1), point(3.0, 0.5), point(4.0, 0.0), point(2.0, 0.2)];
        assert_eq!(frontier(&points), [0, 1, 3]);
        points[1].wrong = 1;
        assert_eq!(frontier(&points), [0, 4, 3]);
    }

    #[test]
    fn a_plot_has_every_label_and_no_nan() {
        let points = vec![point(1.0, 0.0), Point { default: true, wrong: 7, ..point(50.0, 1e-9) }];
        let svg = scatter("title", &[panel(points), panel(vec![point(3.0, 0.0)]), panel(Vec::new())]);
        for part in ["a &lt; b", ">50: 7 wrong<", "<polygon"] {
            assert!(svg.contains(part), "{part}");
        }
        assert!(!svg.contains("NaN") && !svg.contains("inf"));
    }
}
