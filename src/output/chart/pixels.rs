//! Charts as pixels.

use super::Chart;
use super::canvas::Canvas;
use super::draw::{draw, size};
use image::RgbImage;
use image::imageops::{FilterType, resize};
use plotters::prelude::{BitMapBackend, IntoDrawingArea};

/// Pixels a point of the chart, and how many times as fine it is drawn.
const PIXELS: f64 = 2.0;
const FINE: f64 = 2.0;

/// By how much letters come out too high: the room for accents above them counts as part of them.
const DROP: f64 = 0.1;

/// The chart as pixels of sRGB, two a point.
///
/// # Errors
/// A sentence, if a font of charts can't be read.
pub fn pixels(chart: &Chart) -> Result<RgbImage, String> {
    let points = size(chart);
    let [width, height] = points.map(|x| (x * PIXELS).ceil() as u32);
    let [wide, high] = [width, height].map(|n| n * FINE as u32);
    let mut buffer = vec![255; wide as usize * high as usize * 3];
    {
        let area = BitMapBackend::with_buffer(&mut buffer, (wide, high)).into_drawing_area();
        draw(chart, &Canvas::new(&area, PIXELS * FINE, DROP))?;
        area.present().map_err(|error| error.to_string())?;
    }
    let fine = RgbImage::from_raw(wide, high, buffer).ok_or("the chart has no pixels")?;
    Ok(resize(&fine, width, height, FilterType::Triangle))
}

#[cfg(test)]
mod tests {
    use super::super::{Axis, Line, Panel, Point, Scale, Series};
    use super::*;

    fn chart(title: &str) -> Chart {
        let axis = |label: &str| Axis {
            label: label.into(),
            scale: Scale::Log,
        };
        let series = Series {
            name: "a".into(),
            style: 0,
            line: Line::Solid,
            points: vec![Point::new(1.0, 1.0), Point::new(10.0, 100.0)],
        };
        let panel = Panel {
            title: title.into(),
            x: axis("x"),
            y: axis("y"),
            series: vec![series],
        };
        Chart {
            columns: 1,
            panels: vec![panel],
            ..Chart::default()
        }
    }

    /// Letters come from the fonts of charts, not from the system.
    #[test]
    fn letters_are_drawn() {
        let [without, with] = ["", "Schnelligkeit"].map(|title| pixels(&chart(title)).unwrap());
        assert_eq!(without.dimensions(), with.dimensions());
        let differ = without
            .pixels()
            .zip(with.pixels())
            .filter(|(a, b)| a != b)
            .count();
        assert!(differ > 500, "{differ} pixels of a title");
    }

    #[test]
    fn marks_have_their_colour_and_white_is_the_paper() {
        let image = pixels(&chart("")).unwrap();
        let orange = image.pixels().filter(|p| p.0 == [213, 94, 0]).count();
        assert!(orange > 50, "{orange} pixels");
        assert_eq!(image.get_pixel(0, 0).0, [255; 3]);
    }

    #[test]
    fn vector_chart_has_the_same_words() {
        let text = super::super::svg(&chart("Schnelligkeit & Treue")).unwrap();
        assert!(text.starts_with("<svg width=\"660\" "), "{}", &text[..80]);
        assert!(text.contains("Schnelligkeit &amp; Treue"));
    }
}
