//! Places for labels beside points, so that none lies on another label, on a point or beyond the frame.

/// A box, y down.
#[derive(Clone, Copy, Debug)]
pub struct Rect {
    /// Least x.
    pub left: f64,
    /// Least y.
    pub top: f64,
    /// Greatest x.
    pub right: f64,
    /// Greatest y.
    pub bottom: f64,
}

impl Rect {
    fn overlap(&self, other: &Rect) -> f64 {
        let width = self.right.min(other.right) - self.left.max(other.left);
        let height = self.bottom.min(other.bottom) - self.top.max(other.top);
        if width > 0.0 && height > 0.0 { width * height } else { 0.0 }
    }

    /// How much of it lies outside another, in square pixels.
    fn outside(&self, frame: &Rect) -> f64 {
        let own = (self.right - self.left) * (self.bottom - self.top);
        own - self.overlap(frame)
    }
}

/// A label's place.
#[derive(Clone, Copy, Debug)]
pub struct Label {
    /// x of its anchor.
    pub x: f64,
    /// y of its baseline.
    pub y: f64,
    /// SVG's text-anchor.
    pub anchor: &'static str,
    /// True where it is not right beside its point.
    pub aside: bool,
}

/// What is taken so far.
pub struct Labels {
    frame: Rect,
    taken: Vec<Rect>,
}

/// Width of a letter and height of a line at 11 px, of most sans-serif fonts.
const LETTER: f64 = 6.0;
const LINE: f64 = 11.0;

impl Labels {
    /// Nothing but points, the line through some of them, and the frame.
    pub fn new(frame: Rect, points: impl Iterator<Item = (f64, f64)>, line: &[(f64, f64)]) -> Labels {
        let around =
            |(x, y): (f64, f64)| Rect { left: x - 6.0, top: y - 6.0, right: x + 6.0, bottom: y + 6.0 };
        let thin = |(x, y): (f64, f64)| Rect { left: x - 2.0, top: y - 2.0, right: x + 2.0, bottom: y + 2.0 };
        let steps = line.windows(2).flat_map(|w| {
            let (dx, dy) = (w[1].0 - w[0].0, w[1].1 - w[0].1);
            let n = (dx.abs().max(dy.abs()) / 3.0).ceil().max(1.0);
            (0..=n as u32).map(move |k| (w[0].0 + dx * f64::from(k) / n, w[0].1 + dy * f64::from(k) / n))
        });
        Labels { frame, taken: points.map(around).chain(steps.map(thin)).collect() }
    }

    /// The first place around a point that is free, or the one that covers least.
    pub fn place(&mut self, (x, y): (f64, f64), name: &str) -> Label {
        let width = LETTER * name.chars().count() as f64;
        let beside = |dy: f64| [("start", x + 9.0, y + 4.0 + dy), ("end", x - 9.0, y + 4.0 + dy)];
        let level = beside(0.0).into_iter().chain([("middle", x, y - 10.0), ("middle", x, y + 18.0)]);
        let others =
            (1..=12).flat_map(|k| [-1.0, 1.0].map(|side| side * 6.0 * f64::from(k))).flat_map(beside);
        let rect = |(anchor, x, y): (&str, f64, f64)| {
            let left = match anchor {
                "start" => x,
                "end" => x - width,
                _ => x - width / 2.0,
            };
            Rect { left, top: y - LINE + 2.0, right: left + width, bottom: y + 2.0 }
        };
        let cost = |place: (&'static str, f64, f64)| {
            let own = rect(place);
            let covered: f64 = self.taken.iter().map(|other| own.overlap(other)).sum();
            covered + own.outside(&self.frame)
        };
        let mut best = (f64::INFINITY, ("start", x + 9.0, y + 4.0));
        for place in level.chain(others) {
            let cost = cost(place);
            if cost < best.0 {
                best = (cost, place);
            }
            if cost == 0.0 {
                break;
            }
        }
        let (anchor, label_x, label_y) = best.1;
        self.taken.push(rect(best.1));
        let aside = anchor != "middle" && (label_y - 4.0 - y).abs() > 7.0;
        Label { x: label_x, y: label_y, anchor, aside }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels_of_points_on_one_spot_do_not_cover_one_another() {
        let frame = Rect { left: 0.0, top: 0.0, right: 400.0, bottom: 300.0 };
        let points = [(200.0, 150.0); 7];
        let mut labels = Labels::new(frame, points.into_iter(), &[]);
        let placed: Vec<Label> = points.iter().map(|p| labels.place(*p, "twelve chars")).collect();
        for (i, a) in placed.iter().enumerate() {
            for b in &placed[..i] {
                assert!((a.y - b.y).abs() >= LINE || a.anchor != b.anchor, "{a:?} {b:?}");
            }
        }
        let mut edge = Labels::new(frame, [(395.0, 10.0)].into_iter(), &[]);
        assert_eq!(edge.place((395.0, 10.0), "at the edge").anchor, "end");
    }
}
