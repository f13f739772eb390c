//! What a rendering took, for people and for programs.

use crate::render::Statistics;
use serde_json::{Value, json};
use std::time::{Duration, Instant};

/// The time of the command's own stages, in milliseconds.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Stages {
    /// Reading and running the script.
    pub load: f64,
    /// Making closures of its shapes.
    pub compile: f64,
    /// Encoding and writing the picture.
    pub write: f64,
}

/// What `work` gives, and the milliseconds that it took.
pub fn timed<T>(work: impl FnOnce() -> T) -> (T, f64) {
    let start = Instant::now();
    let result = work();
    (result, milliseconds(start.elapsed()))
}

fn milliseconds(time: Duration) -> f64 {
    time.as_secs_f64() * 1e3
}

/// The summary for people, a line for each matter.
pub fn summary(statistics: &Statistics, stages: &Stages) -> String {
    let s = statistics;
    let (rays, time) = (&s.rays, &s.milliseconds);
    let total = rays.primary + rays.shadow + rays.reflected + rays.refracted;
    let of_kind: Vec<String> = [
        (rays.primary, "camera"),
        (rays.shadow, "shadow"),
        (rays.reflected, "reflected"),
        (rays.refracted, "refracted"),
    ]
    .iter()
    .filter(|(n, _)| *n > 0)
    .map(|(n, kind)| format!("{} {kind}", grouped(*n)))
    .collect();
    let mut lines = Vec::new();
    if s.refined_pixels > 0 {
        let [width, height] = s.size.map(u64::from);
        let refined = 100.0 * s.refined_pixels as f64 / (width * height) as f64;
        lines.push(format!(
            "samples       {} in {refined:.1} % of the pixels, else 1",
            s.samples
        ));
    }
    lines.extend([
        format!("rays          {}: {}", grouped(total), of_kind.join(", ")),
        format!(
            "camera rays   {} hits, {} misses, {} unknown",
            grouped(s.primary.hits),
            grouped(s.primary.misses),
            grouped(s.primary.unknown)
        ),
        format!(
            "steps a ray   mean {:.2}, p99 {}, max {}",
            s.steps.mean, s.steps.p99, s.steps.max
        ),
        format!("evaluations   {}", grouped(s.evaluations)),
        format!(
            "milliseconds  load {:.1}, compile {:.1}, trace {:.1}, shade {:.1}, write {:.1}",
            stages.load, stages.compile, time.trace, time.shade, stages.write
        ),
        format!("on {}", threads(s)),
    ]);
    lines.join("\n") + "\n"
}

fn threads(s: &Statistics) -> String {
    let plural = if s.threads == 1 { "" } else { "s" };
    let wall = s.milliseconds.wall;
    format!(
        "{} thread{plural} for {wall:.1} ms (trace and shade are summed over threads)",
        s.threads
    )
}

/// What is to be looked at, if anything.
pub fn warning(statistics: &Statistics) -> Option<String> {
    let s = statistics;
    let pixels = s.unknown_pixels;
    if pixels == 0 {
        return None;
    }
    let rays = s.primary.unknown + s.unknown_secondary;
    let (noun, verb) = if pixels == 1 {
        ("pixel", "is")
    } else {
        ("pixels", "are")
    };
    Some(format!(
        "{} {noun} {verb} unknown ({} rays ended without an answer); --channel verdict shows where, --max-steps allows more",
        grouped(pixels),
        grouped(rays)
    ))
}

/// The number with blanks between groups of three digits.
pub fn grouped(n: u64) -> String {
    let digits = n.to_string();
    let first = digits.len() % 3;
    let mut text = digits[..first].to_string();
    for (i, group) in digits.as_bytes()[first..].chunks(3).enumerate() {
        if first > 0 || i > 0 {
            text.push(' ');
        }
        text.extend(group.iter().map(|byte| *byte as char));
    }
    text
}

/// The statistics for programs: those of the rendering, with the script, its parameters and the other stages.
///
/// # Errors
/// None that can be thought of: they are numbers and words.
pub fn to_json(
    statistics: &Statistics,
    stages: &Stages,
    script: &str,
    parameters: &[(String, String)],
) -> Result<String, serde_json::Error> {
    let mut value = serde_json::to_value(statistics)?;
    if let Some(times) = value.get_mut("milliseconds").and_then(Value::as_object_mut) {
        times.insert("load".into(), json!(stages.load));
        times.insert("compile".into(), json!(stages.compile));
        times.insert("write".into(), json!(stages.write));
    }
    if let Some(object) = value.as_object_mut() {
        let parameters: serde_json::Map<String, Value> = parameters
            .iter()
            .map(|(name, value)| (name.clone(), json!(value)))
            .collect();
        object.insert("script".into(), json!(script));
        object.insert("parameters".into(), Value::Object(parameters));
        object.insert("version".into(), json!(env!("CARGO_PKG_VERSION")));
    }
    serde_json::to_string_pretty(&value).map(|text| text + "\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn digits_are_grouped_by_three() {
        let numbers = [0, 7, 999, 1000, 123456, 1234567].map(grouped);
        assert_eq!(numbers, ["0", "7", "999", "1 000", "123 456", "1 234 567"]);
    }
}
