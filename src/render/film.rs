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

    /// The film in bands of so many rows, from the top, each of which can be recorded by itself.
    pub(super) fn bands(&mut self, rows: u32) -> Vec<Band<'_>> {
        let (width, height) = (self.width, self.height);
        let firsts = (0..height).step_by(rows.max(1) as usize);
        let band = |first| Band {
            first,
            rows: rows.min(height - first),
            width,
            planes: Vec::new(),
        };
        let mut bands: Vec<Band> = firsts.map(band).collect();
        for plane in &mut self.planes {
            let n = plane.channel.components();
            let mut rest = &mut plane.values[..];
            for band in &mut bands {
                let (numbers, after) = rest.split_at_mut((band.rows * width) as usize * n);
                band.planes.push((n, numbers));
                rest = after;
            }
        }
        bands
    }

    fn index(&self, i: u32, j: u32) -> usize {
        assert!(
            i < self.width && j < self.height,
            "the pixel is on the film"
        );
        j as usize * self.width as usize + i as usize
    }
}

/// Some rows of a film.
pub(super) struct Band<'a> {
    first: u32,
    rows: u32,
    width: u32,
    /// For each channel how many numbers a pixel has, and the numbers.
    planes: Vec<(usize, &'a mut [f32])>,
}

impl Band<'_> {
    /// Records some pixels, given by column and row of the film, with the numbers of each of its channels.
    ///
    /// # Panics
    /// If a pixel is not in the band.
    pub fn record(&mut self, pixels: &[[u32; 2]], numbers: &[Vec<f32>]) {
        let place = |&[i, j]: &[u32; 2]| {
            let is_here = i < self.width && j >= self.first && j - self.first < self.rows;
            assert!(is_here, "the pixel is in the band");
            (j - self.first) as usize * self.width as usize + i as usize
        };
        let places: Vec<usize> = pixels.iter().map(place).collect();
        for ((n, plane), numbers) in self.planes.iter_mut().zip(numbers) {
            match n {
                3 => put(plane.as_chunks_mut::<3>().0, &places, numbers.as_chunks().0),
                _ => put(plane, &places, numbers),
            }
        }
    }
}

fn put<T: Copy>(pixels: &mut [T], places: &[usize], numbers: &[T]) {
    for (place, number) in places.iter().zip(numbers) {
        pixels[*place] = *number;
    }
}
