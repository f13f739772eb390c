//! Film: what a rendering recorded, channel by channel, in rows from the top.

use super::Channel;

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

    /// Records some pixels, given by column and row, with the numbers of each of the film's channels.
    pub(super) fn record(&mut self, pixels: &[[u32; 2]], numbers: &[Vec<f32>]) {
        let places: Vec<usize> = pixels.iter().map(|[i, j]| self.index(*i, *j)).collect();
        for (plane, numbers) in self.planes.iter_mut().zip(numbers) {
            let n = plane.channel.components();
            for (place, numbers) in places.iter().zip(numbers.chunks_exact(n)) {
                plane.values[place * n..][..n].copy_from_slice(numbers);
            }
        }
    }

    fn index(&self, i: u32, j: u32) -> usize {
        assert!(
            i < self.width && j < self.height,
            "the pixel is on the film"
        );
        j as usize * self.width as usize + i as usize
    }
}
