//! The panels of `fieldstone chart`: for each scene, each kind of work against each kind of error.

use crate::output::chart::{Axis, Chart, EXACT, Line, Look, Panel, Point, Scale, Series};
use crate::render::{Judged, Place, Setting, pareto};
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

    /// How the picture is made without being asked for anything else, if that was measured.
    pub fn default(&self) -> Option<&Judged> {
        self.judged.iter().find(|j| self.is_default(&j.setting))
    }

    /// Whether the point that is drawn for a setting is beaten by no other point that answered and missed nothing.
    fn on_front(&self, kind: Kind) -> Vec<bool> {
        let places: Vec<Place> = self.judged.iter().map(|j| kind.place(j)).collect();
        pareto(&places)
    }

    /// The points of other methods that beat the default; none where the default was not measured.
    pub fn better_than_default(&self, kind: Kind) -> Vec<&Judged> {
        let Some(default) = self.default() else {
            return Vec::new();
        };
        let own = kind.place(default);
        let is_better =
            |j: &&Judged| j.setting.method != default.setting.method && kind.place(j).beats(&own);
        self.judged.iter().filter(is_better).collect()
    }
}

/// What a panel shows: a kind of work against a kind of error.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Kind {
    /// The horizontal axis.
    pub error: Metric,
    /// The vertical axis.
    pub work: Work,
}

impl Kind {
    /// Every kind of work against every kind of error.
    pub fn all(errors: &[Metric], works: &[Work]) -> Vec<Self> {
        let of_error = |error: &Metric| {
            let error = *error;
            works.iter().map(move |work| Self { error, work: *work })
        };
        errors.iter().flat_map(of_error).collect()
    }

    /// The name of its file.
    pub fn name(self) -> String {
        let [error, work] = [
            self.error.to_possible_value(),
            self.work.to_possible_value(),
        ]
        .map(|value| value.expect("no kind is hidden").get_name().to_string());
        format!("{error}-{work}")
    }

    /// Error and work of a setting, for the front; nowhere, where it missed surfaces or left rays unknown: such a point is
    /// shown, but it beats nothing.
    fn place(self, judged: &Judged) -> Place {
        let e = &judged.errors;
        let error = match e.false_misses + e.unknown {
            0 => self.error.of(judged).map_or(f64::NAN, shown),
            _ => f64::NAN,
        };
        let work = self.work.of(judged);
        Place {
            upper: self.work.upper(judged).unwrap_or(work),
            ..Place::counted(error, work)
        }
    }
}

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
    /// The error of a method at a tolerance, if it was measured; infinite where it found none of the surfaces, so that there is
    /// nothing to compare.
    pub fn of(self, judged: &Judged) -> Option<f64> {
        let e = &judged.errors;
        let finds_nothing = e.compared == 0 && e.false_misses + e.unknown > 0;
        let of_pairs = |error: f64| Some(if finds_nothing { f64::INFINITY } else { error });
        match self {
            Self::Depth => of_pairs(e.depth_p99),
            Self::DepthMax => of_pairs(e.depth_max),
            Self::Wrong => Some(e.wrong_per_million()),
            Self::Normals => of_pairs(e.normal_p99),
            Self::Image => judged.image,
        }
    }

    /// What it is called in titles.
    fn words(self) -> &'static str {
        match self {
            Self::Depth => "the error of depth",
            Self::DepthMax => "the largest error of depth",
            Self::Wrong => "wrong rays",
            Self::Normals => "the error of normals",
            Self::Image => "the error of light",
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

impl Work {
    /// What it is called in titles.
    fn words(self) -> &'static str {
        match self {
            Self::Evaluations => "Evaluations",
            Self::Milliseconds => "Time",
        }
    }
}

/// The chart of all scenes: these kinds of panels of each.
pub fn chart(measured: &[Measured], kinds: &[Kind]) -> Chart {
    let panels = measured
        .iter()
        .flat_map(|scene| kinds.iter().map(|kind| panel(scene, *kind)));
    let title = match kinds {
        [kind] => format!("{} against {}", kind.work.words(), kind.error.words()),
        _ => "Speed against accuracy".into(),
    };
    let look = Look::default();
    let notes = [
        (
            Look {
                is_default: true,
                ..look
            },
            "the default",
        ),
        (
            Look {
                is_wrong: true,
                ..look
            },
            "missed surfaces",
        ),
        (
            Look {
                is_crossed: true,
                ..look
            },
            "some rays unknown",
        ),
        (
            Look {
                is_ringed: true,
                ..look
            },
            "a constant refuted",
        ),
    ];
    Chart {
        title,
        subtitle: "Camera rays against the reference; every line is a method, every point a tolerance. Down and left is good.".into(),
        columns: if kinds.len() > 1 { kinds.len().min(4) } else { measured.len().min(3) },
        panels: panels.collect(),
        notes: notes.map(|(look, text)| (look, text.to_string())).to_vec(),
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

fn panel(scene: &Measured, kind: Kind) -> Panel {
    let of_method = |method: Method| {
        let judged = scene.judged.iter();
        let points = judged
            .filter(|j| j.setting.method == method)
            .filter_map(|j| point(scene, kind, j));
        series_of(method, points.collect())
    };
    let mut series: Vec<Series> = scene.methods().into_iter().map(of_method).collect();
    series.push(front(scene, kind));
    let [width, height] = scene.settings.size;
    Panel {
        title: format!("{}, {width} × {height}", scene.name()),
        x: kind.error.axis(),
        y: kind.work.axis(),
        series,
    }
}

fn point(scene: &Measured, kind: Kind, judged: &Judged) -> Option<Point> {
    Some(Point {
        at: [kind.error.of(judged)?, kind.work.of(judged)],
        upper: kind.work.upper(judged),
        look: Look {
            is_default: scene.is_default(&judged.setting),
            is_wrong: judged.errors.false_misses > 0,
            is_crossed: judged.errors.unknown > 0,
            is_ringed: judged.refuted > 0,
        },
    })
}

/// The points that no other beats.
fn front(scene: &Measured, kind: Kind) -> Series {
    let on_front = scene.on_front(kind);
    let judged = scene
        .judged
        .iter()
        .zip(on_front)
        .filter(|(_, is_on)| *is_on);
    let mut points: Vec<Point> = judged
        .filter_map(|(j, _)| Some(Point::new(kind.error.of(j)?, kind.work.of(j))))
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

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::output::chart::svg;
    use crate::render::{Errors, Spread};

    /// A point with an error of depth, evaluations a ray, and times from four rounds.
    pub fn judged(method: Method, depth: f64, evaluations: f64, times: [f64; 4]) -> Judged {
        Judged {
            setting: Setting {
                method,
                tolerance: 0.1,
            },
            errors: Errors {
                rays: 1000,
                compared: 500,
                depth_p99: depth,
                ..Errors::default()
            },
            refuted: 0,
            evaluations,
            milliseconds: Spread::of(times).unwrap(),
            image: None,
        }
    }

    pub fn measured(judged: Vec<Judged>) -> Measured {
        Measured {
            script: "scene.sdf".into(),
            settings: Settings::default(),
            judged,
        }
    }

    /// The default, which is exact; one that missed surfaces and did little; one with unknown rays; one that met a field steeper
    /// than its constant; one that found none of the surfaces.
    pub fn five() -> Measured {
        let alike = |x: f64| [x, x + 0.1, x + 0.2, x + 0.3];
        let auto = judged(Method::Auto, 0.0, 4.0, alike(10.0));
        let mut missing = judged(Method::Bisect, 1e-3, 1.0, alike(2.0));
        missing.errors.false_misses = 3;
        let mut unknown = judged(Method::Sphere, 1e-3, 2.0, alike(3.0));
        unknown.errors.unknown = 7;
        let mut refuted = judged(Method::Relaxed, 1e-2, 20.0, alike(30.0));
        refuted.refuted = 5;
        let mut blind = judged(Method::Enhanced, 0.0, 1.5, alike(2.5));
        blind.errors.compared = 0;
        blind.errors.false_misses = 500;
        measured(vec![auto, missing, unknown, refuted, blind])
    }

    const KIND: Kind = Kind {
        error: Metric::Depth,
        work: Work::Evaluations,
    };

    /// The look of a method's only point.
    fn look(panel: &Panel, method: Method) -> Look {
        let series = panel.series.iter().find(|s| s.name == method.name());
        series.expect("every method is drawn").points[0].look
    }

    #[test]
    fn what_failed_is_marked_and_never_hidden() {
        let chart = chart(&[five()], &[KIND]);
        let panel = &chart.panels[0];
        let plain = Look::default();
        let is_default = Look {
            is_default: true,
            ..plain
        };
        let is_wrong = Look {
            is_wrong: true,
            ..plain
        };
        let is_crossed = Look {
            is_crossed: true,
            ..plain
        };
        let is_ringed = Look {
            is_ringed: true,
            ..plain
        };
        assert_eq!(look(panel, Method::Auto), is_default);
        assert_eq!(look(panel, Method::Bisect), is_wrong);
        assert_eq!(look(panel, Method::Enhanced), is_wrong);
        assert_eq!(look(panel, Method::Sphere), is_crossed);
        assert_eq!(look(panel, Method::Relaxed), is_ringed);
        // What has nothing to be compared has no error of 0.
        let blind = panel.series.iter().find(|s| s.name == "enhanced").unwrap();
        assert_eq!(blind.points[0].at[0], f64::INFINITY);
    }

    /// A grey mark for each point that missed surfaces and one in the legend; a ring of 16 pieces around a point and in the
    /// legend. Neither where nothing failed.
    #[test]
    fn marks_of_failures_are_drawn() {
        let count = |text: &str, color: &str| text.matches(color).count();
        let drawn = svg(&chart(&[five()], &[KIND])).unwrap();
        let all_well = measured(five().judged[..1].to_vec());
        let all_well = svg(&chart(&[all_well], &[KIND])).unwrap();
        for (color, more) in [("fill=\"#B2B2B8\"", 3), ("stroke=\"#C80028\"", 32)] {
            assert_eq!(count(&drawn, color), more, "{color}");
            assert_eq!(count(&all_well, color), 0, "{color}");
        }
        assert!(drawn.contains("exact"));
    }

    /// Few evaluations that missed surfaces or left rays unknown do not push the default off the front.
    #[test]
    fn what_failed_beats_nothing() {
        let scene = five();
        assert_eq!(scene.on_front(KIND), [true, false, false, false, false]);
        assert!(scene.better_than_default(KIND).is_empty());
        let mut better = five();
        better
            .judged
            .push(judged(Method::Convex, 0.0, 3.9, [11.0; 4]));
        let found = better.better_than_default(KIND);
        assert_eq!(found.len(), 1);
        assert_eq!(found[0].setting.method, Method::Convex);
        let chart = chart(&[better], &[KIND]);
        let front = chart.panels[0].series.last().unwrap();
        assert_eq!(
            (front.name.as_str(), front.line),
            ("Pareto front", Line::Band)
        );
        let places: Vec<[f64; 2]> = front.points.iter().map(|p| p.at).collect();
        assert_eq!(places, [[0.0, 3.9]]);
    }

    /// Errors that are rounding count as none, so that rounding decides no rank.
    #[test]
    fn rounding_is_exact() {
        let exact = [0.0, 3e-14].map(|e| judged(Method::Auto, e, 4.0, [1.0; 4]));
        let [a, b] = exact.each_ref().map(|j| KIND.place(j));
        assert_eq!(a, b);
    }

    #[test]
    fn kinds_are_named_after_both_axes() {
        let kinds = Kind::all(
            &[Metric::DepthMax, Metric::Wrong],
            &[Work::Evaluations, Work::Milliseconds],
        );
        let names: Vec<String> = kinds.into_iter().map(Kind::name).collect();
        assert_eq!(
            names,
            [
                "depth-max-evaluations",
                "depth-max-milliseconds",
                "wrong-evaluations",
                "wrong-milliseconds"
            ]
        );
    }
}
