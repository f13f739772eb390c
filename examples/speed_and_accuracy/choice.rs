//! The table by which one chooses a method: all scenes together, at the tolerance of the default.

use crate::Outcome;
use crate::figures::brief;
use fieldstone::output::chart::EXACT;
use fieldstone::output::{markdown, short};
use serde::Deserialize;
use std::collections::BTreeMap;
use std::path::Path;

/// A row of `chart.csv`, as far as it is asked for.
#[derive(Debug, Deserialize)]
struct Row {
    scene: String,
    method: String,
    tolerance: f64,
    is_default: u8,
    rays: f64,
    depth_p99: f64,
    false_hits: f64,
    false_misses: f64,
    unknown: f64,
    evaluations: f64,
    milliseconds: f64,
}

/// The table.
///
/// # Errors
/// If the figures cannot be read, or the default is not among them.
pub fn table(path: &Path) -> Outcome<String> {
    let mut reader = csv::Reader::from_path(path)?;
    let rows: Vec<Row> = reader.deserialize().collect::<Result<_, _>>()?;
    let default: BTreeMap<&str, &Row> = rows
        .iter()
        .filter(|row| row.is_default == 1)
        .map(|row| (&row.scene[..], row))
        .collect();
    let tolerance = default.values().next().ok_or("no default")?.tolerance;
    let rows = || rows.iter().filter(|row| row.tolerance == tolerance);
    let mut methods: Vec<&str> = rows().map(|row| &row.method[..]).collect();
    methods.dedup();
    // In the order of the list of methods, which each scene repeats.
    let mut seen = Vec::new();
    methods.retain(|m| {
        !seen.contains(m) && {
            seen.push(m);
            true
        }
    });
    let lines: Vec<Vec<String>> = methods
        .iter()
        .map(|method| {
            let own: Vec<&Row> = rows().filter(|row| row.method == **method).collect();
            line(method, &own, &default)
        })
        .collect();
    let head = [
        "method",
        "largest p99 error, px",
        "false hits of a million",
        "false misses",
        "unknown",
        "evaluations a ray",
        "time beside the default",
    ];
    Ok(markdown(&head, 1, &lines))
}

fn line(method: &str, rows: &[&Row], default: &BTreeMap<&str, &Row>) -> Vec<String> {
    let sum = |value: fn(&Row) -> f64| rows.iter().map(|row| value(row)).sum::<f64>();
    let of_million = |n: f64| short((1e6 * n / sum(|row| row.rays)).round());
    let largest = rows.iter().map(|row| row.depth_p99).fold(0.0, f64::max);
    let is_default = rows.iter().any(|row| row.is_default == 1);
    let slower = rows.iter().filter_map(|row| {
        let default = default.get(&row.scene[..])?;
        Some(row.milliseconds / default.milliseconds)
    });
    let name = match is_default {
        true => format!("**`{method}`**"),
        false => format!("`{method}`"),
    };
    let error = match largest < EXACT {
        true => "exact".into(),
        false => short(largest),
    };
    let counts = [
        sum(|row| row.false_hits),
        sum(|row| row.false_misses),
        sum(|row| row.unknown),
    ];
    let mut line = vec![name, error];
    line.extend(counts.map(of_million));
    line.push(from_to(rows.iter().map(|row| row.evaluations)));
    line.push(match is_default {
        true => "1".into(),
        false => format!("{} times", from_to(slower)),
    });
    line
}

/// The smallest and the largest of some figures.
fn from_to(values: impl Iterator<Item = f64>) -> String {
    let (low, high) = values.fold((f64::INFINITY, 0.0f64), |(a, b), x| (a.min(x), b.max(x)));
    format!("{} to {}", brief(low), brief(high))
}
