//! Which pixels of a picture need more than one sample: those that differ from a neighbour.
//!
//! One sample in the middle of each pixel says what is seen, where it faces, and its colour. Where all of this is about that of
//! the eight neighbours, more samples would find hardly anything else; what is smaller than a pixel and lies between the
//! middles is missed. Source: Whitted 1980, who divides pixels whose corners differ in colour; here parts and
//! normals count too, so that edges between like colours are found.

use super::Channel;
use super::film::Film;

/// Normals farther apart than 20 degrees differ: this is its cosine.
const ALIKE: f32 = 0.94;

/// Colours differ by more than this, as shown: of their square roots, so that steps in the dark count as they are seen.
const STEP: f32 = 1.0 / 32.0;

/// What has to be recorded to tell, beyond what the picture shows.
pub(super) const NEEDED: [Channel; 3] = [Channel::Normal, Channel::Verdict, Channel::Object];

/// The pixels of a picture that need more samples, in rows from the top.
pub(super) struct Refined {
    width: u32,
    needs: Vec<bool>,
}

impl Refined {
    /// Those of a film of one sample a pixel, which has recorded what is [needed](NEEDED). Those of which the tracer could not tell
    /// are among them.
    pub fn of(film: &Film) -> Self {
        let (width, height) = (film.width(), film.height());
        let mut needs = vec![false; width as usize * height as usize];
        let number = |[i, j]: [u32; 2]| j as usize * width as usize + i as usize;
        for (i, j) in (0..height).flat_map(|j| (0..width).map(move |i| (i, j))) {
            let here = [i, j];
            if film.at(Channel::Verdict, i, j) == [UNKNOWN] {
                needs[number(here)] = true;
            }
            // Each pair of neighbours once.
            let right = (i + 1 < width).then_some([i + 1, j]);
            let below = (j + 1 < height).then_some([i, j + 1]);
            let across = right.and(below).map(|_| [i + 1, j + 1]);
            let back = below.filter(|_| i > 0).map(|_| [i.wrapping_sub(1), j + 1]);
            for other in [right, below, across, back].into_iter().flatten() {
                if differ(film, here, other) {
                    needs[number(here)] = true;
                    needs[number(other)] = true;
                }
            }
        }
        Self { width, needs }
    }

    /// Whether a pixel needs more samples.
    pub fn needs(&self, [i, j]: [u32; 2]) -> bool {
        self.needs[j as usize * self.width as usize + i as usize]
    }

    /// How many pixels do.
    pub fn count(&self) -> u64 {
        self.needs.iter().filter(|needs| **needs).count() as u64
    }
}

/// What [`Channel::Verdict`] says of a pixel of which the tracer could not tell.
const UNKNOWN: f32 = 2.0;

/// Whether two pixels show different things.
fn differ(film: &Film, [i, j]: [u32; 2], [k, l]: [u32; 2]) -> bool {
    let pair = |channel| (film.at(channel, i, j), film.at(channel, k, l));
    let (part, other) = pair(Channel::Object);
    if part != other {
        return true;
    }
    let (a, b) = pair(Channel::Normal);
    let is_hit = part[0] >= 0.0;
    if is_hit && a.iter().zip(b).map(|(a, b)| a * b).sum::<f32>() < ALIKE {
        return true;
    }
    [Channel::Beauty, Channel::Color]
        .into_iter()
        .any(|channel| {
            let (a, b) = pair(channel);
            a.iter()
                .zip(b)
                .any(|(a, b)| (shown(*a) - shown(*b)).abs() > STEP)
        })
}

/// About how bright a linear value is shown, from 0 to 1.
fn shown(linear: f32) -> f32 {
    linear.clamp(0.0, 1.0).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A film of 5 x 4 pixels that show one wall facing the camera, but for what `change` makes of the numbers of a channel.
    fn film(change: impl Fn(Channel, [u32; 2]) -> Option<Vec<f32>>) -> Film {
        let channels = [
            Channel::Beauty,
            Channel::Normal,
            Channel::Verdict,
            Channel::Object,
        ];
        let mut film = Film::new([5, 4], &channels);
        let wall = |channel: Channel| match channel {
            Channel::Beauty => vec![0.5, 0.5, 0.5],
            Channel::Normal => vec![0.0, 0.0, 1.0],
            Channel::Verdict => vec![1.0],
            _ => vec![7.0],
        };
        for plane in film.planes_mut() {
            let channel = plane.channel;
            let pixels = (0..4).flat_map(|j| (0..5).map(move |i| [i, j]));
            let numbers = pixels.flat_map(|p| change(channel, p).unwrap_or_else(|| wall(channel)));
            plane.values = numbers.collect();
        }
        film
    }

    /// How many pixels need more samples if pixel (2, 1) shows these numbers of a channel.
    fn refined(channel: Channel, numbers: &[f32]) -> u64 {
        let odd = |which, pixel| (which == channel && pixel == [2, 1]).then(|| numbers.to_vec());
        let refined = Refined::of(&film(odd));
        assert!(!refined.needs([4, 3]) && !refined.needs([0, 3]));
        refined.count()
    }

    #[test]
    fn pixels_that_differ_from_a_neighbour_need_more_samples() {
        assert_eq!(refined(Channel::Beauty, &[0.5, 0.5, 0.5]), 0);
        assert_eq!(refined(Channel::Object, &[8.0]), 9);
        assert_eq!(refined(Channel::Object, &[-1.0]), 9);
        let turned = |degrees: f32| [degrees.to_radians().sin(), 0.0, degrees.to_radians().cos()];
        assert_eq!(refined(Channel::Normal, &turned(19.0)), 0);
        assert_eq!(refined(Channel::Normal, &turned(21.0)), 9);
        // A step of a thirtieth as shown, and one of half of it.
        let brighter = |step: f32| (0.5f32.sqrt() + step).powi(2);
        assert_eq!(
            refined(Channel::Beauty, &[0.5, brighter(1.0 / 30.0), 0.5]),
            9
        );
        assert_eq!(
            refined(Channel::Beauty, &[0.5, brighter(1.0 / 60.0), 0.5]),
            0
        );
    }

    #[test]
    fn pixels_without_an_answer_need_more_samples() {
        assert_eq!(refined(Channel::Verdict, &[2.0]), 1);
    }

    #[test]
    fn normals_of_nothing_do_not_count() {
        let sky = film(|channel, pixel| match channel {
            Channel::Object => Some(vec![-1.0]),
            Channel::Normal => Some(vec![0.0, 0.0, pixel[0] as f32 / 100.0]),
            _ => None,
        });
        assert_eq!(Refined::of(&sky).count(), 0);
    }

    #[test]
    fn neighbours_across_corners_and_edges_of_the_picture_count() {
        for corner in [[0, 0], [4, 0], [0, 3], [4, 3]] {
            let odd =
                |channel, pixel| (channel == Channel::Object && pixel == corner).then(|| vec![1.0]);
            let refined = Refined::of(&film(odd));
            assert_eq!(refined.count(), 4, "{corner:?}");
        }
    }
}
