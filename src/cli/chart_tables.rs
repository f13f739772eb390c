//! The figures of `fieldstone chart` as CSV, JSON and Markdown.

use super::chart_panels::{Kind, Measured, Metric, Work};
use super::table::{self, Cell};
use crate::output::{self, chart::EXACT};
use crate::render::{Judged, Setting, Spread};
use serde_json::{Value, json};

/// The columns of the CSV.
const COLUMNS: [&str; 20] = [
    "scene",
    "width",
    "height",
    "method",
    "tolerance",
    "is_default",
    "rays",
    "undecided",
    "depth_median",
    "depth_p99",
    "depth_max",
    "false_hits",
    "false_misses",
    "unknown",
    "refuted",
    "normals_p99",
    "image",
    "evaluations",
    "milliseconds",
    "milliseconds_upper",
];

/// All figures, a row for each method at each tolerance.
pub fn csv(measured: &[Measured]) -> String {
    let rows: Vec<Vec<Cell>> = measured
        .iter()
        .flat_map(|scene| scene.judged.iter().map(|j| row(scene, j)))
        .collect();
    table::to_csv(&COLUMNS, &rows)
}

fn row(scene: &Measured, judged: &Judged) -> Vec<Cell> {
    let e = &judged.errors;
    let count = |n: u64| Cell::Count(u32::try_from(n).unwrap_or(u32::MAX));
    let [width, height] = scene.settings.size.map(Cell::Count);
    let setting = &judged.setting;
    vec![
        Cell::Text(scene.name()),
        width,
        height,
        Cell::Text(setting.method.name().into()),
        Cell::Number(setting.tolerance),
        Cell::Count(scene.is_default(setting).into()),
        count(e.rays),
        count(e.undecided),
        Cell::Number(e.depth_median),
        Cell::Number(e.depth_p99),
        Cell::Number(e.depth_max),
        count(e.false_hits),
        count(e.false_misses),
        count(e.unknown),
        count(judged.refuted),
        Cell::Number(e.normal_p99),
        judged.image.map_or(Cell::Empty, Cell::Number),
        Cell::Number(judged.evaluations),
        Cell::Number(judged.milliseconds.minimum),
        Cell::Number(judged.milliseconds.upper),
    ]
}

/// All figures for programs.
pub fn json(measured: &[Measured]) -> String {
    let scenes: Vec<Value> = measured.iter().map(scene_to_json).collect();
    format!("{:#}\n", json!({ "schema": 1, "scenes": scenes }))
}

fn scene_to_json(scene: &Measured) -> Value {
    let points: Vec<Value> = scene
        .judged
        .iter()
        .map(|j| {
            json!({
                "method": j.setting.method.name(),
                "tolerance": j.setting.tolerance,
                "is_default": scene.is_default(&j.setting),
                "errors": j.errors,
                "wrong_per_million": j.errors.wrong_per_million(),
                "refuted": j.refuted,
                "image": j.image,
                "evaluations": j.evaluations,
                "milliseconds": j.milliseconds,
            })
        })
        .collect();
    json!({ "scene": scene.name(), "size": scene.settings.size, "points": points })
}

/// The figures for people, a table for each scene.
pub fn markdown(measured: &[Measured]) -> String {
    let head = [
        "method",
        "tolerance, px",
        "p99 error, px",
        "largest, px",
        "false hits",
        "false misses",
        "unknown",
        "refuted",
        "normals p99, degrees",
        "evaluations a ray",
        "ms, spread of rounds",
        "against the default",
    ];
    let mut text = String::new();
    for scene in measured {
        let [width, height] = scene.settings.size;
        text.push_str(&format!("### {}, {width} x {height}\n\n", scene.name()));
        let default = scene.default();
        let rows: Vec<Vec<String>> = scene
            .judged
            .iter()
            .map(|j| words(scene, j, default))
            .collect();
        text.push_str(&output::markdown(&head, 1, &rows));
        text.push_str(&format!("\n{}\n\n", fronts(scene)));
    }
    text
}

fn words(scene: &Measured, judged: &Judged, default: Option<&Judged>) -> Vec<String> {
    let (e, setting) = (&judged.errors, &judged.setting);
    let name = setting.method.name();
    let is_default = scene.is_default(setting);
    let Spread { minimum, upper, .. } = judged.milliseconds;
    let mut row = vec![if is_default {
        format!("**{name}**")
    } else {
        name.into()
    }];
    row.push(output::short(setting.tolerance));
    row.extend([Metric::Depth, Metric::DepthMax].map(|metric| error(metric, judged)));
    let counts = [e.false_hits, e.false_misses, e.unknown, judged.refuted];
    row.extend(counts.map(|n| n.to_string()));
    row.push(error(Metric::Normals, judged));
    row.push(output::short(judged.evaluations));
    row.push(format!(
        "{} to {}",
        output::short(minimum),
        output::short(upper)
    ));
    row.push(match default {
        Some(_) if is_default => "the default".into(),
        Some(default) => compared(&judged.milliseconds, &default.milliseconds),
        None => String::new(),
    });
    row
}

/// An error as tables have it.
fn error(metric: Metric, judged: &Judged) -> String {
    match metric.of(judged) {
        None => String::new(),
        Some(error) if error < EXACT => "exact".into(),
        Some(f64::INFINITY) => "none found".into(),
        Some(error) => output::short(error),
    }
}

/// How fast something is beside the default; no ratio where the spreads overlap, or rounds are too few for one.
fn compared(own: &Spread, default: &Spread) -> String {
    match own.ratio(default) {
        None if own.rounds.min(default.rounds) < Spread::ENOUGH => "too few rounds to tell".into(),
        None => "no difference".into(),
        Some(ratio) if ratio >= 1.0 => format!("{} times as fast", output::short(ratio)),
        Some(ratio) => format!("{} times as slow", output::short(1.0 / ratio)),
    }
}

/// Whether another method is better than the default in evaluations and in time, in sentences.
fn fronts(scene: &Measured) -> String {
    let Some(default) = scene.default() else {
        return "The default was not measured, so nothing is said of it.".into();
    };
    let method = default.setting.method;
    if default.errors.false_misses + default.errors.unknown > 0 {
        return "The default missed surfaces or left rays unknown, so it is on no front.".into();
    }
    if scene.judged.iter().all(|j| j.setting.method == method) {
        return "No other method was measured.".into();
    }
    [
        ("evaluations", Work::Evaluations),
        ("time", Work::Milliseconds),
    ]
    .map(|(word, work)| front(scene, word, work))
    .join(" ")
}

fn front(scene: &Measured, word: &str, work: Work) -> String {
    let error = Metric::Depth;
    let better = scene.better_than_default(Kind { error, work });
    if better.is_empty() {
        return format!(
            "The default is on the Pareto front of {word}: no other method is as near with less."
        );
    }
    let point = |j: &&Judged| {
        let Setting { method, tolerance } = j.setting;
        format!("`{}` at {} px", method.name(), output::short(tolerance))
    };
    let points: Vec<String> = better.iter().map(point).collect();
    format!(
        "The default is **not** on the Pareto front of {word}: better are {}.",
        points.join(", ")
    )
}

#[cfg(test)]
mod tests {
    use super::super::chart_panels::tests::{five, judged, measured};
    use super::*;
    use crate::scene::Method;

    #[test]
    fn a_ranking_is_refused_where_spreads_overlap_or_rounds_are_few() {
        let spread = |times: &[f64]| Spread::of(times.iter().copied()).unwrap();
        let default = spread(&[10.0, 10.1, 10.2, 10.3]);
        let [slower, alike] =
            [[20.0, 20.2, 20.4, 20.6], [9.0, 9.5, 10.2, 11.0]].map(|t| spread(&t));
        assert_eq!(compared(&slower, &default), "2 times as slow");
        assert_eq!(compared(&alike, &default), "no difference");
        assert_eq!(
            compared(&spread(&[1000.0]), &default),
            "too few rounds to tell"
        );
        assert!(fronts(&measured(five().judged[..1].to_vec())).contains("No other method"));
        assert!(fronts(&measured(five().judged[1..].to_vec())).contains("was not measured"));
        let mut doubtful = five();
        doubtful.judged[0].errors.unknown = 1;
        assert!(fronts(&doubtful).contains("on no front"));
        // So does the front: what is not surely faster does not push the default off it.
        let scene = |times: [f64; 4]| {
            let auto = judged(Method::Auto, 0.0, 4.0, [10.0, 10.1, 10.2, 10.3]);
            measured(vec![auto, judged(Method::Convex, 0.0, 5.0, times)])
        };
        let said = |times: [f64; 4]| fronts(&scene(times));
        assert!(said([9.0, 9.5, 10.2, 11.0]).contains("Pareto front of time: no other"));
        let surely = said([8.0, 8.1, 8.2, 8.3]);
        assert!(
            surely.contains("better are `convex` at 0.100 px"),
            "{surely}"
        );
        assert!(
            surely.contains("front of evaluations: no other"),
            "{surely}"
        );
    }

    #[test]
    fn refuted_constants_are_listed_in_all_forms() {
        let scenes = [five()];
        let table = markdown(&scenes);
        let row = |name: &str| {
            table
                .lines()
                .find(|l| l.starts_with(name))
                .unwrap()
                .to_string()
        };
        assert!(row("| method").contains("| unknown | refuted |"), "{table}");
        assert!(row("| relaxed").contains("| 0 | 0 | 0 | 5 |"), "{table}");
        assert!(
            row("| **auto**").contains("| exact | exact | 0 | 0 | 0 | 0 |"),
            "{table}"
        );
        assert!(row("| enhanced").contains("| none found |"), "{table}");
        let text = csv(&scenes);
        let mut reader = csv::Reader::from_reader(text.as_bytes());
        let column = reader
            .headers()
            .unwrap()
            .iter()
            .position(|h| h == "refuted")
            .unwrap();
        let refuted: Vec<String> = reader
            .records()
            .map(|r| r.unwrap()[column].into())
            .collect();
        assert_eq!(refuted, ["0", "0", "0", "5", "0"]);
        let found: Value = serde_json::from_str(&json(&scenes)).unwrap();
        assert_eq!(found["scenes"][0]["points"][3]["refuted"], 5);
    }
}
