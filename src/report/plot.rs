//! A scatter of cost against error on logarithmic axes, as SVG: every variant a labelled point, the Pareto frontier joined, the
//! default starred.

use std::fmt::Write;

/// A variant on a plot.
#[derive(Clone, Debug, PartialEq)]
pub struct Point {
    /// Cost, > 0; left is better.
    pub cost: f64,
    /// Error, ≥ 0; low is better. 0 is drawn on the floor.
    pub error: f64,
    /// What to write beside it.
    pub label: String,
    /// Starred.
    pub default: bool,
}

const WIDTH: f64 = 640.0;
const HEIGHT: f64 = 400.0;
const LEFT: f64 = 70.0;
const RIGHT: f64 = 150.0;
const TOP: f64 = 34.0;
const BOTTOM: f64 = 48.0;

/// The points that no other beats in both cost and error, by rising cost.
pub fn frontier(points: &[Point]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..points.len()).collect();
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

/// A logarithmic axis of whole decades around some numbers.
struct Axis {
    from: i32,
    to: i32,
    low: f64,
    high: f64,
}

impl Axis {
    fn around(numbers: impl Iterator<Item = f64> + Clone, low: f64, high: f64) -> Axis {
        let positive = numbers.filter(|x| *x > 0.0 && x.is_finite());
        let least = positive.clone().fold(f64::INFINITY, f64::min);
        let most = positive.fold(0.0, f64::max);
        let decade = |x: f64| crate::math::elementary::log10(x);
        let (from, to) =
            if most > 0.0 { (decade(least).floor() as i32, decade(most).ceil() as i32) } else { (-1, 1) };
        Axis { from, to: to.max(from + 1), low, high }
    }

    fn at(&self, x: f64) -> f64 {
        let decades = if x > 0.0 { crate::math::elementary::log10(x) } else { f64::from(self.from) };
        let part = ((decades - f64::from(self.from)) / f64::from(self.to - self.from)).clamp(0.0, 1.0);
        self.low + (self.high - self.low) * part
    }

    /// Whole decades, at most about eight of them.
    fn ticks(&self) -> impl Iterator<Item = i32> + use<> {
        let step = ((self.to - self.from) / 8 + 1) as usize;
        (self.from..=self.to).step_by(step)
    }
}

/// The plot as an SVG file.
pub fn scatter(title: &str, cost_label: &str, error_label: &str, points: &[Point]) -> String {
    let x = Axis::around(points.iter().map(|p| p.cost), LEFT, WIDTH - RIGHT);
    let y = Axis::around(points.iter().map(|p| p.error), HEIGHT - BOTTOM, TOP);
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{WIDTH}\" height=\"{HEIGHT}\" viewBox=\"0 0 {WIDTH} {HEIGHT}\" \
         font-family=\"sans-serif\" font-size=\"11\">\n<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n"
    );
    text(&mut svg, LEFT, 18.0, "start", 14, title);
    grid(&mut svg, &x, &y);
    text(&mut svg, (LEFT + WIDTH - RIGHT) / 2.0, HEIGHT - 10.0, "middle", 11, cost_label);
    let middle = (TOP + HEIGHT - BOTTOM) / 2.0;
    let _ = writeln!(
        svg,
        "<text x=\"16\" y=\"{middle:.1}\" text-anchor=\"middle\" transform=\"rotate(-90 16 {middle:.1})\">{}</text>",
        escaped(error_label)
    );
    let line: Vec<String> = frontier(points)
        .iter()
        .map(|&i| format!("{:.1},{:.1}", x.at(points[i].cost), y.at(points[i].error)))
        .collect();
    let _ = writeln!(
        svg,
        "<polyline points=\"{}\" fill=\"none\" stroke=\"#4477aa\" stroke-width=\"1.5\"/>",
        line.join(" ")
    );
    let mut taken: Vec<(f64, f64)> = Vec::new();
    for point in points {
        mark(&mut svg, &mut taken, x.at(point.cost), y.at(point.error), point);
    }
    svg.push_str("</svg>\n");
    svg
}

fn grid(svg: &mut String, x: &Axis, y: &Axis) {
    let bottom = HEIGHT - BOTTOM;
    for decade in x.ticks() {
        let at = x.at(10f64.powi_exact(decade));
        let _ = writeln!(svg, "<path d=\"M{at:.1} {TOP}V{bottom}\" stroke=\"#ddd\"/>");
        text(svg, at, bottom + 16.0, "middle", 11, &power(decade));
    }
    for decade in y.ticks() {
        let at = y.at(10f64.powi_exact(decade));
        let _ = writeln!(svg, "<path d=\"M{LEFT} {at:.1}H{}\" stroke=\"#ddd\"/>", WIDTH - RIGHT);
        text(svg, LEFT - 6.0, at + 4.0, "end", 11, &power(decade));
    }
}

/// Powers of ten without the platform's library.
trait PowiExact {
    fn powi_exact(self, n: i32) -> f64;
}

impl PowiExact for f64 {
    fn powi_exact(self, n: i32) -> f64 {
        crate::math::elementary::powi(self, n)
    }
}

/// A point with its label, moved down where another label stands.
fn mark(svg: &mut String, taken: &mut Vec<(f64, f64)>, x: f64, y: f64, point: &Point) {
    let colour = if point.default { "#cc3311" } else { "#222" };
    if point.default {
        let star: Vec<String> = (0..10)
            .map(|k| {
                let radius = if k % 2 == 0 { 8.0 } else { 3.4 };
                let (s, c) =
                    crate::math::elementary::sin_cos(std::f64::consts::PI * (f64::from(k) / 5.0 - 0.5));
                format!("{:.1},{:.1}", x + radius * c, y + radius * s)
            })
            .collect();
        let _ = writeln!(svg, "<polygon points=\"{}\" fill=\"{colour}\"/>", star.join(" "));
    } else {
        let _ = writeln!(svg, "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"4\" fill=\"{colour}\"/>");
    }
    let mut at = y + 4.0;
    while taken.iter().any(|(tx, ty)| (tx - x).abs() < 110.0 && (ty - at).abs() < 12.0) {
        at += 12.0;
    }
    taken.push((x, at));
    let _ = writeln!(
        svg,
        "<text x=\"{:.1}\" y=\"{at:.1}\" fill=\"{colour}\">{}</text>",
        x + 10.0,
        escaped(&point.label)
    );
}

fn text(svg: &mut String, x: f64, y: f64, anchor: &str, size: u32, what: &str) {
    let _ = writeln!(
        svg,
        "<text x=\"{x:.1}\" y=\"{y:.1}\" text-anchor=\"{anchor}\" font-size=\"{size}\">{}</text>",
        escaped(what)
    );
}

fn power(decade: i32) -> String {
    if (-2..=3).contains(&decade) { format!("{}", 10f64.powi_exact(decade)) } else { format!("1e{decade}") }
}

fn escaped(what: &str) -> String {
    what.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn point(cost: f64, error: f64) -> Point {
        Point { cost, error, label: format!("{cost}"), default: false }
    }

    #[test]
    fn what_is_beaten_in_both_is_off_the_frontier() {
        let points = [point(1.0, 1.0), point(2.0, 0.1), point(3.0, 0.5), point(4.0, 0.0), point(2.0, 0.2)];
        assert_eq!(frontier(&points), [0, 1, 3]);
    }

    #[test]
    fn a_plot_has_every_label_and_no_nan() {
        let svg =
            scatter("a < b", "ns", "ulp", &[point(1.0, 0.0), Point { default: true, ..point(50.0, 1e-9) }]);
        assert!(
            svg.contains("a &lt; b")
                && svg.contains(">50<")
                && !svg.contains("NaN")
                && svg.contains("<polygon")
        );
    }
}
