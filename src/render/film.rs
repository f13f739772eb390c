//! Film: what a rendering recorded, channel by channel, in rows from the top.

use super::Channel;
use glam::DVec3;

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

    /// Records pixels in all channels of the film, each at its column and row.
    pub(super) fn record<'a>(
        &mut self,
        pixels: impl Iterator<Item = ([u32; 2], &'a Pixel)> + Clone,
    ) {
        let Self {
            width,
            height,
            planes,
        } = self;
        for plane in planes {
            let n = plane.channel.components();
            for ([i, j], pixel) in pixels.clone() {
                assert!(i < *width && j < *height, "the pixel is on the film");
                let index = j as usize * *width as usize + i as usize;
                let numbers = pixel.numbers(plane.channel);
                plane.values[index * n..][..n].copy_from_slice(&numbers[..n]);
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

/// All that is known of one pixel.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Pixel {
    pub beauty: DVec3,
    pub color: DVec3,
    pub depth: f64,
    pub normal: DVec3,
    pub steps: f64,
    pub evaluations: f64,
    pub verdict: f64,
    pub object: f64,
}

impl Pixel {
    /// The numbers of a channel; a channel of one component is the first.
    fn numbers(&self, channel: Channel) -> [f32; 3] {
        let numbers = match channel {
            Channel::Beauty => self.beauty,
            Channel::Color => self.color,
            Channel::Depth => DVec3::splat(self.depth),
            Channel::Normal => self.normal,
            Channel::Steps => DVec3::splat(self.steps),
            Channel::Evaluations => DVec3::splat(self.evaluations),
            Channel::Verdict => DVec3::splat(self.verdict),
            Channel::Object => DVec3::splat(self.object),
        };
        numbers.to_array().map(|x| x as f32)
    }
}
