//! What light is aimed at: balls around many things, brought together to a few.

use crate::geometry::balls::Ball;
use crate::math::Aabb;
use glam::DVec3;
use std::ops::Range;

/// A few balls that light shall meet; where it meets none of them it is not wanted.
#[derive(Clone, Debug)]
pub struct Targets {
    /// Of the two ways to be few, apart and as one, whichever is smaller across.
    pub(super) balls: Vec<Ball>,
    /// Around everything that is bounded.
    pub(super) world: Ball,
}

/// Balls at most: each is looked at whenever light leaves a lamp.
pub(super) const MOST: usize = 32;

/// Some of the balls, which lie side by side.
struct Cluster {
    range: Range<usize>,
    ball: Ball,
    /// The two that it was cut into, both later in the list.
    halves: Option<[usize; 2]>,
}

impl Targets {
    /// Around all that some balls hold, in a world around which there is one.
    pub fn new(mut balls: Vec<Ball>, world: Ball) -> Targets {
        let clusters = cut(&mut balls);
        let mut across = vec![0.0; clusters.len()];
        let mut kept: Vec<Vec<Ball>> = Vec::new();
        kept.resize_with(clusters.len(), Vec::new);
        for (i, cluster) in clusters.iter().enumerate().rev() {
            let own = cluster.ball.reach * cluster.ball.reach;
            match cluster.halves {
                Some([a, b]) if across[a] + across[b] < own => {
                    across[i] = across[a] + across[b];
                    kept[i] = [std::mem::take(&mut kept[a]), std::mem::take(&mut kept[b])].concat();
                }
                _ => (across[i], kept[i]) = (own, vec![cluster.ball]),
            }
        }
        Targets { balls: kept.into_iter().next().unwrap_or_default(), world }
    }

    /// Balls that hold all of them, few enough that each may be looked at for every pixel or path.
    pub fn balls(&self) -> &[Ball] {
        &self.balls
    }

    /// True where there is nothing to aim at.
    pub fn is_empty(&self) -> bool {
        self.balls.is_empty()
    }
}

/// All balls, cut in two, the largest part first, until there are [`MOST`] parts or each is one ball.
fn cut(balls: &mut [Ball]) -> Vec<Cluster> {
    let around = |balls: &[Ball]| Ball::around(balls.iter().map(|ball| (ball.center, ball.reach)));
    let cluster = |balls: &[Ball], range: Range<usize>| Cluster {
        ball: if range.len() == 1 { balls[range.start] } else { around(&balls[range.clone()]) },
        range,
        halves: None,
    };
    if balls.is_empty() {
        return Vec::new();
    }
    let mut clusters = vec![cluster(balls, 0..balls.len())];
    for _ in 1..MOST {
        let may = |c: &&Cluster| c.halves.is_none() && c.range.len() > 1;
        let whole = (0..clusters.len()).filter(|i| may(&&clusters[*i]));
        let Some(largest) = whole.max_by(|a, b| clusters[*a].ball.reach.total_cmp(&clusters[*b].ball.reach))
        else {
            break;
        };
        let range = clusters[largest].range.clone();
        let middle = range.start + halve(&mut balls[range.clone()]);
        clusters[largest].halves = Some([clusters.len(), clusters.len() + 1]);
        clusters.push(cluster(balls, range.start..middle));
        clusters.push(cluster(balls, middle..range.end));
    }
    clusters
}

/// Brings balls in order along the longest side of what their centres span; how many of them are in the first part where both parts are
/// smallest across.
fn halve(balls: &mut [Ball]) -> usize {
    let size = Aabb::of(balls.iter().map(|ball| ball.center)).size();
    let axis = (0..3).max_by(|a, b| size[*a].total_cmp(&size[*b])).expect("there are three");
    balls.sort_by(|a, b| a.center[axis].total_cmp(&b.center[axis]));
    let to_here = |so_far: &mut Aabb, ball: &Ball| {
        let reach = DVec3::splat(ball.reach);
        *so_far = so_far.with(ball.center - reach).with(ball.center + reach);
        Some(so_far.size().length_squared())
    };
    let before: Vec<f64> = balls.iter().scan(Aabb::EMPTY, to_here).collect();
    let after: Vec<f64> = balls.iter().rev().scan(Aabb::EMPTY, to_here).collect();
    let across = |first: usize| before[first - 1] + after[balls.len() - first - 1];
    (1..balls.len()).min_by(|a, b| across(*a).total_cmp(&across(*b))).expect("there are two at least")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::random::Random;

    fn targets(balls: Vec<Ball>) -> Vec<Ball> {
        Targets::new(balls, Ball { center: DVec3::ZERO, reach: 1e3 }).balls
    }

    #[test]
    fn what_is_apart_stays_apart_and_a_crowd_is_one() {
        let at = |x: f64, reach| Ball { center: DVec3::X * x, reach };
        assert_eq!(targets(vec![at(0.0, 1.0), at(9.0, 1.0)]).len(), 2);
        assert_eq!(targets(vec![at(0.0, 1.0), at(0.5, 1.0)]).len(), 1);
        // Four, two by two: a cut in two alone gains nothing until each part is cut again.
        let row: Vec<Ball> = [0.0, 0.1, 50.0, 50.1].map(|x| at(x, 1.0)).to_vec();
        assert_eq!(targets(row).len(), 2);
        assert!(targets(Vec::new()).is_empty());
    }

    #[test]
    fn any_number_of_balls_is_held_by_a_few() {
        let mut random = Random::new(7);
        for n in [1, 5, 33, 500] {
            let mut ball = || {
                let mut side = || random.between(-10.0, 10.0);
                Ball { center: DVec3::new(side(), side(), side()), reach: random.between(0.01, 0.5) }
            };
            let balls: Vec<Ball> = (0..n).map(|_| ball()).collect();
            let few = targets(balls.clone());
            assert!(few.len() <= MOST && few.len() <= n);
            let holds = |outer: &Ball, inner: &Ball| {
                outer.center.distance(inner.center) + inner.reach <= outer.reach * (1.0 + 1e-12)
            };
            assert!(balls.iter().all(|inner| few.iter().any(|outer| holds(outer, inner))), "{n}");
        }
    }
}
