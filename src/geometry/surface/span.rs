//! Stretches of a line inside a solid, cut by planes: for solids that are part of a larger one. Knows nothing of what made them.

use super::Touch;

/// Stretches in order, each by where it begins and ends.
pub type Spans = Vec<(Touch, Touch)>;

/// A touch where the line begins or ends: beyond everything.
fn beyond(t: f64) -> Touch {
    Touch::new(t, u32::MAX, 0.0)
}

/// What is left of a solid's meetings, in and out in turn, within other stretches, which lie apart. In and out in turn again.
pub fn clip(meetings: &[Touch], within: &Spans) -> Vec<Touch> {
    let mut left = Vec::new();
    for (low, high) in within {
        for pair in meetings.chunks_exact(2) {
            let from = if pair[0].t >= low.t { pair[0] } else { *low };
            let to = if pair[1].t <= high.t { pair[1] } else { *high };
            if from.t <= to.t {
                left.extend([from, to]);
            }
        }
    }
    left
}

/// Stretches between planes through which a wedge or a slab is cut.
pub mod wedge {
    use super::{Spans, Touch, beyond};

    /// Where a line is behind a plane: its height over the plane at its origin, how that rises per unit of its direction, and the
    /// direction's length. `part` is what is met there.
    pub fn half_space(height: f64, rise: f64, length: f64, part: u32) -> Spans {
        let (first, last) = (beyond(f64::NEG_INFINITY), beyond(f64::INFINITY));
        if rise == 0.0 {
            return if height <= 0.0 { vec![(first, last)] } else { Vec::new() };
        }
        let at = Touch::new(-height / rise / length, part, 0.0);
        vec![if rise > 0.0 { (first, at) } else { (at, last) }]
    }

    /// Behind both planes.
    pub fn both(a: Spans, b: Spans) -> Spans {
        let (Some(a), Some(b)) = (a.first(), b.first()) else { return Vec::new() };
        let low = if a.0.t >= b.0.t { a.0 } else { b.0 };
        let high = if a.1.t <= b.1.t { a.1 } else { b.1 };
        if low.t <= high.t { vec![(low, high)] } else { Vec::new() }
    }

    /// Behind one at least.
    pub fn either(a: Spans, b: Spans) -> Spans {
        let mut all: Spans = a.into_iter().chain(b).collect();
        all.sort_by(|x, y| x.0.t.total_cmp(&y.0.t));
        match all.as_slice() {
            [first, second] if second.0.t <= first.1.t => {
                let high = if first.1.t >= second.1.t { first.1 } else { second.1 };
                vec![(first.0, high)]
            }
            _ => all,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(t: f64) -> Touch {
        Touch::new(t, 0, 0.0)
    }

    #[test]
    fn stretches_are_cut_and_joined() {
        let meetings = [1.0, 2.0, 3.0, 5.0].map(at);
        let ts = |spans: &Spans| clip(&meetings, spans).iter().map(|h| h.t).collect::<Vec<_>>();
        let behind = |t: f64| wedge::half_space(-t, 1.0, 1.0, 7);
        let before = |t: f64| wedge::half_space(t, -1.0, 1.0, 8);
        assert_eq!(ts(&behind(4.0)), [1.0, 2.0, 3.0, 4.0]);
        assert_eq!(ts(&wedge::both(behind(4.0), before(1.5))), [1.5, 2.0, 3.0, 4.0]);
        assert_eq!(ts(&wedge::both(behind(1.0), before(4.0))), [0.0; 0]);
        assert_eq!(ts(&wedge::either(behind(1.5), before(4.0))), [1.0, 1.5, 4.0, 5.0]);
        assert_eq!(ts(&wedge::either(behind(4.0), before(2.0))), [1.0, 2.0, 3.0, 5.0]);
        assert_eq!(ts(&wedge::half_space(0.5, 0.0, 1.0, 0)), [0.0; 0]);
    }
}
