//! Charts as SVG.

use super::Chart;
use super::canvas::Canvas;
use super::draw::{draw, size};
use plotters::prelude::{IntoDrawingArea, SVGBackend};

/// Units of the drawing a point of the chart: whole numbers are fine enough.
const FINE: f64 = 10.0;

/// The chart as SVG. Letters are those of the reader's program.
///
/// # Errors
/// A sentence, if a font of charts can't be read.
pub fn svg(chart: &Chart) -> Result<String, String> {
    let points = size(chart);
    let [width, height] = points.map(|x| (x * FINE).ceil() as u32);
    let mut text = String::new();
    {
        let area = SVGBackend::with_string(&mut text, (width, height)).into_drawing_area();
        draw(chart, &Canvas::new(&area, FINE, 0.0))?;
        area.present().map_err(|error| error.to_string())?;
    }
    let [wide, high] = points.map(|x| x.ceil());
    let fine = format!("<svg width=\"{width}\" height=\"{height}\"");
    Ok(text.replacen(
        &fine,
        &format!("<svg width=\"{wide}\" height=\"{high}\""),
        1,
    ))
}
