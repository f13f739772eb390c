//! Film: what a rendering recorded, channel by channel, in rows from the top.

use super::Channel;
use super::area::Area;
use super::block::{Block, Run};

/// One channel of a film.
#[derive(Clone, Debug, PartialEq)]
pub struct Plane {
    /// What is recorded.
    pub channel: Channel,
    /// [`Channel::components`] numbers for each pixel.
    pub values: Vec<f32>,
}

/// What a rendering recorded.
#[derive(Clone, Debug, PartialEq)]
pub struct Film {
    width: u32,
    height: u32,
    planes: Vec<Plane>,
}

impl Film {
    /// A black film of `size` (width and height in pixels) for these channels, each once.
    pub fn new(size: [u32; 2], channels: &[Channel]) -> Self {
        let [width, height] = size;
        let pixels = width as usize * height as usize;
        let mut film = Self {
            width,
            height,
            planes: Vec::new(),
        };
        for &channel in channels {
            if film.plane(channel).is_none() {
                let values = vec![0.0; pixels * channel.components()];
                film.planes.push(Plane { channel, values });
            }
        }
        film
    }

    /// The width in pixels.
    pub fn width(&self) -> u32 {
        self.width
    }

    /// The height in pixels.
    pub fn height(&self) -> u32 {
        self.height
    }

    /// A film of `size` (width and height in pixels) with these numbers of one channel, in rows from the top; none if there are
    /// not as many as it has.
    pub fn of(size: [u32; 2], channel: Channel, values: Vec<f32>) -> Option<Self> {
        let [width, height] = size;
        let pixels = u64::from(width) * u64::from(height);
        let count = pixels.checked_mul(channel.components() as u64);
        (count == Some(values.len() as u64)).then_some(Self {
            width,
            height,
            planes: vec![Plane { channel, values }],
        })
    }

    /// What was recorded, to be changed.
    #[cfg(test)]
    pub(super) fn planes_mut(&mut self) -> &mut [Plane] {
        &mut self.planes
    }

    /// Forgets all but these channels.
    pub(super) fn keep(&mut self, channels: &[Channel]) {
        self.planes
            .retain(|plane| channels.contains(&plane.channel));
    }

    /// What was recorded, in the order in which it was asked for.
    pub fn planes(&self) -> &[Plane] {
        &self.planes
    }

    /// What was recorded of `channel`, if it was.
    pub fn plane(&self, channel: Channel) -> Option<&Plane> {
        self.planes.iter().find(|plane| plane.channel == channel)
    }

    /// The numbers of `channel` at column `i` and row `j`, from the upper left; empty if it was not recorded.
    ///
    /// # Panics
    /// If the pixel is not on the film.
    pub fn at(&self, channel: Channel, i: u32, j: u32) -> &[f32] {
        let pixel = self.index(i, j);
        let n = channel.components();
        self.plane(channel)
            .map_or(&[], |plane| &plane.values[pixel * n..][..n])
    }

    /// The film in patches of this width and height, in rows from the top, each of which can be recorded by itself; those at the
    /// right and lower edge may be smaller.
    pub(super) fn patches(&mut self, side: [u32; 2]) -> Vec<Patch<'_>> {
        let size = [self.width as usize, self.height as usize];
        let side = [0, 1].map(|axis| (side[axis] as usize).clamp(1, size[axis].max(1)));
        let [across, down] = [0, 1].map(|axis| size[axis].div_ceil(side[axis]));
        let width = size[0];
        let patch = |k: usize| Patch {
            corner: [(k % across * side[0]) as u32, (k / across * side[1]) as u32],
            planes: Vec::with_capacity(self.planes.len()),
        };
        let mut patches: Vec<Patch> = (0..across * down).map(patch).collect();
        for (k, plane) in self.planes.iter_mut().enumerate() {
            for patch in &mut patches {
                patch.planes.push(Vec::with_capacity(side[1]));
            }
            let n = plane.channel.components();
            for (j, row) in plane.values.chunks_exact_mut(width * n).enumerate() {
                let beside = &mut patches[j / side[1] * across..];
                for (patch, piece) in beside.iter_mut().zip(row.chunks_mut(side[0] * n)) {
                    patch.planes[k].push(piece);
                }
            }
        }
        patches
    }

    fn index(&self, i: u32, j: u32) -> usize {
        assert!(
            i < self.width && j < self.height,
            "the pixel is on the film"
        );
        j as usize * self.width as usize + i as usize
    }
}

/// A rectangle of a film.
pub(super) struct Patch<'a> {
    /// Its upper left pixel.
    corner: [u32; 2],
    /// For each channel its rows.
    planes: Vec<Vec<&'a mut [f32]>>,
}

impl Patch<'_> {
    /// Records the `N` numbers of channel number `k`, counted from 0, for the pixels of a block: column by column, in the order
    /// of its pixels.
    ///
    /// # Panics
    /// If a pixel is not on the patch, or a column has no number for it.
    pub fn record<const N: usize>(&mut self, k: usize, block: &Block, numbers: [&[f32]; N]) {
        let mut from = 0;
        for Run { first, pixels } in block.runs() {
            let to = from + pixels;
            let row = self.piece::<N>(k, *first, *pixels).as_chunks_mut().0;
            // Of the usual length many are written at once.
            match row.first_chunk_mut() {
                Some(run) => interleave::<N, { Run::LONGEST }>(run, from, numbers),
                None => {
                    for (pixel, i) in row.iter_mut().zip(from..to) {
                        *pixel = numbers.map(|column| column[i]);
                    }
                }
            }
            from = to;
        }
    }

    /// Records the same `N` numbers of channel number `k`, counted from 0, for all pixels of an area.
    ///
    /// # Panics
    /// If a pixel is not on the patch.
    pub fn fill<const N: usize>(&mut self, k: usize, area: &Area, numbers: [f32; N]) {
        let [left, top] = area.corner;
        for row in top..area.end[1] {
            let piece = self.piece::<N>(k, [left, row], area.size()[0] as usize);
            piece.as_chunks_mut().0.fill(numbers);
        }
    }

    /// The `N` numbers of each of so many pixels of a row, in channel number `k`.
    #[inline(always)]
    fn piece<const N: usize>(
        &mut self,
        k: usize,
        [column, row]: [u32; 2],
        pixels: usize,
    ) -> &mut [f32] {
        let [left, top] = self.corner;
        let row = &mut self.planes[k][(row - top) as usize];
        &mut row[N * (column - left) as usize..][..N * pixels]
    }
}

/// Writes a run of pixels, whose numbers begin at one of the columns' rows.
#[inline(always)]
fn interleave<const N: usize, const RUN: usize>(
    run: &mut [[f32; N]; RUN],
    first: usize,
    numbers: [&[f32]; N],
) {
    let mut columns = [[0.0; RUN]; N];
    for (column, numbers) in columns.iter_mut().zip(numbers) {
        column.copy_from_slice(&numbers[first..first + RUN]);
    }
    for (i, pixel) in run.iter_mut().enumerate() {
        for (number, column) in pixel.iter_mut().zip(&columns) {
            *number = column[i];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::block::BLOCK;
    use super::*;

    #[test]
    fn patches_cover_the_film() {
        let channels = [Channel::Beauty, Channel::Depth];
        for side in [[1, 1], [3, 2], [16, 17], [32, 48], [u32::MAX, u32::MAX]] {
            let (width, height) = (57, 35);
            let mut film = Film::new([width, height], &channels);
            for patch in &mut film.patches(side) {
                let corner = patch.corner;
                let end = [(0, width), (1, height)];
                let end = end.map(|(axis, size)| size.min(corner[axis].saturating_add(side[axis])));
                for area in (Area { corner, end }).squares(BLOCK) {
                    let block = Block::of(&area);
                    let number = |[i, j]: &[u32; 2]| (i + 100 * j) as f32 + 1.0;
                    let numbers: Vec<f32> = block.pixels().iter().map(number).collect();
                    let less: Vec<f32> = numbers.iter().map(|x| -x).collect();
                    patch.record(0, &block, [&numbers, &vec![0.0; numbers.len()], &less]);
                    let [column, row] = area.corner;
                    patch.fill(1, &area, [(column + 100 * row) as f32 + 1.0]);
                }
            }
            for (i, j) in (0..height).flat_map(|j| (0..width).map(move |i| (i, j))) {
                let number = (i + 100 * j) as f32 + 1.0;
                assert_eq!(film.at(Channel::Beauty, i, j), [number, 0.0, -number]);
                let first = |x: u32, across: u32| x / across * across + x % across / BLOCK * BLOCK;
                let column = first(i, side[0].min(width));
                let row = first(j, side[1].min(height));
                let number = (column + 100 * row) as f32 + 1.0;
                assert_eq!(film.at(Channel::Depth, i, j), [number]);
            }
        }
    }

    #[test]
    fn numbers_make_a_film_if_there_are_as_many() {
        let film = Film::of([2, 1], Channel::Depth, vec![1.0, 2.0]).unwrap();
        assert_eq!(film.at(Channel::Depth, 1, 0), [2.0]);
        assert!(Film::of([2, 1], Channel::Beauty, vec![0.0; 5]).is_none());
        assert!(Film::of([u32::MAX; 2], Channel::Beauty, Vec::new()).is_none());
    }
}
