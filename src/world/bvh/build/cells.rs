//! Many items as few: those of one cell of a grid count as one, so that the upper levels of a tree, whose parts are much larger
//! than a cell, need not move every item once a level.

use super::boxes::{Box32, Boxed, Item, middles_of};
use super::grid::{Grid, MOST};

/// Items in cells.
pub(super) struct Cells<'a> {
    items: &'a [Item],
    /// Indices of items, cell by cell.
    by_cell: Vec<u32>,
}

/// A cell that is not empty.
#[derive(Clone, Copy)]
pub(super) struct Cell {
    bounds: Box32,
    first: u32,
    count: u32,
}

impl Boxed for Cell {
    fn bounds(&self) -> &Box32 {
        &self.bounds
    }

    fn weight(&self) -> u32 {
        self.count
    }

    fn number(&self) -> u32 {
        self.first
    }
}

impl<'a> Cells<'a> {
    /// Sorts items into the cells of a grid over their middles: [`MOST`] a side.
    pub fn of(items: &'a [Item]) -> (Cells<'a>, Vec<Cell>) {
        let grid = Grid::over(&middles_of(items), MOST);
        let cell_of = |item: &Item| {
            let [x, y, z] = grid.bins(item.bounds().middle());
            (x * MOST + y) * MOST + z
        };
        let mut cells = vec![Cell { bounds: Box32::EMPTY, first: 0, count: 0 }; MOST * MOST * MOST];
        let enter = |item: &Item| {
            let key = cell_of(item);
            let cell = &mut cells[key];
            cell.bounds.grow(item.bounds());
            cell.count += 1;
            key as u16
        };
        let keys: Vec<u16> = items.iter().map(enter).collect();
        let mut next = 0;
        for cell in &mut cells {
            (cell.first, next) = (next, next + cell.count);
        }
        let mut by_cell = vec![0; items.len()];
        for (i, &key) in keys.iter().enumerate() {
            let cell = &mut cells[key as usize];
            by_cell[cell.first as usize] = i as u32;
            cell.first += 1;
        }
        cells.retain(|cell| cell.count > 0);
        cells.iter_mut().for_each(|cell| cell.first -= cell.count);
        (Cells { items, by_cell }, cells)
    }

    /// The items of some cells.
    pub fn gather(&self, cells: &[Cell]) -> Vec<Item> {
        let indices =
            cells.iter().flat_map(|cell| &self.by_cell[cell.first as usize..][..cell.count as usize]);
        let count = cells.iter().map(|cell| cell.count as usize).sum();
        let mut items = Vec::with_capacity(count);
        items.extend(indices.map(|&i| self.items[i as usize]));
        items
    }
}
