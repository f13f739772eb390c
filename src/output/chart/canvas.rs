//! A surface to draw on, measured in points of the finished chart, whatever it is drawn with.

use super::marks::Color;
use plotters::coord::Shift;
use plotters::prelude::{
    DrawingArea, DrawingBackend, IntoFont, IntoTextStyle, PathElement, Polygon, RGBColor,
    ShapeStyle,
};
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{Color as _, FontStyle, FontTransform, TextStyle, register_font};
use std::sync::Once;

/// The family of the letters; in SVG, whatever the reader's program takes for it.
const FAMILY: &str = "sans-serif";

/// Where a text is put.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Anchor {
    /// Its left edge is at the point.
    Left,
    /// Its middle.
    Middle,
    /// Its right edge.
    Right,
}

/// How a text looks.
#[derive(Clone, Copy, Debug)]
pub(super) struct Letters {
    pub size: f64,
    pub color: Color,
    pub is_bold: bool,
    pub anchor: Anchor,
    /// Whether it runs upwards.
    pub is_upright: bool,
}

/// A surface to draw on.
pub(super) struct Canvas<'a, B: DrawingBackend> {
    area: &'a DrawingArea<B, Shift>,
    /// Pixels of the surface a point of the chart.
    scale: f64,
    /// By how much letters are moved down, as a share of their size, so that their middle is where it is meant to be.
    drop: f64,
}

/// Why a surface could not be drawn on.
pub(super) type Trouble = String;

impl<'a, B: DrawingBackend> Canvas<'a, B> {
    /// The surface, which has so many pixels a point of the chart and puts letters too high by this share of their size.
    pub fn new(area: &'a DrawingArea<B, Shift>, scale: f64, drop: f64) -> Self {
        static FONTS: Once = Once::new();
        FONTS.call_once(|| {
            let regular = include_bytes!("font/roboto-regular.ttf");
            let bold = include_bytes!("font/roboto-bold.ttf");
            // A font that can't be read shows in every picture; tests look at one.
            let _ = register_font(FAMILY, FontStyle::Normal, regular);
            let _ = register_font(FAMILY, FontStyle::Bold, bold);
        });
        Self { area, scale, drop }
    }

    fn pixel(&self, [x, y]: [f64; 2]) -> (i32, i32) {
        (
            (x * self.scale).round() as i32,
            (y * self.scale).round() as i32,
        )
    }

    fn stroke(&self, color: Color, width: f64) -> ShapeStyle {
        let width = (width * self.scale).round().max(1.0) as u32;
        rgb(color).stroke_width(width)
    }

    /// Fills the whole surface.
    pub fn fill(&self, color: Color) -> Result<(), Trouble> {
        self.area
            .fill(&rgb(color))
            .map_err(|error| error.to_string())
    }

    /// A line through points, piece by piece: joined in one, sharp corners would grow long spikes.
    pub fn line(&self, points: &[[f64; 2]], color: Color, width: f64) -> Result<(), Trouble> {
        for piece in points.windows(2) {
            self.path(piece, color, width)?;
        }
        Ok(())
    }

    fn path(&self, points: &[[f64; 2]], color: Color, width: f64) -> Result<(), Trouble> {
        let path: Vec<_> = points.iter().map(|p| self.pixel(*p)).collect();
        // A line without length is none.
        if path.windows(2).all(|pair| pair[0] == pair[1]) {
            return Ok(());
        }
        let element = PathElement::new(path, self.stroke(color, width));
        self.area.draw(&element).map_err(|error| error.to_string())
    }

    /// A line of dashes through points.
    pub fn dashes(&self, points: &[[f64; 2]], color: Color, width: f64) -> Result<(), Trouble> {
        const DASH: f64 = 5.0;
        const GAP: f64 = 4.0;
        let mut walked = 0.0;
        for pair in points.windows(2) {
            let [a, b] = [pair[0], pair[1]];
            let length = (b[0] - a[0]).hypot(b[1] - a[1]);
            let at = |s: f64| [0, 1].map(|i| a[i] + (b[i] - a[i]) * s / length);
            // Dashes start at multiples of their length and the gap's along the whole line.
            let mut from = -(walked % (DASH + GAP));
            while from < length {
                let (start, end) = (from.max(0.0), (from + DASH).min(length));
                if end > start {
                    self.line(&[at(start), at(end)], color, width)?;
                }
                from += DASH + GAP;
            }
            walked += length;
        }
        Ok(())
    }

    /// A filled polygon with a rim.
    pub fn polygon(
        &self,
        corners: &[[f64; 2]],
        fill: Color,
        rim: Color,
        width: f64,
    ) -> Result<(), Trouble> {
        let path: Vec<_> = corners.iter().map(|p| self.pixel(*p)).collect();
        self.area
            .draw(&Polygon::new(path, rgb(fill).filled()))
            .map_err(|error| error.to_string())?;
        let closed: Vec<[f64; 2]> = corners.iter().chain(corners.first()).copied().collect();
        self.path(&closed, rim, width)
    }

    /// A text whose middle line, from left to right or upwards, is at a point.
    pub fn text(&self, at: [f64; 2], text: &str, letters: Letters) -> Result<(), Trouble> {
        let at = [at[0], at[1] + self.drop * letters.size];
        self.area
            .draw_text(text, &self.style(letters), self.pixel(at))
            .map_err(|error| error.to_string())
    }

    fn style(&self, letters: Letters) -> TextStyle<'static> {
        let weight = if letters.is_bold {
            FontStyle::Bold
        } else {
            FontStyle::Normal
        };
        let font = (FAMILY, (letters.size * self.scale).round() as i32, weight).into_font();
        let font = if letters.is_upright {
            font.transform(FontTransform::Rotate270)
        } else {
            font
        };
        let horizontal = match letters.anchor {
            Anchor::Left => HPos::Left,
            Anchor::Middle => HPos::Center,
            Anchor::Right => HPos::Right,
        };
        TextStyle {
            color: rgb(letters.color).to_backend_color(),
            pos: Pos::new(horizontal, VPos::Center),
            ..font.into_text_style(self.area)
        }
    }
}

fn rgb([r, g, b]: Color) -> RGBColor {
    RGBColor(r, g, b)
}
