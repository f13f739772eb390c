//! The further charts of `fieldstone chart --study`: what they share.

use super::failure::Failure;
use super::script::described;
use super::table::{self, Cell};
use super::{study_constants, study_counts, study_errors, study_precision};
use crate::output::chart::{Axis, Chart, Panel, Point, Scale, Series};
use crate::output::{self, short};
use crate::scene::{Fault, Method, Scene};
use clap::ValueEnum;
use std::path::Path;

/// A chart that is not one of speed against accuracy.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Study {
    /// Steps towards a plane against the angle
    Grazing,
    /// Time against the number of primitives, with and without pruning
    Primitives,
    /// Wrong rays and work against a factor on every Lipschitz constant
    Constants,
    /// Errors against the distance of everything from the origin and against its size, in f64 and in f32
    Distance,
    /// Errors of f32 and of f64 against the tolerance
    Precision,
    /// Errors of normals by dual numbers and by differences
    Gradients,
    /// Errors of pictures against samples a pixel
    Samples,
}

/// What a study is made of.
pub struct Plan {
    /// Scenes with their names.
    pub scenes: Vec<(String, Scene)>,
    /// The methods.
    pub methods: Vec<Method>,
    /// How often everything is timed.
    pub rounds: usize,
}

/// What a study found.
pub struct Findings {
    /// The chart.
    pub chart: Chart,
    /// What the first columns of the table are: the series, the place on the horizontal axis, the value.
    pub columns: [&'static str; 3],
}

impl Study {
    /// The name, after which files are called.
    pub fn name(self) -> &'static str {
        match self {
            Self::Grazing => "grazing",
            Self::Primitives => "primitives",
            Self::Constants => "constants",
            Self::Distance => "distance",
            Self::Precision => "precision",
            Self::Gradients => "gradients",
            Self::Samples => "samples",
        }
    }

    /// Whether it is made of the scenes that are named.
    fn needs_scenes(self) -> bool {
        matches!(self, Self::Constants | Self::Precision | Self::Samples)
    }

    /// Measures and draws.
    ///
    /// # Errors
    /// If scenes are lacking, or named in vain, or a shape can't be traced.
    pub fn carry_out(self, plan: &Plan) -> Result<Findings, Failure> {
        let fault = |fault: Fault| Failure::Other(described(&fault, None));
        if self.needs_scenes() && plan.scenes.is_empty() {
            let name = self.name();
            return Err(Failure::Usage(format!(
                "which scenes? Write `fieldstone chart scene.sdf --study {name}`"
            )));
        }
        if !self.needs_scenes() && !plan.scenes.is_empty() {
            let name = self.name();
            return Err(Failure::Usage(format!(
                "the study `{name}` has shapes of its own; write `fieldstone chart --study {name}` without scenes"
            )));
        }
        match self {
            Self::Grazing => study_counts::grazing(plan).map_err(fault),
            Self::Primitives => study_counts::primitives(plan).map_err(fault),
            Self::Constants => study_constants::constants(plan).map_err(fault),
            Self::Distance => study_precision::distance(plan).map_err(fault),
            Self::Precision => study_precision::precision(plan).map_err(fault),
            Self::Gradients => study_errors::gradients().map_err(fault),
            Self::Samples => study_errors::samples(plan).map_err(fault),
        }
    }
}

impl Findings {
    /// Every point of every series.
    fn points(&self) -> impl Iterator<Item = (&Panel, &Series, &Point)> {
        let panels = self.chart.panels.iter();
        panels.flat_map(|panel| {
            panel
                .series
                .iter()
                .flat_map(move |s| s.points.iter().map(move |p| (panel, s, p)))
        })
    }

    /// All figures as CSV.
    pub fn csv(&self) -> String {
        let [series, x, y] = self.columns;
        let rows: Vec<Vec<Cell>> = self
            .points()
            .map(|(panel, series, point)| {
                let [x, y] = point.at.map(Cell::Number);
                vec![
                    Cell::Text(panel.title.clone()),
                    Cell::Text(series.name.clone()),
                    x,
                    y,
                ]
            })
            .collect();
        table::to_csv(&["panel", series, x, y], &rows)
    }

    /// The figures for people: a row for each place on the horizontal axis, a column for each series.
    pub fn markdown(&self) -> String {
        let mut text = format!("### {}\n\n{}\n\n", self.chart.title, self.chart.subtitle);
        for panel in &self.chart.panels {
            if self.chart.panels.len() > 1 {
                text.push_str(&format!("{}\n\n", panel.title));
            }
            let mut head = vec![self.columns[1]];
            head.extend(panel.series.iter().map(|s| &s.name[..]));
            let mut places: Vec<f64> = panel
                .series
                .iter()
                .flat_map(|s| &s.points)
                .map(|p| p.at[0])
                .collect();
            places.sort_by(f64::total_cmp);
            places.dedup();
            let value = |series: &Series, x: f64| {
                let point = series.points.iter().find(|p| p.at[0] == x);
                point.map_or(String::new(), |p| figure(p.at[1]))
            };
            let rows: Vec<Vec<String>> = places
                .iter()
                .map(|x| {
                    std::iter::once(figure(*x))
                        .chain(panel.series.iter().map(|s| value(s, *x)))
                        .collect()
                })
                .collect();
            text.push_str(&output::markdown(&head, 1, &rows));
            text.push('\n');
        }
        text
    }
}

/// A figure of a table; what is infinite is the error of what found nothing.
fn figure(x: f64) -> String {
    match x {
        f64::INFINITY => "none found".into(),
        x if x.abs() >= 1e6 => format!("{x:.1e}"),
        x => short(x),
    }
}

/// The name of a script without its folder and ending.
pub fn name(path: &Path) -> String {
    path.file_stem()
        .unwrap_or_default()
        .to_string_lossy()
        .into_owned()
}

/// A chart of one panel.
pub fn single(title: &str, subtitle: &str, axes: [(&str, Scale); 2], series: Vec<Series>) -> Chart {
    let [x, y] = axes.map(|(label, scale)| Axis {
        label: label.into(),
        scale,
    });
    Chart {
        title: title.into(),
        subtitle: subtitle.into(),
        columns: 1,
        panels: vec![Panel {
            title: String::new(),
            x,
            y,
            series,
        }],
        notes: Vec::new(),
    }
}
