//! A channel of a film as a picture of 8-bit sRGB.

use super::chart::{NARROWEST, legend};
use super::colormap::{heat, hue};
use super::srgb::Codes;
use crate::render::{Channel, Film};
use image::{Rgb, RgbImage};

/// A picture of a channel.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Picture {
    /// Its pixels.
    pub image: RgbImage,
    /// How many pixels were not a number, and are black.
    pub not_a_number: u64,
}

/// What is shown where there is no hit.
const NOTHING: [u8; 3] = [0; 3];

/// The picture of `channel`, if the film recorded it. Beauty and color by the transfer function of sRGB, what is brighter
/// than 1 as 1; depth in greys, the nearest white, 1/4 the farthest; normals as `(1 + n) / 2`; steps and evaluations as heat
/// up to what 99 % of the pixels don't exceed, with a bar below that says what the colours mean (unless the picture is too narrow
/// for it); hits grey, misses dark, unknown magenta; parts in hues of their own.
pub fn picture(film: &Film, channel: Channel) -> Option<Picture> {
    let plane = film.plane(channel)?;
    let paint = painter(channel, &plane.values);
    let mut image = RgbImage::new(film.width(), film.height());
    let mut not_a_number = 0;
    let numbers = plane.values.chunks_exact(channel.components());
    for (pixel, numbers) in image.pixels_mut().zip(numbers) {
        not_a_number += u64::from(numbers.iter().any(|x| x.is_nan()));
        *pixel = Rgb(paint(numbers));
    }
    let words = match channel {
        Channel::Steps => "steps a ray",
        Channel::Evaluations => "evaluations a ray",
        _ => "",
    };
    if !words.is_empty() && film.width() >= NARROWEST {
        image = explained(image, words, &plane.values);
    }
    Some(Picture {
        image,
        not_a_number,
    })
}

/// The colour of a pixel's numbers.
type Painter = Box<dyn Fn(&[f32]) -> [u8; 3]>;

fn painter(channel: Channel, values: &[f32]) -> Painter {
    match channel {
        Channel::Beauty | Channel::Color => {
            let codes = Codes::new();
            Box::new(move |color| light(codes, color))
        }
        Channel::Normal => Box::new(normal),
        Channel::Depth => depth(values),
        Channel::Steps | Channel::Evaluations => cost(values),
        Channel::Verdict => Box::new(|v| verdict(v[0])),
        Channel::Object => Box::new(|v| object(v[0])),
    }
}

fn light(codes: Codes, color: &[f32]) -> [u8; 3] {
    std::array::from_fn(|i| codes.of(f64::from(color[i])))
}

fn normal(n: &[f32]) -> [u8; 3] {
    if n.iter().all(|x| *x == 0.0) {
        return NOTHING;
    }
    // Saturates, and takes NaN to 0.
    std::array::from_fn(|i| (255.0 * (0.5 + 0.5 * n[i])).round() as u8)
}

fn depth(values: &[f32]) -> Painter {
    let hits = || values.iter().copied().filter(|x| x.is_finite());
    let nearest = hits().fold(f32::INFINITY, f32::min);
    let farthest = hits().fold(f32::NEG_INFINITY, f32::max);
    let range = farthest - nearest;
    Box::new(move |v| {
        if !v[0].is_finite() {
            return NOTHING;
        }
        let share = if range > 0.0 {
            (v[0] - nearest) / range
        } else {
            0.0
        };
        [(255.0 * (1.0 - 0.75 * share)).round() as u8; 3]
    })
}

/// The heat map with its bar below.
fn explained(map: RgbImage, words: &str, values: &[f32]) -> RgbImage {
    let most = hottest(values);
    let or_more = values.iter().any(|x| f64::from(*x) > most);
    let Ok(strip) = legend(map.width(), words, most, or_more, heat) else {
        return map;
    };
    let mut whole = RgbImage::new(map.width(), map.height() + strip.height());
    image::imageops::replace(&mut whole, &map, 0, 0);
    image::imageops::replace(&mut whole, &strip, 0, map.height().into());
    whole
}

fn cost(values: &[f32]) -> Painter {
    let most = hottest(values);
    Box::new(move |v| heat(f64::from(v[0]) / most))
}

/// The number of the last colour of heat: what 99 % of the values don't exceed, but at least 1.
fn hottest(values: &[f32]) -> f64 {
    let mut sorted: Vec<f32> = values.iter().copied().filter(|x| x.is_finite()).collect();
    sorted.sort_by(f32::total_cmp);
    sorted
        .get((sorted.len() * 99 / 100).min(sorted.len().saturating_sub(1)))
        .map_or(1.0, |x| f64::from(*x).max(1.0))
}

fn verdict(v: f32) -> [u8; 3] {
    if v == 2.0 {
        [255, 0, 255]
    } else if v == 1.0 {
        [176; 3]
    } else {
        [32; 3]
    }
}

fn object(number: f32) -> [u8; 3] {
    if number >= 0.0 {
        hue(number as u64)
    } else {
        NOTHING
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn light_is_encoded_and_nan_is_black() {
        let light = |color: [f32; 3]| super::light(Codes::new(), &color);
        assert_eq!(light([0.0, 0.5, 2.0]), [0, 188, 255]);
        assert_eq!(light([f32::NAN, -1.0, 1.0]), [0, 0, 255]);
    }

    #[test]
    fn near_is_bright_and_nothing_is_black() {
        let paint = depth(&[2.0, 6.0, f32::INFINITY]);
        assert_eq!(paint(&[2.0]), [255; 3]);
        assert_eq!(paint(&[6.0]), [64; 3]);
        assert_eq!(paint(&[f32::INFINITY]), NOTHING);
        let flat = depth(&[3.0, 3.0]);
        assert_eq!(flat(&[3.0]), [255; 3]);
    }

    #[test]
    fn normals_fill_the_colour_cube() {
        assert_eq!(normal(&[1.0, 0.0, -1.0]), [255, 128, 0]);
        assert_eq!(normal(&[0.0; 3]), NOTHING);
    }

    #[test]
    fn one_costly_pixel_does_not_darken_the_rest() {
        let mut values = vec![10.0; 1000];
        values[0] = 1e6;
        let paint = cost(&values);
        assert_eq!(paint(&[10.0]), heat(1.0));
        assert_eq!(paint(&[5.0]), heat(0.5));
    }

    #[test]
    fn verdicts_and_parts_have_their_colours() {
        assert_eq!(verdict(2.0), [255, 0, 255]);
        assert_ne!(verdict(1.0), verdict(0.0));
        assert_eq!(object(-1.0), NOTHING);
        assert_eq!(object(5.0), hue(5));
    }

    #[test]
    fn heat_has_a_bar_below_where_there_is_room() {
        for (width, is_explained) in [(NARROWEST, true), (NARROWEST - 1, false)] {
            let film = Film::new([width, 3], &[Channel::Steps, Channel::Depth]);
            let height = |channel| picture(&film, channel).unwrap().image.height();
            assert_eq!(height(Channel::Steps) > 3, is_explained);
            assert_eq!(height(Channel::Depth), 3);
        }
    }

    #[test]
    fn what_was_not_recorded_has_no_picture() {
        let film = Film::new([2, 2], &[Channel::Depth]);
        assert!(picture(&film, Channel::Beauty).is_none());
        assert!(picture(&film, Channel::Depth).is_some());
    }
}
