//! Film: what a rendering recorded, channel by channel, in rows from the top.

use super::Channel;
use super::block::Block;

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
    /// Records the `N` numbers of channel number `k`, counted from 0, for the pixels of a block.
    ///
    /// # Panics
    /// If a pixel is not on the patch.
    pub fn record<const N: usize>(
        &mut self,
        k: usize,
        block: &Block,
        numbers: impl Fn(usize) -> [f32; N],
    ) {
        if let Some(rows) = block.rows() {
            for (first, places) in rows {
                let row = self.piece::<N>(k, first, places.len());
                let row = row.as_chunks_mut().0;
                for (pixel, place) in row.iter_mut().zip(places) {
                    *pixel = numbers(usize::from(*place));
                }
            }
            return;
        }
        for (i, pixel) in block.pixels().iter().enumerate() {
            self.piece::<N>(k, *pixel, 1).copy_from_slice(&numbers(i));
        }
    }

    /// The `N` numbers of each of so many pixels of a row, in channel number `k`.
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn patches_cover_the_film() {
        let channels = [Channel::Beauty, Channel::Depth];
        for side in [[1, 1], [3, 2], [4, 8], [u32::MAX, u32::MAX]] {
            let (width, height) = (7, 5);
            let mut film = Film::new([width, height], &channels);
            for patch in &mut film.patches(side) {
                let [left, top] = patch.corner;
                let rows = top..height.min(top.saturating_add(side[1]));
                let columns = left..width.min(left.saturating_add(side[0]));
                let pixels = rows.flat_map(|j| columns.clone().map(move |i| [i, j]));
                let pixels: Vec<[u32; 2]> = pixels.collect();
                let number = |k: usize| (pixels[k][0] + 10 * pixels[k][1]) as f32 + 1.0;
                let block = Block::from(pixels.clone());
                patch.record(0, &block, |k| [number(k), 0.0, -number(k)]);
                patch.record(1, &block, |k| [2.0 * number(k)]);
            }
            for (i, j) in (0..height).flat_map(|j| (0..width).map(move |i| (i, j))) {
                let number = (i + 10 * j) as f32 + 1.0;
                assert_eq!(film.at(Channel::Beauty, i, j), [number, 0.0, -number]);
                assert_eq!(film.at(Channel::Depth, i, j), [2.0 * number]);
            }
        }
    }
}
