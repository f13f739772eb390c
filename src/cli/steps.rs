//! `fieldstone steps`: how many steps rays take, and what they take them for.

use super::budget::{self, Limit};
use super::columns::{Row, aligned};
use super::console::{answer, counted};
use super::failure::Failure;
use super::script::{Script, compile};
use super::stats::grouped;
use super::{tracing, value};
use crate::output::short;
use crate::render::{Cause, Hits, Share, Steps, effort};
use crate::scene::{Method, Scene};
use clap::Args;
use serde_json::{Value, json};

const AFTER_HELP: &str = "\
The first table has, for each method, how many camera rays took how many steps. Of each method there is then a table \
of what the steps were taken for, by line of the script: a ray's steps are put down to the leaves that keep them short, \
those that govern the field at the places which sphere tracing samples, in proportion. They add up to all steps.

With --budget, the exit code is 1 if a method exceeds it. Counts are the same on every machine, so this belongs into tests.

Examples:
  fieldstone steps scene.sdf
  fieldstone steps scene.sdf --methods auto,sphere,auto-relaxed
  fieldstone steps scene.sdf --budget mean=20,p99=80,unknown=0
  fieldstone steps scene.sdf --size 160x90 --json | jq '.methods[0].mean'";

/// Print how many steps rays take by each method, and which lines of the script they take them for
#[derive(Args, Debug)]
#[command(after_help = AFTER_HELP)]
pub struct Arguments {
    #[command(flatten)]
    script: Script,
    /// The methods [default: what the script says, or else auto]
    #[arg(long, value_name = "NAME[,NAME]", value_delimiter = ',', value_parser = tracing::method())]
    methods: Vec<Method>,
    /// How far from the surface a hit may be, in pixels [default: what the script says, or else 0.1]
    #[arg(long, value_name = "PX", value_parser = value::positive, allow_negative_numbers = true)]
    tolerance: Option<f64>,
    /// Width and height in pixels, up to 16384 each [default: what the script says, or else 640x360]
    #[arg(long, value_name = "WxH", value_parser = value::size, allow_hyphen_values = true)]
    size: Option<[u32; 2]>,
    /// What no method may exceed, or the command fails: mean, p99, max (steps a ray), evaluations (a ray), unknown (rays)
    #[arg(long, value_name = "NAME=N[,NAME=N]", value_delimiter = ',', value_parser = budget::limit)]
    budget: Vec<Limit>,
    /// Answer in JSON
    #[arg(long)]
    json: bool,
}

/// What was counted for a method.
pub struct Counted {
    /// How rays find surfaces.
    pub method: Method,
    /// How many rays took how many steps.
    pub steps: Steps,
    /// Evaluations of fields a ray.
    pub evaluations: f64,
    /// Rays whose tracing ended without an answer.
    pub unknown: u64,
    total: u64,
    causes: Vec<(Cause, Share)>,
}

/// Counts the steps and prints them.
///
/// # Errors
/// If the script is wrong or shows what can't be traced, or a budget is exceeded.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let mut scene = arguments.script.load()?.scene;
    let settings = &mut scene.settings;
    settings.size = arguments.size.unwrap_or(settings.size);
    settings.tolerance = arguments.tolerance.unwrap_or(settings.tolerance);
    let mut methods = arguments.methods.clone();
    if methods.is_empty() {
        methods.push(scene.settings.method);
    }
    let counted = methods
        .into_iter()
        .map(|method| count(&scene, method))
        .collect::<Result<Vec<_>, _>>()?;
    answer(&if arguments.json {
        in_json(&scene, &counted)
    } else {
        in_words(&scene, &counted)
    })?;
    budget::hold(&arguments.budget, &counted)
}

fn count(scene: &Scene, method: Method) -> Result<Counted, Failure> {
    let mut scene = scene.clone();
    scene.settings.method = method;
    let world = compile(&scene)?;
    let hits = Hits::of(&scene, &world, 0);
    Ok(Counted {
        method,
        steps: hits.steps(),
        evaluations: hits.evaluations(),
        unknown: hits.census.unknown,
        total: hits.outcomes.iter().map(|o| u64::from(o.steps)).sum(),
        causes: effort(&hits, &world),
    })
}

/// How wide the bars of the histogram are.
const BAR: usize = 16;

/// How many causes are told of, for people.
const MAX_LINES: usize = 20;

fn in_words(scene: &Scene, all: &[Counted]) -> String {
    let [width, height] = scene.settings.size;
    let mut text = format!("camera rays by their steps, {width} x {height}\n");
    text.push_str(&histograms(all));
    for counted in all {
        text.push_str(&format!(
            "\nsteps of {} by what they were taken for\n",
            counted.method.name()
        ));
        text.push_str(&causes(counted));
    }
    text
}

/// The ranges of steps that are told apart: 0, 1, 2, then up to each power of two.
fn bins(most: u32) -> Vec<(u32, u32)> {
    let mut bins = vec![(0, 0), (1, 1), (2, 2)];
    while bins[bins.len() - 1].1 < most {
        let last = bins[bins.len() - 1].1;
        bins.push((last + 1, last.saturating_mul(2)));
    }
    bins
}

fn histograms(all: &[Counted]) -> String {
    let most = all.iter().map(|c| c.steps.max).max().unwrap_or(0);
    let of_bin = |c: &Counted, (from, to): (u32, u32)| -> u64 {
        c.steps
            .histogram
            .iter()
            .filter(|(s, _)| (from..=to).contains(s))
            .map(|(_, n)| n)
            .sum()
    };
    let mut head: Row = vec!["steps".into()];
    head.extend(
        all.iter()
            .flat_map(|c| [c.method.name().to_string(), String::new()]),
    );
    let mut rows = vec![head];
    let bins = bins(most);
    let largest = bins
        .iter()
        .flat_map(|bin| all.iter().map(|c| of_bin(c, *bin)))
        .max()
        .unwrap_or(1)
        .max(1);
    for bin in bins {
        let (from, to) = bin;
        let mut row: Row = vec![if from == to {
            from.to_string()
        } else {
            format!("{from} to {to}")
        }];
        for counted in all {
            let rays = of_bin(counted, bin);
            row.push(grouped(rays));
            row.push(bar(rays as f64 / largest as f64));
        }
        rows.push(row);
    }
    let mut summary = |name: &str, value: &dyn Fn(&Counted) -> String| {
        let mut row: Row = vec![name.into()];
        row.extend(all.iter().flat_map(|c| [value(c), String::new()]));
        rows.push(row);
    };
    summary("mean", &|c| short(c.steps.mean));
    summary("p99", &|c| c.steps.p99.to_string());
    summary("max", &|c| c.steps.max.to_string());
    summary("evaluations a ray", &|c| short(c.evaluations));
    summary("unknown rays", &|c| grouped(c.unknown));
    summary("all steps", &|c| grouped(c.total));
    aligned(&padded(rows), 1)
}

/// The bars flush left: all as wide as the widest.
fn padded(mut rows: Vec<Row>) -> Vec<Row> {
    for row in &mut rows {
        for cell in row.iter_mut().skip(2).step_by(2) {
            let blanks = BAR.saturating_sub(cell.chars().count());
            cell.push_str(&" ".repeat(blanks));
        }
    }
    rows
}

/// A bar for a share of its width, to an eighth of a letter; whatever is more than nothing shows.
fn bar(share: f64) -> String {
    const EIGHTHS: [char; 8] = [' ', '▏', '▎', '▍', '▌', '▋', '▊', '▉'];
    let eighths = (share * 8.0 * BAR as f64).ceil() as usize;
    let mut bar = "█".repeat(eighths / 8);
    if !eighths.is_multiple_of(8) {
        bar.push(EIGHTHS[eighths % 8]);
    }
    bar
}

fn causes(counted: &Counted) -> String {
    let head = ["", "line", "share", "steps", "rays", "a ray"]
        .map(String::from)
        .to_vec();
    let mut rows = vec![head];
    let row = |words: [String; 2], share: Share| {
        let percent = 100.0 * share.steps as f64 / counted.total.max(1) as f64;
        let mean = short(share.steps as f64 / share.rays.max(1) as f64);
        let mut row: Row = words.to_vec();
        row.extend([
            format!("{percent:.1} %"),
            grouped(share.steps),
            grouped(share.rays),
            mean,
        ]);
        row
    };
    for (cause, share) in counted.causes.iter().take(MAX_LINES) {
        rows.push(row([described(cause), place(cause)], *share));
    }
    let rest = &counted.causes[counted.causes.len().min(MAX_LINES)..];
    if !rest.is_empty() {
        rows.push(row(
            [format!("{} more", counted_lines(rest.len())), String::new()],
            sum(rest),
        ));
    }
    rows.push(row(["all".into(), String::new()], sum(&counted.causes)));
    aligned(&rows, 2)
}

fn counted_lines(n: usize) -> String {
    counted(n, "line")
}

fn sum(causes: &[(Cause, Share)]) -> Share {
    causes
        .iter()
        .fold(Share::default(), |sum, (_, share)| Share {
            rays: sum.rays + share.rays,
            steps: sum.steps + share.steps,
        })
}

fn described(cause: &Cause) -> String {
    match (&cause.name, &cause.kind[..]) {
        (_, "") => "nothing near".into(),
        (Some(name), kind) => format!("{kind} of `{name}`"),
        (None, kind) => kind.into(),
    }
}

fn place(cause: &Cause) -> String {
    cause
        .place
        .as_ref()
        .map_or(String::new(), |(file, line)| format!("{file}:{line}"))
}

fn in_json(scene: &Scene, all: &[Counted]) -> String {
    let methods: Vec<Value> = all.iter().map(method_to_json).collect();
    format!(
        "{:#}\n",
        json!({ "schema": 1, "size": scene.settings.size, "methods": methods })
    )
}

fn method_to_json(counted: &Counted) -> Value {
    let causes: Vec<Value> = counted
        .causes
        .iter()
        .map(|(cause, share)| {
            json!({
                "kind": cause.kind,
                "name": cause.name,
                "file": cause.place.as_ref().map(|(file, _)| &**file),
                "line": cause.place.as_ref().map(|(_, line)| line),
                "steps": share.steps,
                "rays": share.rays,
            })
        })
        .collect();
    json!({
        "method": counted.method.name(),
        "mean": counted.steps.mean,
        "p99": counted.steps.p99,
        "max": counted.steps.max,
        "evaluations": counted.evaluations,
        "unknown": counted.unknown,
        "total": counted.total,
        "histogram": counted.steps.histogram,
        "causes": causes,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bins_cover_every_number_of_steps_once() {
        let bins = bins(100);
        for steps in 0..=100 {
            let holding = bins
                .iter()
                .filter(|(from, to)| (*from..=*to).contains(&steps));
            assert_eq!(holding.count(), 1, "{steps}");
        }
        assert_eq!(
            bins[3..],
            [(3, 4), (5, 8), (9, 16), (17, 32), (33, 64), (65, 128)]
        );
    }

    #[test]
    fn bars_are_as_long_as_their_share() {
        assert_eq!(bar(0.0), "");
        assert_eq!(bar(1.0), "█".repeat(BAR));
        assert_eq!(bar(0.5), "█".repeat(BAR / 2));
        assert_eq!(bar(1e-9), "▏");
    }
}
