//! Things with a place and a reach, found again by a point: a grid for each power of two of reaches, hashed. Knows nothing of
//! what they are.
//!
//! What is found comes in the order of reaches and, among those, of insertion: the same on every machine. Lengths enter by
//! their ratios alone, so a scene that is scaled by a power of two is answered in the same order.

use crate::render::sampler::mix;
use glam::DVec3;
use std::collections::HashMap;

/// Indices of things, by where they reach.
#[derive(Debug, Default)]
pub struct Grid {
    /// By a hash of the power of two and the cell: two cells of one hash only give what then proves to be too far.
    cells: HashMap<u64, Vec<u32>>,
    /// The powers of two in use, ascending.
    levels: Vec<i32>,
}

/// The smallest and largest power of two whose cells are used.
const LEVELS: [i32; 2] = [-1000, 1000];

impl Grid {
    /// Enters a thing, which reaches as far as `reach` about a point, more than 0. Nothing is done where a float cannot tell the cells.
    pub fn insert(&mut self, index: u32, point: DVec3, reach: f64) {
        let level = level_of(reach);
        if !(LEVELS[0]..=LEVELS[1]).contains(&level) {
            return;
        }
        if let Err(at) = self.levels.binary_search(&level) {
            self.levels.insert(at, level);
        }
        // A cell is at least as wide as the thing, which so lies in two of them an axis at most.
        let [low, high] = [-reach, reach].map(|by| cell(point + DVec3::splat(by), level));
        let mut keys = Vec::with_capacity(8);
        for corner in 0..8 {
            let of = |axis: usize| if corner >> axis & 1 == 0 { low[axis] } else { high[axis] };
            let key = key(level, [of(0), of(1), of(2)]);
            if !keys.contains(&key) {
                keys.push(key);
                self.cells.entry(key).or_default().push(index);
            }
        }
    }

    /// All things that may reach a point.
    pub fn near(&self, point: DVec3) -> impl Iterator<Item = u32> {
        let cells =
            self.levels.iter().filter_map(move |&level| self.cells.get(&key(level, cell(point, level))));
        cells.flatten().copied()
    }
}

/// The power of two below a length.
fn level_of(length: f64) -> i32 {
    (length.to_bits() >> 52) as i32 - 1023
}

/// The cell of a point; cells are four times as wide as the power of two, more than twice any reach of the level.
fn cell(point: DVec3, level: i32) -> [i64; 3] {
    let per_length = f64::from_bits(((1023 - level - 2) as u64) << 52);
    (point * per_length).to_array().map(|x| x.floor() as i64)
}

fn key(level: i32, cell: [i64; 3]) -> u64 {
    cell.into_iter().fold(mix(level as u64), |key, n| mix(key.wrapping_add(n as u64)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::render::sampler::Sampler;

    #[test]
    fn whatever_reaches_a_point_is_found_there_once() {
        let at = |i: u32| {
            let mut numbers = Sampler::new(5, i, 0, 0);
            let (a, b) = (numbers.next_2d(), numbers.next_2d());
            (DVec3::new(a.x, a.y, b.x) * 8.0 - 4.0, 0.01 + b.y * b.y * 2.0)
        };
        let mut grid = Grid::default();
        (0..500).for_each(|i| grid.insert(i, at(i).0, at(i).1));
        for probe in 1000..1400 {
            let point = at(probe).0;
            let found: Vec<u32> = grid.near(point).collect();
            for i in 0..500 {
                let reached = (0..3).all(|axis| (at(i).0[axis] - point[axis]).abs() <= at(i).1);
                let times = found.iter().filter(|&&f| f == i).count();
                assert!(times <= 1 && (times == 1 || !reached), "{i} {times} times at {point}");
            }
            assert!(found.len() < 250, "{} of 500", found.len());
        }
    }
}
