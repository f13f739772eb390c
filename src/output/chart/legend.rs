//! The bar that says what the colours of a heat map mean.

use super::canvas::{Anchor, Canvas, Letters, Trouble};
use super::marks::Color;
use crate::output::short;
use image::imageops::{FilterType, resize};
use image::{Rgb, RgbImage};
use plotters::prelude::{BitMapBackend, IntoDrawingArea};

/// How high the strip with the bar is, in pixels.
pub const HEIGHT: u32 = 36;

/// The narrowest strip that has room for its words, in pixels.
pub const NARROWEST: u32 = 160;

const GROUND: Color = [18, 18, 22];
const INK: Color = [225, 225, 230];

/// The rows of the bar.
const BAR: std::ops::Range<u32> = 6..18;

/// How far the bar stays from the edges, in pixels.
const MARGIN: u32 = 14;

/// As wide as the words before the bar.
const WORDS: u32 = 92;

/// How many times as fine letters are drawn.
const FINE: u32 = 4;

/// A strip with a bar of the colours from 0 to `most`, and numbers at its quarters; `or_more` where the last colour also
/// stands for larger numbers. `words` say what is counted, where there is room for them.
///
/// # Errors
/// A sentence, if the font can't be read.
pub fn legend(
    width: u32,
    words: &str,
    most: f64,
    or_more: bool,
    color: fn(f64) -> [u8; 3],
) -> Result<RgbImage, Trouble> {
    let has_words = width >= 2 * NARROWEST;
    let left = if has_words { WORDS } else { MARGIN };
    let right = width - MARGIN;
    let mut buffer = vec![0; (width * FINE) as usize * (HEIGHT * FINE) as usize * 3];
    {
        let size = (width * FINE, HEIGHT * FINE);
        let area = BitMapBackend::with_buffer(&mut buffer, size).into_drawing_area();
        let canvas = Canvas::new(&area, FINE.into(), 0.1);
        canvas.fill(GROUND)?;
        let letters = Letters {
            size: 11.0,
            color: INK,
            is_bold: false,
            anchor: Anchor::Left,
            is_upright: false,
        };
        if has_words {
            canvas.text([MARGIN.into(), 12.0], words, letters)?;
        }
        let parts = if has_words { 4 } else { 2 };
        for i in 0..=parts {
            let share = f64::from(i) / f64::from(parts);
            let x = f64::from(left) + share * f64::from(right - left);
            let more = if i == parts && or_more { "+" } else { "" };
            let anchor = if i == parts {
                Anchor::Right
            } else {
                Anchor::Middle
            };
            let x = if i == parts {
                x + f64::from(MARGIN) - 4.0
            } else {
                x
            };
            let number = format!("{}{more}", short(share * most));
            canvas.text([x, 27.0], &number, Letters { anchor, ..letters })?;
        }
        area.present().map_err(|error| error.to_string())?;
    }
    let fine = RgbImage::from_raw(width * FINE, HEIGHT * FINE, buffer).ok_or("no pixels")?;
    let mut strip = resize(&fine, width, HEIGHT, FilterType::Triangle);
    for x in left..right {
        let share = f64::from(x - left) / f64::from(right - 1 - left);
        BAR.for_each(|y| strip.put_pixel(x, y, Rgb(color(share))));
    }
    Ok(strip)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grey(share: f64) -> [u8; 3] {
        [(255.0 * share).round() as u8; 3]
    }

    #[test]
    fn the_bar_has_all_colours_and_numbers_below_it() {
        for width in [NARROWEST, 500] {
            let strip = legend(width, "steps a ray", 64.0, true, grey).unwrap();
            assert_eq!(strip.dimensions(), (width, HEIGHT));
            let bar: Vec<u8> = (0..width).map(|x| strip.get_pixel(x, 10).0[0]).collect();
            let left = bar.iter().position(|v| *v == 0).unwrap();
            let right = bar.iter().position(|v| *v == 255).unwrap();
            assert!(bar[left..=right].is_sorted(), "{bar:?}");
            let lit = |from: u32, to: u32| {
                let places = (from..to).flat_map(|x| (20..HEIGHT).map(move |y| (x, y)));
                places
                    .filter(|(x, y)| strip.get_pixel(*x, *y).0[0] > 90)
                    .count()
            };
            assert!(
                lit(0, width / 2) > 3 && lit(width - 30, width) > 3,
                "{width}"
            );
        }
    }
}
