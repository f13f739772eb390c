//! The figures of `fieldstone chart` as CSV, JSON and Markdown.

use super::chart_panels::{Measured, Metric, Work};
use super::table::{self, Cell};
use crate::output;
use crate::render::{Judged, Spread};
use serde_json::{Value, json};

/// The columns of the CSV.
const COLUMNS: [&str; 19] = [
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
        "normals p99, degrees",
        "evaluations a ray",
        "ms (spread)",
        "against the default",
    ];
    let mut text = String::new();
    for scene in measured {
        let [width, height] = scene.settings.size;
        text.push_str(&format!("### {}, {width} x {height}\n\n", scene.name()));
        let default = scene.judged.iter().find(|j| scene.is_default(&j.setting));
        let rows: Vec<Vec<String>> = scene
            .judged
            .iter()
            .map(|j| words(scene, j, default))
            .collect();
        text.push_str(&output::markdown(&head, 1, &rows));
        text.push_str(&format!("\n{}\n\n", front(scene)));
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
    row.extend([setting.tolerance, e.depth_p99, e.depth_max].map(output::short));
    row.extend([e.false_hits, e.false_misses, e.unknown].map(|n| n.to_string()));
    row.extend([e.normal_p99, judged.evaluations].map(output::short));
    row.push(format!(
        "{} ({} to {})",
        output::short(minimum),
        output::short(minimum),
        output::short(upper)
    ));
    row.push(match default {
        Some(_) if is_default => "is it".into(),
        Some(default) => compared(&judged.milliseconds, &default.milliseconds),
        None => String::new(),
    });
    row
}

/// How fast something is beside the default; no ratio where the spreads overlap.
fn compared(own: &Spread, default: &Spread) -> String {
    match own.ratio(default) {
        None => "no difference".into(),
        Some(ratio) if ratio >= 1.0 => format!("{} times as fast", output::short(ratio)),
        Some(ratio) => format!("{} times as slow", output::short(1.0 / ratio)),
    }
}

/// Whether another method is better than the default, in a sentence.
fn front(scene: &Measured) -> String {
    match scene.better_than_default(Metric::Depth, Work::Evaluations) {
        None => "The default was not among them.".into(),
        Some(methods) if methods.is_empty() => {
            "The default is on the Pareto front: no other method is as near with fewer evaluations."
                .into()
        }
        Some(methods) => format!(
            "The default is **not** on the Pareto front: {} is better.",
            methods.join(", ")
        ),
    }
}
