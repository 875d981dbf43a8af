//! The row of items: along the curve of Morton, which is near where it was near before.

use super::super::boxes::{Boxed, Item, middles_of};
use glam::Vec4;
use rayon::prelude::*;

/// Bits of each coordinate; three times as many fit a code.
const BITS: u32 = 21;
/// A little less than all cells, so that what lies at the far end and is rounded up stays in the last one.
const CELLS: f32 = ((1 << BITS) - 2) as f32;

/// Orders items by their middles, those of one cell as they stand.
pub(super) fn sort(items: &mut Vec<Item>) {
    let middles = middles_of(items);
    let lower = Vec4::new(middles.lower(0), middles.lower(1), middles.lower(2), 0.0);
    // Cells are cubes: what is far apart along one axis is not to be torn by another.
    let size = (0..3).map(|axis| middles.upper(axis) - middles.lower(axis)).fold(0.0, f32::max);
    let per_length = if size > 0.0 { (CELLS / size).min(f32::MAX) } else { 0.0 };
    let key =
        |(place, item): (usize, &Item)| (code((item.bounds().middle() - lower) * per_length), place as u32);
    let mut keys: Vec<(u64, u32)> = Vec::new();
    items.par_iter().enumerate().map(key).collect_into_vec(&mut keys);
    keys.par_sort_unstable();
    let mut sorted = Vec::new();
    keys.par_iter().map(|key| items[key.1 as usize]).collect_into_vec(&mut sorted);
    *items = sorted;
}

/// The bits of three cells in turn.
fn code(cell: Vec4) -> u64 {
    let [x, y, z, _] = cell.to_array();
    spread(x as u32) << 2 | spread(y as u32) << 1 | spread(z as u32)
}

/// Two zeros after each bit.
fn spread(cell: u32) -> u64 {
    let mut bits = u64::from(cell) & ((1 << BITS) - 1);
    bits = (bits | bits << 32) & 0x001f_0000_0000_ffff;
    bits = (bits | bits << 16) & 0x001f_0000_ff00_00ff;
    bits = (bits | bits << 8) & 0x100f_00f0_0f00_f00f;
    bits = (bits | bits << 4) & 0x10c3_0c30_c30c_30c3;
    (bits | bits << 2) & 0x1249_2492_4924_9249
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bits_stand_in_turn() {
        for bit in 0..BITS {
            assert_eq!(spread(1 << bit), 1 << (3 * bit));
        }
        assert_eq!(code(Vec4::new(5.0, 3.0, 1.0, 9.0)), 0b100_010_111);
    }
}
