//! A ray against the balls of an arc. In the frame of the ray, with a(t) the distance along it and D(t) = r² − x² − y² what is left of
//! the radius at the ray (degree 6, in Bernstein form), the ball at t covers a ± √D wherever D ≥ 0. Over an interval where D ≥ 0
//! all along, the balls cover one stretch together: from the least a − √D to the greatest a + √D. So the stretches' ends are minima, which are
//! there whatever the rounding, and flat, so that an error in t is one of its square in the distance.
//!
//! An interval is settled where ±a − √D each run one way or bend up (the end of the stretch is then their one minimum), or bend down (it is
//! then at an end of the interval). Otherwise it is halved.

use super::arc::Arc;
use crate::geometry::boxes::Line;
use crate::math::bracket;
use glam::{DVec2, DVec3};

/// An end of a stretch.
#[derive(Clone, Copy, Debug)]
pub(super) struct Edge {
    /// Distance along the line.
    pub s: f64,
    /// Which arc.
    pub arc: u32,
    /// Where in the arc the ball is.
    pub x: f64,
    /// The end of the tube whose plane it is on.
    pub cap: Option<u8>,
}

/// A stretch of the line inside balls.
#[derive(Clone, Copy, Debug)]
pub(super) struct Span {
    pub low: Edge,
    pub high: Edge,
}

impl Span {
    /// Leaves what is behind the plane through a point with its normal out.
    pub fn clip(&mut self, line: &Line, (origin, out): (DVec3, DVec3), end: u8) {
        let (height, rise) = (out.dot(line.origin - origin), out.dot(line.direction));
        if rise == 0.0 {
            if height > 0.0 {
                self.high.s = f64::NEG_INFINITY;
            }
            return;
        }
        let s = -height / rise;
        if rise > 0.0 && s < self.high.s {
            self.high = Edge { s, cap: Some(end), ..self.high };
        } else if rise < 0.0 && s > self.low.s {
            self.low = Edge { s, cap: Some(end), ..self.low };
        }
    }
}

/// An arc as a line sees it.
struct Seen {
    /// Distance along the line that `a` counts from: near the arc.
    base: f64,
    x: [f64; 4],
    y: [f64; 4],
    a: [f64; 4],
    r: [f64; 4],
}

/// An interval of an arc, in Bernstein form.
#[derive(Clone, Copy)]
struct Cell {
    d: [f64; 7],
    a: [f64; 4],
    from: f64,
    to: f64,
}

/// Most intervals looked at for one arc; what is left is taken as its middle. Rays that run along the surface itself take some hundred.
const MOST_CELLS: usize = 2000;
/// An interval this narrow is taken as its middle.
const NARROWEST: f64 = 1.0 / (1u64 << 40) as f64;

/// Calls `found` with the stretches inside an arc's balls that may matter in the window: some of them overlap, and those that begin beyond
/// the window or end before it may be left out.
pub(super) fn spans(
    arc: &Arc,
    index: u32,
    line: &Line,
    planes: &[DVec3; 2],
    window: (f64, f64),
    mut found: impl FnMut(Span),
) {
    let seen = Seen::of(arc, line, planes);
    let whole = seen.whole();
    let window = (window.0 - seen.base, window.1 - seen.base);
    let slack = ROUNDINGS * f64::EPSILON * seen.square();
    if let Verdict::Unclear = whole.settle(&seen, index, window, slack, &mut found) {
        search(&seen, whole, index, window, slack, &mut found);
    }
}

/// D may be off by so many ε of the squares it is made of.
const ROUNDINGS: f64 = 16.0;

#[cold]
fn search(
    seen: &Seen,
    whole: Cell,
    index: u32,
    window: (f64, f64),
    slack: f64,
    found: &mut impl FnMut(Span),
) {
    let mut waiting = whole.halves().to_vec();
    let mut looked = 0;
    while let Some(cell) = waiting.pop() {
        looked += 1;
        if cell.to - cell.from <= NARROWEST || looked > MOST_CELLS {
            let x = 0.5 * (cell.from + cell.to);
            if let Some((low, high)) = seen.ball(x) {
                found(seen.span(index, (low, x), (high, x)));
            }
        } else if let Verdict::Unclear = cell.settle(seen, index, window, slack, found) {
            let [first, second] = cell.halves();
            waiting.extend([second, first]);
        }
    }
}

enum Verdict {
    Settled,
    Unclear,
}

impl Seen {
    fn of(arc: &Arc, line: &Line, planes: &[DVec3; 2]) -> Seen {
        let base = line.direction.dot((arc.points[0] + arc.points[3]) * 0.5 - line.origin);
        let origin = line.at(base);
        let from = arc.points.map(|p| p - origin);
        Seen {
            base,
            x: from.map(|p| planes[0].dot(p)),
            y: from.map(|p| planes[1].dot(p)),
            a: from.map(|p| line.direction.dot(p)),
            r: arc.radii,
        }
    }

    /// The largest of the squares that D is made of.
    fn square(&self) -> f64 {
        let all = self.x.iter().chain(&self.y).chain(&self.r);
        let largest = all.fold(0.0, |m: f64, v| if v.abs() > m { v.abs() } else { m });
        largest * largest
    }

    /// D by products of Bernstein polynomials: Dₖ = Σ C(3,i) C(3,k−i) / C(6,k) · Sᵢⱼ.
    fn whole(&self) -> Cell {
        let s = |i: usize, j: usize| self.r[i] * self.r[j] - (self.x[i] * self.x[j] + self.y[i] * self.y[j]);
        let d = [
            s(0, 0),
            s(0, 1),
            0.4 * s(0, 2) + 0.6 * s(1, 1),
            0.1 * s(0, 3) + 0.9 * s(1, 2),
            0.4 * s(1, 3) + 0.6 * s(2, 2),
            s(2, 3),
            s(3, 3),
        ];
        Cell { d, a: self.a, from: 0.0, to: 1.0 }
    }

    /// The stretch that the ball at x covers, from `base`; none where the line passes it by.
    fn ball(&self, x: f64) -> Option<(f64, f64)> {
        let at = |p: &[f64; 4]| crate::geometry::curve::evaluate::bernstein(p, x);
        let (r, away) = (at(&self.r), DVec2::new(at(&self.x), at(&self.y)).length());
        let left = (r - away) * (r + away);
        (left >= 0.0).then(|| {
            let (a, half) = (at(&self.a), left.sqrt());
            (a - half, a + half)
        })
    }

    fn span(&self, arc: u32, low: (f64, f64), high: (f64, f64)) -> Span {
        let edge = |(s, x): (f64, f64)| Edge { s: self.base + s, arc, x, cap: None };
        Span { low: edge(low), high: edge(high) }
    }
}

/// Differences of neighbours.
fn steps<const N: usize, const M: usize>(c: &[f64; N]) -> [f64; M] {
    std::array::from_fn(|i| c[i + 1] - c[i])
}

fn range(c: &[f64]) -> (f64, f64) {
    c.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), &v| {
        (if v < low { v } else { low }, if v > high { v } else { high })
    })
}

impl Cell {
    /// Gives the stretches of this interval, or says that it must be halved.
    fn settle(
        &self,
        seen: &Seen,
        index: u32,
        window: (f64, f64),
        slack: f64,
        found: &mut impl FnMut(Span),
    ) -> Verdict {
        let (least, most) = range(&self.d);
        if most < 0.0 {
            return Verdict::Settled;
        }
        let (near, far) = range(&self.a);
        let reach = most.sqrt();
        if near - reach > window.1 || far + reach < window.0 {
            return Verdict::Settled;
        }
        let bounds = Bounds::of(self, least, most, slack);
        let (Some(first), Some(last)) = (bounds.shape(1.0), bounds.shape(-1.0)) else {
            return Verdict::Unclear;
        };
        let powers = Powers::of(self);
        let low = self.least(seen, &powers, first, 1.0);
        let high = self.least(seen, &powers, last, -1.0);
        // A line that only just touches may be seen to by one of the two alone.
        match (low, high) {
            (Some((low, _, x)), Some((_, high, y))) => found(seen.span(index, (low, x), (high, y))),
            (Some((low, high, x)), None) | (None, Some((low, high, x))) => {
                found(seen.span(index, (low, x), (high, x)));
            }
            (None, None) => {}
        }
        Verdict::Settled
    }

    /// The ball whose ±a − √D is least, by where it begins and ends and its place in the arc; none where there is no ball.
    fn least(&self, seen: &Seen, powers: &Powers, shape: Shape, sign: f64) -> Option<(f64, f64, f64)> {
        let ball = |x: f64| seen.ball(x).map(|(low, high)| (low, high, x));
        match shape {
            Shape::Dips => ball(self.from + (self.to - self.from) * powers.lowest(sign)),
            Shape::Arches => {
                let begins = |b: &(f64, f64, f64)| if sign > 0.0 { b.0 } else { -b.1 };
                let ends = [ball(self.from), ball(self.to)].into_iter().flatten();
                ends.reduce(|a, b| if begins(&b) < begins(&a) { b } else { a })
            }
        }
    }

    fn halves(&self) -> [Cell; 2] {
        let (d, e) = halve(self.d);
        let (a, b) = halve(self.a);
        let middle = 0.5 * (self.from + self.to);
        [Cell { d, a, from: self.from, to: middle }, Cell { d: e, a: b, from: middle, to: self.to }]
    }
}

/// How ±a − √D runs over an interval, where D ≥ 0.
#[derive(Clone, Copy)]
enum Shape {
    /// Down and then up, or one of the two: its slope changes sign once at most.
    Dips,
    /// Up and then down: it is least at an end.
    Arches,
}

/// Bounds over an interval's own [0, 1].
struct Bounds {
    d: (f64, f64),
    a1: (f64, f64),
    a2: (f64, f64),
    d1: (f64, f64),
    d2: (f64, f64),
    slack: f64,
}

impl Bounds {
    fn of(cell: &Cell, least: f64, most: f64, slack: f64) -> Bounds {
        let d1: [f64; 6] = steps(&cell.d);
        let d2: [f64; 5] = steps(&d1);
        let a1: [f64; 3] = steps(&cell.a);
        let a2: [f64; 2] = steps(&a1);
        let times = |(low, high): (f64, f64), by: f64| (low * by, high * by);
        Bounds {
            d: (least.max(0.0), most),
            a1: times(range(&a1), 3.0),
            a2: times(range(&a2), 6.0),
            d1: times(range(&d1), 6.0),
            d2: times(range(&d2), 30.0),
            slack,
        }
    }

    /// Of ±a − √D; none where the bounds do not tell.
    fn shape(&self, sign: f64) -> Option<Shape> {
        let turned = |(low, high): (f64, f64)| if sign > 0.0 { (low, high) } else { (-high, -low) };
        let (a1, a2) = (turned(self.a1), turned(self.a2));
        let (near, far) = (self.d.0.sqrt(), self.d.1.sqrt());
        // Its slope, times √D, is ±a′√D − D′/2.
        let low = if a1.0 > 0.0 { a1.0 * near } else { a1.0 * far } - 0.5 * self.d1.1;
        let high = if a1.1 > 0.0 { a1.1 * far } else { a1.1 * near } - 0.5 * self.d1.0;
        // It bends up where −D″/2√D outweighs ±a″, or where 4 D^1.5 (±a″) − 2 D D″ + D′² > 0.
        let (dip, bend) = self.d2;
        let adverse = (-a2.0).max(0.0);
        let by_bend = bend <= self.slack && adverse * 2.0 * far <= self.slack - bend;
        let gentlest = self.d1.0.max(-self.d1.1).max(0.0);
        let of_bend = if bend > 0.0 { -2.0 * self.d.1 * bend } else { -2.0 * self.d.0 * bend };
        let bends_up = gentlest * gentlest + of_bend - 4.0 * self.d.1 * far * adverse > 0.0;
        // A D that has two humps would part the balls.
        let is_one_stretch = self.d.0 > 0.0 || gentlest > 0.0 || bend <= self.slack;
        if low > 0.0 || high < 0.0 || by_bend || bends_up && is_one_stretch {
            return Some(Shape::Dips);
        }
        let steepest = self.d1.1.max(-self.d1.0);
        let of_dip = if dip > 0.0 { -2.0 * self.d.0 * dip } else { -2.0 * self.d.1 * dip };
        let bends_down = steepest * steepest + of_dip + 4.0 * self.d.1 * far * a2.1.max(0.0) < 0.0;
        (self.d.0 > 0.0 && bends_down).then_some(Shape::Arches)
    }
}

/// De Casteljau's halves.
fn halve<const N: usize>(mut c: [f64; N]) -> ([f64; N], [f64; N]) {
    let mut first = c;
    for level in 1..N {
        for i in 0..N - level {
            c[i] = 0.5 * (c[i] + c[i + 1]);
        }
        first[level] = c[0];
    }
    (first, c)
}

/// D and a over an interval's own [0, 1] in powers, for Newton's steps: their errors are mended by [`Seen::ball`].
struct Powers {
    d: [f64; 7],
    a: [f64; 4],
}

impl Powers {
    fn of(cell: &Cell) -> Powers {
        Powers {
            d: powers(cell.d, [1.0, 6.0, 15.0, 20.0, 15.0, 6.0, 1.0]),
            a: powers(cell.a, [1.0, 3.0, 3.0, 1.0]),
        }
    }

    /// Where ±a − √D is least, given that it dips: the zero of ±a′√D − D′/2, which is −D′/2 where D < 0.
    fn lowest(&self, sign: f64) -> f64 {
        let f = |x: f64| {
            let [d, d1, d2] = jet(&self.d, x);
            if d <= 0.0 {
                return (-0.5 * d1, -0.5 * d2);
            }
            let root = d.sqrt();
            let [_, a1, a2] = jet(&self.a, x);
            (sign * a1 * root - 0.5 * d1, sign * (a2 * root + 0.5 * a1 * d1 / root) - 0.5 * d2)
        };
        if f(0.0).0 >= 0.0 {
            return 0.0;
        }
        if f(1.0).0 <= 0.0 {
            return 1.0;
        }
        bracket::newton(0.0, 1.0, 0.5, true, f)
    }
}

/// Coefficients of powers: binomials times forward differences.
fn powers<const N: usize>(mut c: [f64; N], binomials: [f64; N]) -> [f64; N] {
    for level in 1..N {
        for i in (level..N).rev() {
            c[i] -= c[i - 1];
        }
    }
    std::array::from_fn(|k| c[k] * binomials[k])
}

/// Value and two derivatives by Horner's rule.
fn jet<const N: usize>(c: &[f64; N], x: f64) -> [f64; 3] {
    let (mut value, mut slope, mut bend) = (c[N - 1], 0.0, 0.0);
    for k in (0..N - 1).rev() {
        bend = bend * x + slope;
        slope = slope * x + value;
        value = value * x + c[k];
    }
    [value, slope, 2.0 * bend]
}
