//! One split of a run: the cheapest plane between bins, by the surface-area heuristic, over all axes at once; of a handful, the
//! cheapest of all ways.

use super::boxes::{Box32, Boxed, bounds_of, middles_of};
use super::grid::{Grid, MOST};
use crate::world::bvh::Pricing;
use glam::Vec4;

/// Runs up to this length are split in the best of all ways, of which there are 2ⁿ⁻¹ − 1.
const HANDFUL: usize = 4;

/// How many bins a longer run is worth: sweeping over them should cost no more than filling them.
fn bins_for(count: usize) -> usize {
    match count {
        0..=16 => 8,
        17..=256 => 16,
        _ => MOST,
    }
}

/// What is in the bins of all three axes; kept between splits, as making it costs as much as a small split.
pub(super) struct Bins {
    bounds: [[Box32; 3]; MOST],
    /// How many items, a lane for each axis.
    weight: [[f32; 4]; MOST],
    pub pricing: Pricing,
}

/// The cheapest plane along each axis: the first bin of the right half, and the cost; infinite where there is none.
struct Planes {
    bin: Vec4,
    cost: Vec4,
}

impl Bins {
    /// Of no meaning yet.
    pub fn new(pricing: Pricing) -> Bins {
        Bins { bounds: [[Box32::EMPTY; 3]; MOST], weight: [[0.0; 4]; MOST], pricing }
    }

    fn fill<T: Boxed>(&mut self, run: &[T], grid: &Grid, n_bins: usize) {
        self.bounds[..n_bins].fill([Box32::EMPTY; 3]);
        self.weight[..n_bins].fill([0.0; 4]);
        for one in run {
            let bins = grid.bins(one.bounds().middle());
            for axis in 0..3 {
                self.bounds[bins[axis]][axis].grow(one.bounds());
                self.weight[bins[axis]][axis] += one.weight() as f32;
            }
        }
    }

    /// Sweeps over the bins of all axes at once.
    fn best(&self, n_bins: usize) -> Planes {
        let (bounds, weight) = (&self.bounds[..n_bins], &self.weight[..n_bins]);
        let mut right_cost = [Vec4::ZERO; MOST];
        let mut sum = Sum::EMPTY;
        for bin in (1..n_bins).rev() {
            sum.add(&bounds[bin], weight[bin]);
            right_cost[bin] = sum.cost(self.pricing);
        }
        let mut sum = Sum::EMPTY;
        let mut best = Planes { bin: Vec4::ZERO, cost: Vec4::INFINITY };
        let mut at = Vec4::ZERO;
        for bin in 1..n_bins {
            sum.add(&bounds[bin - 1], weight[bin - 1]);
            at += Vec4::ONE;
            let both = sum.cost(self.pricing) + right_cost[bin];
            let is_less = both.cmplt(best.cost);
            best.cost = Vec4::select(is_less, both, best.cost);
            best.bin = Vec4::select(is_less, at, best.bin);
        }
        best
    }

    fn sum(&self, axis: usize, bins: std::ops::Range<usize>) -> Box32 {
        self.bounds[bins].iter().fold(Box32::EMPTY, |all, b| all.with(&b[axis]))
    }
}

/// What lies on one side of a plane, for each axis.
struct Sum {
    bounds: [Box32; 3],
    weight: Vec4,
}

impl Sum {
    const EMPTY: Sum = Sum { bounds: [Box32::EMPTY; 3], weight: Vec4::ZERO };

    #[inline(always)]
    fn add(&mut self, bounds: &[Box32; 3], weight: [f32; 4]) {
        for axis in 0..3 {
            self.bounds[axis].grow(&bounds[axis]);
        }
        self.weight += Vec4::from_array(weight);
    }

    /// Area times tests on each axis; NaN where there is nothing, ∞·0, so that no comparison is won.
    #[inline(always)]
    fn cost(&self, pricing: Pricing) -> Vec4 {
        Box32::areas(&self.bounds) * pricing.tests_4(self.weight)
    }
}

/// A way to split a run.
struct Best {
    way: Way,
    /// Area times tests, summed over both halves.
    cost: f32,
    /// Of the halves.
    bounds: [Box32; 2],
}

enum Way {
    /// What lies in bins before this one of an axis, and the rest.
    Plane(Grid, usize, usize),
    /// Those whose bits are set, and the rest.
    Set(u32),
}

impl Best {
    /// The cheapest split; none where the middles do not spread.
    fn of<T: Boxed>(run: &[T], bins: &mut Bins) -> Option<Best> {
        if run.len() <= HANDFUL { Best::of_handful(run, bins.pricing) } else { Best::of_many(run, bins) }
    }

    fn of_many<T: Boxed>(run: &[T], bins: &mut Bins) -> Option<Best> {
        let n_bins = bins_for(run.len());
        let grid = Grid::over(&middles_of(run), n_bins);
        bins.fill(run, &grid, n_bins);
        let planes = bins.best(n_bins);
        let (bin, cost) = (planes.bin.to_array(), planes.cost.to_array());
        let axis = (0..3).filter(|&a| bin[a] > 0.0).min_by(|&a, &b| cost[a].total_cmp(&cost[b]))?;
        let (bin, cost) = (bin[axis] as usize, cost[axis]);
        let bounds = [bins.sum(axis, 0..bin), bins.sum(axis, bin..n_bins)];
        Some(Best { way: Way::Plane(grid, axis, bin), cost, bounds })
    }

    /// Over all sets that hold the first but not all.
    fn of_handful<T: Boxed>(run: &[T], pricing: Pricing) -> Option<Best> {
        let all = (1usize << run.len()) - 1;
        // Of every set: what it adds to that without its last.
        let mut bounds = [Box32::EMPTY; 1 << HANDFUL];
        let mut cost = [0.0; 1 << HANDFUL];
        let mut weight = [0; 1 << HANDFUL];
        for set in 1..all {
            let last = set.ilog2();
            let (one, rest) = (&run[last as usize], set ^ 1 << last);
            bounds[set] = bounds[rest].with(one.bounds());
            weight[set] = weight[rest] + one.weight();
            cost[set] = bounds[set].area() * pricing.tests(weight[set] as f32);
        }
        let mut best = (0, f32::INFINITY);
        for set in (1..all).step_by(2) {
            let both = cost[set] + cost[all ^ set];
            if both < best.1 || best.0 == 0 {
                best = (set, both);
            }
        }
        let (set, cost) = best;
        (set > 0).then(|| Best { way: Way::Set(set as u32), cost, bounds: [bounds[set], bounds[all ^ set]] })
    }

    fn partition<T: Boxed>(&self, run: &mut [T]) -> usize {
        match self.way {
            Way::Plane(grid, axis, bin) => {
                partition(run, |one, _| grid.is_before(one.bounds().middle(), axis, bin))
            }
            Way::Set(set) => partition(run, |_, i| set >> i & 1 == 1),
        }
    }
}

/// Moves the left half to the front; gives its length. Without branches: which half one belongs to cannot be foreseen.
#[inline(always)]
fn partition<T: Copy>(run: &mut [T], is_left: impl Fn(&T, usize) -> bool) -> usize {
    let mut left = 0;
    for i in 0..run.len() {
        let goes_left = is_left(&run[i], i);
        run.swap(i, left);
        left += usize::from(goes_left);
    }
    left
}

/// Halves by number along the axis where the middles spread most.
pub(super) fn halve<T: Boxed>(run: &mut [T]) -> (usize, [Box32; 2]) {
    let middles = middles_of(run);
    let spread = |a: usize| middles.upper(a) - middles.lower(a);
    let axis = (0..3).max_by(|&a, &b| spread(a).total_cmp(&spread(b))).unwrap_or(0);
    let half = run.len() / 2;
    let key = |one: &T| (one.bounds().middle()[axis], one.number());
    run.select_nth_unstable_by(half, |a, b| {
        let (a, b) = (key(a), key(b));
        a.0.total_cmp(&b.0).then(a.1.cmp(&b.1))
    });
    (half, [bounds_of(&run[..half]), bounds_of(&run[half..])])
}

/// A run on the way to becoming a child.
#[derive(Clone, Copy)]
pub(super) struct Part {
    /// Where its items begin among all items.
    pub first: usize,
    pub n_items: usize,
    /// Where its run begins in that of the node above.
    pub start: usize,
    /// Length of the run: fewer than the items where each stands for several.
    pub len: usize,
    pub bounds: Box32,
    /// Splits above.
    depth: u32,
}

/// What splitting a part costs, in tests of items that come with it or go.
#[derive(Clone, Copy)]
pub(super) enum Price {
    /// A node of its own, tested by every ray that meets the part.
    Node(f32),
    /// A child more of a node that has one to spare: all boxes of a node are tested at once, so only who meets a half pays for visiting it.
    Lane(f32),
}

impl Price {
    /// By the area of the part and of both halves together.
    fn of(self, area: f32, halves: f32) -> f32 {
        match self {
            Price::Node(cost) => cost * area,
            Price::Lane(cost) => cost * (halves - area),
        }
    }
}

/// Most items that a leaf may have; the heuristic usually stops earlier.
pub(super) const MAX_LEAF: usize = 8;
/// Binary splits after which halves are taken, so that no input makes a deep tree (a fan of needles would).
const MAX_SAH_DEPTH: u32 = 40;

impl Part {
    /// All items.
    pub fn whole<T: Boxed>(run: &[T]) -> Part {
        let n_items = run.iter().map(|one| one.weight() as usize).sum();
        Part { first: 0, n_items, start: 0, len: run.len(), bounds: bounds_of(run), depth: 0 }
    }

    /// The same items as a run of another length.
    pub fn as_run(self, len: usize) -> Part {
        Part { len, ..self }
    }

    /// The same where its run begins elsewhere.
    pub fn at(self, start: usize) -> Part {
        Part { start, ..self }
    }

    /// Two halves, the run partitioned; none where a leaf is cheaper.
    pub fn split<T: Boxed>(&self, run: &mut [T], price: Price, bins: &mut Bins) -> Option<[Part; 2]> {
        if run.len() < 2 {
            return None;
        }
        let found = if self.depth < MAX_SAH_DEPTH { Best::of(run, bins) } else { None };
        let (len, bounds) = match found {
            Some(best) => {
                let area = self.bounds.area();
                let halves = best.bounds[0].area() + best.bounds[1].area();
                if self.n_items <= MAX_LEAF
                    && bins.pricing.tests(self.n_items as f32) * area <= best.cost + price.of(area, halves)
                {
                    return None;
                }
                (best.partition(run), best.bounds)
            }
            None if self.n_items <= MAX_LEAF => return None,
            None => halve(run),
        };
        let n_left = run[..len].iter().map(|one| one.weight() as usize).sum();
        let depth = self.depth + 1;
        let left = Part { n_items: n_left, len, bounds: bounds[0], depth, ..*self };
        let right = Part {
            first: self.first + n_left,
            n_items: self.n_items - n_left,
            start: self.start + len,
            len: run.len() - len,
            bounds: bounds[1],
            depth,
        };
        Some([left, right])
    }
}
