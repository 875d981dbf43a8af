//! One split of a run: the cheapest plane between bins, by the surface-area heuristic, over all axes at once; of a handful, the
//! cheapest of all ways.

use super::boxes::{Box32, Boxed, bounds_of, middles_of};
use super::grid::{Grid, MOST};

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

/// What is in each bin of each axis; kept between splits, as making it costs as much as a small split.
pub(super) struct Bins {
    bounds: [[Box32; MOST]; 3],
    weight: [[u32; MOST]; 3],
}

impl Bins {
    /// Of no meaning yet.
    pub fn new() -> Bins {
        Bins { bounds: [[Box32::EMPTY; MOST]; 3], weight: [[0; MOST]; 3] }
    }

    fn fill<T: Boxed>(&mut self, run: &[T], grid: &Grid, n_bins: usize) {
        for axis in 0..3 {
            self.bounds[axis][..n_bins].fill(Box32::EMPTY);
            self.weight[axis][..n_bins].fill(0);
        }
        for one in run {
            let bins = grid.bins(one.bounds().middle());
            for axis in 0..3 {
                self.bounds[axis][bins[axis]].grow(one.bounds());
                self.weight[axis][bins[axis]] += one.weight();
            }
        }
    }

    /// The first bin of the right half and the cost of the cheapest split along an axis.
    fn best_along(&self, axis: usize, n_bins: usize) -> Option<(usize, f32)> {
        let (bounds, weight) = (&self.bounds[axis][..n_bins], &self.weight[axis][..n_bins]);
        // NaN where there is nothing, so that no comparison is won.
        let cost = |bounds: &Box32, n: u32| if n > 0 { bounds.area() * n as f32 } else { f32::NAN };
        let mut right_cost = [0.0; MOST];
        let (mut sum, mut n) = (Box32::EMPTY, 0);
        for bin in (1..n_bins).rev() {
            sum.grow(&bounds[bin]);
            n += weight[bin];
            right_cost[bin] = cost(&sum, n);
        }
        let (mut sum, mut n) = (Box32::EMPTY, 0);
        let mut best = (0, f32::INFINITY);
        for bin in 1..n_bins {
            sum.grow(&bounds[bin - 1]);
            n += weight[bin - 1];
            let both = cost(&sum, n) + right_cost[bin];
            if both < best.1 {
                best = (bin, both);
            }
        }
        (best.0 > 0).then_some(best)
    }

    fn sum(&self, axis: usize, bins: std::ops::Range<usize>) -> Box32 {
        self.bounds[axis][bins].iter().fold(Box32::EMPTY, |mut all, b| {
            all.grow(b);
            all
        })
    }
}

/// A way to split a run.
struct Best {
    way: Way,
    /// Area times items, summed over both halves.
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
        if run.len() <= HANDFUL { Best::of_handful(run) } else { Best::of_many(run, bins) }
    }

    fn of_many<T: Boxed>(run: &[T], bins: &mut Bins) -> Option<Best> {
        let n_bins = bins_for(run.len());
        let grid = Grid::over(&middles_of(run), n_bins);
        bins.fill(run, &grid, n_bins);
        let along = |axis: usize| bins.best_along(axis, n_bins).map(|(bin, cost)| (axis, bin, cost));
        let (axis, bin, cost) = (0..3).filter_map(along).min_by(|a, b| a.2.total_cmp(&b.2))?;
        let bounds = [bins.sum(axis, 0..bin), bins.sum(axis, bin..n_bins)];
        Some(Best { way: Way::Plane(grid, axis, bin), cost, bounds })
    }

    /// Over all sets that hold the first but not all.
    fn of_handful<T: Boxed>(run: &[T]) -> Option<Best> {
        let mut best: Option<Best> = None;
        for set in (1..(1u32 << run.len()) - 1).step_by(2) {
            let mut bounds = [Box32::EMPTY; 2];
            let mut weight = [0; 2];
            for (i, one) in run.iter().enumerate() {
                let half = usize::from(set >> i & 1 == 0);
                bounds[half].grow(one.bounds());
                weight[half] += one.weight();
            }
            let cost = bounds[0].area() * weight[0] as f32 + bounds[1].area() * weight[1] as f32;
            if best.as_ref().is_none_or(|best| cost < best.cost) {
                best = Some(Best { way: Way::Set(set), cost, bounds });
            }
        }
        best
    }

    fn partition<T: Boxed>(&self, run: &mut [T]) -> usize {
        match self.way {
            Way::Plane(grid, axis, bin) => {
                partition(run, |one, _| grid.bin(one.bounds().middle()[axis], axis) < bin)
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
        Part { first: 0, n_items, len: run.len(), bounds: bounds_of(run), depth: 0 }
    }

    /// The same items as a run of another length.
    pub fn as_run(self, len: usize) -> Part {
        Part { len, ..self }
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
                    && self.n_items as f32 * area <= best.cost + price.of(area, halves)
                {
                    return None;
                }
                (best.partition(run), best.bounds)
            }
            None if self.n_items <= MAX_LEAF => return None,
            None => halve(run),
        };
        let n_left = run[..len].iter().map(|one| one.weight() as usize).sum();
        let half = |first, n_items, len, bounds| Part { first, n_items, len, bounds, depth: self.depth + 1 };
        Some([
            half(self.first, n_left, len, bounds[0]),
            half(self.first + n_left, self.n_items - n_left, run.len() - len, bounds[1]),
        ])
    }
}
