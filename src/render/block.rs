//! Blocks: the squares of pixels whose rays are traced together.

use super::area::Area;
use crate::num::BATCH;

/// The side of a block, in pixels: the rays of a block are traced together, with all that follows from them, so that
/// what they find does not depend on how blocks are put together to tiles.
pub(super) const BLOCK: u32 = 16;

/// The same, as a length of arrays.
const SIDE: usize = BLOCK as usize;

/// How many pixels a whole block has.
pub(super) const PIXELS: usize = SIDE * SIDE;

// What a block needs is treated at once.
const _: () = assert!(PIXELS == BATCH);

/// The places in a block along Morton's curve: each run of 64 is a square of 8 x 8, so that what is traced together lies
/// together.
const ORDER: [[u8; 2]; PIXELS] = {
    let mut order = [[0; 2]; PIXELS];
    let mut code = 0;
    while code < order.len() {
        let mut bit = 0;
        while bit < BLOCK.ilog2() {
            order[code][0] |= ((code >> (2 * bit) & 1) << bit) as u8;
            order[code][1] |= ((code >> (2 * bit + 1) & 1) << bit) as u8;
            bit += 1;
        }
        code += 1;
    }
    order
};

/// For each row of a block where its pixels are in that order, from left to right.
const ROWS: [[u8; SIDE]; SIDE] = {
    let mut rows = [[0; SIDE]; SIDE];
    let mut code = 0;
    while code < ORDER.len() {
        let [column, row] = ORDER[code];
        rows[row as usize][column as usize] = code as u8;
        code += 1;
    }
    rows
};

/// The pixels of a square, whose rays are traced together.
#[derive(Default)]
pub(super) struct Block {
    pixels: Vec<[u32; 2]>,
    /// Whether there are all of them.
    is_whole: bool,
}

impl Block {
    /// The pixels of an area, no wider or higher than [`BLOCK`].
    pub fn of(area: &Area) -> Self {
        let mut block = Self::default();
        block.move_to(area);
        block
    }

    /// As [`Block::of`], in the same memory.
    pub fn move_to(&mut self, area: &Area) {
        let [left, top] = area.corner;
        let places = ORDER.iter();
        self.pixels.clear();
        self.pixels
            .extend(places.map(|[i, j]| [left + u32::from(*i), top + u32::from(*j)]));
        self.is_whole = area.size() == [BLOCK; 2];
        if !self.is_whole {
            self.pixels.retain(|pixel| area.has(*pixel));
        }
    }

    /// Its pixels, columns and rows, in the order in which they are traced.
    pub fn pixels(&self) -> &[[u32; 2]] {
        &self.pixels
    }

    /// Its rows, if it is a whole square: where each begins, and where its pixels are among all of them, from left to right.
    pub fn rows(&self) -> Option<impl Iterator<Item = ([u32; 2], &'static [u8; SIDE])>> {
        let [left, top] = *self.pixels.first()?;
        let rows = (top..).zip(&ROWS);
        let rows = rows.map(move |(row, places)| ([left, row], places));
        self.is_whole.then_some(rows)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_are_those_of_the_pixels() {
        let mut area = Area {
            corner: [32, 48],
            end: [48, 64],
        };
        let mut block = Block::of(&area);
        let mut seen = 0;
        for ([left, row], places) in block.rows().into_iter().flatten() {
            for (column, place) in (left..).zip(places) {
                assert_eq!(block.pixels()[usize::from(*place)], [column, row]);
                seen += 1;
            }
        }
        assert_eq!((seen, block.pixels().len()), (256, 256));
        area.end[0] = 47;
        block.move_to(&area);
        assert!(block.pixels().len() == 15 * 16 && block.rows().is_none());
        assert!(Block::default().rows().is_none());
    }
}
