//! A chart on a surface: title, legend, panels.

use super::canvas::{Anchor, Canvas, Letters, Trouble};
use super::marks::{BAND, Color, FAINT, GRID, INK, Look, PAPER, RING, Shape, WRONG, style};
use super::scale::Range;
use super::{Chart, Line, Panel, Point, Series};
use plotters::prelude::DrawingBackend;

/// The size of a panel with its title, labels and the room around it, in points: one of several in a row, and one alone.
const PANEL: [f64; 2] = [330.0, 264.0];
const ALONE: [f64; 2] = [660.0, 320.0];

/// The room within a panel that its plot leaves: left, top, right, below.
const MARGINS: [f64; 4] = [56.0, 32.0, 14.0, 46.0];

/// The height of a line of the legend.
const LEGEND_LINE: f64 = 20.0;

/// The radius of a point.
const RADIUS: f64 = 4.0;

const SMALL: f64 = 11.0;

fn letters(size: f64, color: Color, anchor: Anchor) -> Letters {
    Letters {
        size,
        color,
        is_bold: false,
        anchor,
        is_upright: false,
    }
}

/// Where title, legend and panels lie.
struct Layout {
    /// The legend's lines: what they show and where.
    legend: Vec<Entry>,
    /// Where the panels begin, from the top.
    top: f64,
    width: f64,
}

/// A word of the legend.
struct Entry {
    sign: Sign,
    text: String,
    at: [f64; 2],
}

/// What the legend shows beside a word.
#[derive(Clone, Copy)]
enum Sign {
    Series(usize, Line),
    Note(Look),
}

/// How many panels are in a row.
fn columns(chart: &Chart) -> usize {
    chart.columns.clamp(1, chart.panels.len().max(1))
}

/// The size of the panels of a chart.
fn panel_size(chart: &Chart) -> [f64; 2] {
    if columns(chart) == 1 { ALONE } else { PANEL }
}

/// Width and height of a chart in points, without its legend's wrapping, which needs a surface to measure on.
pub(super) fn size(chart: &Chart) -> [f64; 2] {
    let columns = columns(chart);
    let [wide, high] = panel_size(chart);
    let rows = chart.panels.len().div_ceil(columns);
    let width = (columns as f64 * wide).max(2.0 * PANEL[0]);
    [
        width,
        head(chart) + legend_lines(chart, width) as f64 * LEGEND_LINE + 8.0 + rows as f64 * high,
    ]
}

/// The height of title and subtitle.
fn head(chart: &Chart) -> f64 {
    let title = if chart.title.is_empty() { 8.0 } else { 38.0 };
    title + if chart.subtitle.is_empty() { 0.0 } else { 20.0 }
}

/// All points of a chart.
fn points(chart: &Chart) -> impl Iterator<Item = &Point> {
    let series = chart.panels.iter().flat_map(|panel| &panel.series);
    series.flat_map(|series| &series.points)
}

/// The words of the legend, each once; of the notes, those on marks that some point bears.
fn words(chart: &Chart) -> Vec<(Sign, &str)> {
    let mut words: Vec<(Sign, &str)> = Vec::new();
    for series in chart.panels.iter().flat_map(|panel| &panel.series) {
        let is_new = words.iter().all(|(_, name)| *name != series.name);
        if is_new && !series.name.is_empty() {
            words.push((Sign::Series(series.style, series.line), &series.name));
        }
    }
    // In the order of their styles, bands and dashes last, whatever is drawn on top of what.
    words.sort_by_key(|(sign, _)| match sign {
        Sign::Series(number, line) => (*line != Line::Solid, *number),
        Sign::Note(_) => (true, usize::MAX),
    });
    let is_used = |look: &Look| points(chart).any(|point| point.look.has_some_of(look));
    let notes = chart.notes.iter().filter(|(look, _)| is_used(look));
    words.extend(notes.map(|(look, text)| (Sign::Note(*look), &text[..])));
    words
}

/// How wide a word of the legend is with its sign, judged by its letters: the same on every surface, with room for fonts that
/// are wider than ours.
fn word_width(text: &str) -> f64 {
    36.0 + 12.0 * text.chars().map(letter_width).sum::<f64>() + 18.0
}

/// About how wide a letter is beside its height.
fn letter_width(letter: char) -> f64 {
    match letter {
        'f' | 'i' | 'j' | 'l' | 'r' | 't' | 'I' | ' ' | '.' | ',' | ':' | '-' | '(' | ')' | '/' => {
            0.36
        }
        'm' | 'w' | 'M' | 'W' => 0.86,
        'A'..='Z' => 0.68,
        _ => 0.57,
    }
}

/// How many lines the legend has.
fn legend_lines(chart: &Chart, width: f64) -> usize {
    let mut lines = 1;
    let mut x = 20.0;
    for (_, text) in words(chart) {
        if x + word_width(text) > width && x > 20.0 {
            lines += 1;
            x = 20.0;
        }
        x += word_width(text);
    }
    if words(chart).is_empty() { 0 } else { lines }
}

fn layout(chart: &Chart) -> Layout {
    let [width, _] = size(chart);
    let mut legend = Vec::new();
    let (mut x, mut y) = (20.0, head(chart) + 0.5 * LEGEND_LINE);
    for (sign, text) in words(chart) {
        if x + word_width(text) > width && x > 20.0 {
            (x, y) = (20.0, y + LEGEND_LINE);
        }
        legend.push(Entry {
            sign,
            text: text.into(),
            at: [x, y],
        });
        x += word_width(text);
    }
    let top = head(chart) + legend_lines(chart, width) as f64 * LEGEND_LINE + 8.0;
    Layout { legend, top, width }
}

/// Draws all of a chart.
pub(super) fn draw<B: DrawingBackend>(chart: &Chart, canvas: &Canvas<B>) -> Result<(), Trouble> {
    canvas.fill(PAPER)?;
    let layout = layout(chart);
    let title = Letters {
        is_bold: true,
        ..letters(18.0, INK, Anchor::Left)
    };
    canvas.text([20.0, 22.0], &chart.title, title)?;
    canvas.text(
        [20.0, head(chart) - 12.0],
        &chart.subtitle,
        letters(12.0, FAINT, Anchor::Left),
    )?;
    for entry in &layout.legend {
        draw_entry(canvas, entry)?;
    }
    let columns = columns(chart);
    let [wide, high] = panel_size(chart);
    let left = 0.5 * (layout.width - columns as f64 * wide);
    for (i, panel) in chart.panels.iter().enumerate() {
        let corner = [
            left + (i % columns) as f64 * wide,
            layout.top + (i / columns) as f64 * high,
        ];
        Plot::new(panel, corner, [wide, high]).draw(canvas)?;
    }
    Ok(())
}

fn draw_entry<B: DrawingBackend>(canvas: &Canvas<B>, entry: &Entry) -> Result<(), Trouble> {
    let [x, y] = entry.at;
    let ends = [[x, y], [x + 26.0, y]];
    match entry.sign {
        Sign::Series(number, line) => {
            let (color, _) = style(number);
            match line {
                Line::Solid => canvas.line(&ends, color, 1.6)?,
                Line::Dashed => canvas.dashes(&ends, color, 1.4)?,
                Line::Band => canvas.line(&ends, BAND, 7.0)?,
                Line::None => {}
            }
            if matches!(line, Line::Solid | Line::None) {
                mark(canvas, [x + 13.0, y], number, Look::default())?;
            }
        }
        Sign::Note(look) => mark(canvas, [x + 13.0, y], NOTE, look)?,
    }
    canvas.text([x + 33.0, y], &entry.text, letters(12.0, INK, Anchor::Left))
}

/// The style of marks in notes, which are of no series: a dark disc.
const NOTE: usize = 46;

/// The mark of a point of a series.
fn mark<B: DrawingBackend>(
    canvas: &Canvas<B>,
    at: [f64; 2],
    number: usize,
    look: Look,
) -> Result<(), Trouble> {
    let (color, shape) = style(number);
    let color = if look.is_wrong { WRONG } else { color };
    let radius = if look.is_default {
        1.6 * RADIUS
    } else {
        RADIUS
    };
    let (rim, width) = if look.is_default {
        (INK, 1.4)
    } else {
        (PAPER, 0.8)
    };
    let around = |radius: f64| -> Vec<[f64; 2]> {
        shape
            .corners()
            .iter()
            .map(|c| [at[0] + radius * c[0], at[1] + radius * c[1]])
            .collect()
    };
    if look.is_ringed {
        let ring = Shape::Disc.corners();
        let corner = |c: &[f64; 2]| [0, 1].map(|i| at[i] + 2.0 * radius * c[i]);
        let closed: Vec<[f64; 2]> = ring.iter().chain(ring.first()).map(corner).collect();
        canvas.line(&closed, RING, 1.5)?;
    }
    canvas.polygon(&around(radius), color, rim, width)?;
    if look.is_crossed {
        let r = 0.8 * RADIUS;
        let [x, y] = at;
        canvas.line(&[[x - r, y - r], [x + r, y + r]], INK, 1.2)?;
        canvas.line(&[[x - r, y + r], [x + r, y - r]], INK, 1.2)?;
    }
    Ok(())
}

/// A panel with its ranges and its place.
struct Plot<'a> {
    panel: &'a Panel,
    x: Range,
    y: Range,
    corner: [f64; 2],
    size: [f64; 2],
}

impl<'a> Plot<'a> {
    fn new(panel: &'a Panel, corner: [f64; 2], size: [f64; 2]) -> Self {
        let points = || panel.series.iter().flat_map(|s| &s.points);
        let y = points().flat_map(|p| [Some(p.at[1]), p.upper].into_iter().flatten());
        Self {
            x: panel.x.scale.range(points().map(|p| p.at[0])),
            y: panel.y.scale.range(y),
            panel,
            corner,
            size,
        }
    }

    /// The edges of the plot: left, top, right, bottom.
    fn edges(&self) -> [f64; 4] {
        let [x, y] = self.corner;
        let [left, top, right, below] = MARGINS;
        let top = if self.panel.title.is_empty() {
            10.0
        } else {
            top
        };
        [
            x + left,
            y + top,
            x + self.size[0] - right,
            y + self.size[1] - below,
        ]
    }

    fn across(&self, share: f64) -> f64 {
        let [left, _, right, _] = self.edges();
        left + share * (right - left)
    }

    fn up(&self, share: f64) -> f64 {
        let [_, top, _, bottom] = self.edges();
        bottom - share * (bottom - top)
    }

    fn place(&self, [x, y]: [f64; 2]) -> Option<[f64; 2]> {
        Some([self.across(self.x.place(x)?), self.up(self.y.place(y)?)])
    }

    fn draw<B: DrawingBackend>(&self, canvas: &Canvas<B>) -> Result<(), Trouble> {
        self.draw_axes(canvas)?;
        for series in self.in_order() {
            self.draw_line(canvas, series)?;
        }
        for series in self.in_order() {
            self.draw_points(canvas, series)?;
        }
        self.draw_breaks(canvas)
    }

    /// Bands first, so that they lie behind everything; the first style last, on top of the others.
    fn in_order(&self) -> impl Iterator<Item = &'a Series> {
        let mut series: Vec<&Series> = self.panel.series.iter().collect();
        series.sort_by_key(|s| (s.line != Line::Band, std::cmp::Reverse(s.style)));
        series.into_iter()
    }

    fn draw_axes<B: DrawingBackend>(&self, canvas: &Canvas<B>) -> Result<(), Trouble> {
        let [left, top, right, bottom] = self.edges();
        let title = Letters {
            is_bold: true,
            ..letters(12.5, INK, Anchor::Left)
        };
        canvas.text([left, top - 13.0], &self.panel.title, title)?;
        for tick in self.x.ticks(6) {
            let x = self.across(tick.at);
            canvas.line(&[[x, top], [x, bottom]], GRID, 0.7)?;
            canvas.text(
                [x, bottom + 11.0],
                &tick.label,
                letters(SMALL, FAINT, Anchor::Middle),
            )?;
        }
        for tick in self.y.ticks(6) {
            let y = self.up(tick.at);
            canvas.line(&[[left, y], [right, y]], GRID, 0.7)?;
            canvas.text(
                [left - 6.0, y],
                &tick.label,
                letters(SMALL, FAINT, Anchor::Right),
            )?;
        }
        canvas.line(&[[left, top], [left, bottom], [right, bottom]], FAINT, 1.0)?;
        let middle = 0.5 * (left + right);
        canvas.text(
            [middle, bottom + 29.0],
            &self.panel.x.label,
            letters(SMALL, INK, Anchor::Middle),
        )?;
        let upright = Letters {
            is_upright: true,
            ..letters(SMALL, INK, Anchor::Middle)
        };
        canvas.text(
            [self.corner[0] + 14.0, 0.5 * (top + bottom)],
            &self.panel.y.label,
            upright,
        )
    }

    /// The places of the points of a series that have one.
    fn places(&self, series: &Series) -> Vec<[f64; 2]> {
        series
            .points
            .iter()
            .filter_map(|p| self.place(p.at))
            .collect()
    }

    fn draw_line<B: DrawingBackend>(
        &self,
        canvas: &Canvas<B>,
        series: &Series,
    ) -> Result<(), Trouble> {
        let places = self.places(series);
        if places.len() < 2 {
            return Ok(());
        }
        let (color, _) = style(series.style);
        match series.line {
            Line::None => Ok(()),
            Line::Solid => canvas.line(&places, color, 1.6),
            Line::Dashed => canvas.dashes(&places, color, 1.4),
            Line::Band => canvas.line(&places, BAND, 9.0),
        }
    }

    fn draw_points<B: DrawingBackend>(
        &self,
        canvas: &Canvas<B>,
        series: &Series,
    ) -> Result<(), Trouble> {
        if matches!(series.line, Line::Dashed | Line::Band) {
            return Ok(());
        }
        // The default lies on top of its neighbours.
        let is_default = |p: &&Point| p.look.is_default;
        let rest = series.points.iter().filter(|p| !is_default(p));
        for point in rest.chain(series.points.iter().filter(is_default)) {
            let Some(at) = self.place(point.at) else {
                continue;
            };
            if let Some(upper) = point.upper.and_then(|u| self.y.place(u)) {
                canvas.line(&[at, [at[0], self.up(upper)]], style(series.style).0, 1.0)?;
            }
            mark(canvas, at, series.style, point.look)?;
        }
        Ok(())
    }

    /// Two strokes across an axis where zero is beyond them.
    fn draw_breaks<B: DrawingBackend>(&self, canvas: &Canvas<B>) -> Result<(), Trouble> {
        let [left, top, _, bottom] = self.edges();
        if let Some(x) = self.x.broken().map(|share| self.across(share)) {
            canvas.line(&[[x - 2.5, bottom], [x + 2.5, bottom]], PAPER, 4.0)?;
            for shift in [-2.5, 2.5] {
                canvas.line(
                    &[
                        [x + shift - 2.0, bottom + 4.0],
                        [x + shift + 2.0, bottom - 4.0],
                    ],
                    FAINT,
                    1.0,
                )?;
            }
            canvas.dashes(&[[x, top], [x, bottom - 6.0]], GRID, 0.7)?;
        }
        if let Some(y) = self.y.broken().map(|share| self.up(share)) {
            canvas.line(&[[left, y - 2.5], [left, y + 2.5]], PAPER, 4.0)?;
            for shift in [-2.5, 2.5] {
                canvas.line(
                    &[[left - 4.0, y + shift + 2.0], [left + 4.0, y + shift - 2.0]],
                    FAINT,
                    1.0,
                )?;
            }
        }
        Ok(())
    }
}
