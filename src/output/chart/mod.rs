//! Charts: points and lines on axes, side by side in panels, as SVG and as pixels.
//!
//! A chart of speed against accuracy has zeros that matter: an error of 0 is better than every other and must not be lost on
//! a logarithmic axis. So [`Scale::LogOrExact`] shows it at a break of the axis, and [`Scale::LogFromOne`] is linear up to 1.
//! No font of the system is asked for.

mod canvas;
mod draw;
mod legend;
mod marks;
mod pixels;
mod scale;
mod vector;

pub use legend::{NARROWEST, legend};
pub use marks::{Look, STYLES};
pub use pixels::pixels;
pub use scale::{EXACT, Scale};
pub use vector::svg;

/// Panels side by side, row by row, under a common title and legend.
#[derive(Clone, Debug, Default)]
pub struct Chart {
    /// What it shows.
    pub title: String,
    /// A sentence below the title.
    pub subtitle: String,
    /// How many panels are in a row; at least 1.
    pub columns: usize,
    /// The panels.
    pub panels: Vec<Panel>,
    /// What marks mean, below the series in the legend.
    pub notes: Vec<(Look, String)>,
}

/// Points on a pair of axes.
#[derive(Clone, Debug)]
pub struct Panel {
    /// What it shows.
    pub title: String,
    /// The horizontal axis.
    pub x: Axis,
    /// The vertical axis.
    pub y: Axis,
    /// What is drawn; of two at the same place, the one with the lower style is on top.
    pub series: Vec<Series>,
}

/// An axis.
#[derive(Clone, Debug)]
pub struct Axis {
    /// What it measures, with the unit.
    pub label: String,
    /// How numbers lie on it.
    pub scale: Scale,
}

/// Points that belong together.
#[derive(Clone, Debug)]
pub struct Series {
    /// What the legend calls it; the same name has the same style in all panels. Nothing is said of an empty one.
    pub name: String,
    /// Its colour and the shape of its points, by number.
    pub style: usize,
    /// How its points are joined.
    pub line: Line,
    /// The points, in the order in which they are joined.
    pub points: Vec<Point>,
}

/// How points are joined.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Line {
    /// Not at all.
    None,
    /// By a line.
    Solid,
    /// By a line of dashes without any mark on the points.
    Dashed,
    /// By a broad pale line behind everything, without any mark on the points.
    Band,
}

/// A point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point {
    /// Its place; what is not finite, or not on the scale, is left out.
    pub at: [f64; 2],
    /// Up to where its vertical value spreads.
    pub upper: Option<f64>,
    /// How it looks.
    pub look: Look,
}

impl Point {
    /// A point without any spread.
    pub fn new(x: f64, y: f64) -> Self {
        Self {
            at: [x, y],
            upper: None,
            look: Look::default(),
        }
    }
}
