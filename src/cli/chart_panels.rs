//! The panels of `fieldstone chart`: for each scene, each kind of work against each kind of error.

use crate::output::chart::{Axis, Chart, Line, Look, Panel, Point, Scale, Series};
use crate::render::{Judged, Setting, pareto};
use crate::scene::{Method, Settings};
use clap::ValueEnum;
use std::path::PathBuf;

/// What was measured of a scene.
pub struct Measured {
    /// The script.
    pub script: PathBuf,
    /// How the picture is made without being asked for anything else.
    pub settings: Settings,
    /// The methods at their tolerances.
    pub judged: Vec<Judged>,
}

impl Measured {
    /// The script's name without its folder and ending.
    pub fn name(&self) -> String {
        self.script
            .file_stem()
            .unwrap_or_default()
            .to_string_lossy()
            .into_owned()
    }

    /// Whether this is how the picture is made without being asked for anything else.
    pub fn is_default(&self, setting: &Setting) -> bool {
        setting.method == self.settings.method && setting.tolerance == self.settings.tolerance
    }

    /// The methods, in the order of their list.
    fn methods(&self) -> Vec<Method> {
        let mut methods: Vec<Method> = self.judged.iter().map(|j| j.setting.method).collect();
        methods.dedup();
        methods
    }

    /// Whether the point that is drawn for a setting is beaten by no other point that missed nothing.
    fn on_front(&self, metric: Metric, work: Work) -> Vec<bool> {
        let points: Vec<[f64; 2]> = self.judged.iter().map(|j| place(j, metric, work)).collect();
        pareto(&points)
    }

    /// The other methods that have a point which is nearer than the default's and does not work more, or works less and is
    /// not farther; `None` where the default was not measured.
    pub fn better_than_default(&self, metric: Metric, work: Work) -> Option<Vec<&'static str>> {
        let default = self.judged.iter().find(|j| self.is_default(&j.setting))?;
        let own = place(default, metric, work);
        let is_better = |j: &&Judged| {
            j.setting.method != default.setting.method
                && pareto(&[own, place(j, metric, work)]) == [false, true]
        };
        let mut methods: Vec<&str> = self
            .judged
            .iter()
            .filter(is_better)
            .map(|j| j.setting.method.name())
            .collect();
        methods.dedup();
        Some(methods)
    }
}

/// Error and work of a setting; nowhere, where it missed surfaces.
fn place(judged: &Judged, metric: Metric, work: Work) -> [f64; 2] {
    match is_wrong(judged) {
        true => [f64::NAN; 2],
        false => [metric.of(judged).map_or(f64::NAN, shown), work.of(judged)],
    }
}

/// Below this, errors are rounding, and called exact.
const EXACT: f64 = 1e-12;

/// The error as it is drawn.
fn shown(error: f64) -> f64 {
    if error < EXACT { 0.0 } else { error }
}

/// A kind of error.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Metric {
    /// The error of depth that 99 % of the hits don't exceed, in pixels
    Depth,
    /// The largest error of depth, in pixels
    DepthMax,
    /// False hits, false misses and unknown rays, of a million
    Wrong,
    /// The angle between normals that 99 % of the hits don't exceed, in degrees
    Normals,
    /// The root mean square of the difference of the pictures' light
    Image,
}

impl Metric {
    /// The error of a method at a tolerance, if it was measured.
    pub fn of(self, judged: &Judged) -> Option<f64> {
        let e = &judged.errors;
        match self {
            Self::Depth => Some(e.depth_p99),
            Self::DepthMax => Some(e.depth_max),
            Self::Wrong => Some(e.wrong_per_million()),
            Self::Normals => Some(e.normal_p99),
            Self::Image => judged.image,
        }
    }

    fn axis(self) -> Axis {
        let (label, scale) = match self {
            Self::Depth => ("error of depth (p99), pixels", Scale::LogOrExact),
            Self::DepthMax => ("error of depth (largest), pixels", Scale::LogOrExact),
            Self::Wrong => ("wrong or unknown rays of a million", Scale::LogFromOne),
            Self::Normals => ("error of normals (p99), degrees", Scale::LogOrExact),
            Self::Image => ("error of light (root mean square)", Scale::LogOrExact),
        };
        Axis {
            label: label.into(),
            scale,
        }
    }
}

/// A kind of work.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Work {
    /// Evaluations of fields a camera ray
    Evaluations,
    /// Milliseconds in which one thread traces the camera's rays
    Milliseconds,
}

impl Work {
    fn of(self, judged: &Judged) -> f64 {
        match self {
            Self::Evaluations => judged.evaluations,
            Self::Milliseconds => judged.milliseconds.minimum,
        }
    }

    fn upper(self, judged: &Judged) -> Option<f64> {
        (self == Self::Milliseconds).then_some(judged.milliseconds.upper)
    }

    fn axis(self) -> Axis {
        let (label, scale) = match self {
            // Closed forms evaluate nothing.
            Self::Evaluations => ("evaluations a ray", Scale::LogFromOne),
            Self::Milliseconds => ("milliseconds", Scale::Log),
        };
        Axis {
            label: label.into(),
            scale,
        }
    }
}

fn is_wrong(judged: &Judged) -> bool {
    judged.errors.false_misses > 0
}

/// The chart of all scenes.
pub fn chart(measured: &[Measured], metrics: &[Metric], works: &[Work]) -> Chart {
    let mut panels = Vec::new();
    for scene in measured {
        for metric in metrics {
            for work in works {
                panels.push(panel(scene, *metric, *work));
            }
        }
    }
    let kinds = metrics.len() * works.len();
    let look = Look::default();
    let note = |look: Look, text: &str| (look, text.to_string());
    Chart {
        title: "Speed against accuracy".into(),
        subtitle: "Camera rays against the reference; every line is a method, every point a tolerance. Down and left is good.".into(),
        columns: if kinds > 1 { kinds.min(4) } else { measured.len().min(3) },
        panels,
        notes: vec![
            note(Look { is_default: true, ..look }, "the default"),
            note(Look { is_wrong: true, ..look }, "missed surfaces"),
            note(Look { is_crossed: true, ..look }, "some rays unknown"),
        ],
    }
}

/// The points of a method, in its style.
pub fn series_of(method: Method, points: Vec<Point>) -> Series {
    Series {
        name: method.name().into(),
        style: Method::ALL
            .iter()
            .position(|(_, m)| *m == method)
            .unwrap_or(0),
        line: Line::Solid,
        points,
    }
}

fn panel(scene: &Measured, metric: Metric, work: Work) -> Panel {
    let of_method = |method: Method| {
        let judged = scene.judged.iter();
        let points = judged
            .filter(|j| j.setting.method == method)
            .filter_map(|j| point(scene, metric, work, j));
        series_of(method, points.collect())
    };
    let mut series: Vec<Series> = scene.methods().into_iter().map(of_method).collect();
    series.push(front(scene, metric, work));
    let [width, height] = scene.settings.size;
    Panel {
        title: format!("{}, {width} × {height}", scene.name()),
        x: metric.axis(),
        y: work.axis(),
        series,
    }
}

fn point(scene: &Measured, metric: Metric, work: Work, judged: &Judged) -> Option<Point> {
    Some(Point {
        at: [metric.of(judged)?, work.of(judged)],
        upper: work.upper(judged),
        look: Look {
            is_default: scene.is_default(&judged.setting),
            is_wrong: is_wrong(judged),
            is_crossed: judged.errors.unknown > 0,
            is_ringed: false,
        },
    })
}

/// The points that no other beats.
fn front(scene: &Measured, metric: Metric, work: Work) -> Series {
    let on_front = scene.on_front(metric, work);
    let judged = scene
        .judged
        .iter()
        .zip(on_front)
        .filter(|(_, is_on)| *is_on);
    let mut points: Vec<Point> = judged
        .filter_map(|(j, _)| Some(Point::new(metric.of(j)?, work.of(j))))
        .collect();
    points.sort_by(|a, b| {
        shown(a.at[0])
            .total_cmp(&shown(b.at[0]))
            .then(b.at[1].total_cmp(&a.at[1]))
    });
    Series {
        name: "Pareto front".into(),
        style: 0,
        line: Line::Band,
        points,
    }
}
