//! What `fieldstone bench` found, for people and for programs.

use super::columns::{Row, aligned};
use super::console::counted;
use super::stats::grouped;
use crate::output::short;
use crate::render::{Case, Run, Spread, Statistics};
use crate::scene::Settings;
use serde_json::{Value, json};

/// The rounds of a scene.
pub struct Bench {
    /// The script, as it was given.
    pub script: String,
    /// The values of its parameters.
    pub parameters: Vec<(String, String)>,
    /// How the picture was made, but for the methods.
    pub settings: Settings,
    /// The milliseconds of loading, a round each.
    pub load: Vec<f64>,
    /// What was compared, with its runs.
    pub cases: Vec<Measured>,
}

/// A case with its runs, one a round.
pub type Measured = (Case, Vec<Run>);

/// A number of things in a picture.
type Count = fn(&Statistics) -> u64;

/// A time of a run in milliseconds.
type Time = fn(&Run) -> f64;

/// The stages of a run.
const STAGES: [(&str, Time); 3] = [
    ("compile", |run| run.compile),
    ("render", |run| run.statistics.milliseconds.wall),
    ("tracing", |run| run.statistics.milliseconds.trace),
];

/// The kinds of rays: how many there were, and the time in which they were traced.
const KINDS: [(&str, Count, Time); 3] = [
    (
        "primary",
        |s| s.rays.primary,
        |run| run.statistics.milliseconds.trace_primary,
    ),
    (
        "shadow",
        |s| s.rays.shadow,
        |run| run.statistics.milliseconds.trace_shadow,
    ),
    (
        "secondary",
        |s| s.rays.reflected + s.rays.refracted,
        |run| run.statistics.milliseconds.trace_secondary,
    ),
];

fn spread(runs: &[Run], time: Time) -> Spread {
    Spread::of(runs.iter().map(time)).expect("there is at least one round")
}

/// The counts of a case, which are the same in every round.
fn counts(runs: &[Run]) -> &Statistics {
    &runs[0].statistics
}

/// The rays of all kinds.
fn rays(statistics: &Statistics) -> u64 {
    KINDS.iter().map(|(_, number, _)| number(statistics)).sum()
}

/// A case in words.
fn name(case: &Case) -> String {
    format!(
        "{}, {}",
        case.method.name(),
        counted(case.threads, "thread")
    )
}

/// A pair of cases that differ in one thing only: the method, or the number of threads.
fn pairs(bench: &Bench) -> impl Iterator<Item = [&Measured; 2]> {
    let cases = &bench.cases;
    (0..cases.len())
        .flat_map(move |i| (i + 1..cases.len()).map(move |j| [&cases[i], &cases[j]]))
        .filter(|[a, b]| (a.0.method == b.0.method) != (a.0.threads == b.0.threads))
}

/// Tables for people.
pub fn in_words(bench: &Bench) -> String {
    let [width, height] = bench.settings.size;
    let rounds = counted(bench.load.len(), "round");
    let mut text = format!("{}, {width} x {height}, {rounds}\n", bench.script);
    text.push_str(&stages(bench));
    text.push('\n');
    text.push_str(&kinds(bench));
    let ratios = ratios(bench);
    if !ratios.is_empty() {
        text.push('\n');
        text.push_str(&aligned(&ratios, 2));
    }
    text.push('\n');
    text
}

/// The times of each stage.
fn stages(bench: &Bench) -> String {
    let row = |cells: [&str; 5]| cells.map(String::from).to_vec();
    let mut rows = vec![row([
        "milliseconds",
        "",
        "minimum",
        "median",
        "three quarters",
    ])];
    let mut add = |name: &str, stage: &str, spread: Spread| {
        let Spread {
            minimum,
            median,
            upper,
            ..
        } = spread;
        let mut cells = vec![name.to_string(), stage.to_string()];
        cells.extend([minimum, median, upper].map(short));
        rows.push(cells);
    };
    let load = Spread::of(bench.load.iter().copied()).expect("there is at least one round");
    add("", "load", load);
    for (case, runs) in &bench.cases {
        let name = name(case);
        for (i, (stage, time)) in STAGES.iter().enumerate() {
            add(if i == 0 { &name } else { "" }, stage, spread(runs, *time));
        }
    }
    aligned(&rows, 2)
}

/// Rays by kind, and what they took.
fn kinds(bench: &Bench) -> String {
    let head = [
        "rays",
        "",
        "number",
        "per second",
        "ns/ray",
        "evaluations/ray",
    ];
    let mut rows = vec![head.map(String::from).to_vec()];
    for (case, runs) in &bench.cases {
        let counts = counts(runs);
        for (kind, number, time) in KINDS {
            let n = number(counts);
            if n == 0 {
                continue;
            }
            let ns = spread(runs, time).median * 1e6 / n as f64;
            let row: Row = vec![
                String::new(),
                kind.into(),
                grouped(n),
                per_second(1e9 / ns),
                short(ns),
            ];
            rows.push(row);
        }
        let all = rays(counts);
        let wall = spread(runs, STAGES[1].1).median;
        let evaluations = short(counts.evaluations as f64 / all as f64);
        let ns = short(wall * 1e6 / all as f64);
        rows.push(vec![
            String::new(),
            "all, whole picture".into(),
            grouped(all),
            per_second(1e3 * all as f64 / wall),
            ns,
            evaluations,
        ]);
        let first = rows.len()
            - 1
            - KINDS
                .iter()
                .filter(|(_, number, _)| number(counts) > 0)
                .count();
        rows[first][0] = name(case);
    }
    aligned(&rows, 2)
}

/// A number a second.
fn per_second(x: f64) -> String {
    format!("{} M", short(x / 1e6))
}

/// How the cases compare.
fn ratios(bench: &Bench) -> Vec<Row> {
    let ratio = |[(a, before), (b, after)]: [&Measured; 2]| {
        let [before, after] = [before, after].map(|runs| spread(runs, STAGES[1].1));
        // The faster one comes first.
        let (first, second, ratio) = match before.ratio(&after) {
            Some(ratio) if ratio < 1.0 => (b, a, Some(1.0 / ratio)),
            ratio => (a, b, ratio),
        };
        let verdict = ratio.map_or("no difference".into(), |r| {
            format!("{} times as fast", short(r))
        });
        vec![name(first), format!("against {}", name(second)), verdict]
    };
    pairs(bench).map(ratio).collect()
}

/// All of it for programs.
pub fn to_json(bench: &Bench) -> Value {
    let parameters: serde_json::Map<String, Value> = bench
        .parameters
        .iter()
        .map(|(name, value)| (name.clone(), json!(value)))
        .collect();
    let ratios: Vec<Value> = pairs(bench)
        .map(|[(a, before), (b, after)]| {
            let [before, after] = [before, after].map(|runs| spread(runs, STAGES[1].1));
            json!({ "first": case_to_json(a), "second": case_to_json(b), "times_as_fast": before.ratio(&after) })
        })
        .collect();
    let cases: Vec<Value> = bench
        .cases
        .iter()
        .map(|(case, runs)| runs_to_json(case, runs))
        .collect();
    json!({
        "script": bench.script,
        "parameters": parameters,
        "size": bench.settings.size,
        "samples": bench.settings.samples,
        "rounds": bench.load.len(),
        "load": Spread::of(bench.load.iter().copied()),
        "cases": cases,
        "ratios": ratios,
    })
}

fn case_to_json(case: &Case) -> Value {
    json!({ "method": case.method.name(), "threads": case.threads })
}

fn runs_to_json(case: &Case, runs: &[Run]) -> Value {
    let counts = counts(runs);
    let mut value = case_to_json(case);
    for (stage, time) in STAGES {
        value[stage] = json!(spread(runs, time));
    }
    for (kind, number, time) in KINDS {
        let n = number(counts);
        let milliseconds = spread(runs, time).median;
        value["rays"][kind] = json!({
            "number": n,
            "milliseconds": spread(runs, time),
            "per_second": (n > 0).then(|| 1e3 * n as f64 / milliseconds),
            "nanoseconds": (n > 0).then(|| 1e6 * milliseconds / n as f64),
        });
    }
    value["evaluations"] = json!(counts.evaluations);
    value["unknown"] = json!(counts.primary.unknown + counts.unknown_secondary);
    value
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::render::{RenderOptions, rounds};
    use crate::scene::{Method, Scene};

    /// A bench of an empty scene in which rendering takes these times.
    fn bench(times: [&[f64]; 2]) -> Bench {
        let case = |threads| Case {
            method: Method::Auto,
            threads,
        };
        let mut scene = Scene::default();
        scene.settings.size = [4, 2];
        let cases = [1, 2].map(case);
        let runs = rounds(&scene, &cases, 5, &RenderOptions::default()).unwrap();
        let with_times = |mut runs: Vec<Run>, times: &[f64]| {
            runs.iter_mut()
                .zip(times)
                .for_each(|(run, t)| run.statistics.milliseconds.wall = *t);
            runs
        };
        let runs: Vec<Vec<Run>> = runs
            .into_iter()
            .zip(times)
            .map(|(r, t)| with_times(r, t))
            .collect();
        Bench {
            script: "a.sdf".into(),
            parameters: vec![("n".into(), "3".into())],
            settings: scene.settings,
            load: vec![1.0; 5],
            cases: cases.into_iter().zip(runs).collect(),
        }
    }

    #[test]
    fn faster_case_comes_first() {
        let bench = bench([
            &[20.0, 21.0, 22.0, 23.0, 90.0],
            &[11.0, 10.0, 12.0, 10.0, 11.0],
        ]);
        let last = in_words(&bench).lines().rev().nth(1).unwrap().to_string();
        assert_eq!(
            last,
            "  auto, 2 threads  against auto, 1 thread  2 times as fast"
        );
        assert_eq!(to_json(&bench)["ratios"][0]["times_as_fast"], 0.5);
    }

    #[test]
    fn overlapping_spreads_show_no_difference() {
        let bench = bench([
            &[20.0, 21.0, 22.0, 23.0, 90.0],
            &[23.0, 24.0, 25.0, 26.0, 27.0],
        ]);
        assert!(in_words(&bench).contains("no difference"));
        assert!(to_json(&bench)["ratios"][0]["times_as_fast"].is_null());
    }

    #[test]
    fn counts_are_of_the_picture() {
        let bench = bench([&[1.0; 5], &[1.0; 5]]);
        let value = to_json(&bench);
        assert_eq!(value["cases"][0]["rays"]["primary"]["number"], 8);
        assert_eq!(value["parameters"]["n"], "3");
        assert!(value["cases"][0]["rays"]["shadow"]["per_second"].is_null());
    }
}
