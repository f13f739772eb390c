//! Blocks: the squares of pixels whose rays are traced together.

use super::area::Area;
use crate::num::BATCH;

/// The side of a block, in pixels: the rays of a block are traced together, with all that follows from them, so that
/// what they find does not depend on how blocks are put together to tiles.
pub(super) const BLOCK: u32 = 16;

// What a block needs is treated at once.
const _: () = assert!((BLOCK * BLOCK) as usize == BATCH);

/// The side of the squares in it, in pixels: they follow each other, so that the rays of a packet lie close together.
const SQUARE: u32 = 8;

/// Neighbours in a row that follow each other.
#[derive(Clone, Copy, Debug)]
pub(super) struct Run {
    /// The column and row of the first.
    pub first: [u32; 2],
    /// How many there are; at most [`Run::LONGEST`].
    pub pixels: usize,
}

impl Run {
    /// So many there mostly are.
    pub const LONGEST: usize = SQUARE as usize;
}

/// The pixels of a square, whose rays are traced together.
#[derive(Default)]
pub(super) struct Block {
    runs: Vec<Run>,
    pixels: Vec<[u32; 2]>,
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
        self.runs.clear();
        self.pixels.clear();
        for square in area.squares(SQUARE) {
            let [left, right] = [square.corner[0], square.end[0]];
            for row in square.corner[1]..square.end[1] {
                self.runs.push(Run {
                    first: [left, row],
                    pixels: (right - left) as usize,
                });
                self.pixels
                    .extend((left..right).map(|column| [column, row]));
            }
        }
    }

    /// Its pixels, columns and rows, in the order in which they are traced: square by square, and in these row by row.
    pub fn pixels(&self) -> &[[u32; 2]] {
        &self.pixels
    }

    /// The same pixels as runs.
    pub fn runs(&self) -> &[Run] {
        &self.runs
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::HashSet;

    #[test]
    fn runs_are_those_of_the_pixels() {
        for end in [[48, 64], [47, 64], [33, 61], [40, 49]] {
            let corner = [32, 48];
            let area = Area { corner, end };
            let block = Block::of(&area);
            let mut pixels = block.pixels().iter();
            for run in block.runs() {
                let [left, row] = run.first;
                for column in left..left + run.pixels as u32 {
                    assert_eq!(pixels.next(), Some(&[column, row]));
                }
            }
            assert_eq!(pixels.next(), None);
            let distinct: HashSet<_> = block.pixels().iter().collect();
            assert_eq!(distinct.len(), area.pixels());
            assert!(block.pixels().iter().all(|pixel| area.has(*pixel)));
        }
    }
}
