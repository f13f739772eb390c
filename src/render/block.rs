//! Blocks: the squares of pixels whose rays are traced together.

use super::area::Area;
use crate::num::BATCH;
use std::ops::Range;

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
                self.push(left..right, row);
            }
        }
    }

    /// As [`Block::move_to`], of the pixels that are chosen alone.
    pub fn choose(&mut self, area: &Area, is_chosen: impl Fn([u32; 2]) -> bool) {
        self.move_to(area);
        let mut left = Self::default();
        for &Run { first, pixels } in &self.runs {
            let [column, row] = first;
            let all: Vec<u32> = (column..column + pixels as u32).collect();
            for columns in all.chunk_by(|a, b| is_chosen([*a, row]) == is_chosen([*b, row])) {
                if is_chosen([columns[0], row]) {
                    left.push(columns[0]..columns[0] + columns.len() as u32, row);
                }
            }
        }
        *self = left;
    }

    /// Adds neighbours in a row.
    fn push(&mut self, columns: Range<u32>, row: u32) {
        self.runs.push(Run {
            first: [columns.start, row],
            pixels: columns.len(),
        });
        self.pixels.extend(columns.map(|column| [column, row]));
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

    #[test]
    fn chosen_pixels_are_those_of_the_block_in_its_order() {
        let area = Area {
            corner: [16, 32],
            end: [32, 45],
        };
        let whole = Block::of(&area);
        for seed in 0..20 {
            let is_chosen = |[i, j]: [u32; 2]| (i * 7 + j * 13 + i * j) % 20 < seed;
            let mut block = Block::default();
            block.choose(&area, is_chosen);
            let expected = whole.pixels().iter().filter(|pixel| is_chosen(**pixel));
            assert!(expected.eq(block.pixels()), "{seed}");
            let columns = |run: &Run| run.first[0]..run.first[0] + run.pixels as u32;
            let of_run = |run: &Run| columns(run).map(|i| [i, run.first[1]]).collect::<Vec<_>>();
            let runs: Vec<_> = block.runs().iter().flat_map(of_run).collect();
            assert_eq!(runs, block.pixels());
            assert!(block.runs().iter().all(|run| run.pixels <= Run::LONGEST));
        }
    }
}
